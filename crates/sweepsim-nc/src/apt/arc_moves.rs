//! Moves along arcs: the statements `CIRCLE` and `MOVARC`, and the moves that they become.

use super::arcs::PendingArc;
use super::frames::{Vector, norm};
use super::reader::Reader;
use super::statement::Statement;
use crate::drive::Arc;
use crate::text::error::{Located, NcProblem};

impl Reader<'_> {
    /// `MOVARC` that no `GOTO` ends.
    pub fn own_arc(&mut self, arc: &PendingArc) -> Result<(), NcProblem> {
        let Some(start) = self.track.known() else {
            return Err(NcProblem::syntax("an arc without a start: expected a GOTO before it"));
        };
        let Some(end) = arc.own_end(start) else {
            return Err(NcProblem::syntax("an arc without an end: expected a GOTO after CIRCLE"));
        };
        let made = arc.to(start, end).map_err(NcProblem::syntax)?;
        let line = std::mem::replace(&mut self.track.place.line, arc.line);
        let result = self.along(&made, self.axis());
        self.track.place.line = line;
        result
    }

    /// Ends an arc that no `GOTO` has ended.
    pub fn end_of_arc(&mut self) -> Result<(), Located> {
        match self.arc.take() {
            None => Ok(()),
            Some(arc) => self.own_arc(&arc).map_err(|problem| (problem, arc.bytes.clone())),
        }
    }

    pub fn circle(&mut self, statement: &Statement) -> Result<(), Located> {
        let list = statement.numbers();
        if let Some(word) = statement.items.iter().find(|item| item.number.is_none()) {
            let problem = NcProblem::value("a number of CIRCLE", format!("{:?}", word.text), "a number");
            return Err((problem, word.bytes.clone()));
        }
        // x, y, z and the radius, about z (Creo); otherwise with the normal, and perhaps with the radius and tolerances.
        let (normal, radius) = match list.len() {
            4 => ([0.0, 0.0, 1.0], Some(list[3])),
            0..=5 => {
                let expected = "6 (centre and normal), 7 (and the radius), or 4 (centre and radius)";
                let problem = NcProblem::value("the number of numbers of CIRCLE", list.len(), expected);
                return Err((problem, statement.bytes.clone()));
            }
            _ => ([list[3], list[4], list[5]], list.get(6).copied()),
        };
        self.begin_arc(statement, [list[0], list[1], list[2]], normal, radius, None)
    }

    pub fn movarc(&mut self, statement: &Statement) -> Result<(), Located> {
        let triple = |word: &str| -> Option<Vector> {
            let at = statement.items.iter().position(|item| item.is(word))?;
            let numbers: Vec<f64> = statement
                .items
                .get(at + 1..at + 4)?
                .iter()
                .filter_map(|item| item.number)
                .collect();
            numbers.try_into().ok()
        };
        let angle = statement.after("ANGLE").map(f64::to_radians);
        let leading: Vec<f64> = statement.items.iter().map_while(|item| item.number).collect();
        let (centre, normal, radius) = match (triple("CENTER"), triple("AXIS"), leading[..].get(..6)) {
            (Some(centre), Some(normal), _) => (centre, normal, statement.after("RADIUS")),
            (.., Some(list)) => (
                [list[0], list[1], list[2]],
                [list[3], list[4], list[5]],
                leading.get(6).copied(),
            ),
            _ => {
                let problem =
                    NcProblem::syntax("MOVARC without centre and normal: expected x, y, z, i, j, k, radius, ANGLE, a");
                return Err((problem, statement.bytes.clone()));
            }
        };
        if statement.has("TIMES") {
            let problem = NcProblem::unsupported("arcs of several turns are", "expected MOVARC without TIMES");
            return Err((problem, statement.bytes.clone()));
        }
        self.begin_arc(statement, centre, normal, radius, angle)
    }

    fn begin_arc(
        &mut self,
        statement: &Statement,
        centre: Vector,
        normal: Vector,
        radius: Option<f64>,
        angle: Option<f64>,
    ) -> Result<(), Located> {
        let fail = |problem| Err((problem, statement.bytes.clone()));
        let length = norm(normal);
        if !(length > 1e-9 && length.is_finite()) {
            let [i, j, k] = normal;
            let found = format!("({i}, {j}, {k})");
            return fail(NcProblem::value("the normal of this arc", found, "a direction"));
        }
        if angle.is_some_and(|angle| angle == 0.0 || angle.abs() > 1e4) {
            let found = angle.map_or(0.0, f64::to_degrees);
            return fail(NcProblem::value(
                "the angle of this arc",
                found,
                "not 0, and at most 500000 degrees",
            ));
        }
        self.arc = Some(PendingArc {
            centre: self.placed(centre),
            normal: self.directed(normal).map(|c| c / length),
            radius: radius
                .filter(|radius| *radius != 0.0)
                .map(|radius| radius.abs() * self.unit),
            angle,
            bytes: statement.bytes.clone(),
            line: statement.line,
        });
        Ok(())
    }

    /// Moves along an arc, while the tool turns into a direction.
    pub fn along(&mut self, arc: &Arc, axis: Vector) -> Result<(), NcProblem> {
        self.load_next();
        if !self.track.joined {
            self.line_to(arc.start, self.axis(), true)?;
        }
        self.check_turn(axis)?;
        self.track.arc_towards(arc, axis)
    }
}
