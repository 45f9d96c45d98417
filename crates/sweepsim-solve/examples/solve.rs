//! Solves equations given as text, prints all solutions and unresolved boxes, and draws the subdivision:
//!
//! `cargo run -p sweepsim-solve --example solve -- "x^2 + y^2 = 1" "y = x^3" --on x=-2..2,y=-2..2 --svg cubic.svg`
//!
//! As many equations as variables: points. One fewer: curves. One in three variables: a surface. `--tolerance 1e-6`
//! sets that of curves and surfaces, `--boxes 100000` and `--seconds 5` limit the search.

use std::process::ExitCode;
use std::time::Duration;
use sweepsim_solve::{
    CurveEnd, CurveSolver, Enclosure, Picture, PointSolver, RootLocation, SolveOptions, SurfaceSolver, System,
};

const USAGE: &str =
    "usage: solve \"EQUATION\"... --on x=-2..2,y=-2..2 [--tolerance 1e-3] [--boxes N] [--seconds S] [--svg FILE]";

#[derive(Default)]
struct Arguments {
    equations: Vec<String>,
    names: Vec<String>,
    domain: Vec<Enclosure>,
    tolerance: Option<f64>,
    boxes: Option<u64>,
    seconds: Option<f64>,
    svg: Option<String>,
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn arguments() -> Result<Arguments, String> {
    let mut arguments = Arguments::default();
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        if !word.starts_with("--") {
            arguments.equations.push(word);
            continue;
        }
        let value = words.next().ok_or_else(|| format!("{word} needs a value\n{USAGE}"))?;
        let number = |value: &str| {
            value
                .parse::<f64>()
                .map_err(|_| format!("{word}: `{value}` is not a number"))
        };
        match word.as_str() {
            "--on" => {
                for side in value.split(',') {
                    let bad = || format!("--on: `{side}` is not like x=-2..2");
                    let (name, ends) = side.split_once('=').ok_or_else(bad)?;
                    let (lo, hi) = ends.split_once("..").ok_or_else(bad)?;
                    let side = Enclosure::new(number(lo.trim())?, number(hi.trim())?);
                    arguments.names.push(name.trim().to_owned());
                    arguments.domain.push(side.map_err(|error| format!("--on: {error}"))?);
                }
            }
            "--tolerance" => arguments.tolerance = Some(number(&value)?),
            "--boxes" => arguments.boxes = Some(number(&value)? as u64),
            "--seconds" => arguments.seconds = Some(number(&value)?),
            "--svg" => arguments.svg = Some(value),
            _ => return Err(format!("{word} is unknown\n{USAGE}")),
        }
    }
    if arguments.equations.is_empty() || arguments.domain.is_empty() {
        return Err(USAGE.to_owned());
    }
    Ok(arguments)
}

fn run() -> Result<(), String> {
    let arguments = arguments()?;
    let system = System::parse(&arguments.equations, &arguments.names, &arguments.domain)
        .map_err(|error| error.render(false))?;
    let limited = |mut options: SolveOptions| -> Result<SolveOptions, String> {
        options.boxes = arguments.boxes.unwrap_or(options.boxes);
        if let Some(seconds) = arguments.seconds {
            let time = Duration::try_from_secs_f64(seconds).map_err(|error| format!("--seconds: {error}"))?;
            options.time = Some(time);
        }
        Ok(options)
    };
    let tolerance = arguments.tolerance.unwrap_or_else(|| {
        let widest = arguments
            .domain
            .iter()
            .map(|side| 2.0 * side.radius())
            .fold(0.0, f64::max);
        1e-3 * widest
    });
    let mut picture = Picture::new([0, usize::from(system.variables() > 1)]);
    let (n, m) = (system.variables(), system.equations());
    if n == m {
        points(&system, limited(SolveOptions::default())?, &arguments, &mut picture)?;
    } else if n == m + 1 {
        let options = limited(CurveSolver::new(tolerance).options)?;
        curves(&system, CurveSolver::with_options(tolerance, options), &mut picture)?;
    } else if (n, m) == (3, 1) {
        let options = limited(SurfaceSolver::new(tolerance).options)?;
        surface(&system, SurfaceSolver::with_options(tolerance, options), &mut picture)?;
    } else {
        return Err(format!(
            "{m} equations in {n} variables: expected as many, one fewer, or one in three"
        ));
    }
    if let Some(file) = &arguments.svg {
        std::fs::write(file, picture.svg(800.0)).map_err(|error| format!("{file}: {error}"))?;
        println!("picture: {file}");
    }
    Ok(())
}

fn bounds(sides: &[Enclosure]) -> String {
    let sides: Vec<String> = sides.iter().map(|s| format!("[{:?}, {:?}]", s.lo(), s.hi())).collect();
    sides.join(" × ")
}

fn points(system: &System, options: SolveOptions, arguments: &Arguments, picture: &mut Picture) -> Result<(), String> {
    let points = PointSolver::new(options)
        .solve(system, &*picture)
        .map_err(|error| error.to_string())?;
    println!(
        "{} roots, {} unresolved boxes, {} boxes searched",
        points.roots.len(),
        points.unresolved.len(),
        points.statistics.boxes
    );
    for root in &points.roots {
        picture.mark(&root.point);
        let values = arguments.names.iter().zip(&root.point);
        let values: Vec<String> = values.map(|(name, x)| format!("{name} = {x:?}")).collect();
        let place = match root.location {
            RootLocation::Boundary => ", on the boundary or next to it",
            _ => "",
        };
        println!("  {}{place}\n    in {}", values.join(", "), bounds(&root.enclosure));
    }
    for open in &points.unresolved {
        println!("  unresolved, {}: {}", open.cause, bounds(&open.bounds));
    }
    Ok(())
}

fn curves(system: &System, mut solver: CurveSolver, picture: &mut Picture) -> Result<(), String> {
    let curves = solver.solve(system, &*picture).map_err(|error| error.to_string())?;
    println!(
        "{} loops, {} arcs, {} singular or unresolved boxes, {} boxes searched",
        curves.loops().count(),
        curves.arcs().count(),
        curves.singular.len(),
        curves.statistics.boxes
    );
    for curve in &curves.curves {
        let points = curve.points.iter().map(|p| p.point.as_slice());
        let first = curve.points.first().map(|p| p.point.as_slice());
        picture.line(points.chain(first.filter(|_| curve.ends.is_none())));
        let end = |end: CurveEnd| match end {
            CurveEnd::Singular(number) => format!("singular box {number}"),
            _ => "the boundary".to_owned(),
        };
        match (&curve.ends, curve.points.first(), curve.points.last()) {
            (Some([a, b]), Some(from), Some(to)) => println!(
                "  arc of {} vertices from {:?} on {} to {:?} on {}",
                curve.points.len(),
                from.point,
                end(*a),
                to.point,
                end(*b)
            ),
            (_, Some(from), _) => println!("  loop of {} vertices through {:?}", curve.points.len(), from.point),
            _ => {}
        }
    }
    for (number, open) in curves.singular.iter().enumerate() {
        println!(
            "  singular box {number}, {}, {} branches: {}",
            open.cause,
            open.branches.len(),
            bounds(&open.bounds)
        );
    }
    Ok(())
}

fn surface(system: &System, mut solver: SurfaceSolver, picture: &mut Picture) -> Result<(), String> {
    let surface = solver.solve(system, &()).map_err(|error| error.to_string())?;
    println!(
        "{} vertices, {} triangles, {} components, Euler characteristic {}, {} unresolved boxes",
        surface.vertices.len(),
        surface.triangles.len(),
        surface.components(),
        surface.euler_characteristic(),
        surface.unresolved.len()
    );
    for triangle in &surface.triangles {
        let corners = [0, 1, 2, 0].map(|k| surface.vertices[triangle[k] as usize]);
        picture.line(corners.iter().map(<[f64; 3]>::as_slice));
    }
    for open in &surface.unresolved {
        println!("  unresolved, {}: {}", open.cause, bounds(&open.bounds));
    }
    Ok(())
}
