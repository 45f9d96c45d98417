//! Faces with their loops, checked in the parameters of their surfaces.

mod check;
mod facets;
mod flat;
mod shells;

pub(crate) use shells::shells;

use check::Crossing;
use facets::facets;
use flat::Flat;

use crate::chart::Chart;
use crate::edges::{Chains, Placed};
use crate::label::{FREE, Groups, Labels};
use crate::net::Net;
use crate::parts::{Face, SolidOptions, Use};
use nalgebra::Vector3;
use std::ops::Range;

/// So far from where edges cross, in cells, a face is given up for triangles.
const NEAR: f64 = 1.5;

/// The faces of a solid, and the triangles of those that could not be made.
pub(crate) struct Faces {
    pub all: Vec<Face>,
    /// Of each group of triangles its faces: none if it fell together, several where a triangle was cut.
    pub of_group: Vec<Range<u32>>,
    pub failed: Vec<u32>,
}

impl Faces {
    /// Those of a group.
    pub fn of(&self, group: usize) -> &[Face] {
        let Range { start, end } = self.of_group[group];
        &self.all[start as usize..end as usize]
    }
}

/// Triangles near one of a few points.
fn near(net: &Net, triangles: &[u32], points: &[Vector3<f64>], cell: f64) -> Vec<u32> {
    let is_near = |t: &&u32| {
        let corners = net.mesh.triangles[**t as usize].map(|v| net.place(v));
        let any = |at: &Vector3<f64>| corners.iter().any(|p| (p - at).norm() < NEAR * cell);
        points.iter().any(any)
    };
    triangles.iter().filter(is_near).copied().collect()
}

/// Makes the faces of all groups.
pub(crate) fn faces(
    net: &Net,
    groups: &Groups,
    labels: &Labels,
    chains: &Chains,
    placed: &mut Placed,
    options: SolidOptions,
) -> Faces {
    let mut faces = Faces {
        all: Vec::new(),
        of_group: vec![0..0; groups.count()],
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
    let replaced = |own: &Vec<Vec<Use>>| -> Vec<Vec<Use>> {
        let own = own.iter().map(|own| flat.replaced(own));
        own.filter(|own| !own.is_empty()).collect()
    };
    let loops: Vec<Vec<Vec<Use>>> = loops.iter().map(replaced).collect();
    for (group, own) in loops.into_iter().enumerate() {
        if own.is_empty() {
            continue;
        }
        let triangles = groups.triangles(group);
        let made = if groups.is_free(group) {
            facets(net, triangles[0] as usize, own, placed, 0.1 * options.chord).ok_or(None)
        } else {
            curved(labels, groups.label[group], own, placed).map(|face| vec![face])
        };
        match made {
            Ok(made) => {
                let first = faces.all.len() as u32;
                faces.all.extend(made);
                faces.of_group[group] = first..faces.all.len() as u32;
            }
            Err(crossing) => {
                let near = near(net, triangles, &Vec::from_iter(crossing), options.cell);
                faces.failed.extend(if near.is_empty() { triangles } else { &near });
            }
        }
    }
    faces
}

fn curved(labels: &Labels, label: u32, loops: Vec<Vec<Use>>, placed: &Placed) -> Result<Face, Crossing> {
    debug_assert!(label != FREE);
    let label = &labels.all[label as usize];
    let chart = Chart::new(label);
    let (order, range) = check::outer_first(&chart, label.outward, &loops, placed)?;
    let turned = if chart.periodic()[0] {
        chart.turned_to(0.5 * (range[0][0] + range[0][1]))
    } else {
        chart
    };
    Ok(Face {
        surface: label.surface.clone(),
        outward: label.outward,
        axes: turned.axes,
        loops: order.into_iter().map(|k| loops[k].clone()).collect(),
        is_facet: false,
        range,
        spline: None,
    })
}
