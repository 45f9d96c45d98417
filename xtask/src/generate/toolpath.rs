//! Poses as the generators make them: adaptive sampling of pose curves, and the CSV text.

use nalgebra::Vector3;
use std::fmt::Write as _;

/// A tip and an axis (from the tip to the holder; any length).
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    pub tip: Vector3<f64>,
    pub axis: Vector3<f64>,
}

impl Placement {
    /// The same tool moved along its own axis.
    pub fn lifted(self, height: f64) -> Self {
        let tip = self.tip + self.axis.normalize() * height;
        Self { tip, ..self }
    }

    /// Turned about the z axis by the angle of `cosine` and `sine`.
    pub fn turned(self, (cosine, sine): (f64, f64)) -> Self {
        let turn = |v: Vector3<f64>| Vector3::new(cosine * v.x - sine * v.y, sine * v.x + cosine * v.y, v.z);
        Self {
            tip: turn(self.tip),
            axis: turn(self.axis),
        }
    }
}

/// How far the straight moves may leave the curve that they replace.
#[derive(Clone, Copy, Debug)]
pub struct Accuracy {
    /// Distance of the curve of tips from its chords.
    pub chord: f64,
    /// Largest distance between the two axes of a move, as unit vectors (the angle in radians, for small ones).
    pub turn: f64,
}

/// Samples `curve` on `[from, to]`, dense where it bends: an interval is halved until its chord is within `accuracy` of
/// the curve at a quarter, a half and three quarters of it, and its axes are close. Both ends belong to the samples.
pub fn sample(curve: &dyn Fn(f64) -> Placement, from: f64, to: f64, accuracy: Accuracy) -> Vec<Placement> {
    let mut samples = vec![curve(from)];
    halve(
        curve,
        (from, samples[0]),
        (to, curve(to)),
        accuracy,
        DEEPEST,
        &mut samples,
    );
    samples
}

/// At most 2 to this many moves a curve: only a curve with a jump gets there.
const DEEPEST: u32 = 12;

fn halve(
    curve: &dyn Fn(f64) -> Placement,
    (s0, p0): (f64, Placement),
    (s1, p1): (f64, Placement),
    accuracy: Accuracy,
    depth: u32,
    samples: &mut Vec<Placement>,
) {
    let at = |share: f64| s0 + (s1 - s0) * share;
    let chord = p1.tip - p0.tip;
    let strays = [0.25, 0.5, 0.75].iter().any(|&share| {
        let p = curve(at(share)).tip - p0.tip;
        let along = if chord.norm_squared() > 0.0 {
            (p.dot(&chord) / chord.norm_squared()).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (p - chord * along).norm() > accuracy.chord
    });
    let turns = (p1.axis.normalize() - p0.axis.normalize()).norm() > accuracy.turn;
    if depth > 0 && (strays || turns) {
        let middle = (at(0.5), curve(at(0.5)));
        halve(curve, (s0, p0), middle, accuracy, depth - 1, samples);
        halve(curve, middle, (s1, p1), accuracy, depth - 1, samples);
    } else {
        samples.push(p1);
    }
}

/// A job that cuts a block along one path, on dexels over the block.
pub struct BlockJob {
    /// Comments at the top.
    pub heading: &'static str,
    /// The block: `(min, max)`.
    pub stock: [[f64; 3]; 2],
    /// Dexels.
    pub cells: [usize; 2],
    /// The tool.
    pub tool: String,
    /// The file of the path.
    pub path: &'static str,
}

impl BlockJob {
    /// Its text.
    pub fn text(&self) -> String {
        let [min, max] = self.stock.map(|corner| corner.map(decimals).join(", "));
        let [[x0, y0, _], [x1, y1, _]] = self.stock;
        let (
            [nx, ny],
            Self {
                heading, tool, path, ..
            },
        ) = (self.cells, self);
        format!(
            "\
{heading}
Job(
    units: Mm,
    tolerance: 1e-6,
    grid: Grid(min: ({x0:?}, {y0:?}), max: ({x1:?}, {y1:?}), cells: ({nx}, {ny})),
    stock: Block(min: ({min}), max: ({max})),
    tools: {{
        1: {tool},
    }},
    paths: [
        Path(tool: 1, file: \"{path}\"),
    ],
)
"
        )
    }
}

/// The path as CSV with at most six decimals. Equal neighbours are written once.
pub fn csv(path: &[Placement]) -> String {
    let mut text = String::from("x,y,z,i,j,k\n");
    let mut last = String::new();
    for placement in path {
        let axis = placement.axis.normalize();
        let mut line = String::new();
        for (column, value) in placement.tip.iter().chain(axis.iter()).enumerate() {
            let comma = if column == 0 { "" } else { "," };
            write!(line, "{comma}{}", decimals(*value)).expect("a String takes all");
        }
        if line != last {
            text.push_str(&line);
            text.push('\n');
            last = line;
        }
    }
    text
}

/// A number with at most six decimals, no trailing zeros, and no minus before a zero.
pub fn decimals(value: f64) -> String {
    let text = format!("{value:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (1.0, "1"),
            (-0.000_000_1, "0"),
            (-2.5, "-2.5"),
            (0.123_456_78, "0.123457"),
        ] {
            assert_eq!(decimals(value), text);
        }
    }

    #[test]
    fn chords_stay_within_the_accuracy() {
        let circle = |s: f64| {
            let radial = Vector3::new(libm::cos(s), libm::sin(s), 0.0);
            Placement {
                tip: radial * 20.0,
                axis: radial,
            }
        };
        let accuracy = Accuracy { chord: 0.01, turn: 0.2 };
        let samples = sample(&circle, 0.0, 3.0, accuracy);
        for pair in samples.windows(2) {
            let sagitta = 20.0 - ((pair[0].tip + pair[1].tip) * 0.5).norm();
            assert!(sagitta <= accuracy.chord, "a chord strays by {sagitta}");
        }
        assert!(
            (40..100).contains(&samples.len()),
            "{} samples of a plain arc",
            samples.len()
        );
    }
}
