//! Where `g` can vanish, if it is steep along a side of a cell.

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
