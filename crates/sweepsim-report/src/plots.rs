//! Plots as SVG: curves along the program, and histograms.

use crate::html::{escape, measure};
use std::fmt::Write as _;

/// The width of all plots, in units of their picture; heights are in pixels.
const WIDTH: f64 = 1000.0;
const HEIGHT: f64 = 72.0;
/// The most columns of a curve: more would be narrower than a pixel.
const COLUMNS: usize = 800;

/// A quantity along the program.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plot {
    /// What it is.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// From, to and value of each stretch of the program's clock.
    pub steps: Vec<[f64; 3]>,
}

/// A bar of a histogram.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bar {
    /// The lower end of its range.
    pub from: f64,
    /// The upper end.
    pub to: f64,
    /// The area.
    pub area: f64,
}

/// The area of the part's surface by its deviation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Histogram {
    /// Bars from the lowest range to the highest. The first and the last include all beyond them.
    pub bars: Vec<Bar>,
    /// The limits: for gouges and for excess, both as positive numbers.
    pub limits: [f64; 2],
    /// Words about the largest values, below.
    pub note: String,
}

/// The greatest value in each column.
fn columns(plot: &Plot, end: f64) -> Vec<f64> {
    let mut columns = vec![0.0_f64; COLUMNS];
    for [from, to, value] in &plot.steps {
        if !(from.is_finite() && to.is_finite() && value.is_finite()) || end <= 0.0 {
            continue;
        }
        let column = |clock: f64| (clock / end * COLUMNS as f64).clamp(0.0, COLUMNS as f64);
        let first = (column(*from).floor() as usize).min(COLUMNS - 1);
        let last = (column(*to).ceil() as usize).clamp(first + 1, COLUMNS);
        for held in &mut columns[first..last] {
            *held = held.max(*value);
        }
    }
    columns
}

/// Curves below each other, with a common cursor; `end` is the end of the clock.
pub(crate) fn plots(html: &mut String, plots: &[Plot], end: f64) {
    for plot in plots {
        let columns = columns(plot, end);
        let most = columns.iter().copied().fold(0.0, f64::max);
        let mut path = format!("M0 {HEIGHT}");
        let width = WIDTH / COLUMNS as f64;
        let mut before = f64::NAN;
        for (n, value) in columns.iter().enumerate() {
            let y = if most > 0.0 {
                HEIGHT - value / most * (HEIGHT - 4.0)
            } else {
                HEIGHT
            };
            if y != before {
                let _ = write!(path, "H{:.5}V{:.4}", n as f64 * width, y);
            }
            before = y;
        }
        let _ = write!(path, "H{WIDTH}V{HEIGHT}Z");
        let name = escape(&plot.name);
        let _ = writeln!(
            html,
            "<figure class=\"plot\"><figcaption>{name}<span>up to {} {}</span></figcaption>\
             <svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" preserveAspectRatio=\"none\" role=\"img\" aria-label=\"{name} along the program\">\
             <path class=\"area\" d=\"{path}\"/><line class=\"cursor\" x1=\"{WIDTH}\" x2=\"{WIDTH}\" y1=\"0\" y2=\"{HEIGHT}\"/></svg></figure>",
            measure(most),
            escape(&plot.unit),
        );
    }
}

/// A histogram with the limits marked.
pub(crate) fn histogram(html: &mut String, histogram: &Histogram) {
    let bars = &histogram.bars;
    let (Some(first), Some(last)) = (bars.first(), bars.last()) else {
        return;
    };
    let range = (last.to - first.from).max(f64::MIN_POSITIVE);
    let most = bars.iter().map(|bar| bar.area).fold(f64::MIN_POSITIVE, f64::max);
    // Small areas matter as much as large ones: a bar's height is the square root of its share.
    let height = |area: f64| (area / most).max(0.0).sqrt() * 150.0;
    let x = |value: f64| (value - first.from) / range * 640.0;
    let [gouge, excess] = histogram.limits;
    html.push_str(
        "<section class=\"card\" id=\"deviations\"><h2>Deviations</h2>\n<svg class=\"histogram\" viewBox=\"-20 -8 680 196\" role=\"img\" aria-label=\"Area of the surface by its deviation\">\n",
    );
    for bar in bars {
        let middle = 0.5 * (bar.from + bar.to);
        let class = if middle < -gouge {
            "bar gouge"
        } else if middle > excess {
            "bar excess"
        } else {
            "bar"
        };
        let tall = height(bar.area);
        let _ = writeln!(
            html,
            "<rect class=\"{class}\" x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{tall:.2}\"><title>{} to {} mm: {} mm²</title></rect>",
            x(bar.from) + 0.75,
            150.0 - tall,
            (x(bar.to) - x(bar.from) - 1.5).max(0.5),
            measure(bar.from),
            measure(bar.to),
            measure(bar.area),
        );
    }
    html.push_str("<line class=\"axis\" x1=\"0\" x2=\"640\" y1=\"150\" y2=\"150\"/>\n");
    let mut marks = vec![(first.from, "end"), (0.0, ""), (last.to, "end")];
    marks.extend(
        [(-gouge, "limit"), (excess, "limit")]
            .iter()
            .filter(|(at, _)| *at > first.from && *at < last.to),
    );
    for (at, kind) in marks {
        let x = x(at);
        if kind == "limit" {
            let _ = writeln!(
                html,
                "<line class=\"limit\" x1=\"{x:.2}\" x2=\"{x:.2}\" y1=\"0\" y2=\"156\"/>"
            );
        }
        let y = if kind == "limit" { 186 } else { 168 };
        let _ = writeln!(html, "<text x=\"{x:.2}\" y=\"{y}\">{}</text>", measure(at));
    }
    let _ = writeln!(
        html,
        "</svg>\n<p class=\"soft\">Distance of the surface from the target in mm, by area (heights are square roots): too much removed on the left, too little on the right. {}</p></section>",
        escape(&histogram.note)
    );
}
