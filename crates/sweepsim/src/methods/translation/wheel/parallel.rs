//! Cones and tori of an upright tool along an arc in a plane along the dexels: the curves parallel to their sections, at the distance of the arc's radius.
//!
//! For one line the unknown is `v`, the place in the section ahead of the tool's axis or, mirrored, behind it. `Q(v) = q` has one solution where `Q′` has one sign, and the values at both ends are on
//! different sides.

use super::sheet::{Parallel, Point, Sheet};
use super::{Directions, Place, ROUNDING, Rolling};
use sweepsim_dexel::Source;

/// Stretches are halved so many times at most,
const HALVINGS: usize = 30;
/// and there are so many for one line.
const STRETCHES: usize = 240;
/// Steps of Newton's method or halvings of a bracket.
const STEPS: usize = 64;
/// Directions of the arc that are this close to level may be on the other side.
const LEVEL: f64 = 1e-6;

/// What is left to the general method.
struct Open;

/// A solution.
struct Root {
    at: Point,
    /// How far off it may be.
    error: f64,
    /// Whether `Q` grows there.
    grows: bool,
}

/// A half of a section, with the part of it whose envelope may be over a line.
struct Search<'a> {
    parallel: Parallel<'a>,
    /// The wanted value of `Q`.
    y: f64,
    /// −1 behind the axis: then the half has its start at the axis where the other has its end.
    mirror: f64,
}

impl<S: Fn(f64) -> Source> Rolling<'_, '_, S> {
    /// The lines that a cone or a torus passes.
    pub(super) fn sheet(&mut self, sheet: &Sheet) {
        let wheel = self.wheel;
        let outer = sheet.radii[1];
        let [low, high] = self.directions[0].map(|cosine| wheel.radius * cosine);
        let [_, sines] = self.directions;
        // `(cos α, sin α)` is the normal of the section, or its opposite.
        let sides: Vec<f64> = [1.0, -1.0]
            .into_iter()
            .filter(|side| {
                if side * sheet.up > 0.0 {
                    sines[1] > -LEVEL
                } else {
                    sines[0] < LEVEL
                }
            })
            .collect();
        let ranges = [[-outer, outer], [low - outer, high + outer]];
        self.each(wheel.centre, ranges, |own, (i, j), place| {
            let mark = own.lines.mark();
            for side in &sides {
                if own.over(sheet, *side, (i, j), place).is_err() {
                    own.lines.forget(mark);
                    own.lines.open(own.lines.lines.line(i, j));
                    return;
                }
            }
        });
    }

    #[inline]
    fn over(&mut self, sheet: &Sheet, side: f64, (i, j): (usize, usize), [q, p]: [f64; 2]) -> Result<(), Open> {
        let (r, [inner, outer]) = (self.wheel.radius, sheet.radii);
        let slack = self.slack.max(16.0 * f64::EPSILON * outer);
        let doubt = 8.0 * slack * (outer + slack);
        let room = (outer - p) * (outer + p);
        if room < -doubt {
            return Ok(());
        }
        // The ends of the section, at least and at most.
        let root = |square: f64| square.max(0.0).sqrt();
        let to = [root(room - doubt), root(room + doubt)];
        let room = (inner - p) * (inner + p);
        let from = if inner == 0.0 {
            [0.0; 2]
        } else {
            [root(room - doubt), root(room + doubt)]
        };
        let parallel = Parallel {
            sheet,
            p,
            r,
            side,
            slack,
        };
        let [positive, negative] = sheet.sides().map(|certain| if certain { 0.0 } else { 1.0 });
        let margin = 8.0 * slack + ROUNDING * r;
        for mirror in [1.0, -1.0] {
            // Of `side ν`, which is `mirror cos α`.
            let cosines = self.directions[0].map(|cosine| mirror * cosine);
            let normals = if side > 0.0 {
                [-positive, negative]
            } else {
                [-negative, positive]
            };
            let low = cosines[0].min(cosines[1]).max(normals[0]);
            let high = cosines[0].max(cosines[1]).min(normals[1]);
            let y = mirror * q;
            let clip = [y - r * high - margin, y - r * low + margin];
            if !(low <= high + ROUNDING) || clip[1] < from[0] || clip[0] > to[1] {
                continue;
            }
            let search = Search { parallel, y, mirror };
            search.roots([from, to], clip, |root| self.root(&search, root, (i, j)))?;
        }
        Ok(())
    }

    fn root(&mut self, search: &Search, root: Root, (i, j): (usize, usize)) -> Result<(), Open> {
        let Search { parallel, y, mirror } = search;
        let (side, r, sheet) = (parallel.side, parallel.r, parallel.sheet);
        let Root { at, error, grows } = root;
        let cosine = mirror * side * at.nu;
        let off = (at.q - y).abs() + 2.0 * parallel.slack + error;
        let (sine, error) = match self.directions(cosine, off / r) {
            Directions::None | Directions::Level(false) => return Ok(()),
            Directions::Level(true) => return Err(Open),
            Directions::Pair(sine, error) => (side * sheet.up * sine, error),
        };
        let share = match self.place([cosine, sine], error) {
            Place::Outside => return Ok(()),
            Place::Near => return Err(Open),
            Place::Inside(share) => share,
        };
        let z = self.wheel.centre[2] + r * sine + sheet.height(&at);
        let jump = if (sine > 0.0) == grows { -1 } else { 1 };
        let across = sheet.out * at.e / at.rho;
        let up = sheet.out * sheet.up * at.square.sqrt();
        let normal = self.in_space([across * mirror * at.v, across * parallel.p, up]);
        let source = (self.source)(share);
        self.lines
            .crossing(self.lines.lines.line(i, j), z, jump, normal, source);
        Ok(())
    }
}

impl Search<'_> {
    /// On which side of the line: the same at the axis for both halves.
    fn before(&self, at: &Point) -> bool {
        if self.mirror > 0.0 {
            at.q < self.y
        } else {
            at.q > self.y
        }
    }

    /// Whether the line may be met between two places.
    fn may_meet(&self, [a, b]: [&Point; 2]) -> bool {
        let bounds = self.parallel.bounds([a, b]);
        let steepest = bounds.slope[0].abs().max(bounds.slope[1].abs());
        let reach = 0.5 * (b.v - a.v) * steepest + bounds.error;
        // NaN may.
        !((0.5 * (a.q + b.q) - self.y).abs() > reach)
    }

    /// All solutions in a part of the section. The range of each of its ends; the range beyond which the envelope is not on the arc.
    fn roots(
        &self,
        [from, to]: [[f64; 2]; 2],
        clip: [f64; 2],
        mut found: impl FnMut(Root) -> Result<(), Open>,
    ) -> Result<(), Open> {
        let all = [from[0].max(clip[0]), to[1].min(clip[1])];
        if !(all[0] <= all[1]) {
            return Ok(());
        }
        let sure = [from[1].max(all[0]), to[0].min(all[1])];
        let [first, last] = all.map(|v| self.parallel.at(v));
        if !(sure[0] < sure[1]) {
            return if self.may_meet([&first, &last]) {
                Err(Open)
            } else {
                Ok(())
            };
        }
        let [a, b] = sure.map(|v| self.parallel.at(v));
        for (end, beyond) in [(&a, &first), (&b, &last)] {
            let uncertain = if end.v == beyond.v {
                // An end of the arc, or the axis.
                end.v > 0.0 && !((end.q - self.y).abs() > self.parallel.error_at(end))
            } else if end.v < beyond.v {
                self.may_meet([end, beyond])
            } else {
                self.may_meet([beyond, end])
            };
            if uncertain {
                return Err(Open);
            }
        }
        let mut stretches = 0;
        self.between([&a, &b], (0, &mut stretches), &mut found)
    }

    /// The solutions between two places.
    fn between(
        &self,
        [a, b]: [&Point; 2],
        (depth, stretches): (usize, &mut usize),
        found: &mut impl FnMut(Root) -> Result<(), Open>,
    ) -> Result<(), Open> {
        let bounds = self.parallel.bounds([a, b]);
        let [low, high] = bounds.slope;
        let differ = self.before(a) != self.before(b);
        if low > 0.0 || high < 0.0 {
            let grows = low > 0.0;
            if !differ {
                return Ok(());
            }
            if (b.q > a.q) != grows {
                return Err(Open);
            }
            let at = self.solve([*a, *b]);
            let error = (bounds.error + (at.q - self.y).abs()) / low.abs().min(high.abs());
            return found(Root { at, error, grows });
        }
        let reach = 0.5 * (b.v - a.v) * low.abs().max(high) + bounds.error;
        if !differ && (0.5 * (a.q + b.q) - self.y).abs() > reach {
            return Ok(());
        }
        *stretches += 1;
        if depth == HALVINGS || *stretches > STRETCHES {
            return Err(Open);
        }
        let middle = self.parallel.at(0.5 * (a.v + b.v));
        self.between([a, &middle], (depth + 1, stretches), found)?;
        self.between([&middle, b], (depth + 1, stretches), found)
    }

    /// The solution between two places on different sides.
    fn solve(&self, [mut a, mut b]: [Point; 2]) -> Point {
        let enough = 0.25 * self.parallel.slack;
        let share = (self.y - a.q) / (b.q - a.q);
        let mut at = self.parallel.at(a.v + (b.v - a.v) * share.clamp(0.0, 1.0));
        for _ in 0..STEPS {
            if (at.q - self.y).abs() <= enough {
                break;
            }
            if self.before(&at) == self.before(&a) {
                a = at;
            } else {
                b = at;
            }
            let step = at.v - (at.q - self.y) / self.parallel.slope(&at);
            // NaN is outside.
            let next = if step > a.v && step < b.v {
                step
            } else {
                0.5 * (a.v + b.v)
            };
            if !(next > a.v && next < b.v) {
                break;
            }
            at = self.parallel.at(next);
        }
        at
    }
}
