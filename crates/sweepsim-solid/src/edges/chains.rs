//! The borders between faces: chains of edges of the mesh from one corner to the next.

use crate::label::{FREE, Groups, Labels};
use crate::net::Net;
use crate::surface::Surface;
use nalgebra::Vector3;
use sweepsim_dexel::AnalyticSurface as A;

/// No chain.
const NONE: u32 = u32::MAX;

/// A chain of edges of the mesh between two faces, the first of them on its left.
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    pub faces: [u32; 2],
    /// All vertices of the mesh, from end to end; of a closed chain, the first is also the last.
    pub vertices: Vec<u32>,
}

impl Chain {
    /// Its first and its last vertex.
    pub fn ends(&self) -> [u32; 2] {
        [self.vertices[0], self.vertices[self.vertices.len() - 1]]
    }
}

/// All of them.
pub(crate) struct Chains {
    pub all: Vec<Chain>,
    /// Of each half-edge of the mesh its chain.
    of: Vec<u32>,
    /// Whether each vertex of the mesh is one of the solid.
    pub node: Vec<bool>,
    /// Of each vertex that is the tip of a cone, the tip.
    pub tips: Vec<(u32, Vector3<f64>)>,
}

/// Finds the chains of faces.
pub(crate) fn chains(net: &Net, groups: &Groups, labels: &Labels, cell: f64) -> Chains {
    let border = |half: usize| groups.of[half / 3] != groups.of[net.across[half] as usize / 3];
    let mut leaving = vec![0_u8; net.mesh.vertices.len()];
    let mut node = vec![false; net.mesh.vertices.len()];
    for half in 0..net.across.len() {
        if border(half) {
            let count = &mut leaving[net.from(half) as usize];
            *count = count.saturating_add(1);
        }
        if groups.is_free(groups.of[half / 3] as usize) {
            node[net.from(half) as usize] = true;
        }
    }
    for (vertex, count) in leaving.iter().enumerate() {
        node[vertex] |= *count > 2;
    }
    let tips = tips(net, groups, labels, &leaving, cell);
    for (vertex, _) in &tips {
        node[*vertex as usize] = true;
    }
    let mut chains = Chains {
        all: Vec::new(),
        of: vec![NONE; net.across.len()],
        node,
        tips,
    };
    // From corners first; what is left then is closed.
    for closed in [false, true] {
        for half in 0..net.across.len() {
            if chains.of[half] == NONE && border(half) && (closed || chains.node[net.from(half) as usize]) {
                chains.follow(net, groups, half);
            }
        }
    }
    chains
}

/// For each cone with its tip on a border, the vertex that is nearest to it.
fn tips(net: &Net, groups: &Groups, labels: &Labels, leaving: &[u8], cell: f64) -> Vec<(u32, Vector3<f64>)> {
    let mut tips = Vec::new();
    for face in 0..groups.count() {
        let Some(label) = (groups.label[face] != FREE).then(|| &labels.all[groups.label[face] as usize]) else {
            continue;
        };
        let Surface::Analytic(A::Cone { apex, .. }) = label.surface else {
            continue;
        };
        let apex = Vector3::from(apex);
        let corners = groups
            .triangles(face)
            .iter()
            .flat_map(|t| net.mesh.triangles[*t as usize]);
        let far = |vertex: u32| (net.place(vertex) - apex).norm();
        let near = corners.filter(|v| leaving[*v as usize] > 0 && far(*v) < 2.0 * cell);
        tips.extend(
            near.min_by(|a, b| far(*a).total_cmp(&far(*b)))
                .map(|vertex| (vertex, apex)),
        );
    }
    tips.sort_by_key(|(vertex, _)| *vertex);
    tips.dedup_by_key(|(vertex, _)| *vertex);
    tips
}

/// The next half-edge of a face's border after this one, around the vertex where it ends.
pub(crate) fn next(net: &Net, groups: &Groups, half: usize) -> usize {
    let face = groups.of[half / 3];
    let mut turn = half - half % 3 + (half % 3 + 1) % 3;
    // A vertex has finitely many triangles.
    for _ in 0..net.across.len() {
        let across = net.across[turn] as usize;
        if groups.of[across / 3] != face {
            break;
        }
        turn = across - across % 3 + (across % 3 + 1) % 3;
    }
    turn
}

impl Chains {
    fn follow(&mut self, net: &Net, groups: &Groups, start: usize) {
        let number = self.all.len() as u32;
        let mut chain = Chain {
            faces: [start, net.across[start] as usize].map(|half| groups.of[half / 3]),
            vertices: vec![net.from(start)],
        };
        let mut half = start;
        loop {
            self.of[half] = number;
            self.of[net.across[half] as usize] = number;
            let to = net.to(half);
            chain.vertices.push(to);
            if self.node[to as usize] || to == chain.vertices[0] {
                break;
            }
            half = next(net, groups, half);
            if self.of[half] != NONE {
                break;
            }
        }
        if let Some(first) = chain.vertices.first() {
            self.node[*first as usize] = true;
        }
        self.all.push(chain);
    }

    /// The loops of a face: chains with whether they are passed from their first vertex to their last.
    pub fn loops(&self, net: &Net, groups: &Groups, face: usize) -> Vec<Vec<(u32, bool)>> {
        let mut loops = Vec::new();
        let mut seen = std::collections::BTreeSet::new();
        for triangle in groups.triangles(face) {
            for k in 0..3 {
                let start = 3 * *triangle as usize + k;
                if self.of[start] == NONE || seen.contains(&start) {
                    continue;
                }
                let mut own: Vec<(u32, bool)> = Vec::new();
                let mut half = start;
                while seen.insert(half) {
                    let chain = self.of[half];
                    let forward = self.is_forward(groups, half);
                    // A chain begins at a corner.
                    if self.node[net.from(half) as usize] {
                        own.push((chain, forward));
                    }
                    half = next(net, groups, half);
                }
                if own.is_empty() {
                    own.push((self.of[start], self.is_forward(groups, start)));
                }
                loops.push(own);
            }
        }
        loops
    }

    /// Whether a half-edge goes the way of its chain.
    fn is_forward(&self, groups: &Groups, half: usize) -> bool {
        self.all[self.of[half] as usize].faces[0] == groups.of[half / 3]
    }
}
