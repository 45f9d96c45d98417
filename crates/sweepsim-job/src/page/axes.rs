//! The travel of the machine's axes along the program, as plots.

use super::PageSource;
use super::course::Courses;
use super::machine::points;
use crate::base::words;
use sweepsim_report::AxisPlot;

/// A plot of each axis of the first machine that is known.
pub(super) fn plots(source: &PageSource, made: &Courses) -> Vec<AxisPlot> {
    let job = source.session.job;
    let Some(own) = job.paths.iter().find_map(|path| path.on_machine.as_ref()) else {
        return Vec::new();
    };
    let points = points(source, made, own);
    let travelled = source.report.axes.iter().flatten();
    let plot = |axis: &sweepsim_formats::AxisTravel| {
        let joint = own
            .course
            .chain()
            .letters()
            .iter()
            .position(|letter| *letter == axis.letter)?;
        let mut curve = Vec::with_capacity(points.len());
        for point in &points {
            if point.begins && !curve.is_empty() {
                curve.push(None);
            }
            curve.push(Some([point.clock, point.values[joint]]));
        }
        let [low, high] = axis.range.map(words::length);
        let unit = if axis.letter < 'X' { "°" } else { " mm" };
        let mut text = format!("{low} … {high}{unit}");
        if let Some(room) = axis.room {
            let state = if room < 0.0 { "beyond" } else { "left" };
            text += &format!(", {}{unit} {state}", words::length(room.abs()));
            if let (Some(file), Some(line)) = (&axis.file, axis.line) {
                text += &format!(" at {file}:{line}");
            }
        }
        // Where the least room is, by its value.
        let at_least = |value: f64, [low, high]: [f64; 2]| (value - low).min(high - value);
        let least = axis.limits.zip(axis.room).and_then(|(limits, room)| {
            let near = |value: f64| (at_least(value, limits) - room).abs();
            let nearest = points
                .iter()
                .min_by(|a, b| near(a.values[joint]).total_cmp(&near(b.values[joint])));
            nearest.map(|point| point.clock)
        });
        Some(AxisPlot {
            name: axis.letter.to_string(),
            words: text,
            points: curve,
            limits: axis.limits,
            least,
        })
    };
    travelled.filter_map(plot).collect()
}
