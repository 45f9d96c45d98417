//! What the blocks of a free contour say, and the lines and circles that this determines.

use std::f64::consts::TAU;

use super::carrier::{Carrier, Flat, SAME, Support, along, distance, dot, heading, left, minus, unit};

/// A number that may count from a place of the contour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Value {
    pub value: f64,
    /// From the end of the element before, or of that of another block.
    pub relative: bool,
    pub block: Option<u32>,
}

/// What a block says of its element; lengths in mm, angles in radians.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Element {
    /// The number of the block in its program, if it has one.
    pub number: Option<u32>,
    pub line: usize,
    pub is_arc: bool,
    pub tangential: bool,
    /// X and Y of its end.
    pub end: [Option<Value>; 2],
    /// PR and PA of its end.
    pub polar: [Option<Value>; 2],
    /// AN: of a line, or where an arc begins.
    pub angle: Option<Value>,
    /// LEN: of a line, or of the chord of an arc.
    pub length: Option<f64>,
    pub radius: Option<f64>,
    pub counter_clockwise: Option<bool>,
    /// CCX and CCY, CCPR and CCPA.
    pub centre: [Option<Value>; 2],
    pub polar_centre: [Option<f64>; 2],
    /// CCA.
    pub swept: Option<f64>,
    /// Points on it, or at a distance of it.
    pub near: Vec<(Flat, f64)>,
    /// PAR: the block whose line it is parallel to, and DP: at which distance.
    pub parallel: Option<u32>,
    pub apart: Option<f64>,
    /// The pole of FPOL.
    pub pole: Option<Flat>,
    /// CLSD: where a closed contour begins (true), or ends.
    pub closed: Option<bool>,
}

impl Element {
    /// Whether it has polar coordinates about the pole of FPOL.
    pub fn needs_pole(&self) -> bool {
        let counted = self.polar.iter().flatten().any(|value| value.block.is_some());
        self.polar_centre.iter().any(Option::is_some) || !counted && self.polar.iter().any(Option::is_some)
    }
}

/// An element whose ends are known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Solved {
    pub(super) carrier: Carrier,
    pub(super) start: Flat,
    pub end: Flat,
}

impl Solved {
    /// The centre and whether it is counter-clockwise, if it is an arc.
    pub fn arc(&self) -> Option<(Flat, bool)> {
        match self.carrier {
            Carrier::Line { .. } => None,
            Carrier::Circle { centre, radius } => Some((centre, radius > 0.0)),
        }
    }

    /// The way in which it begins.
    pub fn first_direction(&self) -> Flat {
        self.carrier.direction(self.start)
    }

    pub(super) fn length(&self) -> f64 {
        self.carrier.length(self.start, self.end)
    }
}

/// Where the contour has come to before an element.
#[derive(Clone, Copy, Debug)]
pub(super) enum Before {
    /// To a point, going in a direction if that is known.
    At(Flat, Option<Flat>),
    /// On a carrier, from a point on: where it leaves that is open.
    On(Carrier, Flat),
    /// Not known.
    Unknown,
}

/// The same with its numbers as they are in a branch of the search.
pub(super) struct Given<'a> {
    element: &'a Element,
    end: Vec<Carrier>,
    centre: Vec<Carrier>,
    angle: Option<f64>,
    parallel: Option<(Flat, Flat)>,
}

const X: Flat = [1.0, 0.0];
const Y: Flat = [0.0, 1.0];

impl<'a> Given<'a> {
    /// What counts from a place that is not known is left out. `of` gives the element of a block.
    pub fn new(element: &'a Element, before: &Before, of: impl Fn(u32) -> Option<Solved>) -> Self {
        let base = |value: &Value| match (value.block, value.relative, before) {
            (Some(number), ..) => of(number).map(|one| one.end),
            (None, true, Before::At(at, _)) => Some(*at),
            (None, true, _) => None,
            (None, false, _) => Some([0.0; 2]),
        };
        let axes = |values: &[Option<Value>; 2]| {
            let known = |(k, value): (usize, &Option<Value>)| {
                let mut at = [0.0; 2];
                at[k] = base(value.as_ref()?)?[k] + value.as_ref()?.value;
                Some(Carrier::Line { at, way: [Y, X][k] })
            };
            values.iter().enumerate().filter_map(known).collect::<Vec<_>>()
        };
        let mut end = axes(&element.end);
        let pole = match element.polar.iter().flatten().find_map(|value| value.block) {
            Some(number) => of(number).map(|one| one.end),
            None => element.pole,
        };
        let [radius, angle] = element.polar.map(|value| value.map(|value| value.value));
        end.extend(pole.into_iter().flat_map(|pole| polar(pole, radius, angle)));
        let mut centre = axes(&element.centre);
        let [radius, angle] = element.polar_centre;
        centre.extend(element.pole.into_iter().flat_map(|pole| polar(pole, radius, angle)));
        let angle = element.angle.and_then(|angle| {
            let from = match (angle.block, angle.relative, before) {
                (Some(number), ..) => of(number).map(|one| one.carrier.direction(one.end)),
                (None, true, Before::At(_, way)) => *way,
                (None, true, _) => None,
                (None, false, _) => Some(X),
            };
            from.map(|[x, y]| angle.value + y.atan2(x))
        });
        let parallel = element.parallel.and_then(of);
        let parallel = parallel.map(|one| (one.end, one.carrier.direction(one.end)));
        Self {
            element,
            end,
            centre,
            angle,
            parallel,
        }
    }

    /// Its ends on its carrier, from where it begins; `None` if it does not say.
    pub fn ends(&self, carrier: &Carrier, start: Flat) -> Option<Vec<Flat>> {
        let mut loci = self.end.clone();
        loci.extend(
            self.element
                .length
                .map(|radius| Carrier::Circle { centre: start, radius }),
        );
        if let (Some(swept), Carrier::Circle { centre, radius }) = (self.element.swept, *carrier) {
            let (sin, cos) = (swept.abs() * radius.signum()).sin_cos();
            let out = minus(start, centre);
            let end = along(along(centre, cos, out), sin, left(out));
            return Some(vec![end]);
        }
        let (first, others) = loci.split_first()?;
        let fits = |point: &Flat| {
            loci.iter().chain([carrier]).all(|locus| locus.off(*point) < SAME) && carrier.is_ahead(start, *point)
        };
        // Where the carrier lies along a locus or touches it, another one tells the place; where it touches both, they do.
        let second = others.first();
        let by_second = || second.map(|second| carrier.meets(second)).unwrap_or_default();
        let by_both = || second.map(|second| first.meets(second)).unwrap_or_default();
        let ways: [&dyn Fn() -> Vec<Flat>; 3] = [&|| carrier.meets(first), &by_second, &by_both];
        let found = ways.iter().map(|way| Vec::from_iter(way().into_iter().filter(fits)));
        Some(found.into_iter().find(|found| !found.is_empty()).unwrap_or_default())
    }

    /// Whether a carrier agrees with what is said of it, where it begins at a point.
    pub fn agrees(&self, carrier: &Carrier, start: Flat) -> bool {
        let towards = self.angle.map(heading);
        let on = |(point, apart): &(Flat, f64)| (carrier.off(*point) - apart).abs() < SAME;
        towards.is_none_or(|way| distance(carrier.direction(start), way) < SAME) && self.element.near.iter().all(on)
    }

    /// The carriers that are possible; `None` if they are not determined. `next`: what the element goes over to
    /// tangentially.
    pub fn carriers(&self, before: &Before, next: Option<&Carrier>) -> Option<Vec<Carrier>> {
        if self.element.is_arc {
            self.circles(before, next)
        } else {
            self.lines(before, next)
        }
    }

    /// The end, where it is known by itself.
    fn end_points(&self) -> Vec<Flat> {
        match &self.end[..] {
            [first, second, ..] => first.meets(second),
            _ => Vec::new(),
        }
    }

    fn lines(&self, before: &Before, next: Option<&Carrier>) -> Option<Vec<Carrier>> {
        let tangential = self.element.tangential;
        if let (Before::At(at, Some(way)), true) = (before, tangential) {
            return Some(vec![Support(*at, 0.0).line(*way)]);
        }
        // What each of the supports may be.
        let mut supports: Vec<Vec<Support>> = Vec::new();
        match before {
            Before::At(at, _) => supports.push(vec![Support(*at, 0.0)]),
            Before::On(carrier, _) if tangential => supports.extend(Support::of(carrier).map(|one| vec![one])),
            _ => {}
        }
        let ends = self.end_points();
        if !ends.is_empty() {
            supports.push(ends.into_iter().map(|end| Support(end, 0.0)).collect());
        }
        let both = |point: Flat, apart: f64| match apart {
            0.0 => vec![Support(point, 0.0)],
            apart => vec![Support(point, apart), Support(point, -apart)],
        };
        supports.extend(self.element.near.iter().map(|&(point, apart)| both(point, apart)));
        if let (Some((point, _)), Some(apart)) = (self.parallel, self.element.apart) {
            supports.push(both(point, apart));
        }
        supports.extend(next.and_then(Support::of).map(|one| vec![one]));
        let ways: Vec<Flat> = match (self.angle, self.parallel) {
            (Some(angle), _) => vec![heading(angle)],
            (None, Some((_, way))) => vec![way, way.map(|c| -c)],
            (None, None) => Vec::new(),
        };
        let first = supports.first()?;
        if !ways.is_empty() {
            let all = first.iter().flat_map(|one| ways.iter().map(|way| one.line(*way)));
            return Some(all.collect());
        }
        let second = supports.get(1)?;
        let all = first
            .iter()
            .flat_map(|one| second.iter().flat_map(|two| one.lines(*two)));
        Some(all.collect())
    }

    fn circles(&self, before: &Before, next: Option<&Carrier>) -> Option<Vec<Carrier>> {
        let signs: &[f64] = match self.element.counter_clockwise {
            Some(true) => &[1.0],
            Some(false) => &[-1.0],
            None => &[1.0, -1.0],
        };
        let mut all = Vec::new();
        for sign in signs {
            match self.element.radius {
                Some(radius) => all.extend(self.of_radius(before, next, sign * radius)?),
                None => all.extend(self.of_centre(before, next, *sign)?),
            }
        }
        Some(all)
    }

    /// Circles of a radius: by two places of their centre.
    fn of_radius(&self, before: &Before, next: Option<&Carrier>, radius: f64) -> Option<Vec<Carrier>> {
        let mut loci = self.centre.clone();
        let through = |centre: Flat| Carrier::Circle { centre, radius };
        let circle = |centre: Flat| Carrier::Circle { centre, radius };
        let tangent = self.angle.map(heading);
        match (before, self.element.tangential) {
            (Before::At(at, Some(way)), true) => {
                let centre = along(*at, radius, left(*way));
                return Some(vec![circle(centre)]).filter(|_| loci.iter().all(|one| one.off(centre) < SAME));
            }
            (Before::At(at, _), _) => {
                if let Some(way) = tangent {
                    return Some(vec![circle(along(*at, radius, left(way)))]);
                }
                loci.push(through(*at));
            }
            (Before::On(carrier, _), true) => loci.push(carrier.centres(radius)),
            _ => {}
        }
        loci.extend(self.end_points().into_iter().take(1).map(through));
        loci.extend(
            self.element
                .near
                .iter()
                .filter(|(_, apart)| *apart == 0.0)
                .map(|(point, _)| through(*point)),
        );
        loci.extend(next.map(|next| next.centres(radius)));
        let (first, others) = loci.split_first()?;
        let second = others.first()?;
        let mut found = first.meets(second);
        found.retain(|centre| others.iter().all(|locus| locus.off(*centre) < SAME));
        Some(found.into_iter().map(circle).collect())
    }

    /// Circles of which no radius is said.
    fn of_centre(&self, before: &Before, next: Option<&Carrier>, sign: f64) -> Option<Vec<Carrier>> {
        let ends = self.end_points();
        let mut loci = self.centre.clone();
        if let (Before::At(at, Some(way)), true) = (before, self.element.tangential) {
            // The centre is beside where it begins.
            let normal = left(*way);
            let signed = |radius: f64| Carrier::Circle {
                centre: along(*at, radius, normal),
                radius,
            };
            let radii: Vec<f64> = if let Some(locus) = loci.first() {
                let line = Carrier::Line { at: *at, way: normal };
                line.meets(locus)
                    .into_iter()
                    .map(|centre| dot(normal, minus(centre, *at)))
                    .collect()
            } else if !ends.is_empty() {
                let radius = |end: &Flat| {
                    let [x, y] = minus(*end, *at);
                    (x * x + y * y) / (2.0 * dot(normal, [x, y]))
                };
                ends.iter().map(radius).collect()
            } else {
                vec![beside(*at, normal, next?)]
            };
            let good = |radius: &f64| radius.is_finite() && radius * sign > 0.0;
            return Some(radii.into_iter().filter(good).map(signed).collect());
        }
        if let ([_], Before::At(at, _), [end, ..]) = (&loci[..], before, &ends[..]) {
            // Between two points: the centre is on the line between them.
            let middle = along(*at, 0.5, minus(*end, *at));
            let way = left(unit(minus(*end, *at))?);
            loci.push(Carrier::Line { at: middle, way });
        }
        let [first, second, ..] = &loci[..] else { return None };
        let mut all = Vec::new();
        for centre in first.meets(second) {
            let radii: Vec<f64> = match (before, &ends[..]) {
                (Before::At(at, _), _) => vec![distance(*at, centre)],
                (_, [end, ..]) => vec![distance(*end, centre)],
                (Before::On(carrier, _), _) if self.element.tangential => touching(centre, carrier),
                _ => touching(centre, next?),
            };
            let good = radii
                .into_iter()
                .filter(|radius| radius * sign > 0.0 || matches!(before, Before::At(..)));
            all.extend(good.map(|radius| Carrier::Circle {
                centre,
                radius: radius.abs() * sign,
            }));
        }
        Some(all)
    }
}

fn polar(pole: Flat, radius: Option<f64>, angle: Option<f64>) -> Vec<Carrier> {
    match (radius, angle) {
        (Some(radius), Some(angle)) => {
            let at = along(pole, radius, heading(angle));
            [X, Y].map(|way| Carrier::Line { at, way }).to_vec()
        }
        (Some(radius), None) => vec![Carrier::Circle { centre: pole, radius }],
        (None, Some(angle)) => vec![Carrier::Line {
            at: pole,
            way: heading(angle.rem_euclid(TAU)),
        }],
        (None, None) => Vec::new(),
    }
}

/// The signed radii of circles about a centre that touch a carrier, and go on in its direction.
fn touching(centre: Flat, carrier: &Carrier) -> Vec<f64> {
    match *carrier {
        Carrier::Line { at, way } => vec![dot(left(way), minus(centre, at))],
        Carrier::Circle { centre: other, radius } => {
            let apart = distance(centre, other);
            vec![radius - apart, radius + apart]
        }
    }
}

/// The signed radius of the circle that begins at a point beside its centre, and touches a carrier.
fn beside(at: Flat, normal: Flat, next: &Carrier) -> f64 {
    match *next {
        Carrier::Line { at: point, way } => dot(left(way), minus(at, point)) / (1.0 - dot(left(way), normal)),
        Carrier::Circle { centre, radius } => {
            let [x, y] = minus(at, centre);
            (radius * radius - x * x - y * y) / (2.0 * (dot(normal, [x, y]) + radius))
        }
    }
}
