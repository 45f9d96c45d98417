//! How wide the tool in the spindle is, where no register and no table says it.

use std::rc::Rc;

use crate::drive::track::Track;
use crate::text::assumption::Assumption;
use crate::text::numbers::rounded;
use crate::tools::comments;

/// How wide a tool is taken to be whose size nobody tells, where a cycle needs one, in mm. A draft of a job has the same.
pub(crate) const UNKNOWN_TOOL: f64 = 6.0;

/// What asks for the diameter of the tool in the spindle.
pub(crate) struct DiameterAsked<'a> {
    /// What holds it on the control, and its name for `--diameters`.
    pub register: &'a str,
    pub option: &'a str,
    /// Millimetres per unit of length.
    pub unit: f64,
    /// Whether it is 0, as the tool's wear.
    pub wear: bool,
    /// What it is where the tool's size is not known either, in mm.
    pub unknown: f64,
}

impl Track {
    /// Takes the text of the program, whose comments may describe tools.
    pub fn describe_tools(&mut self, text: &Rc<String>) {
        self.cutters.comments = Some(Rc::clone(text));
    }

    /// The diameter of the tool in the spindle, as the job, the library or the comments tell it.
    pub fn tool_diameter(&mut self, unit: f64) -> Option<f64> {
        let tool = self.tool?;
        if let Some(text) = self.cutters.comments.take() {
            for (number, tool) in comments::read(&text, unit).tools {
                if let Some(diameter) = tool.diameter {
                    self.cutters.known.entry(number).or_insert(diameter);
                }
            }
        }
        self.cutters.known.get(&tool).copied()
    }

    /// The diameter of the tool in the spindle, in place of a register that nothing sets: an assumption; none where those are errors.
    pub fn assume_diameter(&mut self, asked: &DiameterAsked) -> Option<f64> {
        let &DiameterAsked { unit, unknown, .. } = asked;
        if self.strict {
            return None;
        }
        let known = self.tool_diameter(unit);
        let tool = self.tool.map_or("a tool".to_owned(), |tool| format!("tool {tool}"));
        let [size, radius] = [known.unwrap_or(unknown), 0.5 * known.unwrap_or(unknown)].map(|mm| rounded(mm / unit));
        let (taken, other, diameter) = match (known, asked.wear) {
            (None, _) if unknown == 0.0 => (
                format!("0, since the size of {tool} is not known: its axis goes along the contour as programmed"),
                "or the size of the tool".to_owned(),
                0.0,
            ),
            (None, _) => (
                format!("{size} across, since the size of {tool} is not known"),
                "or the size of the tool".to_owned(),
                unknown,
            ),
            (Some(diameter), false) => (
                format!("the size of {tool}, {size} across"),
                format!("0 if it is only the tool's wear: the tool is then {radius} nearer to the contour"),
                diameter,
            ),
            (Some(_), true) => (
                format!("0, the tool's wear, not the size of {tool}, {size} across"),
                "the tool's diameter".to_owned(),
                0.0,
            ),
        };
        let settle = format!("--diameters {}=… (in a job: diameters), {other}", asked.option);
        let mut assumption = Assumption::new(asked.register, taken, settle);
        assumption.size_of = self.tool.filter(|_| known.is_some() && !asked.wear);
        self.assume(assumption);
        Some(diameter)
    }
}
