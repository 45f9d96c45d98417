//! A tree of boxes over triangles.

mod halves;
mod parts;

use halves::{Hull, halved};
use parts::TrianglePart;

/// Triangles of a leaf of the tree.
const LEAF: usize = 4;
/// Subtrees over more parts than this are worth a task of their own.
const TASK: usize = 4096;

#[derive(Clone, Debug)]
pub(super) struct TreeNode {
    pub low: [f64; 3],
    pub high: [f64; 3],
    /// The places `first..first + count` in the order of faces; of an inner node the second child is at `first`, the
    /// first right behind it.
    pub first: u32,
    pub count: u32,
}

impl TreeNode {
    pub fn distance_squared(&self, p: [f64; 3]) -> f64 {
        (0..3)
            .map(|k| (self.low[k] - p[k]).max(p[k] - self.high[k]).max(0.0).powi(2))
            .sum()
    }
}

/// The numbers of triangles in the order of the leaves, some more than once; and the nodes, the root first.
pub(super) fn over(triangles: impl Iterator<Item = [[f64; 3]; 3]> + Clone) -> (Vec<u32>, Vec<TreeNode>) {
    let mut parts = parts::of(triangles);
    let nodes = grown(&mut parts);
    (parts.into_iter().map(|part| part.face).collect(), nodes)
}

/// The tree over some parts of triangles, which are put in the order of its leaves; the root comes first.
fn grown(parts: &mut [TrianglePart]) -> Vec<TreeNode> {
    let mut nodes = Vec::new();
    if !parts.is_empty() {
        split(&mut nodes, parts, 0);
    }
    nodes
}

/// Builds the tree over some parts of faces, the first of which has the place `first` in the order of all.
fn split(nodes: &mut Vec<TreeNode>, parts: &mut [TrianglePart], first: usize) {
    let number = nodes.len();
    let mut hull = Hull::NOTHING;
    parts.iter().for_each(|part| hull.add(part.low, part.high));
    nodes.push(TreeNode {
        low: hull.low,
        high: hull.high,
        first: first as u32,
        count: parts.len() as u32,
    });
    if parts.len() <= LEAF {
        return;
    }
    let middle = halved(parts);
    let (lower, upper) = parts.split_at_mut(middle);
    let second;
    if upper.len() > TASK {
        let of = |parts: &mut [TrianglePart], first| {
            let mut nodes = Vec::new();
            split(&mut nodes, parts, first);
            nodes
        };
        let (lower, upper) = rayon::join(|| of(lower, first), || of(upper, first + middle));
        append(nodes, lower);
        second = nodes.len() as u32;
        append(nodes, upper);
    } else {
        split(nodes, lower, first);
        second = nodes.len() as u32;
        split(nodes, upper, first + middle);
    }
    (nodes[number].first, nodes[number].count) = (second, 0);
}

/// Appends a tree that was grown by itself.
fn append(nodes: &mut Vec<TreeNode>, own: Vec<TreeNode>) {
    let before = nodes.len() as u32;
    nodes.extend(own.into_iter().map(|mut node| {
        // Leaves tell places, inner nodes their second child.
        if node.count == 0 {
            node.first += before;
        }
        node
    }));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Places of the leaves below a node; all its boxes lie in its own.
    fn leaves(nodes: &[TreeNode], number: usize, parts: &[TrianglePart], places: &mut Vec<u32>) {
        let node = &nodes[number];
        let children = match node.count {
            0 => vec![number + 1, node.first as usize],
            _ => Vec::new(),
        };
        let inner = children.iter().map(|n| (nodes[*n].low, nodes[*n].high));
        let own = (node.first..node.first + node.count).map(|n| (parts[n as usize].low, parts[n as usize].high));
        for (low, high) in inner.chain(own) {
            assert!((0..3).all(|k| node.low[k] <= low[k] && high[k] <= node.high[k]));
        }
        places.extend(node.first..node.first + node.count);
        children.into_iter().for_each(|n| leaves(nodes, n, parts, places));
    }

    #[test]
    fn a_tree_has_every_part_once_in_order() {
        for count in [1, 4, 5, 100, 2 * TASK, 9 * TASK + 7] {
            let part = |n: usize| {
                let low = [7, 11, 13].map(|prime| (n * prime % 997) as f64);
                let high = low.map(|c| c + (n % 5) as f64);
                TrianglePart {
                    face: n as u32,
                    low,
                    high,
                    place: low.map(|c| 3.0 * c),
                }
            };
            let mut parts: Vec<TrianglePart> = (0..count).map(part).collect();
            let nodes = grown(&mut parts);
            let mut places = Vec::new();
            leaves(&nodes, 0, &parts, &mut places);
            assert!(places.into_iter().eq(0..count as u32));
            let mut faces: Vec<u32> = parts.iter().map(|part| part.face).collect();
            faces.sort_unstable();
            assert!(faces.into_iter().eq(0..count as u32));
        }
    }
}
