//! The part's surface as triangles, and that of the workpiece during the program.

use super::arrays::{Arrays, Scale, octahedron};
use super::layers;
use crate::scene::{Surface, SurfaceCourse};
use serde::Serialize;

#[derive(Clone, Debug, Serialize)]
pub(crate) struct SurfaceHead {
    places: [Scale; 3],
    triangles: usize,
    whole: usize,
    farthest: f64,
}

/// The surface of the workpiece during the program, as embedded.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct SurfaceCourseHead {
    places: [Scale; 3],
    /// The clock of each moment.
    clocks: Vec<f64>,
}

/// The names of a surface's arrays: places, normals, makers, deviations and corners.
type Names = [&'static str; 8];

const PART: Names = [
    "surface.x",
    "surface.y",
    "surface.z",
    "surface.u",
    "surface.v",
    "surface.maker",
    "surface.deviation",
    "surface.corners",
];
const COURSE: Names = [
    "course.x",
    "course.y",
    "course.z",
    "course.u",
    "course.v",
    "course.maker",
    "course.deviation",
    "course.corners",
];

/// The part's surface.
pub(crate) fn surface(surface: &Surface, step: Option<f64>) -> (SurfaceHead, Arrays) {
    let (places, numbers, arrays) = arrays(surface, &PART, step);
    let head = SurfaceHead {
        places,
        triangles: numbers.len(),
        whole: surface.whole,
        farthest: surface.farthest,
    };
    (head, arrays)
}

/// The surface of the workpiece at all moments.
pub(crate) fn course(course: &SurfaceCourse, step: Option<f64>) -> (SurfaceCourseHead, Arrays) {
    let (places, numbers, mut arrays) = arrays(&course.surface, &COURSE, step);
    let moments = |k: usize| -> Vec<u16> {
        let spans = numbers.iter().map(|n| course.spans.get(*n).copied());
        spans.map(|span| span.unwrap_or_default()[k]).collect()
    };
    arrays.u16("course.from", &moments(0));
    arrays.u16("course.to", &moments(1));
    let clocks = course.clocks.clone();
    (SurfaceCourseHead { places, clocks }, arrays)
}

/// Every second moment, counted from the last.
pub(crate) fn thinned(course: &SurfaceCourse) -> SurfaceCourse {
    let count = course.clocks.len();
    let is_kept = |moment: &usize| *moment == 0 || (count - moment).is_multiple_of(2);
    // Of each moment, how many before it are kept.
    let before: Vec<u16> = std::iter::once(0)
        .chain((0..=count).scan(0, |kept, moment| {
            *kept += u16::from(is_kept(&moment));
            Some(*kept)
        }))
        .collect();
    let own = &course.surface;
    let mut thin = SurfaceCourse {
        clocks: (1..=count)
            .filter(is_kept)
            .map(|moment| course.clocks[moment - 1])
            .collect(),
        ..SurfaceCourse::default()
    };
    let (triangles, makers) = (&mut thin.surface.triangles, &mut thin.surface.makers);
    for (n, (corners, span)) in own.triangles.iter().zip(&course.spans).enumerate() {
        let [from, to] = span.map(|moment| before[usize::from(moment).min(count + 1)]);
        if from < to {
            triangles.push(*corners);
            makers.push(own.makers.get(n).copied().unwrap_or_default());
            thin.spans.push([from, to]);
        }
    }
    thin.surface.vertices.clone_from(&own.vertices);
    thin.surface.normals.clone_from(&own.normals);
    thin.surface.deviations.clone_from(&own.deviations);
    thin
}

/// Corners in the order in which triangles use them, so that numbers differ little from the ones before. What made a
/// triangle is stored at its last corner: triangles are turned so that few corners need a copy for that. Returns the
/// numbers of the triangles that are kept, too.
fn arrays(surface: &Surface, names: &Names, step: Option<f64>) -> ([Scale; 3], Vec<usize>, Arrays) {
    const UNUSED: u32 = u32::MAX;
    let mut numbers = vec![UNUSED; surface.vertices.len()];
    let (mut order, mut corners): (Vec<usize>, Vec<u32>) = (Vec::new(), Vec::new());
    let (mut makers, mut kept): (Vec<Option<u32>>, _) = (Vec::new(), Vec::new());
    let good = |(_, triangle): &(usize, &[u32; 3])| {
        let place = |v: u32| surface.vertices.get(v as usize);
        let is_there = |v: &u32| place(*v).is_some_and(|p| p.iter().all(|c| c.is_finite()));
        triangle.iter().all(is_there)
    };
    for (n, triangle) in surface.triangles.iter().enumerate().filter(good) {
        kept.push(n);
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
    for (k, name) in names[..3].iter().enumerate() {
        let steps: Vec<u16> = place(k).map(|c| places[k].steps(c, layers::HEIGHTS) as u16).collect();
        arrays.u16(name, &steps);
    }
    let normal = |v: &usize| surface.normals.get(*v).copied().unwrap_or([0.0, 0.0, 1.0]);
    let packed: Vec<[f64; 2]> = order.iter().map(|v| octahedron(normal(v).map(f64::from))).collect();
    for (k, name) in names[3..5].iter().enumerate() {
        let own: Vec<i8> = packed.iter().map(|n| (n[k] * 127.0).round() as i8).collect();
        arrays.i8(name, &own);
    }
    arrays.u32(names[5], &makers);
    if let Some(step) = step {
        let deviation = |v: &usize| surface.deviations.get(*v).copied().unwrap_or(f32::NAN);
        let own: Vec<i16> = order.iter().map(|v| layers::deviation(deviation(v), step)).collect();
        arrays.i16(names[6], &own);
    }
    arrays.u32(names[7], &corners);
    (places, kept, arrays)
}
