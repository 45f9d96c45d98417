//! Follows the trees of a certificate, whatever they are about.
//!
//! A node is a byte, and what belongs to it. It divides what it is about into parts, of which the nodes follow; or it
//! is a leaf, and says why a statement holds there. So the leaves are about all of it together.

use crate::vector::V3;

/// A leaf that does not hold.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Failed {
    /// The path and the move; of heights, nothing.
    pub place: Option<(usize, usize)>,
    /// Lower corner of the cell.
    pub low: [f64; 3],
    /// Upper corner of the cell.
    pub high: [f64; 3],
    /// Why.
    pub why: &'static str,
}

/// What a check has found.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Checked {
    /// What is measured is no more, if nothing failed.
    pub bound: f64,
    /// The nodes of all trees.
    pub nodes: usize,
    /// What does not hold: some of it.
    pub failed: Vec<Failed>,
    /// How much that is.
    pub failed_count: usize,
    /// What is wrong with the claim as a whole.
    pub wrong: Option<String>,
}

/// As many failures are described.
const MOST_FAILED: usize = 20;
/// Nothing is divided more often.
const DEEPEST: usize = 200;

impl Checked {
    /// Whether what is claimed is proven.
    #[must_use]
    pub fn is_proven(&self) -> bool {
        self.failed_count == 0 && self.wrong.is_none()
    }

    pub(crate) fn nothing() -> Self {
        let bound = f64::NEG_INFINITY;
        Self {
            bound,
            ..Self::default()
        }
    }

    pub(crate) fn fail(&mut self, place: Option<(usize, usize)>, [low, high]: [V3; 2], why: &'static str) {
        self.failed_count += 1;
        if self.failed.len() < MOST_FAILED {
            self.failed.push(Failed { place, low, high, why });
        }
    }

    pub(crate) fn join(&mut self, other: Self) {
        self.nodes += other.nodes;
        self.bound = self.bound.max(other.bound);
        self.failed_count += other.failed_count;
        self.failed.extend(other.failed);
    }
}

/// Reads bytes.
pub(crate) struct Reader<'a>(pub &'a [u8]);

impl<'a> Reader<'a> {
    pub fn byte(&mut self) -> Option<u8> {
        self.bytes(1).map(|own| own[0])
    }

    /// Groups of seven bits, the lowest first.
    pub fn number(&mut self) -> Option<usize> {
        let mut number = 0_usize;
        for shift in (0..35).step_by(7) {
            let byte = self.byte()?;
            number |= usize::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Some(number);
            }
        }
        None
    }

    pub fn bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        let (own, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(own)
    }

    /// Nothing if it is not `there`.
    pub fn float_if(&mut self, there: bool) -> Option<Option<f64>> {
        if there { self.float().map(Some) } else { Some(None) }
    }

    pub fn float(&mut self) -> Option<f64> {
        let bytes = self.bytes(4)?;
        Some(f64::from(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])))
    }
}

/// A path and a move, if it is about one; and a lower and an upper corner.
pub(crate) type Place = (Option<(usize, usize)>, [V3; 2]);

/// Into which parts a node divides something; nothing where it is a leaf that holds, or else why it does not. `None` if
/// it cannot be read.
pub(crate) type Step<P> = Option<Result<Vec<P>, &'static str>>;

/// What trees prove.
pub(crate) trait Proof {
    /// What a node is about.
    type Part;

    /// What a node does.
    fn node(&mut self, part: &Self::Part, kind: u8, reader: &mut Reader, found: &mut Checked) -> Step<Self::Part>;

    /// Where something is.
    fn place(&self, part: &Self::Part) -> Place;
}

/// Looks at the trees of some parts.
pub(crate) fn walked<P: Proof>(mut proof: P, roots: &[P::Part], bytes: &[u8]) -> Checked {
    let (mut reader, mut found) = (Reader(bytes), Checked::nothing());
    for root in roots {
        if follow(&mut proof, root, &mut reader, &mut found, 0).is_none() {
            let (place, around) = proof.place(root);
            found.fail(place, around, "the tree ends early, or is none");
            return found;
        }
    }
    if !reader.0.is_empty() {
        found.fail(None, [[0.0; 3]; 2], "something comes after the tree");
    }
    found
}

fn follow<P: Proof>(
    proof: &mut P,
    part: &P::Part,
    reader: &mut Reader,
    found: &mut Checked,
    depth: usize,
) -> Option<()> {
    found.nodes += 1;
    let kind = reader.byte().filter(|_| depth < DEEPEST)?;
    match proof.node(part, kind, reader, found)? {
        Ok(parts) => { parts.iter() }.try_for_each(|part| follow(proof, part, reader, found, depth + 1)),
        Err(why) => {
            let (place, around) = proof.place(part);
            found.fail(place, around, why);
            Some(())
        }
    }
}
