//! 3MF, for additive manufacturing. Written in millimetres as one object, with numbers in the shortest form that reads
//! back exactly.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::{self, Write};

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use sweepsim_dexel::Mesh;

use super::colours::{self, Colour, Colours};
use crate::archive::{self, Archive};
use crate::error::{FormatError, Problem};
use sweepsim_nc::shortest;

const MODEL: &str = "3D/3dmodel.model";
const RELATIONS_ENTRY: &str = "_rels/.rels";
const TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>
"#;
const RELATIONS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>
"#;

/// Writes a mesh. 3MF needs triangles that share vertices, as
/// [`TriDexels::surface`](sweepsim_dexel::TriDexels::surface) makes them.
///
/// # Errors
/// Those of the writer; a triangle with missing vertices.
pub fn write_3mf(mesh: &Mesh, writer: &mut (impl Write + ?Sized)) -> io::Result<()> {
    super::check_triangles(mesh)?;
    let mut text = String::from(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources><object id="1" type="model"><mesh><vertices>
"#,
    );
    for v in &mesh.vertices {
        let [x, y, z] = v.map(shortest);
        let _ = writeln!(text, r#"<vertex x="{x}" y="{y}" z="{z}"/>"#);
    }
    text.push_str("</vertices><triangles>\n");
    for [a, b, c] in &mesh.triangles {
        let _ = writeln!(text, r#"<triangle v1="{a}" v2="{b}" v3="{c}"/>"#);
    }
    text.push_str("</triangles></mesh></object></resources><build><item objectid=\"1\"/></build></model>\n");
    let entries = [
        ("[Content_Types].xml", TYPES.into()),
        (RELATIONS_ENTRY, RELATIONS.into()),
        (MODEL, text.into_bytes()),
    ];
    archive::write(&entries, writer)
}

/// Reads the mesh of a file with one object, without components or transformations. The archive may be compressed.
/// Lengths are converted to millimetres.
///
/// # Errors
/// [`FormatError`]: not an archive, or one without a model; several objects, components or transformations; vertices
/// that are not finite; triangles with missing vertices.
pub fn read_3mf(bytes: &[u8]) -> Result<Mesh, FormatError> {
    coloured_3mf(bytes).map(|(mesh, _)| mesh)
}

/// Reads a mesh with the colour of each triangle: that of its base material or its colour group, if all its corners
/// have the same.
pub(crate) fn coloured_3mf(bytes: &[u8]) -> Result<(Mesh, Colours), FormatError> {
    let mut archive = Archive::read(bytes)?;
    let model = model_entry(&mut archive)?;
    let text = text(archive.entry(&model)?)?;
    let mut reader = Reader::from_str(&text);
    let mut model = Model::default();
    loop {
        match reader.read_event().map_err(|error| xml_problem(&error))? {
            Event::Start(tag) | Event::Empty(tag) => model.tag(&tag)?,
            Event::End(tag) if tag.local_name().as_ref() == "model" => model.complete = true,
            Event::Eof => break,
            _ => {}
        }
    }
    if model.objects == 1 && model.complete {
        Ok((model.mesh, model.colours))
    } else {
        Err(problem("this 3MF does not have exactly one complete object"))
    }
}

fn problem(message: impl Into<String>) -> FormatError {
    FormatError::new(Problem::syntax(message), None)
}

fn text(bytes: Vec<u8>) -> Result<String, FormatError> {
    String::from_utf8(bytes).map_err(|_| problem("the XML of this 3MF is not UTF-8"))
}

fn xml_problem(error: &dyn std::error::Error) -> FormatError {
    problem(format!("the XML of this 3MF is invalid: {error}"))
}

/// The name of the archive's entry with the model: as the relationships say, or the usual one.
fn model_entry(archive: &mut Archive<'_>) -> Result<String, FormatError> {
    if !archive.has(RELATIONS_ENTRY) {
        return Ok(MODEL.to_owned());
    }
    let text = text(archive.entry(RELATIONS_ENTRY)?)?;
    let mut reader = Reader::from_str(&text);
    loop {
        match reader.read_event().map_err(|error| xml_problem(&error))? {
            Event::Start(tag) | Event::Empty(tag) if tag.local_name().as_ref() == "Relationship" => {
                let kind = attribute(&tag, "Type")?.unwrap_or_default();
                if let (true, Some(target)) = (kind.ends_with("/3dmodel"), attribute(&tag, "Target")?) {
                    return Ok(target.trim_start_matches('/').to_owned());
                }
            }
            Event::Eof => return Ok(MODEL.to_owned()),
            _ => {}
        }
    }
}

/// The value of an attribute.
fn attribute(tag: &BytesStart<'_>, name: &str) -> Result<Option<String>, FormatError> {
    for attribute in tag.attributes().with_checks(false) {
        let attribute = attribute.map_err(|error| xml_problem(&error))?;
        if attribute.key.as_ref() == name {
            let value = quick_xml::escape::unescape(&attribute.value).map_err(|error| xml_problem(&error))?;
            return Ok(Some(value.into_owned()));
        }
    }
    Ok(None)
}

/// The model as far as it has been read.
#[derive(Default)]
struct Model {
    mesh: Mesh,
    /// Millimetres per unit of the file.
    unit: f64,
    objects: usize,
    complete: bool,
    /// The colours of each group, by its number.
    groups: BTreeMap<String, Vec<Option<Colour>>>,
    /// The group that is being read.
    group: String,
    /// Group and place of the object's own colour.
    own: (Option<String>, Option<String>),
    colours: Colours,
}

impl Model {
    fn tag(&mut self, tag: &BytesStart<'_>) -> Result<(), FormatError> {
        match tag.local_name().as_ref() {
            "model" => self.unit = unit(attribute(tag, "unit")?.as_deref())?,
            "object" => {
                self.objects += 1;
                self.own = (attribute(tag, "pid")?, attribute(tag, "pindex")?);
            }
            "basematerials" | "colorgroup" => {
                self.group = attribute(tag, "id")?.unwrap_or_default();
                self.groups.entry(self.group.clone()).or_default();
            }
            name @ ("base" | "color") => {
                let value = attribute(tag, if name == "base" { "displaycolor" } else { "color" })?;
                let colour = value.as_deref().and_then(colours::parsed);
                self.groups.entry(self.group.clone()).or_default().push(colour);
            }
            "components" => return Err(problem("this 3MF has components: expected one mesh")),
            "item" if attribute(tag, "transform")?.is_some() => {
                return Err(problem("this 3MF has transformations: expected one mesh as it is"));
            }
            "vertex" => {
                let mut vertex = [0.0; 3];
                for (coordinate, name) in vertex.iter_mut().zip(["x", "y", "z"]) {
                    let value = attribute(tag, name)?.and_then(|text| text.trim().parse::<f64>().ok());
                    let value = value.map(|value| value * self.unit).filter(|value| value.is_finite());
                    *coordinate =
                        value.ok_or_else(|| problem("a vertex of this 3MF does not have three finite coordinates"))?;
                }
                self.mesh.vertices.push(vertex);
            }
            "triangle" => {
                let mut triangle = [0; 3];
                for (corner, name) in triangle.iter_mut().zip(["v1", "v2", "v3"]) {
                    let index = attribute(tag, name)?.and_then(|text| text.trim().parse::<u32>().ok());
                    let index = index.filter(|v| (*v as usize) < self.mesh.vertices.len());
                    *corner = index.ok_or_else(|| problem("a triangle of this 3MF refers to a missing vertex"))?;
                }
                self.mesh.triangles.push(triangle);
                let colour = self.colour(tag)?;
                self.colours.push(colour);
            }
            _ => {}
        }
        Ok(())
    }
}

impl Model {
    /// The colour of a triangle.
    fn colour(&self, tag: &BytesStart<'_>) -> Result<Option<Colour>, FormatError> {
        if self.groups.is_empty() {
            return Ok(None);
        }
        let group = attribute(tag, "pid")?.or_else(|| self.own.0.clone());
        let first = attribute(tag, "p1")?;
        for other in ["p2", "p3"] {
            if attribute(tag, other)?.is_some_and(|other| Some(other) != first) {
                return Ok(None);
            }
        }
        let (group, place) = (group.as_deref(), first.or_else(|| self.own.1.clone()));
        let place = place.and_then(|place| place.trim().parse::<usize>().ok());
        let colours = group.and_then(|group| self.groups.get(group));
        Ok(colours.zip(place).and_then(|(colours, place)| *colours.get(place)?))
    }
}

/// Millimetres per unit; without a unit 3MF is in millimetres.
fn unit(name: Option<&str>) -> Result<f64, FormatError> {
    Ok(match name {
        None | Some("millimeter") => 1.0,
        Some("micron") => 1e-3,
        Some("centimeter") => 10.0,
        Some("inch") => 25.4,
        Some("foot") => 304.8,
        Some("meter") => 1000.0,
        Some(other) => {
            let expected = "micron, millimeter, centimeter, inch, foot or meter";
            return Err(FormatError::new(
                Problem::value("the unit of this 3MF", format!("{other:?}"), expected),
                None,
            ));
        }
    })
}
