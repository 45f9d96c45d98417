//! Tools and stock in the comments of programs.
//!
//! - Posts of Fusion and HSM: `(T1 D=6. CR=3. - ZMIN=-12. - ball end mill)`. `TAPER` is the included angle of drills, and half of it for
//!   the other kinds.
//! - Free text, of Mastercam, Hurco and others: [`free_text`]. One without the number of its tool is about the next change of tools, or that of its block or of one right before.
//! - CutViewer, Carbide Create: `(TOOL/MILL, diameter, corner radius, height, taper)`, `(TOOL/DRILL, diameter, point angle, height)`,
//!   `(STOCK/BLOCK, size x, y, z, zero x, y, z)`, where the zero is that of the program, from the lower corner; `(stockMin:…)`,
//!   `(stockMax:…)`. They hold for the next tool of the program.

use std::collections::BTreeMap;

use super::free_text::{self, Described};
use super::fusion::kind_of;
use crate::model::program::Program;
use crate::model::stock::StockDescription;
use crate::model::tool::{CutterKind, ToolDescription};

/// What comments say.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Comments {
    pub tools: BTreeMap<u32, ToolDescription>,
    pub stock: Option<StockDescription>,
}

/// Describes tools by their names, where nothing else does.
pub(crate) fn name_tools(program: &mut Program, names: &BTreeMap<String, u32>) {
    let unit = program.units.in_mm();
    for (name, number) in names {
        if let Some(tool) = of_name(name.trim_matches('"'), unit) {
            program.tools.entry(*number).or_insert(tool);
        }
    }
}

/// A tool that has a name instead of a comment: `MILL_D10_R0.5`.
fn of_name(name: &str, unit: f64) -> Option<ToolDescription> {
    let tool = free_text::read(&format!("T0 {name}"), unit)?.tool;
    Some(ToolDescription {
        name: Some(name.to_owned()),
        ..tool
    })
}

/// How many lines behind a change of tools a comment without a number may be about that tool.
const BEHIND: usize = 2;

impl Comments {
    /// The first description of a tool holds.
    fn add(&mut self, number: u32, index: usize, tool: ToolDescription) {
        let tool = ToolDescription {
            line: index + 1,
            ..tool
        };
        self.tools.entry(number).or_insert(tool);
    }
}

/// Reads the comments of a program. `unit` is in millimetres per unit of the program.
pub(crate) fn read(text: &str, unit: f64) -> Comments {
    let mut found = Comments::default();
    if !text.contains(['(', ';']) {
        return found;
    }
    let mut calls = Calls::new(text);
    let mut corners = [None; 2];
    for (index, line) in text.lines().enumerate() {
        let Some(at) = line.find(['(', ';']) else {
            calls.block(index, line, &mut found);
            continue;
        };
        let comment = line[at + 1..].trim();
        let comment = comment
            .strip_suffix(')')
            .unwrap_or_else(|| comment.split(')').next().unwrap_or(""))
            .trim();
        let upper = comment.to_ascii_uppercase();
        if let Some(list) = upper.strip_prefix("TOOL/") {
            calls.next = cut_viewer(list, unit).map(|tool| ToolDescription {
                line: index + 1,
                ..tool
            });
        } else if let Some(list) = upper.strip_prefix("STOCK/BLOCK") {
            found.stock = found.stock.or_else(|| block(list, unit));
        } else if let Some(list) = upper.strip_prefix("STOCKMIN:") {
            corners[0] = point(list, unit);
        } else if let Some(list) = upper.strip_prefix("STOCKMAX:") {
            corners[1] = point(list, unit);
        } else if let Some((number, tool)) = fusion(&upper, comment, unit) {
            found.add(number, index, tool);
        } else if let Some(Described { number, tool }) = free_text::read(comment, unit) {
            // A block and its comment belong together.
            let here = number.or_else(|| calls.changed_in(&line[..at]));
            match here.or_else(|| calls.just_changed(index, &found)) {
                Some(number) => found.add(number, index, tool),
                None => {
                    calls.next = Some(ToolDescription {
                        line: index + 1,
                        ..tool
                    })
                }
            }
        }
        calls.block(index, &line[..at], &mut found);
    }
    if let [Some(min), Some(max)] = corners
        && (0..3).all(|k| min[k] < max[k])
    {
        found.stock = Some(StockDescription::Block { min, max });
    }
    found
}

/// The changes of tools, to which comments without a number belong.
struct Calls {
    /// Whether they are blocks with T and M6; a T by itself then is for later.
    with_m6: bool,
    /// The tool described last, for the next change.
    next: Option<ToolDescription>,
    /// The last change, and its line.
    last: Option<(u32, usize)>,
}

impl Calls {
    fn new(text: &str) -> Self {
        let changes = |line: &str| tool_word(block_of(line)).is_some() && has_m6(block_of(line));
        Self {
            with_m6: text.lines().any(changes),
            next: None,
            last: None,
        }
    }

    /// The tool that a block changes to.
    fn changed_in(&self, block: &str) -> Option<u32> {
        tool_word(block).filter(|_| !self.with_m6 || has_m6(block))
    }

    /// The tool of a change right before, if nothing describes it.
    fn just_changed(&self, index: usize, found: &Comments) -> Option<u32> {
        let (number, line) = self.last?;
        (index - line <= BEHIND && !found.tools.contains_key(&number)).then_some(number)
    }

    /// Gives the tool described last to the tool that a block changes to.
    fn block(&mut self, index: usize, block: &str, found: &mut Comments) {
        let Some(number) = self.changed_in(block) else { return };
        self.last = Some((number, index));
        if let Some(tool) = self.next.take() {
            found.tools.entry(number).or_insert(tool);
        }
    }
}

/// A line without its comment.
fn block_of(line: &str) -> &str {
    line.split(['(', ';']).next().unwrap_or("")
}

/// The number of a T word.
fn tool_word(block: &str) -> Option<u32> {
    let at = block.find(['T', 't'])?;
    if block[..at].ends_with(|c: char| c.is_ascii_alphabetic()) {
        return None;
    }
    let digits = block[at + 1..].len() - block[at + 1..].trim_start_matches(|c: char| c.is_ascii_digit()).len();
    block[at + 1..at + 1 + digits].parse().ok()
}

fn has_m6(block: &str) -> bool {
    block.match_indices(['M', 'm']).any(|(at, _)| {
        let rest = block[at + 1..].strip_prefix('0').unwrap_or(&block[at + 1..]);
        rest.strip_prefix('6')
            .is_some_and(|rest| !rest.starts_with(|c: char| c.is_ascii_digit()))
    })
}

/// The numbers of a list, with or without a unit behind them.
fn numbers(list: &str) -> Vec<f64> {
    list.split(',')
        .map(|word| word.trim().trim_end_matches(|c: char| c.is_ascii_alphabetic()))
        .filter(|word| !word.is_empty())
        .map_while(|word| word.parse::<f64>().ok().filter(|value| value.is_finite()))
        .collect()
}

fn point(list: &str, unit: f64) -> Option<[f64; 3]> {
    // The unit is written behind the numbers.
    let unit = if list.contains("MM") {
        1.0
    } else if list.contains("IN") {
        25.4
    } else {
        unit
    };
    let point: [f64; 3] = numbers(list).try_into().ok()?;
    Some(point.map(|c| c * unit))
}

fn block(list: &str, unit: f64) -> Option<StockDescription> {
    let numbers: [f64; 6] = numbers(list).try_into().ok()?;
    let [dx, dy, dz, x, y, z] = numbers.map(|c| c * unit);
    ([dx, dy, dz].iter().all(|side| *side > 0.0)).then_some(StockDescription::Block {
        min: [-x, -y, -z],
        max: [dx - x, dy - y, dz - z],
    })
}

fn cut_viewer(list: &str, unit: f64) -> Option<ToolDescription> {
    let (kind, list) = list.split_once(',')?;
    let numbers = numbers(list);
    let get = |index: usize| numbers.get(index).copied();
    let length = |index| get(index).map(|value| value * unit).filter(|value| *value > 0.0);
    let mut tool = match kind.trim() {
        "MILL" => {
            let taper = get(3).filter(|angle| *angle > 0.0);
            let corner = length(1);
            let diameter = length(0);
            let half = diameter.map(|diameter| 0.5 * diameter * (1.0 - 1e-3));
            let kind = match (taper, corner) {
                (Some(_), _) => CutterKind::Tapered,
                (None, None) => CutterKind::Flat,
                // Numbers have few digits: 3.17 and 1.58 are a ball.
                (None, Some(corner)) if half.is_some_and(|half| corner >= half - 0.01 * unit) => CutterKind::Ball,
                (None, Some(_)) => CutterKind::Bull,
            };
            let mut tool = ToolDescription::new(kind);
            tool.corner_radius = corner;
            tool.taper_angle = taper;
            tool.flute_length = length(2);
            tool
        }
        "DRILL" => {
            let mut tool = ToolDescription::new(CutterKind::Drill);
            tool.point_angle = get(1).filter(|angle| *angle > 0.0);
            tool.flute_length = length(2);
            tool
        }
        _ => return None,
    };
    tool.diameter = length(0);
    Some(tool)
}

fn fusion(upper: &str, comment: &str, unit: f64) -> Option<(u32, ToolDescription)> {
    let rest = upper.trim_start_matches(';').trim_start().strip_prefix(['T', '#'])?;
    let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
    let number = digits.parse().ok()?;
    let get = |name: &str| -> Option<f64> {
        // `CR=` ends with the letters of no other name; `D=` must not be the end of one.
        let at = rest
            .match_indices(name)
            .map(|(at, _)| at)
            .find(|&at| !rest[..at].ends_with(|c: char| c.is_ascii_alphanumeric()))?;
        let value: String = rest[at + name.len()..]
            .chars()
            .take_while(|c| c.is_ascii_digit() || matches!(c, '.' | '-' | '+'))
            .collect();
        value.parse::<f64>().ok().filter(|value| value.is_finite())
    };
    let diameter = get("D=")?;
    let corner = get("CR=");
    let name = comment.rsplit(" - ").next().unwrap_or("").trim();
    let kind = if name.contains('=') {
        None
    } else {
        Some(kind_of(name, corner))
    };
    let mut tool = ToolDescription {
        kind,
        ..ToolDescription::default()
    };
    tool.name = (!name.contains('=') && !name.is_empty()).then(|| name.to_owned());
    tool.diameter = (diameter > 0.0).then_some(diameter * unit);
    tool.corner_radius = corner.filter(|corner| *corner > 0.0).map(|corner| corner * unit);
    match tool.kind {
        Some(CutterKind::Drill) => tool.point_angle = get("TAPER="),
        _ => tool.taper_angle = get("TAPER="),
    }
    Some((number, tool))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn posts_of_fusion() {
        let text = "%\n(T1 D=6. CR=3. - ZMIN=-12. - ball end mill)\n(T2  D=10. CR=0. TAPER=118deg - ZMIN=-5. - drill)\n\
                    (T7 D=12. CR=0. TAPER=45deg - ZMIN=-1. - chamfer mill)\nG21\nT1 M6\n";
        let found = read(text, 1.0);
        assert_eq!(found.tools.len(), 3);
        let ball = &found.tools[&1];
        assert_eq!(
            (&ball.kind, ball.diameter, ball.line),
            (&Some(CutterKind::Ball), Some(6.0), 2)
        );
        assert_eq!(found.tools[&2].point_angle, Some(118.0));
        assert_eq!(
            (found.tools[&7].taper_angle, &found.tools[&7].kind),
            (Some(45.0), &Some(CutterKind::Chamfer))
        );
    }

    #[test]
    fn cut_viewer_and_stock() {
        let text = "(STOCK/BLOCK, 100.00, 50.00, 10.00, 0.00, 25.00, 10.00)\n(TOOL/MILL,3.17, 1.58, 0.00, 0.00)\nM6T102\n\
                    (TOOL/MILL,0.03, 0.00, 10.00, 45.00)\nM6 T390\n";
        let found = read(text, 1.0);
        assert_eq!(
            found.stock,
            Some(StockDescription::Block {
                min: [0.0, -25.0, -10.0],
                max: [100.0, 25.0, 0.0]
            })
        );
        assert_eq!(found.tools[&102].kind, Some(CutterKind::Ball));
        assert_eq!(
            (found.tools[&390].taper_angle, found.tools[&390].flute_length),
            (Some(45.0), Some(10.0))
        );
        let carbide = "(stockMin:0.00mm, 0.00mm, -1.00mm)\n(stockMax:100.00mm, 100.00mm, 0.00mm)\n";
        assert_eq!(
            read(carbide, 25.4).stock,
            Some(StockDescription::Block {
                min: [0.0, 0.0, -1.0],
                max: [100.0, 100.0, 0.0]
            })
        );
    }

    #[test]
    fn comments_before_beside_and_behind_a_change() {
        let sizes = |text: &str| -> Vec<(u32, f64)> {
            let tools = read(text, 1.0).tools;
            tools
                .into_iter()
                .map(|(number, tool)| (number, tool.diameter.unwrap()))
                .collect()
        };
        // Before each change, with the next tool staged after it.
        let before = "( 1/4\" DIA. E.M. )\nN1 T3 M6\nT2\nG0 X0\n( 1/8\" DIA. BALL E.M. )\nN2 T2 M6\nT3\nG1 X1\nM30\n";
        assert_eq!(sizes(before), [(2, 3.175), (3, 6.35)]);
        // In its block, and behind it.
        assert_eq!(
            sizes("T5 M06 (8MM ENDMILL)\nG0 X0\nT6 M06\n(6MM DRILL)\nG0 X0\n"),
            [(5, 8.0), (6, 6.0)]
        );
        // Without M6 each T is a change.
        assert_eq!(
            sizes("(8MM ENDMILL)\nT5\nG0 X0\n(6MM ENDMILL)\nT6\n"),
            [(5, 8.0), (6, 6.0)]
        );
        // A table at the head comes first; an operation's name is no tool.
        let head = "(T1| 10. FLAT ENDMILL|H1)\n(DRILL 4 HOLES)\nT1 M6\n(8MM ENDMILL)\nG0 X0\nM30\n";
        assert_eq!(sizes(head), [(1, 10.0)]);
        let found = &read("(T4| 12. FLAT ENDMILL|H4|XY STOCK TO LEAVE - .2)\nT4 M6\n", 1.0).tools[&4];
        assert_eq!((found.name.as_deref(), found.line), (Some("12. FLAT ENDMILL"), 1));
        // Klartext.
        assert_eq!(
            sizes("12 ;T2 D=+4 CR=+0 - ZMIN=-15 - flat end mill\n13 ;  #3 D=10 - ZMIN=-4.5 - flat end mill\n"),
            [(2, 4.0), (3, 10.0)]
        );
    }

    #[test]
    fn other_comments_say_nothing() {
        for text in [
            "(T1)",
            "(D=5)",
            "(T D=5)",
            "(TOOL/)",
            "(STOCK/BLOCK, 1, 2)",
            "(T1 OD=5)",
            "(stockMin:1)",
            "(TOOL/MILL,",
        ] {
            let found = read(text, 1.0);
            assert_eq!(found, Comments::default(), "{text}");
        }
    }
}
