//! Guesses where the next solution of a chart is, from those of its neighbours on the lattice of targets and from how they depend on their targets.

use smallvec::SmallVec;

/// A solution, of a target with these first two values. (If it has only one, that is the second.)
#[derive(Clone, Copy, Debug)]
pub(super) struct Solution<const N: usize> {
    pub s: [f64; N],
    pub q: [f64; 2],
    /// `∂s/∂q` by the first value and by the second: across rows and along them.
    pub slopes: [[f64; N]; 2],
}

const ACROSS: usize = 0;
const ALONG: usize = 1;

/// A solution this many places from the next target is no guess any more.
const FAR: usize = 4;

impl<const N: usize> Solution<N> {
    /// To first order.
    fn tangent(&self, q: &[f64; 2]) -> [f64; N] {
        let step = [q[0] - self.q[0], q[1] - self.q[1]];
        std::array::from_fn(|i| self.s[i] + self.slopes[0][i] * step[0] + self.slopes[1][i] * step[1])
    }

    /// The cubic through the last two of three evenly spaced solutions and their slopes, at the next one: its error is a sixth of the fourth difference.
    fn cubic(&self, before: &Self, axis: usize) -> [f64; N] {
        let step = self.q[axis] - before.q[axis];
        std::array::from_fn(|i| {
            let slopes = 4.0 * self.slopes[axis][i] + 2.0 * before.slopes[axis][i];
            5.0 * before.s[i] - 4.0 * self.s[i] + step * slopes
        })
    }
}

/// The solutions of a row.
#[derive(Debug)]
struct Row<const N: usize> {
    number: usize,
    /// The place of the first one.
    first: usize,
    found: SmallVec<[Option<Solution<N>>; 6]>,
}

impl<const N: usize> Row<N> {
    fn at(&self, place: usize) -> Option<&Solution<N>> {
        self.found.get(place.checked_sub(self.first)?)?.as_ref()
    }

    /// The solution nearest to a place before or behind all of them.
    fn nearest(&self, place: usize) -> Option<&Solution<N>> {
        let last = self.first + self.found.len() - 1;
        let nearest = place.clamp(self.first, last);
        (nearest.abs_diff(place) < FAR).then(|| self.at(nearest)).flatten()
    }
}

/// A row, and the two that are across from it.
const ROWS: usize = 3;

/// The solutions in the latest rows in which there are any.
#[derive(Debug)]
pub(super) struct Neighbours<const N: usize> {
    /// In order; the latest comes last.
    rows: SmallVec<[Row<N>; ROWS]>,
}

impl<const N: usize> Neighbours<N> {
    pub fn new() -> Self {
        Self { rows: SmallVec::new() }
    }

    /// Rows, and places in a row, come in order.
    pub fn push(&mut self, [number, place]: [usize; 2], solution: Solution<N>) {
        match self.rows.last_mut() {
            Some(row) if row.number == number && place >= row.first + row.found.len() => {
                row.found.resize(place - row.first, None);
                row.found.push(Some(solution));
            }
            _ => {
                if self.rows.len() == ROWS {
                    self.rows.remove(0);
                }
                self.rows.push(Row {
                    number,
                    first: place,
                    found: SmallVec::from_elem(Some(solution), 1),
                });
            }
        }
    }

    fn row(&self, number: usize) -> Option<&Row<N>> {
        self.rows.iter().rev().find(|row| row.number == number)
    }

    /// Predicts the solution of the target at this place, whose first two values are these: from two neighbours in the row or across rows, or else from one.
    pub fn guess(&self, [number, place]: [usize; 2], q: &[f64; 2]) -> Option<[f64; N]> {
        let latest = self.rows.last()?;
        let own = (latest.number == number).then_some(latest);
        let in_row = |back: usize| own?.at(place.checked_sub(back)?);
        let beside = in_row(1);
        if let (Some(last), Some(before)) = (beside, in_row(2)) {
            return Some(last.cubic(before, ALONG));
        }
        let across = |back: usize| self.row(number.checked_sub(back)?);
        let previous = across(1);
        let below = previous.and_then(|row| row.at(place));
        if let (Some(below), Some(before)) = (below, across(2).and_then(|row| row.at(place))) {
            return Some(below.cubic(before, ACROSS));
        }
        if let Some(last) = beside {
            let mut guess = last.tangent(q);
            // The second difference is about that of the row before.
            if let (Some(next), Some(of_last)) = (below, previous.and_then(|row| row.at(place - 1))) {
                let half = 0.5 * (q[ALONG] - last.q[ALONG]);
                for i in 0..N {
                    guess[i] += half * (next.slopes[ALONG][i] - of_last.slopes[ALONG][i]);
                }
            }
            return Some(guess);
        }
        let near = below.or_else(|| own.or(previous).and_then(|row| row.nearest(place)));
        Some(near?.tangent(q))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 0.1;

    /// A cubic in each direction.
    fn solution(row: f64, place: f64) -> Solution<2> {
        let q = [STEP * row, STEP * place];
        let [x, y] = q;
        Solution {
            s: [1.0 + x - y * y * y + x * y, x * x * x - 2.0 * y * y],
            q,
            slopes: [[1.0 + y, 3.0 * x * x], [x - 3.0 * y * y, -4.0 * y]],
        }
    }

    #[test]
    fn guesses_are_exact_for_cubics_along_and_across_rows() {
        let mut known = Neighbours::new();
        let mut guessed = 0;
        for row in 0..12_usize {
            // Each row begins earlier than the one before, the first places being 0 in the end.
            let first = 11 - row;
            for place in first..20 {
                let exact = solution(row as f64, place as f64);
                let guess = known.guess([row, place], &exact.q);
                assert_eq!(guess.is_none(), row == 0 && place == first);
                if let Some(guess) = guess {
                    let off = (guess[0] - exact.s[0]).abs().max((guess[1] - exact.s[1]).abs());
                    // From two neighbours in the row, or in the rows before, which begin two places later.
                    let two = place >= first + 2;
                    let most = if two { 1e-13 } else { 8.0 * STEP * STEP };
                    assert!(off < most, "row {row}, place {place}: {off:e}");
                    guessed += 1;
                }
                known.push([row, place], exact);
            }
        }
        assert!(guessed > 150);
    }

    #[test]
    fn the_second_place_of_a_row_knows_the_second_difference_of_the_row_before() {
        let mut known = Neighbours::new();
        let at = |row: usize, place: usize| solution(row as f64, place as f64);
        for [row, place] in [[3, 7], [3, 8], [4, 7]] {
            known.push([row, place], at(row, place));
        }
        let exact = at(4, 8);
        let guess = known.guess([4, 8], &exact.q).unwrap();
        let third = STEP * STEP * STEP;
        assert!((guess[0] - exact.s[0]).abs() < 2.0 * third && (guess[1] - exact.s[1]).abs() < 1e-13);
    }

    #[test]
    fn nothing_is_guessed_from_afar() {
        let mut known = Neighbours::new();
        let at = |row: usize, place: usize| solution(row as f64, place as f64);
        let guess = |known: &Neighbours<2>, row: usize, place: usize| known.guess([row, place], &at(row, place).q);
        known.push([3, 7], at(3, 7));
        assert_eq!(guess(&known, 3, 8), Some(at(3, 7).tangent(&at(3, 8).q)));
        assert_eq!(guess(&known, 3, 7 + FAR), None);
        assert_eq!(guess(&known, 4, 9), Some(at(3, 7).tangent(&at(4, 9).q)));
        assert_eq!(guess(&known, 5, 7), None);
        known.push([3, 10], at(3, 10));
        assert_eq!(guess(&known, 3, 11), Some(at(3, 10).tangent(&at(3, 11).q)));
        // Beside a gap.
        assert_eq!(guess(&known, 4, 8), None);
    }
}
