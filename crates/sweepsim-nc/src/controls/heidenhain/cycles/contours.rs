//! Cycles on contours: 14 names them, 20 has their levels, 22 to 24 mill the area within them, 25 goes along one.
//!
//! Source: *TNC 620, Cycle Programming* (340 56x-02), 7.1 to 7.9. A contour is a pocket or an island by the side on which its subprogram has the tool, and the way around.

use crate::controls::contour;
use crate::controls::heidenhain::interpreter::Reader;
use crate::controls::heidenhain::language::line::Line;
use crate::controls::heidenhain::state::{Level, LevelKind};
use crate::drive::{ContourCycle, Course, Cycle, Pocket, Shape, UNKNOWN_TOOL, Work};
use crate::text::error::{Located, NcProblem};

impl Reader<'_> {
    /// The levels of cycle 20, or of 25.
    pub(in crate::controls::heidenhain) fn contour_data(&mut self, number: u32, line: &Line) -> Result<(), Located> {
        let defined = self.defined(number, line);
        let surface = defined.span(5)?;
        let start = surface + defined.span(6)?.abs();
        let overlap = defined.find(2)?.filter(|overlap| *overlap > 0.0).unwrap_or(1.0);
        let end = start.max(defined.length(7)?.unwrap_or(start));
        let bottom = surface + defined.depth(1)?;
        let levels = Pocket {
            left: [defined.span(3)?, defined.span(4)?],
            ..Pocket::new([end, start, surface, bottom], 0.0)
        };
        self.cycles.contours.levels = Some(levels);
        self.cycles.contours.overlap = overlap;
        Ok(())
    }

    /// Cycles 22 to 25.
    pub(in crate::controls::heidenhain) fn contour_cycle(
        &mut self,
        number: u32,
        line: &Line,
    ) -> Result<Cycle, Located> {
        let name = format!("cycle {number}");
        let courses = match self.courses() {
            Ok(courses) if !courses.is_empty() => courses,
            // What its subprograms say is not understood, or there are none.
            Ok(_) | Err(_) => return Ok(Cycle::Unknown(name)),
        };
        if number == 25 {
            self.contour_data(25, line)?;
        }
        let tool = self.cutter_radius(UNKNOWN_TOOL).ok_or_else(|| {
            let problem = NcProblem::syntax(format!("the radius of the tool of {name} is not known"));
            (problem, line.all())
        })?;
        let Some(levels) = self.cycles.contours.levels.clone() else {
            let problem = NcProblem::syntax(format!("{name} without cycle 20 before it: expected its levels there"));
            return Err((problem, line.all()));
        };
        let defined = self.defined(number, line);
        let [side, floor] = levels.left;
        let pocket = Pocket {
            tool,
            step: tool * self.cycles.contours.overlap,
            infeed: defined.span(10)?.abs(),
            plunge: defined.feed(11)?,
            feed: defined.feed(12)?,
            left: match number {
                22 => [side, floor],
                23 => [side, 0.0],
                24 => [defined.span(14)?, 0.0],
                _ => [side, 0.0],
            },
            ..levels
        };
        let work = match (number, courses) {
            (25, mut courses) => {
                let course = courses.swap_remove(0);
                let left = course.left;
                Work::Along(course, left)
            }
            (_, courses) => {
                let (pockets, islands): (Vec<_>, Vec<_>) = courses.into_iter().partition(Course::is_pocket);
                if pockets.is_empty() || !pockets.iter().chain(&islands).all(Course::is_closed) {
                    return Ok(Cycle::Unknown(name));
                }
                Work::Area {
                    pockets,
                    islands,
                    inside: number != 24,
                    rim: number != 23,
                }
            }
        };
        let pocket = Pocket {
            // The floor at once, which roughing has left.
            infeed: if number == 23 { 0.0 } else { pocket.infeed },
            ..pocket
        };
        let contours = ContourCycle { work, pocket };
        Ok(Cycle::Shape(name, Box::new(Shape::Contours(contours))))
    }

    /// The courses of the contours, whose subprograms run for it.
    fn courses(&mut self) -> Result<Vec<Course>, Located> {
        let labels = self.cycles.contours.labels.clone();
        labels.iter().map(|label| self.course(label)).collect()
    }

    fn course(&mut self, label: &str) -> Result<Course, Located> {
        let fail = |problem| (problem, 0..0);
        let routine = self.stack.last().map_or(0, |level| level.routine);
        let Some(&next) = self.routines[routine].labels.get(label) else {
            return Err(fail(NcProblem::syntax(format!(
                "there is no LBL {label} in this program"
            ))));
        };
        let (depth, compensated) = (self.stack.len(), self.modes.compensated);
        let level = Level::new(routine, next, LevelKind::Subprogram);
        contour::course(
            self,
            self.modes.plane,
            |reader| reader.stack.push(level),
            |reader| reader.stack.len() > depth,
            |reader| {
                reader.stack.truncate(depth);
                (reader.modes.compensated, reader.ended) = (compensated, false);
            },
        )
    }
}
