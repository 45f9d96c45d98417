//! Boundaries of a face that go around its surface.

use kentron::geometry::curve2::Curve2;
use kentron::geometry::surface::Surface;
use kentron::geometry::{ParametricCurve, ParametricSurface};
use kentron::math::{Transform2, Transformable2, Vector2};
use kentron::tolerance::LINEAR;
use kentron::topology::{EdgeId, Model, Orientation, Shape, WireId};

/// Where a seam may be, as shares of a period.
const PLACES: usize = 64;
/// Parameters that differ by less, as a share of the period, are the same.
const SAME: f64 = 1e-9;
/// As many points of a curve are looked at.
const SAMPLES: usize = 32;

/// An edge as a boundary has it.
#[derive(Clone, Debug)]
pub(super) struct Use {
    pub edge: EdgeId,
    /// Whether it is walked along its curve.
    pub forward: bool,
    /// Its curve in the parameters of the surface.
    pub curve: Curve2,
    pub range: [f64; 2],
}

impl Use {
    /// Where it begins and ends.
    pub fn ends(&self) -> [[f64; 2]; 2] {
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

    pub fn moved(mut self, [u, v]: [f64; 2]) -> Self {
        self.curve = self.curve.transformed(&Transform2::translation(Vector2::new(u, v)));
        self
    }
}

/// A face with boundaries that go around it.
pub(super) struct Around {
    pub surface: Surface,
    pub wires: Vec<Shape>,
    pub boundaries: Vec<Vec<Use>>,
    /// The parameter that they go along, its period, and that of the other one.
    pub along: usize,
    pub period: f64,
    pub across: Option<f64>,
    /// Which of the boundaries, and whether forwards.
    pub ways: Vec<(usize, bool)>,
}

impl Around {
    /// `None` if no boundary goes around, or one goes around in both directions.
    pub fn of(model: &Model, face: Shape) -> Option<Self> {
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
    pub fn turned(mut self) -> Self {
        for uses in &mut self.boundaries {
            uses.reverse();
            uses.iter_mut().for_each(|own| own.forward ^= true);
        }
        self.ways.iter_mut().for_each(|way| way.1 ^= true);
        self
    }

    /// How far it is from a place on, less than a period.
    fn ahead(&self, place: f64, to: f64) -> f64 {
        (to - place).rem_euclid(self.period)
    }

    /// A place along the boundaries where a seam meets no hole: where one of them begins, if that can be.
    pub fn place(&self) -> Option<f64> {
        let holes: Vec<[f64; 2]> = self
            .holes()
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
                let ahead = self.ahead(place, *low);
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

    /// The boundaries that do not go around.
    pub fn holes(&self) -> impl Iterator<Item = usize> {
        let goes_around = |number: usize| self.ways.iter().any(|way| way.0 == number);
        (0..self.boundaries.len()).filter(move |number| !goes_around(*number))
    }

    /// A hole within the periods that begin at these parameters, along the boundaries and across.
    pub fn hole(&self, number: usize, least: [f64; 2]) -> Vec<Use> {
        let uses = &self.boundaries[number];
        let at = uses[0].ends()[0];
        let along = least[0] + self.ahead(least[0], at[self.along]) - at[self.along];
        let own = at[1 - self.along];
        let across = self
            .across
            .map_or(0.0, |period| least[1] + (own - least[1]).rem_euclid(period) - own);
        let by = self.both(along, across);
        uses.iter().map(|own| own.clone().moved(by)).collect()
    }

    /// Where a boundary passes a place within one of its edges: the edge, and its parameter.
    pub fn passes(&self, number: usize, place: f64) -> Option<(EdgeId, f64)> {
        let uses = &self.boundaries[number];
        if uses.iter().any(|own| self.is_at(own.ends()[0][self.along], place)) {
            return None;
        }
        uses.iter().find_map(|own| {
            let beside = |t: f64| {
                let ahead = self.ahead(place, own.at(t)[self.along]);
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
        let ahead = self.ahead(place, at);
        ahead.min(self.period - ahead) < SAME * self.period
    }

    /// A boundary from where it passes a place on, which has this number along it.
    pub fn opened(&self, number: usize, place: f64, begin: f64) -> Option<Vec<Use>> {
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
    pub fn both(&self, along: f64, across: f64) -> [f64; 2] {
        if self.along == 0 {
            [along, across]
        } else {
            [across, along]
        }
    }

    /// Where all of the surface is one point: the other parameter there.
    pub fn poles(&self) -> Vec<f64> {
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
