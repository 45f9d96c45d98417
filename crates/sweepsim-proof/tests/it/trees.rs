//! The nodes of trees in certificates.

use std::collections::BTreeSet;

/// Where the node ends that begins somewhere in a tree.
pub(crate) fn after(bytes: &[u8], at: usize) -> Option<usize> {
    Some(match *bytes.get(at)? {
        0 => after(bytes, after(bytes, at + 1)?)?,
        1 => {
            let count = bytes.get(at + 1)?.count_ones();
            let mut end = at + 2;
            for _ in 0..count {
                end = after(bytes, end)?;
            }
            end
        }
        kind => {
            let mut end = at + 1;
            let normals = match kind {
                7 => {
                    end += 1;
                    *bytes.get(at + 1)?
                }
                _ => [0, 0, 0, 0, 0, 1, 1, 0, 2][usize::from(kind)],
            };
            for _ in 0..normals {
                let number = end;
                end = last(bytes, end);
                match bytes[number] {
                    0 => end += 12,
                    1 => end = last(bytes, end),
                    _ => {}
                }
            }
            end
        }
    })
}

/// The end of a number.
fn last(bytes: &[u8], at: usize) -> usize {
    at + 1 + bytes[at..].iter().take_while(|byte| **byte >= 0x80).count()
}

/// Where nodes begin.
pub(crate) fn nodes(bytes: &[u8]) -> BTreeSet<usize> {
    let (mut all, mut open) = (BTreeSet::new(), vec![0]);
    while let Some(at) = open.pop() {
        all.insert(at);
        let count = match bytes[at] {
            0 => 2,
            1 => bytes[at + 1].count_ones(),
            _ => 0,
        };
        let mut next = at + 1 + usize::from(bytes[at]);
        for _ in 0..count {
            open.push(next);
            next = after(bytes, next).expect("a node");
        }
    }
    all
}
