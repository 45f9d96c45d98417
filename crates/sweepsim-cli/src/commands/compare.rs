//! `compare`: reports how a part differs from its target.

use crate::arguments::CompareOptions;
use crate::session::{Failure, Lines, Outputs, Progress, print};
use sweepsim_formats::{ComparisonReport, DeviationSummary, Furthest, ReportedRegion};
use sweepsim_job::{output_folder, words};

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
        summary(&found.report, &outputs).print()
    }
}

/// The summary for the user.
fn summary(report: &ComparisonReport, outputs: &Outputs) -> Lines {
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
    let [mean, rms] = [report.mean, report.rms].map(length);
    let area = words::measure(report.area);
    line("distance", &format!("mean {mean}, RMS {rms} mm, over {area} mm²"));
    let [gouge, excess] = report.limits.map(length);
    let count = words::counted(report.regions.len() as u64, "region");
    line(
        "limits",
        &format!("{count} deeper than {gouge} or higher than {excess} mm"),
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
    for (label, furthest) in [("part", report.furthest_of_part), ("target", report.furthest_of_target)] {
        if let Some(Furthest { place, distance }) = furthest {
            let (distance, place) = (length(distance), words::point(place));
            line("furthest", &format!("{distance} mm at {place}, of the {label}"));
        }
    }
    if report.unmatched > 0 {
        line(
            "note",
            &format!(
                "{} without a counterpart",
                words::counted(report.unmatched as u64, "end")
            ),
        );
    }
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
    format!("{depth} mm at {}, {area} mm²{of}", words::point(region.place))
}

/// A distance. Values below the rounding errors of millimetres in `f64` are shown as 0.
fn length(value: f64) -> String {
    words::measure(if value.abs() < 1e-10 { 0.0 } else { value })
}

fn words_of(deviation: &DeviationSummary) -> String {
    if deviation.count == 0 && deviation.max == 0.0 {
        return "nothing beyond the tolerance".to_owned();
    }
    let [max, mean] = [deviation.max, deviation.mean].map(length);
    let count = words::counted(deviation.count as u64, "end");
    format!("up to {max}, mean {mean} mm, at {count}")
}
