//! From the library's boundary representation to triangles that close.

use std::collections::{BTreeMap, BTreeSet};

use kentron::geometry::surface::Surface;
use kentron::io::step::Node;
use kentron::math::{Direction, Point, Transform, Transformable, Vector};
use kentron::meshing::{MeshOptions, mesh_with};
use kentron::topology::{Model, NodeKind, Orientation, Shape};
use sweepsim_dexel::{AnalyticSurface, TriangleSoup};

use super::{deviation, fill};

/// The most that neighbouring chords turn, in radians.
const TURN: f64 = 0.5;
/// How often a part is meshed anew, finer, where the first mesh is not as near as asked.
const ATTEMPTS: usize = 5;
/// A distance that is no less than this part of what it was with chords twice as long stays: a quarter is usual.
const STAYS: f64 = 0.7;
/// How many triangles are enough not to ask for more.
const LARGE: usize = 2_000_000;
/// The most triangles of a file.
const MOST_TRIANGLES: usize = 20_000_000;

/// A body as it is placed.
#[derive(Debug, Default)]
pub(super) struct Placed {
    /// The products that lead to it, and its own name.
    pub path: String,
    /// Whether it is a solid; otherwise a sheet.
    pub solid: bool,
    /// Its triangles.
    pub soup: TriangleSoup,
    /// For each triangle, the entity of its face.
    pub faces: Vec<usize>,
    /// How many of the triangles fill holes that the library left.
    pub filled: usize,
    /// Its volume from its surfaces rather than from its triangles, in cubic millimetres, if it is a solid.
    pub volume: Option<f64>,
    /// The kind of each of its faces, by entity.
    pub kinds: BTreeMap<usize, &'static str>,
    /// The surfaces of those that are planes, cylinders, cones, spheres and tori.
    pub surfaces: BTreeMap<usize, AnalyticSurface>,
}

impl Placed {
    /// Closes holes, if they can be.
    fn close(&mut self) {
        let added = fill::holes(&self.soup.triangles).unwrap_or_default();
        self.filled = added.len();
        for (triangle, beside) in added {
            self.soup.triangles.push(triangle);
            self.faces.push(self.faces[beside]);
        }
    }
}

/// Meshes the bodies of a tree of products.
///
/// The library leaves a triangle out here and there, where corners are in line; another chord error then does not. And
/// a surface that bends where it was not looked at needs a smaller one than was asked for.
pub(super) fn bodies(model: &Model, roots: &[Node], chord: f64) -> Result<Found, String> {
    let mut best: Option<Found> = None;
    let mut wanted = chord;
    for _ in 0..ATTEMPTS {
        let found = attempt(model.clone(), roots, wanted)?;
        let near = found.deviation <= chord;
        let (closed, large) = (found.open == 0, found.triangles > LARGE);
        // Edges of the file that are not in its surfaces stay as far away, and thin triangles beside edges nearly so.
        let stays = best
            .as_ref()
            .is_some_and(|before| found.deviation > STAYS * before.deviation);
        if best
            .as_ref()
            .is_none_or(|before| (found.open, found.deviation) < (before.open, before.deviation))
        {
            best = Some(found);
        }
        if closed && (near || stays || large) {
            break;
        }
        wanted *= if near || stays { 0.83 } else { 0.5 };
    }
    best.ok_or_else(|| "nothing was meshed".into())
}

fn attempt(mut model: Model, roots: &[Node], chord: f64) -> Result<Found, String> {
    let mut found = Found::default();
    for root in roots {
        found.node(&mut model, root, Transform::IDENTITY, "", chord)?;
    }
    for body in found.bodies.iter_mut().filter(|body| body.solid) {
        if body.soup.check_closed().is_err() {
            body.close();
            found.open += usize::from(body.soup.check_closed().is_err());
        }
    }
    Ok(found)
}

/// The bodies of a file, as triangles.
#[derive(Default)]
pub(super) struct Found {
    pub bodies: Vec<Placed>,
    /// The largest distance found between triangles and surfaces.
    pub deviation: f64,
    /// How far edges are from the surfaces of the file, where triangles are farther than asked.
    pub gap: f64,
    triangles: usize,
    /// How many solids do not close.
    open: usize,
}

impl Found {
    fn node(&mut self, model: &mut Model, node: &Node, above: Transform, path: &str, chord: f64) -> Result<(), String> {
        let placement = above * node.placement;
        let path = match (path, node.name.as_str()) {
            (path, "") => path.to_owned(),
            ("", name) => name.to_owned(),
            (path, name) => format!("{path}/{name}"),
        };
        if let Some(shape) = node.shape {
            let options = MeshOptions {
                deflection: chord,
                angle: TURN,
                relative: false,
            };
            mesh_with(model, shape, options).map_err(|error| error.to_string())?;
            let deviation = deviation::of_shape(model, shape, chord);
            if deviation > chord {
                self.gap = self.gap.max(deviation::of_file(model, shape));
            }
            self.deviation = self.deviation.max(deviation);
            let numbers = node.subshapes.iter().filter(|part| part.shape.kind() == NodeKind::Face);
            let number = |part: &kentron::io::step::Subshape| part.name.as_ref()?.strip_prefix('#')?.parse().ok();
            let numbers: Vec<(Shape, usize)> = numbers.filter_map(|part| Some((part.shape, number(part)?))).collect();
            let shape = shape.moved(&placement);
            let mut of_solids = BTreeSet::new();
            for solid in model.explore(shape, NodeKind::Solid).collect::<Vec<_>>() {
                let faces: Vec<Shape> = model.explore(solid, NodeKind::Face).collect();
                of_solids.extend(faces.iter().map(|face| face.node));
                self.body(model, faces, &numbers, &path)?;
                if let Some(body) = self.bodies.last_mut() {
                    body.solid = true;
                    body.volume = kentron::properties::solid_volume(model, solid).map(|(volume, _)| volume);
                }
            }
            let sheets = model
                .explore(shape, NodeKind::Face)
                .filter(|face| !of_solids.contains(&face.node));
            let sheets: Vec<Shape> = sheets.collect();
            if !sheets.is_empty() {
                self.body(model, sheets, &numbers, &path)?;
            }
        }
        node.children
            .iter()
            .try_for_each(|child| self.node(model, child, placement, &path, chord))
    }

    fn body(&mut self, model: &Model, faces: Vec<Shape>, numbers: &[(Shape, usize)], path: &str) -> Result<(), String> {
        let numbers: BTreeMap<_, usize> = numbers.iter().map(|(shape, number)| (shape.node, *number)).collect();
        let mut body = Placed {
            path: path.to_owned(),
            ..Placed::default()
        };
        for face in faces {
            let number = numbers.get(&face.node).copied().unwrap_or_default();
            let unplaced = Shape::new(face.node);
            let Some(mesh) = model.face_mesh(unplaced) else {
                return Err(format!("face #{number} could not be meshed"));
            };
            if mesh.triangles().is_empty() {
                return Err(format!("face #{number} could not be meshed: it has no area"));
            }
            let surface = model.surface(unplaced);
            body.kinds.insert(number, surface.map_or("face", kind));
            if let Some(surface) = surface.and_then(|surface| analytic(&surface.transformed(&face.placement))) {
                body.surfaces.insert(number, surface);
            }
            let corner = |p: &Point| {
                let placed = p.transformed(&face.placement);
                [placed.x, placed.y, placed.z]
            };
            let corners: Vec<[f64; 3]> = mesh.nodes().iter().map(corner).collect();
            for triangle in mesh.triangles() {
                let [a, b, c] = triangle.map(|k| corners[k as usize]);
                let reversed = face.orientation == Orientation::Reversed;
                body.soup.triangles.push(if reversed { [a, c, b] } else { [a, b, c] });
                body.faces.push(number);
            }
        }
        self.triangles += body.faces.len();
        if self.triangles > MOST_TRIANGLES {
            return Err(format!(
                "more than {MOST_TRIANGLES} triangles: expected fewer, or larger limits"
            ));
        }
        self.bodies.push(body);
        Ok(())
    }
}

fn kind(surface: &Surface) -> &'static str {
    match surface {
        Surface::Plane(_) => "plane",
        Surface::Cylinder(_) => "cylinder",
        Surface::Cone(_) => "cone",
        Surface::Sphere(_) => "sphere",
        Surface::Torus(_) => "torus",
        Surface::Bezier(_) | Surface::BSpline(_) => "B-spline surface",
        Surface::Extrusion(_) => "extruded surface",
        Surface::Revolution(_) => "revolved surface",
        Surface::Offset(_) => "offset surface",
        Surface::Trimmed(_) => "trimmed surface",
    }
}

/// The surface in numbers, if few say what it is.
fn analytic(surface: &Surface) -> Option<AnalyticSurface> {
    let point = |p: Point| [p.x, p.y, p.z];
    let direction = |d: Direction| point(Point::ORIGIN + Vector::from(d));
    Some(match surface {
        Surface::Plane(plane) => AnalyticSurface::Plane {
            origin: point(plane.frame().origin()),
            normal: direction(plane.frame().z()),
        },
        Surface::Cylinder(cylinder) => AnalyticSurface::Cylinder {
            origin: point(cylinder.frame().origin()),
            axis: direction(cylinder.frame().z()),
            radius: cylinder.radius(),
        },
        Surface::Cone(cone) => AnalyticSurface::Cone {
            apex: point(cone.apex()),
            axis: direction(cone.frame().z()).map(|c| c * cone.semi_angle().signum()),
            angle: cone.semi_angle().abs(),
        },
        Surface::Sphere(sphere) => AnalyticSurface::Sphere {
            centre: point(sphere.frame().origin()),
            radius: sphere.radius(),
        },
        Surface::Torus(torus) => AnalyticSurface::Torus {
            centre: point(torus.frame().origin()),
            axis: direction(torus.frame().z()),
            major: torus.major_radius(),
            minor: torus.minor_radius(),
        },
        _ => return None,
    })
}
