//! The part's surface as triangles.

use super::arrays::{Arrays, Scale, octahedron};
use super::layers;
use crate::scene::Surface;
use serde::Serialize;

#[derive(Clone, Debug, Serialize)]
pub(crate) struct SurfaceHead {
    places: [Scale; 3],
    triangles: usize,
    whole: usize,
    farthest: f64,
}

/// Corners in the order in which triangles use them, so that numbers differ little from the ones before. What made a
/// triangle is stored at its last corner: triangles are turned so that few corners need a copy for that.
pub(crate) fn surface(surface: &Surface, step: Option<f64>) -> (SurfaceHead, Arrays) {
    const UNUSED: u32 = u32::MAX;
    let mut numbers = vec![UNUSED; surface.vertices.len()];
    let (mut order, mut corners): (Vec<usize>, Vec<u32>) = (Vec::new(), Vec::new());
    let mut makers: Vec<Option<u32>> = Vec::new();
    let good = |(_, triangle): &(usize, &[u32; 3])| {
        let place = |v: u32| surface.vertices.get(v as usize);
        let is_there = |v: &u32| place(*v).is_some_and(|p| p.iter().all(|c| c.is_finite()));
        triangle.iter().all(is_there)
    };
    for (n, triangle) in surface.triangles.iter().enumerate().filter(good) {
        let maker = surface.makers.get(n).copied().unwrap_or(0);
        let mut own = triangle.map(|v| {
            let number = &mut numbers[v as usize];
            if *number == UNUSED {
                *number = order.len() as u32;
                order.push(v as usize);
                makers.push(None);
            }
            *number
        });
        let free = (0..3).find(|k| makers[own[*k] as usize].is_none_or(|other| other == maker));
        match free {
            Some(k) => own.rotate_left((k + 1) % 3),
            None => {
                let copy = order[own[2] as usize];
                own[2] = order.len() as u32;
                // Later triangles take the copy.
                numbers[copy] = own[2];
                order.push(copy);
                makers.push(None);
            }
        }
        makers[own[2] as usize] = Some(maker);
        corners.extend(own);
    }
    let makers: Vec<u32> = makers.into_iter().map(Option::unwrap_or_default).collect();
    let mut arrays = Arrays::default();
    let place = |k: usize| order.iter().map(move |v| surface.vertices[*v][k]);
    let places = [0, 1, 2].map(|k| Scale::over(place(k), layers::HEIGHTS));
    for (k, name) in ["surface.x", "surface.y", "surface.z"].into_iter().enumerate() {
        let steps: Vec<u16> = place(k).map(|c| places[k].steps(c, layers::HEIGHTS) as u16).collect();
        arrays.u16(name, &steps);
    }
    let normal = |v: &usize| surface.normals.get(*v).copied().unwrap_or([0.0, 0.0, 1.0]);
    let packed: Vec<[f64; 2]> = order.iter().map(|v| octahedron(normal(v).map(f64::from))).collect();
    for (k, name) in ["surface.u", "surface.v"].into_iter().enumerate() {
        let own: Vec<i8> = packed.iter().map(|n| (n[k] * 127.0).round() as i8).collect();
        arrays.i8(name, &own);
    }
    arrays.u32("surface.maker", &makers);
    if let Some(step) = step {
        let deviation = |v: &usize| surface.deviations.get(*v).copied().unwrap_or(f32::NAN);
        let own: Vec<i16> = order.iter().map(|v| layers::deviation(deviation(v), step)).collect();
        arrays.i16("surface.deviation", &own);
    }
    arrays.u32("surface.corners", &corners);
    let head = SurfaceHead {
        places,
        triangles: corners.len() / 3,
        whole: surface.whole,
        farthest: surface.farthest,
    };
    (head, arrays)
}
