//! Tools and stock as comments, in the words that readers know.

use super::number;
use crate::model::program::Program;
use crate::model::stock::StockDescription;
use crate::model::tool::{CutterKind, ToolDescription};

/// The most decimals of measures.
const DECIMALS: usize = 9;

fn length(value: f64) -> String {
    let text = number(value, DECIMALS);
    if text.contains('.') { text } else { text + "." }
}

/// Comments about the tools and the stock of a program.
pub(super) fn of(program: &Program) -> Vec<String> {
    let mut lines: Vec<String> = program
        .tools
        .iter()
        .filter_map(|(number, tool)| of_tool(*number, tool))
        .collect();
    if let Some(StockDescription::Block { min, max }) = program.stock {
        for (name, corner) in [("stockMin", min), ("stockMax", max)] {
            let [x, y, z] = corner.map(|value| number(value, DECIMALS));
            lines.push(format!("{name}:{x}mm, {y}mm, {z}mm"));
        }
    }
    lines
}

/// `T1 D=6. CR=3. - ball end mill`, as posts of Fusion and HSM write it.
fn of_tool(number: u32, tool: &ToolDescription) -> Option<String> {
    let (kind, diameter) = (tool.kind.as_ref()?, tool.diameter?);
    let (corner, angle) = match kind {
        CutterKind::Flat => (None, None),
        CutterKind::Ball => (Some(tool.corner_radius.unwrap_or(0.5 * diameter)), None),
        CutterKind::Bull => (Some(tool.corner_radius?), None),
        CutterKind::Tapered | CutterKind::Chamfer => (tool.corner_radius, Some(tool.taper_angle?)),
        CutterKind::Drill => (None, tool.point_angle),
        _ => return None,
    };
    let mut line = format!("T{number} D={} CR={}", length(diameter), length(corner.unwrap_or(0.0)));
    if let Some(angle) = angle {
        line += &format!(" TAPER={}deg", super::number(angle, DECIMALS));
    }
    Some(format!("{line} - {}", kind.name()))
}
