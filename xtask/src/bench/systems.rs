//! The stored systems of equations, `../shared/data/systems`: what the solvers find, how long it takes, and what others
//! took.

use super::records::{Records, heading};
use super::shortest;
use crate::workspace;
use serde_json::Value;
use std::time::{Duration, Instant};
use sweepsim_solve::{Cause, CurveSolver, Enclosure, PointSolver, Singular, SolveOptions, SurfaceSolver, System};
use sweepsim_spline::Bernstein;

/// Milliseconds that other solvers took for the stored systems of these names, as far as they were measured: IRIT's
/// `mvar_lib` at its best setting, and a prototype in plain floating-point numbers. Taken on another day, on two shared
/// cores.
const OTHERS: [(&str, f64, f64); 4] = [
    ("dense_cheb4_3d", 2.0, 4.7),
    ("cyclohexane", 42.0, 0.9),
    ("noon4", 12_613.0, 6.8),
    ("wood", 1_094.0, 23.0),
];
/// Systems that the prototype could not solve.
const FAILED: [&str; 2] = ["katsura6", "reimer5"];
/// No system takes longer.
const LIMIT: Duration = Duration::from_secs(60);
/// What takes longer is measured once.
const LONG: Duration = Duration::from_secs(1);
/// The tolerance of curves and surfaces, relative to the widest side of the domain.
const TOLERANCE: f64 = 1e-3;

/// Branches at the singular point of curves that have one, by hand: a crossing, a cusp, an isolated point, and two
/// nodes.
const BRANCHES: [(&str, usize); 5] = [
    ("c1_cross", 4),
    ("c1_cusp", 2),
    ("c1_isolated_point", 0),
    ("c1_viviani", 4),
    ("c1_torus_tangent_plane", 4),
];

/// What a solver found.
struct Outcome {
    /// As the stored answers write it.
    found: String,
    open: usize,
    /// The number of roots with multiplicity in each open box, if all of them are known.
    zeros: Option<Vec<u32>>,
    /// The number of branches that end in each open box, if all of them are singular points as small as the limit.
    branches: Option<Vec<usize>>,
    boxes: u64,
}

/// How much of a system was solved.
#[derive(Clone, Copy, PartialEq)]
enum State {
    /// No open box, and the right answer.
    Complete,
    /// Open boxes, each with the number of roots with multiplicity, or of branches, that it holds.
    Counted,
    Open,
    Wrong,
}

impl Outcome {
    fn state(&self, name: &str, expected: Option<&str>) -> State {
        if self.open == 0 {
            let right = expected.is_none_or(|e| e == self.found);
            return if right { State::Complete } else { State::Wrong };
        }
        if let Some(zeros) = &self.zeros {
            // Stored answers are numbers of different roots; a box holds at least one, and no more than its number.
            let certified: Option<u32> = self.found.parse().ok();
            let (Some(certified), Some(all)) = (certified, expected.and_then(|e| e.parse::<u32>().ok())) else {
                return State::Open;
            };
            let range = certified + u32::from(zeros.iter().any(|z| *z > 0))..=certified + zeros.iter().sum::<u32>();
            return if range.contains(&all) {
                State::Counted
            } else {
                State::Wrong
            };
        }
        match (&self.branches, BRANCHES.iter().find(|b| b.0 == name)) {
            (Some(branches), Some((_, known))) if branches.as_slice() == [*known] => State::Counted,
            (Some(_), Some(_)) => State::Wrong,
            _ => State::Open,
        }
    }

    fn mark(&self, state: State) -> String {
        let listed = |numbers: &[String]| numbers.join(", ");
        match (state, &self.zeros, &self.branches) {
            (State::Complete, ..) => String::new(),
            (State::Counted, Some(zeros), _) => {
                let numbers: Vec<String> = zeros.iter().map(u32::to_string).collect();
                format!("counted: multiplicity {}", listed(&numbers))
            }
            (State::Counted, _, Some(branches)) => {
                let numbers: Vec<String> = branches.iter().map(usize::to_string).collect();
                format!("counted: branches {}", listed(&numbers))
            }
            (State::Open | State::Counted, ..) => "open".to_owned(),
            (State::Wrong, ..) => "WRONG".to_owned(),
        }
    }
}

/// Solves all stored systems, or those whose names contain the filter, on one thread.
pub fn systems(filter: Option<&str>) -> Result<(), String> {
    let file = workspace::root().join("../shared/data/systems/systems.json");
    let text = std::fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))?;
    let stored: Vec<Value> = serde_json::from_str(&text).map_err(|error| format!("{}: {error}", file.display()))?;
    let mut records = Records::open();
    heading(
        "Stored systems of equations, one thread; `IRIT` and `prototype` in ms, `ratio`: IRIT's time over this one's",
    );
    println!(
        "{:<30} {:>2} {:>14} {:>14} {:>5} {:>9} {:>10} {:>9} {:>9} {:>6} {:>7}",
        "system", "n", "expected", "found", "open", "boxes", "ms", "IRIT", "prototype", "ratio", "before"
    );
    let mut states = Vec::new();
    let mut total = 0.0;
    let mut ratios = Vec::new();
    for json in &stored {
        let name = json["name"].as_str().unwrap_or("?");
        if filter.is_some_and(|filter| !name.contains(filter)) {
            continue;
        }
        let system = read(json).map_err(|error| format!("{name}: {error}"))?;
        let start = Instant::now();
        let outcome = solve(&system).map_err(|error| format!("{name}: {error}"))?;
        // The first run has yet to allocate its memory, which does not matter if it is long.
        let once = start.elapsed();
        let time = if once > LONG {
            once.as_secs_f64()
        } else {
            shortest(|| solve(&system).map(drop))?
        };
        total += time;
        let expected = expected(json);
        let state = outcome.state(name, expected.as_deref());
        states.push(state);
        let others = OTHERS.iter().find(|(other, ..)| *other == name);
        if let Some((_, irit, _)) = others {
            ratios.push(irit / (time * 1e3));
        }
        let fails = if FAILED.contains(&name) { "fails" } else { "" };
        let before = records.note(&format!("systems/{}", name.replace(',', "")), time);
        println!(
            "{name:<30} {:>2} {:>14} {:>14} {:>5} {:>9} {:>10.3} {:>9} {:>9} {:>6} {before:>7} {}",
            system.variables(),
            expected.as_deref().unwrap_or("?"),
            outcome.found,
            outcome.open,
            outcome.boxes,
            time * 1e3,
            others.map_or(String::new(), |o| o.1.to_string()),
            others.map_or(fails.to_owned(), |o| o.2.to_string()),
            others.map_or(String::new(), |o| format!("{:.0}", o.1 / (time * 1e3))),
            outcome.mark(state),
        );
    }
    let number = |state| states.iter().filter(|s| **s == state).count();
    println!(
        "{} complete, {} complete with clusters counted, {} open, {} wrong; {total:.2} s in all",
        number(State::Complete),
        number(State::Counted),
        number(State::Open),
        number(State::Wrong),
    );
    if !ratios.is_empty() {
        let mean = ratios.iter().map(|r: &f64| r.ln()).sum::<f64>() / ratios.len() as f64;
        println!(
            "IRIT's time over this one's, geometric mean of {}: {:.0}",
            ratios.len(),
            mean.exp()
        );
    }
    records.save()
}

fn expected(json: &Value) -> Option<String> {
    let expected = &json["expected"];
    let number = |key: &str| expected[key].as_i64();
    if let Some(count) = expected.as_i64() {
        return Some(count.to_string());
    }
    if let (Some(loops), Some(arcs)) = (number("loops"), number("arcs")) {
        return Some(format!("{loops} + {arcs}"));
    }
    Some(format!("{}, χ = {}", number("components")?, number("euler")?))
}

fn read(json: &Value) -> Result<System, String> {
    let strings = |key: &str| -> Vec<&str> {
        json[key]
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(Value::as_str)
            .collect()
    };
    let sides: Option<Vec<Enclosure>> = json["box"]
        .as_array()
        .into_iter()
        .flatten()
        .map(|side| Enclosure::new(side[0].as_f64()?, side[1].as_f64()?).ok())
        .collect();
    let domain = sides.ok_or("the box")?;
    if let Some(text) = json["bernstein_text"].as_str() {
        let forms = coefficients(text).ok_or("the coefficients")?;
        return System::mapped(&domain, forms).map_err(|error| error.to_string());
    }
    System::parse(&strings("equations"), &strings("vars"), &domain).map_err(|error| error.to_string())
}

/// Variables and equations, a line for each side of the box, and two lines for each form: degrees and coefficients.
fn coefficients(text: &str) -> Option<Vec<Bernstein>> {
    let mut lines = text.lines();
    let mut counts = lines.next()?.split_whitespace().map(str::parse::<usize>);
    let (variables, equations) = (counts.next()?.ok()?, counts.next()?.ok()?);
    let mut lines = lines.skip(variables);
    let form = |_| {
        let degrees: Result<Vec<usize>, _> = lines.next()?.split_whitespace().map(str::parse).collect();
        let values: Result<Vec<f64>, _> = lines.next()?.split_whitespace().map(str::parse).collect();
        Bernstein::new(&degrees.ok()?, values.ok()?).ok()
    };
    (0..equations).map(form).collect()
}

fn solve(system: &System) -> Result<Outcome, String> {
    let limited = |options: SolveOptions| options.time(Some(LIMIT));
    let widest = system
        .domain()
        .iter()
        .map(|side| 2.0 * side.radius())
        .fold(0.0, f64::max);
    let tolerance = TOLERANCE * widest;
    if system.equations() == system.variables() {
        let mut solver = PointSolver::new(limited(SolveOptions::default()));
        let points = solver.solve(system, &()).map_err(|error| error.to_string())?;
        return Ok(Outcome {
            found: points.roots.len().to_string(),
            open: points.unresolved.len(),
            zeros: points.unresolved.iter().map(|u| u.count.as_ref()?.zeros).collect(),
            branches: None,
            boxes: points.statistics.boxes,
        });
    }
    if system.equations() + 1 == system.variables() {
        let options = limited(CurveSolver::new(tolerance).options);
        let curves = CurveSolver::with_options(tolerance, options).solve(system, &());
        let curves = curves.map_err(|error| error.to_string())?;
        return Ok(Outcome {
            found: format!("{} + {}", curves.loops().count(), curves.arcs().count()),
            open: curves.singular.len(),
            zeros: None,
            branches: curves.singular.iter().map(branches).collect(),
            boxes: curves.statistics.boxes + curves.statistics.faces,
        });
    }
    let tolerance = 20.0 * tolerance;
    let options = limited(SurfaceSolver::new(tolerance).options);
    let surface = SurfaceSolver::with_options(tolerance, options).solve(system, &());
    let surface = surface.map_err(|error| error.to_string())?;
    Ok(Outcome {
        found: format!("{}, χ = {}", surface.components(), surface.euler_characteristic()),
        open: surface.unresolved.len(),
        zeros: None,
        branches: None,
        boxes: surface.statistics.boxes,
    })
}

/// The branches of a singular point; `None` if the box is open for another reason.
fn branches(singular: &Singular) -> Option<usize> {
    matches!(singular.cause, Cause::Smallest | Cause::Vanishing).then_some(singular.branches.len())
}
