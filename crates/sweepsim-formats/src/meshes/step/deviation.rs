//! How far triangles are from the surfaces of a file, and how far the file's own edges are.

use kentron::geometry::ParametricCurve;
use kentron::geometry::extrema::nearest_on_surface;
use kentron::geometry::surface::Surface;
use kentron::math::Point;
use kentron::topology::{Model, NodeKind, Shape};
use rayon::prelude::*;

/// The largest distance found between triangles and surfaces, and between chords and edges.
pub(super) fn of_shape(model: &Model, shape: Shape, chord: f64) -> f64 {
    let edges = model.unique_subshapes(shape, NodeKind::Edge).into_iter();
    let worst = edges.map(|edge| of_edge(model, unplaced(edge))).fold(0.0, f64::max);
    // Where the library compares points by their parameters, which also counts what they differ along the surface, it
    // says too much: what is more than asked is measured.
    let faces = model.unique_subshapes(shape, NodeKind::Face).into_iter().map(unplaced);
    let mut faces: Vec<(f64, Shape)> = faces
        .filter_map(|face| Some((model.face_mesh(face)?.deflection(), face)))
        .collect();
    faces.sort_by(|a, b| b.0.total_cmp(&a.0));
    faces.into_iter().fold(worst, |worst, (said, face)| {
        if said <= worst {
            worst
        } else if said <= chord {
            said
        } else {
            worst.max(of_face(model, face).min(said))
        }
    })
}

/// How far edges are from the surfaces of the faces that they bound, as the file has them.
pub(super) fn of_file(model: &Model, shape: Shape) -> f64 {
    let faces = model.unique_subshapes(shape, NodeKind::Face).into_iter().map(unplaced);
    let of_face = |face: Shape| {
        let edges = model.unique_subshapes(face, NodeKind::Edge).into_iter();
        let curves = edges.filter_map(|edge| model.edge_curve(unplaced(edge)));
        let points = curves.flat_map(|(curve, first, last)| {
            (0..=8).map(move |k| curve.point(first + (last - first) * f64::from(k) / 8.0))
        });
        let surface = model.surface(face);
        surface.map_or(0.0, |surface| {
            points.map(|point| beside(surface, point)).fold(0.0, f64::max)
        })
    };
    faces.map(of_face).fold(0.0, f64::max)
}

/// The library keeps geometry and meshes of shapes that are not placed.
fn unplaced(shape: Shape) -> Shape {
    Shape::new(shape.node)
}

fn beside(surface: &Surface, point: Point) -> f64 {
    nearest_on_surface(point, surface, None).2
}

/// Of the middles of triangles and of their sides from the surface.
fn of_face(model: &Model, face: Shape) -> f64 {
    let (Some(surface), Some(mesh)) = (model.surface(face), model.face_mesh(face)) else {
        return f64::INFINITY;
    };
    let of_triangle = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|k| mesh.nodes()[k as usize]);
        let side = |from: Point, to: Point| from + (to - from) * 0.5;
        let middle = a + ((b - a) + (c - a)) * (1.0 / 3.0);
        let points = [middle, side(a, b), side(b, c), side(c, a)];
        points
            .map(|point| beside(surface, point))
            .into_iter()
            .fold(0.0, f64::max)
    };
    mesh.triangles().par_iter().map(of_triangle).reduce(|| 0.0, f64::max)
}

/// Of the chords of an edge from it.
fn of_edge(model: &Model, edge: Shape) -> f64 {
    let (Some(polyline), Some((curve, _, _))) = (model.edge_polyline(edge), model.edge_curve(edge)) else {
        return 0.0;
    };
    let Some(parameters) = polyline.parameters() else {
        return 0.0;
    };
    let mut worst = 0.0_f64;
    for (ends, times) in polyline.nodes().windows(2).zip(parameters.windows(2)) {
        // Not only halfway, where an S crosses its chord.
        for share in [0.25, 0.5, 0.75] {
            let point = curve.point(times[0] + share * (times[1] - times[0]));
            worst = worst.max(distance(point, ends[0], ends[1]));
        }
    }
    worst
}

/// The distance of a point from a stretch.
fn distance(point: Point, from: Point, to: Point) -> f64 {
    let along = to - from;
    let square = along.dot(along);
    let share = if square > 0.0 {
        ((point - from).dot(along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    point.distance(from + along * share)
}
