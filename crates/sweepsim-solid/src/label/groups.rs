//! Connected parts of the mesh with one label.

use crate::net::Net;

/// No surface is known.
pub(crate) const FREE: u32 = u32::MAX;

/// The faces that labels make.
pub(crate) struct Groups {
    /// Of each triangle its face: a triangle without a label is a face of its own.
    pub of: Vec<u32>,
    /// Of each face its label,
    pub label: Vec<u32>,
    /// and its triangles: where each list begins,
    pub first: Vec<u32>,
    /// and all of them.
    pub members: Vec<u32>,
}

impl Groups {
    pub fn count(&self) -> usize {
        self.label.len()
    }

    pub fn triangles(&self, face: usize) -> &[u32] {
        &self.members[self.first[face] as usize..self.first[face + 1] as usize]
    }

    pub fn is_free(&self, face: usize) -> bool {
        self.label[face] == FREE
    }
}

/// Connects triangles that share an edge and a label.
pub(crate) fn group(net: &Net, labels: &[u32]) -> Groups {
    let mut groups = Groups {
        of: vec![u32::MAX; net.triangles()],
        label: Vec::new(),
        first: vec![0],
        members: Vec::with_capacity(net.triangles()),
    };
    let label = |triangle: usize| labels[net.end_of(triangle) as usize];
    let mut next = Vec::new();
    for start in 0..net.triangles() {
        if groups.of[start] != u32::MAX {
            continue;
        }
        let (face, own) = (groups.label.len() as u32, label(start));
        groups.label.push(own);
        groups.of[start] = face;
        next.push(start);
        while let Some(triangle) = next.pop() {
            groups.members.push(triangle as u32);
            if own == FREE {
                continue;
            }
            for k in 0..3 {
                let other = net.across[3 * triangle + k] as usize / 3;
                if groups.of[other] == u32::MAX && label(other) == own {
                    groups.of[other] = face;
                    next.push(other);
                }
            }
        }
        groups.first.push(groups.members.len() as u32);
    }
    groups
}
