//! Whether given intervals are the swept set of a line.
//!
//! Equal in number and ends: the same. Otherwise the two sets differ on some stretches, and the signed distance decides
//! each: an answer is *wrong* if it calls a point tool that is farther outside than the tolerance, or air if it is
//! deeper inside than the tolerance. Points within the tolerance of the boundary may be called either (a *film*): a
//! line in a wall, a wall so steep that a shift of the line within the tolerance moves its end far, a gap about to
//! close.

use super::depth::Depth;
use super::union::SweptLine;

/// The judge's own error: the minimum over time is resolved to better than this.
const JUDGE: f64 = 1e-8;
/// The number of points tested on a stretch where the two sets differ.
const PROBES: usize = 9;

/// A point at which an answer is wrong beyond the tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disagreement {
    /// The height.
    pub z: f64,
    /// The signed distance from the swept volume there: positive outside.
    pub distance: f64,
}

/// The oracle's verdict on an answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// Equal in number, and in ends within the tolerance.
    Same,
    /// Different only within the tolerance of the boundary.
    Film,
    /// Right by the distance, where the sampling missed something.
    Better,
    /// Wrong by more than the tolerance.
    Wrong(Disagreement),
}

/// Judges `found`, the intervals of the line through `(x, y)`, which may be off by `tolerance` in space.
#[must_use]
pub fn compare(found: &[[f64; 2]], line: &SweptLine, depth: &Depth<'_>, [x, y]: [f64; 2], tolerance: f64) -> Verdict {
    // An end that the sampling does not resolve better than this must be judged by its distance.
    let near = |z: f64, end: f64, error: f64| error <= tolerance && (z - end).abs() <= tolerance + error;
    let same = found.len() == line.spans.len()
        && found.iter().zip(&line.spans).all(|(interval, span)| {
            near(interval[0], span.low, span.error[0]) && near(interval[1], span.high, span.error[1])
        });
    if same {
        return Verdict::Same;
    }
    let expected: Vec<[f64; 2]> = line.spans.iter().map(|span| [span.low, span.high]).collect();
    let inside = |set: &[[f64; 2]], z: f64| set.iter().any(|[low, high]| *low <= z && z <= *high);
    let mut cuts: Vec<f64> = found.iter().chain(&expected).flatten().copied().collect();
    cuts.sort_by(f64::total_cmp);
    let limit = tolerance + JUDGE;
    let (mut better, mut worst) = (false, None::<Disagreement>);
    for pair in cuts.windows(2) {
        let middle = 0.5 * (pair[0] + pair[1]);
        let tool = inside(found, middle);
        if tool == inside(&expected, middle) || pair[0] == pair[1] {
            continue;
        }
        for probe in 0..PROBES {
            let z = pair[0] + (pair[1] - pair[0]) * ((probe as f64 + 0.5) / PROBES as f64);
            let distance = depth.at([x, y, z]).distance;
            if distance.abs() <= limit {
                continue;
            }
            if (distance < 0.0) == tool {
                better = true;
            } else if worst.is_none_or(|w| distance.abs() > w.distance.abs()) {
                worst = Some(Disagreement { z, distance });
            }
        }
    }
    match worst {
        Some(disagreement) => Verdict::Wrong(disagreement),
        None if better => Verdict::Better,
        None => Verdict::Film,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oracle::{Motion, Outline, Sampling, swept_line};
    use sweepsim_motion::{Pose, Tool};

    /// A judge that never rejects is useless: every kind of wrong answer must be caught.
    #[test]
    fn wrong_answers_are_caught_and_films_are_not() {
        let outline = Outline::new(Tool::flat(2.0, 10.0).unwrap().profile().expect("a solid of revolution"));
        let up = [0.0, 0.0, 1.0];
        let poses = [
            Pose::new([-5.0, 0.0, 0.0], up).unwrap(),
            Pose::new([5.0, 0.0, 0.0], up).unwrap(),
        ];
        let motion = Motion::new(&poses);
        let depth = Depth::new(&outline, &motion);
        let judge = |found: &[[f64; 2]], y: f64| {
            let line = swept_line(&outline, &motion, 0.3, y, Sampling::number(200));
            compare(found, &line, &depth, [0.3, y], 1e-6)
        };
        let wrong = |verdict| matches!(verdict, Verdict::Wrong(_));
        assert_eq!(judge(&[[0.0, 10.0]], 1.0), Verdict::Same);
        assert_eq!(judge(&[[5e-7, 10.0 - 5e-7]], 1.0), Verdict::Same);
        assert!(wrong(judge(&[[1e-5, 10.0]], 1.0)) && wrong(judge(&[[0.0, 10.0 + 1e-5]], 1.0)));
        assert!(wrong(judge(&[], 1.0)) && wrong(judge(&[[0.0, 4.0], [4.1, 10.0]], 1.0)));
        assert!(wrong(judge(&[[0.0, 10.0], [12.0, 13.0]], 1.0)));
        // A line in the wall may be called tool or air; one beside it may not.
        assert!(!wrong(judge(&[[0.0, 10.0]], 2.0)) && !wrong(judge(&[], 2.0)));
        assert!(!wrong(judge(&[[0.0, 10.0]], 2.0 + 5e-7)) && !wrong(judge(&[], 2.0 - 5e-7)));
        assert!(wrong(judge(&[[0.0, 10.0]], 2.0 + 2e-6)) && wrong(judge(&[], 2.0 - 2e-6)));
    }
}
