//! A stretch of a path, and how long it takes by the speeds at its ends.

use super::MoveTime;

/// A stretch of a path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    pub length: f64,
    /// The largest speed on it,
    pub speed: f64,
    /// and the largest square of the speed at its start, where the path has a corner.
    pub corner: f64,
    /// The largest change of the speed, and of the acceleration; may be infinite.
    pub acceleration: f64,
    pub jerk: f64,
    /// How long its move takes at full speed, in seconds, and the rest before it.
    pub full: [f64; 2],
}

impl Stretch {
    /// The change of the square of the speed along it.
    pub fn gain(&self) -> f64 {
        2.0 * self.acceleration * self.length
    }

    pub fn row(self) -> [f64; 7] {
        let Self {
            length,
            speed,
            corner,
            acceleration,
            jerk,
            full: [seconds, rest],
        } = self;
        [length, speed, corner, acceleration, jerk, seconds, rest]
    }

    pub fn of_row([length, speed, corner, acceleration, jerk, seconds, rest]: [f64; 7]) -> Self {
        Self {
            length,
            speed,
            corner,
            acceleration,
            jerk,
            full: [seconds, rest],
        }
    }

    /// The time of its move, in which it passes it in so many seconds, and so many more.
    pub fn time(&self, seconds: f64, more: f64) -> MoveTime {
        let [full, rest] = self.full;
        MoveTime {
            // Rounding makes no move faster than at full speed.
            seconds: Some(full.max(seconds) + more),
            rest,
            assumed: false,
        }
    }

    /// How long the ramps between its ends and a speed are together.
    fn ramps(&self, squares: [f64; 2], speed: f64) -> f64 {
        let ramp = |square: &f64| (speed * speed - square) / (2.0 * self.acceleration);
        squares.iter().map(ramp).sum()
    }

    /// The largest speed on it, by the squares of those at its ends.
    pub fn peak(&self, squares: [f64; 2]) -> f64 {
        if self.acceleration == f64::INFINITY || self.ramps(squares, self.speed) <= self.length {
            return self.speed;
        }
        // The ramps meet before, at v² = w² + 2 a l from both sides, with lengths l that make up the stretch.
        let square = 0.5 * (squares[0] + squares[1]) + self.acceleration * self.length;
        square.max(squares[0]).max(squares[1]).sqrt()
    }

    /// How long it takes, by the squares of the speeds at its ends.
    pub fn seconds(&self, squares: [f64; 2]) -> f64 {
        if self.acceleration == f64::INFINITY {
            return self.length / self.speed;
        }
        let peak = self.peak(squares);
        let rest = (self.length - self.ramps(squares, self.speed)).max(0.0);
        let change: f64 = squares.iter().map(|square| peak - square.sqrt()).sum();
        change / self.acceleration + if rest > 0.0 { rest / peak } else { 0.0 }
    }
}
