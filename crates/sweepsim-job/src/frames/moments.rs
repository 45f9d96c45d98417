//! The moments of a program that are shown.

use sweepsim_formats::{Job, JobPath};

/// A moment of a program: within a move of a path, at a time from 0 to 1 of the move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Moment {
    pub path: usize,
    pub number: usize,
    pub time: f64,
}

/// `count` moments from the start of a program to its end, equally far apart by the clock, or the end alone if there is
/// one. The clock is that of the machine if all moves have a duration, otherwise the way of the tip. Nothing for a
/// program without moves.
pub(super) fn moments(job: &Job, count: usize) -> Vec<Moment> {
    let timed = |path: &JobPath| {
        path.seconds.len() == path.path.moves() && path.seconds.iter().all(|s| s.is_some_and(f64::is_finite))
    };
    let timed = job.paths.iter().all(timed);
    let mut durations = Vec::new();
    for (path, of_path) in job.paths.iter().enumerate() {
        if timed {
            let seconds = of_path.seconds.iter().enumerate();
            durations.extend(seconds.map(|(number, seconds)| (path, number, seconds.unwrap_or_default())));
        } else {
            let lengths = of_path.path.tip_lengths().enumerate();
            durations.extend(lengths.map(|(number, length)| (path, number, length)));
        }
    }
    spread(&durations, count)
}

fn spread(durations: &[(usize, usize, f64)], count: usize) -> Vec<Moment> {
    let ends: Vec<f64> = durations
        .iter()
        .scan(0.0, |clock, (.., duration)| {
            *clock += duration;
            Some(*clock)
        })
        .collect();
    let Some((end, (last_path, last_number, _))) = ends.last().zip(durations.last()) else {
        return Vec::new();
    };
    let last = Moment {
        path: *last_path,
        number: *last_number,
        time: 1.0,
    };
    (0..count)
        .map(|k| {
            if k + 1 == count {
                return last;
            }
            let clock = end * k as f64 / (count - 1) as f64;
            let index = ends.partition_point(|end| *end < clock).min(ends.len() - 1);
            let (path, number, duration) = durations[index];
            let time = if k == 0 {
                0.0
            } else {
                1.0 - (ends[index] - clock) / duration
            };
            Moment {
                path,
                number,
                // A program that takes no time is at its start until its end.
                time: if time.is_finite() { time.clamp(0.0, 1.0) } else { 0.0 },
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(path: usize, number: usize, time: f64) -> Moment {
        Moment { path, number, time }
    }

    #[test]
    fn moments_are_equally_far_apart() {
        let durations = [(0, 0, 2.0), (0, 1, 0.0), (1, 0, 6.0)];
        let expected = [
            at(0, 0, 0.0),
            at(0, 0, 1.0),
            at(1, 0, 1.0 / 3.0),
            at(1, 0, 2.0 / 3.0),
            at(1, 0, 1.0),
        ];
        let found = spread(&durations, 5);
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            assert_eq!((found.path, found.number), (expected.path, expected.number));
            // Two differences of numbers up to 8, divided by 6.
            assert!(
                (found.time - expected.time).abs() < 4.0 * f64::EPSILON,
                "{found:?} {expected:?}"
            );
        }
        assert_eq!(spread(&durations, 1), [at(1, 0, 1.0)]);
        assert_eq!(spread(&durations, 2), [at(0, 0, 0.0), at(1, 0, 1.0)]);
        assert_eq!(spread(&[], 3), []);
        assert_eq!(
            spread(&[(0, 0, 0.0), (0, 1, 0.0)], 3),
            [at(0, 0, 0.0), at(0, 0, 0.0), at(0, 1, 1.0)]
        );
    }
}
