//! The tables of the page: set-ups and tools.

use super::PageSource;
use super::course::Courses;
use crate::base::words::{self, clock};
use crate::describe::tool_in_words;
use crate::request::Task;
use sweepsim_dexel::{Frame, Stock};
use sweepsim_formats::{AxisTravel, FaceDeviation, Job, JobPath, Report};
use sweepsim_report::{Table, measure};

/// Fixtures that are described one by one.
const DESCRIBED: usize = 12;

/// A box: its lowest and highest corner.
type Corners = [[f64; 3]; 2];

fn point(place: [f64; 3]) -> String {
    place.map(measure).join(", ")
}

/// A box that holds a solid, in the coordinates of a frame.
fn seen(solid: &Stock, frame: &Frame) -> Option<Corners> {
    if frame.is_world() {
        return solid.bounds();
    }
    let unit = |k: usize| [0, 1, 2].map(|j| if j == k { 1.0 } else { 0.0 });
    let axes = [0, 1, 2].map(|k| frame.turn_from_world(unit(k)));
    let inverse = Frame::from_axes(frame.from_world([0.0; 3]), axes).ok();
    // Dexels stay as they are: a box around their box.
    if let Some(turned) = inverse.and_then(|inverse| solid.placed(&inverse)) {
        return turned.bounds();
    }
    let [low, high] = solid.bounds()?;
    let corner = |n: usize| frame.from_world([0, 1, 2].map(|k| if n >> k & 1 == 0 { low[k] } else { high[k] }));
    (0..8).map(corner).map(|p| [p, p]).reduce(|[a, b], [c, d]| {
        [
            [0, 1, 2].map(|k| f64::min(a[k], c[k])),
            [0, 1, 2].map(|k| f64::max(b[k], d[k])),
        ]
    })
}

fn size([low, high]: Corners) -> String {
    let size = [0, 1, 2].map(|k| measure(high[k] - low[k]));
    format!("{} × {} × {} mm", size[0], size[1], size[2])
}

/// What the person at the machine needs: a table for each set-up, and one for what they share.
pub(super) fn setups(source: &PageSource) -> Vec<Table> {
    let job = source.session.job;
    let mut tables: Vec<Table> = (0..job.setups.len()).map(|number| setup(source, number)).collect();
    let mut rows = Vec::new();
    let mut row = |name: &str, value: String| rows.push(vec![name.to_owned(), value]);
    let words = |gouge, excess| format!("gouge {} mm, excess {} mm", measure(gouge), measure(excess));
    if let Some(limits) = &job.limits {
        row("Limits", words(limits.gouge, limits.excess));
        for region in &limits.regions {
            let name = format!("Region {}", region.name);
            row(&name, words(region.gouge, region.excess));
        }
    }
    let [dx, dy] = job.grid.spacing().map(measure);
    row("Grid", format!("a dexel every {dx} × {dy} mm"));
    match tables.as_mut_slice() {
        [only] => only.rows.append(&mut rows),
        _ => tables.push(table("All set-ups".to_owned(), rows)),
    }
    tables
}

fn table(title: String, rows: Vec<Vec<String>>) -> Table {
    Table {
        title,
        rows,
        printed: true,
        ..Table::default()
    }
}

fn setup(source: &PageSource, number: usize) -> Table {
    let job = source.session.job;
    let setup = &job.setups[number];
    let name = job.setup_name(number);
    let mut rows = Vec::new();
    let mut row = |name: &str, value: String| rows.push(vec![name.to_owned(), value]);
    if name.is_some() {
        let [x, _, z] = setup.frame.axes().map(words::direction);
        row("Up, right", format!("{z} and {x} of the part"));
        row("Zero on the part", format!("{} mm", point(setup.frame.origin())));
    }
    let stock = seen(&job.stock, &setup.frame).filter(|_| source.session.request.task != Task::Sweep);
    if let Some([low, high]) = stock {
        row("Stock", size([low, high]));
        row("Lowest corner", format!("{} mm", point(low)));
        row("Highest corner", format!("{} mm", point(high)));
        row("Program zero", zero([low, high]));
    }
    for (k, fixture) in setup.fixtures.iter().take(DESCRIBED).enumerate() {
        if let Some([low, high]) = seen(fixture, &setup.frame) {
            let name = if setup.fixtures.len() == 1 {
                "Fixture".to_owned()
            } else {
                format!("Fixture {}", k + 1)
            };
            row(
                &name,
                format!("{}, from {} to {} mm", size([low, high]), point(low), point(high)),
            );
        }
    }
    if setup.fixtures.len() > DESCRIBED {
        let more = words::count((setup.fixtures.len() - DESCRIBED) as u64);
        row("Further fixtures", more);
    }
    if name.is_some() {
        for (what, value) in work(source, job, number) {
            row(what, value);
        }
    }
    table(name.map_or("Set-up".to_owned(), |name| format!("Set-up {name}")), rows)
}

/// Programs, tools and time of a set-up.
fn work(source: &PageSource, job: &Job, number: usize) -> Vec<(&'static str, String)> {
    let mut rows = Vec::new();
    let own = || job.paths.iter().filter(|path| path.setup == number);
    let mut programs: Vec<&str> = Vec::new();
    let from_file = |path: &&JobPath| !path.files.is_empty();
    for path in own().filter(from_file) {
        if !programs.contains(&path.source.as_str()) {
            programs.push(&path.source);
        }
    }
    if !programs.is_empty() {
        rows.push(("Programs", programs.join(", ")));
    }
    let Some(summary) = source.report.setups.as_ref().and_then(|setups| setups.get(number)) else {
        return rows;
    };
    if !summary.tools.is_empty() {
        let tools: Vec<String> = summary.tools.iter().map(|tool| format!("T{tool}")).collect();
        rows.push(("Tools", tools.join(", ")));
    }
    if let Some(work) = &summary.work {
        if work.untimed == 0 && work.total_seconds() > 0.0 {
            rows.push(("Machine time", clock(work.total_seconds())));
        }
        rows.push(("Removed", format!("{} mm³", measure(work.removed))));
    }
    rows
}

/// Where the zero of a set-up is on the stock.
fn zero([low, high]: Corners) -> String {
    let zero = [0, 1, 2].map(|k| {
        let (from, to) = (low[k], high[k]);
        let near = 1e-9 * (to - from);
        let place = match 0.0_f64 {
            z if (z - from).abs() <= near => "lower side",
            z if (z - to).abs() <= near => "upper side",
            z if (z - 0.5 * (from + to)).abs() <= near => "middle",
            z if z > from && z < to => "inside",
            _ => "outside",
        };
        format!("{} {place}", ["X", "Y", "Z"][k])
    });
    zero.join(", ")
}

/// What the tools are, and what they do.
pub(super) fn tools(source: &PageSource, made: &Courses) -> Table {
    let job = source.session.job;
    let removed = |number: u32| -> Option<f64> {
        let paths = source.report.paths.as_ref()?;
        Some(
            paths
                .iter()
                .filter(|path| path.tool == number)
                .map(|path| path.removed)
                .sum(),
        )
    };
    let seconds = |number: u32| -> Option<f64> {
        let tools = source.report.tools.as_ref()?;
        tools
            .iter()
            .find(|summary| summary.tool == number)
            .map(|summary| summary.work.total_seconds())
    };
    let row = |(number, tool)| {
        let number: &u32 = number;
        let own = || {
            job.paths
                .iter()
                .zip(&made.lengths)
                .filter(|(path, _)| path.tool == *number)
        };
        let moves: usize = own().map(|(path, _)| path.path.moves()).sum();
        let [cut, rapid] = own().fold([0.0; 2], |sum, (_, own)| [sum[0] + own[0], sum[1] + own[1]]);
        let bodies = job.bodies.get(number).map_or(0, Vec::len);
        let mut shape = tool_in_words(tool);
        if bodies > 0 {
            shape += &format!(", with {}", if bodies == 1 { "a holder" } else { "shank and holder" });
        }
        vec![
            format!("T{number}"),
            shape,
            words::count(moves as u64),
            format!("{cut:.0}"),
            format!("{rapid:.0}"),
            seconds(*number).map_or("–".to_owned(), clock),
            removed(*number).map_or("–".to_owned(), measure),
        ]
    };
    Table {
        title: "Tools".to_owned(),
        columns: ["Tool", "Shape", "Moves", "Feed mm", "Rapid mm", "Time", "Removed mm³"]
            .map(str::to_owned)
            .into(),
        rows: job.tools.iter().map(row).collect(),
        numbers: vec![2, 3, 4, 5, 6],
        printed: true,
        ..Table::default()
    }
}

/// How far the axes of the machine go, and the room that is left.
pub(super) fn axes(report: &Report) -> Option<Table> {
    let number = |value: f64| words::length((1e3 * value).round() / 1e3);
    let row = |axis: &AxisTravel| {
        let [least, largest] = axis.range.map(number);
        let limits = axis.limits.map(|limits| limits.map(number).join(" … "));
        let place = axis.file.as_ref().zip(axis.line);
        vec![
            axis.letter.to_string(),
            least,
            largest,
            limits.unwrap_or_else(|| "–".to_owned()),
            axis.room.map_or_else(|| "–".to_owned(), number),
            place.map_or_else(String::new, |(file, line)| format!("{file}:{line}")),
        ]
    };
    let axes = report.axes.as_ref()?;
    Some(Table {
        title: "Axes of the machine".to_owned(),
        note: "Of the spindle's nose in mm, and in degrees; the room is the least that is left to a limit.".to_owned(),
        columns: ["Axis", "From", "To", "Limits", "Room", "Where"]
            .map(str::to_owned)
            .into(),
        rows: axes.iter().map(row).collect(),
        numbers: vec![1, 2, 4],
        printed: true,
    })
}

/// The deviations on the faces of a target that is a STEP file.
pub(super) fn faces(report: &Report) -> Option<Table> {
    let number = |value: f64| {
        if value.abs() < 5e-7 {
            "0".to_owned()
        } else {
            measure(value)
        }
    };
    let row = |face: &FaceDeviation| {
        let colour = face.colour.clone().unwrap_or_else(|| "–".to_owned());
        // Along the dexels, the part is anywhere between two of them: at least what is certain, if anything is.
        let is_known = face.area > 0.0;
        let deviates = face.gouge > 0.0 || face.excess > 0.0;
        let largest = |value: f64| match (is_known, deviates) {
            (true, _) => number(value),
            (false, true) => format!("≥ {}", number(value)),
            (false, false) => "–".to_owned(),
        };
        let mean = |value: f64| if is_known { number(value) } else { "–".to_owned() };
        let numbers = [
            number(face.area),
            largest(face.gouge),
            largest(face.excess),
            mean(face.mean),
            mean(face.rms),
        ];
        [face.face.clone(), face.kind.clone(), colour]
            .into_iter()
            .chain(numbers)
            .collect()
    };
    let faces = report.faces.as_ref()?;
    Some(Table {
        title: "Deviations by face of the target".to_owned(),
        note: "In mm, along the normal: the deepest gouge and the highest excess found on each face, their mean (positive where material is left) and root mean square, both over the area on which the distance is known. Of a face along the dexels that is none (–).".to_owned(),
        columns: ["Face", "Kind", "Colour", "Area mm²", "Gouge", "Excess", "Mean", "RMS"]
            .map(str::to_owned)
            .into(),
        rows: faces.iter().map(row).collect(),
        numbers: vec![3, 4, 5, 6, 7],
        printed: true,
    })
}
