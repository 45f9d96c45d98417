//! Guesses where the next solution is, from those of its neighbours on a lattice.

use nalgebra::SVector;

/// Solutions that a guess takes into account, along a row or across rows.
const DEPTH: usize = 5;

/// The coefficients, nearest first, of the polynomial through `k` even places, at the next one: `Σ (−1)ⁿ⁺¹ (k over n) xₙ`.
const EXTRAPOLATION: [&[f64]; DEPTH + 1] = [
    &[],
    &[1.0],
    &[2.0, -1.0],
    &[3.0, -3.0, 1.0],
    &[4.0, -6.0, 4.0, -1.0],
    &[5.0, -10.0, 10.0, -5.0, 1.0],
];

/// Places before the first of a row that it is continued to, when the next begins: that one may begin earlier.
const BEFORE: usize = 3;

/// What was found in a row, from its first place on.
#[derive(Debug)]
struct Row<const N: usize> {
    number: usize,
    /// [`BEFORE`] places before that of the first solution. Places are counted from there, so that there are some before 0.
    first: usize,
    /// NaN where nothing was found.
    found: Vec<SVector<f64, N>>,
    /// So many of the last were found one after the other.
    run: usize,
}

impl<const N: usize> Row<N> {
    /// Continues the row backwards.
    fn close(&mut self) {
        let solutions = self.found[BEFORE..].iter().take_while(|s| !s[0].is_nan());
        let count = solutions.take(DEPTH).count();
        if count < 2 {
            return;
        }
        for place in (0..BEFORE).rev() {
            let factors = EXTRAPOLATION[count].iter().enumerate();
            self.found[place] = factors.map(|(n, factor)| self.found[place + 1 + n] * *factor).sum();
        }
    }
}

/// The solutions in the last rows of a lattice.
#[derive(Debug)]
pub(crate) struct Trail<const N: usize> {
    /// The latest last.
    rows: Vec<Row<N>>,
}

impl<const N: usize> Trail<N> {
    pub fn new() -> Self {
        Self { rows: Vec::new() }
    }

    pub fn push(&mut self, [number, place]: [usize; 2], s: SVector<f64, N>) {
        let place = place + BEFORE;
        match self.rows.last_mut() {
            Some(row) if row.number == number && place >= row.first => {
                if row.found.len() < place - row.first {
                    row.found.resize(place - row.first, SVector::repeat(f64::NAN));
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
                    Vec::new()
                };
                found.clear();
                found.resize(BEFORE, SVector::repeat(f64::NAN));
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
    fn at(&self, number: usize, back: usize, place: usize) -> Option<&SVector<f64, N>> {
        let wanted = number.checked_sub(back)?;
        let row = self.rows.iter().rev().take(back + 1).find(|row| row.number == wanted)?;
        let s = row.found.get(place.checked_sub(row.first)?)?;
        (!s[0].is_nan()).then_some(s)
    }

    /// Where the solution at this place of the lattice should be.
    pub fn guess(&self, [number, place]: [usize; 2]) -> Option<SVector<f64, N>> {
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
        let factors = EXTRAPOLATION[most].iter();
        if in_row >= in_column {
            let last = row.found.iter().rev();
            return Some(last.zip(factors).map(|(s, factor)| s * *factor).sum());
        }
        factors.zip(1..).map(|(factor, n)| Some(across(n)? * *factor)).sum()
    }
}
