//! Sides of patches that have shrunk to a point: where `g` can vanish beside them, and how they are searched apart from the rest.

use crate::time::over::DyadicInterval;
use smallvec::SmallVec;

type Range = (f64, f64);

/// The part of the side of a box outside which a function has a sign, if it is steep along the side: it is at least `lo` at one end and at most `hi` at the other,
/// and changes at least as `slope` says.
pub(super) fn with_zeros((start, end): Range, values: Range, slope: Range) -> Range {
    /// Of the domain's sides: far below what matters, far above rounding.
    const LEAST: f64 = 1e-13;
    let steepness = slope.0.max(-slope.1);
    if !(steepness > 0.0) {
        return (start, end);
    }
    let reach = |value: f64| value / steepness + LEAST;
    // Where it grows, from the start it takes at most this to grow from its least value to 0, and from 0 to its largest to the end.
    let [near, far] = if slope.0 > 0.0 {
        [-values.0, values.1]
    } else {
        [values.1, -values.0]
    };
    let (lower, upper) = ((end - reach(far)).max(start), (start + reach(near)).min(end));
    // NaN, or no zero, which rounding may hide.
    if lower < upper { (lower, upper) } else { (start, end) }
}

/// The most parts of a patch beside its poles.
const SIDES: usize = 4;

/// A patch without what is beside its poles, and the parts of it that are.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Apart {
    pub rest: [DyadicInterval; 2],
    pub beside: SmallVec<[[DyadicInterval; 2]; SIDES]>,
}

impl Apart {
    /// With poles at the lower and the upper side in each variable.
    pub fn new(poles: &[[bool; 2]; 2]) -> Self {
        /// Of the patch's side. All numbers are exact.
        const NEAR: f64 = 1.0 / 16.0;
        let (mut rest, mut beside) = ([DyadicInterval::WHOLE; 2], SmallVec::new());
        for axis in 0..2 {
            for (upper, _) in [false, true]
                .into_iter()
                .zip(poles[axis])
                .filter(|(_, is_pole)| *is_pole)
            {
                let mut part = rest;
                part[axis].length = NEAR;
                rest[axis].length -= NEAR;
                if upper {
                    part[axis].from = 1.0 - NEAR;
                } else {
                    rest[axis].from = NEAR;
                }
                beside.push(part);
            }
        }
        Self { rest, beside }
    }
}

/// The direction towards the pole, in a cell that has one.
pub(crate) fn pole(poles: &[[bool; 2]; 2], sides: [Range; 2]) -> Option<usize> {
    (0..2).find(|axis| {
        let (start, end) = sides[*axis];
        let [lower, upper] = poles[*axis];
        (lower && start == 0.0) || (upper && end == 1.0)
    })
}

/// What is left of a cell at a pole, which is all that has zeros of `g`, if that is much less.
///
/// If a tip moves level, `g` is 0 all along its pole, and steep across it in all directions but those along the tip's way: only the pole is left. `look` gives ranges of `g` and of its
/// derivatives in a cell with these sides; `None` if `g` has a sign there.
pub(crate) fn at_pole(
    poles: &[[bool; 2]; 2],
    mut sides: [Range; 2],
    (mut g, mut slopes): (Range, [Range; 2]),
    mut look: impl FnMut([Range; 2]) -> Option<(Range, [Range; 2])>,
) -> Option<[Range; 2]> {
    /// Of the side, at each step.
    const SMALL: f64 = 0.125;
    let axis = pole(poles, sides)?;
    let mut part = None;
    loop {
        let (start, end) = sides[axis];
        let (lower, upper) = with_zeros((start, end), g, slopes[axis]);
        if !(upper - lower < SMALL * (end - start)) {
            return part;
        }
        sides[axis] = (lower, upper);
        part = Some(sides);
        let Some(found) = look(sides) else { return part };
        (g, slopes) = found;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::*;

    proptest! {
        /// Each point of a patch is in exactly one part, but for those between two; points beside poles are in parts beside poles.
        #[test]
        fn parts_fill_the_patch(poles in [[any::<bool>(), any::<bool>()], [any::<bool>(), any::<bool>()]], at in [0.0..1.0_f64, 0.0..1.0_f64]) {
            let Apart { rest, beside } = Apart::new(&poles);
            let holds = |part: &[DyadicInterval; 2]| (0..2).all(|axis| part[axis].from <= at[axis] && at[axis] < part[axis].to());
            let others = beside.iter().filter(|part| holds(part)).count();
            prop_assert_eq!(usize::from(holds(&rest)) + others, 1);
            let near = (0..2).any(|axis| (poles[axis][0] && at[axis] < 0.0625) || (poles[axis][1] && at[axis] >= 0.9375));
            prop_assert_eq!(near, others == 1);
        }
    }
}
