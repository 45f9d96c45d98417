//! Cycles on contours: `CYCLE62` names them, `CYCLE63` mills the pocket within the first one beside the others, `CYCLE72` goes along one.
//!
//! Source: the order of the parameters of `CYCLE72` is that of Siemens, *NC programming, Programming Manual*, 12/2019 (6FC5398-2EP40-0BA0), section 3.25; of
//! [the others](super::UNCHECKED) no manual was at hand.

use super::arguments::Arguments;
use crate::controls::contour;
use crate::controls::siemens::interpreter::Reader;
use crate::controls::siemens::language::structures::Search;
use crate::controls::siemens::state::Level;
use crate::controls::siemens::state::NamedContour;
use crate::drive::{ContourCycle, Course, Cycle, Pocket, Shape, UNKNOWN_TOOL, Work};
use crate::text::error::{Located, NcProblem};

/// The step between lines where none is given, in radii of the tool.
const WIDE: f64 = 1.6;

/// The cycles on contours. `CYCLE64` drills where `CYCLE63` plunges: its moves are not known.
pub(in crate::controls::siemens) const CONTOURS: [&str; 3] = ["CYCLE62", "CYCLE63", "CYCLE72"];

/// `CYCLE62(KNAME, TYPE, LAB1, LAB2)`: a subprogram (0), a contour between `E_LAB_A_` and `E_LAB_E_` (1), between labels (2), of a subprogram (3).
fn named(arguments: &Arguments) -> Option<NamedContour> {
    let name = arguments.text(0);
    let labels = || Some([arguments.text(2)?, arguments.text(3)?]);
    let (program, labels) = match arguments.get(1).unwrap_or(0.0) {
        0.0 => (Some(name?), None),
        1.0 => {
            let name = name?;
            (None, Some(["A", "E"].map(|end| format!("E_LAB_{end}_{name}"))))
        }
        2.0 => (None, Some(labels()?)),
        _ => (Some(name?), Some(labels()?)),
    };
    Some(NamedContour { program, labels })
}

impl Reader<'_> {
    pub(in crate::controls::siemens) fn contour_cycle(&mut self, arguments: &Arguments) -> Result<(), NcProblem> {
        let name = arguments.name;
        if name == "CYCLE62" {
            if std::mem::take(&mut self.contours.milled) || arguments.values.iter().all(Option::is_none) {
                self.contours.named.clear();
            }
            self.contours.named.extend(named(arguments));
            return Ok(());
        }
        self.contours.milled = true;
        // CYCLE72 may name its contour itself: a subprogram, or labels.
        let named = match arguments.text(0).filter(|_| name == "CYCLE72") {
            Some(text) => {
                let labels = text.split_once(':').map(|(from, to)| [from.to_owned(), to.to_owned()]);
                vec![NamedContour {
                    program: Some(text).filter(|_| labels.is_none()),
                    labels,
                }]
            }
            None => self.contours.named.clone(),
        };
        let courses: Result<Vec<Course>, Located> = named.iter().map(|named| self.course(named)).collect();
        let courses = match courses {
            Ok(courses) if !courses.is_empty() => courses,
            // What they say is not understood, or there are none.
            _ => return self.track.leave_out_cycle(name),
        };
        let tool = self.cutter_radius(UNKNOWN_TOOL)?;
        let contours = match name {
            "CYCLE63" => area(arguments, courses, tool)?,
            _ => along(arguments, courses, tool)?,
        };
        let Some(contours) = contours else {
            return self.track.leave_out_cycle(name);
        };
        let cycle = Cycle::Shape(name.to_owned(), Box::new(Shape::Contours(contours)));
        self.track.cycle_here(&cycle, self.modes.plane, self.uncertain)
    }

    /// The course of a contour, whose blocks run for it.
    fn course(&mut self, named: &NamedContour) -> Result<Course, Located> {
        let fail = |problem| (problem, 0..0);
        let here = self.stack.last().map_or((0, 0), |level| (level.routine, level.next));
        let (routine, from) = match &named.program {
            Some(program) if self.knows(program) => (self.names[program], 0),
            Some(program) => {
                let problem = NcProblem::syntax(format!("there is no contour {program}"));
                return Err(fail(problem));
            }
            None => here,
        };
        let (next, end) = match &named.labels {
            None => (0, usize::MAX),
            Some([first, last]) => {
                let start = self.routines[routine].find(first, from, Search::Anywhere)?;
                (start, self.routines[routine].find(last, start, Search::Forward)?)
            }
        };
        let (depth, motion) = (self.stack.len(), self.modes.motion);
        let mut level = Level::new(routine, 1);
        level.called_modally = true;
        level.next = next;
        contour::course(
            self,
            self.modes.plane,
            |reader| reader.stack.push(level),
            |reader| match reader.stack.get(depth) {
                None => false,
                Some(level) => level.next < end || reader.stack.len() > depth + 1,
            },
            |reader| {
                reader.stack.truncate(depth);
                (reader.modes.motion, reader.ended) = (motion, false);
            },
        )
    }
}

/// `CYCLE63(PRG, VARI, RP, Z0, SC, Z1, F, FZ, DXY, DZ, UXY, UZ, CDIR, …)`: the last digit of `VARI` is 1 for roughing, 3 for the floor, 4 for the edge.
fn area(arguments: &Arguments, mut courses: Vec<Course>, tool: f64) -> Result<Option<ContourCycle>, NcProblem> {
    let kind = arguments.get(1).unwrap_or(1.0) % 10.0;
    let (end, surface) = (arguments.need(2, "RP")?, arguments.need(3, "Z0")?);
    // Whether it is a depth or a level is in a later parameter that posts fill in differently: a level above the surface is none.
    let bottom = arguments.need(5, "Z1")?;
    let bottom = if bottom < surface {
        bottom
    } else {
        surface - bottom.abs()
    };
    let islands = courses.split_off(1);
    let all_closed = courses.iter().chain(&islands).all(Course::is_closed);
    if !(all_closed && matches!(kind, 1.0 | 3.0 | 4.0) && bottom < surface) {
        return Ok(None);
    }
    let (step, infeed) = (arguments.length(8), arguments.length(9).abs());
    let [side, floor] = [arguments.length(10), arguments.length(11)];
    let start = surface + arguments.length(4).abs();
    Ok(Some(ContourCycle {
        work: Work::Area {
            pockets: courses,
            islands,
            inside: kind != 4.0,
            rim: kind != 3.0,
        },
        pocket: Pocket {
            infeed: if kind == 1.0 { infeed } else { 0.0 },
            left: match kind {
                1.0 => [side, floor],
                3.0 => [side, 0.0],
                _ => [0.0; 2],
            },
            step: if step > 0.0 { step } else { WIDE * tool },
            feed: arguments.feed(6),
            plunge: arguments.feed(7),
            ..Pocket::new([end.max(start), start, surface, bottom], tool)
        },
    }))
}

/// `CYCLE72(KNAME, RTP, RFP, SDIS, DP, MID, FAL, FALD, FFP1, FFD, VARI, RL, AS1, LP1, FF3, AS2, LP2, …)`: on the contour (`RL` 40), left (41) or right of it (42).
fn along(arguments: &Arguments, mut courses: Vec<Course>, tool: f64) -> Result<Option<ContourCycle>, NcProblem> {
    let [end, surface, bottom] = [(1, "RTP"), (2, "RFP"), (4, "DP")].map(|(k, name)| arguments.need(k, name));
    let (end, surface, bottom) = (end?, surface?, bottom?);
    let finishes = arguments.get(10).is_some_and(|kind| kind % 10.0 == 2.0);
    let side = match arguments.get(11) {
        Some(41.0) => Some(true),
        Some(42.0) => Some(false),
        _ => None,
    };
    if !(bottom < surface) {
        return Ok(None);
    }
    let start = surface + arguments.length(3).abs();
    let left = match finishes {
        true => [0.0; 2],
        false => [arguments.length(6), arguments.length(7)],
    };
    Ok(Some(ContourCycle {
        work: Work::Along(courses.swap_remove(0), side),
        pocket: Pocket {
            infeed: arguments.length(5).abs(),
            left,
            feed: arguments.feed(8),
            plunge: arguments.feed(9),
            ..Pocket::new([end.max(start), start, surface, bottom], tool)
        },
    }))
}
