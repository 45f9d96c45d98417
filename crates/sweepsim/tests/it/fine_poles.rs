//! What lines under the pole of a free-form patch cost at tolerances at which rounding hides how far they are from its way: in boxes, as in [`near_degenerate`](crate::near_degenerate).
//!
//! `cargo test -p sweepsim --release --test it fine_poles -- --include-ignored --nocapture` prints the table of the docs.

use crate::far_and_fine::difference;
use crate::grazing_curves::bud;
use crate::near_degenerate::{DISTANCES, GENERIC, METHODS, MOST, work};
use crate::near_poles::over_poles;
use sweepsim::{Method, Options, sweep};

/// Tolerances down to almost the least.
const FINE: [f64; 5] = [1e-7, 3e-8, 1e-8, 1e-9, 6e-10];

/// Lines that rounding leaves undecided are given up early, and solved again at a distance, which takes about as many boxes as all lines do otherwise. `lines` leaves to charts what would
/// have taken it fewer.
fn poles_at_fine_tolerances(distances: &[f64]) {
    let (mut wrong, tool) = (Vec::new(), bud());
    for tolerance in FINE {
        for method in METHODS {
            for (what, family) in over_poles() {
                let swept = |d: f64, tolerance: f64, method: Method| {
                    let input = family(d);
                    let options = Options::new(tolerance).method(method);
                    let found = sweep(&tool, &input.0, &input.1, &options, &()).expect("a sweep");
                    (work(method, &found.statistics, &input.1), found)
                };
                let (generic, _) = swept(GENERIC, tolerance, method);
                for d in distances {
                    let (work, found) = swept(*d, tolerance, method);
                    let (ratio, again, open) = (
                        work / generic,
                        found.statistics.repaired,
                        found.statistics.unresolved.len(),
                    );
                    let apart =
                        difference(&found.volume, &swept(*d, 1e-6, Method::Charts).1.volume, 10.0, 0.0).along_lines;
                    let line = format!(
                        "{tolerance:e}, {method}, {what}, {d:e}: {ratio:.2} of {generic}, {again} again, {open} open, {apart:e}"
                    );
                    println!("{line}");
                    // No other line is solved again.
                    if !(ratio <= MOST && again <= 15 && open == 0 && apart < 1e-5) {
                        wrong.push(line);
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn poles_over_lines_cost_little_at_fine_tolerances() {
    poles_at_fine_tolerances(&[1e-9, 1e-12, 0.0]);
}

#[test]
#[ignore = "takes half a minute"]
fn so_they_do_at_all_distances() {
    poles_at_fine_tolerances(&DISTANCES);
}
