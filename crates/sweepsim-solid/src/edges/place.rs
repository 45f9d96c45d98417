//! Vertices and edges in space.

use super::chains::{Chain, Chains};
use super::curve::{Curve, Edge};
use super::trace::Course;
use crate::label::{FREE, Groups, Labels};
use crate::net::Net;
use crate::parts::SolidOptions;
use crate::solve::{Condition, meet, sine};
use crate::surface::Surface;
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// Vertices of a chain that are looked at.
const GUIDES: usize = 24;
/// How far points may be moved onto surfaces, in cells.
const FAR: f64 = 2.0;
/// Longer chains, in cells, do not fall together.
const SPAN: f64 = 3.0;
/// Edges of triangles shorter than this, in cells, are none.
const LEAST: f64 = 1e-2;
/// Corners with a shorter chain between them may be one, in cells.
const SHORT: f64 = 1.5;
/// Surfaces that meet at larger angles than this, as a sine, cross there, although they may touch nearby.
const CROSSING: f64 = 0.1;

/// Where chains and their corners are.
pub(crate) struct Placed {
    /// Of each chain its edge; none if its ends fell together.
    pub edges: Vec<Option<Edge>>,
    /// The vertices of the solid, by their place in [`Edge::vertices`].
    pub vertices: Vec<Vector3<f64>>,
    /// Vertices of the mesh where no point was found, or chains for which no edge was.
    pub failed: Vec<u32>,
}

/// The places of two ends.
type Bits = [[u64; 3]; 2];

/// What was found in earlier rounds: vertices of the mesh keep their numbers and places, and labels their surfaces.
#[derive(Default)]
pub(crate) struct Known {
    /// Whether surfaces touch, by the vertices of a chain and its labels.
    touch: BTreeMap<(Vec<u32>, [u32; 2]), bool>,
    /// Edges, by the places of their ends as well.
    edges: BTreeMap<(Vec<u32>, [u32; 2], Bits), Option<Edge>>,
}

/// What a chain runs along.
#[derive(Clone, Copy)]
pub(crate) enum Between<'a> {
    /// A face without a surface is on one side.
    Free,
    /// Two surfaces, and whether they touch.
    Surfaces([&'a Surface; 2], bool),
}

/// Finds the vertices and edges of the solid.
pub(crate) fn place(
    net: &Net,
    groups: &Groups,
    labels: &Labels,
    chains: &Chains,
    scale: &SolidOptions,
    known: &mut Known,
) -> Placed {
    let between: Vec<Between> = chains
        .all
        .iter()
        .map(|chain| between(net, groups, labels, chain, scale, known))
        .collect();
    let (nodes, mut failed) = nodes(net, groups, labels, chains, &between, scale);
    let mut numbers: BTreeMap<u32, u32> = nodes.keys().enumerate().map(|(k, v)| (*v, k as u32)).collect();
    let mut vertices: Vec<Vector3<f64>> = nodes.values().copied().collect();
    collapse(net, groups, chains, &mut numbers, &mut vertices, scale);
    let mut edges = Vec::with_capacity(chains.all.len());
    for (chain, between) in chains.all.iter().zip(&between) {
        let own = chain.ends().map(|vertex| numbers[&vertex]);
        let round = chain.ends()[0] == chain.ends()[1];
        if own[0] == own[1] && !round && extent(net, chain) < SPAN * scale.cell {
            edges.push(None);
            continue;
        }
        let ends = own.map(|vertex| vertices[vertex as usize]);
        let edge = match between {
            Between::Free => Some(Edge {
                vertices: own,
                ends,
                curve: Curve::Line,
            }),
            Between::Surfaces(surfaces, touch) => {
                let key = (chain.vertices.clone(), labels_of(groups, chain), bits(ends));
                let make = || course(net, chain, *surfaces, *touch, own, ends, scale).edge();
                let edge = known.edges.entry(key).or_insert_with(make).clone();
                edge.map(|edge| Edge { vertices: own, ..edge })
            }
        };
        if edge.is_none() {
            failed.extend(&chain.vertices);
        }
        edges.push(edge);
    }
    Placed {
        edges,
        vertices,
        failed,
    }
}

/// How far a chain reaches from its start.
fn extent(net: &Net, chain: &Chain) -> f64 {
    let start = net.place(chain.vertices[0]);
    chain
        .vertices
        .iter()
        .map(|v| (net.place(*v) - start).norm())
        .fold(0.0, f64::max)
}

/// A few vertices of a chain, without its ends unless it has no others.
fn some(chain: &Chain, count: usize) -> Vec<u32> {
    let inner = &chain.vertices[1..chain.vertices.len() - 1];
    let from = if inner.is_empty() { &chain.vertices[..] } else { inner };
    let step = from.len().div_ceil(count).max(1);
    from.iter().step_by(step).copied().collect()
}

fn labels_of(groups: &Groups, chain: &Chain) -> [u32; 2] {
    chain.faces.map(|face| groups.label[face as usize])
}

fn bits(ends: [Vector3<f64>; 2]) -> Bits {
    ends.map(|end| [end.x, end.y, end.z].map(f64::to_bits))
}

fn between<'a>(
    net: &Net,
    groups: &Groups,
    labels: &'a Labels,
    chain: &Chain,
    scale: &SolidOptions,
    known: &mut Known,
) -> Between<'a> {
    let [a, b] = labels_of(groups, chain);
    if a == FREE || b == FREE {
        return Between::Free;
    }
    let surface = |label: u32| &labels.all[label as usize].surface;
    if let Some(plane) = labels.divider(a, b) {
        return Between::Surfaces([surface(a), plane], false);
    }
    let pair = [surface(a), surface(b)];
    let touch = || {
        let looked_at = some(chain, 9);
        let touching = looked_at
            .iter()
            .filter(|vertex| touches(net.place(**vertex), pair, scale));
        2 * touching.count() > looked_at.len()
    };
    let key = (chain.vertices.clone(), [a, b]);
    Between::Surfaces(pair, *known.touch.entry(key).or_insert_with(touch))
}

/// Whether two surfaces have one tangent plane near a point, up to the tolerance.
fn touches(p: Vector3<f64>, [a, b]: [&Surface; 2], scale: &SolidOptions) -> bool {
    let conditions = [Condition::On(a), Condition::On(b), Condition::Touch(a, b)];
    let crossing = meet(p, &conditions[..2], scale.cell).filter(|(_, off)| *off <= 0.1 * scale.tolerance);
    if crossing
        .and_then(|(q, _)| sine(a, b, q))
        .is_some_and(|sine| sine > CROSSING)
    {
        return false;
    }
    meet(p, &conditions, scale.cell).is_some_and(|(q, off)| {
        let parallel = sine(a, b, q).is_some_and(|sine| sine < 1e-3);
        parallel && off <= scale.tolerance && (q - p).norm() <= FAR * scale.cell
    })
}

/// The conditions of a corner.
#[derive(Default)]
struct Corner<'a> {
    labels: Vec<u32>,
    conditions: Vec<Condition<'a>>,
    place: Vector3<f64>,
    found: bool,
}

/// The places of all corners by their vertices of the mesh, and those for which none was found.
fn nodes(
    net: &Net,
    groups: &Groups,
    labels: &Labels,
    chains: &Chains,
    between: &[Between],
    scale: &SolidOptions,
) -> (BTreeMap<u32, Vector3<f64>>, Vec<u32>) {
    let mut corners: BTreeMap<u32, Corner> = BTreeMap::new();
    for (chain, between) in chains.all.iter().zip(between) {
        for vertex in chain.ends() {
            let corner = corners.entry(vertex).or_default();
            for face in chain.faces {
                let label = groups.label[face as usize];
                if label != FREE && !corner.labels.contains(&label) {
                    corner.labels.push(label);
                    corner
                        .conditions
                        .push(Condition::On(&labels.all[label as usize].surface));
                }
            }
            if let Between::Surfaces([a, b], touch) = *between {
                if touch {
                    corner.conditions.push(Condition::Touch(a, b));
                }
                corner.conditions.push(Condition::On(b));
            }
        }
    }
    let near = |p: Vector3<f64>, vertex: u32| (p - net.place(vertex)).norm() <= FAR * scale.cell;
    for (vertex, corner) in &mut corners {
        let start = net.place(*vertex);
        let tip = chains.tips.binary_search_by_key(vertex, |(vertex, _)| *vertex);
        let found = match tip {
            Ok(tip) => Some(chains.tips[tip].1),
            Err(_) => meet(start, &corner.conditions, scale.cell)
                .filter(|(p, off)| *off <= scale.tolerance && near(*p, *vertex))
                .map(|(p, _)| p),
        };
        (corner.place, corner.found) = (found.unwrap_or(start), found.is_some());
    }
    // Where four faces or more meet in a point, the mesh may have two corners with a short chain between them.
    for (chain, between) in chains.all.iter().zip(between) {
        let [a, b] = chain.ends();
        let short = a != b && matches!(between, Between::Surfaces(..)) && extent(net, chain) < SHORT * scale.cell;
        let (Some(one), Some(two)) = (corners.get(&a).filter(|_| short), corners.get(&b)) else {
            continue;
        };
        let all = one
            .labels
            .iter()
            .chain(two.labels.iter().filter(|label| !one.labels.contains(label)));
        if all.count() == one.labels.len().max(two.labels.len()) {
            continue;
        }
        let conditions: Vec<Condition> = one.conditions.iter().chain(&two.conditions).copied().collect();
        let start = (net.place(a) + net.place(b)) * 0.5;
        let found = meet(start, &conditions, scale.cell)
            .filter(|(p, off)| *off <= scale.tolerance && near(*p, a) && near(*p, b));
        if let Some((place, _)) = found {
            for vertex in [a, b] {
                if let Some(corner) = corners.get_mut(&vertex) {
                    (corner.place, corner.found) = (place, true);
                }
            }
        }
    }
    let failed = corners
        .iter()
        .filter(|(_, corner)| !corner.found)
        .map(|(vertex, _)| *vertex);
    let failed = failed.collect();
    (
        corners
            .into_iter()
            .map(|(vertex, corner)| (vertex, corner.place))
            .collect(),
        failed,
    )
}

/// Makes one vertex of those that fell together at the ends of a short chain.
fn collapse(
    net: &Net,
    groups: &Groups,
    chains: &Chains,
    numbers: &mut BTreeMap<u32, u32>,
    vertices: &mut [Vector3<f64>],
    scale: &SolidOptions,
) {
    let mut root: Vec<u32> = (0..vertices.len() as u32).collect();
    let find = |root: &[u32], mut vertex: u32| {
        while root[vertex as usize] != vertex {
            vertex = root[vertex as usize];
        }
        vertex
    };
    // Vertices on surfaces stay where they are.
    let mut held = vec![false; vertices.len()];
    for chain in &chains.all {
        let on = chain.faces.iter().any(|face| !groups.is_free(*face as usize));
        for vertex in chain.ends() {
            held[numbers[&vertex] as usize] |= on;
        }
    }
    for chain in &chains.all {
        let [a, b] = chain.ends().map(|vertex| find(&root, numbers[&vertex]));
        let apart = (vertices[a as usize] - vertices[b as usize]).norm();
        let free = chain.faces.iter().any(|face| groups.is_free(*face as usize));
        let least = if free {
            (LEAST * scale.cell).max(4.0 * scale.tolerance)
        } else {
            4.0 * scale.tolerance
        };
        if a != b && apart <= least && extent(net, chain) < SPAN * scale.cell {
            let (kept, gone) = match [held[a as usize], held[b as usize]] {
                [true, false] => (a, b),
                [false, true] => (b, a),
                _ => (a.min(b), a.max(b)),
            };
            root[gone as usize] = kept;
        }
    }
    for number in numbers.values_mut() {
        *number = find(&root, *number);
    }
}

/// An edge to be, with points on its way.
fn course<'a>(
    net: &Net,
    chain: &Chain,
    surfaces: [&'a Surface; 2],
    touch: bool,
    vertices: [u32; 2],
    ends: [Vector3<f64>; 2],
    scale: &SolidOptions,
) -> Course<'a> {
    let [a, b] = surfaces;
    let mut conditions = vec![Condition::On(a), Condition::On(b)];
    if touch {
        conditions.push(Condition::Touch(a, b));
    }
    let guide = |vertex: u32| {
        let start = net.place(vertex);
        let (p, off) = meet(start, &conditions, scale.cell)?;
        (off <= scale.tolerance && (p - start).norm() <= FAR * scale.cell).then_some(p)
    };
    let inner = if chain.vertices.len() > 2 {
        some(chain, GUIDES)
    } else {
        Vec::new()
    };
    let length = chain
        .vertices
        .windows(2)
        .map(|pair| (net.place(pair[1]) - net.place(pair[0])).norm());
    // An end that three surfaces only nearly have in common is as near to the edge as to them.
    let missed = ends.iter().flat_map(|p| [a.off(*p), b.off(*p)]).fold(0.0, f64::max);
    Course {
        surfaces,
        touch,
        vertices,
        ends,
        guides: inner.into_iter().filter_map(guide).collect(),
        length: length.sum(),
        cell: scale.cell,
        tolerance: (0.1 * scale.tolerance + missed).max(if touch { scale.tolerance } else { 0.0 }),
    }
}
