//! What a solid is made of, and how near it is to the interval ends that it was made of.

use crate::edges::Placed;
use crate::faces::Faces;
use crate::label::{FREE, Groups, Labels};
use crate::net::Net;
use std::collections::BTreeMap;

/// What a solid is made of.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Summary {
    /// How many faces of each kind: `plane`, `cylinder`, `cone`, `sphere`, `torus`, `sheet`, `spline`, `facet`.
    pub faces: BTreeMap<&'static str, usize>,
    /// The area of each kind, of the mesh.
    pub areas: BTreeMap<&'static str, f64>,
    /// The largest distance of an interval end from the surface of its face, triangles left out.
    pub deviation: f64,
    /// The largest distance of an interval end from the plane of its nearest triangle.
    pub facet_deviation: f64,
    /// The largest distance of a vertex or an edge from the surfaces of its faces.
    pub gap: f64,
    /// The largest distance found of a B-spline from the surface that it is written for: to be added to the others.
    pub spline: f64,
}

impl Summary {
    /// The share of the area on surfaces rather than triangles.
    #[must_use]
    pub fn share(&self) -> f64 {
        let all: f64 = self.areas.values().sum();
        let facets = self.areas.get("facet").copied().unwrap_or_default();
        if all > 0.0 { (all - facets) / all } else { 0.0 }
    }
}

pub(crate) fn summary(net: &Net, groups: &Groups, labels: &Labels, placed: &Placed, made: &Faces) -> Summary {
    let mut summary = Summary::default();
    for face in &made.all {
        let kind = if face.is_facet { "facet" } else { face.surface.kind() };
        *summary.faces.entry(kind).or_default() += 1;
        summary.spline = summary
            .spline
            .max(face.spline.as_ref().map_or(0.0, |spline| spline.off));
        for (edge, _) in face.loops.iter().flatten() {
            let Some(edge) = &placed.edges[*edge as usize] else {
                continue;
            };
            for k in 0..=8 {
                summary.gap = summary.gap.max(face.surface.off(edge.at(f64::from(k) / 8.0)));
            }
        }
    }
    let mut nearest: BTreeMap<u32, f64> = BTreeMap::new();
    for group in 0..groups.count() {
        let faces = made.of(group);
        let kind = match groups.label[group] {
            FREE => "facet",
            label => labels.all[label as usize].surface.kind(),
        };
        for triangle in groups.triangles(group) {
            *summary.areas.entry(kind).or_default() += 0.5 * net.area(*triangle as usize).norm();
            let number = net.end_of(*triangle as usize);
            let end = &net.ends.ends[number as usize];
            for face in faces.iter().filter(|_| end.normal.is_some()) {
                let off = face.surface.off(end.place.into());
                if face.is_facet {
                    let least = nearest.entry(number).or_insert(f64::INFINITY);
                    *least = least.min(off);
                } else {
                    summary.deviation = summary.deviation.max(off);
                }
            }
        }
    }
    summary.facet_deviation = nearest.into_values().fold(0.0, f64::max);
    summary
}
