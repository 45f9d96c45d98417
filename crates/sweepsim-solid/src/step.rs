//! STEP files (ISO 10303-21) of solids: application protocol 214, advanced boundary representations, in millimetres.

use crate::edges::{Curve, Edge};
use crate::parts::Face;
use crate::solid::Solid;
use crate::surface::{EllipticSheet, Surface, TensorSpline};
use nalgebra::Vector3;
use std::collections::BTreeMap;
use std::io::{self, Write};
use sweepsim_dexel::AnalyticSurface as A;

/// What the file says of itself.
#[derive(Clone, Debug, Default)]
pub struct StepHeader {
    /// The name of the product.
    pub name: String,
    /// What has written it.
    pub program: String,
    /// How near points have to be to count as one, in millimetres.
    pub uncertainty: f64,
}

/// Writes the bodies of a solid. Lengths are millimetres.
///
/// The bytes depend on nothing but the solid and the header: there is no date.
///
/// # Errors
/// Those of the writer.
pub fn write_step(solid: &Solid, header: &StepHeader, out: &mut dyn Write) -> io::Result<()> {
    let (name, program) = (text(&header.name), text(&header.program));
    writeln!(out, "ISO-10303-21;\nHEADER;")?;
    writeln!(out, "FILE_DESCRIPTION(('lengths in millimetres'),'2;1');")?;
    writeln!(
        out,
        "FILE_NAME('{name}','1970-01-01T00:00:00',(''),(''),'{program}','{program}','');"
    )?;
    writeln!(out, "FILE_SCHEMA(('AUTOMOTIVE_DESIGN {{ 1 0 10303 214 1 1 1 1 }}'));")?;
    writeln!(out, "ENDSEC;\nDATA;")?;
    let mut file = Entities {
        out,
        last: 0,
        vertices: BTreeMap::new(),
        edges: BTreeMap::new(),
    };
    let context = file.add("APPLICATION_CONTEXT('core data for automotive mechanical design processes')")?;
    file.add(&format!(
        "APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,#{context})"
    ))?;
    let of_product = file.add(&format!("PRODUCT_CONTEXT('',#{context},'mechanical')"))?;
    let product = file.add(&format!("PRODUCT('{name}','{name}','',(#{of_product}))"))?;
    file.add(&format!("PRODUCT_RELATED_PRODUCT_CATEGORY('part','',(#{product}))"))?;
    let formation = file.add(&format!("PRODUCT_DEFINITION_FORMATION('','',#{product})"))?;
    let of_definition = file.add(&format!(
        "PRODUCT_DEFINITION_CONTEXT('part definition',#{context},'design')"
    ))?;
    let definition = file.add(&format!(
        "PRODUCT_DEFINITION('design','',#{formation},#{of_definition})"
    ))?;
    let shape = file.add(&format!("PRODUCT_DEFINITION_SHAPE('','',#{definition})"))?;
    let length = file.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))")?;
    let angle = file.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))")?;
    let space = file.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())")?;
    let near = real(header.uncertainty);
    let near = file.add(&format!(
        "UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE({near}),#{length},'distance_accuracy_value','')"
    ))?;
    let units = file.add(&format!(
        "(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#{near}))\
         GLOBAL_UNIT_ASSIGNED_CONTEXT((#{length},#{angle},#{space}))REPRESENTATION_CONTEXT('',''))"
    ))?;
    let mut items = vec![file.placement(Vector3::zeros(), Vector3::z(), Vector3::x())?];
    for body in &solid.bodies {
        let outer = file.shell(solid, &body.faces)?;
        if body.hollows.is_empty() {
            items.push(file.add(&format!("MANIFOLD_SOLID_BREP('{name}',#{outer})"))?);
            continue;
        }
        let mut hollows = Vec::new();
        for hollow in &body.hollows {
            let shell = file.shell(solid, hollow)?;
            hollows.push(file.add(&format!("ORIENTED_CLOSED_SHELL('',*,#{shell},.T.)"))?);
        }
        let hollows = list(&hollows);
        items.push(file.add(&format!("BREP_WITH_VOIDS('{name}',#{outer},{hollows})"))?);
    }
    let items = list(&items);
    let whole = file.add(&format!(
        "ADVANCED_BREP_SHAPE_REPRESENTATION('{name}',{items},#{units})"
    ))?;
    file.add(&format!("SHAPE_DEFINITION_REPRESENTATION(#{shape},#{whole})"))?;
    writeln!(out, "ENDSEC;\nEND-ISO-10303-21;")
}

struct Entities<'a> {
    out: &'a mut dyn Write,
    last: usize,
    vertices: BTreeMap<u32, usize>,
    edges: BTreeMap<u32, usize>,
}

/// A name between quotes: letters of other alphabets become their codes.
fn text(name: &str) -> String {
    let one = |c: char| match c {
        '\'' => "''".to_owned(),
        '\\' => "\\\\".to_owned(),
        ' '..='~' => c.to_string(),
        c if c.is_control() => " ".to_owned(),
        c => format!("\\X4\\{:08X}\\X0\\", u32::from(c)),
    };
    name.chars().map(one).collect()
}

/// A number with a point, as the format wants it.
fn real(value: f64) -> String {
    let text = format!("{:?}", value + 0.0);
    match text.split_once('e') {
        Some((digits, power)) if digits.contains('.') => format!("{digits}E{power}"),
        Some((digits, power)) => format!("{digits}.E{power}"),
        None => text,
    }
}

fn triple(p: Vector3<f64>) -> String {
    format!("({},{},{})", real(p.x), real(p.y), real(p.z))
}

fn list(numbers: &[usize]) -> String {
    let all: Vec<String> = numbers.iter().map(|number| format!("#{number}")).collect();
    format!("({})", all.join(","))
}

fn reals(values: impl Iterator<Item = f64>) -> String {
    let all: Vec<String> = values.map(real).collect();
    format!("({})", all.join(","))
}

impl Entities<'_> {
    fn add(&mut self, record: &str) -> io::Result<usize> {
        self.last += 1;
        writeln!(self.out, "#{}={record};", self.last)?;
        Ok(self.last)
    }

    fn point(&mut self, p: Vector3<f64>) -> io::Result<usize> {
        self.add(&format!("CARTESIAN_POINT('',{})", triple(p)))
    }

    fn direction(&mut self, d: Vector3<f64>) -> io::Result<usize> {
        self.add(&format!("DIRECTION('',{})", triple(d)))
    }

    fn placement(&mut self, origin: Vector3<f64>, axis: Vector3<f64>, x: Vector3<f64>) -> io::Result<usize> {
        let (origin, axis, x) = (self.point(origin)?, self.direction(axis)?, self.direction(x)?);
        self.add(&format!("AXIS2_PLACEMENT_3D('',#{origin},#{axis},#{x})"))
    }

    fn shell(&mut self, solid: &Solid, faces: &[u32]) -> io::Result<usize> {
        let mut numbers = Vec::with_capacity(faces.len());
        for face in faces {
            numbers.push(self.face(solid, &solid.faces[*face as usize])?);
        }
        self.add(&format!("CLOSED_SHELL('',{})", list(&numbers)))
    }

    fn face(&mut self, solid: &Solid, face: &Face) -> io::Result<usize> {
        let mut bounds = Vec::with_capacity(face.loops.len());
        for (k, own) in face.loops.iter().enumerate() {
            let mut uses = Vec::with_capacity(own.len());
            for (number, forward) in own {
                let Some(edge) = &solid.edges[*number as usize] else {
                    continue;
                };
                let edge = self.edge(*number, edge)?;
                let way = if *forward { ".T." } else { ".F." };
                uses.push(self.add(&format!("ORIENTED_EDGE('',*,*,#{edge},{way})"))?);
            }
            let way = self.add(&format!("EDGE_LOOP('',{})", list(&uses)))?;
            let kind = if k == 0 { "FACE_OUTER_BOUND" } else { "FACE_BOUND" };
            bounds.push(self.add(&format!("{kind}('',#{way},.T.)"))?);
        }
        let surface = self.surface(face)?;
        let sense = if face.outward { ".T." } else { ".F." };
        self.add(&format!("ADVANCED_FACE('',{},#{surface},{sense})", list(&bounds)))
    }

    fn surface(&mut self, face: &Face) -> io::Result<usize> {
        let [x, _, z] = face.axes;
        let mut at = |origin: [f64; 3]| self.placement(origin.into(), z, x);
        match &face.surface {
            Surface::Analytic(A::Plane { origin, .. }) => {
                let at = at(*origin)?;
                self.add(&format!("PLANE('',#{at})"))
            }
            Surface::Analytic(A::Cylinder { origin, radius, .. }) => {
                let at = at(*origin)?;
                self.add(&format!("CYLINDRICAL_SURFACE('',#{at},{})", real(*radius)))
            }
            Surface::Analytic(A::Cone { apex, angle, .. }) => {
                // The circle at the far end of the face.
                let height = face.range[1][1];
                let at = at((Vector3::from(*apex) + z * height).into())?;
                let (radius, angle) = (real(height * angle.tan()), real(*angle));
                self.add(&format!("CONICAL_SURFACE('',#{at},{radius},{angle})"))
            }
            Surface::Analytic(A::Sphere { centre, radius }) => {
                let at = at(*centre)?;
                self.add(&format!("SPHERICAL_SURFACE('',#{at},{})", real(*radius)))
            }
            Surface::Analytic(A::Torus {
                centre, major, minor, ..
            }) => {
                let at = at(*centre)?;
                self.add(&format!("TOROIDAL_SURFACE('',#{at},{},{})", real(*major), real(*minor)))
            }
            Surface::Analytic(_) | Surface::Swept(_) => {
                if let Some(spline) = &face.spline {
                    return self.tensor(spline);
                }
                let at = at([0.0; 3])?;
                self.add(&format!("PLANE('',#{at})"))
            }
            Surface::Elliptic(sheet) => self.sheet(sheet, face.range),
        }
    }

    /// A curve across the sheet, a little longer than its face, moved along the rulings.
    fn sheet(&mut self, sheet: &EllipticSheet, [angles, heights]: [[f64; 2]; 2]) -> io::Result<usize> {
        let room = 0.01 * (angles[1] - angles[0]);
        let low = sheet.axes[2] * heights[0];
        let knots = sheet.knots([angles[0] - room, angles[1] + room]);
        let mut points = vec![self.point(sheet.point(knots[0], 0.0) + low)?];
        for pair in knots.windows(2) {
            let third = (pair[1] - pair[0]) / 3.0;
            points.push(self.point(sheet.point(pair[0], 0.0) + sheet.speed(pair[0]) * third + low)?);
            points.push(self.point(sheet.point(pair[1], 0.0) - sheet.speed(pair[1]) * third + low)?);
        }
        points.push(self.point(sheet.point(knots[knots.len() - 1], 0.0) + low)?);
        let curve = self.spline(&points, &knots)?;
        let along = self.direction(sheet.axes[2])?;
        let vector = self.add(&format!("VECTOR('',#{along},1.)"))?;
        self.add(&format!("SURFACE_OF_LINEAR_EXTRUSION('',#{curve},#{vector})"))
    }

    /// A cubic spline with double knots.
    fn spline(&mut self, points: &[usize], knots: &[f64]) -> io::Result<usize> {
        let (points, count) = (list(points), multiplicities(knots.len()));
        let knots = reals(knots.iter().copied());
        self.add(&format!(
            "B_SPLINE_CURVE_WITH_KNOTS('',3,{points},.UNSPECIFIED.,.F.,.F.,{count},{knots},.UNSPECIFIED.)"
        ))
    }

    /// A bicubic spline with double knots.
    fn tensor(&mut self, spline: &TensorSpline) -> io::Result<usize> {
        let mut rows = Vec::with_capacity(spline.points.len());
        for row in &spline.points {
            let points = row.iter().map(|p| self.point(*p)).collect::<io::Result<Vec<usize>>>()?;
            rows.push(list(&points));
        }
        let counts = [0, 1].map(|k| multiplicities(spline.knots[k].len()));
        let knots = [0, 1].map(|k: usize| reals(spline.knots[k].iter().copied()));
        self.add(&format!(
            "B_SPLINE_SURFACE_WITH_KNOTS('',3,3,({}),.UNSPECIFIED.,.F.,.F.,.F.,{},{},{},{},.UNSPECIFIED.)",
            rows.join(","),
            counts[0],
            counts[1],
            knots[0],
            knots[1]
        ))
    }

    fn vertex(&mut self, number: u32, p: Vector3<f64>) -> io::Result<usize> {
        if let Some(known) = self.vertices.get(&number) {
            return Ok(*known);
        }
        let point = self.point(p)?;
        let vertex = self.add(&format!("VERTEX_POINT('',#{point})"))?;
        self.vertices.insert(number, vertex);
        Ok(vertex)
    }

    fn edge(&mut self, number: u32, edge: &Edge) -> io::Result<usize> {
        if let Some(known) = self.edges.get(&number) {
            return Ok(*known);
        }
        let [from, to] = edge.vertices;
        let from = self.vertex(from, edge.ends[0])?;
        let to = self.vertex(to, edge.ends[1])?;
        let curve = match &edge.curve {
            Curve::Line => {
                let way = edge.ends[1] - edge.ends[0];
                // Not at an end, which may be the tip of a cone.
                let start = self.point((edge.ends[0] + edge.ends[1]) * 0.5)?;
                let along = self.direction(way.try_normalize(0.0).unwrap_or(Vector3::z()))?;
                let vector = self.add(&format!("VECTOR('',#{along},1.)"))?;
                self.add(&format!("LINE('',#{start},#{vector})"))?
            }
            Curve::Circle {
                centre,
                axis,
                towards,
                radius,
                ..
            } => {
                let at = self.placement(*centre, *axis, *towards)?;
                self.add(&format!("CIRCLE('',#{at},{})", real(*radius)))?
            }
            Curve::Ellipse {
                centre,
                axis,
                long,
                half,
                ..
            } => {
                let at = self.placement(*centre, *axis, *long)?;
                self.add(&format!("ELLIPSE('',#{at},{},{})", real(half[0]), real(half[1])))?
            }
            Curve::Spline { points, knots } => {
                let mut numbers = Vec::with_capacity(points.len());
                for p in points {
                    numbers.push(self.point(*p)?);
                }
                self.spline(&numbers, knots)?
            }
        };
        let edge = self.add(&format!("EDGE_CURVE('',#{from},#{to},#{curve},.T.)"))?;
        self.edges.insert(number, edge);
        Ok(edge)
    }
}

/// Of cubic splines with one derivative in common at their knots.
fn multiplicities(knots: usize) -> String {
    let inner = std::iter::repeat_n("2", knots.saturating_sub(2));
    let all: Vec<&str> = ["4"].into_iter().chain(inner).chain(["4"]).collect();
    format!("({})", all.join(","))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_names_are_as_the_format_wants_them() {
        assert_eq!(real(1e-7), "1.E-7");
        assert_eq!(real(-1.5e-7), "-1.5E-7");
        assert_eq!(real(3.0), "3.0");
        assert_eq!(real(-0.0), "0.0");
        assert_eq!(text("it's\n5\\6 ü"), "it''s 5\\\\6 \\X4\\000000FC\\X0\\");
        assert_eq!(multiplicities(2), "(4,4)");
        assert_eq!(multiplicities(4), "(4,2,2,4)");
    }
}
