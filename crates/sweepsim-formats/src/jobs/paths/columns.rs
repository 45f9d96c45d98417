//! What is known of each move or pose of a path, in little memory: programs have millions of them.

use super::Origin;
use sweepsim_motion::PackedRows;

/// A yes or no for each move.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Flags {
    words: Vec<u64>,
    length: usize,
}

impl Flags {
    /// Appends a flag.
    pub fn push(&mut self, flag: bool) {
        let bit = self.length % 64;
        if bit == 0 {
            self.words.push(0);
        }
        if let (true, Some(word)) = (flag, self.words.last_mut()) {
            *word |= 1 << bit;
        }
        self.length += 1;
    }

    /// The number of moves.
    #[must_use]
    pub fn len(&self) -> usize {
        self.length
    }

    /// Whether nothing is known of any move.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// Whether it is so in a move; no beyond the last.
    #[must_use]
    pub fn get(&self, number: usize) -> bool {
        number < self.length && self.words[number / 64] >> (number % 64) & 1 == 1
    }

    /// The number of moves in which it is so.
    #[must_use]
    pub fn count(&self) -> usize {
        self.words.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Of all moves in order.
    pub fn iter(&self) -> impl Iterator<Item = bool> + '_ {
        (0..self.length).map(|number| self.get(number))
    }
}

impl FromIterator<bool> for Flags {
    fn from_iter<I: IntoIterator<Item = bool>>(flags: I) -> Self {
        let mut made = Self::default();
        flags.into_iter().for_each(|flag| made.push(flag));
        made
    }
}

/// How long each move takes, in seconds, as far as that is known.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Seconds(PackedRows<1>);

impl Seconds {
    /// Appends a move.
    pub fn push(&mut self, seconds: Option<f64>) {
        self.0.push([seconds.unwrap_or(f64::NAN)]);
    }

    /// The number of moves.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether nothing is known of any move.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Of a move; `None` beyond the last, too.
    #[must_use]
    pub fn get(&self, number: usize) -> Option<f64> {
        self.0.get(number).and_then(known)
    }

    /// Of all moves in order.
    pub fn iter(&self) -> impl Iterator<Item = Option<f64>> + '_ {
        self.0.iter().map(known)
    }
}

fn known([seconds]: [f64; 1]) -> Option<f64> {
    (!seconds.is_nan()).then_some(seconds)
}

impl FromIterator<Option<f64>> for Seconds {
    fn from_iter<I: IntoIterator<Item = Option<f64>>>(all: I) -> Self {
        let mut made = Self::default();
        all.into_iter().for_each(|seconds| made.push(seconds));
        made
    }
}

/// Where each pose comes from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Origins(PackedRows<3>);

impl Origins {
    /// Appends a pose.
    pub fn push(&mut self, origin: Origin) {
        let call = origin.call.map_or(0.0, |call| f64::from(call) + 1.0);
        self.0.push([origin.file as f64, origin.line as f64, call]);
    }

    /// The number of poses.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether nothing is known of any pose.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Of a pose; `None` beyond the last.
    #[must_use]
    pub fn get(&self, pose: usize) -> Option<Origin> {
        self.0.get(pose).map(origin)
    }

    /// Of the first pose.
    #[must_use]
    pub fn first(&self) -> Option<Origin> {
        self.get(0)
    }

    /// Of the last pose.
    #[must_use]
    pub fn last(&self) -> Option<Origin> {
        self.get(self.len().checked_sub(1)?)
    }

    /// Of all poses in order.
    pub fn iter(&self) -> impl Iterator<Item = Origin> + '_ {
        self.0.iter().map(origin)
    }
}

fn origin([file, line, call]: [f64; 3]) -> Origin {
    Origin {
        file: file as usize,
        line: line as usize,
        call: (call > 0.0).then_some((call - 1.0) as u32),
    }
}

impl FromIterator<Origin> for Origins {
    fn from_iter<I: IntoIterator<Item = Origin>>(all: I) -> Self {
        let mut made = Self::default();
        all.into_iter().for_each(|origin| made.push(origin));
        made
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_hold_what_was_put_in() {
        let flags: Vec<bool> = (0..300).map(|k| k % 7 == 0 || k % 64 == 63).collect();
        let kept: Flags = flags.iter().copied().collect();
        assert!(kept.iter().eq(flags.iter().copied()) && kept.len() == 300);
        assert_eq!(kept.count(), flags.iter().filter(|flag| **flag).count());
        assert!(kept.get(63) && !kept.get(64) && !kept.get(300));
        let times: Vec<Option<f64>> = (0..300).map(|k| (k % 5 != 0).then(|| f64::from(k).sqrt())).collect();
        let kept: Seconds = times.iter().copied().collect();
        assert!(kept.iter().eq(times.iter().copied()));
        assert_eq!(
            [kept.get(7), kept.get(5), kept.get(300)],
            [Some(7_f64.sqrt()), None, None]
        );
        let origin = |k: usize| Origin {
            file: k / 100,
            line: 3 * k + 1,
            call: (k % 3 == 1).then_some(k as u32),
        };
        let kept: Origins = (0..300).map(origin).collect();
        assert!(kept.iter().eq((0..300).map(origin)));
        assert_eq!(
            (kept.first(), kept.get(123), kept.last()),
            (Some(origin(0)), Some(origin(123)), Some(origin(299)))
        );
        assert_eq!((kept.get(300), Origins::default().last()), (None, None));
    }
}
