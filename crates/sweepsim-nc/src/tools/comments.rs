//! Tools and stock in the comments of programs.
//!
//! - Posts of Fusion and HSM: `(T1 D=6. CR=3. - ZMIN=-12. - ball end mill)`. `TAPER` is the included angle of drills, and half of it for
//!   the other kinds.
//! - CutViewer, Carbide Create: `(TOOL/MILL, diameter, corner radius, height, taper)`, `(TOOL/DRILL, diameter, point angle, height)`,
//!   `(STOCK/BLOCK, size x, y, z, zero x, y, z)`, where the zero is that of the program, from the lower corner; `(stockMin:…)`,
//!   `(stockMax:…)`. They hold for the next tool of the program.

use std::collections::BTreeMap;

use super::fusion::kind_of;
use crate::model::stock::StockDescription;
use crate::model::tool::{CutterKind, ToolDescription};

/// What comments say.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Comments {
    pub tools: BTreeMap<u32, ToolDescription>,
    pub stock: Option<StockDescription>,
}

/// Words without which no comment says anything.
const WORDS: [&str; 6] = ["D=", "TOOL/", "STOCK/", "tool/", "stock/", "stockM"];

/// Reads the comments of a program. `unit` is in millimetres per unit of the program.
pub(crate) fn read(text: &str, unit: f64) -> Comments {
    let mut found = Comments::default();
    if !WORDS.iter().any(|word| text.contains(word)) {
        return found;
    }
    let mut next_tool: Option<ToolDescription> = None;
    let mut corners = [None; 2];
    for (index, line) in text.lines().enumerate() {
        let Some(at) = line.find(['(', ';']) else {
            take_up(line, &mut next_tool, &mut found);
            continue;
        };
        let comment = line[at + 1..].split(')').next().unwrap_or("").trim();
        let upper = comment.to_ascii_uppercase();
        if let Some(list) = upper.strip_prefix("TOOL/") {
            next_tool = cut_viewer(list, unit).map(|tool| ToolDescription {
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
            found.tools.entry(number).or_insert(ToolDescription {
                line: index + 1,
                ..tool
            });
        }
        take_up(&line[..at], &mut next_tool, &mut found);
    }
    if let [Some(min), Some(max)] = corners
        && (0..3).all(|k| min[k] < max[k])
    {
        found.stock = Some(StockDescription::Block { min, max });
    }
    found
}

/// Gives the tool described last to the tool that a block selects.
fn take_up(block: &str, next: &mut Option<ToolDescription>, found: &mut Comments) {
    if next.is_none() {
        return;
    }
    let Some(at) = block.find(['T', 't']) else { return };
    let digits: String = block[at + 1..].chars().take_while(char::is_ascii_digit).collect();
    if let (Ok(number), Some(tool)) = (digits.parse(), next.take()) {
        found.tools.entry(number).or_insert(tool);
    }
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
    let rest = upper.strip_prefix('T')?;
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
