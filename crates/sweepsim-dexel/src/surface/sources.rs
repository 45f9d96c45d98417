//! Sources of the vertices of a surface.

use crate::dexels::{Dexels, NearestEnd};
use crate::intervals::Source;
use crate::mesh::Mesh;
use rayon::prelude::*;

/// For each vertex, the source of the nearest end that a tool made, in any of the sets.
pub(crate) fn sources_in(sets: &[&Dexels], mesh: &Mesh) -> Vec<Source> {
    // A set without an end near a place would be searched as a whole: each looks no farther than the best so far.
    let nearest = |place: [f64; 3], reach: f64| {
        sets.iter().fold(None, |best: Option<NearestEnd>, set| {
            let reach = best.as_ref().map_or(reach, |best| best.distance);
            let own = set.nearest_of(place, reach, |end| end.source.is_cut());
            own.filter(|own| best.is_none() || own.distance < reach).or(best)
        })
    };
    // A surface is seldom farther from its ends than cells are wide.
    let diagonals = sets.iter().map(|set| set.grid().spacing()).map(|[u, v]| u.hypot(v));
    let wide = diagonals.fold(0.0, f64::max);
    let source = |(number, place): (usize, &[f64; 3])| {
        let cut = mesh.cut.get(number).copied().unwrap_or(false);
        let near = || nearest(*place, wide).or_else(|| nearest(*place, f64::INFINITY));
        cut.then(near)
            .flatten()
            .map_or(Source::Stock, |nearest| nearest.end.source)
    };
    mesh.vertices.par_iter().enumerate().map(source).collect()
}
