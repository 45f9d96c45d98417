//! Seams of faces that go once around.
//!
//! Systems built on Parasolid bound the side of a hole by its two rims, a countersink's tip or a dimple by one. The
//! library wants one boundary that closes in the surface's parameters: from rim to rim, or to the pole, along a seam
//! and back.

use std::collections::{BTreeMap, BTreeSet};

use kentron::divide::Cut;
use kentron::geometry::curve2::{Curve2, Line2};
use kentron::geometry::surface::Surface;
use kentron::geometry::{ParametricCurve, ParametricSurface};
use kentron::io::step::{Exchange, Node, Value};
use kentron::math::{Direction2, Point2, Transform2, Transformable2, Vector2};
use kentron::tolerance::LINEAR;
use kentron::topology::{EdgeId, Model, NodeId, NodeKind, Orientation, Shape, VertexId, WireId};

use super::styles::numbers;

/// Where a seam may be, as shares of a period.
const PLACES: usize = 64;
/// Parameters that differ by less, as a share of the period, are the same.
const SAME: f64 = 1e-9;
/// As many points of a curve are looked at.
const SAMPLES: usize = 32;

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

/// An edge as a boundary has it.
#[derive(Clone, Debug)]
struct Use {
    edge: EdgeId,
    /// Whether it is walked along its curve.
    forward: bool,
    /// Its curve in the parameters of the surface.
    curve: Curve2,
    range: [f64; 2],
}

impl Use {
    /// Where it begins and ends.
    fn ends(&self) -> [[f64; 2]; 2] {
        let [first, last] = self.range.map(|t| self.at(t));
        if self.forward { [first, last] } else { [last, first] }
    }

    fn at(&self, t: f64) -> [f64; 2] {
        let point = self.curve.point(t);
        [point.x, point.y]
    }

    fn samples(&self) -> impl Iterator<Item = f64> {
        let [first, last] = self.range;
        (0..=SAMPLES).map(move |k| first + (last - first) * k as f64 / SAMPLES as f64)
    }

    fn moved(mut self, [u, v]: [f64; 2]) -> Self {
        self.curve = self.curve.transformed(&Transform2::translation(Vector2::new(u, v)));
        self
    }
}

/// A face with boundaries that go around it.
struct Around {
    surface: Surface,
    wires: Vec<Shape>,
    boundaries: Vec<Vec<Use>>,
    /// The parameter that they go along, its period, and that of the other one.
    along: usize,
    period: f64,
    across: Option<f64>,
    /// Which of the boundaries, and whether forwards.
    ways: Vec<(usize, bool)>,
}

impl Around {
    /// `None` if no boundary goes around, or one goes around in both directions.
    fn of(model: &Model, face: Shape) -> Option<Self> {
        let surface = model.surface(face)?.clone();
        let periods = [surface.u_period(), surface.v_period()];
        let wires: Vec<Shape> = model.children_local(face).collect();
        let boundaries: Vec<Vec<Use>> = wires.iter().map(|wire| boundary(model, *wire)).collect::<Option<_>>()?;
        let mut ways = Vec::new();
        for (number, uses) in boundaries.iter().enumerate() {
            for (k, period) in periods.iter().enumerate() {
                let gone: f64 = uses.iter().map(Use::ends).map(|[from, to]| to[k] - from[k]).sum();
                let turns = period.map_or(0.0, |period| (gone / period).round());
                if turns != 0.0 {
                    (turns.abs() == 1.0).then_some(())?;
                    ways.push((k, number, turns > 0.0));
                }
            }
        }
        let along = ways.first()?.0;
        ways.iter().all(|way| way.0 == along).then_some(())?;
        Some(Self {
            surface,
            wires,
            boundaries,
            along,
            period: periods[along]?,
            across: periods[1 - along],
            ways: ways
                .into_iter()
                .map(|(_, number, forwards)| (number, forwards))
                .collect(),
        })
    }

    /// The same with boundaries that run the other way.
    fn turned(mut self) -> Self {
        for uses in &mut self.boundaries {
            uses.reverse();
            uses.iter_mut().for_each(|own| own.forward ^= true);
        }
        self.ways.iter_mut().for_each(|way| way.1 ^= true);
        self
    }

    /// How far it is from a place on, less than a period.
    fn from(&self, place: f64, to: f64) -> f64 {
        (to - place).rem_euclid(self.period)
    }

    /// A place along the boundaries where a seam meets no hole: where one of them begins, if that can be.
    fn place(&self) -> Option<f64> {
        let goes_around = |number: usize| self.ways.iter().any(|way| way.0 == number);
        let holes = (0..self.boundaries.len()).filter(|number| !goes_around(*number));
        let holes: Vec<[f64; 2]> = holes
            .map(|number| {
                let uses = self.boundaries[number].iter();
                let all = uses.flat_map(|own| own.samples().map(|t| own.at(t)[self.along]));
                all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| {
                    [low.min(at), high.max(at)]
                })
            })
            .collect();
        // How far it is to the nearest one.
        let free = |place: f64| {
            let beside = holes.iter().map(|[low, high]| {
                let ahead = self.from(place, *low);
                ahead.min(self.period - (ahead + high - low))
            });
            beside.fold(f64::INFINITY, f64::min)
        };
        let least = 0.25 * self.period / PLACES as f64;
        let own = self.ways.iter().flat_map(|way| &self.boundaries[way.0]);
        let mut own = own.map(|own| own.ends()[0][self.along]);
        own.find(|place| free(*place) > least).or_else(|| {
            let first = self.boundaries[self.ways[0].0][0].ends()[0][self.along];
            let places = (0..PLACES).map(|k| first + self.period * k as f64 / PLACES as f64);
            let best = places.max_by(|a, b| free(*a).total_cmp(&free(*b)))?;
            (free(best) > least).then_some(best)
        })
    }

    /// Where a boundary passes a place within one of its edges: the edge, and its parameter.
    fn passes(&self, number: usize, place: f64) -> Option<(EdgeId, f64)> {
        let uses = &self.boundaries[number];
        if uses.iter().any(|own| self.is_at(own.ends()[0][self.along], place)) {
            return None;
        }
        uses.iter().find_map(|own| {
            let beside = |t: f64| {
                let ahead = self.from(place, own.at(t)[self.along]);
                if ahead < 0.5 * self.period {
                    ahead
                } else {
                    ahead - self.period
                }
            };
            let times: Vec<f64> = own.samples().collect();
            let passing = |ends: &&[f64]| {
                let [a, b] = [beside(ends[0]), beside(ends[1])];
                (a < 0.0) != (b < 0.0) && (a - b).abs() < 0.5 * self.period
            };
            let [mut low, mut high] = times.windows(2).find(passing)?.try_into().ok()?;
            let rises = beside(low) < 0.0;
            for _ in 0..100 {
                let middle = 0.5 * (low + high);
                if (beside(middle) < 0.0) == rises {
                    low = middle
                } else {
                    high = middle
                }
            }
            Some((own.edge, 0.5 * (low + high)))
        })
    }

    fn is_at(&self, at: f64, place: f64) -> bool {
        let ahead = self.from(place, at);
        ahead.min(self.period - ahead) < SAME * self.period
    }

    /// A boundary from where it passes a place on, which has this number along it.
    fn opened(&self, number: usize, place: f64, begin: f64) -> Option<Vec<Use>> {
        let mut uses = self.boundaries[number].clone();
        let first = uses
            .iter()
            .position(|own| self.is_at(own.ends()[0][self.along], place))?;
        uses.rotate_left(first);
        let mut end = begin;
        let mut opened = Vec::with_capacity(uses.len());
        for own in uses {
            let [from, to] = own.ends().map(|at| at[self.along]);
            let turns = ((end - from) / self.period).round();
            end = to + turns * self.period;
            opened.push(own.moved(self.both(turns * self.period, 0.0)));
        }
        Some(opened)
    }

    /// Both parameters, of one along the boundaries and one across.
    fn both(&self, along: f64, across: f64) -> [f64; 2] {
        if self.along == 0 {
            [along, across]
        } else {
            [across, along]
        }
    }

    /// Where all of the surface is one point: the other parameter there.
    fn poles(&self) -> Vec<f64> {
        if self.along != 0 {
            return Vec::new();
        }
        let (_, _, low, high) = self.surface.bounds();
        let apex = match &self.surface {
            Surface::Cone(cone) => -cone.radius() / cone.semi_angle().sin(),
            _ => f64::INFINITY,
        };
        let is_point = |v: &f64| {
            v.is_finite() && {
                let [a, b, c] = [0.0, 0.3, 0.6].map(|share| self.surface.point(share * self.period, *v));
                a.distance(b).max(a.distance(c)) <= LINEAR
            }
        };
        [low, high, apex].into_iter().filter(is_point).collect()
    }
}

/// The edges of a boundary, in order.
fn boundary(model: &Model, wire: Shape) -> Option<Vec<Use>> {
    let number = WireId::try_from(wire.node).ok()?;
    let each = model.get(number)?.coedges.iter().map(|number| {
        let own = model.get(*number)?;
        let (curve, first, last) = model.effective_pcurve(*number)?;
        Some(Use {
            edge: own.edge,
            forward: own.orientation == Orientation::Forward,
            curve,
            range: [first, last],
        })
    });
    let mut uses: Vec<Use> = each.collect::<Option<_>>()?;
    if wire.orientation == Orientation::Reversed {
        uses.reverse();
        uses.iter_mut().for_each(|own| own.forward ^= true);
    }
    Some(uses)
}

/// Adds a seam to a face whose boundaries go around it, or leaves it as it is. `turned`: whether they run the wrong way.
fn add_to(model: &mut Model, face: Shape, turned: bool) -> kentron::Result<()> {
    let Some(place) = Around::of(model, face).and_then(|around| around.place()) else {
        return Ok(());
    };
    // Boundaries begin where the seam is.
    while let Some((edge, t)) = Around::of(model, face).and_then(|around| {
        let mut passed = around.ways.iter().filter_map(|way| around.passes(way.0, place));
        passed.next()
    }) {
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

/// One boundary of those that go around, by a seam, and the holes beside it.
fn joined(model: &mut Model, around: &Around, place: f64) -> kentron::Result<Option<Vec<Vec<Use>>>> {
    let (period, along) = (around.period, around.along);
    let of_way = |forwards: bool| {
        let mut own = around.ways.iter().filter(|way| way.1 == forwards);
        own.next().map(|way| way.0)
    };
    let (rises, falls) = (of_way(true), of_way(false));
    if around.ways.len() > 2 || (around.ways.len() == 2 && (rises.is_none() || falls.is_none())) {
        return Ok(None);
    }
    let open = |number: Option<usize>, begin: f64| number.and_then(|number| around.opened(number, place, begin));
    let (mut rising, mut falling) = (open(rises, place), open(falls, place + period));
    let across = |uses: &Option<Vec<Use>>| uses.as_ref().map(|uses| uses[0].ends()[0][1 - along]);
    // The face is to the left of what rises: beyond it where that is along the first parameter, else before it.
    let upwards = along == 0;
    let [from, to] = [across(&rising), across(&falling)];
    let beyond = |own: f64, other: f64| if upwards { other > own } else { other < own };
    let mut pole = |at: f64, forward: bool| {
        let [u, v] = around.both(place, at);
        let point = around.surface.point(u, v);
        let vertex = model.add_vertex(point, LINEAR);
        let edge = model.add_edge(vertex, vertex, LINEAR)?;
        let curve = Curve2::Line(Line2::new(Point2::new(u, v), Direction2::new(1.0, 0.0)));
        kentron::Result::Ok(Some(vec![Use {
            edge,
            forward,
            curve,
            range: [0.0, period],
        }]))
    };
    let (from, to) = match (from, to) {
        (Some(from), Some(mut to)) => {
            if let Some(period) = around.across {
                let ahead = if upwards {
                    (to - from).rem_euclid(period)
                } else {
                    -(from - to).rem_euclid(period)
                };
                let moved = from + ahead - to;
                let by = around.both(0.0, moved);
                falling = falling.map(|uses| uses.into_iter().map(|own| own.moved(by)).collect());
                to += moved;
            }
            (from, to)
        }
        (Some(from), None) => {
            let Some(to) = around.poles().into_iter().find(|to| beyond(from, *to)) else {
                return Ok(None);
            };
            falling = pole(to, false)?;
            (from, to)
        }
        (None, Some(to)) => {
            let Some(from) = around.poles().into_iter().find(|from| beyond(*from, to)) else {
                return Ok(None);
            };
            rising = pole(from, true)?;
            (from, to)
        }
        (None, None) => return Ok(None),
    };
    let (Some(rising), Some(falling)) = (rising, falling) else {
        return Ok(None);
    };
    if !beyond(from, to) {
        return Ok(None);
    }
    let seam = Cut::iso(&around.surface, along == 0, place, from.min(to), from.max(to));
    let [begin, end] = [&rising, &falling].map(|uses| start(model, &uses[0]));
    let ends = if upwards { [begin, end] } else { [end, begin] };
    let edge = model.add_edge(ends[0], ends[1], LINEAR)?;
    model.set_edge_curve(edge.into(), seam.curve, LINEAR)?;
    model.set_edge_range(edge.into(), seam.first, seam.last)?;
    let own = Use {
        edge,
        forward: !upwards,
        curve: seam.pcurve,
        range: [seam.first, seam.last],
    };
    let mut there = own.clone().moved(around.both(period, 0.0));
    there.forward = upwards;
    let mut outer = rising;
    outer.push(there);
    outer.extend(falling);
    outer.push(own);
    let mut all = vec![outer];
    let between = [from.min(to), from.max(to)];
    for (number, uses) in around.boundaries.iter().enumerate() {
        if around.ways.iter().all(|way| way.0 != number) {
            let at = uses[0].ends()[0];
            let mut by = [0.0; 2];
            by[along] = place + around.from(place, at[along]) - at[along];
            if let Some(period) = around.across {
                by[1 - along] = between[0] + (at[1 - along] - between[0]).rem_euclid(period) - at[1 - along];
            }
            all.push(uses.iter().cloned().map(|own| own.moved(by)).collect());
        }
    }
    Ok(Some(all))
}

/// The vertex where an edge begins as a boundary has it.
fn start(model: &Model, own: &Use) -> VertexId {
    let (first, last) = model.edge_vertices(own.edge);
    let vertex = if own.forward { first } else { last };
    VertexId::try_from(vertex.node).expect("edges end at vertices")
}
