//! What a search leaves behind for a checker: of each zone of a motion, a tree.
//!
//! A node is a byte, and what belongs to it; all parts of a division follow.
//!
//! | byte | node |
//! | --- | --- |
//! | 1 | Beside the stock: for each of its regions how many planes, a byte; their numbers, each with its weight, an `f32`, if there are several. |
//! | 2 | Outside of the stock. |
//! | 3 | Removed: the numbers of the cutter, of its solid, and of the stretch among those on which it cuts; the time, an `f32`, if that is not straight. |
//! | 4 | Removed between two times: the same, and both times. |
//! | 5 | In the cutter that moves along: the number of its solid. |
//! | 10, 11, 12, 13 | Divided: time in half, the outline into its pieces, one of these in half, angles. |
//! | 14 | Cut at a height, an `f32`: what is below, and what is above. |

use crate::numbers::write_number;
use smallvec::SmallVec;

/// A node with what belongs to it, but for its parts.
pub(super) type Bytes = SmallVec<[u8; 16]>;

/// What holds all of a zone: a cutter, one of its solids, a stretch of its path on which it cuts; and when, if that
/// matters, for all of it, or for the first and the last time of the zone.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Holder {
    pub numbers: [usize; 3],
    pub times: SmallVec<[f32; 2]>,
}

#[derive(Clone, Debug, Default)]
struct Node {
    /// Empty as long as nothing is known.
    bytes: Bytes,
    /// The first of its parts, and how many they are.
    parts: [usize; 2],
}

/// Trees of some zones.
pub(super) struct Record {
    nodes: Vec<Node>,
    roots: usize,
}

impl Record {
    pub fn new(roots: usize) -> Self {
        let nodes = vec![Node::default(); roots];
        Self { nodes, roots }
    }

    /// Why a zone is done; nothing if a checker could not see it.
    pub fn done(&mut self, node: usize, why: Option<Bytes>) {
        self.nodes[node].bytes = why.unwrap_or_default();
    }

    /// Into how many parts a zone is divided; the first of them.
    pub fn divided(&mut self, node: usize, how: Bytes, parts: usize) -> usize {
        let first = self.nodes.len();
        self.nodes[node] = Node {
            bytes: how,
            parts: [first, parts],
        };
        self.nodes.resize(first + parts, Node::default());
        first
    }

    /// All trees, one after the other; nothing if something is not known.
    pub fn trees(&self) -> Option<Vec<u8>> {
        let mut all = Vec::new();
        let mut open: Vec<usize> = (0..self.roots).rev().collect();
        while let Some(number) = open.pop() {
            let node = &self.nodes[number];
            if node.bytes.is_empty() {
                return None;
            }
            all.extend_from_slice(&node.bytes);
            let [first, parts] = node.parts;
            open.extend((first..first + parts).rev());
        }
        Some(all)
    }
}

impl Holder {
    pub fn bytes(&self) -> Bytes {
        let mut bytes = Bytes::from_slice(&[if self.times.len() < 2 { 3 } else { 4 }]);
        self.numbers.iter().for_each(|own| write_number(&mut bytes, *own));
        bytes.extend(self.times.iter().flat_map(|time| time.to_le_bytes()));
        bytes
    }
}
