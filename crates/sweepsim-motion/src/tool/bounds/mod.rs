//! Convex solids of revolution that hold a tool, and that it holds, whatever its shape.

mod cores;
mod hulls;
mod polygon;
mod silhouette;
mod slivers;

use super::Tool;
use crate::profile::Profile;
use silhouette::{Sample, silhouette};
use slivers::{Controls, Corners, Net, Sliver, slivers};

type Convex = Vec<[f64; 2]>;

/// Convex solids of revolution about a tool's axis, each by its corners `(ρ, ζ)`: from the lowest on the axis to the
/// highest, counter-clockwise.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Bounds {
    /// All together, they hold the tool.
    pub hulls: Vec<Vec<[f64; 2]>>,
    /// The tool holds each of them.
    pub cores: Vec<Vec<[f64; 2]>>,
}

/// How closely solids follow a tool of revolution, in parts of its radius.
const TOLERANCE: f64 = 2e-4;
/// What is no higher is not divided.
const FLAT: f64 = 1e-5;
/// Heights are rounded to multiples of this part of the largest coordinate; other roundings are smaller.
const ROUNDING: f64 = 1e-10;
/// A surface has at most so many parts.
const MOST: usize = 1 << 15;

/// A tool's surface.
struct Surface {
    parts: Vec<Sliver>,
    corners: Vec<Corners>,
    samples: Vec<Sample>,
    /// In millimetres.
    tolerance: f64,
    flat: f64,
    rounding: f64,
    /// A bound of all coordinates.
    size: f64,
    /// Of a profile, all between its ends is inside of the tool.
    ends: Option<[f64; 2]>,
}

impl Surface {
    fn new(tool: &Tool) -> Self {
        let radius = tool.cylinder.radius;
        let tolerance = TOLERANCE * radius;
        let pieces = tool.profile().map_or_else(Vec::new, Profile::pieces);
        let curves = pieces.iter().flat_map(|piece| piece.curves()).map(Controls::Meridian);
        let nets = tool.patches().iter().filter(|_| pieces.is_empty());
        let nets = nets.map(|patch| Controls::Net(Net::new(patch.position(), patch.weight())));
        let rounding = ROUNDING * tool.reach;
        let (parts, corners) = slivers(curves.chain(nets), (tolerance, rounding, MOST));
        Self {
            samples: silhouette(&parts, rounding),
            parts,
            corners,
            tolerance,
            flat: FLAT * radius,
            rounding,
            size: 2.0 * tool.reach,
            ends: pieces
                .first()
                .zip(pieces.last())
                .map(|(first, last)| [first.from.y, last.to.y]),
        }
    }

    fn heights(&self) -> [f64; 2] {
        let all = self.parts.iter().map(Sliver::heights);
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [from, to]| {
            [low.min(from), high.max(to)]
        })
    }

    fn meeting(&self, [low, high]: [f64; 2]) -> impl Iterator<Item = &Sliver> {
        let meets = move |own: &&Sliver| own.heights()[0] <= high && own.heights()[1] >= low;
        self.parts.iter().filter(meets)
    }

    /// Where something between two heights is divided that is off by so much, at most, at a height.
    fn division(&self, [low, high]: [f64; 2], most: Option<(f64, f64)>) -> Option<f64> {
        let (off, at) = most?;
        let is_inner = at - low > self.flat && high - at > self.flat;
        let at = if is_inner { at } else { 0.5 * (low + high) };
        (off > 2.0 * self.tolerance && high - low > 2.0 * self.flat).then_some(at)
    }

    fn samples(&self, [low, high]: [f64; 2]) -> impl Iterator<Item = &Sample> {
        let within = move |sample: &&Sample| sample.height >= low && sample.height <= high;
        self.samples.iter().filter(within)
    }
}

impl Tool {
    /// Convex solids of revolution that hold the tool, and that it holds: few, and close to it where it is one of
    /// revolution, but for hollows about its axis.
    ///
    /// ```
    /// use sweepsim_motion::Tool;
    /// let ball = Tool::ball(3.0, 10.0)?;
    /// let bounds = ball.bounds();
    /// let radius = |solid: &[[f64; 2]]| solid.iter().map(|corner| corner[0]).fold(0.0, f64::max);
    /// assert!((3.0..3.001).contains(&radius(&bounds.hulls[0])));
    /// assert!((2.999..=3.0).contains(&radius(&bounds.cores[0])));
    /// # Ok::<(), sweepsim_motion::ProfileError>(())
    /// ```
    #[must_use]
    pub fn bounds(&self) -> &Bounds {
        self.bounds.get_or_init(|| {
            let surface = Surface::new(self);
            Bounds {
                hulls: hulls::hulls(&surface),
                cores: cores::cores(&surface),
            }
        })
    }
}
