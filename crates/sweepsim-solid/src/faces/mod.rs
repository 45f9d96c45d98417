//! Faces with their loops, checked in the parameters of their surfaces.

mod check;
mod flat;
mod shells;

pub(crate) use shells::shells;

use flat::{Flat, start};

use crate::chart::{Chart, across};
use crate::edges::{Chains, Placed};
use crate::label::{FREE, Groups, Labels};
use crate::net::Net;
use crate::parts::{Face, SolidOptions, Use};
use crate::surface::Surface;
use nalgebra::Vector3;
use sweepsim_dexel::AnalyticSurface as A;

/// The faces of a solid, and the triangles of those that could not be made.
pub(crate) struct Faces {
    pub all: Vec<Face>,
    /// Of each group of triangles its face: none if it fell together.
    pub of_group: Vec<Option<u32>>,
    pub failed: Vec<u32>,
}

/// Makes the faces of all groups.
pub(crate) fn faces(
    net: &Net,
    groups: &Groups,
    labels: &Labels,
    chains: &Chains,
    placed: &Placed,
    options: SolidOptions,
) -> Faces {
    let mut faces = Faces {
        all: Vec::new(),
        of_group: vec![None; groups.count()],
        failed: Vec::new(),
    };
    let mut loops: Vec<Vec<Vec<Use>>> = Vec::with_capacity(groups.count());
    for group in 0..groups.count() {
        let own = chains.loops(net, groups, group).into_iter().map(|own| {
            let kept = own
                .into_iter()
                .filter(|(chain, _)| placed.edges[*chain as usize].is_some());
            kept.collect::<Vec<Use>>()
        });
        loops.push(own.filter(|own| !own.is_empty()).collect());
    }
    let mut flat = Flat::new(placed, options);
    loops.iter().for_each(|own| flat.lens(own));
    for group in (0..groups.count()).filter(|group| groups.is_free(*group)) {
        flat.triangle(&loops[group]);
    }
    for group in 0..groups.count() {
        let own = loops[group].iter().map(|own| flat.replaced(own));
        let own: Vec<Vec<Use>> = own.filter(|own| !own.is_empty()).collect();
        if own.is_empty() {
            continue;
        }
        let face = if groups.is_free(group) {
            facet(net, groups.triangles(group)[0] as usize, own, placed)
        } else {
            curved(labels, groups.label[group], own, placed)
        };
        match face {
            Some(face) => {
                faces.of_group[group] = Some(faces.all.len() as u32);
                faces.all.push(face);
            }
            None => faces.failed.extend(groups.triangles(group)),
        }
    }
    faces
}

/// The plane of a triangle without a surface.
fn facet(net: &Net, triangle: usize, loops: Vec<Vec<Use>>, placed: &Placed) -> Option<Face> {
    let corners: Vec<Vector3<f64>> = loops.first()?.iter().filter_map(|used| start(used, placed)).collect();
    if corners.len() < 3 {
        return None;
    }
    // Twice the area of the polygon, along its normal.
    let around = |k: usize| corners[(k + 1) % corners.len()] - corners[0];
    let normal: Vector3<f64> = (0..corners.len())
        .map(|k| (corners[k] - corners[0]).cross(&around(k)))
        .sum();
    let sides = (0..corners.len()).map(|k| around(k) + corners[0] - corners[k]);
    let longest = sides.max_by(|a, b| a.norm().total_cmp(&b.norm()))?;
    let flat = 1e-6 * longest.norm_squared();
    let own = net.area(triangle);
    let moved = corners
        .iter()
        .any(|p| net.mesh.triangles[triangle].iter().all(|v| net.place(*v) != *p));
    // Flat, or turned over by what moved its corners. The mesh has triangles without area, too.
    if moved && (normal.norm() <= flat || own.norm() > flat && normal.dot(&own) <= 0.0) {
        return None;
    }
    let along = longest.try_normalize(0.0)?;
    let normal = normal.try_normalize(flat).unwrap_or_else(|| across(along));
    let along = (along - normal * normal.dot(&along)).try_normalize(0.0)?;
    let surface = Surface::Analytic(A::Plane {
        origin: corners[0].into(),
        normal: normal.into(),
    });
    Some(Face {
        surface,
        outward: true,
        axes: [along, normal.cross(&along), normal],
        loops,
        is_facet: true,
        range: [[0.0; 2]; 2],
    })
}

fn curved(labels: &Labels, label: u32, loops: Vec<Vec<Use>>, placed: &Placed) -> Option<Face> {
    debug_assert!(label != FREE);
    let label = &labels.all[label as usize];
    let chart = Chart::new(label);
    let (order, range) = check::outer_first(&chart, label.outward, &loops, placed)?;
    let turned = if chart.periodic()[0] {
        chart.turned_to(0.5 * (range[0][0] + range[0][1]))
    } else {
        chart
    };
    Some(Face {
        surface: label.surface,
        outward: label.outward,
        axes: turned.axes,
        loops: order.into_iter().map(|k| loops[k].clone()).collect(),
        is_facet: false,
        range,
    })
}
