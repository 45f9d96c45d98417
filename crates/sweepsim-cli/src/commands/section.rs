//! `section`: cuts the swept volume of a job by a plane.

use crate::arguments::SectionOptions;
use crate::session::{Failure, Lines, Outputs, Progress};
use std::process::ExitCode;
use sweepsim_job::{PlaneSection, output_folder, words};

/// Cuts the swept volume by the plane, and writes `section.svg` and `section.csv`.
pub(crate) fn section(options: &SectionOptions) -> Result<ExitCode, Failure> {
    let plan = options.request().plan()?;
    let mut outputs = Outputs::new(output_folder(options.out.as_deref(), &plan.job().name))?;
    let progress = Progress::new(plan.job().moves(), options.quiet);
    let found = plan.section(&options.plane, options.chord, &progress);
    progress.finish();
    let found = found?;
    found.write_to(&mut outputs)?;
    if !options.quiet {
        summary(&found, &outputs).print()?;
    }
    Ok(ExitCode::from(if found.is_certified() { 0 } else { 3 }))
}

/// The summary for the user.
fn summary(found: &PlaneSection, outputs: &Outputs) -> Lines {
    let mut lines = Lines::default();
    let section = &found.section;
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
    for warning in &found.warnings {
        lines.line("warning", warning);
    }
    for note in &found.notes {
        lines.line("note", note);
    }
    for open in found.unresolved() {
        lines.line("unresolved", &open);
    }
    lines.line("out", &outputs.listed());
    lines
}
