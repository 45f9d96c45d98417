//! The fastest course of the speed along stretches that follow one another, from rest to rest.

use std::ops::Range;

use sweepsim_motion::PackedRows;

use super::MoveTime;
use super::hills;
use super::stretch::Stretch;

/// How long stretches take, where the speed is nowhere larger than it may be and changes as fast as it may.
///
/// The squares of the speeds at the ends of stretches are the largest with `v² ≤ w² + 2 a L` between neighbours: one pass against the path for what
/// it must brake to, and one along it for what it can reach. That is the look-ahead of Grbl's planner, over the whole path. Stretches are kept from where it
/// may still have to brake for what follows; all but the last of them are packed, and looked at part by part.
///
/// A control that averages speeds over a time `T` comes down to a speed `u` between stretches of larger speeds, up to
/// `P` on the slower of them, only if it stays at `u` for `T`: that takes `T (1 − u/P)` longer, and `T` from rest to
/// rest. It is counted in the stretch that begins there.
///
/// Where the jerk is bounded, the course is that of [`hills`], and no time is known before the rest.
#[derive(Debug, Default)]
pub(super) struct Profile {
    /// Over how many seconds speeds are averaged.
    smoothing: f64,
    /// The largest speed on the stretch whose time was given last, if nothing rested since.
    peak: Option<f64>,
    packed: PackedRows<7>,
    /// The last stretches.
    open: Vec<Stretch>,
    /// The square of the speed at the start of the first of them.
    entry: f64,
    /// Whether the jerk may be bounded.
    has_jerk: bool,
    /// So many were left when it was last looked for those that are settled.
    left: usize,
}

/// So many more stretches are looked at together.
const LOOK: usize = 1024;
/// So many stretches are not packed: mostly, fewer are kept.
const OPEN: usize = 1 << 14;
/// So many stretches are unpacked at a time.
const PART: usize = 1 << 11;

impl Profile {
    /// Of a control that averages speeds over so many seconds, with axes whose jerk may be bounded.
    pub fn new(smoothing: f64, has_jerk: bool) -> Self {
        Self {
            smoothing,
            has_jerk,
            ..Self::default()
        }
    }

    /// The number of stretches whose times are not known yet.
    pub fn len(&self) -> usize {
        self.packed.len() + self.open.len()
    }

    /// Appends a stretch.
    pub fn push(&mut self, stretch: Stretch) {
        if self.open.len() == OPEN {
            self.packed.extend(self.open.drain(..).map(Stretch::row));
        }
        self.open.push(stretch);
    }

    /// Gives the times of the first moves, as far as nothing that follows can change them; mostly none.
    pub fn settled(&mut self, each: impl FnMut(MoveTime)) {
        // It takes as long as there are stretches.
        if self.has_jerk || self.len() < LOOK + 2 * self.left {
            return;
        }
        let last = self.open.last().map_or(0.0, |stretch| stretch.speed);
        // Whatever the speed is at the end, what must be braked to lies between these.
        let (mut slow, mut fast) = (0.0, last * last);
        let mut count = self.len();
        'all: for part in parts(self.len()).rev() {
            let stretches = self.stretches(part);
            for (before, stretch) in stretches.pairs().rev() {
                if slow == fast {
                    break 'all;
                }
                (slow, fast) = (
                    self.to_brake_to(before, stretch, slow),
                    self.to_brake_to(before, stretch, fast),
                );
                count -= 1;
            }
        }
        self.take(count, slow, each);
        self.left = self.len();
    }

    /// Gives the times of all moves, after which there is a rest.
    pub fn rest(&mut self, each: impl FnMut(MoveTime)) {
        if self.has_jerk {
            self.pass(each);
        } else {
            self.take(self.len(), 0.0, each);
        }
        (self.entry, self.left, self.peak) = (0.0, 0, None);
    }

    /// Takes all stretches away, whose jerk may be bounded.
    fn pass(&mut self, mut each: impl FnMut(MoveTime)) {
        let count = self.len();
        let Stretches { stretches, .. } = self.stretches(0..count);
        let mut squares = vec![0.0; count + 1];
        for k in (0..count).rev() {
            let before = k.checked_sub(1).map(|before| &stretches[before]);
            squares[k] = self.to_brake_to(before, &stretches[k], squares[k + 1]);
        }
        for (k, stretch) in stretches.iter().enumerate() {
            squares[k + 1] = squares[k + 1].min(squares[k] + stretch.gain());
        }
        for (stretch, passed) in stretches.iter().zip(hills::passed(&stretches, &squares)) {
            each(stretch.time(passed.seconds, self.dip(passed.start, passed.peak)));
            self.peak = Some(passed.peak);
        }
        self.packed = PackedRows::default();
        self.open.clear();
    }

    /// The largest square of the speed at the start of a stretch from which it can brake to that at its end.
    fn to_brake_to(&self, before: Option<&Stretch>, stretch: &Stretch, end: f64) -> f64 {
        let most = match before {
            None => self.entry,
            Some(before) => {
                let speed = before.speed.min(stretch.speed);
                stretch.corner.min(speed * speed)
            }
        };
        most.min(end + stretch.gain())
    }

    /// How much longer the speed between the last stretch and one with this largest speed makes it.
    fn dip(&self, speed: f64, peak: f64) -> f64 {
        let slower = self.peak.map_or(peak, |last| last.min(peak));
        if slower.is_finite() {
            self.smoothing * (1.0 - speed.min(slower) / slower)
        } else {
            0.0
        }
    }

    /// Takes the first stretches away, with the square of the speed that can be braked to at the end of the last of them.
    fn take(&mut self, count: usize, end: f64, mut each: impl FnMut(MoveTime)) {
        let parts = parts(count);
        // What can be braked to at the end of each part.
        let mut ends = vec![end; parts.len()];
        for (k, part) in parts.clone().enumerate().skip(1).rev() {
            let stretches = self.stretches(part);
            let brakes = |end, (before, stretch): (Option<&Stretch>, &Stretch)| self.to_brake_to(before, stretch, end);
            ends[k - 1] = stretches.pairs().rev().fold(ends[k], brakes);
        }
        let mut start = None;
        for (part, end) in parts.zip(ends) {
            let stretches = self.stretches(part);
            let mut squares = vec![end];
            for (before, stretch) in stretches.pairs().rev() {
                squares.push(self.to_brake_to(before, stretch, squares[squares.len() - 1]));
            }
            squares.reverse();
            squares[0] = start.unwrap_or(squares[0]);
            for (k, (_, stretch)) in stretches.pairs().enumerate() {
                squares[k + 1] = squares[k + 1].min(squares[k] + stretch.gain());
                let ends = [squares[k], squares[k + 1]];
                let peak = stretch.peak(ends);
                each(stretch.time(stretch.seconds(ends), self.dip(squares[k].sqrt(), peak)));
                self.peak = Some(peak);
            }
            start = squares.pop();
        }
        self.entry = start.unwrap_or(self.entry);
        let packed = count.min(self.packed.len());
        if packed == self.packed.len() {
            self.packed = PackedRows::default();
        } else if packed > 0 {
            self.packed = std::mem::take(&mut self.packed).into_iter().skip(packed).collect();
        }
        self.open.drain(..count - packed);
    }

    /// Some stretches, and the one before them.
    fn stretches(&self, numbers: Range<usize>) -> Stretches {
        let from = numbers.start.saturating_sub(1);
        let packed = self.packed.range(from..numbers.end.min(self.packed.len()).max(from));
        let open = |number: usize| number.saturating_sub(self.packed.len());
        let mut stretches = Vec::with_capacity(numbers.end - from);
        stretches.extend(packed.map(Stretch::of_row));
        stretches.extend(&self.open[open(from)..open(numbers.end)]);
        Stretches {
            stretches,
            first: numbers.start - from,
        }
    }
}

/// The numbers of so many stretches, part by part.
fn parts(count: usize) -> impl DoubleEndedIterator<Item = Range<usize>> + ExactSizeIterator + Clone {
    (0..count.div_ceil(PART)).map(move |part| PART * part..count.min(PART * (part + 1)))
}

/// Stretches that follow one another.
struct Stretches {
    stretches: Vec<Stretch>,
    /// 1 if there is another one before them, which is no part of them.
    first: usize,
}

impl Stretches {
    /// Each stretch and the one before it.
    fn pairs(&self) -> impl DoubleEndedIterator<Item = (Option<&Stretch>, &Stretch)> {
        let numbered = self.stretches.iter().enumerate().skip(self.first);
        numbered.map(|(k, stretch)| (k.checked_sub(1).map(|before| &self.stretches[before]), stretch))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::*;

    fn stretch() -> impl Strategy<Value = Stretch> {
        let acceleration = prop_oneof![9 => 1.0..4e3_f64, 1 => Just(f64::INFINITY)];
        let corner = prop_oneof![1 => Just(0.0), 9 => 0.0..1e4_f64, 9 => Just(f64::INFINITY)];
        let rest = prop_oneof![9 => Just(0.0), 1 => 0.0..3.0_f64];
        (1e-3..10.0_f64, 0.1..500.0_f64, corner, acceleration, rest).prop_map(
            |(length, speed, corner, acceleration, rest)| Stretch {
                length,
                speed,
                corner,
                acceleration,
                jerk: f64::INFINITY,
                full: [length / speed, rest],
            },
        )
    }

    /// All at once, by two passes over the whole path.
    fn whole(stretches: &[Stretch], smoothing: f64) -> Vec<MoveTime> {
        let mut squares = vec![0.0; stretches.len() + 1];
        for (k, stretch) in stretches.iter().enumerate().skip(1).rev() {
            let speed = stretches[k - 1].speed.min(stretch.speed);
            squares[k] = stretch.corner.min(speed * speed).min(squares[k + 1] + stretch.gain());
        }
        for (k, stretch) in stretches.iter().enumerate() {
            squares[k + 1] = squares[k + 1].min(squares[k] + stretch.gain());
        }
        let ends = |k: usize| [squares[k], squares[k + 1]];
        let peak = |k: usize| stretches[k].peak(ends(k));
        let passed = stretches.iter().enumerate().map(|(k, stretch)| {
            let seconds = stretch.seconds(ends(k));
            let slower = peak(k.saturating_sub(1)).min(peak(k));
            let dip = smoothing * (1.0 - squares[k].sqrt().min(slower) / slower);
            MoveTime {
                seconds: Some(seconds.max(stretch.full[0]) + dip),
                rest: stretch.full[1],
                assumed: false,
            }
        });
        passed.collect()
    }

    /// One after the other, and the most stretches that were kept.
    fn passed(stretches: &[Stretch], smoothing: f64) -> (Vec<MoveTime>, usize) {
        let (mut profile, mut times, mut most) = (Profile::new(smoothing, false), Vec::new(), 0);
        for stretch in stretches {
            profile.push(*stretch);
            most = most.max(profile.len());
            profile.settled(|time| times.push(time));
        }
        profile.rest(|time| times.push(time));
        assert!(profile.len() == 0 && profile.entry == 0.0);
        (times, most)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        /// Times that are settled before the end are those that the whole path gives, to the last bit; slow ones, too, which are settled late.
        #[test]
        fn settled_times_are_those_of_the_whole(stretches in collection::vec(stretch(), 1..9_000), slow in any::<bool>(), repeat in 1..8_usize, smoothing in prop_oneof![Just(0.0), 0.0..0.2_f64]) {
            let mut stretches = stretches;
            if slow {
                for stretch in &mut stretches {
                    (stretch.corner, stretch.acceleration, stretch.speed) = (f64::INFINITY, 0.01, 500.0);
                }
                stretches = stretches.repeat(repeat);
            }
            let (settled, most) = passed(&stretches, smoothing);
            prop_assert!(settled == whole(&stretches, smoothing));
            prop_assert!(slow || most <= LOOK + 2 * 200, "{}", most);
        }
    }

    /// Half a million moves of 1 µm on a line, on axes that would reach the feed after 5 m.
    #[test]
    fn long_ramps_take_a_few_bytes_a_move() {
        const MOVES: usize = 500_000;
        let mut profile = Profile::default();
        for k in 0..MOVES {
            let length = 0.001 * (k + 1) as f64 - 0.001 * k as f64;
            let seconds = 60.0 * (length / 60_000.0);
            profile.push(Stretch {
                length,
                speed: length / seconds,
                corner: f64::INFINITY,
                acceleration: 100.0,
                jerk: f64::INFINITY,
                full: [seconds, 0.0],
            });
            profile.settled(|_| ());
        }
        assert!(profile.len() > MOVES - 2 * OPEN, "{}", profile.len());
        let bytes = profile.packed.bytes() + profile.open.capacity() * size_of::<Stretch>();
        assert!(bytes < 16 * MOVES, "{bytes}");
    }
}
