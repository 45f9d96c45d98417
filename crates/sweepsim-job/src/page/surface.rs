//! The part's surface along three axes, as it is shown: with sharp walls, and what is known of each piece of it.

use super::number_of;
use crate::base::words;
use rayon::prelude::*;
use sweepsim::verify::Target;
use sweepsim_dexel::{Mesh, TriDexels};
use sweepsim_report::{Surface, measure};

/// The most triangles that are shown: so many open in a second.
pub(super) const MOST: usize = 300_000;

/// The surface with its deviations along the target's normal, and the moves that made it.
pub(super) fn surface(solid: &TriDexels, mesh: &Mesh, target: Option<&Target>, first_moves: &[u32]) -> Surface {
    let clustered = mesh.clustered(MOST);
    let farthest = clustered.farthest(mesh).unwrap_or(clustered.within);
    let shown = clustered.mesh;
    let deviations = target.map_or_else(Vec::new, |target| distances(target, &shown.vertices));
    let sources = solid.sources(&middles(&shown));
    let makers = sources
        .into_iter()
        .map(|source| number_of(source, first_moves))
        .collect();
    Surface {
        deviations,
        makers,
        whole: mesh.triangles.len(),
        farthest,
        vertices: shown.vertices,
        normals: shown.normals,
        triangles: shown.triangles,
    }
}

/// The signed distances of places from the target along its normal; NaN where there is none.
pub(super) fn distances(target: &Target, places: &[[f64; 3]]) -> Vec<f32> {
    let near = |p: &[f64; 3]| {
        let near = target.distance().nearest(*p);
        near.map_or(f32::NAN, |near| near.distance as f32)
    };
    places.par_iter().map(near).collect()
}

/// The middles of all triangles as vertices; each counts as cut if all corners do.
fn middles(mesh: &Mesh) -> Mesh {
    let mut middles = Mesh::default();
    for corners in &mesh.triangles {
        let places = corners.map(|v| mesh.vertices[v as usize]);
        middles
            .vertices
            .push([0, 1, 2].map(|k| places.iter().map(|p| p[k]).sum::<f64>() / 3.0));
        middles.cut.push(corners.iter().all(|v| mesh.cut[*v as usize]));
    }
    middles
}

/// What is said of a mesh that is shown with fewer triangles than it has.
pub(super) fn fewer(what: &str, whole: usize, shown: usize, farthest: f64) -> String {
    let [whole, shown] = [whole, shown].map(|n| words::count(n as u64));
    format!(
        "{what} has {whole} triangles: the page shows {shown}, from which the farthest corner is {} mm",
        measure(farthest)
    )
}
