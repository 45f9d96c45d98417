//! Tool libraries of Fusion 360 and HSM, as JSON.

use serde_json::Value;

use super::json::{measure, number, string, tool_number};
use super::library::ToolLibrary;
use crate::model::program::Note;
use crate::model::tool::{CutterKind, HolderSegment, ToolDescription};

/// Names of measures, and of the expressions that override them.
const EXPRESSIONS: [(&str, &str); 12] = [
    ("DC", "tool_diameter"),
    ("RE", "tool_cornerRadius"),
    ("TA", "tool_taperAngle"),
    ("SIG", "tool_tipAngle"),
    ("tip-diameter", "tool_tipDiameter"),
    ("LCF", "tool_fluteLength"),
    ("shoulder-length", "tool_shoulderLength"),
    ("shoulder-diameter", "tool_shoulderDiameter"),
    ("SFDM", "tool_shaftDiameter"),
    ("LB", "tool_bodyLength"),
    ("OAL", "tool_overallLength"),
    ("neck-diameter", "tool_neckDiameter"),
];

/// Millimetres per unit of a library, and a note if it is none that is known.
fn unit_of(value: &Value) -> (f64, Option<String>) {
    match value.get("unit") {
        Some(Value::String(unit)) => match unit.as_str() {
            "inches" | "inch" | "in" => (25.4, None),
            "millimeters" | "millimeter" | "millimetres" | "mm" => (1.0, None),
            unit => (
                1.0,
                Some(format!("the unit {unit:?} is not known: taken as millimeters")),
            ),
        },
        _ => (1.0, None),
    }
}

pub(super) fn read(value: &Value) -> ToolLibrary {
    let mut library = ToolLibrary::default();
    let entries = value.get("data").and_then(Value::as_array);
    for (index, entry) in entries.into_iter().flatten().enumerate() {
        let kind = string(entry, "type").unwrap_or_default();
        // Holders and probes of a library are entries of their own; a holder comes with each tool that uses it.
        if kind == "holder" || kind.is_empty() {
            continue;
        }
        let process = entry.get("post-process");
        let mut tool = one(entry, &kind);
        library
            .notes
            .extend(tool.notes.iter().map(|note| Note::new(0, note.clone())));
        tool.name = tool.name.or_else(|| string(entry, "product-id"));
        let number = process
            .and_then(|process| process.get("number"))
            .or_else(|| entry.get("number"))
            .and_then(tool_number);
        match number {
            Some(number) => library.add(number, tool),
            None => library.notes.push(Note::new(
                0,
                format!("entry {} of the library has no tool number: ignored", index + 1),
            )),
        }
    }
    library
}

fn one(entry: &Value, kind: &str) -> ToolDescription {
    let (unit, note) = unit_of(entry);
    let mut notes = Vec::from_iter(note);
    let empty = Value::Null;
    let geometry = entry.get("geometry").unwrap_or(&empty);
    let expressions = entry.get("expressions").unwrap_or(&empty);
    let mut get = |name: &str, is_length: bool| -> Option<f64> {
        let factor = if is_length { unit } else { 1.0 };
        let expression = EXPRESSIONS
            .iter()
            .find(|(own, _)| *own == name)
            .and_then(|(_, expression)| string(expressions, expression));
        if let Some(text) = expression {
            match measure(&text, factor) {
                Some(value) => return Some(value),
                None => notes.push(format!(
                    "the expression {text:?} is not evaluated: the library's number is used"
                )),
            }
        }
        number(geometry, name).map(|value| value * factor)
    };
    let positive = |value: Option<f64>| value.filter(|value| *value > 0.0);
    let diameter = positive(get("DC", true));
    let corner = get("RE", true);
    let kind = kind_of(kind, corner);
    let mut tool = ToolDescription::new(kind);
    tool.name = string(entry, "description");
    tool.diameter = diameter;
    tool.corner_radius = positive(corner);
    tool.tip_diameter = positive(get("tip-diameter", true));
    tool.taper_angle = positive(get("TA", false));
    tool.point_angle = positive(get("SIG", false));
    tool.flute_length = positive(get("LCF", true));
    tool.neck_diameter = positive(get("neck-diameter", true));
    tool.shoulder_length = positive(get("shoulder-length", true));
    tool.shoulder_diameter = positive(get("shoulder-diameter", true));
    tool.shank_diameter = positive(get("SFDM", true));
    tool.stick_out = positive(get("LB", true));
    tool.overall_length = positive(get("OAL", true));
    // A ball-ended tapered mill has its radius as the corner; its tip is the ball.
    if tool.kind == Some(CutterKind::Tapered)
        && let (Some(tip), None) = (tool.tip_diameter, tool.corner_radius)
    {
        tool.diameter = Some(tip);
    }
    if let (Some(CutterKind::Flat | CutterKind::Bull), Some(angle)) = (&tool.kind, tool.taper_angle) {
        notes.push(format!(
            "its taper angle of {angle} degrees is not looked at: taken as a cylinder"
        ));
    }
    if let Some(holder) = entry.get("holder") {
        let (unit, note) = unit_of(holder);
        notes.extend(note.map(|note| format!("its holder: {note}")));
        tool.holder_name = string(holder, "description");
        let segments = holder.get("segments").and_then(Value::as_array);
        tool.holder = segments
            .into_iter()
            .flatten()
            .map(|segment| {
                let length = |name| number(segment, name).unwrap_or(0.0) * unit;
                HolderSegment {
                    height: length("height"),
                    lower_diameter: length("lower-diameter"),
                    upper_diameter: length("upper-diameter"),
                }
            })
            .collect();
    }
    tool.notes = notes;
    tool
}

/// The kind of a tool by its name in Fusion. Face and slot mills with a corner radius are bull-nosed.
pub(super) fn kind_of(kind: &str, corner: Option<f64>) -> CutterKind {
    let lower = kind.to_ascii_lowercase();
    let has = |word: &str| lower.contains(word);
    match lower.as_str() {
        _ if has("ball") => CutterKind::Ball,
        _ if has("bull") => CutterKind::Bull,
        _ if has("tapered") => CutterKind::Tapered,
        _ if has("chamfer") || has("countersink") || has("counter sink") || has("engrav") => CutterKind::Chamfer,
        _ if has("lollipop") => CutterKind::Lollipop,
        _ if has("dovetail") => CutterKind::Dovetail,
        _ if has("tap ") || has("thread") || has("form") || has("probe") || has("turning") || has("radius mill") => {
            CutterKind::Other(kind.to_owned())
        }
        _ if has("drill") => CutterKind::Drill,
        _ if has("flat") || has("face") || has("slot") || has("reamer") || has("bor") => match corner {
            Some(radius) if radius > 0.0 => CutterKind::Bull,
            _ => CutterKind::Flat,
        },
        _ => CutterKind::Other(kind.to_owned()),
    }
}
