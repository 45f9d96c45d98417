//! Sections of a swept volume by a plane, as curves: the paper's Eq. 4 and 5.

use crate::cutter::Cutter;
use crate::envelope::systems::{EdgeMotion, PatchMotion, PlacedPatch, Plane};
use crate::error::SweepError;
use crate::sections::boundary_piece::{BoundaryPiece, BoundaryPoint, Moving};
use crate::sections::loops::{Passage, passages};
use crate::sweep::{Cut, Options, Plan, probe_lines};
use crate::time::path_parts::PathPart;
use crate::tolerances::{ChordTolerance, Tolerances, curve_options};
use nalgebra::Vector3;
use rayon::prelude::*;
use sweepsim_dexel::Frame;
use sweepsim_motion::Tool;
use sweepsim_solve::{CancelOnly, CurveSolver, Monitor, System, SystemError};

/// A curve of a section.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SectionCurve {
    /// Number of the cut.
    pub cut: usize,
    /// The origin of the curve.
    pub piece: BoundaryPiece,
    /// Number of the move.
    pub segment: u32,
    /// The points, in order. The first point of a closed curve is repeated at the end.
    pub points: Vec<BoundaryPoint>,
    /// For each point, whether it bounds the volume, that is, no other part of any sweep covers it.
    pub outer: Vec<bool>,
}

/// The section of a swept volume by a plane.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Section {
    /// The plane.
    pub plane: Plane,
    /// The curves of all pieces of the envelope, including those inside the volume.
    pub curves: Vec<SectionCurve>,
    /// Pieces whose curves are uncertified, with the numbers of their cut and move.
    pub open: Vec<(usize, BoundaryPiece, u32)>,
    /// The maximum distance between the curves and their polylines.
    pub(super) chord: f64,
    /// For each curve, where others cross it.
    pub(super) passages: Vec<Vec<Passage>>,
}

impl Section {
    /// The parts of the curves that bound the volume.
    #[must_use]
    pub fn outline(&self) -> Vec<Vec<[f64; 3]>> {
        let mut lines = Vec::new();
        for curve in &self.curves {
            let mut line: Vec<[f64; 3]> = Vec::new();
            for (point, outer) in curve.points.iter().zip(&curve.outer) {
                if *outer {
                    line.push(point.position);
                } else if !line.is_empty() {
                    lines.push(std::mem::take(&mut line));
                }
            }
            lines.push(line);
        }
        lines.retain(|line| line.len() > 1);
        lines
    }
}

/// The budget of boxes for the curves of one piece.
const BOXES: u64 = 20_000;

/// The section of the volume that the cuts sweep together by a plane of any direction, as polylines within `chord` of the curves.
///
/// # Errors
/// [`SweepError`]: cancelled, or an invalid tolerance or chord error.
///
/// ```
/// use sweepsim::{Cut, Options, section, systems::Plane};
/// use sweepsim_motion::{Path, Pose, Tool};
///
/// // A ball end along x: across it, the groove has the ball's outline.
/// let up = [0.0, 0.0, 1.0];
/// let path = Path::new(vec![Pose::new([-9.0, 0.0, 0.0], up)?, Pose::new([9.0, 0.0, 0.0], up)?])?;
/// let tool = Tool::ball(2.0, 30.0)?;
/// let cut = Cut::new(&tool, &path);
/// let groove = section(&[cut], &Plane::x(0.5)?, 1e-3, &Options::default(), &())?;
/// for [_, y, z] in groove.outline().into_iter().flatten().filter(|p| p[2] < 1.99) {
///     assert!((y.hypot(z - 2.0) - 2.0).abs() < 1e-6);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn section(
    cuts: &[Cut],
    plane: &Plane,
    chord: f64,
    options: &Options,
    monitor: &dyn Monitor,
) -> Result<Section, SweepError> {
    let limits = ChordTolerance::new(chord)?;
    let mut section = Section {
        plane: *plane,
        curves: Vec::new(),
        open: Vec::new(),
        chord,
        passages: Vec::new(),
    };
    for (number, Cut { tool, path }) in cuts.iter().enumerate() {
        let plan = Plan::new(tool, path, &Frame::WORLD, std::iter::once(plane.offset()), options)?;
        let found: Vec<Found> = (0..plan.parts.len())
            .into_par_iter()
            .with_max_len(1)
            .map(|at| {
                if monitor.cancelled() || !reaches(&plan.parts[at], plane, plan.cutter.reach) {
                    return (Vec::new(), Vec::new());
                }
                of_part((tool, number), &plan.cutter, (&plan.parts, at), plane, limits, monitor)
            })
            .collect();
        if monitor.cancelled() {
            return Err(SweepError::Cancelled);
        }
        for (curves, open) in found {
            section.curves.extend(curves);
            section.open.extend(open);
        }
    }
    section.passages = passages(&section.curves, plane.frame(), chord);
    // Passages lie on chords, so they are tested farther away.
    let off = Tolerances::new(options.tolerance, 0.0)?.outside();
    let vertices = section.curves.iter().flat_map(|curve| &curve.points);
    let between = section
        .passages
        .iter()
        .flatten()
        .map(|passage| (&passage.point, off + 2.0 * chord));
    let points: Vec<(&BoundaryPoint, f64)> = vertices.map(|point| (point, off)).chain(between).collect();
    let mut outer = outer(cuts, &points, options, monitor)?.into_iter();
    for curve in &mut section.curves {
        curve.outer = outer.by_ref().take(curve.points.len()).collect();
    }
    for (passage, outer) in section.passages.iter_mut().flatten().zip(outer) {
        passage.outer = outer;
    }
    Ok(section)
}

/// Whether points of the envelope bound the volume: the points this far outside them are not swept. If that is uncertain, they count
/// as outer.
pub(crate) fn outer(
    cuts: &[Cut],
    points: &[(&BoundaryPoint, f64)],
    options: &Options,
    monitor: &dyn Monitor,
) -> Result<Vec<bool>, SweepError> {
    let outside: Vec<[f64; 3]> = points
        .iter()
        .map(|(point, off)| [0, 1, 2].map(|k| point.position[k] + off * point.normal[k]))
        .collect();
    let lines: Vec<[f64; 2]> = outside.iter().map(|p| [p[0], p[1]]).collect();
    let mut outer = vec![true; points.len()];
    for Cut { tool, path } in cuts {
        let swept = probe_lines(tool, path, &Frame::WORLD, &lines, options, monitor)?;
        for (n, intervals) in swept.iter().enumerate() {
            let z = outside[n][2];
            let covers = |all: &Vec<sweepsim_dexel::Interval>| all.iter().any(|i| i.lower.z < z && z < i.upper.z);
            outer[n] &= !intervals.as_ref().is_ok_and(covers);
        }
    }
    Ok(outer)
}

/// Whether the tool comes close to the plane.
fn reaches(part: &PathPart, plane: &Plane, reach: f64) -> bool {
    let normal = Vector3::from(plane.normal());
    let margin = reach * normal.norm();
    let (points, weights) = part.segment.points();
    let heights = points
        .iter()
        .zip(&weights)
        .map(|(p, w)| p.dot(&normal) / w - plane.offset());
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), h| (a.min(h), b.max(h)));
    low <= margin && high >= -margin
}

type Found = (Vec<SectionCurve>, Vec<(usize, BoundaryPiece, u32)>);

fn of_part(
    (tool, cut): (&Tool, usize),
    cutter: &Cutter,
    (parts, at): (&[PathPart], usize),
    plane: &Plane,
    chord: ChordTolerance,
    monitor: &dyn Monitor,
) -> Found {
    let moving = Moving::new(&cutter.patches, &cutter.edges, parts, at);
    let segment = &parts[at].segment;
    let speed = moving.speed(cutter.reach);
    // No parameter moves a point by more than this: a patch's side by its control polygon's longest leg times the degree.
    let fastest = tool
        .patches()
        .iter()
        .map(|patch| stretch(patch.position(), patch.weight()));
    let fastest = fastest.chain(tool.edges().iter().map(|edge| stretch(edge.position(), edge.weight())));
    let fastest = fastest.fold(speed, f64::max).max(f64::MIN_POSITIVE);
    let mut solver = CurveSolver::with_options(chord.of_curve(fastest), curve_options(BOXES, 16));
    let (mut curves, mut open) = (Vec::new(), Vec::new());
    let number = parts[at].number;
    for piece in moving.pieces(tool) {
        let system = system(piece, tool, segment, plane);
        let Some(found) = system
            .ok()
            .and_then(|system| solver.solve(&system, &CancelOnly(monitor)).ok())
        else {
            open.push((cut, piece, number));
            continue;
        };
        if !found.singular.is_empty() {
            open.push((cut, piece, number));
        }
        for curve in found.curves {
            let mut points: Vec<&[f64]> = curve.points.iter().map(|p| p.point.as_slice()).collect();
            if curve.ends.is_none() {
                points.push(points[0]);
            }
            let Some(points) = refined(&moving, piece, &points, chord.of_step()) else {
                open.push((cut, piece, number));
                continue;
            };
            let points: Vec<&[f64]> = points.iter().map(Vec::as_slice).collect();
            for points in kept(&moving, piece, &points) {
                curves.push(SectionCurve {
                    cut,
                    piece,
                    segment: number,
                    outer: Vec::new(),
                    points,
                });
            }
        }
    }
    (curves, open)
}

fn system(
    piece: BoundaryPiece,
    tool: &Tool,
    segment: &sweepsim_motion::Segment,
    plane: &Plane,
) -> Result<System, SystemError> {
    let [first, last] = segment.tips().map(Vector3::from);
    match piece {
        BoundaryPiece::Patch(k) => PatchMotion::new(&tool.patches()[k], segment).section(plane),
        BoundaryPiece::Edge(k) => EdgeMotion::new(&tool.edges()[k], segment).section(plane),
        BoundaryPiece::Placed(k) => PlacedPatch::new(&tool.patches()[k], &segment.start(), &first).section(plane),
        BoundaryPiece::Last(k) => PlacedPatch::new(&tool.patches()[k], &segment.end(), &last).section(plane),
    }
}

/// The maximum number of halvings of a step of a polyline.
const HALVINGS: u32 = 12;
/// The most points of a curve. If the chord error takes more, the curve is left open.
const POINTS: usize = 200_000;

/// The polyline with as many more points as needed to keep the midpoints of its steps within `off` of the curve: a curve that is straight in the
/// parameters may be round in space. `None` if these are more than [`POINTS`].
fn refined(moving: &Moving, piece: BoundaryPiece, points: &[&[f64]], off: f64) -> Option<Vec<Vec<f64>>> {
    let place = |x: &[f64]| Vector3::from(moving.see(piece, x).point.position);
    let mut all: Vec<Vec<f64>> = Vec::with_capacity(points.len());
    all.extend(points.first().map(|x| x.to_vec()));
    for pair in points.windows(2) {
        // The points still to be reached, the nearest last.
        let mut ahead: Vec<(Vec<f64>, u32)> = vec![(pair[1].to_vec(), 0)];
        let mut from = pair[0].to_vec();
        while let Some((to, _)) = ahead.last() {
            let middle: Vec<f64> = from.iter().zip(to).map(|(a, b)| 0.5 * (a + b)).collect();
            let sag = (place(&middle) - 0.5 * (place(&from) + place(to))).norm();
            if all.len() + ahead.len() > POINTS {
                return None;
            }
            let Some((_, depth)) = ahead.last_mut() else { break };
            if sag > off && *depth < HALVINGS {
                *depth += 1;
                let depth = *depth;
                ahead.push((middle, depth));
            } else {
                all.extend(ahead.pop().map(|(to, _)| to));
                from.clone_from(&all[all.len() - 1]);
            }
        }
    }
    Some(all)
}

/// The runs of a polyline that belong to the boundary of their move, cut where a condition changes its sign.
fn kept(moving: &Moving, piece: BoundaryPiece, points: &[&[f64]]) -> Vec<Vec<BoundaryPoint>> {
    let belongs = |sides: Option<[f64; 2]>| sides.is_none_or(|[a, b]| (a < 0.0) != (b < 0.0));
    let mut runs: Vec<Vec<BoundaryPoint>> = Vec::new();
    let mut run: Vec<BoundaryPoint> = Vec::new();
    for (n, x) in points.iter().enumerate() {
        let seen = moving.see(piece, x);
        let inside = belongs(seen.sides);
        if n > 0 && inside == run.is_empty() {
            // The ends of a run lie on the chord where the sign changes: halving finds it.
            let (mut from, mut to) = (points[n - 1].to_vec(), x.to_vec());
            for _ in 0..40 {
                let middle: Vec<f64> = from.iter().zip(&to).map(|(a, b)| 0.5 * (a + b)).collect();
                if belongs(moving.see(piece, &middle).sides) == inside {
                    to = middle;
                } else {
                    from = middle;
                }
            }
            run.push(moving.see(piece, if inside { &to } else { &from }).point);
        }
        if inside {
            run.push(seen.point);
        } else if !run.is_empty() {
            runs.push(std::mem::take(&mut run));
        }
    }
    runs.push(run);
    runs.retain(|run| run.len() > 1);
    runs
}

/// A bound on how fast the point moves with a parameter: the largest difference of neighbouring control points, times the degree,
/// times the variation of the weights.
pub(crate) fn stretch(position: &[sweepsim_spline::Bernstein; 3], weight: &sweepsim_spline::Bernstein) -> f64 {
    let weights = weight.coefficients();
    let point = |i: usize| Vector3::from([0, 1, 2].map(|k| position[k].coefficients()[i] / weights[i]));
    let (least, most) = weights
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(a, b), w| (a.min(*w), b.max(*w)));
    let degrees = weight.degrees();
    let mut fastest = 0.0_f64;
    let mut stride = 1;
    for degree in degrees {
        for i in 0..weights.len() {
            if i / stride % (degree + 1) < *degree {
                fastest = fastest.max((point(i + stride) - point(i)).norm() * *degree as f64);
            }
        }
        stride *= degree + 1;
    }
    // Floater 1992: |p′| ≤ n (w_max / w_min)² max |Δp|.
    fastest * (most / least).powi(2)
}
