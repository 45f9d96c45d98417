//! Plots with logarithmic or plain axes as SVG: small multiples beside each other, readable on light and on dark pages.

use std::fmt::Write as _;

/// Size of a panel's plotting area, and the room around it.
const AREA: [f64; 2] = [270.0, 200.0];
const LEFT: f64 = 62.0;
const RIGHT: f64 = 16.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 44.0;
/// Of a row of the legend, and of an entry of it.
const ROW: f64 = 20.0;
const ENTRY: f64 = 205.0;

const STYLE: &str = "\
text{font:12px system-ui,sans-serif;fill:#2b2b2b}.title{font-weight:600;font-size:13px}.small{font-size:11px;fill:#5a5a5a}
.page{fill:#fbfaf7}.grid{stroke:#dedbd3;stroke-width:1}.frame{fill:none;stroke:#8a877f;stroke-width:1}
.line{fill:none;stroke-width:2;stroke-linejoin:round}.dashed{stroke-dasharray:5 4}
.s0{stroke:#1f6fb2;--c:#1f6fb2}.s1{stroke:#c4561b;--c:#c4561b}.s2{stroke:#2f8f5b;--c:#2f8f5b}.s3{stroke:#8a4fae;--c:#8a4fae}.s4{stroke:#7a6a1e;--c:#7a6a1e}
.dot{fill:var(--c);stroke:none}
@media (prefers-color-scheme:dark){text{fill:#e4e2dc}.small{fill:#b3b0a8}.page{fill:#1c1d20}.grid{stroke:#34363b}.frame{stroke:#7d7f86}
.s0{stroke:#6cb4ee;--c:#6cb4ee}.s1{stroke:#f0955c;--c:#f0955c}.s2{stroke:#6fce9b;--c:#6fce9b}.s3{stroke:#c79be6;--c:#c79be6}.s4{stroke:#d3c15c;--c:#d3c15c}}";

/// A curve through points, or the points alone.
pub struct Series {
    /// Its name in the legend; the same names in several panels are one entry.
    pub name: String,
    /// From 0 to 4.
    pub colour: usize,
    /// Whether the line is dashed.
    pub dashed: bool,
    /// Whether a line goes through the points.
    pub joined: bool,
    /// `(x, y)`.
    pub points: Vec<[f64; 2]>,
}

/// An axis.
#[derive(Clone)]
pub struct Axis {
    /// What it measures, with the unit.
    pub label: String,
    /// Whether it is logarithmic.
    pub logarithmic: bool,
    /// The least range that it shows.
    pub range: Option<[f64; 2]>,
}

/// One of the plots of a figure.
pub struct Panel {
    /// Above it.
    pub title: String,
    /// Its axes.
    pub axes: [Axis; 2],
    /// Its curves.
    pub series: Vec<Series>,
}

/// The figure as SVG, with so many panels in a row. `alternative`: what a reader should know who does not see it.
pub fn figure(panels: &[Panel], columns: usize, alternative: &str) -> String {
    let cell = [LEFT + AREA[0] + RIGHT, TOP + AREA[1] + BOTTOM];
    let columns = columns.min(panels.len()).max(1);
    let rows = panels.len().div_ceil(columns);
    let names = legend(panels);
    let width = cell[0] * columns as f64;
    let per_row = ((width - LEFT) / ENTRY).floor().max(1.0) as usize;
    let below = ROW * names.len().div_ceil(per_row) as f64 + 10.0;
    let height = cell[1] * rows as f64 + below;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{}\">\n<style>{STYLE}</style>\n\
         <rect class=\"page\" width=\"{width}\" height=\"{height}\"/>\n",
        escaped(alternative)
    );
    for (n, panel) in panels.iter().enumerate() {
        let corner = [
            cell[0] * (n % columns) as f64 + LEFT,
            cell[1] * (n / columns) as f64 + TOP,
        ];
        draw(&mut svg, panel, corner);
    }
    for (n, (name, series)) in names.iter().enumerate() {
        let x = LEFT + ENTRY * (n % per_row) as f64;
        let y = cell[1] * rows as f64 + ROW * (n / per_row) as f64 + 8.0;
        let dashed = if series.dashed { " dashed" } else { "" };
        let colour = series.colour;
        let _ = writeln!(svg, "<path class=\"line s{colour}{dashed}\" d=\"M{x} {y}h24\"/>");
        let _ = writeln!(
            svg,
            "<circle class=\"dot s{colour}\" cx=\"{}\" cy=\"{y}\" r=\"3\"/>",
            x + 12.0
        );
        let _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"{}\">{}</text>",
            x + 30.0,
            y + 4.0,
            escaped(name)
        );
    }
    svg.push_str("</svg>\n");
    svg
}

fn legend(panels: &[Panel]) -> Vec<(&str, &Series)> {
    let mut names: Vec<(&str, &Series)> = Vec::new();
    for series in panels.iter().flat_map(|panel| &panel.series) {
        if !names.iter().any(|(name, _)| *name == series.name) {
            names.push((&series.name, series));
        }
    }
    names
}

/// From values to places between 0 and 1, and the ticks.
struct Scale {
    logarithmic: bool,
    low: f64,
    high: f64,
    ticks: Vec<f64>,
}

impl Scale {
    fn new(axis: &Axis, values: impl Iterator<Item = f64>) -> Self {
        let usable = values.filter(|value| value.is_finite() && (!axis.logarithmic || *value > 0.0));
        let range = axis.range.unwrap_or([f64::INFINITY, f64::NEG_INFINITY]);
        let [low, high] = usable.fold(range, |[low, high], value| [low.min(value), high.max(value)]);
        let (low, high) = if low < high {
            (low, high)
        } else {
            (0.5 * low.abs().min(1e300), 2.0 * low.abs().min(1e300) + 1e-300)
        };
        if axis.logarithmic {
            let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
            let step = ((last - first) / 6 + 1).max(1);
            let ticks = (first..=last)
                .filter(|power| (power - first) % step == 0)
                .map(|power| 10_f64.powi(power))
                .collect();
            return Self {
                logarithmic: true,
                low: f64::from(first),
                high: f64::from(last),
                ticks,
            };
        }
        let rough = (high - low.min(0.0)) / 4.0;
        let power = 10_f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0]
            .map(|m| m * power)
            .into_iter()
            .find(|step| *step >= rough)
            .unwrap_or(rough);
        let count = (high / step).ceil().max(1.0);
        let ticks = (0..=count as i32).map(|k| f64::from(k) * step).collect();
        Self {
            logarithmic: false,
            low: 0.0,
            high: count * step,
            ticks,
        }
    }

    fn place(&self, value: f64) -> f64 {
        let value = if self.logarithmic { value.log10() } else { value };
        (value - self.low) / (self.high - self.low)
    }
}

fn draw(svg: &mut String, panel: &Panel, [left, top]: [f64; 2]) {
    let values = |k: usize| {
        panel
            .series
            .iter()
            .flat_map(move |series| series.points.iter().map(move |point| point[k]))
    };
    let scales = [0, 1].map(|k| Scale::new(&panel.axes[k], values(k)));
    let x = |value: f64| left + AREA[0] * scales[0].place(value);
    let y = |value: f64| top + AREA[1] * (1.0 - scales[1].place(value));
    let (right, bottom) = (left + AREA[0], top + AREA[1]);
    let _ = writeln!(
        svg,
        "<text class=\"title\" x=\"{left}\" y=\"{}\">{}</text>",
        top - 12.0,
        escaped(&panel.title)
    );
    for &tick in &scales[0].ticks {
        let (at, text) = (x(tick), tick_text(tick));
        let _ = writeln!(svg, "<path class=\"grid\" d=\"M{at:.1} {top}V{bottom}\"/>");
        let _ = writeln!(
            svg,
            "<text class=\"small\" x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{text}</text>",
            bottom + 16.0
        );
    }
    for &tick in &scales[1].ticks {
        let (at, text) = (y(tick), tick_text(tick));
        let _ = writeln!(svg, "<path class=\"grid\" d=\"M{left} {at:.1}H{right}\"/>");
        let _ = writeln!(
            svg,
            "<text class=\"small\" x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{text}</text>",
            left - 6.0,
            at + 4.0
        );
    }
    let _ = writeln!(
        svg,
        "<rect class=\"frame\" x=\"{left}\" y=\"{top}\" width=\"{}\" height=\"{}\"/>",
        AREA[0], AREA[1]
    );
    let (middle, level) = (left + 0.5 * AREA[0], top + 0.5 * AREA[1]);
    let label = |k: usize| escaped(&panel.axes[k].label);
    let _ = writeln!(
        svg,
        "<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
        bottom + 34.0,
        label(0)
    );
    let aside = left - 48.0;
    let _ = writeln!(
        svg,
        "<text transform=\"translate({aside} {level}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
        label(1)
    );
    for series in &panel.series {
        let shown =
            |point: &&[f64; 2]| (0..2).all(|k| point[k].is_finite() && (!panel.axes[k].logarithmic || point[k] > 0.0));
        let places: Vec<[f64; 2]> = series
            .points
            .iter()
            .filter(shown)
            .map(|point| [x(point[0]), y(point[1])])
            .collect();
        let words: Vec<String> = places.iter().map(|[x, y]| format!("{x:.1} {y:.1}")).collect();
        let dashed = if series.dashed { " dashed" } else { "" };
        if series.joined && places.len() > 1 {
            let _ = writeln!(
                svg,
                "<path class=\"line s{}{dashed}\" d=\"M{}\"/>",
                series.colour,
                words.join("L")
            );
        }
        for [x, y] in places {
            let radius = if series.points.len() == 1 { 5.5 } else { 2.5 };
            let _ = writeln!(
                svg,
                "<circle class=\"dot s{}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\"/>",
                series.colour
            );
        }
    }
}

/// A number without needless digits.
fn tick_text(value: f64) -> String {
    let superscript = |power: i32| -> String {
        let digits = power.to_string();
        let raised = |c: char| match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            digit => char::from_u32('⁰' as u32 + digit.to_digit(10).unwrap_or(0)).unwrap_or(digit),
        };
        digits.chars().map(raised).collect()
    };
    if value == 0.0 || (1e-2..1e4).contains(&value.abs()) {
        return format!("{}", (value * 1e9).round() / 1e9);
    }
    let power = value.abs().log10().floor() as i32;
    let factor = value / 10_f64.powi(power);
    if (factor - 1.0).abs() < 1e-6 {
        return format!("10{}", superscript(power));
    }
    format!("{}·10{}", (factor * 1e3).round() / 1e3, superscript(power))
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_and_ticks_are_where_they_belong() {
        let axis = |label: &str, logarithmic| Axis {
            label: label.into(),
            logarithmic,
            range: None,
        };
        // The origin cannot be shown on a logarithmic axis.
        let points = vec![[0.0, 0.0], [1.0, 1.0], [100.0, 10.0]];
        let series = Series {
            name: "a < b".into(),
            colour: 1,
            dashed: false,
            joined: true,
            points,
        };
        let panel = Panel {
            title: "t".into(),
            axes: [axis("x", true), axis("y", false)],
            series: vec![series],
        };
        let svg = figure(&[panel], 2, "\"quoted\"");
        let [left, right] = [LEFT, LEFT + AREA[0]];
        let [bottom, tenth] = [TOP + AREA[1], TOP + AREA[1] * 0.9];
        assert!(
            svg.contains(&format!("M{left:.1} {tenth:.1}L{right:.1} {TOP:.1}")),
            "{svg}"
        );
        assert!(svg.contains("&quot;quoted&quot;") && svg.contains("a &lt; b"));
        for tick in ["1", "10", "100", "5", "0"] {
            assert!(svg.contains(&format!(">{tick}</text>")), "{tick}");
        }
        assert!(svg.contains(&format!("y=\"{:.1}\" text-anchor=\"end\">0<", bottom + 4.0)));
        assert_eq!(tick_text(1e-6), "10⁻⁶");
        assert_eq!(tick_text(3e5), "3·10⁵");
    }
}
