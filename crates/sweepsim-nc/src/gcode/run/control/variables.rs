//! Numbered and named variables, and what the control keeps in them.

use std::cell::RefCell;
use std::collections::BTreeMap;

use super::super::interpreter::Reader;
use crate::gcode::codes::MotionMode;
use crate::gcode::syntax::block::Target;
use crate::gcode::syntax::expression::Variables;
use crate::gcode::syntax::functions::Value;
use crate::model::read_options::Controller;
use crate::text::assumption::Assumption;
use crate::text::error::NcProblem;

/// `#1` to `#33`, which calls save and restore.
pub(crate) type Locals = [Value; 34];

/// The variables of a program.
#[derive(Clone, Debug)]
pub(crate) struct Store {
    pub locals: Locals,
    /// Named variables of this call: `#<name>`.
    pub named: BTreeMap<String, f64>,
    numbered: BTreeMap<u32, f64>,
    /// Those of this block that only the machine or the operator knows, and what they are taken for.
    asked: RefCell<Vec<(String, &'static str)>>,
    /// Those that begin with `_`: `#<_name>`.
    global: BTreeMap<String, f64>,
}

impl Store {
    pub(crate) fn new(numbered: &BTreeMap<u32, f64>) -> Self {
        Self {
            locals: [None; 34],
            named: BTreeMap::new(),
            numbered: numbered.clone(),
            asked: RefCell::default(),
            global: BTreeMap::new(),
        }
    }

    /// Whether a variable was asked for that only the machine or the operator knows.
    pub(crate) fn asks(&mut self) -> bool {
        !self.asked.get_mut().is_empty()
    }

    pub(crate) fn get(&self, index: u32) -> Value {
        match self.locals.get(index as usize) {
            Some(local) => *local,
            None => self.numbered.get(&index).copied(),
        }
    }

    fn set(&mut self, index: u32, value: Value) {
        match (self.locals.get_mut(index as usize), value) {
            (Some(local), value) => *local = value,
            (None, Some(value)) => {
                self.numbered.insert(index, value);
            }
            (None, None) => {
                self.numbered.remove(&index);
            }
        }
    }

    /// What a subroutine returned: `#<_value>`.
    pub(crate) fn set_returned(&mut self, value: Option<f64>) {
        self.global.insert("_value".into(), value.unwrap_or(0.0));
        let returned = if value.is_some() { 1.0 } else { 0.0 };
        self.global.insert("_value_returned".into(), returned);
    }
}

/// The index of X, Y or Z if `index` is one of three variables from `first` on.
fn axis(index: u32, first: u32) -> Option<usize> {
    index.checked_sub(first).filter(|k| *k < 3).map(|k| k as usize)
}

/// The work offset and what of it a variable holds: 0 to 2 its origin, 9 its turn.
fn of_work_offset(index: u32) -> Option<(u32, usize)> {
    let place = index.checked_sub(5221)?;
    let (offset, part) = (place / 20, place % 20);
    (offset < 9 && part < 10).then_some((offset, part as usize))
}

impl Reader {
    fn in_units(&self, mm: f64) -> f64 {
        mm / self.unit()
    }

    /// What the control itself keeps in a numbered variable.
    fn system(&self, index: u32) -> Option<Result<f64, NcProblem>> {
        let fanuc = self.fanuc();
        let position = |at: Option<f64>| {
            at.map(|mm| self.in_units(mm))
                .ok_or_else(|| NcProblem::syntax(format!("#{index} is the current position, which is not known here")))
        };
        let at = self.track.xyz;
        if let Some((offset, part)) = of_work_offset(index) {
            let placed = self.offsets.work.placed(offset)?;
            return Some(Ok(match part {
                0..=2 => self.in_units(placed.origin[part]),
                9 if !fanuc => placed.turn,
                _ => 0.0,
            }));
        }
        let found = if fanuc {
            match index {
                5001..=5003 => position(at[axis(index, 5001)?]),
                5041..=5043 => position(at[axis(index, 5041)?]),
                4001 => Ok(match self.modes.motion {
                    Some(MotionMode::Rapid) => 0.0,
                    Some(MotionMode::Arc {
                        counter_clockwise: false,
                    }) => 2.0,
                    Some(MotionMode::Arc {
                        counter_clockwise: true,
                    }) => 3.0,
                    _ => 1.0,
                }),
                4003 => Ok(if self.modes.absolute { 90.0 } else { 91.0 }),
                4006 => Ok(if self.modes.inch { 20.0 } else { 21.0 }),
                4014 if self.offsets.work.active < 6 => Ok(f64::from(54 + self.offsets.work.active)),
                4109 => Ok(self.modes.feed.unwrap_or(0.0)),
                4119 => Ok(self.modes.speed.unwrap_or(0.0)),
                4120 => Ok(f64::from(self.track.tool.unwrap_or(0))),
                _ => return None,
            }
        } else {
            match index {
                5021..=5023 => position(self.machine_position()[axis(index, 5021)?]),
                5210 => Ok(if self.offsets.shifted { 1.0 } else { 0.0 }),
                5211..=5213 => Ok(self.in_units(self.offsets.saved_shift()[axis(index, 5211)?])),
                5214..=5219 => Ok(0.0),
                5220 => Ok(f64::from(self.offsets.work.active + 1)),
                5400 => Ok(f64::from(self.track.tool.unwrap_or(0))),
                5401..=5403 => {
                    let row = self.tools.get(self.track.tool.unwrap_or(0));
                    Ok(self.in_units(row.map_or(0.0, |row| row.offset[(index - 5401) as usize])))
                }
                5410 => {
                    let row = self.tools.get(self.track.tool.unwrap_or(0));
                    Ok(self.in_units(row.map_or(0.0, |row| row.diameter)))
                }
                5420..=5422 => position(at[axis(index, 5420)?]),
                5423..=5425 => Ok(self.track.abc[(index - 5423) as usize]),
                _ => return None,
            }
        };
        Some(found)
    }

    /// LinuxCNC's predefined named variables.
    fn predefined(&self, name: &str) -> Option<Result<f64, NcProblem>> {
        let truth = |yes: bool| if yes { 1.0 } else { 0.0 };
        let position = |at: Option<f64>| {
            at.map(|mm| self.in_units(mm))
                .ok_or_else(|| NcProblem::syntax(format!("#<{name}> is the current position, which is not known here")))
        };
        Some(match name {
            "_x" | "_y" | "_z" => position(self.track.xyz[name.as_bytes()[1] as usize - usize::from(b'x')]),
            "_abs_x" | "_abs_y" | "_abs_z" => {
                position(self.machine_position()[name.as_bytes()[5] as usize - usize::from(b'x')])
            }
            "_a" | "_b" | "_c" => Ok(self.track.abc[name.as_bytes()[1] as usize - usize::from(b'a')]),
            "_line" => Ok(self.track.place.line as f64),
            "_metric" => Ok(truth(!self.modes.inch)),
            "_imperial" => Ok(truth(self.modes.inch)),
            "_absolute" => Ok(truth(self.modes.absolute)),
            "_incremental" => Ok(truth(!self.modes.absolute)),
            "_feed" => Ok(self.modes.feed.unwrap_or(0.0)),
            "_rpm" => Ok(self.modes.speed.unwrap_or(0.0)),
            "_current_tool" => Ok(f64::from(self.track.tool.unwrap_or(0))),
            "_selected_tool" => Ok(f64::from(self.tools.selected.unwrap_or(0))),
            "_coord_system" => Ok(f64::from(match self.offsets.work.active {
                index @ 0..=5 => 540 + 10 * index,
                index => 585 + index,
            })),
            "_plane" => Ok(match self.modes.plane[2] {
                2 => 170.0,
                1 => 180.0,
                _ => 190.0,
            }),
            "_value" | "_value_returned" => Ok(self.variables.global.get(name).copied().unwrap_or(0.0)),
            "_task" => Ok(0.0),
            "_vmajor" => Ok(2.9),
            "_call_level" => Ok(self.calls.levels.len() as f64 - 1.0),
            _ => return None,
        })
    }

    /// Executes the assignments of a block.
    pub(crate) fn assign(&mut self, target: &Target, value: Value) -> Result<(), NcProblem> {
        let index = match target {
            Target::Name(name) => {
                let value = value.unwrap_or(0.0);
                let names = if name.starts_with('_') {
                    if self.predefined(name).is_some() {
                        return Err(NcProblem::syntax(format!(
                            "#<{name}> belongs to the control: it cannot be set"
                        )));
                    }
                    &mut self.variables.global
                } else {
                    &mut self.variables.named
                };
                names.insert(name.clone(), value);
                return Ok(());
            }
            Target::Number(index) => *index,
        };
        if let Some((offset, part)) = of_work_offset(index) {
            let mut placed = self.offsets.work.placed(offset).unwrap_or_default();
            let number = value.unwrap_or(0.0);
            match part {
                0..=2 => placed.origin[part] = number * self.unit(),
                9 if !self.fanuc() => placed.turn = number,
                _ if number == 0.0 => {}
                _ => return Err(NcProblem::unsupported("work offsets that turn are", "expected X, Y, Z")),
            }
            return self.reframe(|reader| reader.offsets.work.place(offset, placed));
        }
        let system = index >= 1000;
        if self.fanuc() && system {
            return match index {
                3000 => Err(NcProblem::syntax(
                    "the program stops here with an alarm of its own (#3000)",
                )),
                3001..=3006 | 3901 | 3902 => {
                    self.track.note(format!("#{index} is set: ignored"));
                    Ok(())
                }
                _ => Err(NcProblem::unsupported(
                    format!("setting the control's own variable #{index} is"),
                    "expected a variable below #1000, or a work offset from #5221 on",
                )),
            };
        }
        if index == 0 || (5000..5161).contains(&index) || (5191..=5602).contains(&index) {
            return Err(NcProblem::syntax(format!(
                "#{index} belongs to the control: it cannot be set"
            )));
        }
        self.variables.set(index, value);
        Ok(())
    }
}

impl Reader {
    /// Says which variables of a line were not known, and which way it went.
    pub(crate) fn say_unknown(&mut self, line: &str, jumps: bool) {
        let mut asked = std::mem::take(&mut *self.variables.asked.borrow_mut());
        asked.dedup();
        let upper = line.to_ascii_uppercase();
        let branches =
            upper.contains("IF") && (upper.contains("GOTO") || upper.contains("] N") || upper.contains("]N"));
        for (name, value) in asked {
            let taken = match (branches, jumps) {
                (true, true) => format!("{value}, by which IF jumps; with another value it may go on"),
                (true, false) => format!("{value}, by which IF goes on; with another value it may jump"),
                _ => value.to_owned(),
            };
            let settle = format!("{name}=… in the program, or the control's variables");
            self.track.assume(Assumption::new(
                format!("{name}, which the program does not set"),
                taken,
                settle,
            ));
        }
    }
}

impl Variables for Reader {
    fn fanuc(&self) -> bool {
        self.rules.fanuc()
    }

    fn increment(&self, letter: char) -> Option<f64> {
        let step = match letter {
            'A'..='C' => 0.001,
            'I'..='K' | 'Q' | 'R' | 'U'..='Z' if self.modes.inch => 0.0001,
            'I'..='K' | 'Q' | 'R' | 'U'..='Z' => 0.001,
            _ => return None,
        };
        self.rules.fanuc().then_some(step)
    }

    fn numbered(&self, index: u32) -> Result<Value, NcProblem> {
        if let Some(value) = self.variables.get(index) {
            return Ok(Some(value));
        }
        if let Some(found) = self.system(index) {
            return found.map(Some);
        }
        // Common variables that stay from program to program, and those of the machine.
        if !self.track.strict()
            && index >= 500
            && matches!(self.rules.controller, None | Some(Controller::Fanuc | Controller::Haas))
        {
            let taken = if index < 1000 { "empty" } else { "0" };
            self.variables.asked.borrow_mut().push((format!("#{index}"), taken));
            return Ok((index >= 1000).then_some(0.0));
        }
        match self.rules.controller {
            Some(Controller::Fanuc | Controller::Haas) if index >= 1000 => Err(NcProblem::unsupported(
                format!("reading the control's own variable #{index} is"),
                "only the machine knows its value",
            )),
            Some(Controller::Fanuc | Controller::Haas) => Ok(None),
            Some(Controller::LinuxCnc) if index > 5602 => {
                Err(NcProblem::value("the number of a variable", index, "at most 5602"))
            }
            Some(Controller::LinuxCnc) => Ok(Some(0.0)),
            _ => Err(NcProblem::syntax(format!(
                "#{index} has no value here: LinuxCNC takes 0, Fanuc leaves out its word; expected `#{index} = …` before, or the name of the control"
            ))),
        }
    }

    fn named(&self, name: &str) -> Result<Value, NcProblem> {
        let names = if name.starts_with('_') {
            if let Some(found) = self.predefined(name) {
                return found.map(Some);
            }
            &self.variables.global
        } else {
            &self.variables.named
        };
        match names.get(name) {
            Some(value) => Ok(Some(*value)),
            None if name == "empty" => Ok(None),
            // Of its program they are empty; common ones and the system's only the control knows.
            None if self.has_user_task() && !self.track.strict() => {
                if let Some(common) = name.strip_prefix('_') {
                    let mut asked = self.variables.asked.borrow_mut();
                    asked.push((common.to_ascii_uppercase(), "empty"));
                }
                Ok(None)
            }
            None => Err(NcProblem::syntax(format!(
                "#<{name}> has no value here: expected `#<{name}> = …` before"
            ))),
        }
    }

    fn exists(&self, target: &Target) -> bool {
        match target {
            // LinuxCNC's numbered variables all exist.
            Target::Number(index) => {
                self.variables.get(*index).is_some()
                    || self.system(*index).is_some()
                    || self.rules.controller == Some(Controller::LinuxCnc) && (1..=5602).contains(index)
            }
            Target::Name(name) => self.named(name).is_ok(),
        }
    }
}
