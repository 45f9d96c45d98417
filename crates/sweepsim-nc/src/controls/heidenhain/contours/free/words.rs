//! The words of the blocks of a free contour.

use crate::controls::heidenhain::interpreter::Reader;
use crate::controls::heidenhain::language::line::Line;
use crate::drive::free::{Element, Flat, Value};
use crate::text::error::{Located, NcProblem};

/// The names of words, longer ones before those that they begin with.
const NAMES: [&str; 34] = [
    "RCCX", "RCCY", "CCPR", "CCPA", "CLSD", "CCX", "CCY", "CCA", "PDX", "PDY", "P1X", "P1Y", "P2X", "P2Y", "P3X",
    "P3Y", "PAR", "RPR", "RPA", "RAN", "LEN", "DR", "DP", "PR", "PA", "AN", "RX", "RY", "RL", "RR", "R", "D", "X", "Y",
];

/// A word of a block: its name, whether it is incremental, and what is written on it.
struct Word<'a> {
    name: &'a str,
    relative: bool,
    text: String,
    index: usize,
}

/// The words of a block that are about geometry.
fn geometry(line: &Line) -> Result<Vec<Word<'static>>, Located> {
    let mut words = Vec::new();
    let mut index = 1;
    while index < line.tokens.len() {
        let at = index;
        let text = line.word(index).to_owned();
        index += 1;
        let (relative, plain) = crate::controls::heidenhain::language::line::relative(&text);
        let named = NAMES.iter().find_map(|name| {
            let rest = plain.strip_prefix(name)?;
            let value = |c: char| "+-.,Q".contains(c) || c.is_ascii_digit();
            (rest.is_empty() || rest.starts_with(value)).then_some((*name, rest))
        });
        let Some((name, rest)) = named else {
            if text.starts_with('F') || text.starts_with('M') || matches!(text.as_str(), "MAX" | "AUTO") {
                continue;
            }
            let problem = NcProblem::syntax(format!(
                "{text} in a free contour: expected X, Y, AN, LEN, R, DR, CCX, CCY"
            ));
            return Err((problem, line.span(at)));
        };
        let mut rest = rest.to_owned();
        if rest.is_empty() && !matches!(name, "RL" | "RR") {
            rest = line.word(index).to_owned();
            index += 1;
        }
        words.push(Word {
            name,
            relative,
            text: rest,
            index: at,
        });
    }
    Ok(words)
}

impl Reader<'_> {
    /// What a block says of its element.
    pub(super) fn element(&self, line: &Line) -> Result<Element, Located> {
        let words = geometry(line)?;
        let kind = line.word(0);
        let mut element = Element {
            is_arc: kind.starts_with("FC"),
            tangential: kind.ends_with('T'),
            ..Element::default()
        };
        let unit = self.unit();
        let (mut near, mut beside): ([[Option<f64>; 2]; 4], f64) = ([[None; 2]; 4], 0.0);
        for word in &words {
            let fail = |problem| (problem, line.span(word.index));
            let sign = match (word.name, word.text.as_str()) {
                ("RL" | "RR", _) => continue,
                ("R", "0") => continue,
                ("DR", "+") => Some(true),
                ("DR", "-") => Some(false),
                ("CLSD", "+") => {
                    element.closed = Some(true);
                    continue;
                }
                ("CLSD", "-") => {
                    element.closed = Some(false);
                    continue;
                }
                _ => None,
            };
            if sign.is_some() {
                element.counter_clockwise = sign;
                continue;
            }
            let value = self.parameters.value(&word.text).map_err(fail)?;
            let (mm, angle) = (value * unit, value.to_radians());
            let block = || NcProblem::whole("a block number", value, 0..=u32::MAX, "a whole number").map_err(fail);
            let number = |value: f64| {
                Some(Value {
                    value,
                    relative: word.relative,
                    block: None,
                })
            };
            // From the end of which block a number counts follows it.
            let from = |place: &mut Option<Value>, number: u32| {
                if let Some(value) = place {
                    value.block = Some(number);
                }
            };
            match word.name {
                "X" => element.end[0] = number(mm),
                "Y" => element.end[1] = number(mm),
                "PR" => element.polar[0] = number(mm),
                "PA" => element.polar[1] = number(angle),
                "AN" => element.angle = number(angle),
                "CCX" => element.centre[0] = number(mm),
                "CCY" => element.centre[1] = number(mm),
                "CCPR" => element.polar_centre[0] = Some(mm),
                "CCPA" => element.polar_centre[1] = Some(angle),
                "RX" => from(&mut element.end[0], block()?),
                "RY" => from(&mut element.end[1], block()?),
                "RPR" => from(&mut element.polar[0], block()?),
                "RPA" => from(&mut element.polar[1], block()?),
                "RAN" => from(&mut element.angle, block()?),
                "RCCX" => from(&mut element.centre[0], block()?),
                "RCCY" => from(&mut element.centre[1], block()?),
                "CCA" => element.swept = Some(angle).filter(|angle| *angle != 0.0),
                "LEN" => element.length = Some(mm),
                "R" => element.radius = Some(mm.abs()),
                "PAR" => element.parallel = Some(block()?),
                "DP" => element.apart = Some(mm),
                "D" => beside = mm,
                "PDX" => near[0][0] = Some(mm),
                "PDY" => near[0][1] = Some(mm),
                "P1X" => near[1][0] = Some(mm),
                "P1Y" => near[1][1] = Some(mm),
                "P2X" => near[2][0] = Some(mm),
                "P2Y" => near[2][1] = Some(mm),
                "P3X" => near[3][0] = Some(mm),
                "P3Y" => near[3][1] = Some(mm),
                name => {
                    return Err(fail(NcProblem::value(name, word.text.clone(), "+ or -")));
                }
            }
        }
        for (k, point) in near.iter().enumerate() {
            match point {
                [Some(x), Some(y)] => element.near.push(([*x, *y], if k == 0 { beside } else { 0.0 })),
                [None, None] => {}
                _ => {
                    let problem = NcProblem::syntax("one coordinate of an auxiliary point: expected both");
                    return Err((problem, line.all()));
                }
            }
        }
        Ok(element)
    }

    /// The pole that a block sets.
    pub(super) fn pole_of(&self, line: &Line) -> Option<Flat> {
        let words = geometry(line).ok()?;
        let at = |name: &str| {
            let word = words.iter().find(|word| word.name == name && !word.relative)?;
            Some(self.parameters.value(&word.text).ok()? * self.unit())
        };
        Some([at("X")?, at("Y")?])
    }

    /// The number that a block has in its program.
    pub(super) fn block_number(&self, line: usize) -> Option<u32> {
        let level = self.stack.last()?;
        let text = self.routines[level.routine].text(line.checked_sub(1)?).trim_start();
        let digits = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
        text[..digits].parse().ok()
    }
}
