//! Projects of CAMotics: tools and stock of a program.

use serde_json::Value;

use super::json::{number, string};
use super::library::ToolLibrary;
use crate::model::program::Note;
use crate::model::stock::StockDescription;
use crate::model::tool::{CutterKind, ToolDescription};

/// Millimetres per unit.
fn unit_of(value: &Value) -> f64 {
    match value.get("units").and_then(Value::as_str) {
        Some("imperial") => 25.4,
        _ => 1.0,
    }
}

pub(super) fn read(value: &Value) -> ToolLibrary {
    let mut library = ToolLibrary::default();
    let tools = value.get("tools").and_then(Value::as_object);
    for (key, entry) in tools.into_iter().flatten() {
        let Ok(number) = key.trim().parse::<u32>() else {
            library
                .notes
                .push(Note::new(0, format!("tool {key:?} has no number: ignored")));
            continue;
        };
        library.add(number, tool(entry));
    }
    // The bounds are in millimetres whatever the units of the project are.
    let workpiece = value.get("workpiece");
    let bounds = workpiece.and_then(|workpiece| workpiece.get("bounds"));
    let corner = |name: &str| -> Option<[f64; 3]> {
        let list = bounds?.get(name)?.as_array()?;
        let numbers: Vec<f64> = list.iter().filter_map(Value::as_f64).collect();
        numbers.try_into().ok()
    };
    if let (Some(min), Some(max)) = (corner("min"), corner("max"))
        && (0..3).all(|k| min[k] < max[k])
    {
        library.stock = Some(StockDescription::Block { min, max });
    }
    let files = value.get("files").and_then(Value::as_array);
    library.programs = files
        .into_iter()
        .flatten()
        .filter_map(|file| file.as_str().map(str::to_owned))
        .collect();
    library
}

/// A tool. CAMotics' `length` is that of the cutting part.
fn tool(entry: &Value) -> ToolDescription {
    let unit = unit_of(entry);
    let length = number(entry, "length")
        .map(|value| value * unit)
        .filter(|value| *value > 0.0);
    let diameter = number(entry, "diameter")
        .map(|value| value * unit)
        .filter(|value| *value > 0.0);
    let shape = string(entry, "shape").unwrap_or_default();
    let kind = match shape.as_str() {
        "cylindrical" => CutterKind::Flat,
        "ballnose" => CutterKind::Ball,
        "conical" | "snubnose" => CutterKind::Chamfer,
        _ => CutterKind::Other(shape),
    };
    let mut tool = ToolDescription::new(kind);
    tool.name = string(entry, "description");
    tool.flute_length = length;
    tool.diameter = diameter;
    tool.tip_diameter = number(entry, "snub_diameter")
        .map(|value| value * unit)
        .filter(|value| *value > 0.0);
    if tool.kind == Some(CutterKind::Chamfer)
        && let (Some(length), Some(diameter)) = (length, diameter)
    {
        // The cone reaches its diameter at its whole length.
        let tip = tool.tip_diameter.unwrap_or(0.0);
        tool.taper_angle = Some((0.5 * (diameter - tip)).atan2(length).to_degrees());
    }
    tool
}
