//! The paper's Figures 1, 3 and 5 in one picture: an envelope cut open, the curves of its section, and the ends of one
//! dexel.

use super::figures::said;
use crate::bench::cutter;
use std::f64::consts::{PI, TAU};
use sweepsim::nalgebra::Vector3;
use sweepsim::systems::Plane;
use sweepsim::{Cut, Options, Ray, envelope_surfaces, probe, section};
use sweepsim_dexel::Mesh;
use sweepsim_picture::{Drawing, Image, View};

type Point = [f64; 3];

/// The section is by the plane of this `y`; what lies before it is left out.
const PLANE: f64 = -1.0;
/// The dexel, along z: its `x` in that plane.
const DEXEL: f64 = 3.0;
/// Largest distance of triangles and polylines from the envelope, in millimetres.
const CHORD: f64 = 0.02;
/// Radii, in millimetres: of curves that bound the volume, of the dexel and of curves inside, and of points.
const OUTER: f64 = 0.25;
const INNER: f64 = 0.1;
const DOT: f64 = 0.7;
/// Sides of what is drawn as round.
const SIDES: usize = 10;

/// The envelope of the flat end along Sweep2, and its section.
pub fn envelope() -> Result<Image, String> {
    let cutter = cutter("flat")?;
    let path = cutter.path(1)?;
    let cuts = [Cut::new(cutter.tool(), &path)];
    let options = Options::new(1e-6);
    let surfaces = envelope_surfaces(&cuts, CHORD, &options, &()).map_err(said)?;
    let (points, triangles) = surfaces.triangles(true);
    let mut shell = Mesh::default();
    for triangle in triangles {
        let corners = triangle.map(|v| &points[v as usize]);
        behind(&corners.map(|point| (point.position, point.normal)), &mut shell);
    }

    let mut curves = Mesh::default();
    let plane = Plane::y(PLANE).map_err(said)?;
    for curve in section(&cuts, &plane, CHORD, &options, &()).map_err(said)?.curves {
        for (pair, outer) in curve.points.windows(2).zip(curve.outer.windows(2)) {
            let radius = if outer == [true; 2] { OUTER } else { INNER };
            let ends = [pair[0].position, pair[1].position];
            turned(ends, &[(0.0, radius), (1.0, radius)], &mut curves);
        }
    }
    let ray = Ray::new([DEXEL, PLANE, 0.0], [0.0, 0.0, 1.0]).map_err(said)?;
    for dexel in probe(cutter.tool(), &path, &[ray], &options, &()).map_err(said)? {
        for interval in dexel.map_err(said)? {
            let ends = [interval.lower.z, interval.upper.z].map(|z| ray.at(z));
            turned(ends, &[(0.0, INNER), (1.0, INNER)], &mut curves);
            for [x, y, z] in ends {
                let ball: Vec<(f64, f64)> = (0..=SIDES)
                    .map(|k| PI * k as f64 / SIDES as f64)
                    .map(|angle| (0.5 - 0.5 * angle.cos(), DOT * angle.sin()))
                    .collect();
                turned([[x, y, z - DOT], [x, y, z + DOT]], &ball, &mut curves);
            }
        }
    }

    let mut view = View::default();
    view.size = [800, 600];
    view.axes = false;
    (view.azimuth, view.elevation) = (-75.0, 20.0);
    Ok(view.draw(&Drawing::new(&shell).tool(&curves)))
}

/// Adds the part of a triangle, given with its normals, behind the plane: seen from both sides.
fn behind(corners: &[(Point, Point); 3], shell: &mut Mesh) {
    let mut kept: Vec<(Point, Point)> = Vec::with_capacity(4);
    for k in 0..3 {
        let (from, to) = (corners[k], corners[(k + 1) % 3]);
        let [a, b] = [from, to].map(|corner| corner.0[1] - PLANE);
        if a >= 0.0 {
            kept.push(from);
        }
        if (a >= 0.0) != (b >= 0.0) {
            let mix = |p: Point, q: Point| [0, 1, 2].map(|i| p[i] + (q[i] - p[i]) * a / (a - b));
            kept.push((mix(from.0, to.0), mix(from.1, to.1)));
        }
    }
    for side in [1.0, -1.0] {
        let first = shell.vertices.len() as u32;
        for (place, normal) in &kept {
            shell.vertices.push(*place);
            shell.normals.push(normal.map(|x| (side * x) as f32));
            shell.cut.push(side > 0.0);
        }
        for k in 1..kept.len().saturating_sub(1) as u32 {
            let fan = [first, first + k, first + k + 1];
            shell
                .triangles
                .push(if side > 0.0 { fan } else { [fan[0], fan[2], fan[1]] });
        }
    }
}

/// Adds a surface about the line between two points: at each part of the way, its radius.
fn turned([from, to]: [Point; 2], outline: &[(f64, f64)], mesh: &mut Mesh) {
    let [from, to] = [from, to].map(Vector3::from);
    let Some(along) = (to - from).try_normalize(1e-12) else {
        return;
    };
    let mut other = Vector3::zeros();
    other[along.iamin()] = 1.0;
    let across = along.cross(&other).normalize();
    let first = mesh.vertices.len() as u32;
    for (share, radius) in outline {
        for side in 0..SIDES {
            let (sin, cos) = (TAU * side as f64 / SIDES as f64).sin_cos();
            let out = across * cos + along.cross(&across) * sin;
            mesh.vertices.push((from + (to - from) * *share + out * *radius).into());
            mesh.normals.push(out.map(|x| x as f32).into());
            mesh.cut.push(true);
        }
    }
    let sides = SIDES as u32;
    for ring in 0..outline.len() as u32 - 1 {
        for side in 0..sides {
            let next = (side + 1) % sides;
            let at = |ring: u32, side: u32| first + ring * sides + side;
            let [a, b, c, d] = [at(ring, side), at(ring, next), at(ring + 1, next), at(ring + 1, side)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
}
