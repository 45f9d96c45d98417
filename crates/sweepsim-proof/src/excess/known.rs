//! Answers to looks at patches that are known: they follow from the moves that come near.
//!
//! A search asks what was removed around some points. It is kept with a box that holds all of these, and a digest of
//! all stretches whose boxes meet it. If that is the same again, so is every answer within the search, and it asks for
//! the same points. Where in a program stretches are does not matter, only their order, but for records.

use super::found::Found;
use super::removed::Removed;
use crate::motion::{Bounds, blocks, digest};
use crate::recall::{Answer, QuestionDigest, Reading, Recall, Writing};
use nalgebra::Vector3;

/// Of blocks of stretches, which have a digest together: if one of them is another, what is near any of them is looked
/// at again.
const TOGETHER: [usize; 3] = [8, 8, 32];
/// So many of these have a box around all.
const BOXED: usize = 16;
/// Where the polynomial of digests is evaluated: odd, so that no digest is lost.
const BASE: u128 = 0x9e37_79b9_7f4a_7c15_f39c_c060_5ced_c835;

/// Stretches of all courses, some at a time: a box around what solids sweep there, and a digest.
pub(super) struct Blocks<'a> {
    recall: &'a dyn Recall,
    all: Vec<([f32; 6], u128)>,
    /// Boxes around some of these.
    hulls: Vec<[f32; 6]>,
    /// A digest of what is asked of all patches.
    question: QuestionDigest,
}

impl<'a> Blocks<'a> {
    /// `question`: what is known of the search but for the stretches. `recorded`: answers have the stretches' numbers.
    pub fn new(recall: &'a dyn Recall, removed: &Removed, mut question: Writing, recorded: bool) -> Self {
        let mut all = Vec::new();
        for (number, course) in removed.courses.iter().enumerate() {
            let solids: Vec<_> = course.solids.iter().map(|own| &*own.convex).collect();
            question.bytes(format!("{solids:?}").as_bytes());
            let stretches = course.stretches;
            let place = |number: usize| digest(&stretches[number].ends[0].tip);
            let ranges: Vec<_> = blocks(stretches.len(), TOGETHER, place).collect();
            let hulls = course.solids.iter().map(|own| own.boxes.hulls(&ranges));
            let hulls = hulls.reduce(|mut all, own| {
                all.iter_mut().zip(&own).for_each(|(a, b)| *a = hull(a, b));
                all
            });
            for (hull, some) in hulls.into_iter().flatten().zip(ranges) {
                let mut content = Writing::default();
                content.number(number);
                if recorded {
                    content.number(some.start);
                }
                stretches[some].iter().for_each(|stretch| stretch.write(&mut content));
                let digest = recall.digest(&content.0);
                all.push((hull, u128::from_le_bytes(std::array::from_fn(|k| digest[k]))));
            }
        }
        let some = all.chunks(BOXED);
        let hulls = some.map(|some| some[1..].iter().fold(some[0].0, |all, (own, _)| hull(&all, own)));
        Self {
            recall,
            hulls: hulls.collect(),
            all,
            question: recall.digest(&question.0),
        }
    }

    /// All stretches that may meet a box, in order, as the value of a polynomial with parts of their digests.
    fn around(&self, around: &Bounds) -> u128 {
        let (low, high) = (
            around.low.map(|c| (c as f32).next_down()),
            around.high.map(|c| (c as f32).next_up()),
        );
        let meets = |own: &[f32; 6]| (0..3).all(|k| high[k] >= own[k] && low[k] <= own[k + 3]);
        let near = self.hulls.iter().zip(self.all.chunks(BOXED));
        let near = near.filter(|(hull, _)| meets(hull)).flat_map(|(_, some)| some);
        let near = near.filter(|(own, _)| meets(own));
        near.fold(0, |value, (_, digest)| value.wrapping_mul(BASE).wrapping_add(*digest))
    }

    /// What is found at some patches: known, or as it is looked for; with a box around all that was asked for then.
    pub fn found(
        &self,
        asked: impl FnOnce(&mut Writing),
        count: usize,
        look: impl FnOnce() -> Option<(Vec<Found>, Bounds)>,
    ) -> Option<Vec<Found>> {
        let mut question = Writing(self.question.to_vec());
        asked(&mut question);
        let key = self.recall.digest(&question.0);
        let known = self.recall.recall(&key).and_then(|bytes| self.read(&bytes, count));
        if known.is_some() {
            return known;
        }
        let (found, around): (Vec<Found>, Bounds) = look()?;
        let mut answer = Writing::default();
        answer.floats(around.low.as_slice());
        answer.floats(around.high.as_slice());
        answer.0.extend(self.around(&around).to_le_bytes());
        answer.0.extend(Found::write_all(&found));
        self.recall.keep(&key, answer.0);
        Some(found)
    }

    fn read(&self, bytes: &[u8], count: usize) -> Option<Vec<Found>> {
        let mut from = Reading(bytes);
        let [low, high] = [from.point()?, from.point()?].map(Vector3::from);
        let (digest, rest) = from.0.split_first_chunk()?;
        let is_same = u128::from_le_bytes(*digest) == self.around(&Bounds { low, high });
        is_same.then(|| Found::read_all(rest, count))?
    }
}

/// A box around two boxes.
fn hull(a: &[f32; 6], b: &[f32; 6]) -> [f32; 6] {
    std::array::from_fn(|k| if k < 3 { a[k].min(b[k]) } else { a[k].max(b[k]) })
}

/// A box with nothing in it.
pub(super) fn nothing() -> Bounds {
    Bounds {
        low: Vector3::repeat(f64::INFINITY),
        high: Vector3::repeat(f64::NEG_INFINITY),
    }
}
