//! A STEP file in words.

use super::Description;
use crate::base::words::{count, counted, measure};
use crate::show::soup;
use sweepsim_formats::StepPart;

/// The most bodies that are listed.
const MOST_BODIES: usize = 40;

pub(super) fn step(text: &mut Description, part: &StepPart) {
    text.line("schema", &part.schemas.join(", "));
    let unit = match part.unit {
        1.0 => "millimetres".to_owned(),
        25.4 => "inches".to_owned(),
        1000.0 => "metres".to_owned(),
        other => format!("{other} mm"),
    };
    text.line("units", &unit);
    for (number, body) in part.bodies.iter().enumerate() {
        if number == MOST_BODIES {
            text.line("", &format!("and {} more", count((part.bodies.len() - number) as u64)));
            break;
        }
        let faces: Vec<String> = body
            .faces
            .iter()
            .map(|(kind, number)| counted(*number as u64, kind))
            .collect();
        let name = if body.name.is_empty() {
            "without a name"
        } else {
            &body.name
        };
        let volume = body
            .volume
            .map_or(String::new(), |volume| format!(", {} mm³", measure(volume)));
        let kind = if body.solid { "solid" } else { "sheet" };
        text.line(kind, &format!("#{} {name}: {}{volume}", body.entity, faces.join(", ")));
    }
    let volume: f64 = part.bodies.iter().filter_map(|body| body.volume).sum();
    text.line("volume", &format!("{} mm³, by the surfaces", measure(volume)));
    let named = part.faces.iter().filter(|face| face.name.is_some()).count();
    let coloured = part.faces.iter().filter(|face| face.colour.is_some()).count();
    let faces = counted(part.faces.len() as u64, "face");
    let (named, coloured) = (count(named as u64), count(coloured as u64));
    text.line(
        "faces",
        &format!("{faces}, {named} with a name, {coloured} with a colour"),
    );
    text.bounds(part.mesh.vertices.iter().copied());
    let triangles = counted(part.mesh.triangles.len() as u64, "triangle");
    let (chord, found) = (measure(part.chord), part.deviation);
    text.line(
        "mesh",
        &format!("{triangles}, for {chord} mm; the largest distance from a face found is {found:.1e} mm"),
    );
    match soup(&part.mesh).check_closed() {
        Ok(()) => text.line("closed", "yes"),
        Err(error) => text.line("closed", &format!("no: {error}")),
    }
    for note in &part.notes {
        text.line("note", note);
    }
}
