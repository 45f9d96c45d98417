//! Free contours (FK): `FL FLT FC FCT FPOL FSELECT`. What a drawing says of lines and arcs determines where they begin
//! and end.
//!
//! Source: *iTNC 530, User's Manual* (340 49x-03), 6.6 Path contours, FK free contour programming. Its pages name the
//! data; in which order the control numbers the solutions among which `FSELECT` chooses they do not say.

mod words;

use std::collections::VecDeque;

use crate::controls::heidenhain::interpreter::Reader;
use crate::controls::heidenhain::language::line::Line;
use crate::controls::heidenhain::words::MoveWords;
use crate::drive::CircularArc;
use crate::drive::free::{Element, Flat, Solved, Unsolved, contour, unit};
use crate::text::assumption::Assumption;
use crate::text::error::{Located, NcProblem};

/// The most elements of a free contour.
const MOST_ELEMENTS: usize = 1000;
/// The most steps of all searches of a program: loops search again.
const MOST_STEPS: usize = 2_000_000;

/// Whether a block is an element of a free contour.
pub(in crate::controls::heidenhain) fn is_free(word: &str) -> bool {
    matches!(word, "FL" | "FLT" | "FC" | "FCT")
}

impl Reader<'_> {
    /// A block of a free contour.
    pub(in crate::controls::heidenhain) fn free_block(&mut self, line: &Line) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        if line.word(0) == "FPOL" {
            self.free.pole = self.pole_of(line);
            return match self.free.pole {
                Some(_) => Ok(()),
                None => Err(whole(NcProblem::syntax("FPOL without its place: expected X and Y"))),
            };
        }
        if self.free.wrong.contains(&self.track.place.line) {
            return Ok(());
        }
        let words = self.other_words(line)?;
        let calls = self.codes(line)?;
        let Some(here) = self.track.known() else {
            return if self.uncertain {
                Ok(())
            } else {
                let problem = "a free contour from an unknown position: expected a move to X, Y and Z before it";
                Err(whole(NcProblem::syntax(problem)))
            };
        };
        if words.side == Some(None) && self.track.compensates() {
            self.track.end_compensation(None).map_err(whole)?;
        } else if let Some(Some(left)) = words.side {
            self.compensate(left, &words, "L").map_err(whole)?;
        }
        let [u, v, _] = self.modes.plane;
        let place = self.track.place.line;
        if self.free.solved.front().is_none_or(|(line, _)| *line != place) {
            let way = self.track.last_direction().and_then(|way| unit([way[u], way[v]]));
            self.free.solved = self.solve(line, [here[u], here[v]], way)?;
        }
        let Some((_, element)) = self.free.solved.pop_front() else {
            return Ok(());
        };
        let mut target = here;
        (target[u], target[v]) = (element.end[0], element.end[1]);
        let abc = self.track.abc;
        self.corner_ahead(words.rapid, abc)?;
        match element.arc() {
            None => self.track.line(target, abc, words.rapid),
            Some((centre, counter_clockwise)) => {
                CircularArc::about((here, target), self.modes.plane, centre, counter_clockwise, 1.0)
                    .map_err(NcProblem::syntax)
                    .and_then(|arc| self.track.circle(&arc, abc))
            }
        }
        .map_err(whole)?;
        if calls {
            self.call_cycle(line)?;
        }
        Ok(())
    }

    /// The direction in which a free contour goes on from a point, by the block there and those after it.
    pub(in crate::controls::heidenhain) fn free_way_after(&self, line: &Line, from: Flat) -> Option<Flat> {
        let elements = self.elements(line, false).ok()?;
        let found = contour(&elements, from, None).ok()?;
        found.contour.first().map(Solved::first_direction)
    }

    /// The elements from this block on.
    fn solve(&mut self, line: &Line, from: Flat, way: Option<Flat>) -> Result<VecDeque<(usize, Solved)>, Located> {
        let whole = |problem| (problem, line.all());
        let elements = self.elements(line, true)?;
        self.free.wrong = 0..0;
        if self.free.steps > MOST_STEPS {
            let problem =
                "the free contours of this program take too long to solve: expected fewer of them, or in fewer loops";
            return Err(whole(NcProblem::syntax(problem)));
        }
        let found = contour(&elements, from, way).map_err(|stuck| {
            let own = self.track.place.line;
            self.free.steps += stuck.steps;
            self.free.wrong = own + 1..elements.last().map_or(own, |last| last.line) + 1;
            whole(unsolved(&elements, &stuck))
        })?;
        self.free.steps += found.steps;
        self.track
            .note("a free contour is solved from what its blocks say: compare it with the drawing");
        if found.count > 1 {
            let [first, last] = [elements.first(), elements.last()].map(|one| one.map_or(0, |one| one.line));
            let what = format!("the free contour of lines {first} to {last}");
            let count = if found.may_be_more() {
                "many".to_owned()
            } else {
                found.count.to_string()
            };
            let kind = if found.crosses_itself {
                "all of which cross themselves"
            } else {
                "and does not cross itself"
            };
            let taken = format!(
                "the shortest of {count} that fit its blocks, {kind}: how the control numbers them for FSELECT is not known"
            );
            let settle = "the ends of its elements by X and Y";
            self.track.assume(Assumption::new(what, taken, settle));
        }
        Ok(elements.iter().map(|element| element.line).zip(found.contour).collect())
    }

    /// This block if it is one, and those after it, as far as they are of the same contour.
    fn elements(&self, line: &Line, own: bool) -> Result<Vec<Element>, Located> {
        let fail = |problem: NcProblem| (problem, line.all());
        let mut pole = self.free.pole;
        let mut elements = Vec::new();
        let own = own.then(|| (self.track.place.line, line.clone()));
        let after = self.following_lines().map(|(line, block)| (line, (*block).clone()));
        for (number, block) in own.into_iter().chain(after) {
            match block.word(0) {
                "FPOL" => pole = self.pole_of(&block).or(pole),
                word if word.starts_with("RND") || word.starts_with("CHF") => {}
                word if is_free(word) => {
                    let mut element = self.element(&block).map_err(|(problem, span)| {
                        if number == self.track.place.line {
                            (problem, span)
                        } else {
                            fail(NcProblem::syntax(format!("in line {number}: {problem}")))
                        }
                    })?;
                    (element.line, element.pole) = (number, pole);
                    if element.needs_pole() && pole.is_none() {
                        let problem = "polar coordinates in a free contour without a pole: expected FPOL before them";
                        return Err(fail(NcProblem::syntax(problem)));
                    }
                    element.number = self.block_number(number);
                    elements.push(element);
                }
                _ => break,
            }
            if elements.len() > MOST_ELEMENTS {
                let problem = NcProblem::value("the elements of a free contour", "more", "at most 1000");
                return Err(fail(problem));
            }
        }
        Ok(elements)
    }

    /// What elements say besides their geometry: side, feed, rapid.
    fn other_words(&mut self, line: &Line) -> Result<MoveWords, Located> {
        let mut rest = line.clone();
        let is_other = |text: &str| {
            matches!(text, "R0" | "RL" | "RR" | "MAX" | "AUTO") || text.starts_with('F') || text.starts_with('M')
        };
        let mut number = 0;
        rest.tokens.retain(|token| {
            number += 1;
            number == 1 || is_other(&token.text)
        });
        self.words(&rest)
    }
}

fn unsolved(elements: &[Element], stuck: &Unsolved) -> NcProblem {
    let line = elements.get(stuck.number).map_or(0, |one| one.line);
    if stuck.is_open {
        NcProblem::syntax(format!(
            "the free contour is not determined by its blocks up to line {line}: expected more of what the drawing says, such as X, Y, AN, LEN, R or CCX and CCY"
        ))
    } else {
        NcProblem::syntax(format!(
            "no free contour fits its blocks up to line {line}: expected what agrees with those before and after"
        ))
    }
}
