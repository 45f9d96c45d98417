//! Courses of the speed with a bounded jerk (S-curves): between two speeds, and up and down again along a stretch.

/// What bounds the speed's change along a path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// May be infinite,
    pub acceleration: f64,
    /// and so may this.
    pub jerk: f64,
}

/// A change from one speed to another, as fast as the limits let it; the acceleration is 0 at both ends.
///
/// The acceleration rises and falls with the whole jerk for `rise` each, and is constant between them. The course of the speed has its middle as a centre of symmetry.
#[derive(Clone, Copy, Debug)]
struct Ramp {
    slow: f64,
    fast: f64,
    rise: f64,
    seconds: f64,
    jerk: f64,
    /// The largest acceleration that it reaches.
    steepest: f64,
}

impl Limits {
    /// With an acceleration of at most this.
    pub fn at_most(self, acceleration: f64) -> Self {
        Self {
            acceleration: self.acceleration.min(acceleration),
            ..self
        }
    }

    fn ramp(self, speeds: [f64; 2]) -> Ramp {
        let (slow, fast) = (speeds[0].min(speeds[1]), speeds[0].max(speeds[1]));
        let Self { acceleration: a, jerk } = self;
        let change = fast - slow;
        let (rise, seconds, steepest) = if jerk == f64::INFINITY {
            (0.0, if change > 0.0 { change / a } else { 0.0 }, a)
        } else if change * jerk >= a * a {
            (a / jerk, change / a + a / jerk, a)
        } else {
            // The largest acceleration is not reached.
            let rise = (change / jerk).sqrt();
            (rise, 2.0 * rise, rise * jerk)
        };
        Ramp {
            slow,
            fast,
            rise,
            seconds,
            jerk,
            steepest,
        }
    }

    /// How long the way between two speeds is.
    pub fn way(self, speeds: [f64; 2]) -> f64 {
        self.ramp(speeds).way()
    }

    /// The largest speed up to `most` to which it can change from `speed`, or from which it can change to it, along a way. It is at least `speed`.
    pub fn reach(self, speed: f64, way: f64, most: f64) -> f64 {
        let (mut low, mut high) = (speed, most);
        if high <= low || self.way([low, high]) <= way {
            return high.max(low);
        }
        // What it would be without a bound of the jerk is farther.
        high = high.min((speed * speed + 2.0 * self.acceleration * way).sqrt());
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                return low;
            }
            *(if self.way([speed, middle]) <= way {
                &mut low
            } else {
                &mut high
            }) = middle;
        }
    }
}

impl Ramp {
    fn way(&self) -> f64 {
        0.5 * (self.slow + self.fast) * self.seconds
    }

    /// The speed, and the way from the slow end, so many seconds after it.
    fn after(&self, seconds: f64) -> (f64, f64) {
        if 2.0 * seconds > self.seconds {
            let (speed, way) = self.before_middle(self.seconds - seconds, self.fast, -1.0);
            return (speed, self.way() - way);
        }
        self.before_middle(seconds, self.slow, 1.0)
    }

    /// The speed and the way after so many seconds from an end with a speed, which rises or falls from there.
    fn before_middle(&self, t: f64, speed: f64, sign: f64) -> (f64, f64) {
        // Jerk has no part in it where it is infinite: then the first phase takes no time.
        let first = t.min(self.rise);
        let jerk = if first > 0.0 { sign * self.jerk } else { 0.0 };
        let (mut v, mut way) = (
            speed + 0.5 * jerk * first * first,
            speed * first + jerk * first * first * first / 6.0,
        );
        let then = t - first;
        if then > 0.0 {
            let a = sign * self.steepest;
            way += v * then + 0.5 * a * then * then;
            v += a * then;
        }
        (v, way)
    }

    /// The seconds from the slow end after a way, and the speed there.
    fn at(&self, way: f64) -> (f64, f64) {
        if way <= 0.0 {
            return (0.0, self.slow);
        }
        if way >= self.way() {
            return (self.seconds, self.fast);
        }
        let (mut low, mut high) = (0.0, self.seconds);
        loop {
            let middle = 0.5 * (low + high);
            let (speed, gone) = self.after(middle);
            if middle <= low || middle >= high {
                return (middle, speed);
            }
            *(if gone <= way { &mut low } else { &mut high }) = middle;
        }
    }
}

/// The course along a way between two speeds, with an acceleration of 0 at both ends: up to its peak, and down again.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leg {
    up: Ramp,
    down: Ramp,
    length: f64,
}

impl Leg {
    /// The fastest one along a length, nowhere faster than `most`. Each end can be reached from the other.
    pub fn new([start, end]: [f64; 2], most: f64, length: f64, [rise, fall]: [Limits; 2]) -> Self {
        let fits = |peak: f64| rise.way([start, peak]) + fall.way([peak, end]) <= length;
        let (mut low, mut high) = (start.max(end), most.max(start).max(end));
        if fits(high) {
            low = high;
        }
        while low < high {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            *(if fits(middle) { &mut low } else { &mut high }) = middle;
        }
        Self {
            up: rise.ramp([start, low]),
            down: fall.ramp([low, end]),
            length,
        }
    }

    pub fn seconds(&self) -> f64 {
        self.up.seconds + self.level_seconds() + self.down.seconds
    }

    fn level(&self) -> f64 {
        (self.length - self.up.way() - self.down.way()).max(0.0)
    }

    fn level_seconds(&self) -> f64 {
        let level = self.level();
        if level > 0.0 { level / self.peak() } else { 0.0 }
    }

    pub fn peak(&self) -> f64 {
        self.up.fast
    }

    /// From where to where on its way it has its largest speed.
    pub fn top(&self) -> [f64; 2] {
        let from = self.up.way();
        [from, from + self.level()]
    }

    /// The seconds from its start after a way, and the speed there.
    pub fn at(&self, way: f64) -> (f64, f64) {
        let [from, to] = self.top();
        if way < from {
            return self.up.at(way);
        }
        if way <= to {
            let passed = if way > from { (way - from) / self.peak() } else { 0.0 };
            return (self.up.seconds + passed, self.peak());
        }
        let (left, speed) = self.down.at(self.length - way);
        (self.seconds() - left, speed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::*;

    /// Moves from rest to rest by hand: `(length, speed, acceleration, jerk)` and seconds, in all four cases.
    #[test]
    fn from_rest_to_rest_by_hand() {
        let cases = [
            // 100 mm/s after 0.1 + 0.05 s with 1000 mm/s² and 20,000 mm/s³, and 7.5 mm: 85 mm at full speed.
            ((100.0, 100.0, 1000.0, 2e4), 2.0 * 0.15 + 0.85),
            // The speed is reached after 2 √(20/20,000) s, the acceleration is not.
            ((100.0, 20.0, 1000.0, 2e4), 100.0 / 20.0 + 2.0 * f64::sqrt(1e-3)),
            // The acceleration is reached, the speed is not: v²/a + v a/j = 15 at v = 100.
            ((15.0, 1e3, 1000.0, 2e4), 2.0 * 0.15),
            // Neither: four times the cube root of l / 2j.
            ((0.32, 1e3, 1000.0, 2e4), 4.0 * 0.02),
            // Without a bound of the jerk, and of the acceleration.
            ((100.0, 100.0, 1000.0, f64::INFINITY), 1.1),
            ((2.0, 100.0, 1000.0, f64::INFINITY), 2.0 * f64::sqrt(0.002)),
            ((0.32, 1e3, f64::INFINITY, 2e4), 4.0 * 0.02),
            ((100.0, 50.0, f64::INFINITY, f64::INFINITY), 2.0),
        ];
        for ((length, speed, acceleration, jerk), expected) in cases {
            let leg = Leg::new([0.0; 2], speed, length, [Limits { acceleration, jerk }; 2]);
            assert!(
                (leg.seconds() - expected).abs() < 1e-12 * expected,
                "{} {expected}",
                leg.seconds()
            );
        }
    }

    fn limits() -> impl Strategy<Value = Limits> {
        (0.0..4.0_f64, 1.0..7.0_f64).prop_map(|(a, jerk)| Limits {
            acceleration: 10.0_f64.powf(a),
            jerk: 10.0_f64.powf(jerk),
        })
    }

    proptest! {
        /// Steps of time with the jerk that the course says: limits hold, the ways are those said, and the ends are met.
        #[test]
        fn courses_are_their_integrals(
            limits in [limits(), limits()],
            ends in prop_oneof![Just([0.0; 2]), [0.0..200.0_f64, 0.0..200.0_f64]],
            more in 0.0..3.0_f64,
            most in 1.0..400.0_f64,
        ) {
            let most = most.max(ends[0]).max(ends[1]);
            let needed = limits[usize::from(ends[1] < ends[0])].way(ends);
            let length = needed * (1.0 + more) + 1e-3;
            let leg = Leg::new(ends, most, length, limits);
            let total = leg.seconds();
            const STEPS: usize = 4000;
            let dt = total / STEPS as f64;
            // Speeds at equal times, by halving the way.
            let speed_at = |t: f64| {
                let (mut low, mut high) = (0.0, length);
                for _ in 0..70 {
                    let middle = 0.5 * (low + high);
                    *(if leg.at(middle).0 <= t { &mut low } else { &mut high }) = middle;
                }
                leg.at(low)
            };
            let speeds: Vec<f64> = (0..=STEPS).step_by(40).map(|k| speed_at(k as f64 * dt).1).collect();
            let step = 40.0 * dt;
            prop_assert!((speeds[0] - ends[0]).abs() < 1e-5 * (1.0 + most), "{speeds:?}");
            prop_assert!((speeds[speeds.len() - 1] - ends[1]).abs() < 1e-5 * (1.0 + most));
            // Between two times the acceleration is at most the larger one, and the second difference at most the jerk.
            let (a, jerk) = (limits[0].acceleration.max(limits[1].acceleration), limits[0].jerk.max(limits[1].jerk));
            for pair in speeds.windows(2) {
                prop_assert!((pair[1] - pair[0]).abs() <= 1.001 * a * step + 1e-6 * most, "{pair:?}");
            }
            for three in speeds.windows(3) {
                let second = three[2] - 2.0 * three[1] + three[0];
                prop_assert!(second.abs() <= 1.001 * jerk * step * step + 4e-6 * most, "{three:?}");
            }
            prop_assert!(speeds.iter().all(|v| *v <= most * (1.0 + 1e-12)));
            // By the trapezoidal rule, whose error is at most jerk · step²/12 · seconds.
            let way: f64 = speeds.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]) * step).sum();
            prop_assert!((way - length).abs() <= jerk * step * step / 12.0 * total + 1e-5 * length, "{way} {length}");
            // It cannot be faster: the peak is the largest, or another limit binds.
            let faster = leg.peak() * (1.0 + 1e-6) + 1e-9;
            let longer = limits[0].way([ends[0], faster]) + limits[1].way([faster, ends[1]]);
            prop_assert!(faster > most || longer > length * (1.0 - 1e-12));
        }

        /// More jerk is never slower from rest to rest, and tends to the trapezoid of speed.
        #[test]
        fn more_jerk_is_faster(length in 1e-3..1e3_f64, speed in 1.0..500.0_f64, limits in limits(), factor in 1.0..100.0_f64) {
            let seconds = |jerk: f64| Leg::new([0.0; 2], speed, length, [Limits { jerk, ..limits }; 2]).seconds();
            let a = limits.acceleration;
            let trapezoid = if length * a <= speed * speed { 2.0 * (length / a).sqrt() } else { length / speed + speed / a };
            prop_assert!(seconds(factor * limits.jerk) <= seconds(limits.jerk) * (1.0 + 1e-12));
            prop_assert!(seconds(limits.jerk) >= trapezoid * (1.0 - 1e-12));
            prop_assert!((seconds(1e15) - trapezoid).abs() <= 1e-5 * trapezoid);
        }

        /// A speed that is reached needs the whole way.
        #[test]
        fn reach_needs_the_whole_way(limits in limits(), speed in prop_oneof![Just(0.0), 0.0..200.0_f64], way in 1e-4..100.0_f64) {
            let found = limits.reach(speed, way, 1e6);
            prop_assert!(found > speed && limits.way([speed, found]) <= way);
            prop_assert!(found == 1e6 || limits.way([speed, found * (1.0 + 1e-9)]) > way * (1.0 - 1e-9));
            prop_assert_eq!(limits.reach(speed, way, 0.5 * (speed + found)), 0.5 * (speed + found));
        }
    }
}
