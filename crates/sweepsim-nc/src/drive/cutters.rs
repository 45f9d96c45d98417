//! The sizes of the tools themselves, which stand for those that nothing gives the control.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::track::Track;
use crate::model::assumption::Assumption;
use crate::model::read_options::ReadOptions;
use crate::text::numbers::rounded;
use crate::tools::comments;

/// Diameters of the tools: those that jobs and libraries describe, and once one is asked for, those of the comments.
#[derive(Clone, Debug, Default)]
pub(super) struct Cutters {
    known: BTreeMap<u32, f64>,
    /// The text whose comments have not been read yet.
    comments: Option<Rc<String>>,
}

impl Cutters {
    pub fn new(options: &ReadOptions) -> Self {
        Self {
            known: options.cutters.clone(),
            comments: None,
        }
    }
}

impl Track {
    /// Takes the text of the program, whose comments may describe tools.
    pub fn describe_tools(&mut self, text: &Rc<String>) {
        self.cutters.comments = Some(Rc::clone(text));
    }

    /// The diameter of the tool in the spindle, in place of a register that nothing sets: an assumption. `wear`: that it is 0 instead, since a contour cannot be
    /// offset by the tool's radius.
    pub fn assume_diameter(&mut self, register: &str, option: &str, unit: f64, wear: bool) -> Option<f64> {
        let tool = self.tool.filter(|_| !self.strict)?;
        if let Some(text) = self.cutters.comments.take() {
            for (number, tool) in comments::read(&text, unit).tools {
                if let Some(diameter) = tool.diameter {
                    self.cutters.known.entry(number).or_insert(diameter);
                }
            }
        }
        let diameter = *self.cutters.known.get(&tool)?;
        let [size, radius] = [diameter, 0.5 * diameter].map(|mm| rounded(mm / unit));
        let (taken, other) = match wear {
            false => (
                format!("the size of tool {tool}, {size} across"),
                format!("0 if it is only the tool's wear: the tool is then {radius} nearer to the contour"),
            ),
            true => (
                format!(
                    "0, the tool's wear: with the size of tool {tool}, {size} across, the contour cannot be offset"
                ),
                "the tool's diameter".to_owned(),
            ),
        };
        let settle = format!("--diameters {option}=… (in a job: diameters), {other}");
        self.assume(Assumption::new(register, taken, settle));
        Some(if wear { 0.0 } else { diameter })
    }
}
