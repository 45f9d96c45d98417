//! A section as a drawing.

use crate::sections::section::Section;
use std::fmt::Write as _;

/// Width of the drawing, in its own units; the height follows from it.
const WIDTH: f64 = 1000.0;
/// The margin, as a fraction of the width.
const MARGIN: f64 = 0.04;

impl Section {
    /// The section as an SVG drawing, with thick lines for the boundary of the volume, thin lines for other parts of the envelope, and a
    /// labelled scale.
    #[must_use]
    pub fn svg(&self) -> String {
        let [across, up] = self.plane.frame();
        let flat = |p: &[f64; 3]| -> [f64; 2] { [across, up].map(|axis| (0..3).map(|k| axis[k] * p[k]).sum()) };
        let (mut min, mut max) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in self.curves.iter().flat_map(|curve| &curve.points) {
            let p = flat(&point.position);
            for k in 0..2 {
                min[k] = min[k].min(p[k]);
                max[k] = max[k].max(p[k]);
            }
        }
        if !(min[0] <= max[0] && min[1] <= max[1]) {
            (min, max) = ([0.0; 2], [1.0; 2]);
        }
        let size = (max[0] - min[0]).max(max[1] - min[1]).max(1e-9);
        let scale = WIDTH * (1.0 - 2.0 * MARGIN) / size;
        let margin = WIDTH * MARGIN;
        let place = |p: [f64; 2]| [margin + (p[0] - min[0]) * scale, margin + (max[1] - p[1]) * scale];
        let width = (max[0] - min[0]) * scale + 2.0 * margin;
        let height = (max[1] - min[1]) * scale + 3.0 * margin;
        let (mut inner, mut outer) = (String::new(), String::new());
        for curve in &self.curves {
            for (pair, flags) in curve.points.windows(2).zip(curve.outer.windows(2)) {
                let [a, b] = [0, 1].map(|k| place(flat(&pair[k].position)));
                let out = if flags[0] && flags[1] { &mut outer } else { &mut inner };
                // Writing to a String cannot fail.
                let _ = write!(out, "M{:.2} {:.2}L{:.2} {:.2}", a[0], a[1], b[0], b[1]);
            }
        }
        // A scale of a round length, at most a quarter of the drawing.
        let length = round_below(0.25 * size);
        let (x, y) = (margin, height - margin);
        let label = format!("{length} mm");
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.2} {height:.2}\" width=\"{width:.0}\" height=\"{height:.0}\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#fbfaf7\"/>\n\
             <path d=\"{inner}\" fill=\"none\" stroke=\"#b9b2a3\" stroke-width=\"1\"/>\n\
             <path d=\"{outer}\" fill=\"none\" stroke=\"#20506e\" stroke-width=\"2.4\" stroke-linecap=\"round\"/>\n\
             <path d=\"M{x:.2} {y:.2}h{:.2}\" stroke=\"#333\" stroke-width=\"1.5\"/>\n\
             <text x=\"{x:.2}\" y=\"{:.2}\" font-family=\"sans-serif\" font-size=\"16\" fill=\"#333\">{label}</text>\n</svg>\n",
            length * scale,
            y - 6.0,
        )
    }
}

/// The largest 1, 2 or 5 times a power of ten that is not above a positive number.
fn round_below(x: f64) -> f64 {
    let power = 10f64.powi(x.log10().floor() as i32);
    [5.0, 2.0, 1.0]
        .into_iter()
        .map(|digit| digit * power)
        .find(|round| *round <= x)
        .unwrap_or(power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_round() {
        for (x, round) in [(0.7, 0.5), (1.0, 1.0), (3.9, 2.0), (25.0, 20.0), (99.0, 50.0)] {
            assert!((round_below(x) - round).abs() < 1e-12, "{x}");
        }
    }
}
