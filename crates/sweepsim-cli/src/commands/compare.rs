//! `compare`: reports how a part differs from its target.

use super::faces::{by_face, length};
use crate::arguments::CompareOptions;
use crate::session::{Failure, Lines, Outputs, Progress, print};
use sweepsim_formats::{ComparisonReport, DeviationSummary, ReportedAlignment, ReportedRegion};
use sweepsim_job::{DeviationLimits, output_folder, words};

/// The most regions that are named one by one.
const NAMED: usize = 10;

/// Compares two parts, and writes a report and a picture.
pub(crate) fn compare(options: &CompareOptions) -> Result<(), Failure> {
    let request = options.request();
    let pair = request.read()?;
    let name = options.part.file_stem().unwrap_or_default().to_string_lossy();
    let mut outputs = Outputs::new(output_folder(options.out.as_deref(), &name))?;
    let progress = Progress::new(0, true);
    let found = pair.compare(&progress)?;
    found.write_to(&mut outputs)?;
    if options.json {
        print(&found.json()?)
    } else if options.quiet {
        Ok(())
    } else {
        summary(&found.report, options.limits.as_ref(), &outputs).print()
    }
}

/// The summary for the user.
fn summary(report: &ComparisonReport, limits: Option<&DeviationLimits>, outputs: &Outputs) -> Lines {
    let mut lines = Lines::default();
    let mut line = |label: &str, value: &str| lines.line(label, value);
    let volume = |value: f64| format!("{} mm³", words::measure(value));
    line(
        "volume",
        &format!("{}, target {}", volume(report.volume), volume(report.target_volume)),
    );
    line(
        "excess",
        &format!("{}, {}", volume(report.excess_volume), words_of(&report.excess)),
    );
    line(
        "missing",
        &format!("{}, {}", volume(report.missing_volume), words_of(&report.gouge)),
    );
    if let Some(alignment) = &report.alignment {
        aligned(&mut line, alignment);
    }
    let [gouge, excess] = report.limits.map(length);
    let count = words::counted(report.regions.len() as u64, "region");
    let beyond = format!("deeper than {gouge} or higher than {excess} mm");
    line(
        "limits",
        &match limits {
            Some(DeviationLimits::Job(job)) => format!(
                "{count} beyond the limits of {}: {beyond} where no region of it says otherwise",
                job.display()
            ),
            _ => format!("{count} {beyond}"),
        },
    );
    for region in report.regions.iter().take(NAMED) {
        line(&region.kind, &region_in_words(region));
    }
    if report.regions.len() > NAMED {
        line(
            "",
            &format!("… and {} more, all in comparison.json", report.regions.len() - NAMED),
        );
    }
    for (label, found) in [("part", &report.of_part), ("target", &report.of_target)] {
        let place = found
            .place
            .map_or(String::new(), |place| format!(" at {}", words::point(place)));
        let [largest, mean, rms] = [found.largest, found.mean, found.rms].map(range);
        let area = words::measure(found.area);
        line(
            label,
            &format!("largest distance {largest} mm{place}; mean {mean}, RMS {rms} mm, over {area} mm²"),
        );
    }
    let open = [&report.of_part, &report.of_target].map(|found| found.largest[0] < found.largest[1]);
    if open.contains(&true) {
        line(
            "note",
            "[a, b] is between a and b: dexels along one axis do not tell where a wall is between two of their lines",
        );
    }
    by_face(&report.faces, "comparison.json", &mut line);
    for warning in &report.warnings {
        line("warning", warning);
    }
    line("out", &outputs.listed());
    lines
}

fn region_in_words(region: &ReportedRegion) -> String {
    let [depth, area] = [region.depth, region.area].map(words::measure);
    let of = region
        .region
        .as_ref()
        .map_or(String::new(), |name| format!(", in region {name}"));
    let on = region
        .face
        .as_ref()
        .map_or(String::new(), |face| format!(" on face {face}"));
    format!("{depth} mm at {}{on}, {area} mm²{of}", words::point(region.place))
}

/// How the part was laid onto the target, what is left, and what is not determined.
fn aligned(line: &mut impl FnMut(&str, &str), alignment: &ReportedAlignment) {
    let how = match alignment.kind.as_str() {
        "datum" => format!("by the faces {}", alignment.datums.join(", ")),
        kind => format!("by {kind}"),
    };
    let moved = if alignment.inverse {
        "the target moved back"
    } else {
        "moved"
    };
    line(
        "aligned",
        &format!(
            "{how}: turned by {}° and {moved} by {}; then it is off by {} mm (RMS), at most by {} mm, at {} points",
            length(alignment.angle),
            words::point(alignment.translation),
            length(alignment.rms),
            length(alignment.largest),
            words::count(alignment.points as u64)
        ),
    );
    for motion in &alignment.undetermined {
        line(
            "note",
            &format!("{motion} changes nothing: the part stays as it was along it"),
        );
    }
}

/// What a length may be: one number if it is known.
fn range([least, most]: [f64; 2]) -> String {
    if length(least) == length(most) {
        length(least)
    } else {
        format!("[{}, {}]", length(least), length(most))
    }
}

fn words_of(deviation: &DeviationSummary) -> String {
    let largest = range([deviation.max, deviation.at_most.unwrap_or(deviation.max)]);
    match (deviation.count, deviation.at_most) {
        (0, None) if deviation.max == 0.0 => "nothing beyond the tolerance".to_owned(),
        (0, _) => format!("largest {largest} mm"),
        (count, _) => {
            let (mean, count) = (length(deviation.mean), words::counted(count as u64, "point"));
            format!("largest {largest}, mean {mean} mm, at {count} of the part")
        }
    }
}
