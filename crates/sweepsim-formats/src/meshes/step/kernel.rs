//! Reads a STEP file through the library: scan, audit, build, and what is checked of the result.

use std::any::Any;
use std::collections::{BTreeMap, BTreeSet};
use std::thread;

use kentron::io::step;
use kentron::topology::Model;
use sweepsim_dexel::{MeshError, TriangleSoup};

use super::scan::{Scan, at};
use super::styles::{FileBody, FileFace};
use super::{StepBody, StepFace, StepPart, audit, build, copies, seams, styles, units};
use crate::error::{FormatError, Problem};

/// The stack of the thread that reads: the library follows references one call within another.
const STACK: usize = 64 << 20;

/// How many times farther than asked triangles may be from the surfaces.
const FAR: f64 = 20.0;
/// The error of a volume that is integrated over surfaces, as a share of it.
const INEXACT: f64 = 1e-4;

/// Reads a file on a thread of its own, so that a panic of the library ends that thread only.
pub(super) fn parse(text: &[u8], chord: f64) -> Result<StepPart, FormatError> {
    let problem = |message: String| FormatError::new(Problem::syntax(message), None);
    thread::scope(|scope| {
        let reader = thread::Builder::new().name(super::THREAD.into()).stack_size(STACK);
        let reader = reader.spawn_scoped(scope, || read(text, chord));
        let reader = reader.map_err(|error| problem(format!("no thread to read this STEP file: {error}")))?;
        reader.join().unwrap_or_else(|panic| {
            let reason = words(&*panic);
            Err(problem(format!(
                "the reader of STEP files failed at this one ({reason}): expected entities with attributes as their schema has them"
            )))
        })
    })
}

/// What a panic says.
fn words(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned())
        .unwrap_or_default()
}

fn read(text: &[u8], chord: f64) -> Result<StepPart, FormatError> {
    let scan = Scan::new(text)?;
    let refused = |(number, message): audit::Refused| match scan.place(number) {
        Some(place) => at(text, place, message),
        None => FormatError::new(Problem::syntax(message), None),
    };
    let rewritten = scan.rewritten(text)?;
    let failed = |error: &kentron::Error| error_at(&scan, text, &error.to_string(), None);
    let exchange = step::exchange_of(&rewritten).map_err(|error| failed(&error))?;
    let unit = units::length(&exchange).map_err(refused)?;
    audit::check(&exchange).map_err(refused)?;
    let copies = copies::count(&exchange).map_err(refused)?;
    let (file_bodies, file_faces) = styles::bodies(&exchange);
    audit::open_solid(&exchange, &file_bodies, &file_faces).map_err(refused)?;

    let rewritten = with_product(rewritten, &exchange, &file_bodies);
    let mut model = Model::default();
    let roots = step::read_assembly(&mut model, &mut &rewritten[..])
        .map_err(|error| error_at(&scan, text, &error.to_string(), Some(&exchange)))?;
    seams::add(&mut model, &roots, &exchange).map_err(|error| failed(&error))?;
    let build::Found {
        bodies: placed,
        deviation,
        gap,
        ..
    } = build::bodies(&model, &roots, chord).map_err(|message| error_at(&scan, text, &message, None))?;

    let reached: BTreeSet<usize> = placed.iter().flat_map(|body| &body.faces).copied().collect();
    if let Some((face, of)) = file_faces.iter().find(|(face, _)| !reached.contains(face)) {
        let body = &file_bodies[of.body];
        let message = format!("no product places #{}: its face #{face} would be missing", body.number);
        return Err(refused((body.number, message)));
    }
    if placed.is_empty() {
        let message = format!(
            "no solid and no surface is in this STEP file ({})",
            scan.schemas.join(", ")
        );
        return Err(at(text, 0..1, message));
    }
    let file = File {
        scan: &scan,
        text,
        bodies: &file_bodies,
        faces: &file_faces,
    };
    file.part(
        placed,
        gap,
        StepPart {
            schemas: scan.schemas.clone(),
            unit,
            chord,
            deviation,
            notes: tessellated(copies),
            ..StepPart::default()
        },
    )
}

/// What is said of tessellated solids that are beside boundary representations of the same parts.
fn tessellated(copies: usize) -> Vec<String> {
    match copies {
        0 => Vec::new(),
        1 => vec!["left out: a tessellated solid, as its part has a boundary representation".into()],
        _ => vec![format!(
            "left out: {copies} tessellated solids, as their parts have boundary representations"
        )],
    }
}

/// A file without products has one of all bodies: the library numbers the faces of products only.
fn with_product(mut text: Vec<u8>, x: &step::Exchange, bodies: &[FileBody]) -> Vec<u8> {
    let end = text.windows(7).rposition(|words| words == b"ENDSEC;");
    let (Some(end), Some(last), None) = (end, x.ids().max(), x.of_type("PRODUCT_DEFINITION").next()) else {
        return text;
    };
    let items: Vec<String> = bodies.iter().map(|body| format!("#{}", body.number)).collect();
    let [a, b, c, d, e, f] = [1, 2, 3, 4, 5, 6].map(|k| last.saturating_add(k));
    let product = format!(
        "#{a}=PRODUCT('','','',());#{b}=PRODUCT_DEFINITION_FORMATION('','',#{a});#{c}=PRODUCT_DEFINITION('','',#{b},$);\
         #{d}=PRODUCT_DEFINITION_SHAPE('','',#{c});#{e}=SHAPE_REPRESENTATION('',({}),$);\
         #{f}=SHAPE_DEFINITION_REPRESENTATION(#{d},#{e});\n",
        items.join(",")
    );
    text.splice(end..end, product.into_bytes());
    text
}

/// An error of the library, at the entity that it names. An entity that is missing is shown where it is referred to.
fn error_at(scan: &Scan, text: &[u8], message: &str, x: Option<&step::Exchange>) -> FormatError {
    let message = message
        .replace("invalid input: ", "")
        .replace("STEP: ", "")
        .replace("operation failed: ", "");
    let numbers = message.split('#').skip(1).filter_map(|rest| {
        let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
        digits.parse::<usize>().ok()
    });
    let mut numbers: Vec<usize> = numbers.collect();
    let mut message = message;
    if let (Some(x), [missing]) = (x, &numbers[..])
        && scan.place(*missing).is_none()
        && let Some(from) = audit::referring(x, *missing)
    {
        message = format!("#{from} refers to #{missing}, which is not in this file");
        numbers = vec![from];
    }
    match numbers.into_iter().find_map(|number| scan.place(number)) {
        Some(place) => at(text, place, message),
        None => FormatError::new(Problem::syntax(message), None),
    }
}

/// A file with what was found in it.
struct File<'a> {
    scan: &'a Scan,
    text: &'a [u8],
    bodies: &'a [FileBody],
    faces: &'a BTreeMap<usize, FileFace>,
}

impl File<'_> {
    /// Joins the solids, or the sheets where there is no solid. `gap`: between edges and surfaces of the file, where
    /// triangles are farther than asked.
    fn part(&self, placed: Vec<build::Placed>, gap: f64, mut part: StepPart) -> Result<StepPart, FormatError> {
        let any_solid = placed.iter().any(|body| body.solid);
        let mut soup = TriangleSoup::default();
        let mut numbers = Vec::new();
        for body in placed {
            self.check(&body, part.deviation.max(part.chord))?;
            let of_file = body
                .faces
                .first()
                .and_then(|face| Some(&self.bodies[self.faces.get(face)?.body]));
            let own = of_file
                .map(|body| body.name.as_str())
                .filter(|name| !matches!(*name, "" | "NONE"));
            let name = match (own, body.path.as_str()) {
                (Some(own), path) if !path.is_empty() && path.rsplit('/').next() != Some(own) => {
                    format!("{path}/{own}")
                }
                (own, "") => own.unwrap_or_default().to_owned(),
                (_, path) => path.to_owned(),
            };
            let mut kinds: BTreeMap<&'static str, usize> = BTreeMap::new();
            body.kinds
                .values()
                .for_each(|kind| *kinds.entry(kind).or_default() += 1);
            part.bodies.push(StepBody {
                name,
                entity: of_file.map_or(0, |body| body.number),
                solid: body.solid,
                volume: body.volume,
                faces: kinds,
            });
            if body.solid || !any_solid {
                let place = part.bodies.len() - 1;
                self.faces(&body, place, &mut part.faces, &mut numbers);
                soup.triangles.extend(body.soup.triangles);
            } else {
                let count = body.kinds.len();
                part.notes
                    .push(format!("left out: a sheet of {count} faces, as it encloses nothing"));
            }
        }
        if !any_solid {
            part.notes
                .push("no solid: the faces are sheets, which enclose nothing".into());
        }
        if part.deviation > part.chord {
            let (deviation, chord) = (part.deviation, part.chord);
            let found = format!("up to {deviation:.2e} mm from the file's surfaces, where {chord:.2e} mm was asked");
            let why = if gap > 0.5 * deviation {
                format!("edges of the file are up to {gap:.2e} mm from the surfaces that they bound")
            } else {
                "more triangles come little nearer".to_owned()
            };
            if deviation > FAR * chord {
                let message = format!("triangles would be {found} ({why}): expected at most {FAR} times as much");
                return Err(FormatError::new(Problem::syntax(message), None));
            }
            part.notes.push(format!("triangles are {found}: {why}"));
        }
        let numbered = |error: MeshError| FormatError::new(Problem::syntax(error.to_string()), None);
        // Corners that coincide are no triangle, here as in the mesh.
        let real: Vec<bool> = soup
            .triangles
            .iter()
            .map(|[a, b, c]| a != b && b != c && c != a)
            .collect();
        part.mesh = soup.indexed().map_err(numbered)?;
        part.face_of = numbers
            .into_iter()
            .zip(real)
            .filter_map(|(face, real)| real.then_some(face))
            .collect();
        Ok(part)
    }

    /// The faces of a body, and which of them each of its triangles belongs to.
    fn faces(&self, body: &build::Placed, place: usize, faces: &mut Vec<StepFace>, numbers: &mut Vec<u32>) {
        let mut at: BTreeMap<usize, u32> = BTreeMap::new();
        for (entity, kind) in &body.kinds {
            at.insert(*entity, faces.len() as u32);
            faces.push(StepFace {
                entity: *entity,
                body: place,
                name: self.scan.face_name(self.text, *entity),
                kind,
                surface: body.surfaces.get(entity).copied(),
                colour: self.faces.get(entity).and_then(|face| face.colour),
            });
        }
        numbers.extend(body.faces.iter().map(|face| at[face]));
    }

    /// A solid encloses its volume, from outside, and as much of it as its surfaces say.
    fn check(&self, body: &build::Placed, near: f64) -> Result<(), FormatError> {
        let first = body.faces.first().copied().unwrap_or_default();
        let of_file = self.faces.get(&first).map(|face| self.bodies[face.body].number);
        let error = |message: String| {
            let number = of_file.unwrap_or(first);
            match self.scan.place(number) {
                Some(place) => at(self.text, place, format!("solid #{number}: {message}")),
                None => FormatError::new(Problem::syntax(message), None),
            }
        };
        if !body.solid {
            return Ok(());
        }
        body.soup.check_closed().map_err(|reason| error(reason.to_string()))?;
        let volume = body.soup.volume();
        if !(volume > 0.0) {
            return Err(error("it is inside out: expected its faces to point outwards".into()));
        }
        if let Some(exact) = body.volume
            && (volume - exact).abs() > 2.0 * near * area(&body.soup) + INEXACT * exact
        {
            let message = format!("its triangles enclose {volume:.6} mm³, its surfaces {exact:.6}: expected the same");
            return Err(error(message));
        }
        Ok(())
    }
}

/// The area of triangles.
fn area(soup: &TriangleSoup) -> f64 {
    let each = soup.triangles.iter().map(|[a, b, c]| {
        let [u, v] = [b, c].map(|p| [0, 1, 2].map(|k: usize| p[k] - a[k]));
        let cross = [0, 1, 2].map(|k: usize| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
        0.5 * cross.iter().map(|c| c * c).sum::<f64>().sqrt()
    });
    each.sum()
}
