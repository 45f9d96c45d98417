//! The travel of a machine's axes along the program: a curve for each, with its limits and the place of least room.

use crate::html::{escape, measure};
use std::fmt::Write as _;

/// The width and height of a plot, in units of its picture.
const WIDTH: f64 = 1000.0;
const HEIGHT: f64 = 72.0;
/// Room above and below.
const MARGIN: f64 = 3.0;
/// The most columns of a curve: more would be narrower than a pixel.
const COLUMNS: usize = 800;

/// The travel of an axis over the program's clock.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AxisPlot {
    /// The axis, as it is called above the plot.
    pub name: String,
    /// Words about its travel, beside the name.
    pub words: String,
    /// Clock and value; `None` where the next one is elsewhere without a way.
    pub points: Vec<Option<[f64; 2]>>,
    /// Its limits.
    pub limits: Option<[f64; 2]>,
    /// The clock where the least room is left.
    pub least: Option<f64>,
}

/// The least and the greatest value in each column, if any.
fn columns(plot: &AxisPlot, end: f64) -> Vec<Option<[f64; 2]>> {
    let mut columns: Vec<Option<[f64; 2]>> = vec![None; COLUMNS];
    let place = |clock: f64| (clock / end * COLUMNS as f64).clamp(0.0, COLUMNS as f64 - 1e-6);
    for pair in plot.points.windows(2) {
        let [Some([from, a]), Some([to, b])] = pair else {
            continue;
        };
        let (first, last) = (place(*from), place(*to));
        let value = |at: f64| match last > first {
            true => a + (b - a) * ((at - first) / (last - first)).clamp(0.0, 1.0),
            false => *b,
        };
        for number in first as usize..=last as usize {
            let ends = [value(first.max(number as f64)), value(last.min(number as f64 + 1.0))];
            let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            let own = columns[number].get_or_insert([low, high]);
            *own = [own[0].min(low), own[1].max(high)];
        }
    }
    // A jump is seen at both of its ends.
    for point in plot.points.iter().flatten() {
        let own = columns[place(point[0]) as usize].get_or_insert([point[1]; 2]);
        *own = [own[0].min(point[1]), own[1].max(point[1])];
    }
    columns
}

/// A plot for each axis; `end` is the end of the clock.
pub(crate) fn axes(html: &mut String, plots: &[AxisPlot], end: f64) {
    for plot in plots.iter().filter(|_| end > 0.0) {
        let columns = columns(plot, end);
        let values = columns.iter().flatten().flatten().chain(plot.limits.iter().flatten());
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(*value), high.max(*value))
        });
        if !(low.is_finite() && high.is_finite()) {
            continue;
        }
        let y = |value: f64| {
            let share = if high > low { (value - low) / (high - low) } else { 0.5 };
            HEIGHT - MARGIN - share * (HEIGHT - 2.0 * MARGIN)
        };
        let mut path = String::new();
        let width = WIDTH / COLUMNS as f64;
        for (number, column) in columns.iter().enumerate() {
            let Some([low, high]) = column else { continue };
            let command = if path.is_empty() { 'M' } else { 'L' };
            let _ = write!(path, "{command}{:.2} {:.1}", number as f64 * width, y(*low));
            if high > low {
                let _ = write!(path, "V{:.1}", y(*high));
            }
        }
        let name = escape(&plot.name);
        let _ = write!(
            html,
            "<figure class=\"plot\"><figcaption>{name}<span>{}</span></figcaption>\
             <svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" preserveAspectRatio=\"none\" role=\"img\" aria-label=\"{name} along the program\">",
            escape(&plot.words)
        );
        for limit in plot.limits.iter().flatten() {
            let at = y(*limit);
            let _ = write!(
                html,
                "<line class=\"reach\" x1=\"0\" x2=\"{WIDTH}\" y1=\"{at:.2}\" y2=\"{at:.2}\"><title>limit {}</title></line>",
                measure(*limit)
            );
        }
        if let Some(clock) = plot.least {
            let x = clock / end * WIDTH;
            let _ = write!(
                html,
                "<line class=\"least\" x1=\"{x:.2}\" x2=\"{x:.2}\" y1=\"0\" y2=\"{HEIGHT}\"/>"
            );
        }
        let _ = writeln!(
            html,
            "<path class=\"way\" d=\"{path}\"/><line class=\"cursor\" x1=\"{WIDTH}\" x2=\"{WIDTH}\" y1=\"0\" y2=\"{HEIGHT}\"/></svg></figure>"
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A curve goes from where the axis is at the first column to where it is at the last; limits are lines above and
    /// below.
    #[test]
    fn curves_have_their_limits_and_marks() {
        let plot = AxisPlot {
            name: "X".into(),
            words: "10 mm left".into(),
            points: vec![
                Some([0.0, 0.0]),
                Some([10.0, 90.0]),
                None,
                Some([10.0, -50.0]),
                Some([20.0, -50.0]),
            ],
            limits: Some([-100.0, 100.0]),
            least: Some(10.0),
        };
        let all = columns(&plot, 20.0);
        assert_eq!(all[0].expect("a value")[0], 0.0);
        assert!((all[399].expect("a value")[1] - 90.0).abs() < 1e-9);
        assert_eq!(all[400].expect("a value"), [-50.0, 90.0]);
        assert_eq!(all[799], Some([-50.0; 2]));
        let mut html = String::new();
        axes(&mut html, &[plot], 20.0);
        assert_eq!(html.matches("class=\"reach\"").count(), 2);
        // At the top and at the bottom, and the mark in the middle.
        assert!(
            html.contains("y1=\"3.00\"")
                && html.contains("y1=\"69.00\"")
                && html.contains("class=\"least\" x1=\"500.00\"")
        );
        assert!(html.contains("M0.00 36.0V"), "{html}");
    }
}
