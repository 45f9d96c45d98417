//! Tool bits (`.fctb`) and libraries (`.fctl`) of FreeCAD.

use std::path::Path;

use serde_json::Value;

use super::json::{self, measure, string, tool_number};
use super::library::ToolLibrary;
use crate::model::program::Note;
use crate::model::tool::{CutterKind, ToolDescription};
use crate::text::error::{NcError, NcProblem};

/// A tool bit.
pub(super) fn bit(value: &Value) -> ToolDescription {
    let empty = Value::Null;
    let parameters = value.get("parameter").unwrap_or(&empty);
    let get = |name: &str| {
        let found = parameters.get(name)?;
        let value = found.as_f64().or_else(|| measure(found.as_str()?, 1.0))?;
        (value.is_finite() && value > 0.0).then_some(value)
    };
    let shape = string(value, "shape-type")
        .or_else(|| string(value, "shape"))
        .unwrap_or_default();
    let shape = shape.trim_end_matches(".fcstd").to_ascii_lowercase();
    let kind = match shape.as_str() {
        "endmill" | "reamer" => CutterKind::Flat,
        "ballend" => CutterKind::Ball,
        "bullnose" | "torus" => CutterKind::Bull,
        "drill" => CutterKind::Drill,
        "chamfer" | "v-bit" | "vbit" => CutterKind::Chamfer,
        "taperedballnose" | "tapered-ball-nose" => CutterKind::Tapered,
        "dovetail" => CutterKind::Dovetail,
        "slittingsaw" => CutterKind::Flat,
        _ => CutterKind::Other(shape.clone()),
    };
    let mut tool = ToolDescription::new(kind);
    tool.name = string(value, "name");
    tool.diameter = get("Diameter");
    tool.corner_radius = get("FlatRadius").or_else(|| get("CornerRadius"));
    tool.tip_diameter = get("TipDiameter");
    tool.point_angle = get("TipAngle");
    tool.flute_length = get("CuttingEdgeHeight").or_else(|| get("BladeThickness"));
    tool.neck_diameter = get("NeckDiameter");
    tool.shank_diameter = get("ShankDiameter").or_else(|| get("ShaftDiameter"));
    tool.overall_length = get("Length");
    match shape.as_str() {
        // FreeCAD gives the angle between the flanks.
        "chamfer" | "v-bit" | "vbit" => {
            tool.taper_angle = get("CuttingEdgeAngle").map(|angle| 0.5 * angle);
        }
        "taperedballnose" | "tapered-ball-nose" => {
            tool.taper_angle = get("TaperAngle").map(|angle| 0.5 * angle);
            tool.diameter = get("TipDiameter").or_else(|| get("Diameter"));
            tool.corner_radius = tool.diameter.map(|diameter| 0.5 * diameter);
        }
        // A drill cuts along its whole length, as far as FreeCAD describes it.
        "drill" => tool.flute_length = tool.flute_length.or(tool.overall_length),
        // The boss below the blade of a saw does not cut; the tip is the blade's lower face.
        "slittingsaw" => tool.shoulder_length = None,
        _ => {}
    }
    tool
}

/// A library: numbers, and the files of their bits, in the folder of the library, or in `Bit` beside that folder.
pub(super) fn library(value: &Value, file: &Path) -> Result<ToolLibrary, NcError> {
    let mut library = ToolLibrary::default();
    let folder = file.parent().unwrap_or(Path::new(""));
    let beside = folder.parent().unwrap_or(Path::new("..")).join("Bit");
    for entry in value.get("tools").and_then(Value::as_array).into_iter().flatten() {
        let number = entry.get("nr").and_then(tool_number);
        let (Some(number), Some(path)) = (number, string(entry, "path")) else {
            library
                .notes
                .push(Note::new(0, "an entry of the library without `nr` or `path`: ignored"));
            continue;
        };
        let found = [folder.join(&path), beside.join(&path)]
            .into_iter()
            .find(|file| file.is_file());
        let Some(found) = found else {
            let problem = NcProblem::value(
                format!("the file of tool {number}"),
                format!("{path:?}"),
                format!("a file in {} or {}", folder.display(), beside.display()),
            );
            return Err(NcError::new(problem, None));
        };
        let text = crate::text::whole::text(&found)
            .map_err(|error| NcError::new(NcProblem::Read(error), None).in_file(&found))?;
        let tool = json::parse(&text).map_err(|error| error.in_file(&found))?;
        library.add(number, bit(&tool));
    }
    Ok(library)
}
