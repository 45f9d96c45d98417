//! Slots that several moves make narrower than the tool: corners compare neighbouring moves only, as controls without a
//! check do.
//!
//! The tool's moves so far are compared with all other moves of the contour, those of the look-ahead before and after. The
//! move that switches compensation on is none of the contour. Nor is an arc that is its first move or its last: on such arcs the
//! tool comes to the contour and leaves it.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use super::corner::{Curve, Flat, cross, dot, length, meetings, minus, plus};
use super::stroke::{ArcPlane, Bend, Stroke, flat};

/// How many moves back and ahead are compared.
const LOOK_AHEAD: usize = 16;
/// Contours of rounded numbers are not that exact, in mm.
const SLACK: f64 = 0.01;

/// A move in the plane.
#[derive(Clone, Copy, Debug)]
struct Element {
    index: usize,
    line: usize,
    start: Flat,
    end: Flat,
    bend: Option<Bend>,
}

/// The last moves of the contour, and of the tool beside it.
#[derive(Clone, Debug, Default)]
pub(super) struct Narrow {
    contour: VecDeque<Element>,
    tool: VecDeque<Element>,
    /// An arc that may be the last move.
    waiting: Option<Element>,
    /// The number of moves of the contour so far.
    count: usize,
    /// One report a contour is enough.
    reported: bool,
}

/// Where the tool does not fit: the lines of two moves, and how far it goes into the contour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TooNarrow {
    pub lines: [usize; 2],
    pub depth: f64,
}

impl Narrow {
    /// The next move of the contour.
    pub fn contour(&mut self, plane: ArcPlane, from: [f64; 3], stroke: &Stroke, radius: f64) -> Option<TooNarrow> {
        let index = self.count;
        self.count += 1;
        let element = Element::new(plane, from, stroke, index);
        if self.reported || index == 0 {
            return None;
        }
        let before = self.waiting.take().and_then(|arc| self.wall(arc, radius));
        let found = match element.bend {
            None => self.wall(element, radius),
            Some(_) => {
                self.waiting = Some(element).filter(|_| index > 1);
                None
            }
        };
        self.report(before.or(found))
    }

    /// A move that is no way to the contour or from it.
    fn wall(&mut self, element: Element, radius: f64) -> Option<TooNarrow> {
        let found = self
            .tool
            .iter()
            .filter(|tool| tool.index < element.index)
            .find_map(|tool| clash(tool, &element, radius));
        keep(&mut self.contour, element);
        found
    }

    /// The next move of the tool.
    pub fn tool(
        &mut self,
        plane: ArcPlane,
        from: [f64; 3],
        stroke: &Stroke,
        ends: bool,
        radius: f64,
    ) -> Option<TooNarrow> {
        // Moves are given out when the next one is known.
        let index = self.count.checked_sub(if ends { 1 } else { 2 })?;
        let element = Element::new(plane, from, stroke, index);
        if self.reported || index == 0 || element.is_point() {
            return None;
        }
        let found = self
            .contour
            .iter()
            .filter(|other| other.index != index)
            .find_map(|other| clash(&element, other, radius));
        keep(&mut self.tool, element);
        self.report(found)
    }

    fn report(&mut self, found: Option<TooNarrow>) -> Option<TooNarrow> {
        self.reported |= found.is_some();
        found
    }
}

fn keep(elements: &mut VecDeque<Element>, element: Element) {
    if elements.len() >= LOOK_AHEAD {
        elements.pop_front();
    }
    elements.push_back(element);
}

/// Whether a move of the tool goes into a move of the contour.
fn clash(tool: &Element, contour: &Element, radius: f64) -> Option<TooNarrow> {
    let reach = radius - SLACK;
    if tool.boxes_apart(contour) >= reach {
        return None;
    }
    let distance = tool.distance(contour);
    (distance < reach).then_some(TooNarrow {
        lines: [tool.line, contour.line],
        depth: radius - distance,
    })
}

impl Element {
    fn new(plane: ArcPlane, from: [f64; 3], stroke: &Stroke, index: usize) -> Self {
        Self {
            index,
            line: stroke.place.line,
            start: flat(plane, from),
            end: flat(plane, stroke.end),
            bend: stroke.bend,
        }
    }

    fn is_point(&self) -> bool {
        self.bend.is_none() && self.start == self.end
    }

    /// A box around it.
    fn bounds(&self) -> [Flat; 2] {
        match self.bend {
            None => {
                let pair = |f: fn(f64, f64) -> f64| [f(self.start[0], self.end[0]), f(self.start[1], self.end[1])];
                [pair(f64::min), pair(f64::max)]
            }
            Some(bend) => {
                let r = length(minus(self.start, bend.centre)).max(length(minus(self.end, bend.centre)));
                [bend.centre.map(|c| c - r), bend.centre.map(|c| c + r)]
            }
        }
    }

    /// How far the boxes are apart, at least.
    fn boxes_apart(&self, other: &Self) -> f64 {
        let ([a, b], [c, d]) = (self.bounds(), other.bounds());
        let gap = |k: usize| (c[k] - b[k]).max(a[k] - d[k]);
        gap(0).max(gap(1))
    }

    fn curve(&self) -> Option<Curve> {
        match self.bend {
            Some(bend) => Some(Curve::Circle {
                centre: bend.centre,
                radius: length(minus(self.end, bend.centre)),
                counter_clockwise: bend.sweep > 0.0,
            }),
            None => {
                let way = minus(self.end, self.start);
                let long = length(way);
                (long > 0.0).then(|| Curve::Line {
                    point: self.start,
                    direction: way.map(|c| c / long),
                })
            }
        }
    }

    /// Whether a point of its curve, or a direction from its centre, is on it.
    fn holds(&self, point: Flat) -> bool {
        match self.bend {
            None => {
                let way = minus(self.end, self.start);
                let along = dot(minus(point, self.start), way);
                (0.0..=dot(way, way)).contains(&along)
            }
            Some(bend) => {
                let (a, b) = (minus(self.start, bend.centre), minus(point, bend.centre));
                let angle = cross(a, b).atan2(dot(a, b)) * bend.sweep.signum();
                angle.rem_euclid(TAU) <= bend.sweep.abs()
            }
        }
    }

    /// The nearest point to a point.
    fn nearest(&self, point: Flat) -> Flat {
        let foot = match (self.bend, self.curve()) {
            (Some(bend), _) => {
                let out = minus(point, bend.centre);
                let (far, radius) = (length(out), length(minus(self.end, bend.centre)));
                (far > 0.0).then(|| plus(bend.centre, radius / far, out))
            }
            (None, Some(Curve::Line { point: on, direction })) => {
                Some(plus(on, dot(minus(point, on), direction), direction))
            }
            _ => None,
        };
        let ends = [self.start, self.end].into_iter();
        let all = foot.filter(|foot| self.holds(*foot)).into_iter().chain(ends);
        let near = |at: &Flat| length(minus(*at, point));
        all.min_by(|a, b| near(a).total_cmp(&near(b))).unwrap_or(self.start)
    }

    /// The distance between two moves.
    fn distance(&self, other: &Self) -> f64 {
        if let (Some(a), Some(b)) = (self.curve(), other.curve())
            && meetings(&a, &b)
                .iter()
                .any(|point| self.holds(*point) && other.holds(*point))
        {
            return 0.0;
        }
        let to = |from: &Self, point: Flat| length(minus(from.nearest(point), point));
        let mut distance = [self.start, self.end]
            .map(|point| to(other, point))
            .into_iter()
            .chain([other.start, other.end].map(|point| to(self, point)))
            .fold(f64::INFINITY, f64::min);
        // Between an arc and another move: along the line from its centre.
        for (arc, beside) in [(self, other), (other, self)] {
            let Some(bend) = arc.bend else { continue };
            let radius = length(minus(arc.end, bend.centre));
            let centre = beside.bend.map_or(bend.centre, |other| other.centre);
            let feet = match beside.bend {
                None => vec![beside.nearest(bend.centre)],
                Some(other) => {
                    let between = minus(centre, bend.centre);
                    let (far, wide) = (length(between), length(minus(beside.end, other.centre)));
                    if far == 0.0 {
                        continue;
                    }
                    [wide, -wide].map(|r| plus(centre, r / far, between)).to_vec()
                }
            };
            for foot in feet.into_iter().filter(|foot| beside.holds(*foot)) {
                let out = minus(foot, bend.centre);
                let far = length(out);
                for side in [1.0, -1.0] {
                    if far > 0.0 && arc.holds(plus(bend.centre, side * radius / far, out)) {
                        distance = distance.min((far - side * radius).abs());
                    }
                }
            }
        }
        distance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn element(start: Flat, end: Flat, bend: Option<Bend>) -> Element {
        Element {
            index: 0,
            line: 1,
            start,
            end,
            bend,
        }
    }

    fn at(element: &Element, s: f64) -> Flat {
        match element.bend {
            None => plus(element.start, s, minus(element.end, element.start)),
            Some(bend) => {
                let [x, y] = minus(element.start, bend.centre);
                let (sin, cos) = (s * bend.sweep).sin_cos();
                plus(bend.centre, 1.0, [x * cos - y * sin, x * sin + y * cos])
            }
        }
    }

    /// Distances of random lines and arcs against dense sampling.
    #[test]
    fn distances() {
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        for _ in 0..400 {
            let mut make = || {
                let [x, y, u, v] = [(); 4].map(|()| 10.0 * random());
                if random() < 0.4 {
                    return element([x, y], [u, v], None);
                }
                let bend = Bend {
                    centre: [u, v],
                    sweep: (2.0 * random() - 1.0) * 6.2,
                };
                let mut arc = element([x, y], [x, y], Some(bend));
                arc.end = at(&arc, 1.0);
                arc
            };
            let (a, b) = (make(), make());
            let found = a.distance(&b);
            let steps = 400;
            let places =
                |e: &Element| -> Vec<Flat> { (0..=steps).map(|k| at(e, f64::from(k) / f64::from(steps))).collect() };
            let (p, q) = (places(&a), places(&b));
            let mut sampled = f64::INFINITY;
            for x in &p {
                for y in &q {
                    sampled = sampled.min(length(minus(*x, *y)));
                }
            }
            // Steps are shorter than 6.2 · 14.2 / 400.
            assert!(
                found <= sampled + 1e-9 && sampled <= found + 0.23,
                "{found} {sampled} {a:?} {b:?}"
            );
            assert!(a.boxes_apart(&b) <= found + 1e-9);
        }
    }
}
