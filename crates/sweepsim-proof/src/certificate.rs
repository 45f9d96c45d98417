//! A proof and what it is about, as the plain numbers that a checker takes.

use crate::search::{Cutter, Enclosed, Limits, Piece};
use crate::solid::Target;
use crate::tool::Convex;
use nalgebra::Vector3;
use std::collections::BTreeMap;
use sweepsim_check::{
    Claim, Curve, Move, Outline, Path, Piece as PlainPiece, Scene, Solid, SolidArc, TreePart, Witness, trees,
};
use sweepsim_dexel::TriangleSoup;
use sweepsim_motion::{MeridianShape, Pose, Segment, Tool};

/// Target, tools and paths of a statement as plain numbers. `cutters`: each with the number of its tool.
#[must_use]
pub fn scene<'a>(
    target: &TriangleSoup,
    tools: impl IntoIterator<Item = (u32, &'a Tool)>,
    cutters: &[(u32, Cutter)],
    limits: &Limits,
) -> Scene {
    let mut scene = Scene::default();
    scene.triangles.clone_from(&target.triangles);
    scene.tools = tools
        .into_iter()
        .map(|(number, tool)| (number, outline(tool)))
        .collect();
    scene.paths = cutters
        .iter()
        .map(|(tool, cutter)| path(*tool, cutter, limits))
        .collect();
    scene.deviation = limits.deviation();
    scene
}

/// What was [recorded](crate::deepest_recorded) of a proof, as a claim: nothing if it was too much.
///
/// `cutters`: each with the number of its tool.
#[must_use]
pub fn claim(target: &Target, cutters: &[(u32, Cutter)], limits: &Limits, found: &Enclosed) -> Option<Claim> {
    if found.trees.iter().any(|tree| tree.bytes.is_empty()) {
        return None;
    }
    let tools: BTreeMap<u32, Vec<Solid>> = cutters
        .iter()
        .map(|(tool, cutter)| (*tool, cutter.solids.iter().map(solid).collect()))
        .collect();
    let part = |(path, number): (usize, usize)| {
        let tree = found
            .trees
            .iter()
            .find(|tree| tree.path == path && tree.moves.contains(&number));
        tree.map(|tree| [tree.moves.start, tree.moves.len()])
    };
    let witness = match &found.deepest {
        None => None,
        Some((path, witness)) => Some(Witness {
            path: *path,
            number: witness.number,
            moves: part((*path, witness.number))?,
            piece: witness.piece,
            place: witness.place,
        }),
    };
    Some(Claim {
        about: "gouge".to_owned(),
        limit: limits.depth,
        enclosure: [witness.as_ref().map_or(0.0, |_| known(found)), found.bound],
        witness,
        root: target.root(),
        tools,
        trees: trees(found.trees.iter().map(|tree| TreePart {
            path: tree.path,
            moves: [tree.moves.start, tree.moves.len()],
            solid: tree.solid,
            bytes: &tree.bytes,
        })),
    })
}

fn known(found: &Enclosed) -> f64 {
    found.deepest.as_ref().map_or(0.0, |(_, witness)| witness.depth)
}

fn solid(convex: &Convex) -> Solid {
    let arc = |(centre, radius, normals)| SolidArc {
        centre,
        radius,
        normals,
    };
    Solid {
        corners: convex.corners().to_vec(),
        arcs: convex.arcs().map(arc).collect(),
    }
}

fn outline(tool: &Tool) -> Outline {
    let curve = |curve: sweepsim_motion::MeridianCurve| match curve.shape {
        MeridianShape::Line => Curve::Line([curve.from, curve.to]),
        MeridianShape::Arc {
            centre,
            radius,
            start,
            sweep,
        } => Curve::Arc {
            ends: [curve.from, curve.to],
            centre,
            radius,
            start,
            sweep,
        },
        _ => Curve::Bezier(curve.controls),
    };
    let curves: Vec<Curve> = tool.meridians().into_iter().map(curve).collect();
    let points = if curves.is_empty() {
        around_axis(tool)
    } else {
        Vec::new()
    };
    Outline { curves, points }
}

/// The control points of a tool's patches, `(ρ, ζ)`.
fn around_axis(tool: &Tool) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    for patch in tool.patches() {
        for (i, weight) in patch.weight().coefficients().iter().enumerate() {
            let [x, y, z] = [0, 1, 2].map(|k| patch.position()[k].coefficients()[i] / weight);
            points.push([x.hypot(y), z]);
        }
    }
    points
}

/// Paths are looked at in parts of so many moves.
const TOGETHER: usize = 64;

fn path(tool: u32, cutter: &Cutter, limits: &Limits) -> Path {
    let plain = |pose: &Pose| [pose.tip(), pose.axis()];
    let poses: Vec<_> = cutter.path.poses_in_order(0).map(|pose| plain(&pose)).collect();
    let count = cutter.path.moves();
    let own = Cutter {
        others: None,
        ..*cutter
    };
    let mut moves = Vec::with_capacity(count);
    for first in (0..count).step_by(TOGETHER) {
        let pieces = own.pieces(first..count.min(first + TOGETHER), limits.deviation());
        for pieces in pieces.chunk_by(|a, b| a.number == b.number) {
            moves.push(motion(pieces, &poses[moves.len()], &poses[moves.len() + 1]));
        }
    }
    let others = cutter.others.iter().flat_map(|others| others.of(0..count));
    Path {
        tool,
        poses,
        moves,
        others: others
            .map(|other| (other.number, other.path.poses().iter().map(plain).collect()))
            .collect(),
    }
}

/// A move: linear, if its only piece is.
fn motion(pieces: &[Piece], from: &[[f64; 3]; 2], to: &[[f64; 3]; 2]) -> Move {
    if let [piece] = pieces
        && is_linear(&piece.segment, from, to)
    {
        return Move::Linear;
    }
    Move::Pieces(pieces.iter().map(|piece| plain(&piece.segment)).collect())
}

/// Whether a piece is the linear move between two poses, but for rounding.
fn is_linear(segment: &Segment, from: &[[f64; 3]; 2], to: &[[f64; 3]; 2]) -> bool {
    let [a, b] = [from[1], to[1]].map(Vector3::from);
    let Some(middle) = (a + b).try_normalize(1.0) else {
        return false;
    };
    let near = |axis: Vector3<f64>, other: Vector3<f64>| (axis - other).norm() < 1e-13;
    let axes: Vec<_> = segment.turns().iter().map(|turn| turn.column(2).into_owned()).collect();
    let turns = match (&axes[..], segment.weights()) {
        ([axis], [w]) => near(axis / *w, a) && near(axis / *w, b),
        ([p, q, r], [1.0, w, 1.0]) => {
            let still = near(a, b) && near(q / *w, a);
            near(*p, a) && near(*r, b) && (still || near(*q, middle) && (w - 0.5 * (a + b).norm()).abs() < 1e-13)
        }
        _ => false,
    };
    segment.is_arc() && segment.tips() == [from[0], to[0]] && turns
}

fn plain(segment: &Segment) -> PlainPiece {
    let (points, tip_weights) = segment.points();
    PlainPiece {
        tips: points.into_iter().map(Into::into).collect(),
        tip_weights,
        axes: segment
            .turns()
            .iter()
            .map(|turn| turn.column(2).into_owned().into())
            .collect(),
        axis_weights: segment.weights().to_vec(),
    }
}
