//! `section`: the curves in which a plane cuts what a job's tools sweep.

use crate::arguments::{Output, SectionOptions};
use crate::failure::Failure;
use crate::outputs::Outputs;
use crate::progress::Progress;
use crate::run::{cuts_of, folder_name, notes_of};
use crate::words;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;
use std::process::ExitCode;
use sweepsim::systems::Plane;
use sweepsim::{BoundaryPiece, Monitor, Options, Section, SweepError, section};
use sweepsim_formats::Job;

/// Cuts the job's sweeps by the plane; writes `section.svg` and `section.csv`.
pub(crate) fn run(options: &SectionOptions) -> Result<ExitCode, Failure> {
    let job = Job::read(&options.job)?;
    let folder = options
        .out
        .clone()
        .unwrap_or_else(|| Path::new("out").join(folder_name(&job.name)));
    let mut outputs = Outputs::new(folder, &[Output::Report])?;
    let progress = Progress::new(job.moves(), options.quiet);
    progress.phase("section");
    let sweeping = Options::new(options.tolerance.unwrap_or(job.tolerance));
    let found = section(
        &cuts_of(&job),
        &options.plane,
        options.chord,
        &sweeping,
        &progress as &dyn Monitor,
    );
    progress.finish();
    let found = found.map_err(|error| match error {
        SweepError::Cancelled => Failure::Interrupted,
        error => Failure::message(format!("{}: {error}", options.job.display())),
    })?;
    outputs.write("section.svg", |file| file.write_all(found.svg().as_bytes()))?;
    outputs.write("section.csv", |file| file.write_all(table(&found).as_bytes()))?;
    if !options.quiet {
        crate::print(&summary(&found, &notes_of(&job, &options.job), &outputs))?;
    }
    Ok(if found.open.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(3)
    })
}

/// What a piece is called in `section.csv`.
fn name(piece: BoundaryPiece) -> String {
    match piece {
        BoundaryPiece::Patch(k) => format!("patch {k}"),
        BoundaryPiece::Edge(k) => format!("edge {k}"),
        BoundaryPiece::Placed(k) => format!("placed {k}"),
        BoundaryPiece::Last(k) => format!("last {k}"),
        _ => "other".to_owned(),
    }
}

/// One row a point; numbers in the shortest form that reads back to the same.
fn table(section: &Section) -> String {
    let mut text = String::from("curve,path,move,t,piece,outer,x,y,z\n");
    for (number, curve) in section.curves.iter().enumerate() {
        for (point, outer) in curve.points.iter().zip(&curve.outer) {
            let [x, y, z] = point.position;
            // A String takes all that is written to it.
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

fn summary(section: &Section, notes: &[String], outputs: &Outputs) -> String {
    let points: usize = section.curves.iter().map(|curve| curve.points.len()).sum();
    let mut text = format!(
        "   section  {} of {}, {} of outline\n",
        words::counted(section.curves.len() as u64, "curve"),
        words::counted(points as u64, "point"),
        words::counted(section.outline().len() as u64, "part"),
    );
    for note in notes {
        let _ = writeln!(text, "      note  {note}");
    }
    for (path, piece, number) in &section.open {
        let _ = writeln!(text, "unresolved  path {path}, move {number}: {}", name(*piece));
    }
    let files: Vec<String> = outputs
        .written
        .iter()
        .map(|(name, size)| format!("{name} ({})", words::bytes(*size)))
        .collect();
    let _ = writeln!(text, "       out  {}: {}", outputs.folder().display(), files.join(", "));
    text
}

/// `x=1.5`, `y=…`, `z=…`, or `a,b,c=d` for the plane `a x + b y + c z = d`.
pub(crate) fn plane(text: &str) -> Result<Plane, String> {
    let wrong = || "expected a plane, like x=3.5, or a,b,c=d for a x + b y + c z = d".to_owned();
    let (normal, offset) = text.split_once('=').ok_or_else(wrong)?;
    let offset: f64 = offset.trim().parse().map_err(|_| wrong())?;
    let normal = match normal.trim() {
        "x" => [1.0, 0.0, 0.0],
        "y" => [0.0, 1.0, 0.0],
        "z" => [0.0, 0.0, 1.0],
        list => {
            let numbers: Result<Vec<f64>, _> = list.split(',').map(|part| part.trim().parse()).collect();
            numbers.ok().and_then(|n| n.try_into().ok()).ok_or_else(wrong)?
        }
    };
    let length = normal.iter().map(|x: &f64| x * x).sum::<f64>().sqrt();
    if !(length > 0.0 && length.is_finite() && offset.is_finite()) {
        return Err(wrong());
    }
    Ok(Plane { normal, offset })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_are_read() {
        assert_eq!(plane("x=3.5"), Ok(Plane::x(3.5)));
        assert_eq!(plane(" z = -1 "), Ok(Plane::z(-1.0)));
        let slanted = Plane {
            normal: [1.0, 0.0, 2.0],
            offset: 4.0,
        };
        assert_eq!(plane("1,0,2=4"), Ok(slanted));
        for bad in [
            "",
            "x",
            "x=",
            "w=1",
            "1,2=3",
            "0,0,0=1",
            "1,2,3,4=5",
            "x=NaN",
            "inf,0,0=1",
        ] {
            assert!(plane(bad).is_err(), "{bad}");
        }
    }
}
