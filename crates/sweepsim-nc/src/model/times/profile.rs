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

/// How long each stretch takes, where the speed is nowhere larger than it may be and changes as fast as it may.
///
/// The squares of the speeds at the ends of stretches are the largest with `v² ≤ w² + 2 a L` between neighbours: one pass against the path for what
/// it must brake to, and one along it for what it can reach. That is the look-ahead of Grbl's planner, over the whole path.
pub(super) fn seconds(stretches: &[Stretch]) -> Vec<f64> {
    let mut squares = vec![0.0; stretches.len() + 1];
    for (k, pair) in stretches.windows(2).enumerate() {
        let most = pair[0].speed.min(pair[1].speed);
        squares[k + 1] = pair[1].corner.min(most * most);
    }
    let gain = |stretch: &Stretch| 2.0 * stretch.acceleration * stretch.length;
    for (k, stretch) in stretches.iter().enumerate().rev() {
        squares[k] = squares[k].min(squares[k + 1] + gain(stretch));
    }
    for (k, stretch) in stretches.iter().enumerate() {
        squares[k + 1] = squares[k + 1].min(squares[k] + gain(stretch));
    }
    let ends = squares.windows(2).zip(stretches);
    ends.map(|(ends, stretch)| stretch.seconds([ends[0], ends[1]]))
        .collect()
}

impl Stretch {
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
