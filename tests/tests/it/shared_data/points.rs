//! The stored systems with known answers: every count right, or unresolved where the root is multiple.

use super::solver_support::taylor;
use super::stored::{Stored, all};
use std::time::{Duration, Instant};
use sweepsim_solve::{Enclosure, PointSolver, Points, Root, SolveOptions, System};

fn solver() -> PointSolver {
    PointSolver::new(SolveOptions::default().boxes(u64::MAX))
}

/// Solves a system with sines and cosines cell by cell.
fn solve_in_cells(stored: &Stored, cells: usize) -> (Points, Duration) {
    let mut points = Points::default();
    let mut time = Duration::ZERO;
    let sides: Vec<Vec<Enclosure>> = stored
        .bounds
        .iter()
        .map(|b| {
            let step = (b.hi() - b.lo()) / cells as f64;
            let at = |i: usize| if i == cells { b.hi() } else { b.lo() + i as f64 * step };
            (0..cells).map(|i| Enclosure::new(at(i), at(i + 1)).unwrap()).collect()
        })
        .collect();
    let mut solver = solver();
    for x in &sides[0] {
        for y in &sides[1] {
            let cell = [*x, *y];
            let frame = cell.map(|s| Enclosure::new(s.lo() - 0.05 * s.radius(), s.hi() + 0.05 * s.radius()).unwrap());
            let equations = stored.expressions.iter().map(|e| taylor::equation(e, &frame));
            let system = System::mapped(&frame, equations).unwrap().within(&cell).unwrap();
            let start = Instant::now();
            let found = solver.solve(&system, &()).unwrap();
            time += start.elapsed();
            points.unresolved.extend(found.unresolved);
            points.statistics.boxes += found.statistics.boxes;
            // All cells approximate one function: a root in another's box of uniqueness is the same.
            let same = |a: &Root, b: &Root| {
                a.enclosure
                    .iter()
                    .zip(&b.unique_in)
                    .all(|(e, u)| u.lo() <= e.lo() && e.hi() <= u.hi())
            };
            for root in found.roots {
                if !points.roots.iter().any(|r| same(&root, r) || same(r, &root)) {
                    points.roots.push(root);
                }
            }
        }
    }
    (points, time)
}

/// Solves it, and says what is wrong, if anything.
fn check(stored: &Stored) -> (String, Option<String>) {
    let start = Instant::now();
    let (points, time) = match stored.system() {
        Some(system) => {
            let start = Instant::now();
            let mut solver = solver();
            let points = solver.solve(&system, &()).unwrap();
            let first = start.elapsed();
            // Quick ones again, with warm memory.
            let mut best = first;
            for _ in 0..if first < Duration::from_millis(20) { 20 } else { 0 } {
                let start = Instant::now();
                let again = solver.solve(&system, &()).unwrap();
                best = best.min(start.elapsed());
                assert_eq!(again, points, "{}: the same again", stored.name);
            }
            (points, best)
        }
        // Finer cells where the waves are short.
        None => solve_in_cells(stored, if stored.bounds[0].radius() > 1.5 { 16 } else { 8 }),
    };
    let expected = stored.expected.as_u64().unwrap() as usize;
    // Multiple as well: x = −7/20, z = 0 makes rose's second equation a square.
    let multiple = stored.tags.iter().any(|t| t.starts_with("singular")) || stored.name == "rose";
    let (certified, open) = (points.roots.len(), points.unresolved.len());
    let row = format!(
        "{:28} {expected:4} {certified:4} {open:4} {:9} {:10.3} ms  ({:.1} s in all)  {:?}",
        stored.name,
        points.statistics.boxes,
        time.as_secs_f64() * 1e3,
        start.elapsed().as_secs_f64(),
        points.unresolved.first().map(|u| u.cause),
    );
    let mut wrong = None;
    if certified > expected || (open == 0 && certified != expected) {
        wrong = Some("wrong count".to_owned());
    } else if open > 0 && !multiple {
        wrong = Some("open although simple".to_owned());
    } else if multiple && certified + open != expected {
        wrong = Some("roots and clusters do not add up".to_owned());
    }
    for root in &stored.roots {
        let near = |bounds: &[Enclosure]| {
            root.iter().zip(bounds).all(|(x, b)| {
                let slack = 1e-9 * (1.0 + x.abs());
                b.lo() - slack <= *x && *x <= b.hi() + slack
            })
        };
        let covered =
            points.roots.iter().any(|r| near(&r.enclosure)) || points.unresolved.iter().any(|u| near(&u.bounds));
        if !covered {
            wrong = Some(format!("lost {root:?}"));
        }
    }
    (row, wrong)
}

fn run(choose: impl Fn(&Stored) -> bool) {
    let systems = all();
    println!(
        "{:28} {:>4} {:>4} {:>4} {:>9} {:>10}",
        "system", "true", "cert", "open", "boxes", "time"
    );
    let mut failures = Vec::new();
    for stored in systems.iter().filter(|s| s.dimension == 0 && choose(s)) {
        let (row, wrong) = check(stored);
        println!("{row}{}", wrong.as_ref().map_or(String::new(), |w| format!("  <- {w}")));
        if let Some(wrong) = wrong {
            failures.push(format!("{}: {wrong}", stored.name));
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

/// The first of the systems with sines, whose Taylor expansions take longer than solving them.
const WITH_SINES: [&str; 2] = ["cheb2_2.1", "cheb2_2.3"];

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn stored_systems_have_their_known_roots() {
    run(|s| s.system().is_some() || WITH_SINES.contains(&s.name.as_str()));
}

#[test]
#[ignore = "takes half a minute"]
fn all_stored_systems_have_their_known_roots() {
    let only = std::env::var("SYSTEM").ok();
    run(|s| only.as_ref().is_none_or(|o| *o == s.name));
}
