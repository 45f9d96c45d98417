//! The largest deviations of a surface, and their means.

use super::DistanceRange;
use super::samples::SampleDeviation;

/// The largest deviation to one side.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct DeviationAt {
    /// The largest distance that is certain.
    pub least: f64,
    /// What the largest distance may be: `least`, if all distances are known.
    pub most: f64,
    /// Where `least` is; where `most` is, if no deviation is certain.
    pub place: [f64; 3],
}

/// How far one surface is from another.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct SurfaceDeviations {
    /// The largest distance inside the other surface, if any is beyond the tolerance.
    pub inside: Option<DeviationAt>,
    /// The largest distance outside of it.
    pub outside: Option<DeviationAt>,
    /// The range of the mean over the area, positive outside.
    pub mean: [f64; 2],
    /// The range of the root mean square over the area.
    pub rms: [f64; 2],
    /// The area of the surface. Walls that may be anywhere between two lines count by the mean over their directions.
    pub area: f64,
    /// All points that were looked at, in a fixed order.
    pub points: Vec<SurfacePoint>,
}

/// A point of a surface, and its distance from the other one.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SurfacePoint {
    /// Where it is.
    pub place: [f64; 3],
    /// Its distance.
    pub distance: DistanceRange,
    /// The area that it stands for; 0 for one that is only there for the largest distance.
    pub area: f64,
}

impl SurfaceDeviations {
    /// The least and the most that the largest distance may be, to either side.
    #[must_use]
    pub fn largest(&self) -> [f64; 2] {
        let sides = self.inside.iter().chain(&self.outside);
        sides.fold([0.0_f64; 2], |[least, most], at| {
            [least.max(at.least), most.max(at.most)]
        })
    }

    /// Where the largest distance is that is certain; if none is, where one may be. `None` if there is none.
    #[must_use]
    pub fn place(&self) -> Option<[f64; 3]> {
        let larger = |a: DeviationAt, b: DeviationAt| {
            if [b.least, b.most] > [a.least, a.most] { b } else { a }
        };
        self.inside
            .into_iter()
            .chain(self.outside)
            .reduce(larger)
            .map(|at| at.place)
    }

    /// Of samples in a fixed order.
    pub(super) fn of(found: Vec<SampleDeviation>, tolerance: f64) -> Self {
        let mut all = Self::default();
        let (mut sums, mut squares) = ([0.0; 2], [0.0; 2]);
        for SampleDeviation { place, range, area } in found {
            let size = range.size();
            for (k, (sum, square)) in sums.iter_mut().zip(&mut squares).enumerate() {
                *sum += area * [range.low, range.high][k];
                *square += area * size[k] * size[k];
            }
            all.area += area;
            let distance = range;
            all.points.push(SurfacePoint { place, distance, area });
            let DistanceRange { low, high } = range;
            for (side, [least, most]) in [(&mut all.inside, [-high, -low]), (&mut all.outside, [low, high])] {
                // Not greater: nothing, or a NaN.
                if !(most > tolerance) {
                    continue;
                }
                let least = if least > tolerance { least } else { 0.0 };
                let here = DeviationAt { least, most, place };
                let at = side.get_or_insert(here);
                if least > at.least || (least == 0.0 && at.least == 0.0 && most > at.most) {
                    at.place = place;
                }
                at.least = at.least.max(least);
                at.most = at.most.max(most);
            }
        }
        if all.area > 0.0 {
            all.mean = sums.map(|sum| sum / all.area);
            all.rms = squares.map(|square| (square / all.area).sqrt());
        }
        all
    }
}
