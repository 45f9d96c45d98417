//! Approach to a contour and departure from it: `APPR LT LN CT LCT`, `DEP LT LN CT LCT`; with a `P` before, the point is
//! in polar coordinates.
//!
//! Source: *TNC 620, Klartext programming*, Contour approach and departure; *iTNC 530* (340 420), 6.3, for `R0`. The tool
//! goes from where it is to an auxiliary point beside which the contour's compensation begins, and from there
//! tangentially, or at a right angle (`LN`), to the first point of the contour; the departure is the same backwards.

use std::f64::consts::TAU;

use crate::controls::heidenhain::contours::free::is_free;
use crate::controls::heidenhain::interpreter::Reader;
use crate::controls::heidenhain::language::line::Line;
use crate::controls::heidenhain::moves::polar_point;
use crate::controls::heidenhain::words::MoveWords;
use crate::drive::CircularArc;
use crate::model::program::FeedMode;
use crate::text::assumption::Assumption;
use crate::text::error::{Located, NcProblem};

type Flat = [f64; 2];

fn unit([x, y]: Flat) -> Option<Flat> {
    let long = x.hypot(y);
    (long > 0.0).then(|| [x / long, y / long])
}

/// A quarter turn to the left.
fn left([x, y]: Flat) -> Flat {
    [-y, x]
}

fn plus([x, y]: Flat, s: f64, [a, b]: Flat) -> Flat {
    [x + s * a, y + s * b]
}

/// `point` turned about `centre`.
fn turned(centre: Flat, point: Flat, angle: f64) -> Flat {
    let (sin, cos) = angle.sin_cos();
    let [x, y] = [point[0] - centre[0], point[1] - centre[1]];
    [centre[0] + x * cos - y * sin, centre[1] + x * sin + y * cos]
}

/// Where a tangent from `from` touches a circle, such that the way goes on along it to the left or to the right.
fn touch(from: Flat, centre: Flat, radius: f64, counter_clockwise: bool) -> Option<Flat> {
    let out = [from[0] - centre[0], from[1] - centre[1]];
    let far = out[0].hypot(out[1]);
    if !(far > radius) {
        return None;
    }
    let angle = (radius / far).acos() * if counter_clockwise { 1.0 } else { -1.0 };
    Some(turned(centre, plus(centre, radius / far, out), angle))
}

/// How the tool moves.
struct Speed {
    feed: Option<f64>,
    mode: FeedMode,
    rapid: bool,
}

impl Reader<'_> {
    /// `APPR` and `DEP`.
    pub(in crate::controls::heidenhain) fn approach_block(&mut self, line: &Line) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        let (comes, kind) = (line.word(0) == "APPR", line.word(1).to_owned());
        let plain = kind.strip_prefix('P').filter(|plain| comes || *plain == "LCT");
        let plain = plain.unwrap_or(&kind);
        if !matches!(plain, "LT" | "LN" | "CT" | "LCT") {
            let problem = NcProblem::unsupported(
                format!("{} {kind} is", line.word(0)),
                "expected LT, LN, CT or LCT, or the moves written out",
            );
            return Err(whole(problem));
        }
        let mut rest = line.clone();
        rest.tokens.remove(1);
        let before = Speed {
            feed: self.track.feed,
            mode: self.track.feed_mode,
            rapid: self.modes.last_rapid,
        };
        let words = self.words(&rest)?;
        self.codes(line)?;
        self.modes.last_rapid = words.rapid;
        if self.track.known().is_none() && self.uncertain {
            return Ok(());
        }
        match comes {
            true => self.approach(plain, &words, &before, line),
            false => self.depart(plain, &words).map_err(whole),
        }
    }

    /// The point of the plane that words give, from the tool's own.
    fn point_of(&self, words: &MoveWords) -> Result<(Flat, f64), NcProblem> {
        let plane = self.modes.plane;
        let here = self.track.known().ok_or_else(|| {
            NcProblem::syntax("APPR or DEP from an unknown position: expected a move to X, Y and Z before it")
        })?;
        let at = |k: usize| match words.axes[k] {
            Some((value, true)) => here[k] + value,
            Some((value, false)) => value,
            None => here[k],
        };
        let [u, v, w] = plane;
        let point = match words.polar.iter().any(Option::is_some) {
            true => polar_point(self.modes.centre, words.polar, Some([here[u], here[v]]))?,
            false => [at(u), at(v)],
        };
        Ok((point, at(w)))
    }

    /// Whether the tool is on the left of the contour. Without compensation nothing says it.
    fn is_left(&mut self, kind: &str, side: Option<bool>) -> bool {
        if side.is_none() && kind != "LT" {
            let what = "from which side APPR and DEP come and go without RL or RR";
            let taken = "from the right, as on the iTNC 530; later controls refuse some of them";
            self.track.assume(Assumption::new(what, taken, "RL or RR in APPR"));
        }
        side == Some(true)
    }

    /// To the auxiliary point: as the move before, but with `LCT` as the block says.
    fn go_to_auxiliary(&mut self, at: [f64; 3], kind: &str, before: &Speed, rapid: bool) -> Result<(), NcProblem> {
        let abc = self.track.abc;
        let said = before.rapid || before.feed.is_some();
        if kind == "LCT" || rapid || !said {
            return self.track.line(at, abc, rapid);
        }
        let own = (self.track.feed, self.track.feed_mode);
        (self.track.feed, self.track.feed_mode) = (before.feed, before.mode);
        let went = self.track.line(at, abc, before.rapid);
        (self.track.feed, self.track.feed_mode) = own;
        went
    }

    fn approach(&mut self, kind: &str, words: &MoveWords, before: &Speed, line: &Line) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        let [u, v, w] = self.modes.plane;
        let (first, depth) = self.point_of(words).map_err(whole)?;
        let way = self.way_after(first).ok_or_else(|| {
            whole(NcProblem::unsupported(
                "APPR before a block of this kind is",
                "expected L, LP, C, CP or CR after it",
            ))
        })?;
        let side = words
            .side
            .flatten()
            .or(self.modes.compensated.filter(|_| words.side.is_none()));
        let towards_left = self.is_left(kind, side);
        let normal = if towards_left { left(way) } else { left(way).map(|c| -c) };
        let radius = words.radius.unwrap_or(0.0);
        let sense = if towards_left == (radius >= 0.0) { 1.0 } else { -1.0 };
        let centre = plus(first, radius, normal);
        let from = self.track.known().map_or(first, |here| [here[u], here[v]]);
        let tool = match side {
            Some(_) if kind == "LN" => self.cutter_radius(0.0).unwrap_or(0.0),
            _ => 0.0,
        };
        let auxiliary = match kind {
            "LT" => Some(plus(first, -self.length_of(words), way)),
            "LN" => Some(plus(first, self.length_of(words) + tool, normal)),
            "CT" => {
                let angle = words.arc_angle.unwrap_or(0.0).to_radians();
                Some(turned(centre, first, -sense * angle))
            }
            _ => touch(from, centre, radius.abs(), sense > 0.0),
        };
        let auxiliary = auxiliary.ok_or_else(|| {
            whole(NcProblem::value(
                "the radius of APPR LCT",
                radius,
                "less than the way to its circle",
            ))
        })?;
        let space = |[a, b]: Flat, c: f64| {
            let mut at = [0.0; 3];
            (at[u], at[v], at[w]) = (a, b, c);
            at
        };
        let (abc, rapid) = (self.track.abc, words.rapid);
        let height = self.track.known().map_or(depth, |here| here[w]);
        let compensates = |reader: &mut Self| match side {
            Some(left) => reader.compensate(left, words, "L"),
            None => Ok(()),
        };
        // At a right angle, compensation begins at the auxiliary point; else before it, so that the tool comes there beside it, and goes down there.
        if kind == "LN" {
            self.go_to_auxiliary(space(auxiliary, height), kind, before, rapid)
                .map_err(whole)?;
            self.track.line(space(auxiliary, depth), abc, rapid).map_err(whole)?;
            compensates(self).map_err(whole)?;
            return self.track.line(space(first, depth), abc, false).map_err(whole);
        }
        compensates(self).map_err(whole)?;
        self.go_to_auxiliary(space(auxiliary, height), kind, before, rapid)
            .map_err(whole)?;
        if height != depth {
            self.track.line(space(auxiliary, depth), abc, rapid).map_err(whole)?;
        }
        match kind {
            "LT" => self.track.line(space(first, depth), abc, false),
            _ => self.bow((space(auxiliary, depth), space(first, depth)), centre, sense > 0.0),
        }
        .map_err(whole)
    }

    fn depart(&mut self, kind: &str, words: &MoveWords) -> Result<(), NcProblem> {
        let plane @ [u, v, _] = self.modes.plane;
        let unknown = || NcProblem::syntax("DEP without a contour before it");
        let here = self.track.known().ok_or_else(unknown)?;
        let last = [here[u], here[v]];
        let way = self.track.last_direction().and_then(|way| unit([way[u], way[v]]));
        let way = way.ok_or_else(unknown)?;
        let side = self.modes.compensated.filter(|_| self.track.compensates());
        let towards_left = self.is_left(kind, side);
        let normal = if towards_left { left(way) } else { left(way).map(|c| -c) };
        let radius = words.radius.unwrap_or(0.0);
        let sense = if towards_left == (radius >= 0.0) { 1.0 } else { -1.0 };
        let centre = plus(last, radius, normal);
        let tool = match side {
            Some(_) if kind == "LN" => self.cutter_radius(0.0).unwrap_or(0.0),
            _ => 0.0,
        };
        let (end, height) = self.point_of(words)?;
        let abc = self.track.abc;
        let at = |[a, b]: Flat| {
            let mut at = here;
            (at[u], at[v]) = (a, b);
            at
        };
        match kind {
            "LT" => self
                .track
                .line(at(plus(last, self.length_of(words), way)), abc, false)?,
            "LN" => {
                self.track.end_compensation(None)?;
                let out = plus(last, self.length_of(words) + tool, normal);
                self.track.line(at(out), abc, false)?;
            }
            "CT" => {
                let angle = words.arc_angle.unwrap_or(0.0).to_radians();
                let out = turned(centre, last, sense * angle);
                self.bow((here, at(out)), centre, sense > 0.0)?;
            }
            _ => {
                // The tangent from the end, as if the way were backwards.
                let out = touch(end, centre, radius.abs(), sense < 0.0).ok_or_else(|| {
                    NcProblem::value("the radius of DEP LCT", radius, "less than the way from its circle")
                })?;
                self.bow((here, at(out)), centre, sense > 0.0)?;
            }
        }
        self.track.end_compensation(None)?;
        self.modes.compensated = None;
        if kind == "LCT" {
            self.track.line(at(end), abc, words.rapid)?;
        }
        let mut up = self.track.known().unwrap_or(here);
        if words.axes[plane[2]].is_some() {
            up[plane[2]] = height;
            self.track.line(up, abc, words.rapid)?;
        }
        Ok(())
    }

    fn bow(
        &mut self,
        (start, end): ([f64; 3], [f64; 3]),
        centre: Flat,
        counter_clockwise: bool,
    ) -> Result<(), NcProblem> {
        let arc = CircularArc::about((start, end), self.modes.plane, centre, counter_clockwise, 1.0);
        let arc = arc.map_err(NcProblem::syntax)?;
        // A full turn of the angle is one, whatever rounding says.
        if arc.sweep.abs() > TAU - 1e-9 {
            return Ok(());
        }
        self.track.circle(&arc, self.track.abc)
    }

    fn length_of(&self, words: &MoveWords) -> f64 {
        words.length.unwrap_or(0.0)
    }

    /// The direction in which the contour goes on from a point, by the block that follows.
    fn way_after(&mut self, from: Flat) -> Option<Flat> {
        let [u, v, _] = self.modes.plane;
        let before = (self.track.feed, self.track.feed_mode, self.modes.centre);
        let per_revolution = self.modes.per_revolution;
        let mut skipped = 0;
        let mut centre = self.modes.centre;
        loop {
            let line = self.following_after(skipped)?;
            skipped += 1;
            let words = match line.word(0) {
                "RND" | "CHF" | "FPOL" => continue,
                word if is_free(word) => return self.free_way_after(&line, from),
                "L" | "LP" | "C" | "CP" | "CR" | "CC" => self.words(&line).ok()?,
                _ => return None,
            };
            (self.track.feed, self.track.feed_mode, self.modes.centre) = before;
            self.modes.per_revolution = per_revolution;
            let at = |k: usize, from: f64| match words.axes[k] {
                Some((value, true)) => from + value,
                Some((value, false)) => value,
                None => from,
            };
            let to = match words.polar.iter().any(Option::is_some) {
                true => polar_point(centre, words.polar, Some(from)).ok()?,
                false => [at(u, from[0]), at(v, from[1])],
            };
            let counter_clockwise = words.counter_clockwise.unwrap_or(true);
            let along = |centre: Flat| {
                let out = unit([from[0] - centre[0], from[1] - centre[1]])?;
                Some(if counter_clockwise {
                    left(out)
                } else {
                    left(out).map(|c| -c)
                })
            };
            return match line.word(0) {
                "CC" => {
                    centre = Some(to);
                    continue;
                }
                "C" | "CP" => along(centre?),
                "CR" => {
                    let ends = ([from[0], from[1], 0.0], [to[0], to[1], 0.0]);
                    let arc = CircularArc::with_radius(ends, [0, 1, 2], words.radius?, counter_clockwise, 1.0).ok()?;
                    along(arc.centre)
                }
                _ => match unit([to[0] - from[0], to[1] - from[1]]) {
                    Some(way) => Some(way),
                    None => continue,
                },
            };
        }
    }
}
