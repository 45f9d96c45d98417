//! Certificates of scenes with a known answer, and whatever may be done to them.

use crate::scenes::waves;
use crate::walls::{LIMITS, cut, slot};
use std::collections::BTreeSet;
use sweepsim_check::{Certificate, Checked, Claim, Curve, Scene, TreePart, check, digest_of, trees};
use sweepsim_dexel::TriangleSoup;
use sweepsim_motion::{Path, Pose, Tool};
use sweepsim_proof::{Cutter, Enclosed, Limits, Target, Tree, claim, cover, deepest_recorded, scene};

/// A proof, what it is about, and what is claimed.
pub(crate) struct Certified {
    pub found: Enclosed,
    pub scene: Scene,
    pub claim: Claim,
}

pub(crate) fn certified(soup: &TriangleSoup, tool: &Tool, path: &Path, limits: &Limits) -> Certified {
    let target = Target::new(soup).expect("closed");
    let solids = cover(tool, 0.01 * limits.depth);
    let cutter = Cutter {
        solids: &solids,
        path,
        others: None,
    };
    let found = deepest_recorded(&target, &[cutter], limits, &()).expect("not cancelled");
    let own = [(1, cutter)];
    Certified {
        scene: scene(soup, [(1, tool)], &own, limits),
        claim: claim(&target, &own, limits, &found).expect("recorded"),
        found,
    }
}

impl Certified {
    pub fn checked(&self) -> Checked {
        check(&self.scene, &self.claim, 1)
    }

    /// It is accepted, with a bound that holds the truth.
    pub fn check(&self, truth: f64) {
        let checked = self.checked();
        assert!(checked.is_proven(), "{checked:?}");
        assert!(
            truth <= checked.bound && checked.bound <= self.found.bound + 1e-6,
            "{truth} {} {}",
            checked.bound,
            self.found.bound
        );
    }
}

/// A wall that is cut too deep.
const TRUTH: f64 = 0.05;

fn small() -> Certified {
    let (tool, path) = cut();
    certified(&slot(-5.0, 5.0 - TRUTH, 2.0), &tool, &path, &LIMITS)
}

fn written(certified: &Certified) -> Vec<u8> {
    let (digest, claims) = (certified.scene.digest(), vec![certified.claim.clone()]);
    let certificate = Certificate::new("a test".into(), serde_json::json!({"a": 1}), Vec::new(), digest, claims);
    certificate.written().expect("a notation").into_bytes()
}

#[test]
fn every_changed_byte_is_refused() {
    let text = written(&small());
    assert!(Certificate::read(&text).is_ok());
    for number in 0..text.len() {
        for by in [1, 2, 0x10, 0x80] {
            let mut changed = text.clone();
            changed[number] ^= by;
            assert!(Certificate::read(&changed).is_err(), "byte {number}");
        }
        assert!(Certificate::read(&text[..number]).is_err());
    }
}

/// With a digest that fits, a change is seen in the content: what is accepted is still true.
#[test]
fn what_is_accepted_after_a_change_is_true() {
    let certified = small();
    let text = written(&certified);
    let end = text.len() - ",\"digest\":\"\"}\n".len() - 64;
    let (mut read, mut proven) = (0, 0);
    for number in 0..end {
        for by in [1, 3, 4, 0x10] {
            let mut changed = text[..end].to_vec();
            changed[number] ^= by;
            let digest = digest_of(&changed);
            changed.extend(format!(",\"digest\":\"{digest}\"}}\n").into_bytes());
            let Ok(certificate) = Certificate::read(&changed) else {
                continue;
            };
            read += 1;
            if certificate.scene != certified.scene.digest() {
                continue;
            }
            for claim in &certificate.statement {
                if check(&certified.scene, claim, 1).is_proven() {
                    proven += 1;
                    let [lo, hi] = claim.enclosure;
                    assert!(
                        claim.about == "gouge" && lo <= TRUTH && hi >= TRUTH,
                        "byte {number}: {lo} {hi}"
                    );
                }
            }
        }
    }
    // Changes of numbers beyond what is needed are harmless, most others are not.
    assert!(read > 1000 && proven > 10 && proven < read / 2, "{proven} of {read}");
}

/// The claim with other trees.
fn with(certified: &Certified, change: impl Fn(&Tree) -> Vec<u8>) -> Claim {
    let changed: Vec<(Tree, Vec<u8>)> = certified
        .found
        .trees
        .iter()
        .map(|tree| (tree.clone(), change(tree)))
        .collect();
    let mut claim = certified.claim.clone();
    claim.trees = trees(changed.iter().map(|(tree, bytes)| TreePart {
        path: tree.path,
        moves: [tree.moves.start, tree.moves.len()],
        solid: tree.solid,
        bytes,
    }));
    claim
}

/// However a tree is changed, it does not prove what is not true.
#[test]
fn no_tree_proves_too_little() {
    let certified = small();
    let bytes = certified.found.trees[0].bytes.clone();
    let too_little = |claim: Claim| Claim {
        enclosure: [0.0, TRUTH - 1e-6],
        ..claim
    };
    let mut refused = 0;
    for number in (0..bytes.len()).step_by(3) {
        for byte in (0..=11).chain([0x80, 0xff]) {
            let change = |tree: &Tree| {
                let mut bytes = tree.bytes.clone();
                bytes[number] = byte;
                bytes
            };
            let claim = with(&certified, change);
            let checked = check(&certified.scene, &claim, 1);
            refused += usize::from(!checked.is_proven());
            assert!(!check(&certified.scene, &too_little(claim), 1).is_proven());
        }
        // A byte is missing, or there is one more.
        for count in [0, 2] {
            let change = |tree: &Tree| {
                let own = std::iter::repeat_n(tree.bytes[number], count);
                let bytes = tree.bytes.iter().copied();
                bytes
                    .clone()
                    .take(number)
                    .chain(own)
                    .chain(bytes.skip(number + 1))
                    .collect()
            };
            let claim = with(&certified, change);
            let checked = check(&certified.scene, &claim, 1);
            refused += usize::from(!checked.is_proven());
            assert!(!check(&certified.scene, &too_little(claim), 1).is_proven());
        }
    }
    assert!(refused > 2 * bytes.len(), "{refused} of {}", 5 * bytes.len());
}

/// Where the node ends that begins somewhere in a tree.
fn after(bytes: &[u8], at: usize) -> Option<usize> {
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
            let normals = [0, 0, 0, 0, 0, 1, 1, 1, 2, 3, 2][usize::from(kind)];
            let mut end = at + 1;
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
fn nodes(bytes: &[u8]) -> BTreeSet<usize> {
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

#[test]
fn leaves_and_divisions_are_needed() {
    let certified = small();
    let refused = |change: &dyn Fn(&Tree) -> Vec<u8>| {
        let checked = check(&certified.scene, &with(&certified, change), 1);
        assert!(!checked.is_proven(), "{checked:?}");
    };
    let bytes = &certified.found.trees[0].bytes;
    // Without the last leaf; with one more; without the first division.
    refused(&|tree| tree.bytes[..tree.bytes.len() - 1].to_vec());
    refused(&|tree| [&tree.bytes[..], &[2]].concat());
    refused(&|tree| tree.bytes[1..].to_vec());
    refused(&|_| vec![4]);
    refused(&|_| Vec::new());
    refused(&|_| vec![0; 1000]);
    refused(&|_| [1, 255].repeat(1000));
    let twice = |claim: &Claim| Claim {
        trees: trees([0, 1].map(|_| TreePart {
            path: 0,
            moves: [0, 3],
            solid: 0,
            bytes,
        })),
        ..claim.clone()
    };
    assert!(!check(&certified.scene, &twice(&certified.claim), 1).is_proven());
    let none = Claim {
        trees: trees([]),
        ..certified.claim.clone()
    };
    assert!(!check(&certified.scene, &none, 1).is_proven());
}

/// Both halves of a division of time, exchanged, prove what they prove: mostly nothing.
#[test]
fn times_are_not_exchanged() {
    let tool = Tool::ball(2.0, 30.0).expect("a tool");
    let pose = |k: u32| {
        let part = f64::from(k) / 8.0;
        let tip = [-8.0 + 16.0 * part, -3.0 + 2.0 * part, -0.3 + (3.0 * part).sin()];
        Pose::new(tip, [0.3 * (5.0 * part).cos(), 0.4 * part, 1.0]).expect("a pose")
    };
    let path = Path::new((0..9).map(pose).collect()).expect("a path");
    let certified = certified(&waves(0.8, 24), &tool, &path, &LIMITS);
    let known = certified.claim.enclosure[0];
    assert!(known > 0.1);
    certified.check(known);
    let bytes = &certified.found.trees[0].bytes;
    let (mut exchanged, mut refused) = (0, 0);
    for number in nodes(bytes).into_iter().filter(|number| bytes[*number] == 0).take(60) {
        let middle = after(bytes, number + 1).expect("a node");
        let end = after(bytes, middle).expect("a node");
        let (first, second) = (&bytes[number + 1..middle], &bytes[middle..end]);
        let own = [&bytes[..=number], second, first, &bytes[end..]].concat();
        let claim = with(&certified, |_| own.clone());
        exchanged += 1;
        refused += usize::from(!check(&certified.scene, &claim, 1).is_proven());
        let claim = Claim {
            enclosure: [0.0, known - 1e-6],
            ..claim
        };
        assert!(!check(&certified.scene, &claim, 1).is_proven());
    }
    assert!(refused > exchanged / 2 && refused > 10, "{refused} of {exchanged}");
}

#[test]
fn other_scenes_are_refused() {
    let certified = small();
    let digest = certified.scene.digest();
    let refused = |change: &dyn Fn(&mut Scene), is_worse: bool| {
        let mut scene = certified.scene.clone();
        change(&mut scene);
        assert_ne!(scene.digest(), digest);
        if is_worse {
            assert!(!check(&scene, &certified.claim, 1).is_proven());
        }
    };
    refused(&|scene| scene.deviation *= 2.0, false);
    refused(&|scene| scene.triangles[3][1][2] += 1e-12, true);
    refused(&|scene| scene.triangles.truncate(scene.triangles.len() - 1), true);
    refused(&|scene| scene.triangles[5].swap(0, 1), true);
    refused(&|scene| scene.paths[0].poses[1][0][2] -= 0.1, true);
    refused(&|scene| scene.paths[0].poses[2][0][1] += 0.01, true);
    refused(&|scene| scene.paths[0].poses.truncate(3), true);
    refused(&|scene| scene.paths[0].tool = 2, true);
    refused(
        &|scene| scene.paths[0].others.push((1, vec![[[0.0; 3], [0.0, 0.0, 1.0]]])),
        false,
    );
    refused(&|scene| scene.paths[0].others.push((7, Vec::new())), true);
    // A larger tool is not covered.
    let larger = |scene: &mut Scene| {
        for curve in &mut scene.tools[0].1.curves {
            if let Curve::Line(ends) = curve {
                ends.iter_mut().for_each(|end| end[0] *= 1.001);
            }
        }
    };
    refused(&larger, true);
    // Nor is one by smaller solids, or by none.
    let mut claim = certified.claim.clone();
    for corner in &mut claim.tools.get_mut(&1).expect("a tool")[0].corners {
        corner[0] *= 0.999;
    }
    assert!(!check(&certified.scene, &claim, 1).is_proven());
    claim.tools.clear();
    assert!(!check(&certified.scene, &claim, 1).is_proven());
    // A cube that leaves out part of the target.
    let mut claim = certified.claim.clone();
    claim.root.0[1] -= 25.0;
    assert!(!check(&certified.scene, &claim, 1).is_proven());
    // A deeper witness.
    let mut claim = certified.claim.clone();
    claim.enclosure[0] += 1e-3;
    assert!(!check(&certified.scene, &claim, 1).is_proven());
}
