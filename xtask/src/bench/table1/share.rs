//! How near the sweeps of Table 1 are to the least that they could cost: one evaluation of the equations per crossing.

use super::{CUTTERS, Cutter, cutter};
use crate::bench::records::{Records, heading};
use crate::bench::{on, shortest};
use std::hint::black_box;
use sweepsim::systems::PatchMotion;
use sweepsim::{Method, Options, sweep};

/// What is wanted on 500 × 500 lines.
const WANTED: &str = "0.3";
const CELLS: [(usize, &str); 2] = [(200, ""), (500, WANTED)];
/// Points at which the equations are evaluated.
const POINTS: usize = 1024;

/// The number of crossings times the time of one evaluation of `(X, Y, g)` with its gradient, over the time of the
/// sweep.
///
/// The evaluation is that of the [forms](PatchMotion), at many points side by side, as no sweep can have all of them.
/// (Charts evaluate the factors of these forms instead.)
pub fn share() -> Result<(), String> {
    on(1, here)?
}

fn here() -> Result<(), String> {
    let mut records = Records::open();
    heading("Share of one evaluation of (X, Y, g) per crossing in the time of a sweep, one thread");
    println!(
        "{:<6} {:<8} {:<8} {:>5} {:>10} {:>9} {:>15} {:>6} {:>7} {:>7}",
        "tool", "motion", "method", "cells", "crossings", "ms", "evaluation, ns", "share", "wanted", "before"
    );
    for name in CUTTERS {
        let cutter = cutter(name)?;
        for which in 0..2 {
            let evaluation = evaluation(&cutter, which)?;
            for method in [Method::Mixed, Method::General] {
                for (cells, wanted) in CELLS {
                    let entry = cutter.entry(which, cells)?;
                    let options = Options::new(1e-6).method(method);
                    let swept = sweep(entry.tool, &entry.path, &entry.grid, &options, &());
                    let crossings = swept.map_err(|error| error.to_string())?.statistics.crossings;
                    let seconds = shortest(|| entry.run(method))?;
                    let share = evaluation * crossings as f64 / seconds;
                    let before = records.note(&format!("share/{name}/{}/{method}/{cells}", which + 1), share);
                    println!(
                        "{name:<6} {:<8} {:<8} {cells:>5} {crossings:>10} {:>9.2} {:>15.0} {share:>6.2} {wanted:>7} {before:>7}",
                        format!("Sweep{}", which + 1),
                        method.to_string(),
                        seconds * 1e3,
                        evaluation * 1e9,
                    );
                }
            }
        }
    }
    records.save()
}

/// Seconds of one evaluation of `X`, `Y`, their denominator and `g`, each with its gradient: the mean over the tool's
/// patches.
fn evaluation(cutter: &Cutter, which: usize) -> Result<f64, String> {
    let path = cutter.path(which)?;
    let points = points();
    let patches = cutter.tool().patches();
    let segments = path.segments(0, cutter.radius, 1e-7);
    let forms: Vec<PatchMotion> = segments
        .iter()
        .flat_map(|segment| patches.iter().map(move |patch| PatchMotion::new(patch, segment)))
        .collect();
    let seconds = shortest(|| {
        let (mut values, mut gradients) = ([0.0; POINTS], [0.0; 3 * POINTS]);
        for forms in &forms {
            let ([x, y, _], weight) = forms.position();
            for form in [x, y, weight, forms.condition()] {
                form.evaluate_gradient_batch(black_box(&points), &mut values, &mut gradients);
                black_box((&values, &gradients));
            }
        }
        Ok(())
    })?;
    Ok(seconds / (forms.len() * POINTS) as f64)
}

/// Points in the unit cube, spread evenly: a lattice of Korobov's.
fn points() -> Vec<f64> {
    let fraction = |i: usize, k: usize| (i * k % POINTS) as f64 / POINTS as f64;
    let point = |i| [fraction(i, 1), fraction(i, 275), fraction(i, 275 * 275)];
    (0..POINTS).flat_map(point).collect()
}
