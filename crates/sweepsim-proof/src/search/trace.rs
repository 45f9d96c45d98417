//! What a search leaves behind, so that a checker can follow it: the divisions, and a bound for each pair that was not
//! divided.
//!
//! A node is a byte, and what belongs to it:
//!
//! | byte | node |
//! | --- | --- |
//! | 0 | The time is divided: two nodes. |
//! | 1 | The cell is divided. A byte tells which of the eight cells the moving solid may reach; a node for each of these. |
//! | 2 | The box that the solid sweeps misses the cell. |
//! | 3 | Nothing of the surface is near the cell, and it is outside of the target; of distances, only the former. |
//! | 4 | Bound by the depth of the cell's middle. |
//! | 5 | A plane separates the solid from the cell: a normal. |
//! | 6 | The solid, or all of the cell, lifted above a plane: its normal. |
//! | 7 | The same above several planes at once: how many, a byte, and their normals. |
//! | 8 | Between two planes: their normals. |
//!
//! A normal is a number `k`: 0, and three `f32`; or 1, and the number of a triangle; or that which was written
//! `k − 1` normals ago. Numbers are in groups of seven bits, the lowest first; each but the last has its
//! highest bit set.

use crate::numbers::write_number;
use crate::solid::{MOST_PLANES, Written};
use std::collections::HashMap;

/// Why no point in a cell is deeper at a time. Less than no depth is a distance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(u8)]
pub(super) enum Reason {
    Missed = 2,
    Outside = 3,
    Middle = 4,
    Separated = 5,
    Lifted = 6,
    LiftedAbove = 7,
    Slab = 8,
}

/// The normals of a bound.
pub(super) type Normals = [Option<Written>; MOST_PLANES];
/// Of a bound without any.
pub(super) const NO_NORMALS: Normals = [None; MOST_PLANES];

/// Of a bound with one.
pub(super) fn one(normal: Written) -> Normals {
    let mut normals = NO_NORMALS;
    normals[0] = Some(normal);
    normals
}

#[derive(Clone, Copy, Debug)]
struct Node {
    /// No point is deeper.
    value: f64,
    reason: Option<Reason>,
    /// Where its normals begin, and how many they are.
    normals: u32,
    count: u8,
    divided: Division,
}

#[derive(Clone, Copy, Debug)]
enum Division {
    None,
    /// The number of the first of two.
    Time(u32),
    /// That of the first of eight.
    Cell(u32),
}

const NODE: Node = Node {
    value: f64::INFINITY,
    reason: None,
    normals: 0,
    count: 0,
    divided: Division::None,
};

/// The nodes of a search, if it is recorded.
#[derive(Debug)]
pub(super) struct Trace {
    recorded: bool,
    nodes: Option<Vec<Node>>,
    normals: Vec<Written>,
}

/// A search with more nodes, of some thirty bytes each, is not recorded.
const MOST_NODES: usize = 8_000_000;

impl Trace {
    pub fn new(recorded: bool) -> Self {
        Self {
            recorded,
            nodes: recorded.then(|| vec![NODE]),
            normals: Vec::new(),
        }
    }

    /// The bound of a node, if it is better than what is known of it.
    pub fn bound(&mut self, node: u32, reason: Reason, normals: Normals, value: f64) {
        let Some(nodes) = &mut self.nodes else { return };
        let node = &mut nodes[node as usize];
        if value < node.value {
            (node.value, node.reason, node.normals) = (value, Some(reason), self.normals.len() as u32);
            self.normals.extend(normals.iter().flatten());
            node.count = (self.normals.len() - node.normals as usize) as u8;
        }
    }

    /// Divides the time of a node: the number of its first part; the second comes after it.
    pub fn divide_time(&mut self, node: u32) -> u32 {
        self.divide(node, 2, Division::Time)
    }

    /// Divides the cell of a node: the number of its first part; the others come after it.
    pub fn divide_cell(&mut self, node: u32) -> u32 {
        self.divide(node, 8, Division::Cell)
    }

    fn divide(&mut self, node: u32, parts: usize, division: impl Fn(u32) -> Division) -> u32 {
        let Some(nodes) = &mut self.nodes else { return 0 };
        let first = nodes.len() as u32;
        if nodes.len() > MOST_NODES {
            self.nodes = None;
            return 0;
        }
        nodes.extend(std::iter::repeat_n(NODE, parts));
        nodes[node as usize].divided = division(first);
        first
    }

    /// The tree down to where bounds are at most a value, in bytes: empty if it was too much. `None` if it was not
    /// to be recorded. `allowance`: of all bounds.
    pub fn written(&self, bound: f64, allowance: f64) -> Option<Vec<u8>> {
        let mut written = Writer::default();
        let mut open = vec![0_u32];
        while let (Some(nodes), Some(number)) = (&self.nodes, open.pop()) {
            let node = &nodes[number as usize];
            if let Some(reason) = node.reason.filter(|_| node.value + allowance <= bound) {
                written.bytes.push(reason as u8);
                if reason == Reason::LiftedAbove {
                    written.bytes.push(node.count);
                }
                let normals = &self.normals[node.normals as usize..];
                normals[..usize::from(node.count)]
                    .iter()
                    .for_each(|normal| written.normal(*normal));
                continue;
            }
            match node.divided {
                Division::Time(first) => {
                    written.bytes.push(0);
                    open.extend([first + 1, first]);
                }
                Division::Cell(first) => {
                    let reached = |part: &u32| nodes[(first + part) as usize].reason != Some(Reason::Missed);
                    let mask = (0..8).filter(reached).fold(0_u8, |mask, part| mask | 1 << part);
                    written.bytes.extend([1, mask]);
                    open.extend((0..8).rev().filter(reached).map(|part| first + part));
                }
                // Not bounded: no checker takes it.
                Division::None => written.bytes.push(Reason::Middle as u8),
            }
        }
        self.recorded.then_some(written.bytes)
    }
}

#[derive(Default)]
struct Writer {
    bytes: Vec<u8>,
    /// When each normal was written last.
    known: HashMap<[u32; 4], usize>,
    normals: usize,
}

impl Writer {
    fn normal(&mut self, normal: Written) {
        let key = match normal {
            Written::OfTriangle(number) => [1, number, 0, 0],
            Written::Given(short) => {
                let [x, y, z] = short.map(f32::to_bits);
                [0, x, y, z]
            }
        };
        let before = self.known.insert(key, self.normals);
        match (before, normal) {
            (Some(before), _) => write_number(&mut self.bytes, 1 + self.normals - before),
            (None, Written::OfTriangle(number)) => {
                write_number(&mut self.bytes, 1);
                write_number(&mut self.bytes, number as usize);
            }
            (None, Written::Given(short)) => {
                write_number(&mut self.bytes, 0);
                self.bytes.extend(short.iter().flat_map(|c| c.to_le_bytes()));
            }
        }
        self.normals += 1;
    }
}
