//! The fastest course of the speed along stretches that follow one another, from rest to rest.

/// A stretch of a path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    pub length: f64,
    /// The largest speed on it,
    pub speed: f64,
    /// and the largest square of the speed at its start, where the path has a corner.
    pub corner: f64,
    /// The largest change of the speed; may be infinite.
    pub acceleration: f64,
}

/// How long stretches take, where the speed is nowhere larger than it may be and changes as fast as it may.
///
/// The squares of the speeds at the ends of stretches are the largest with `v² ≤ w² + 2 a L` between neighbours: one pass against the path for what
/// it must brake to, and one along it for what it can reach. That is the look-ahead of Grbl's planner, over the whole path.
#[derive(Debug, Default)]
pub(super) struct Profile {
    stretches: Vec<Stretch>,
    /// The square of the speed at the start of the first of them.
    entry: f64,
    /// So many were left when it was last looked for those that are settled.
    left: usize,
}

/// So many more stretches are looked at together.
const LOOK: usize = 1024;

impl Profile {
    /// The number of stretches whose times are not known yet.
    pub fn len(&self) -> usize {
        self.stretches.len()
    }

    /// Appends a stretch.
    pub fn push(&mut self, stretch: Stretch) {
        self.stretches.push(stretch);
    }

    /// Gives the times of the first stretches, as far as nothing that follows can change them; mostly none.
    pub fn settled(&mut self, each: impl FnMut(f64)) {
        // It takes as long as there are stretches.
        if self.len() < LOOK + 2 * self.left {
            return;
        }
        let last = self.stretches.last().map_or(0.0, |stretch| stretch.speed);
        // Whatever the speed is at the end, what must be braked to lies between these.
        let [slow, fast] = [0.0, last * last].map(|end| self.to_brake_to(end));
        let same = slow.iter().zip(&fast).rposition(|(slow, fast)| slow == fast);
        self.take(same.unwrap_or(0), slow, each);
        self.left = self.len();
    }

    /// Gives the times of all stretches, after which there is a rest.
    pub fn rest(&mut self, each: impl FnMut(f64)) {
        let squares = self.to_brake_to(0.0);
        self.take(self.len(), squares, each);
        (self.entry, self.left) = (0.0, 0);
    }

    /// The largest squares of the speeds at the ends of stretches from which it can brake to all later ones, and to that at the end.
    fn to_brake_to(&self, end: f64) -> Vec<f64> {
        let mut squares = vec![end; self.len() + 1];
        for (k, stretch) in self.stretches.iter().enumerate().rev() {
            let most = match k.checked_sub(1).map(|before| &self.stretches[before]) {
                None => self.entry,
                Some(before) => {
                    let speed = before.speed.min(stretch.speed);
                    stretch.corner.min(speed * speed)
                }
            };
            squares[k] = most.min(squares[k + 1] + stretch.gain());
        }
        squares
    }

    /// Takes the first stretches away, with the squares of the speeds that can be braked to.
    fn take(&mut self, count: usize, mut squares: Vec<f64>, mut each: impl FnMut(f64)) {
        for (k, stretch) in self.stretches.drain(..count).enumerate() {
            squares[k + 1] = squares[k + 1].min(squares[k] + stretch.gain());
            each(stretch.seconds([squares[k], squares[k + 1]]));
        }
        self.entry = squares[count];
    }
}

impl Stretch {
    /// The change of the square of the speed along it.
    fn gain(&self) -> f64 {
        2.0 * self.acceleration * self.length
    }

    /// How long it takes, by the squares of the speeds at its ends.
    fn seconds(&self, squares: [f64; 2]) -> f64 {
        if self.acceleration == f64::INFINITY {
            return self.length / self.speed;
        }
        // The ramps between its ends and its largest speed.
        let ramps: f64 = squares
            .iter()
            .map(|square| (self.speed * self.speed - square) / (2.0 * self.acceleration))
            .sum();
        let (peak, rest) = if ramps <= self.length {
            (self.speed, self.length - ramps)
        } else {
            // They meet before, at v² = w² + 2 a l from both sides, with lengths l that make up the stretch.
            let square = 0.5 * (squares[0] + squares[1]) + self.acceleration * self.length;
            (square.max(squares[0]).max(squares[1]).sqrt(), 0.0)
        };
        let change: f64 = squares.iter().map(|square| peak - square.sqrt()).sum();
        change / self.acceleration + if rest > 0.0 { rest / peak } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn stretch() -> impl Strategy<Value = Stretch> {
        let acceleration = prop_oneof![9 => 1.0..4e3_f64, 1 => Just(f64::INFINITY)];
        let corner = prop_oneof![1 => Just(0.0), 9 => 0.0..1e4_f64, 9 => Just(f64::INFINITY)];
        (1e-3..10.0_f64, 0.1..500.0_f64, corner, acceleration).prop_map(|(length, speed, corner, acceleration)| {
            Stretch {
                length,
                speed,
                corner,
                acceleration,
            }
        })
    }

    /// What is settled on the way.
    fn run(stretches: &[Stretch], settle: bool) -> (Vec<f64>, usize) {
        let (mut profile, mut times, mut most) = (Profile::default(), Vec::new(), 0);
        for stretch in stretches {
            profile.push(*stretch);
            most = most.max(profile.len());
            if settle {
                profile.settled(|time| times.push(time));
            }
        }
        profile.rest(|time| times.push(time));
        (times, most)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        /// Times that are settled before the end are those that the whole path gives, to the last bit; slow ones, too, which are settled late.
        #[test]
        fn settled_times_are_those_of_the_whole(stretches in proptest::collection::vec(stretch(), 1..9_000), slow in any::<bool>()) {
            let mut stretches = stretches;
            if slow {
                for stretch in &mut stretches {
                    (stretch.corner, stretch.acceleration, stretch.speed) = (f64::INFINITY, 0.01, 500.0);
                }
            }
            let ((whole, _), (settled, most)) = (run(&stretches, false), run(&stretches, true));
            prop_assert_eq!(whole.len(), stretches.len());
            prop_assert!(whole.iter().zip(&settled).all(|(a, b)| a.to_bits() == b.to_bits()) && whole.len() == settled.len());
            prop_assert!(slow || most <= LOOK + 2 * 200, "{}", most);
        }
    }
}
