//! Areas within contours, and ways along them: a control says in its own words what the contours are, and the moves are made here.
//!
//! An area is left out by the tool's radius: the tool goes straight down, along parallel lines, and along the contours last. Its middle is where no edge is nearer than the radius. That is found
//! on lines: the points of a line that are too near to an edge are an interval, since those about a straight edge are convex. Arcs become chords.

use super::holes::HolePlace;
use super::pockets::{Pocket, WIDEST_STEP};
use crate::drive::circular_arc::radius_slack;
use crate::drive::contour::Stroke;
use crate::drive::track::Track;
use crate::text::error::NcProblem;

/// The most chords of all contours, and the most lines of an area.
const MOST: usize = 20_000;
/// The most lines times edges that are compared.
const MOST_PAIRS: usize = 50_000_000;
/// How far chords are from their arcs, at most, in mm.
const CHORDS: f64 = 1e-3;
/// By how much the tool may be nearer to an edge than its radius along the contour itself, in mm: its own edge is as near as that.
const TOUCH: f64 = 1e-6;
/// The least turn of a chord around a corner.
const LEAST_TURN: f64 = 0.02;

type Flat = [f64; 2];

/// The points of a contour in its plane, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Course {
    pub points: Vec<Flat>,
    /// The side of the tool (`RL`, `RR`), if the contour says it.
    pub left: Option<bool>,
}

impl Course {
    /// That of programmed moves, whose first one leads to its start.
    pub fn of(strokes: &[([f64; 3], Stroke)], plane: [usize; 3], left: Option<bool>) -> Result<Self, NcProblem> {
        let [u, v, _] = plane;
        let mut points: Vec<Flat> = Vec::new();
        for (index, (from, stroke)) in strokes.iter().enumerate() {
            let end = [stroke.end[u], stroke.end[v]];
            if let (Some(bend), true) = (stroke.bend, index > 0) {
                if stroke.plane != plane {
                    return Err(NcProblem::syntax("a contour with an arc out of its plane"));
                }
                let start = [from[u] - bend.centre[0], from[v] - bend.centre[1]];
                let radius = start[0].hypot(start[1]);
                let turn = 2.0 * (1.0 - (CHORDS / radius).min(1.0)).acos().max(1e-4);
                let parts = (bend.sweep.abs() / turn).ceil().max(1.0);
                let first = start[1].atan2(start[0]);
                for part in 1..parts as usize {
                    let angle = first + bend.sweep * part as f64 / parts;
                    points.push([
                        bend.centre[0] + radius * angle.cos(),
                        bend.centre[1] + radius * angle.sin(),
                    ]);
                }
            }
            points.push(end);
            if points.len() > MOST {
                return Err(NcProblem::value(
                    "the chords of a contour",
                    points.len(),
                    format!("at most {MOST}"),
                ));
            }
        }
        points.dedup_by(|a, b| distance(*a, *b) <= TOUCH);
        if points.len() < 2 {
            return Err(NcProblem::syntax("a contour without moves in its plane"));
        }
        Ok(Self { points, left })
    }

    pub fn is_closed(&self) -> bool {
        let [first, .., last] = &self.points[..] else {
            return false;
        };
        distance(*first, *last) <= radius_slack(1.0)
    }

    /// Whether the tool is within it: left of a counter-clockwise contour, or right of a clockwise one.
    pub fn is_pocket(&self) -> bool {
        self.left.is_none_or(|left| left == (self.area() > 0.0))
    }

    fn edges(&self) -> impl Iterator<Item = [Flat; 2]> {
        self.points.windows(2).map(|pair| [pair[0], pair[1]])
    }

    /// Twice its area; positive counter-clockwise.
    fn area(&self) -> f64 {
        self.edges().map(|[a, b]| a[0] * b[1] - a[1] * b[0]).sum()
    }

    fn holds(&self, [x, y]: Flat) -> bool {
        let crosses =
            |[a, b]: [Flat; 2]| (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
        self.edges().filter(|edge| crosses(*edge)).count() % 2 == 1
    }
}

/// What is made of contours.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Work {
    /// The area within the first ones but not within the others; with `rim` along its edges, with `inside` between them.
    Area {
        pockets: Vec<Course>,
        islands: Vec<Course>,
        inside: bool,
        rim: bool,
    },
    /// Along a contour, beside it by the tool's radius on this side (left), or on it.
    Along(Course, Option<bool>),
}

/// A cycle on contours: what is made, with the levels, feeds, tool and allowances of a pocket.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ContourCycle {
    pub work: Work,
    pub pocket: Pocket,
}

fn distance(a: Flat, b: Flat) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn along([a, b]: [Flat; 2], s: f64) -> Flat {
    [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])]
}

/// The parts of the line from `a` to `b`, in proportion, that are at least `off` from all edges.
fn free(line: [Flat; 2], edges: &[[Flat; 2]], off: f64) -> Vec<[f64; 2]> {
    let mut taken: Vec<[f64; 2]> = edges.iter().filter_map(|edge| near(line, *edge, off)).collect();
    taken.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut parts = Vec::new();
    let mut at = 0.0;
    for [from, to] in taken {
        if from > at {
            parts.push([at, from.min(1.0)]);
        }
        at = at.max(to);
        if at >= 1.0 {
            return parts;
        }
    }
    parts.push([at, 1.0]);
    parts
}

/// The part of a line, in proportion and within 0 to 1, that is nearer than `off` to an edge: one interval, since the points near an edge are convex.
fn near([a, b]: [Flat; 2], [c, d]: [Flat; 2], off: f64) -> Option<[f64; 2]> {
    let way = [b[0] - a[0], b[1] - a[1]];
    let square = way[0] * way[0] + way[1] * way[1];
    let edge = [d[0] - c[0], d[1] - c[1]];
    let long = edge[0].hypot(edge[1]);
    let mut found: Option<[f64; 2]> = None;
    let mut add = |[from, to]: [f64; 2]| {
        let (from, to) = (from.max(0.0), to.min(1.0));
        if from < to {
            found = Some(match found {
                Some([a, b]) => [a.min(from), b.max(to)],
                None => [from, to],
            });
        }
    };
    // The discs about its ends.
    for end in [c, d] {
        let out = [a[0] - end[0], a[1] - end[1]];
        let half = (out[0] * way[0] + out[1] * way[1]) / square;
        let root = half * half - (out[0] * out[0] + out[1] * out[1] - off * off) / square;
        if root > 0.0 {
            add([-half - root.sqrt(), -half + root.sqrt()]);
        }
    }
    // The strip along it: 0 < forward < long, -off < across < off.
    if long > 0.0 {
        let unit = [edge[0] / long, edge[1] / long];
        let out = [a[0] - c[0], a[1] - c[1]];
        let forward = [out[0] * unit[0] + out[1] * unit[1], way[0] * unit[0] + way[1] * unit[1]];
        let across = [unit[0] * out[1] - unit[1] * out[0], unit[0] * way[1] - unit[1] * way[0]];
        let mut within = [0.0_f64, 1.0_f64];
        for ([at, step], [low, high]) in [(forward, [0.0, long]), (across, [-off, off])] {
            if step == 0.0 {
                if !(low < at && at < high) {
                    within = [1.0, 0.0];
                }
                continue;
            }
            let (p, q) = ((low - at) / step, (high - at) / step);
            within = [within[0].max(p.min(q)), within[1].min(p.max(q))];
        }
        add(within);
    }
    found
}

/// Lines beside a course, left of it or right, and around its corners.
fn beside(course: &Course, left: bool, off: f64) -> Vec<[Flat; 2]> {
    let side = if left { 1.0 } else { -1.0 };
    let mut lines = Vec::new();
    let edges: Vec<[Flat; 2]> = course.edges().collect();
    let angle = |[a, b]: &[Flat; 2]| (b[1] - a[1]).atan2(b[0] - a[0]);
    for (index, edge) in edges.iter().enumerate() {
        let direction = angle(edge);
        let out = [-direction.sin() * side * off, direction.cos() * side * off];
        lines.push(edge.map(|point| [point[0] + out[0], point[1] + out[1]]));
        let next = match edges.get(index + 1) {
            Some(next) => next,
            None if course.is_closed() => &edges[0],
            None => continue,
        };
        // Around a corner on the tool's side, outside of the circle about it.
        let turn = (angle(next) - direction).rem_euclid(std::f64::consts::TAU);
        let turn = if turn > std::f64::consts::PI {
            turn - std::f64::consts::TAU
        } else {
            turn
        };
        if turn * side < 0.0 && off > 0.0 {
            let least = 2.0 * (1.0 - (CHORDS / off).min(1.0)).acos().max(LEAST_TURN);
            let parts = (turn.abs() / least).ceil().max(1.0);
            let half = 0.5 * turn / parts;
            let first = direction + side * std::f64::consts::FRAC_PI_2;
            let at = |angle: f64, radius: f64| [edge[1][0] + radius * angle.cos(), edge[1][1] + radius * angle.sin()];
            let mut from = at(first, off);
            for part in 0..parts as usize {
                let to = at(first + turn * (part as f64 + 0.5) / parts, off / half.cos());
                lines.push([from, to]);
                from = to;
            }
            lines.push([from, at(first + turn, off)]);
        }
    }
    lines
}

impl ContourCycle {
    /// The ways of the tool on each level: points that are joined by lines.
    fn ways(&self) -> Result<Vec<Vec<Flat>>, NcProblem> {
        let off = self.pocket.tool + self.pocket.left[0];
        match &self.work {
            Work::Along(course, None) => Ok(vec![course.points.clone()]),
            Work::Along(course, Some(left)) => {
                let edges: Vec<_> = course.edges().collect();
                joined(beside(course, *left, off), &edges, off, |_| true)
            }
            Work::Area {
                pockets,
                islands,
                inside,
                rim,
            } => {
                let all = || pockets.iter().chain(islands);
                let edges: Vec<_> = all().flat_map(Course::edges).collect();
                let within = |point: Flat| {
                    pockets.iter().any(|pocket| pocket.holds(point))
                        && !islands.iter().any(|island| island.holds(point))
                };
                let mut ways = Vec::new();
                if *inside {
                    let step = self.pocket.step.min(WIDEST_STEP * self.pocket.tool);
                    ways.extend(joined(parallels(&edges, off, step)?, &edges, off, within)?);
                }
                if *rim {
                    for (courses, is_pocket) in [(pockets, true), (islands, false)] {
                        for course in courses {
                            let left = (course.area() > 0.0) == is_pocket;
                            ways.extend(joined(beside(course, left, off), &edges, off, within)?);
                        }
                    }
                }
                Ok(ways)
            }
        }
    }
}

/// Parallel lines over the area of some edges, to and fro.
fn parallels(edges: &[[Flat; 2]], off: f64, step: f64) -> Result<Vec<[Flat; 2]>, NcProblem> {
    let bound = |k: usize, pick: fn(f64, f64) -> f64, start: f64| {
        edges.iter().flatten().map(|point| point[k]).fold(start, pick)
    };
    let [x0, y0] = [0, 1].map(|k| bound(k, f64::min, f64::INFINITY) + off);
    let [x1, y1] = [0, 1].map(|k| bound(k, f64::max, f64::NEG_INFINITY) - off);
    if !(x1 - x0 > 0.0 && y1 - y0 >= 0.0 && step > 0.0) {
        return Ok(Vec::new());
    }
    let count = ((y1 - y0) / step).ceil();
    if !(count < MOST as f64) {
        return Err(NcProblem::value(
            "the lines of an area",
            count,
            format!("at most {MOST}"),
        ));
    }
    let line = |k: usize| {
        let y = y0 + (y1 - y0) * k as f64 / count.max(1.0);
        if k.is_multiple_of(2) {
            [[x0, y], [x1, y]]
        } else {
            [[x1, y], [x0, y]]
        }
    };
    Ok((0..=count as usize).map(line).collect())
}

/// The free parts of lines, one after the other where they meet.
fn joined(
    lines: Vec<[Flat; 2]>,
    edges: &[[Flat; 2]],
    off: f64,
    within: impl Fn(Flat) -> bool,
) -> Result<Vec<Vec<Flat>>, NcProblem> {
    let pairs = lines.len().saturating_mul(edges.len());
    if pairs > MOST_PAIRS {
        let name = "the number of lines of an area, times the edges of its contours";
        return Err(NcProblem::value(name, pairs, format!("at most {MOST_PAIRS}")));
    }
    let mut ways: Vec<Vec<Flat>> = Vec::new();
    for line in lines.into_iter().filter(|[a, b]| distance(*a, *b) > 0.0) {
        for [from, to] in free(line, edges, off - TOUCH) {
            let [a, b] = [along(line, from), along(line, to)];
            if distance(a, b) <= TOUCH || !within(along(line, 0.5 * (from + to))) {
                continue;
            }
            match ways.last_mut() {
                Some(way) if way.last().is_some_and(|last| distance(*last, a) <= 10.0 * CHORDS) => way.push(b),
                _ => ways.push(vec![a, b]),
            }
        }
    }
    Ok(ways)
}

impl Track {
    pub(super) fn contours(&mut self, cycle: &ContourCycle, here: HolePlace) -> Result<(), NcProblem> {
        let pocket = &cycle.pocket;
        let (ways, levels) = (cycle.ways()?, pocket.levels()?);
        // Contours are in coordinates of the frame.
        let place = HolePlace {
            origin: [0.0; 3],
            ..here
        };
        let modal = self.feed;
        self.line(here.point([0.0; 2], pocket.start), self.abc, true)?;
        for level in levels {
            for way in &ways {
                let (Some(first), Some(last)) = (way.first(), way.last()) else {
                    continue;
                };
                self.line(place.point(*first, pocket.start), self.abc, true)?;
                self.feed = pocket.plunge.or(pocket.feed).or(modal);
                self.line(place.point(*first, level), self.abc, false)?;
                self.feed = pocket.feed.or(modal);
                for point in &way[1..] {
                    self.line(place.point(*point, level), self.abc, false)?;
                }
                self.line(place.point(*last, pocket.start), self.abc, true)?;
            }
        }
        self.feed = modal;
        self.line(here.point([0.0; 2], pocket.end), self.abc, true)
    }
}
