//! Faces with their loops, checked in the parameters of their surfaces.

mod check;
mod shells;

pub(crate) use shells::shells;

use crate::chart::{Chart, across};
use crate::edges::{Chains, Edge, Placed};
use crate::label::{FREE, Groups, Labels};
use crate::net::Net;
use crate::solid::Face;
use crate::surface::Surface;
use nalgebra::Vector3;
use sweepsim_dexel::AnalyticSurface as A;

/// The faces of a solid, and the triangles of those that could not be made.
pub(crate) struct Faces {
    pub all: Vec<Face>,
    /// Of each group of triangles its face: none if it fell together.
    pub of_group: Vec<Option<u32>>,
    pub failed: Vec<u32>,
}

/// An edge of a loop, and whether it is passed from its start to its end.
pub(crate) type Use = (u32, bool);

/// Makes the faces of all groups.
pub(crate) fn faces(
    net: &Net,
    groups: &Groups,
    labels: &Labels,
    chains: &Chains,
    placed: &Placed,
    tolerance: f64,
) -> Faces {
    let mut faces = Faces {
        all: Vec::new(),
        of_group: vec![None; groups.count()],
        failed: Vec::new(),
    };
    let mut loops: Vec<Vec<Vec<Use>>> = Vec::with_capacity(groups.count());
    for group in 0..groups.count() {
        let own = chains.loops(net, groups, group).into_iter().map(|own| {
            let kept = own.into_iter().filter(|(chain, _)| placed.edges[*chain as usize].is_some());
            kept.collect::<Vec<Use>>()
        });
        loops.push(own.filter(|own| !own.is_empty()).collect());
    }
    let instead = flattened(&loops, placed, 4.0 * tolerance);
    for group in 0..groups.count() {
        let own: Vec<Vec<Use>> = loops[group].iter().map(|own| replaced(own, &instead)).collect();
        if own.is_empty() || own.iter().all(|own| is_flat(own)) {
            continue;
        }
        let own: Vec<Vec<Use>> = own.into_iter().filter(|own| !is_flat(own)).collect();
        let face = if groups.is_free(group) {
            facet(net, groups.triangles(group)[0] as usize, own, placed)
        } else {
            curved(labels, groups.label[group], own, placed)
        };
        match face {
            Some(face) => {
                faces.of_group[group] = Some(faces.all.len() as u32);
                faces.all.push(face);
            }
            None => faces.failed.extend(groups.triangles(group)),
        }
    }
    faces
}

/// Whether a loop goes along one edge and back.
fn is_flat(own: &[Use]) -> bool {
    matches!(own, [(a, x), (b, y)] if a == b && x != y)
}

fn replaced(own: &[Use], instead: &[Use]) -> Vec<Use> {
    let other = |(edge, forward): &Use| {
        let (mut edge, mut forward) = (*edge, *forward);
        while instead[edge as usize].0 != edge {
            let (next, same) = instead[edge as usize];
            (edge, forward) = (next, forward == same);
        }
        (edge, forward)
    };
    own.iter().map(other).collect()
}

/// For each edge the one that takes its place: itself, or the other edge of a face that has no width.
fn flattened(loops: &[Vec<Vec<Use>>], placed: &Placed, width: f64) -> Vec<Use> {
    let mut instead: Vec<Use> = (0..placed.edges.len() as u32).map(|edge| (edge, true)).collect();
    for own in loops {
        let [only] = &own[..] else { continue };
        let only = replaced(only, &instead);
        let [(a, forward), (b, backward)] = only[..] else { continue };
        let (Some(one), Some(two)) = (&placed.edges[a as usize], &placed.edges[b as usize]) else {
            continue;
        };
        if a == b || one.vertices[0] == one.vertices[1] {
            continue;
        }
        // Both from the same vertex to the same.
        let same = forward != backward;
        let near = (1..8).all(|k| {
            let part = f64::from(k) / 8.0;
            distance(one.at(part), two, 64) <= width
        });
        let meet = if same { one.vertices == two.vertices } else { one.vertices[0] == two.vertices[1] };
        if near && meet {
            let (kept, gone) = (a.min(b), a.max(b));
            instead[gone as usize] = (kept, same);
        }
    }
    instead
}

/// The distance of a point from an edge, by its chords.
fn distance(p: Vector3<f64>, edge: &Edge, parts: usize) -> f64 {
    let mut least = f64::INFINITY;
    let mut from = edge.at(0.0);
    for k in 1..=parts {
        let to = edge.at(k as f64 / parts as f64);
        let way = to - from;
        let t = (way.dot(&(p - from)) / way.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        least = least.min((p - from - way * t).norm());
        from = to;
    }
    least
}

/// The plane of a triangle without a surface.
fn facet(net: &Net, triangle: usize, loops: Vec<Vec<Use>>, placed: &Placed) -> Option<Face> {
    let corners: Vec<Vector3<f64>> = loops.first()?.iter().filter_map(|used| start(used, placed)).collect();
    let [a, b, c] = corners[..] else { return None };
    let normal = (b - a).cross(&(c - a));
    let longest = (b - a).norm().max((c - a).norm()).max((c - b).norm());
    let own = net.area(triangle);
    let moved = (0..3).any(|k| net.place(net.mesh.triangles[triangle][k]) != corners[k]);
    // Flat, or turned over by what moved its corners. The mesh has triangles without area, too.
    let flat = 1e-6 * longest * longest;
    if moved && (normal.norm() <= flat || own.norm() > flat && normal.dot(&own) <= 0.0) {
        return None;
    }
    let normal = normal.try_normalize(flat).unwrap_or_else(|| across((b - a).try_normalize(0.0).unwrap_or(own)));
    let surface = Surface::Analytic(A::Plane {
        origin: a.into(),
        normal: normal.into(),
    });
    Some(Face {
        surface,
        outward: true,
        axes: [(b - a).normalize(), normal.cross(&(b - a)).normalize(), normal],
        loops,
        is_facet: true,
        range: [[0.0; 2]; 2],
    })
}

/// Where an edge begins in a loop.
pub(crate) fn start((edge, forward): &Use, placed: &Placed) -> Option<Vector3<f64>> {
    let edge = placed.edges[*edge as usize].as_ref()?;
    Some(edge.ends[usize::from(!forward)])
}

fn curved(labels: &Labels, label: u32, loops: Vec<Vec<Use>>, placed: &Placed) -> Option<Face> {
    debug_assert!(label != FREE);
    let label = &labels.all[label as usize];
    let chart = Chart::new(label);
    let (order, range) = check::outer_first(&chart, label.outward, &loops, placed)?;
    let turned = if chart.periodic()[0] {
        chart.turned_to(0.5 * (range[0][0] + range[0][1]))
    } else {
        chart
    };
    Some(Face {
        surface: label.surface,
        outward: label.outward,
        axes: turned.axes,
        loops: order.into_iter().map(|k| loops[k].clone()).collect(),
        is_facet: false,
        range,
    })
}
