//! Cycles that have been defined: the cycle that is called, and what cycles on contours share.

use std::collections::{BTreeMap, VecDeque};
use std::ops::Range;

use super::language::line::Line;
use super::language::values::Parameters;
use crate::drive::free::{Flat, Solved};
use crate::drive::{Cycle, Pocket};
use crate::model::event::Spindle;
use crate::text::error::{Located, NcProblem};

/// What stays in effect until another word changes it.
#[derive(Default)]
pub(super) struct Modes {
    pub inch: bool,
    pub plane: [usize; 3],
    pub tip_control: bool,
    pub shortest: bool,
    /// The centre of CC, in the frame.
    pub centre: Option<[f64; 2]>,
    /// Whether the last move was a rapid.
    pub last_rapid: bool,
    /// The side of the contour: RL.
    pub compensated: Option<bool>,
    /// The radii of TOOL DEF, in mm.
    pub radii: BTreeMap<u32, f64>,
    /// DR of TOOL CALL, in mm.
    pub oversize: f64,
    /// DR2 of TOOL CALL, in mm.
    pub corner_oversize: f64,
    /// The feed of TOOL CALL, for F AUTO.
    pub tool_feed: Option<f64>,
    /// M136: feeds per revolution.
    pub per_revolution: bool,
    /// M89: the cycle is called after each move.
    pub calls_after_moves: bool,
    pub speed: Option<f64>,
    /// Whether the speed is another one than that at which the spindle was turned on.
    pub other_speed: bool,
    pub spindle: Spindle,
}

/// The cycle that `CYCL CALL` and `M99` call, and what cycles on contours share.
#[derive(Default)]
pub(super) struct Cycles {
    pub(super) cycle: Option<Cycle>,
    /// The program of cycle 12, which is called instead.
    pub(super) program: Option<String>,
    /// Its number and its block, which patterns take with other levels.
    pub(super) block: Option<(u32, Line)>,
    /// Where `CYCL CALL PAT` calls it.
    pub(super) pattern: Pattern,
    pub(super) contours: ContourData,
}

/// Where a cycle is called: in the plane, and by how much its surface is above that of its definition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CyclePlace {
    pub(super) at: [f64; 2],
    pub(super) above: f64,
}

/// What `PATTERN DEF` or `SEL PATTERN` names.
#[derive(Clone, Debug, Default)]
pub(super) enum Pattern {
    #[default]
    None,
    Places(Vec<CyclePlace>),
    /// A table of points, by its name.
    Table(String),
}

/// What free contours share from block to block.
#[derive(Default)]
pub(super) struct FreeContour {
    /// The pole of FPOL.
    pub(super) pole: Option<Flat>,
    /// The elements that are still to be made, with their lines.
    pub(super) solved: VecDeque<(usize, Solved)>,
    /// The lines of a contour that is wrong: what is said of its first one is enough.
    pub(super) wrong: Range<usize>,
    /// The steps of all searches.
    pub(super) steps: usize,
}

/// What cycles 14 and 20 say.
#[derive(Default)]
pub(super) struct ContourData {
    pub(super) labels: Vec<String>,
    pub(super) levels: Option<Pocket>,
    /// The overlap of ways, in radii of the tool.
    pub(super) overlap: f64,
}

impl ContourData {
    /// `CYCL DEF 14.1 CONTOUR LABEL1 /2`: the numbers behind the word.
    pub(super) fn name_labels(&mut self, part: &str, line: &Line) {
        if part == "0" {
            self.labels.clear();
            return;
        }
        let words: Vec<&str> = line.tokens.iter().skip(3).map(|token| token.text.as_str()).collect();
        let text = words.join(" ");
        let numbers = text
            .split(|c: char| !c.is_ascii_digit())
            .filter(|digits| !digits.is_empty());
        self.labels.extend(numbers.map(str::to_owned));
    }
}

/// The block that defines a cycle.
pub(super) struct Defined<'a> {
    pub number: u32,
    pub(super) line: &'a Line,
    pub(super) parameters: &'a Parameters,
    pub(super) unit: f64,
    pub(super) feed_unit: f64,
    pub(super) speed: Option<f64>,
    pub(super) per_revolution: bool,
}

impl Defined<'_> {
    /// A parameter, if it is there and a number.
    pub fn find(&self, parameter: u32) -> Result<Option<f64>, Located> {
        let name = format!("Q{parameter}=");
        for (index, token) in self.line.tokens.iter().enumerate() {
            if let Some(rest) = token.text.strip_prefix(&name) {
                let text = if rest.is_empty() {
                    self.line.word(index + 1)
                } else {
                    rest
                };
                return match self.parameters.value(text) {
                    Ok(value) => Ok(Some(value)),
                    // FMAX, FAUTO.
                    Err(_) if text.starts_with('F') || matches!(text, "MAX" | "AUTO") => Ok(None),
                    Err(problem) => Err((problem, token.span.clone())),
                };
            }
        }
        Ok(None)
    }

    /// A feed in the unit of the program.
    pub fn feed(&self, parameter: u32) -> Result<Option<f64>, Located> {
        Ok(self.find(parameter)?.map(|feed| feed * self.feed_unit))
    }

    /// A number, or 0.
    pub fn number(&self, parameter: u32) -> Result<f64, Located> {
        Ok(self.find(parameter)?.unwrap_or(0.0))
    }

    /// A length in mm, if it is there.
    pub fn length(&self, parameter: u32) -> Result<Option<f64>, Located> {
        Ok(self.find(parameter)?.map(|value| value * self.unit))
    }

    /// A length in mm, or 0.
    pub fn span(&self, parameter: u32) -> Result<f64, Located> {
        Ok(self.length(parameter)?.unwrap_or(0.0))
    }

    pub fn need(&self, parameter: u32) -> Result<f64, Located> {
        let number = self.number;
        let problem = || {
            NcProblem::syntax(format!(
                "cycle {number} without Q{parameter}: expected Q{parameter}= a number"
            ))
        };
        self.length(parameter)?.ok_or_else(|| self.fail(problem()))
    }

    /// A depth in mm, below 0.
    pub fn depth(&self, parameter: u32) -> Result<f64, Located> {
        let depth = self.need(parameter)?;
        if depth >= 0.0 {
            let what = format!("the depth Q{parameter} of cycle {}", self.number);
            return Err(self.fail(NcProblem::value(what, depth, "negative")));
        }
        Ok(depth)
    }

    pub fn fail(&self, problem: NcProblem) -> Located {
        (problem, self.line.all())
    }
}

/// A program, subprogram or repeated section on its way.
pub(super) struct Level {
    pub(super) routine: usize,
    pub(super) next: usize,
    pub(super) kind: LevelKind,
    /// The parameters of its caller alone, which come back at its end.
    pub(super) locals: Option<Vec<(String, f64)>>,
}

impl Level {
    pub(super) fn new(routine: usize, next: usize, kind: LevelKind) -> Self {
        let locals = None;
        Self {
            routine,
            next,
            kind,
            locals,
        }
    }
}

pub(super) enum LevelKind {
    Program,
    /// Until LBL 0.
    Subprogram,
    /// From `from` to before `end`, this many more times.
    Section {
        from: usize,
        end: usize,
        times: usize,
    },
}
