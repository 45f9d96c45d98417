//! Canonical commands: what a program makes the machine do, in LinuxCNC's words for it.
//!
//! Source: *The NIST RS274/NGC Interpreter, version 3*, section 4 (canonical machining functions), as LinuxCNC's stand-alone interpreter
//! prints them.

use std::f64::consts::TAU;
use std::fmt;

use super::contour::{ArcPlane, Stroke};

/// A canonical command, in the program's units and coordinates.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Canonical {
    Traverse([f64; 6]),
    Feed([f64; 6]),
    Arc {
        plane: ArcPlane,
        end: [f64; 3],
        centre: [f64; 2],
        /// Signed: negative clockwise; 1 for less than a full turn.
        turns: i32,
        abc: [f64; 3],
    },
    WorkOffset {
        index: u32,
        origin: [f64; 3],
    },
    Shift([f64; 3]),
    Rotation(f64),
    ToolOffset([f64; 3]),
    Dwell(f64),
    Message(String),
    Print(String),
}

/// The canonical commands of a program so far.
#[derive(Default)]
pub(crate) struct Trace {
    pub commands: Vec<Canonical>,
    /// Millimetres per unit of the program.
    pub unit: f64,
}

impl Trace {
    /// A move of the tool.
    pub fn stroke(&mut self, stroke: &Stroke) {
        let [x, y, z] = stroke.end.map(|x| x / self.unit);
        let [a, b, c] = stroke.abc;
        self.commands.push(match stroke.bend {
            Some(bend) => {
                let turns = ((bend.sweep.abs() - 1e-6) / TAU).floor() as i32 + 1;
                Canonical::Arc {
                    plane: stroke.plane,
                    end: [x, y, z],
                    centre: bend.centre.map(|x| x / self.unit),
                    turns: if bend.sweep > 0.0 { turns } else { -turns },
                    abc: stroke.abc,
                }
            }
            None if stroke.rapid => Canonical::Traverse([x, y, z, a, b, c]),
            None => Canonical::Feed([x, y, z, a, b, c]),
        });
    }
}

/// A number with four decimals, never `-0.0000`.
struct Four(f64);

impl fmt::Display for Four {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = format!("{:.4}", self.0);
        f.write_str(if text == "-0.0000" { "0.0000" } else { &text })
    }
}

fn list(numbers: impl IntoIterator<Item = f64>) -> String {
    let texts: Vec<String> = numbers.into_iter().map(|number| Four(number).to_string()).collect();
    texts.join(", ")
}

impl fmt::Display for Canonical {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Traverse(to) => write!(f, "STRAIGHT_TRAVERSE({})", list(*to)),
            Self::Feed(to) => write!(f, "STRAIGHT_FEED({})", list(*to)),
            Self::Arc {
                plane: [u, v, w],
                end,
                centre,
                turns,
                abc,
            } => {
                let first = list([end[*u], end[*v], centre[0], centre[1]]);
                let last = list([end[*w], abc[0], abc[1], abc[2]]);
                write!(f, "ARC_FEED({first}, {turns}, {last})")
            }
            Self::WorkOffset { index, origin } => {
                let [x, y, z] = *origin;
                write!(f, "SET_G5X_OFFSET({index}, {})", list([x, y, z, 0.0, 0.0, 0.0]))
            }
            Self::Shift([x, y, z]) => write!(f, "SET_G92_OFFSET({})", list([*x, *y, *z, 0.0, 0.0, 0.0])),
            Self::Rotation(degrees) => write!(f, "SET_XY_ROTATION({})", Four(*degrees)),
            Self::ToolOffset([x, y, z]) => write!(
                f,
                "USE_TOOL_LENGTH_OFFSET({} {} {}, 0.0000 0.0000 0.0000, 0.0000 0.0000 0.0000)",
                Four(*x),
                Four(*y),
                Four(*z)
            ),
            Self::Dwell(seconds) => write!(f, "DWELL({})", Four(*seconds)),
            Self::Message(text) => write!(f, "MESSAGE(\"{text}\")"),
            Self::Print(text) => f.write_str(text),
        }
    }
}
