//! `compare`: reports how a part differs from its target.

use super::verify::targets;
use crate::arguments::{CompareOptions, GivenLimits, Output};
use crate::session::{Failure, Lines, Outputs, Solid, bounds, output_folder, picture, print, soup, words};
use std::io::Write as _;
use std::ops::ControlFlow;
use std::time::Instant;
use sweepsim::verify::deviations;
use sweepsim_dexel::{
    Comparison, Dexels, DistanceTo, Mesh, Nearest, Operation, TriangleSoup, compare_tri_with_mesh, compare_with_mesh,
};
use sweepsim_formats::{
    ComparisonReport, DeviationSummary, Furthest, HistogramBar, Job, LimitRegion, Limits, MeshFormat, RegionPlace,
    ReportedRegion, Target as Goal, read_coloured_mesh_file,
};

/// The most regions that are named one by one.
const NAMED: usize = 10;
/// Bars of the histogram.
const BARS: usize = 20;

/// Compares two parts, and writes a report and a picture.
pub(crate) fn compare(options: &CompareOptions) -> Result<(), Failure> {
    let mut report = ComparisonReport::default();
    report.part = options.part.display().to_string();
    report.target = options.target.display().to_string();
    report.tolerance = options.tolerance;
    let start = Instant::now();
    let [part, target] = read(options)?;
    let name = options.part.file_stem().unwrap_or_default().to_string_lossy();
    let folder = output_folder(options.out.as_deref(), &name);
    let mut outputs = Outputs::new(folder, &[Output::Picture, Output::Report])?;
    let (mesh, goal) = (part.surface()?, target.surface()?);
    let around =
        bounds(&mesh).ok_or_else(|| Failure::message(format!("{}: this part is empty", options.part.display())))?;
    if bounds(&goal).is_none() {
        let message = format!("{}: this target is empty", options.target.display());
        return Err(Failure::message(message));
    }
    let grid = match (part.grid(), target.grid(), options.grid.grid(Some(around))?) {
        (Some(grid), ..) | (None, Some(grid), _) | (None, None, Some(grid)) => grid,
        (None, None, None) => return Err(Failure::message("no grid to compare on")),
    };
    report.seconds.insert("read".to_owned(), start.elapsed().as_secs_f64());
    let start = Instant::now();
    let dexels = part.dexels(&options.part, &grid)?;
    let surface = match &target {
        Solid::Dexels(_) | Solid::TriDexels(_) => soup(&goal),
        Solid::Mesh(target) => soup(target),
    };
    let failed = |error: &dyn std::fmt::Display| Failure::message(format!("{}: {error}", options.target.display()));
    let found = match &part {
        Solid::TriDexels(part) => compare_tri_with_mesh(part, &surface),
        Solid::Dexels(_) | Solid::Mesh(_) => compare_with_mesh(&dexels, &surface),
    };
    let found = found.map_err(|error| failed(&error))?;
    describe(&mut report, options, &found);
    regions(&mut report, options, &dexels, surface)?;
    report.cells = grid.cells();
    let tree = DistanceTo::new(&soup(&goal))?;
    let [dx, dy] = grid.spacing();
    let spacing = dx.min(dy);
    // Of dexels only the ends are exact, not the triangles between them.
    report.furthest_of_part = match &part {
        Solid::Mesh(_) => tree.furthest(&soup(&mesh), spacing).map(furthest_of),
        Solid::Dexels(dexels) => furthest_end(dexels, |place, _| tree.nearest(place)),
        Solid::TriDexels(part) => {
            let of = |set| furthest_end(set, |place, _| tree.nearest(place));
            part.sets().iter().filter_map(of).reduce(further)
        }
    };
    let own = DistanceTo::new(&soup(&mesh))?;
    report.furthest_of_target = match &target {
        Solid::Mesh(_) => own.most_missing(&soup(&goal), &tree, spacing).map(furthest_of),
        Solid::Dexels(dexels) => furthest_end(dexels, |place, normal| own.missing_at(place, normal, &tree)),
        Solid::TriDexels(target) => {
            let of = |set| furthest_end(set, |place, normal| own.missing_at(place, normal, &tree));
            target.sets().iter().filter_map(of).reduce(further)
        }
    };
    worst(&mut report, options.tolerance);
    report
        .seconds
        .insert("compare".to_owned(), start.elapsed().as_secs_f64());
    let start = Instant::now();
    let values = values(&mesh, &tree);
    let largest = values
        .iter()
        .copied()
        .filter(|v| v.is_finite())
        .fold(0.0, |a: f32, v| a.max(v.abs()));
    let range = options
        .range
        .unwrap_or(round(f64::from(largest).max(options.tolerance)));
    let (png, missed) = picture(&options.view, &mesh, Some((&values, range)), &|_| {
        ControlFlow::Continue(())
    })?;
    report.warnings = missed;
    outputs.write("comparison.png", |file| file.write_all(&png))?;
    report
        .seconds
        .insert("picture".to_owned(), start.elapsed().as_secs_f64());
    let json = report
        .to_json()
        .map_err(|error| Failure::message(format!("cannot make the report: {error}")))?;
    outputs.write("comparison.json", |file| file.write_all(json.as_bytes()))?;
    if options.json {
        print(&json)
    } else if options.quiet {
        Ok(())
    } else {
        summary(&report, &outputs).print()
    }
}

/// Reads both parts. A table of dexels takes the grid of the other part, unless the options name one.
fn read(options: &CompareOptions) -> Result<[Solid; 2], Failure> {
    let given = if options.grid.grid.is_some() || options.grid.area.is_some() {
        options.grid.grid(None)?
    } else {
        None
    };
    let files = [&options.part, &options.target];
    let table = files.map(|file| file.extension().is_some_and(|e| e.eq_ignore_ascii_case("csv")));
    match table {
        [true, false] => {
            let target = Solid::read(files[1], given.as_ref())?;
            let grid = given.or(target.grid());
            Ok([Solid::read(files[0], grid.as_ref())?, target])
        }
        _ => {
            let part = Solid::read(files[0], given.as_ref())?;
            let grid = given.or(part.grid());
            let target = Solid::read(files[1], grid.as_ref())?;
            Ok([part, target])
        }
    }
}

/// The connected regions beyond the limits: those of `--limits`.
fn regions(
    report: &mut ComparisonReport,
    options: &CompareOptions,
    dexels: &Dexels,
    surface: TriangleSoup,
) -> Result<(), Failure> {
    let limits = match &options.limits {
        None => Limits::new(targets::LIMIT, targets::LIMIT),
        Some(GivenLimits::Both([gouge, excess])) => Limits::new(*gouge, *excess),
        Some(GivenLimits::Job(file)) => Job::read(file)?
            .limits
            .ok_or_else(|| Failure::message(format!("{}: this job has no limits", file.display())))?,
    };
    let by_colour = |region: &LimitRegion| matches!(region.place, RegionPlace::Colour(_));
    let colours = if limits.regions.iter().any(by_colour) && MeshFormat::of(&options.target).is_some() {
        read_coloured_mesh_file(&options.target)?.1
    } else {
        Vec::new()
    };
    let failed = |error: &dyn std::fmt::Display| Failure::message(format!("{}: {error}", options.target.display()));
    let parts = Goal::new(options.target.clone(), surface.clone(), colours).by_region(&limits);
    let target = targets::with_limits(&surface, Some(parts), Some(&limits), dexels.grid(), options.tolerance);
    let target = target.map_err(|error| failed(&error))?;
    // What is missing is missing, whatever the stock was.
    let mut stock = dexels.clone();
    stock
        .combine(Operation::Union, target.solid())
        .map_err(|error| failed(&error))?;
    let found = deviations(&stock, dexels, &target);
    report.limits = [limits.gouge, limits.excess];
    report.regions = targets::regions(&found, Some(&limits));
    Ok(())
}

/// The worst is the worst: of the ends of the dexels, of the part's surface between them, and of what of the target has no counterpart.
fn worst(report: &mut ComparisonReport, tolerance: f64) {
    let of_part = report.furthest_of_part.map(|furthest| furthest.distance);
    // A point of the target outside the part: there the part is missing.
    let of_target = report.furthest_of_target.map(|furthest| -furthest.distance);
    for distance in [of_part, of_target].into_iter().flatten() {
        let side = if distance < 0.0 {
            &mut report.gouge
        } else {
            &mut report.excess
        };
        if distance.abs() > tolerance {
            side.max = side.max.max(distance.abs());
        }
    }
}

/// The end of dexels that is farthest from another surface: `of` gets its place and its normal.
fn furthest_end(dexels: &Dexels, of: impl Fn([f64; 3], [f64; 3]) -> Option<Nearest> + Sync) -> Option<Furthest> {
    use rayon::prelude::*;
    let (grid, frame) = (dexels.grid(), dexels.grid().frame());
    let lines: Vec<usize> = dexels.iter().map(|(line, _)| line).collect();
    let of_line = |line: &usize| {
        let (i, j) = grid.place(*line);
        let ends = dexels
            .at(*line)
            .iter()
            .flat_map(|interval| [interval.lower, interval.upper]);
        let found = ends.filter_map(|end| {
            let place = frame.to_world([grid.x(i), grid.y(j), end.z]);
            let near = of(place, frame.turn_to_world(end.normal.map(f64::from)))?;
            Some(furthest_of((place, near)))
        });
        found.reduce(further)
    };
    let found: Vec<Option<Furthest>> = lines.par_iter().map(of_line).collect();
    found.into_iter().flatten().reduce(further)
}

fn further(a: Furthest, b: Furthest) -> Furthest {
    if b.distance.abs() > a.distance.abs() { b } else { a }
}

fn furthest_of((place, near): ([f64; 3], Nearest)) -> Furthest {
    Furthest {
        place,
        distance: near.distance,
    }
}

/// Rounds up to a number of one or two digits, for a readable scale.
fn round(value: f64) -> f64 {
    let whole = 10_f64.powf(value.log10().floor());
    let steps = [1.0, 1.2, 1.6, 2.0, 2.4, 3.0, 4.0, 5.0, 6.0, 8.0];
    // For values beyond the last step, or if the logarithm was rounded down.
    steps
        .into_iter()
        .map(|step| step * whole)
        .find(|step| *step >= value)
        .unwrap_or(10.0 * whole)
}

/// The distance of each vertex from the target, positive outside.
fn values(mesh: &Mesh, tree: &DistanceTo) -> Vec<f32> {
    use rayon::prelude::*;
    let places = mesh.vertices.par_iter();
    places
        .map(|p| tree.nearest(*p).map_or(f32::NAN, |near| near.distance as f32))
        .collect()
}

/// Fills in the report.
fn describe(report: &mut ComparisonReport, options: &CompareOptions, found: &Comparison) {
    report.volume = found.volume;
    report.target_volume = found.target;
    report.excess_volume = found.excess;
    report.missing_volume = found.missing;
    report.area = found.area();
    report.unmatched = found.unmatched();
    report.mean = found.mean();
    report.rms = found.rms();
    let side = |sign: f64| {
        let mut all = DeviationSummary::default();
        for (distance, area) in found
            .deviations
            .iter()
            .filter_map(|d| Some((sign * d.distance?, d.area)))
        {
            if distance > options.tolerance {
                all.max = all.max.max(distance);
                all.mean += area * distance;
                all.rms += area * distance * distance;
                all.area += area;
                all.count += 1;
            }
        }
        if all.area > 0.0 {
            all.mean /= all.area;
            all.rms = (all.rms / all.area).sqrt();
        }
        all
    };
    report.gouge = side(-1.0);
    report.excess = side(1.0);
    if let Some([low, high]) = found.range() {
        let step = (high - low) / BARS as f64;
        let limit = |k: usize| low + step * k as f64;
        let limits: Vec<f64> = (1..BARS).map(limit).collect();
        let areas = found.histogram(&limits);
        let bars = areas.iter().enumerate().map(|(k, area)| HistogramBar {
            from: limit(k),
            to: limit(k + 1),
            area: *area,
        });
        report.histogram = bars.collect();
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
