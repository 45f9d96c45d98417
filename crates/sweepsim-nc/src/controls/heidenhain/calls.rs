//! Calls and jumps.

use std::rc::Rc;

use super::interpreter::Reader;
use super::language::line::Line;
use super::language::routine::Routine;
use super::state::{Level, LevelKind};
use crate::controls::run::DEEPEST_CALL;
use crate::text::error::{Located, NcProblem};

impl Reader<'_> {
    pub(super) fn push(&mut self, level: Level, line: &Line) -> Result<(), Located> {
        let whole = |problem| (problem, line.all());
        if self.stack.len() > DEEPEST_CALL {
            return Err(whole(NcProblem::syntax(format!(
                "calls within calls: nested too deeply, expected at most {DEEPEST_CALL}"
            ))));
        }
        self.track.calls().map_err(whole)?;
        self.stack.push(level);
        Ok(())
    }

    /// `CALL LBL 1`, `CALL LBL 1 REP 2`.
    pub(super) fn call_label(&mut self, line: &Line, routine: usize, index: usize) -> Result<(), Located> {
        let label = line.word(2).to_owned();
        let from = self.routines[routine].labels.get(&label).copied().ok_or_else(|| {
            (
                NcProblem::syntax(format!("there is no LBL {label} in this program")),
                line.span(2),
            )
        })?;
        let repeats = match line.word(3) {
            "" => None,
            "REP" => Some(line.word(4).split('/').next().unwrap_or("")),
            word => Some(word.strip_prefix("REP").unwrap_or(word).split('/').next().unwrap_or("")),
        };
        let kind = match repeats {
            None => LevelKind::Subprogram,
            Some(text) => {
                let times = self.parameters.value(text).map_err(|problem| (problem, line.all()))?;
                let times = NcProblem::whole("REP", times, 0..=65_534, "a whole number from 0 to 65534");
                let times = times.map_err(|problem| (problem, line.all()))?;
                if times == 0 || from >= index {
                    return Ok(());
                }
                LevelKind::Section {
                    from,
                    end: index,
                    times: times as usize,
                }
            }
        };
        self.push(Level::new(routine, from, kind), line)
    }

    pub(super) fn call_program(&mut self, line: &Line) -> Result<(), Located> {
        self.call_path(line.word(2), line)
    }

    pub(super) fn call_path(&mut self, path: &str, line: &Line) -> Result<(), Located> {
        let path = path.trim_matches('"').trim_end_matches(".H");
        // Folders are the control's own.
        let name = path.rsplit(['\\', '/', ':']).next().unwrap_or(path).to_owned();
        let routine = match self.names.get(&name) {
            Some(&routine) => routine,
            None => {
                let Some((file, text)) = (self.library)(&name) else {
                    let left = self.track.leave_out_program(&name, &format!("{name}.H"));
                    return left.map_err(|problem| (problem, line.all()));
                };
                let routine = Routine::new(self.track.add_file(file), Rc::new(text));
                self.routines.push(routine);
                self.names.insert(name, self.routines.len() - 1);
                self.routines.len() - 1
            }
        };
        self.push(Level::new(routine, 0, LevelKind::Program), line)?;
        let locals = self.parameters.take_locals();
        if let Some(level) = self.stack.last_mut() {
            level.locals = Some(locals);
        }
        Ok(())
    }

    pub(super) fn jump(&mut self, label: &str, routine: usize) -> Result<(), NcProblem> {
        let to = self.routines[routine].labels.get(label).copied();
        let to = to.ok_or_else(|| NcProblem::syntax(format!("there is no LBL {label} in this program")))?;
        // A jump out of a repeated section ends it.
        while let Some(Level {
            kind: LevelKind::Section { from, end, .. },
            ..
        }) = self.stack.last()
            && !(*from..*end).contains(&to)
        {
            self.back();
        }
        if let Some(level) = self.stack.last_mut() {
            level.next = to;
        }
        Ok(())
    }
}
