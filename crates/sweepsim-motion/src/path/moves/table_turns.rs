//! How a rotary table carries the part under a tool that goes straight.

use super::TipArc;
use nalgebra::{Matrix3, Vector3};

/// The turns of a table during a move, at constant speed, seen from the part: about a line of the part, or about two
/// lines of which the second one turns with the first. The second line is given where it is at the start.
///
/// ```
/// use sweepsim_motion::{TableTurns, TipArc};
/// let quarter = |normal| TipArc::new([0.0; 3], normal, std::f64::consts::FRAC_PI_2);
/// // Half-way, and at the end, what was at (1, 0, 0): first about y, and that about z.
/// let turns = TableTurns::new(quarter([0.0, 0.0, 1.0])?).on(quarter([0.0, 1.0, 0.0])?);
/// let [x, y, z] = turns.turned([1.0, 0.0, 0.0], 0.5);
/// assert!((x - 0.5).abs() < 1e-15 && (y - 0.5).abs() < 1e-15 && (z + 0.5_f64.sqrt()).abs() < 1e-15);
/// let [x, y, z] = turns.turned([1.0, 0.0, 0.0], 1.0);
/// assert!(x.abs() < 1e-15 && y.abs() < 1e-15 && (z + 1.0).abs() < 1e-15);
/// # Ok::<(), sweepsim_motion::ArcError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableTurns {
    first: TipArc,
    second: Option<TipArc>,
}

impl TableTurns {
    /// About one line.
    #[must_use]
    pub fn new(first: TipArc) -> Self {
        Self { first, second: None }
    }

    /// The same on an axis that turns, too.
    #[must_use]
    pub fn on(self, second: TipArc) -> Self {
        let second = Some(second);
        Self { second, ..self }
    }

    /// The turns, that about a line of the part first.
    pub fn turns(&self) -> impl DoubleEndedIterator<Item = &TipArc> {
        std::iter::once(&self.first).chain(&self.second)
    }

    /// Where a point of the machine is on the part after a fraction of the time; at the start, it is at `from`.
    #[must_use]
    pub fn turned(&self, from: [f64; 3], time: f64) -> [f64; 3] {
        self.turned_point(from.into(), time).into()
    }

    pub(in crate::path) fn turned_point(&self, from: Vector3<f64>, time: f64) -> Vector3<f64> {
        self.turns().rev().fold(from, |point, turn| turn.turned(point, time))
    }

    /// From `from` to `to` as the tool goes: in the frame that turns, which at the start is the part's.
    pub(in crate::path) fn way(&self, from: Vector3<f64>, to: Vector3<f64>) -> Vector3<f64> {
        self.turns().fold(to, |point, turn| turn.reversed().turned(point, 1.0)) - from
    }

    /// The same between two different times, forwards or backwards.
    #[must_use]
    pub fn during(&self, [from, to]: [f64; 2]) -> Self {
        let second = self.second.map(|second| {
            // Where the second line is then.
            let [at, above] = [0.0, 1.0].map(|k| Vector3::from(second.centre()) + second.normal_vector().scale(k));
            let [at, above] = [at, above].map(|point| self.first.turned(point, from));
            TipArc::of_parts(at.into(), (above - at).normalize().into(), second.angle() * (to - from))
        });
        Self {
            first: self.first.times(to - from),
            second,
        }
    }

    /// The same turns in another place.
    pub(in crate::path) fn moved(&self, turn: &Matrix3<f64>, shift: Vector3<f64>) -> Self {
        Self {
            first: self.first.moved(turn, shift),
            second: self.second.map(|second| second.moved(turn, shift)),
        }
    }

    /// The largest angle, without its sign.
    pub(in crate::path) fn angle(&self) -> f64 {
        self.turns().map(|turn| turn.angle().abs()).fold(0.0, f64::max)
    }

    /// The tip is never farther than this from where it starts.
    pub(in crate::path) fn travel(&self, from: Vector3<f64>, to: Vector3<f64>) -> f64 {
        let way = self.way(from, to);
        let turned = self
            .levers(from, way)
            .0
            .into_iter()
            .map(|(angle, far)| angle.min(2.0) * far);
        turned.sum::<f64>() + way.norm()
    }

    /// Each angle, without its sign, with the largest distance of the tip from the line as far as the inner turns and
    /// its way bring it there, in the order of [`turns`](Self::turns); and a bound of the tip's second derivative.
    ///
    /// A turn by `ω` of a point at a distance `r` that moves at a speed `v` adds `ω r` to its speed and `2 ω v + ω² r`
    /// to its acceleration.
    pub(in crate::path) fn levers(&self, from: Vector3<f64>, way: Vector3<f64>) -> (Vec<(f64, f64)>, f64) {
        let (mut levers, mut speed, mut bend) = (Vec::new(), way.norm(), 0.0);
        for turn in self.turns().rev() {
            let angle = turn.angle().abs();
            let far = turn.radius_vector(from).norm() + speed;
            levers.push((angle, far));
            bend += 2.0 * angle * speed + angle * angle * far;
            speed += angle * far;
        }
        levers.reverse();
        (levers, bend)
    }
}
