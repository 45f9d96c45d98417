//! Tools made of B-spline surfaces: the file that `Surface("…")` refers to. A side of a surface may join several
//! others.
//!
//! ```ron
//! Surfaces(
//!     tolerance: 1e-6,                       // the largest gap between sides that join, in the job's units
//!     surfaces: [
//!         Surface(
//!             degrees: (3, 3),               // in u and in v
//!             knots: ([0, 0, 0, 0, 1, 1, 1, 1], [0, 0, 0, 0, 1, 1, 1, 1]),
//!             points: [[(0, 0, 0), …], …],   // a row along u for each v; F_u × F_v points out of the tool
//!             weights: [[1, …], …],          // of the same shape; 1 by default
//!         ),
//!     ],
//! )
//! ```

use serde::Deserialize;
use std::path::Path as FilePath;
use sweepsim_motion::{Tool, ToolError};
use sweepsim_spline::{KnotVector, RationalSpline, SplineError};

use crate::error::{FormatError, Problem, TextPosition};
use crate::text;
use crate::text::SpanTree;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Surfaces")]
struct Raw {
    #[serde(default = "tolerance")]
    tolerance: f64,
    surfaces: Vec<Surface>,
}

fn tolerance() -> f64 {
    1e-6
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Surface {
    degrees: [usize; 2],
    knots: [Vec<f64>; 2],
    points: Vec<Vec<[f64; 3]>>,
    #[serde(default)]
    weights: Option<Vec<Vec<f64>>>,
}

/// Reads a tool. Lengths are multiplied by `unit`.
pub(crate) fn read(file: &FilePath, unit: f64) -> Result<Tool, FormatError> {
    let text = text::read(file)?;
    parse(&text, unit).map_err(|error| error.in_file(file))
}

fn parse(text: &str, unit: f64) -> Result<Tool, FormatError> {
    let raw: Raw = text::ron(text)?;
    let root = SpanTree::of(text);
    let at = |problem: Problem, node: &SpanTree| {
        FormatError::new(problem, Some(TextPosition::of_bytes(text, node.span.clone())))
    };
    if !(raw.tolerance > 0.0 && raw.tolerance.is_finite()) {
        let problem = Problem::value("tolerance", raw.tolerance, "a positive number");
        return Err(at(problem, root.key("tolerance")));
    }
    let mut surfaces = Vec::with_capacity(raw.surfaces.len());
    for (index, surface) in raw.surfaces.iter().enumerate() {
        let node = root.key("surfaces").item(index);
        surfaces.push(spline(surface, unit).map_err(|(problem, field)| at(problem, node.key(field)))?);
    }
    Tool::from_surfaces(&surfaces, raw.tolerance * unit).map_err(|error| {
        let all = root.key("surfaces");
        let node = match error {
            ToolError::Surface { surface, .. }
            | ToolError::Spline { surface, .. }
            | ToolError::Patch { surface, .. } => all.item(surface),
            _ => all,
        };
        at(Problem::syntax(error.to_string()), node)
    })
}

/// The surface, or a problem and the field at fault.
fn spline(raw: &Surface, unit: f64) -> Result<RationalSpline, (Problem, &'static str)> {
    let mut knots = Vec::with_capacity(2);
    for (axis, list) in raw.knots.iter().enumerate() {
        let vector = KnotVector::new(raw.degrees[axis], list.clone());
        let name = ["u", "v"][axis];
        knots.push(vector.map_err(|error| (Problem::syntax(format!("the knots in {name}: {error}")), "knots"))?);
    }
    let [along_u, along_v] = [knots[0].count(), knots[1].count()];
    let shape = |rows: usize, longest: Option<usize>, field: &'static str| {
        let found = format!("{rows} rows, one of {}", longest.unwrap_or(0));
        let expected = format!("{along_v} rows of {along_u} for these knots and degrees");
        (
            Problem::value(format!("the shape of `{field}`"), found, expected),
            field,
        )
    };
    if raw.points.len() != along_v || raw.points.iter().any(|row| row.len() != along_u) {
        let odd = raw.points.iter().map(Vec::len).find(|length| *length != along_u);
        return Err(shape(
            raw.points.len(),
            odd.or(raw.points.first().map(Vec::len)),
            "points",
        ));
    }
    let weights = match &raw.weights {
        None => vec![1.0; along_u * along_v],
        Some(rows) if rows.len() == along_v && rows.iter().all(|row| row.len() == along_u) => rows.concat(),
        Some(rows) => {
            let odd = rows.iter().map(Vec::len).find(|length| *length != along_u);
            return Err(shape(rows.len(), odd.or(rows.first().map(Vec::len)), "weights"));
        }
    };
    let points: Vec<f64> = raw.points.iter().flatten().flatten().map(|c| c * unit).collect();
    RationalSpline::new(knots, 3, &points, &weights).map_err(|error| {
        let field = match error {
            SplineError::Weight { .. } => "weights",
            _ => "points",
        };
        (Problem::syntax(error.to_string()), field)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box from (-1, -1, 0) to (1, 1, 4) as six bilinear surfaces.
    fn cube() -> String {
        let corner = |k: usize| [0, 1, 2].map(|a| if k >> a & 1 == 0 { [-1, -1, 0][a] } else { [1, 1, 4][a] });
        let faces = [
            [0, 2, 1, 3],
            [4, 5, 6, 7],
            [0, 1, 4, 5],
            [2, 6, 3, 7],
            [0, 4, 2, 6],
            [1, 3, 5, 7],
        ];
        let surface = |face: [usize; 4]| {
            let [a, b, c, d] = face.map(|k| format!("({}, {}, {})", corner(k)[0], corner(k)[1], corner(k)[2]));
            format!(
                "Surface(degrees: (1, 1), knots: ([0, 0, 1, 1], [0, 0, 1, 1]), points: [[{a}, {b}], [{c}, {d}]]),\n"
            )
        };
        format!("Surfaces(surfaces: [\n{}])", faces.map(surface).concat())
    }

    #[test]
    fn a_box_is_a_tool() {
        let tool = parse(&cube(), 25.4).unwrap();
        assert_eq!((tool.patches().len(), tool.edges().len()), (6, 12));
        assert!((tool.patches()[1].point(0.5, 0.5)[2] - 4.0 * 25.4).abs() < 1e-12);
    }

    #[test]
    fn what_is_wrong_is_said_with_its_place() {
        let bad = |from: &str, to: &str, expected: &str| {
            let text = cube().replacen(from, to, 1);
            assert_ne!(text, cube());
            let error = parse(&text, 1.0).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}");
        };
        bad("[0, 0, 1, 1]", "[0, 1, 0, 1]", "2:");
        bad("(1, 1)", "(2, 1)", "2:");
        bad("(-1, -1, 0)", "(-1, -1, nan)", "2:");
        bad("(-1, -1, 0)", "(-1, -1, -1)", "1:");
        bad("degrees", "degree", "2:");
        bad("surfaces: [\n", "tolerance: -1, surfaces: [\n", "1:");
        let open: Vec<String> = cube()
            .lines()
            .map(str::to_owned)
            .enumerate()
            .filter(|(n, _)| *n != 3)
            .map(|(_, l)| l)
            .collect();
        let error = parse(&open.join("\n"), 1.0).unwrap_err().to_string();
        assert!(error.contains("open"), "{error}");
    }
}
