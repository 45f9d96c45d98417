//! `section`: cuts the swept volume of a job by a plane.

use crate::arguments::{Output, SectionOptions};
use crate::session::{Failure, JobSession, Lines, read_job, words};
use crate::warnings::{self, Use};
use std::fmt::Write as _;
use std::io::Write as _;
use std::process::ExitCode;
use sweepsim::systems::Plane;
use sweepsim::{BoundaryPiece, Monitor, Options, Section, section as cut_by_plane};

/// What of a job it looks at.
const USE: Use = Use {
    command: "`section`",
    stock: false,
    grid: false,
    judges: false,
};

/// Cuts the swept volume by the plane, and writes `section.svg` and `section.csv`.
pub(crate) fn section(options: &SectionOptions) -> Result<ExitCode, Failure> {
    let read = read_job(&options.job, &options.program, None)?;
    let out = options.out.as_deref();
    let mut session = JobSession::new(&options.job, read, out, &[Output::Report], options.quiet)?;
    session.progress.phase("section");
    let sweeping = Options::new(options.tolerance.unwrap_or(session.job.tolerance));
    let found = cut_by_plane(
        &session.cuts(),
        &options.plane,
        options.chord,
        &sweeping,
        &session.progress as &dyn Monitor,
    );
    session.progress.finish();
    let found = found.map_err(|error| session.failed(error))?;
    let outputs = &mut session.outputs;
    outputs.write("section.svg", |file| file.write_all(found.svg().as_bytes()))?;
    outputs.write("section.csv", |file| file.write_all(table(&found).as_bytes()))?;
    if !options.quiet {
        let mut warnings = warnings::before(&session.job, USE);
        warnings.extend(missed(&options.plane, &found, &session));
        summary(&found, &warnings, &session).print()?;
    }
    Ok(if found.open.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(3)
    })
}

/// A plane that does not meet what the tools sweep, and where that is.
fn missed(plane: &Plane, section: &Section, session: &JobSession) -> Option<String> {
    if !section.curves.is_empty() {
        return None;
    }
    let normal = plane.normal();
    let boxes = session.cuts().into_iter().filter_map(|cut| cut.bounds());
    // The range of ⟨p, normal⟩ over a box.
    let ranges = boxes.map(|[low, high]| {
        let ends = [0, 1, 2].map(|k| [normal[k] * low[k], normal[k] * high[k]]);
        let sum = |pick: fn(f64, f64) -> f64| ends.iter().map(|[a, b]| pick(*a, *b)).sum::<f64>();
        [sum(f64::min), sum(f64::max)]
    });
    let [from, to] = ranges.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])?;
    let [x, y, z] = normal.map(words::length);
    Some(format!(
        "the section is empty: the plane lies at {}, what the tools sweep at {} … {} along ({x}, {y}, {z})",
        words::length(plane.offset()),
        words::length(from),
        words::length(to),
    ))
}

/// The name of a piece in `section.csv`.
fn name(piece: BoundaryPiece) -> String {
    match piece {
        BoundaryPiece::Patch(k) => format!("patch {k}"),
        BoundaryPiece::Edge(k) => format!("edge {k}"),
        BoundaryPiece::Placed(k) => format!("placed {k}"),
        BoundaryPiece::Last(k) => format!("last {k}"),
        _ => "other".to_owned(),
    }
}

/// One row per point, with numbers in the shortest form that reads back exactly.
fn table(section: &Section) -> String {
    let mut text = String::from("curve,path,move,t,piece,outer,x,y,z\n");
    for (number, curve) in section.curves.iter().enumerate() {
        for (point, outer) in curve.points.iter().zip(&curve.outer) {
            let [x, y, z] = point.position;
            // Writing to a String cannot fail.
            let _ = writeln!(
                text,
                "{number},{},{},{},{},{},{x},{y},{z}",
                curve.cut,
                curve.segment,
                point.t,
                name(curve.piece),
                u8::from(*outer),
            );
        }
    }
    text
}

/// The summary for the user.
fn summary(section: &Section, warnings: &[String], session: &JobSession) -> Lines {
    let mut lines = Lines::default();
    let points: usize = section.curves.iter().map(|curve| curve.points.len()).sum();
    lines.line(
        "section",
        &format!(
            "{} of {}, {} on the outline",
            words::counted(section.curves.len() as u64, "curve"),
            words::counted(points as u64, "point"),
            words::counted(section.outline().len() as u64, "part"),
        ),
    );
    for warning in warnings {
        lines.line("warning", warning);
    }
    for note in session.notes() {
        lines.line("note", &note);
    }
    for (path, piece, number) in &section.open {
        lines.line("unresolved", &format!("path {path}, move {number}: {}", name(*piece)));
    }
    lines.line("out", &session.outputs.listed());
    lines
}
