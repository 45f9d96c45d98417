//! Boxes that stay open.

use super::{Cause, UnresolvedBox};
use crate::System;
use crate::numbers::Row;

/// An open box in inner coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Open {
    pub lo: Row,
    pub hi: Row,
    pub cause: Cause,
    pub boxes: usize,
}

/// Merges boxes with the same cause that touch, or nearly so.
pub(crate) fn unite(open: &mut Vec<Open>, n: usize) {
    let near = |a: &Open, b: &Open| {
        a.cause == b.cause
            && (0..n).all(|j| {
                let pad = 0.5 * (a.hi[j] - a.lo[j]).max(b.hi[j] - b.lo[j]);
                a.lo[j] <= b.hi[j] + pad && b.lo[j] <= a.hi[j] + pad
            })
    };
    loop {
        let before = open.len();
        let mut united: Vec<Open> = Vec::with_capacity(before);
        for next in open.drain(..) {
            match united.iter_mut().find(|u| near(u, &next)) {
                Some(u) => {
                    for j in 0..n {
                        u.lo[j] = u.lo[j].min(next.lo[j]);
                        u.hi[j] = u.hi[j].max(next.hi[j]);
                    }
                    u.boxes += next.boxes;
                }
                None => united.push(next),
            }
        }
        *open = united;
        if open.len() == before {
            return;
        }
    }
}

/// The box in the domain's coordinates.
pub(crate) fn open_box(system: &System, open: &Open) -> UnresolvedBox {
    UnresolvedBox::new(system.outward(&open.lo, &open.hi), open.cause, open.boxes)
}
