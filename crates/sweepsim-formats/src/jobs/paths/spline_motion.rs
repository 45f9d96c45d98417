//! User-defined motions: the tip and the orientation as B-splines.
//!
//! ```ron
//! Motion(
//!     tip: Curve(degree: 3, points: [(0, 0, 0), …]),                    // further knots: […] and weights: […]
//!     orientation: Quaternions(degree: 2, points: [(1, 0, 0, 0), …]),   // (w, x, y, z), of any length but 0; further knots: […]
//!     // or Matrices(degree: 2, points: [((1, 0, 0), (0, 1, 0), (0, 0, 1)), …]): rows; further knots, weights, tolerance
//! )
//! ```
//!
//! A curve without knots gets evenly spaced knots over the domain of the other curve, or over `[0, 1]`. Without an
//! orientation, the tool axis stays along z.

use std::path::Path as FilePath;
use sweepsim_motion::{MotionError, Path, SplineMotion};
use sweepsim_spline::{BSpline, KnotError, KnotVector, RationalSpline, SplineError};

use crate::error::{FormatError, Problem, TextPosition};
use crate::jobs::place::{Fault, Step};
use crate::jobs::schema;
use crate::text;
use crate::text::SpanTree;

/// The default deviation of a matrix from a rotation.
const TOLERANCE: f64 = 1e-9;

/// Reads a motion from a separate file. Lengths are multiplied by `unit`.
pub(crate) fn read(file: &FilePath, unit: f64) -> Result<Path, FormatError> {
    let text = text::read(file)?;
    let parse = || {
        let raw: schema::Motion = text::ron(&text)?;
        let root = SpanTree::of(&text);
        path(&raw, unit).map_err(|fault| {
            let node = fault.field.iter().fold(&root, |node, step| step.of(node));
            FormatError::new(fault.problem, Some(TextPosition::of_bytes(&text, node.span.clone())))
        })
    };
    parse().map_err(|error| error.in_file(file))
}

/// The path along a motion. Lengths are multiplied by `unit`.
pub(crate) fn path(raw: &schema::Motion, unit: f64) -> Result<Path, Fault> {
    let tip = &raw.tip;
    let (degree, count, own) = match &raw.orientation {
        None => (0, 1, None),
        Some(schema::Orientation::Quaternions { degree, points, knots }) => (*degree, points.len(), knots.as_deref()),
        Some(schema::Orientation::Matrices {
            degree, points, knots, ..
        }) => (*degree, points.len(), knots.as_deref()),
    };
    let along = given("tip", tip.degree, tip.points.len(), tip.knots.as_deref())?;
    let around = given("orientation", degree, count, own)?;
    let domain = along
        .as_ref()
        .or(around.as_ref())
        .map_or((0.0, 1.0), KnotVector::domain);
    let along = along.map_or_else(|| even("tip", tip.degree, tip.points.len(), domain), Ok)?;
    let around = around.map_or_else(|| even("orientation", degree, count, domain), Ok)?;
    let weights = weights("tip", tip.points.len(), tip.weights.as_deref())?;
    finite("tip", &tip.points, |point| point.iter().all(|c| (c * unit).is_finite()))?;
    let points: Vec<f64> = tip.points.iter().flatten().map(|c| c * unit).collect();
    let tip = RationalSpline::new(vec![along], 3, &points, &weights).map_err(|error| rational("tip", &error))?;
    let motion = match &raw.orientation {
        None => SplineMotion::from_quaternions(&curve(around, &[[1.0, 0.0, 0.0, 0.0]])?, &tip),
        Some(schema::Orientation::Quaternions { points, .. }) => {
            SplineMotion::from_quaternions(&curve(around, points)?, &tip)
        }
        Some(schema::Orientation::Matrices {
            points,
            weights: own,
            tolerance,
            ..
        }) => {
            let what = "orientation";
            finite(what, points, |point| point.iter().flatten().all(|c| c.is_finite()))?;
            let weights = self::weights(what, points.len(), own.as_deref())?;
            let points: Vec<f64> = points.iter().flatten().flatten().copied().collect();
            let matrices =
                RationalSpline::new(vec![around], 9, &points, &weights).map_err(|error| rational(what, &error))?;
            SplineMotion::from_matrices(&matrices, &tip, tolerance.unwrap_or(TOLERANCE))
        }
    };
    motion.map(Path::along).map_err(|error| {
        let field: &[&'static str] = match &error {
            MotionError::Curve { what, .. } | MotionError::Spline { what, .. } => &[what],
            MotionError::Degree { what, .. } => &[what, "degree"],
            MotionError::NotFinite { what, .. } => &[what, "points"],
            MotionError::Domains { .. } => &["orientation", "knots"],
            MotionError::Tolerance(_) => &["orientation", "tolerance"],
            MotionError::Weight { .. } => &["tip", "weights"],
            MotionError::NoOrientation { .. } | MotionError::NoRotation { .. } | MotionError::Mirrored => {
                &["orientation", "points"]
            }
            MotionError::Pose { .. } => &["orientation"],
            _ => &[],
        };
        fault(Problem::Motion(error.clone()), field)
    })
}

fn fault(problem: Problem, field: &[&'static str]) -> Fault {
    Fault {
        problem,
        field: field.iter().map(|key| Step::from(*key)).collect(),
    }
}

/// The knots given for a curve with a number of points.
fn given(what: &'static str, degree: usize, points: usize, list: Option<&[f64]>) -> Result<Option<KnotVector>, Fault> {
    if points <= degree {
        let problem = Problem::value(
            format!("the number of points of the {what}"),
            points,
            format!("more than its degree, {degree}"),
        );
        return Err(fault(problem, &[what, "points"]));
    }
    let Some(list) = list else { return Ok(None) };
    if list.len() != points + degree + 1 {
        let problem = Problem::value(
            format!("the number of knots of the {what}"),
            list.len(),
            format!("{}: its points, its degree and one more", points + degree + 1),
        );
        return Err(fault(problem, &[what, "knots"]));
    }
    let knots = KnotVector::new(degree, list.to_vec()).map_err(|error| no_knots(what, &error))?;
    Ok(Some(knots))
}

/// Evenly spaced, clamped knots.
fn even(what: &'static str, degree: usize, points: usize, domain: (f64, f64)) -> Result<KnotVector, Fault> {
    KnotVector::uniform(degree, points - degree, domain.0, domain.1).map_err(|error| no_knots(what, &error))
}

fn no_knots(what: &'static str, error: &KnotError) -> Fault {
    let problem = Problem::syntax(format!("the knots of the {what}: {error}"));
    fault(problem, &[what, "knots"])
}

fn weights(what: &'static str, points: usize, given: Option<&[f64]>) -> Result<Vec<f64>, Fault> {
    match given {
        None => Ok(vec![1.0; points]),
        Some(list) if list.len() == points => Ok(list.to_vec()),
        Some(list) => {
            let problem = Problem::value(
                format!("the number of weights of the {what}"),
                list.len(),
                format!("{points}, as many as points"),
            );
            Err(fault(problem, &[what, "weights"]))
        }
    }
}

fn finite<P>(what: &'static str, points: &[P], good: impl Fn(&P) -> bool) -> Result<(), Fault> {
    let Some(bad) = points.iter().position(|point| !good(point)) else {
        return Ok(());
    };
    let problem = Problem::syntax(format!("point {bad} of the {what} has a number that is not finite"));
    let mut fault = fault(problem, &[what, "points"]);
    fault.field.push(Step::Item(bad));
    Err(fault)
}

fn curve(knots: KnotVector, quaternions: &[[f64; 4]]) -> Result<BSpline, Fault> {
    finite("orientation", quaternions, |point| point.iter().all(|c| c.is_finite()))?;
    BSpline::new(vec![knots], 4, quaternions.concat()).map_err(|error| {
        let problem = Problem::syntax(format!("the orientation: {error}"));
        fault(problem, &["orientation", "points"])
    })
}

fn rational(what: &'static str, error: &SplineError) -> Fault {
    let field = match error {
        SplineError::Weight { .. } => "weights",
        _ => "points",
    };
    fault(Problem::syntax(format!("the {what}: {error}")), &[what, field])
}
