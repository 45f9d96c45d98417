//! Guesses where the next solution is, from those of its neighbours on a lattice.

/// The number of solutions that a guess uses, along a row or across rows.
const DEPTH: usize = 5;

/// The coefficients, nearest first, of the polynomial through `k` equally spaced places, at the next one: `Σ (−1)ⁿ⁺¹ (k over n) xₙ`.
const EXTRAPOLATION: [&[f64]; DEPTH + 1] = [
    &[],
    &[1.0],
    &[2.0, -1.0],
    &[3.0, -3.0, 1.0],
    &[4.0, -6.0, 4.0, -1.0],
    &[5.0, -10.0, 10.0, -5.0, 1.0],
];

/// How many places a row is extended backwards when the next row begins, since that one may begin earlier.
const BEFORE: usize = 3;

/// Rows have room for as many places at first.
const USUAL: usize = 16;

/// The polynomial through `count` places, nearest first, at the next one.
fn extrapolate<const N: usize>(count: usize, place: impl Fn(usize) -> [f64; N]) -> [f64; N] {
    let mut sum = [0.0; N];
    for (n, factor) in EXTRAPOLATION[count].iter().enumerate() {
        let s = place(n);
        for i in 0..N {
            sum[i] += factor * s[i];
        }
    }
    sum
}

/// The solutions of a row, from its first place on.
#[derive(Debug)]
struct Row<const N: usize> {
    number: usize,
    /// [`BEFORE`] places before that of the first solution. Places are counted from there, so that there are some before 0.
    first: usize,
    /// NaN where nothing was found.
    found: Vec<[f64; N]>,
    /// The number of consecutive solutions found last.
    run: usize,
}

impl<const N: usize> Row<N> {
    /// Extends the row backwards.
    fn close(&mut self) {
        let solutions = self.found[BEFORE..].iter().take_while(|s| !s[0].is_nan());
        let count = solutions.take(DEPTH).count();
        if count < 2 {
            return;
        }
        for place in (0..BEFORE).rev() {
            self.found[place] = extrapolate(count, |n| self.found[place + 1 + n]);
        }
    }
}

/// The solutions in the last rows of a lattice.
#[derive(Debug)]
pub(crate) struct Trail<const N: usize> {
    /// In order; the latest comes last.
    rows: Vec<Row<N>>,
}

impl<const N: usize> Trail<N> {
    pub fn new() -> Self {
        Self {
            rows: Vec::with_capacity(DEPTH + 1),
        }
    }

    pub fn push(&mut self, [number, place]: [usize; 2], s: [f64; N]) {
        let place = place + BEFORE;
        match self.rows.last_mut() {
            Some(row) if row.number == number && place >= row.first => {
                if row.found.len() < place - row.first {
                    row.found.resize(place - row.first, [f64::NAN; N]);
                    row.run = 0;
                }
                row.found.push(s);
                row.run += 1;
            }
            _ => {
                if let Some(row) = self.rows.last_mut() {
                    row.close();
                }
                let mut found = if self.rows.len() > DEPTH {
                    self.rows.remove(0).found
                } else {
                    Vec::with_capacity(USUAL)
                };
                found.clear();
                found.resize(BEFORE, [f64::NAN; N]);
                found.push(s);
                self.rows.push(Row {
                    number,
                    first: place - BEFORE,
                    found,
                    run: 1,
                });
            }
        }
    }

    /// The solution `back` rows before row `number`.
    fn at(&self, number: usize, back: usize, place: usize) -> Option<&[f64; N]> {
        let wanted = number.checked_sub(back)?;
        let row = self.rows.iter().rev().take(back + 1).find(|row| row.number == wanted)?;
        let s = row.found.get(place.checked_sub(row.first)?)?;
        (!s[0].is_nan()).then_some(s)
    }

    /// Predicts the solution at this place of the lattice.
    pub fn guess(&self, [number, place]: [usize; 2]) -> Option<[f64; N]> {
        let place = place + BEFORE;
        let row = self.rows.last()?;
        let in_row = if row.number == number && row.first + row.found.len() == place {
            row.run.min(DEPTH)
        } else {
            0
        };
        let across = |n: usize| self.at(number, n, place);
        let mut in_column = 0;
        if in_row < DEPTH {
            in_column = (1..=DEPTH).take_while(|n| across(*n).is_some()).count();
        }
        let most = in_row.max(in_column);
        if most < 2 {
            return None;
        }
        if in_row >= in_column {
            let last = row.found.len() - 1;
            return Some(extrapolate(most, |n| row.found[last - n]));
        }
        Some(extrapolate(most, |n| across(n + 1).copied().unwrap_or([f64::NAN; N])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A polynomial of degree 4 in each direction.
    fn solution(row: f64, place: f64) -> [f64; 2] {
        let (x, y) = (0.1 * row, 0.1 * place);
        [1.0 + x - y * y * y * y + x * y, x * x * x * x - 2.0 * y * y + x * x]
    }

    #[test]
    fn guesses_are_exact_for_polynomials_along_and_across_rows() {
        let mut trail: Trail<2> = Trail::new();
        let mut guessed = 0;
        for row in 0..12_usize {
            // Each row begins earlier than the one before, the first places being 0 in the end.
            let first = 11 - row;
            for place in first..20 {
                let exact = solution(row as f64, place as f64);
                if let Some(guess) = trail.guess([row, place]) {
                    // The fifth row before this one is continued to two places after the first of this one.
                    let deep = (row >= 5 && place >= first + 2) || place >= first + 5;
                    let off = (guess[0] - exact[0]).abs().max((guess[1] - exact[1]).abs());
                    assert!(!deep || off < 1e-12, "row {row}, place {place}: {off:e}");
                    guessed += 1;
                }
                trail.push([row, place], exact);
            }
        }
        assert!(guessed > 150);
    }

    #[test]
    fn nothing_is_guessed_over_a_gap() {
        let mut trail: Trail<1> = Trail::new();
        trail.push([3, 7], [1.0]);
        assert_eq!(trail.guess([3, 8]), None);
        trail.push([3, 8], [2.0]);
        assert_eq!(trail.guess([3, 9]), Some([3.0]));
        assert_eq!(trail.guess([3, 10]), None);
        assert_eq!(trail.guess([4, 8]), None);
        trail.push([3, 10], [4.0]);
        assert_eq!(trail.guess([3, 11]), None);
    }
}
