//! Every length and limit that is derived from the tolerance, in one table.
//!
//! Programs are full of coincidences: a flat bottom moving sideways (`g ≡ 0` on a whole patch), a wall along a row of dexels, a tip exactly
//! over a line. To avoid them, tips and lines are displaced by small fractions of the tolerance. The dexels are those of the
//! displaced input, up to rounding and the last step of Newton's method. As fractions of the tolerance `τ`:
//!
//! | what | at most | |
//! | --- | --- | --- |
//! | a tip of the path | 1/100 | [`tip_displacement`](Tolerances::tip_displacement) |
//! | the middle of a straight move for lines that are solved again, attempts 4 and 5 | 1/100 | [`bend`](Tolerances::bend) |
//! | a tip between moves that are joined to one | 1/100 | [`joint_deviation`](Tolerances::joint_deviation), not together with the next |
//! | a motion that has no exact rational form, from its law | 1/20 | [`law_deviation`](Tolerances::law_deviation) |
//! | a line | 1/500, at tolerances near the least 1/15 | [`line_displacement`](Tolerances::line_displacement), attempt 0 |
//! | a line that is solved again because its audit failed | 1/170 … 1/5 | the same, attempts 1 to 5 |
//! | heights that count as one crossing's | 1/1000 | [`same_height`](Tolerances::same_height) |
//! | the last step of Newton's method leaves | 1/1000 | [`last_step`](Tolerances::last_step) |
//!
//! Together they stay below `τ/3`: the dexels belong to an input within a third of the tolerance of the given one.

use crate::error::SweepError;
use nalgebra::Vector3;
use sweepsim_solve::SolveOptions;

/// The maximum displacement of a tip.
const TIP: f64 = 1e-2;
/// The maximum deviation of motions from their law.
const LAW: f64 = 5e-2;
/// The maximum deviation of arcs from circles, part of the one above.
const CIRCLE: f64 = 1e-2;
/// The initial displacement of lines.
const LINE: f64 = 2e-3;
/// The factors for the attempts, each larger than the one before.
const ATTEMPTS: [f64; 6] = [1.0, 3.0, 10.0, 30.0, 60.0, 100.0];
/// The same at the least tolerance.
const FINEST_ATTEMPTS: [f64; 6] = [32.0, 40.0, 51.0, 64.0, 80.0, 100.0];
/// A line is displaced by at least this part of the largest coordinate: 256 times the rounding of coordinates, or lines that a pole passes over, or a wall, would be seen to be within
/// rounding of it, and solved twice.
const LEAST: f64 = 256.0 * ROUNDING;
/// The directions for the attempts, in radians: none along a row or column of lines, as walls are, and no two alike. The usual one has the golden ratio
/// as its tangent, from which the ratios of small integers are farthest, as the directions of diagonals are on square cells; and it points away from the usual
/// direction of tips, which no pose of an upright tool takes closer to a line.
const DIRECTIONS: [f64; 6] = [3.6952, 1.970, 3.520, 5.323, 1.154, 2.747];
/// From this attempt on, straight moves are bent.
const BENT: usize = 4;
/// The maximum displacement of the middle of a straight move.
const BEND: f64 = 1e-2;
/// The same as a part of the move's length.
const BEND_OF_LENGTH: f64 = 0.25;
/// Crossings of a line this close together count as having the same height.
const SAME: f64 = 1e-3;
/// The error that the last step of Newton's method may leave.
const REST: f64 = 1e-3;
/// The distance from the surface at which a point is tested for being outside the volume: well above the sum of all displacements, even where the
/// surface is steep.
const OUTSIDE: f64 = 20.0;
/// The directions in which tips are displaced, orthogonal to each other and almost across no axis of the grid: the usual one first.
const WAYS: [[f64; 3]; 3] = [
    [0.569_840_290_998, 0.331_172_830_617, 0.752_022_194_331],
    [0.322_021_831_822, 0.751_986_956_037, -0.575_167_417_175],
    [-0.756_016_867_947, 0.569_940_858_461, 0.321_878_724_424],
];
/// The part of a displacement that has to be along the tool's axis. An end of the tool that is flat slides along itself on moves across the axis: whether
/// it cuts is decided by this part alone.
const LEAST_RISE: f64 = 0.2;
/// After this many poses, the displacement of tips restarts from zero.
const PERIOD: usize = 61;
/// The same for tolerances below [`FINE`], where a sixtieth of the displacement would be a few roundings of the coordinates.
const FINE_PERIOD: usize = 4;
/// In parts of the largest coordinate.
const FINE: f64 = 1e-9;
/// The limit that the table above promises.
const _: () = assert!(CIRCLE <= LAW);
const _: () = assert!(FINEST_ATTEMPTS[Tolerances::REPAIRS] <= ATTEMPTS[Tolerances::REPAIRS]);
const _: () = assert!(TIP + BEND + LAW + LINE * ATTEMPTS[Tolerances::REPAIRS] + SAME + REST < 1.0 / 3.0);

/// Coordinates are accurate to within this fraction of the largest: a few dozen roundings.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// The smallest tolerance, as a fraction of the largest coordinate: a thousandth of it is four times the rounding of coordinates, and the least
/// displacement of lines a fifteenth of it.
const FINEST: f64 = 4000.0 * ROUNDING;
/// Sums of products of three such coordinates stay far from overflow.
const LARGEST: f64 = 1e90;

/// A tolerance, and the limits derived from it for coordinates of some size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tolerances {
    tolerance: f64,
    size: f64,
}

impl Tolerances {
    /// `size`: a bound on all coordinates.
    pub fn new(tolerance: f64, size: f64) -> Result<Self, SweepError> {
        if !(tolerance > 0.0 && tolerance.is_finite()) {
            return Err(SweepError::Tolerance(tolerance));
        }
        if !(size <= LARGEST) {
            return Err(SweepError::TooLarge { size });
        }
        let least = FINEST * size;
        if tolerance < least {
            return Err(SweepError::TooFine { tolerance, size, least });
        }
        Ok(Self { tolerance, size })
    }

    /// How many times a line is solved again, displaced farther each time, before its dexel is reported as unresolved.
    pub const REPAIRS: usize = ATTEMPTS.len() - 1;

    /// The displacement of a line at an attempt, 0 to [`REPAIRS`](Self::REPAIRS): farther than at the previous one, and in a different direction.
    pub fn line_displacement(&self, attempt: usize) -> [f64; 2] {
        let attempt = attempt.min(Self::REPAIRS);
        let [usual, finest] = [ATTEMPTS[attempt], FINEST_ATTEMPTS[attempt]];
        // The factor that attempt 0 needs is 1 or more; the others grow in proportion.
        let least = LEAST * self.size / (LINE * self.tolerance);
        let share = ((least - ATTEMPTS[0]) / (FINEST_ATTEMPTS[0] - ATTEMPTS[0])).clamp(0.0, 1.0);
        let reach = LINE * self.tolerance * (usual + share * (finest - usual));
        let angle = DIRECTIONS[attempt];
        [reach * angle.cos(), reach * angle.sin()]
    }

    /// The displacement of the tip of a pose: a sawtooth along a generic direction, which depends on nothing but the tool's axis at this pose.
    ///
    /// Each translation is changed by the *same* vector, so that the sign of `g` on a patch that it decides is the same for all of them, and no
    /// kinks arise between collinear moves. The exception is every 61st, which takes all of the displacement back: before and after it there may be
    /// kinks, as thin as the displacement, which are counted like any others. The same holds at the ends of arcs of tools that lie along an axis of the
    /// grid, where one component of it is left out.
    pub fn tip_displacement(&self, pose: usize, axis: Vector3<f64>) -> Vector3<f64> {
        let period = if self.tolerance < FINE * self.size {
            FINE_PERIOD
        } else {
            PERIOD
        };
        direction(axis) * (TIP * self.tolerance * ((pose % period) as f64 / period as f64))
    }

    /// A translation for a tool that stands still, with this axis: as long as the largest displacement of a tip.
    pub fn standstill(&self, axis: Vector3<f64>) -> Vector3<f64> {
        direction(axis) * (TIP * self.tolerance)
    }

    /// How far the middle of a straight move is displaced at an attempt, by this way and for this axis of the tool: across the way and, at the first such attempt, across the
    /// displacement of tips. So rulings of a wall that slides along itself, which are where the displacement is tangent to it, turn about the tool by 90° or 45°. `None` at other attempts.
    pub fn bend(&self, attempt: usize, way: Vector3<f64>, axis: Vector3<f64>) -> Option<Vector3<f64>> {
        let ahead = way.try_normalize(0.0).filter(|_| attempt >= BENT)?;
        let usual = direction(axis);
        let across = ahead.cross(&usual);
        let across = across.try_normalize(1e-3).unwrap_or_else(|| {
            // Along the displacement itself: any way across will do.
            let [_, other, _] = WAYS.map(Vector3::from);
            ahead.cross(&other).normalize()
        });
        let within = across.cross(&ahead);
        let bend = if attempt == BENT {
            across
        } else {
            (across + within).normalize()
        };
        Some(bend * (BEND * self.tolerance).min(BEND_OF_LENGTH * way.norm()))
    }

    /// The maximum deviation of motions from their law.
    pub fn law_deviation(&self) -> f64 {
        LAW * self.tolerance
    }

    /// The maximum distance of the tips between moves that are joined to one from its straight way.
    pub fn joint_deviation(&self) -> f64 {
        TIP * self.tolerance
    }

    /// The maximum distance between the end of an arc and the circle about its centre through its start, for the arc to be taken as a circle through both.
    pub fn circle_deviation(&self) -> f64 {
        CIRCLE * self.tolerance
    }

    /// Heights that differ by no more than this count as the same.
    pub fn same_height(&self) -> f64 {
        SAME * self.tolerance
    }

    /// The distance from the surface at which a point is tested for being outside the volume.
    pub fn outside(&self) -> f64 {
        OUTSIDE * self.tolerance
    }

    /// The rounding error of a coordinate.
    pub fn rounding(&self) -> f64 {
        ROUNDING * self.size
    }

    /// The longest last step of Newton's method, relative to the parameters' ranges: the remaining error is its square, times lengths of the size of the
    /// coordinates.
    pub fn last_step(&self) -> f64 {
        (REST * self.tolerance / self.size).sqrt().clamp(1e-9, 1e-5)
    }
}

/// The first direction that is not almost across this axis, of any length.
fn direction(axis: Vector3<f64>) -> Vector3<f64> {
    let ways = WAYS.map(|way| Vector3::from(way).normalize());
    let least = LEAST_RISE * axis.norm();
    let rises = |way: &&Vector3<f64>| way.dot(&axis).abs() >= least;
    // Of three orthogonal directions, one is along any axis by more than a half.
    *ways.iter().find(rises).unwrap_or(&ways[0])
}

/// Limits that follow from the chord error of a polyline or a mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ChordTolerance(f64);

impl ChordTolerance {
    /// `chord`: the maximum distance of the midpoint of a chord from the curve.
    pub fn new(chord: f64) -> Result<Self, SweepError> {
        if !(chord > 0.0 && chord.is_finite()) {
            return Err(SweepError::Tolerance(chord));
        }
        Ok(Self(chord))
    }

    /// The chord error of a curve in its parameters, where none moves a point by more than `fastest`: half of it, as the ends of a chord may be off
    /// as well.
    pub fn of_curve(self, fastest: f64) -> f64 {
        (self.0 / (2.0 * fastest)).clamp(1e-9, 0.03)
    }

    /// The same of a surface. Meshes finer than a millionth of the parameters' ranges are never built.
    pub fn of_surface(self, fastest: f64) -> f64 {
        (self.0 / fastest).clamp(1e-6, 0.05)
    }

    /// The permitted error at the midpoint of a grid step: half, since triangles have diagonals.
    pub fn of_step(self) -> f64 {
        0.5 * self.0
    }
}

/// Limits of the curves of a section: boxes smaller than `1e-10` of the parameters' ranges are singular points to them.
pub(crate) fn curve_options(boxes: u64, unresolved: usize) -> SolveOptions {
    SolveOptions::default()
        .smallest(1e-10)
        .boxes(boxes)
        .unresolved(unresolved)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_attempt_displaces_a_line_farther_than_the_one_before() {
        let size = 100.0;
        for tolerance in [1e-3, 1e-6, 5e-8, 2e-8, 1e-8, FINEST * size] {
            let tolerances = Tolerances::new(tolerance, size).unwrap();
            let mut before = 0.0;
            for attempt in 0..=Tolerances::REPAIRS {
                let [x, y] = tolerances.line_displacement(attempt);
                let reach = x.hypot(y);
                assert!(
                    reach > 1.2 * before && reach <= 0.2 * tolerance * (1.0 + 1e-12),
                    "{tolerance}, attempt {attempt}"
                );
                before = reach;
                // Away from walls along rows and columns.
                assert!(x.abs().min(y.abs()) > 0.3 * reach, "{tolerance}, attempt {attempt}");
            }
            let [x, y] = tolerances.line_displacement(0);
            let most = (LINE * tolerance).max(LEAST * size);
            assert!((x.hypot(y) - most).abs() <= 1e-12 * most && most < tolerance / 15.0);
            // And from walls along diagonals, the more so the more lines of a square grid they pass over.
            for [p, q] in [
                [1.0, 1.0],
                [2.0, 1.0],
                [1.0, 2.0],
                [3.0, 1.0],
                [1.0, 3.0],
                [3.0, 2.0],
                [2.0, 3.0],
            ] {
                for q in [q, -q] {
                    let across = (x * q - y * p).abs() / f64::hypot(p, q);
                    assert!(across > 0.4 * most / (p * p + q * q), "{p}:{q}");
                }
            }
        }
    }

    #[test]
    fn translations_change_alike_but_where_the_sawtooth_wraps() {
        let tolerances = Tolerances::new(1e-6, 100.0).unwrap();
        let axis = Vector3::new(0.2, -0.3, 0.7);
        let change = |k: usize| tolerances.tip_displacement(k + 1, axis) - tolerances.tip_displacement(k, axis);
        for k in 0..3 * PERIOD {
            assert!(tolerances.tip_displacement(k, axis).norm() < TIP * 1e-6);
            if (k + 1) % PERIOD == 0 {
                assert!(change(k).dot(&change(0)) < 0.0, "{k}");
            } else {
                assert!((change(k) - change(0)).norm() < 1e-12 * TIP * 1e-6, "{k}");
            }
        }
    }

    #[test]
    fn no_tip_of_an_upright_tool_is_displaced_as_lines_are() {
        let tolerances = Tolerances::new(1e-6, 100.0).unwrap();
        let [x, y] = tolerances.line_displacement(0);
        for pose in 0..2 * PERIOD {
            let tip = tolerances.tip_displacement(pose, Vector3::z());
            assert!((tip.x - x).abs().min((tip.y - y).abs()) > 0.5e-3 * 1e-6, "{pose}");
        }
    }

    #[test]
    fn no_axis_is_across_its_displacement() {
        let tolerances = Tolerances::new(1e-6, 100.0).unwrap();
        let along_grid = (0..3).map(|k| {
            let mut axis = Vector3::zeros();
            axis[k] = 1.0;
            axis
        });
        for axis in along_grid.chain([Vector3::new(0.0, 0.3, -2.0), Vector3::new(3.0, 2.0, 9.0)]) {
            assert_eq!(direction(axis), Vector3::from(WAYS[0]).normalize(), "{axis:?}");
        }
        // Around the globe, every 2°, and everywhere across the usual direction.
        let [usual, other, third] = WAYS.map(|way| Vector3::from(way).normalize());
        let degrees = |k: u32| f64::from(2 * k).to_radians();
        let globe = (0..180_u32).flat_map(|k| {
            let (east, north) = degrees(k).sin_cos();
            (0..90_u32).map(move |l| {
                let (across, along) = degrees(l).sin_cos();
                Vector3::new(across * east, across * north, along)
            })
        });
        let across = (0..180_u32).map(|k| other * degrees(k).cos() + third * degrees(k).sin());
        for axis in globe.chain(across) {
            let way = tolerances.standstill(axis) / tolerances.standstill(axis).norm();
            assert!(way.dot(&axis).abs() >= LEAST_RISE * (1.0 - 1e-12), "{axis:?}");
            // Neither in a plane of faces along the grid, nor halfway between two of these.
            assert!((0..3).all(|k| way[k].abs() > 0.3 && (way[k].abs() - way[(k + 1) % 3].abs()).abs() > 0.1));
            assert_eq!(direction(axis), direction(-axis * 7.0), "{axis:?}");
        }
        assert!(
            usual
                .dot(&other)
                .abs()
                .max(usual.dot(&third).abs())
                .max(other.dot(&third).abs())
                < 1e-9
        );
    }

    #[test]
    fn tolerances_that_numbers_cannot_hold_are_refused() {
        for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(Tolerances::new(tolerance, 1.0), Err(SweepError::Tolerance(_))));
            assert!(matches!(ChordTolerance::new(tolerance), Err(SweepError::Tolerance(_))));
        }
        assert!(matches!(Tolerances::new(1e-12, 1.0), Err(SweepError::TooFine { .. })));
        for size in [1e100, f64::INFINITY, f64::NAN] {
            assert!(matches!(Tolerances::new(1e90, size), Err(SweepError::TooLarge { .. })));
        }
        // The smallest displacement of a line is more than the rounding of a coordinate.
        let finest = Tolerances::new(FINEST * 100.0, 100.0).unwrap();
        let [x, y] = finest.line_displacement(0);
        assert!(x.abs().min(y.abs()) > 8.0 * f64::EPSILON * 100.0);
    }
}
