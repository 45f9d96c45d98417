//! 3MF, for additive manufacturing: millimetres, one object. Numbers in the shortest form that reads back to the same bits.

use std::fmt::Write as _;
use std::io::{self, Write};

use sweepsim_dexel::Mesh;

use crate::error::{FormatError, Problem};
use crate::zip::{self, Archive};
use sweepsim_nc::shortest;

const MODEL: &str = "3D/3dmodel.model";
const TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>
"#;
const RELATIONS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>
"#;

/// Writes a mesh. The format wants one whose vertices are shared, as [`TriDexels::surface`](sweepsim_dexel::TriDexels::surface) gives it.
///
/// # Errors
/// What the writer says; a triangle of vertices that the mesh does not have; more than 4 GiB.
pub fn write_3mf(mesh: &Mesh, writer: &mut impl Write) -> io::Result<()> {
    let count = mesh.vertices.len();
    if mesh.triangles.iter().flatten().any(|v| *v as usize >= count) {
        return Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "a triangle without its vertices",
        ));
    }
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
        ("_rels/.rels", RELATIONS.into()),
        (MODEL, text.into_bytes()),
    ];
    zip::write(&entries, writer)
}

/// Reads the mesh of a file that [`write_3mf`] wrote: archives that are not compressed, one object, without transformations.
///
/// # Errors
/// [`FormatError`]: no such archive, units other than millimetres, several objects, numbers that are none, triangles of vertices that are not there.
pub fn read_3mf(bytes: &[u8]) -> Result<Mesh, FormatError> {
    let problem = |message: &str| FormatError::new(Problem::syntax(message), None);
    let archive = Archive::read(bytes)?;
    let text = std::str::from_utf8(archive.file(MODEL)?).map_err(|_| problem("the model of this 3MF is no UTF-8"))?;
    let mut mesh = Mesh::default();
    let mut objects = 0;
    for tag in text.split('<').skip(1).filter_map(|rest| rest.split('>').next()) {
        let name = tag
            .split(|c: char| c.is_whitespace() || c == '/')
            .next()
            .unwrap_or_default();
        let value = |key: &str| -> Option<&str> {
            let start = tag.find(&format!(" {key}=\""))? + key.len() + 3;
            tag[start..].split('"').next()
        };
        match name {
            "model" if !matches!(value("unit"), None | Some("millimeter")) => {
                return Err(problem("the unit of this 3MF is not millimetre"));
            }
            "object" => objects += 1,
            "components" => return Err(problem("this 3MF has components: expected one mesh")),
            "item" if value("transform").is_some() => {
                return Err(problem("this 3MF has transformations: expected one mesh as it is"));
            }
            "vertex" => {
                let [x, y, z] = ["x", "y", "z"].map(|key| value(key)?.parse::<f64>().ok().filter(|c| c.is_finite()));
                match (x, y, z) {
                    (Some(x), Some(y), Some(z)) => mesh.vertices.push([x, y, z]),
                    _ => return Err(problem("a vertex of this 3MF has not three finite numbers")),
                }
            }
            "triangle" => {
                let corner = |key| {
                    value(key)?
                        .parse::<u32>()
                        .ok()
                        .filter(|v| (*v as usize) < mesh.vertices.len())
                };
                match ["v1", "v2", "v3"].map(corner) {
                    [Some(a), Some(b), Some(c)] => mesh.triangles.push([a, b, c]),
                    _ => return Err(problem("a triangle of this 3MF has not three vertices that there are")),
                }
            }
            _ => {}
        }
    }
    if objects == 1 && text.trim_end().ends_with("</model>") {
        Ok(mesh)
    } else {
        Err(problem("this 3MF has not one whole object"))
    }
}
