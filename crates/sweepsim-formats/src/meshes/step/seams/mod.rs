//! Seams of faces that go once around.
//!
//! Some systems, as NX, bound the side of a hole by its two rims, a countersink's tip or a dimple by one. The library
//! wants one boundary that closes in the surface's parameters: from rim to rim, or to the pole, along a seam and back.

mod around;

use std::collections::{BTreeMap, BTreeSet};

use kentron::divide::Cut;
use kentron::geometry::curve2::{Curve2, Line2};
use kentron::geometry::{ParametricCurve, ParametricSurface};
use kentron::io::step::{Exchange, Node, Value};
use kentron::math::{Direction2, Point2};
use kentron::tolerance::LINEAR;
use kentron::topology::{Model, NodeId, NodeKind, Orientation, Shape, VertexId};

use super::styles::numbers;
use around::{Around, Use};

/// Adds the seams that faces lack.
pub(super) fn add(model: &mut Model, roots: &[Node], x: &Exchange) -> kentron::Result<()> {
    let mut seen = BTreeSet::new();
    let mut found = Vec::new();
    let mut left: Vec<&Node> = roots.iter().collect();
    while let Some(node) = left.pop() {
        left.extend(&node.children);
        let numbered = |kind: NodeKind| {
            let own = node.subshapes.iter().filter(move |part| part.shape.kind() == kind);
            let number = |name: &str| name.strip_prefix('#')?.parse().ok();
            own.filter_map(move |part| Some((part.shape.node, number(part.name.as_deref()?)?)))
        };
        let edges: BTreeMap<NodeId, usize> = numbered(NodeKind::Edge).collect();
        for (face, number) in numbered(NodeKind::Face).filter(|(face, _)| seen.insert(*face)) {
            let face = Shape::new(face);
            if let Some(around) = Around::of(model, face) {
                let turned = is_turned(&around.boundaries, &edges, &directions(x, number));
                found.push((face, turned));
            }
        }
    }
    // Seams divide edges, which have no number then.
    for (face, turned) in found {
        if let Some(turned) = turned {
            add_to(model, face, turned)?;
        }
    }
    Ok(())
}

/// Which way the boundaries of a face run along each edge so that the face is to the left of them on its surface, by
/// the number of the edge.
fn directions(x: &Exchange, face: usize) -> BTreeMap<usize, bool> {
    let is_true = |value: Option<&Value>| value.and_then(Value::as_bool).unwrap_or(true);
    let entity = |number: usize, kind: &str| x.get(number).ok().and_then(|instance| instance.record(kind));
    let mut found = BTreeMap::new();
    let Some(own) = entity(face, "ADVANCED_FACE").or_else(|| entity(face, "FACE_SURFACE")) else {
        return found;
    };
    for bound in own
        .get(1)
        .map_or(Vec::new(), |bounds| numbers(x, std::slice::from_ref(bounds)))
    {
        let kinds = ["FACE_OUTER_BOUND", "FACE_BOUND"];
        let Some(bound) = kinds.iter().find_map(|kind| entity(bound, kind)) else {
            continue;
        };
        let edges = bound.get(1).and_then(Value::as_reference);
        for oriented in edges
            .and_then(|number| entity(number, "EDGE_LOOP"))
            .map_or(Vec::new(), |own| numbers(x, own))
        {
            let Some(oriented) = entity(oriented, "ORIENTED_EDGE") else {
                continue;
            };
            let Some(number) = oriented.get(3).and_then(Value::as_reference) else {
                continue;
            };
            let curve = entity(number, "EDGE_CURVE").and_then(|edge| edge.get(4));
            let each = [own.get(3), bound.get(2), oriented.get(4), curve];
            let against = each.into_iter().filter(|along| !is_true(*along)).count();
            found.insert(number, against % 2 == 0);
        }
    }
    found
}

/// Whether boundaries run the other way. `directions`: of edges by their numbers.
fn is_turned(
    boundaries: &[Vec<Use>],
    edges: &BTreeMap<NodeId, usize>,
    directions: &BTreeMap<usize, bool>,
) -> Option<bool> {
    boundaries.iter().flatten().find_map(|own| {
        let along = directions.get(edges.get(&own.edge.into())?)?;
        Some(*along != own.forward)
    })
}

/// Adds a seam to a face whose boundaries go around it, or leaves it as it is. `turned`: they run the wrong way.
fn add_to(model: &mut Model, face: Shape, turned: bool) -> kentron::Result<()> {
    let Some(around) = Around::of(model, face) else {
        return Ok(());
    };
    let (Some(place), mut left) = (around.place(), around.ways.len()) else {
        return Ok(());
    };
    // Boundaries begin where the seam is: each of them is divided once at most.
    while let Some(around) = Around::of(model, face).filter(|_| left > 0) {
        left -= 1;
        let Some((edge, t)) = around.ways.iter().find_map(|way| around.passes(way.0, place)) else {
            break;
        };
        let Some((curve, _, _)) = model.edge_curve(edge) else {
            return Ok(());
        };
        let vertex = model.add_vertex(curve.point(t), LINEAR);
        model.split_edge(edge, vertex, t)?;
    }
    let Some(around) = Around::of(model, face) else {
        return Ok(());
    };
    let around = if turned { around.turned() } else { around };
    let Some(boundaries) = joined(model, &around, place)? else {
        return Ok(());
    };
    for wire in &around.wires {
        model.remove(face, *wire)?;
    }
    for uses in boundaries {
        let mut coedges = Vec::with_capacity(uses.len());
        for own in uses {
            let way = if own.forward {
                Orientation::Forward
            } else {
                Orientation::Reversed
            };
            let coedge = model.add_coedge(own.edge, way)?;
            model.set_pcurve_with_range(coedge, own.curve, own.range[0], own.range[1])?;
            coedges.push(coedge);
        }
        let wire = model.add_wire(&coedges)?;
        model.add(face, wire.into())?;
    }
    for wire in around.wires {
        model.remove_subtree(wire.node);
    }
    Ok(())
}

/// One boundary of those that go around, by a seam, and the holes beside it; `None` if that cannot be.
fn joined(model: &mut Model, around: &Around, place: f64) -> kentron::Result<Option<Vec<Vec<Use>>>> {
    let of_way = |forwards: bool| {
        let mut own = around.ways.iter().filter(|way| way.1 == forwards);
        own.next().map(|way| way.0)
    };
    let (rises, falls) = (of_way(true), of_way(false));
    if around.ways.len() > usize::from(rises.is_some()) + usize::from(falls.is_some()) {
        return Ok(None);
    }
    // The face is to the left of what rises: beyond it where that is along the first parameter, else before it.
    let is_beyond = |from: f64, to: f64| if around.along == 0 { to > from } else { to < from };
    let across = |uses: &[Use]| uses[0].ends()[0][1 - around.along];
    let open = |number: usize, begin: f64| around.opened(number, place, begin);
    let pole_beyond = |from: f64| around.poles().into_iter().find(|to| is_beyond(from, *to));
    let pole_before = |to: f64| around.poles().into_iter().find(|from| is_beyond(*from, to));
    let rising = rises.and_then(|number| open(number, place));
    let falling = falls.and_then(|number| open(number, place + around.period));
    let (rising, falling) = match (rising, falling) {
        (Some(rising), Some(falling)) => {
            let by = around.across.map_or(0.0, |period| {
                let [from, to] = [&rising, &falling].map(|uses| across(uses));
                // Within one period beyond the other.
                let ahead = (to - from).rem_euclid(period);
                from + if around.along == 0 { ahead } else { ahead - period } - to
            });
            let by = around.both(0.0, by);
            (rising, falling.into_iter().map(|own| own.moved(by)).collect())
        }
        (Some(rising), None) => match pole_beyond(across(&rising)) {
            Some(at) => (rising, vec![pole(model, around, [place, at], false)?]),
            None => return Ok(None),
        },
        (None, Some(falling)) => match pole_before(across(&falling)) {
            Some(at) => (vec![pole(model, around, [place, at], true)?], falling),
            None => return Ok(None),
        },
        (None, None) => return Ok(None),
    };
    let [from, to] = [&rising, &falling].map(|uses| across(uses));
    if !is_beyond(from, to) {
        return Ok(None);
    }
    let holes = around
        .holes()
        .map(|number| around.hole(number, [place, from.min(to)]))
        .collect();
    let outer = sewn(model, around, place, [rising, falling])?;
    Ok(Some([vec![outer], holes].concat()))
}

/// A boundary from what rises to what falls along a seam, and back.
fn sewn(model: &mut Model, around: &Around, place: f64, uses: [Vec<Use>; 2]) -> kentron::Result<Vec<Use>> {
    let [from, to] = uses.each_ref().map(|uses| uses[0].ends()[0][1 - around.along]);
    let [begin, end] = uses.each_ref().map(|uses| start(model, &uses[0]));
    let rises = to > from;
    let seam = Cut::iso(&around.surface, around.along == 0, place, from.min(to), from.max(to));
    let ends = if rises { [begin, end] } else { [end, begin] };
    let edge = model.add_edge(ends[0], ends[1], LINEAR)?;
    model.set_edge_curve(edge.into(), seam.curve, LINEAR)?;
    model.set_edge_range(edge.into(), seam.first, seam.last)?;
    let back = Use {
        edge,
        forward: !rises,
        curve: seam.pcurve,
        range: [seam.first, seam.last],
    };
    let mut there = back.clone().moved(around.both(around.period, 0.0));
    there.forward = rises;
    let [mut outer, falling] = uses;
    outer.push(there);
    outer.extend(falling);
    outer.push(back);
    Ok(outer)
}

/// An edge without a length around a pole, from both parameters on.
fn pole(model: &mut Model, around: &Around, [along, across]: [f64; 2], forward: bool) -> kentron::Result<Use> {
    let [u, v] = around.both(along, across);
    let vertex = model.add_vertex(around.surface.point(u, v), LINEAR);
    Ok(Use {
        edge: model.add_edge(vertex, vertex, LINEAR)?,
        forward,
        curve: Curve2::Line(Line2::new(Point2::new(u, v), Direction2::new(1.0, 0.0))),
        range: [0.0, around.period],
    })
}

/// The vertex where an edge begins as a boundary has it.
fn start(model: &Model, own: &Use) -> VertexId {
    let (first, last) = model.edge_vertices(own.edge);
    let vertex = if own.forward { first } else { last };
    VertexId::try_from(vertex.node).expect("edges end at vertices")
}
