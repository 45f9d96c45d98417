//! Finer triangles where they border on curved faces: their edges there are chords.

use super::ends::Labels;
use super::groups::FREE;
use crate::net::Net;
use nalgebra::Vector3;
use sweepsim_dexel::Mesh;

/// A mesh with the ends of its triangles.
pub(crate) type Finer = (Mesh, Vec<u32>);

/// The mesh with borders between faces and triangles without a surface cut in two where their middles are farther than
/// `chord` from the face, as many at a time as have no triangle in common; `None` if none is.
pub(crate) fn finer(net: &Net, labels: &Labels, chord: f64) -> Option<Finer> {
    let mut mesh: Option<Mesh> = None;
    let mut ends = net.ends.of_triangle.clone();
    let mut used = vec![false; net.triangles()];
    let label = |half: usize| labels.of[net.end_of(half / 3) as usize];
    for half in 0..net.across.len() {
        let other = net.across[half] as usize;
        if label(half) == FREE || label(other) != FREE || used[half / 3] || used[other / 3] {
            continue;
        }
        let surface = &labels.all[label(half) as usize].surface;
        // The ends of the edge as they will be: on the surface.
        let onto = |p: Vector3<f64>| surface.at(p).map(|(distance, grows)| p - grows * distance);
        let [from, to] = [net.from(half), net.to(half)].map(|vertex| onto(net.place(vertex)));
        let (Some(from), Some(to)) = (from, to) else { continue };
        let middle = (from + to) * 0.5;
        let Some(place) = onto(middle).filter(|place| (place - middle).norm() > chord) else {
            continue;
        };
        let mesh = mesh.get_or_insert_with(|| net.mesh.as_ref().clone());
        let new = mesh.vertices.len() as u32;
        mesh.vertices.push(place.into());
        for half in [half, other] {
            used[half / 3] = true;
            let (triangle, k) = (half / 3, half % 3);
            let [a, b, c] = [0, 1, 2].map(|off| mesh.triangles[triangle][(k + off) % 3]);
            mesh.triangles[triangle] = [a, new, c];
            mesh.triangles.push([new, b, c]);
            ends.push(ends[triangle]);
        }
    }
    mesh.map(|mesh| (mesh, ends))
}
