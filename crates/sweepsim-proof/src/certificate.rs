//! A proof and what it is about, as the plain numbers that a checker takes.

use crate::excess::Left;
use crate::motion::{Cutter, Piece};
use crate::process::Touched;
use crate::search::{Closest, Enclosed, Tree};
use crate::solid::Target;
use crate::tool::{Convex, cores, cover};
use nalgebra::Vector3;
use rayon::prelude::*;
use std::ops::Range;
use sweepsim_check::{Claim, Course, Curve, Motion, Outline, Question, Scene, Witness, packed};
use sweepsim_motion::{MeridianCurve, MeridianShape, Segment, Tool};

/// The outline of a tool; of one without, that of solids that [cover] it. With what it holds for certain, if it
/// cuts.
#[must_use]
pub fn outline(tool: &Tool, cuts: bool) -> Outline {
    let curve = |curve: MeridianCurve| match curve.shape {
        MeridianShape::Line => Curve::Bezier([curve.from, curve.to].map(|end| (end, 1.0)).to_vec()),
        MeridianShape::Arc {
            centre,
            radius,
            start,
            sweep,
        } => Curve::Arc {
            centre,
            radius,
            angles: [start, start + sweep],
        },
        _ => Curve::Bezier(curve.controls),
    };
    let mut curves: Vec<Curve> = tool.meridians().into_iter().map(curve).collect();
    if curves.is_empty() {
        let sides = |solid: Convex| {
            solid
                .corners()
                .windows(2)
                .map(|side| Curve::Hull(side.to_vec()))
                .collect()
        };
        curves = cover(tool, 0.0).into_iter().flat_map::<Vec<Curve>, _>(sides).collect();
    }
    let cores = if cuts { cores(tool) } else { Vec::new() };
    Outline {
        curves,
        cores: cores.iter().map(|core| core.corners().to_vec()).collect(),
    }
}

/// The motions of a path, in the order in which proofs look at them. `is_idle`: whether a move must not cut.
#[must_use]
pub fn motions(cutter: &Cutter, deviation: f64, is_idle: &dyn Fn(usize) -> bool) -> Vec<Motion> {
    let mut all = Vec::with_capacity(cutter.path.moves());
    for moves in cutter.blocks() {
        let pieces = cutter.pieces(moves, deviation);
        all.extend(pieces.iter().map(|piece| Motion {
            number: piece.number,
            possible: piece.is_other,
            idle: is_idle(piece.number),
            course: course(piece),
        }));
    }
    all
}

/// A linear motion, if it is one but for rounding.
fn course(piece: &Piece) -> Course {
    let segment = &piece.segment;
    let [from, to] = segment.tips();
    let axis = |k: usize| (segment.turns()[k].column(2) / segment.weights()[k]).into();
    let ends = [[from, axis(0)], [to, axis(segment.weights().len() - 1)]];
    if is_linear(segment, &ends) {
        return Course::Linear(ends);
    }
    let (points, weights) = segment.points();
    let tips = points.into_iter().map(Into::into).zip(weights).collect();
    let axes = segment.turns().iter().map(|turn| turn.column(2).into_owned().into());
    Course::Rational([tips, axes.zip(segment.weights().iter().copied()).collect()])
}

/// Whether a segment is the linear motion between its ends, but for rounding.
fn is_linear(segment: &Segment, ends: &[[[f64; 3]; 2]; 2]) -> bool {
    let [a, b] = ends.map(|end| Vector3::from(end[1]));
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
    segment.is_arc() && turns && a.dot(&b) > 0.0
}

/// The cutters that answer a question, each with the number of its path.
type Answering<'a> = &'a [(usize, Cutter<'a>)];

/// How an outline is cut into solids.
type Cover = Vec<[usize; 2]>;

/// For each mover of a question, or each cutter, by their paths and outlines: its cutter, the first of its solids
/// there, and how the outline is cut.
fn movers(scene: &Scene, asked: &[(usize, usize)], cutters: Answering) -> Option<Vec<(usize, usize, Cover)>> {
    let mut taken = vec![0; cutters.len()];
    let one = |(path, outline): &(usize, usize)| {
        let number = cutters.iter().position(|(own, _)| own == path)?;
        let solids = cutters[number].1.solids;
        let (first, mut curves, mut cover) = (taken[number], 0, Vec::new());
        while curves < scene.outlines[*outline].curves.len() {
            let [count, parts] = solids.get(taken[number])?.cut();
            curves += count;
            taken[number] += parts;
            cover.push([count, parts]);
        }
        taken[number] += scene.outlines[*outline].cores.len();
        Some((number, first, cover))
    };
    asked.iter().map(one).collect()
}

/// Trees in the numbers of a question; nothing if one of them was too large.
fn trees(
    scene: &Scene,
    question: &Question,
    cutters: Answering,
    all: &[Tree],
) -> Option<(Vec<Cover>, Vec<sweepsim_check::Tree>)> {
    let movers = movers(scene, &question.movers, cutters)?;
    let one = |tree: &Tree| {
        let own = |(cutter, first, _): &(usize, usize, _)| *cutter == tree.path && *first <= tree.solid;
        let mover = movers.iter().rposition(own)?;
        let path = &scene.paths[question.movers[mover].0];
        let [first, last] = [tree.moves.start, tree.moves.end].map(|number| first_motion(path, number));
        (!tree.bytes.is_empty()).then(|| sweepsim_check::Tree {
            mover,
            solid: tree.solid - movers[mover].1,
            first,
            count: last - first,
            bytes: packed(&tree.bytes),
        })
    };
    let is_cover = |tree: &&Tree| {
        let own = cutters
            .get(tree.path)
            .and_then(|(_, cutter)| cutter.solids.get(tree.solid));
        !own.is_some_and(Convex::is_core)
    };
    let trees = all.par_iter().filter(is_cover).map(one).collect::<Option<_>>()?;
    Some((movers.into_iter().map(|(_, _, cover)| cover).collect(), trees))
}

/// The first motion of a part of the work that begins with a move.
fn first_motion(path: &[Motion], number: usize) -> usize {
    path.partition_point(|motion| motion.number < number)
}

/// An answer to a question about depths: nothing if it was not recorded, or too much.
#[must_use]
pub fn depth_claim(
    scene: &Scene,
    question: &Question,
    target: &Target,
    cutters: Answering,
    found: &Enclosed,
) -> Option<Claim> {
    let (covers, trees) = trees(scene, question, cutters, &found.trees)?;
    let witness = match &found.deepest {
        None => None,
        Some((number, witness)) => {
            let (path, cutter) = &cutters[*number];
            let path = *path;
            let mut blocks = cutter.blocks().into_iter();
            let own = blocks.find(|moves| moves.contains(&witness.number))?;
            let first = first_motion(&scene.paths[path], own.start);
            let is_own = |(own, _): &(usize, usize)| *own == path;
            question.movers.iter().any(is_own).then(|| Witness {
                path,
                motion: first + witness.piece.0,
                time: witness.piece.1,
                place: witness.place,
                depth: witness.depth,
            })
        }
    };
    Some(Claim {
        about: question.about.clone(),
        bound: found.bound,
        witness,
        root: target.root(),
        lift: target.lift(),
        covers,
        trees,
    })
}

/// An answer to a question about distances, which are depths of less than 0.
#[must_use]
pub fn distance_claim(
    scene: &Scene,
    question: &Question,
    target: &Target,
    bodies: Answering,
    found: &Closest,
) -> Option<Claim> {
    let (covers, trees) = trees(scene, question, bodies, &found.trees)?;
    (found.bound > 0.0 && found.bound.is_finite()).then(|| Claim {
        about: question.about.clone(),
        bound: -found.bound,
        witness: None,
        root: target.root(),
        lift: target.lift(),
        covers,
        trees,
    })
}

/// Trees are about so many motions, and some more.
const MOTIONS: usize = 1 << 14;

/// An answer to a question about material: nothing if it was not proven, or not in a way that can be checked. `bound`:
/// what is measured is no more.
#[must_use]
pub fn material_claim(
    scene: &Scene,
    question: &Question,
    [own, cutters]: [Answering; 2],
    bound: f64,
    touched: &Touched,
) -> Option<Claim> {
    let found = touched.trees.as_ref()?;
    let moving = movers(scene, &question.movers, own)?;
    let mut trees = Vec::new();
    for (mover, (cutter, first_solid, cover)) in moving.iter().enumerate() {
        let path = own[*cutter].0;
        for solid in 0..cover.iter().map(|[_, parts]| parts).sum() {
            let is_own = |tree: &&Tree| tree.path == path && tree.solid == first_solid + solid;
            let own: Vec<&Tree> = found.iter().filter(is_own).collect();
            let length = scene.paths[path].len();
            let (mut first, mut bytes) = (0, Vec::new());
            // Where no tree is, nothing is looked at.
            for (number, tree) in own.iter().enumerate() {
                bytes.extend_from_slice(&tree.bytes);
                let next = own.get(number + 1);
                let end = next.map_or(length, |next| first_motion(&scene.paths[path], next.moves.start));
                if end - first >= MOTIONS || next.is_none() {
                    trees.push((mover, solid, first..end, std::mem::take(&mut bytes)));
                    first = end;
                }
            }
            if first < length {
                trees.push((mover, solid, first..length, Vec::new()));
            }
        }
    }
    let packed = |(mover, solid, motions, bytes): (usize, usize, Range<usize>, Vec<u8>)| sweepsim_check::Tree {
        mover,
        solid,
        first: motions.start,
        count: motions.len(),
        bytes: packed(&bytes),
    };
    let cutters = movers(scene, &question.cutters, cutters)?;
    let covers = moving.into_iter().chain(cutters);
    Some(Claim {
        about: question.about.clone(),
        bound,
        covers: covers.map(|(_, _, cover)| cover).collect(),
        trees: trees.into_par_iter().map(packed).collect(),
        ..Claim::default()
    })
}

/// An answer to a question about heights.
#[must_use]
pub fn height_claim(scene: &Scene, question: &Question, cutters: Answering, left: &Left) -> Option<Claim> {
    let covers = movers(scene, &question.movers, cutters)?
        .into_iter()
        .map(|(_, _, cover)| cover)
        .collect();
    let tree = |(first, count, bytes): &(usize, usize, Vec<u8>)| sweepsim_check::Tree {
        mover: 0,
        solid: 0,
        first: *first,
        count: *count,
        bytes: packed(bytes),
    };
    (left.bound.is_finite() && !left.trees.is_empty()).then(|| Claim {
        about: question.about.clone(),
        bound: left.bound,
        witness: None,
        root: ([0.0; 3], 0.0),
        lift: 0.0,
        covers,
        trees: left.trees.par_iter().map(tree).collect(),
    })
}
