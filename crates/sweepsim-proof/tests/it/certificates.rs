//! Certificates of scenes with a known answer, and whatever may be done to them.

use crate::scenes::waves;
use crate::trees::{after, nodes};
use crate::walls::{LIFT, LIMITS, cut, slot};
use sweepsim_check::{
    Certificate, Checked, Claim, Course, Curve, Measure, Question, Scene, Tree, check, digest_of, packed,
};
use sweepsim_dexel::{Stock, TriangleSoup};
use sweepsim_motion::Pose;
use sweepsim_motion::{Path, Tool};
use sweepsim_proof::{
    Closest, Cutter, Enclosed, Left, Limits, Target, cover_and_cores, deepest, depth_claim, distance_claim,
    height_claim, margin, motions, outline, regions,
};

/// A proof, what it is about, and what is claimed.
pub(crate) struct Certified {
    pub found: Enclosed,
    pub scene: Scene,
    pub claim: Claim,
}

/// One tool on one path, and a solid. `limit`: less than 0 of distances.
pub(crate) fn scene(
    soup: &TriangleSoup,
    (tool, cutter): (&Tool, &Cutter),
    limits: &Limits,
    (measure, limit): (Measure, f64),
    stock: Option<&Stock>,
) -> Scene {
    let size = soup.triangles.as_flattened().as_flattened().iter();
    let size = size.fold(0.0, |size: f64, c| size.max(c.abs()));
    let margin = margin(size, &[*cutter], limits);
    Scene {
        solids: vec![soup.triangles.clone()],
        outlines: vec![outline(tool, true)],
        paths: vec![motions(cutter, limits.deviation, &|_| false)],
        deviation: limits.deviation,
        stock: stock.and_then(|stock| regions(stock, 6.0 * margin)).unwrap_or_default(),
        skin: 6.0 * margin,
        margin,
        questions: vec![Question {
            about: "a test".into(),
            measure,
            limit,
            solid: 0,
            movers: vec![(0, 0)],
            cutters: Vec::new(),
        }],
    }
}

pub(crate) fn certified(soup: &TriangleSoup, tool: &Tool, path: &Path, limits: &Limits) -> Certified {
    let target = Target::new(soup, LIFT).expect("closed");
    let solids = cover_and_cores(tool, 0.01 * limits.depth);
    let cutter = Cutter::new(&solids, path, None);
    let found = deepest(&target, &[cutter], limits, true, &()).expect("not cancelled");
    let scene = scene(soup, (tool, &cutter), limits, (Measure::Depth, limits.depth), None);
    let claim = depth_claim(&scene, &scene.questions[0], &target, &[(0, cutter)], &found).expect("recorded");
    Certified { found, scene, claim }
}

/// What is claimed of heights is accepted, and less than that is not. Nothing is claimed where it is not known, or only
/// that it is less than the size of target and tool. Whether something is claimed.
pub(crate) fn check_height(
    (soup, stock): (&TriangleSoup, &Stock),
    (tool, cutter): (&Tool, &Cutter),
    limits: &Limits,
    left: &Left,
) -> bool {
    let scene = scene(
        soup,
        (tool, cutter),
        limits,
        (Measure::Height, limits.depth),
        Some(stock),
    );
    let claim = height_claim(&scene, &scene.questions[0], &[(0, *cutter)], left);
    let size = soup.triangles.as_flattened().as_flattened().iter();
    let farthest = size.fold(0.0, |size: f64, c| size.max(c.abs())) + cutter.reach;
    assert_eq!(claim.is_some(), left.bound <= farthest);
    let Some(claim) = claim else {
        return false;
    };
    let own = checked(&scene, &claim);
    assert!(own.is_proven() && own.bound == left.bound, "{own:?}");
    if let Some((_, height)) = left.highest {
        // The stock counts without its skin.
        let claim = Claim {
            bound: height - 8.0 * scene.margin,
            ..claim
        };
        assert!(!checked(&scene, &claim).is_proven());
    }
    true
}

/// The same of distances.
pub(crate) fn check_distance(
    (soup, target): (&TriangleSoup, &Target),
    (tool, body): (&Tool, &Cutter),
    limits: &Limits,
    found: &Closest,
) {
    let scene = scene(soup, (tool, body), limits, (Measure::Depth, -limits.depth), None);
    let claim = distance_claim(&scene, &scene.questions[0], target, &[(0, *body)], found);
    assert_eq!(claim.is_some(), found.bound > 0.0);
    let Some(claim) = claim else { return };
    let own = checked(&scene, &claim);
    assert!(own.is_proven() && own.bound <= -found.bound, "{own:?} {}", found.bound);
    if let Some((_, nearest)) = &found.nearest {
        let claim = Claim {
            bound: -nearest.depth - 1e-6,
            ..claim
        };
        assert!(!checked(&scene, &claim).is_proven());
    }
}

/// What a checker says of a claim.
pub(crate) fn checked(scene: &Scene, claim: &Claim) -> Checked {
    check(scene, &scene.questions[0], claim, 1)
}

impl Certified {
    pub fn checked(&self) -> Checked {
        checked(&self.scene, &self.claim)
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
    let (digest, claims) = (certified.scene.digest(), vec![Some(certified.claim.clone())]);
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
        for by in [1, 2, 3, 4, 8, 0x10] {
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
            for claim in certificate.claims.iter().flatten() {
                if checked(&certified.scene, claim).is_proven() {
                    proven += 1;
                    let lo = claim.witness.as_ref().map_or(0.0, |witness| witness.depth);
                    let is_true = claim.about == "a test" && lo <= TRUTH && claim.bound >= TRUTH;
                    assert!(is_true, "byte {number}: {lo} {}", claim.bound);
                }
            }
        }
    }
    // Changes of numbers beyond what is needed are harmless, most others are not.
    assert!(read > 1000 && proven > 10 && proven < read / 2, "{proven} of {read}");
}

/// The claim with other trees.
fn with(certified: &Certified, change: impl Fn(&[u8]) -> Vec<u8>) -> Claim {
    let mut claim = certified.claim.clone();
    for (tree, own) in claim.trees.iter_mut().zip(&certified.found.trees) {
        tree.bytes = packed(&change(&own.bytes));
    }
    claim
}

/// However a tree is changed, it does not prove what is not true.
#[test]
fn no_tree_proves_too_little() {
    let certified = small();
    let bytes = certified.found.trees[0].bytes.clone();
    let too_little = |claim: Claim| Claim {
        bound: TRUTH - 1e-6,
        witness: None,
        ..claim
    };
    let mut refused = 0;
    for number in (0..bytes.len()).step_by(3) {
        for byte in (0..=10).chain([0x80, 0xff]) {
            let change = |tree: &[u8]| {
                let mut bytes = tree.to_vec();
                bytes[number] = byte;
                bytes
            };
            let claim = with(&certified, change);
            let own = checked(&certified.scene, &claim);
            refused += usize::from(!own.is_proven());
            assert!(!checked(&certified.scene, &too_little(claim)).is_proven());
        }
        // A byte is missing, or there is one more.
        for count in [0, 2] {
            let change = |tree: &[u8]| {
                let own = std::iter::repeat_n(tree[number], count);
                let bytes = tree.iter().copied();
                bytes
                    .clone()
                    .take(number)
                    .chain(own)
                    .chain(bytes.skip(number + 1))
                    .collect()
            };
            let claim = with(&certified, change);
            let own = checked(&certified.scene, &claim);
            refused += usize::from(!own.is_proven());
            assert!(!checked(&certified.scene, &too_little(claim)).is_proven());
        }
    }
    assert!(refused > 2 * bytes.len(), "{refused} of {}", 5 * bytes.len());
}

#[test]
fn leaves_and_divisions_are_needed() {
    let certified = small();
    let refused = |change: &dyn Fn(&[u8]) -> Vec<u8>| {
        let own = checked(&certified.scene, &with(&certified, change));
        assert!(!own.is_proven(), "{own:?}");
    };
    // Without the last leaf; with one more; without the first division.
    refused(&|tree| tree[..tree.len() - 1].to_vec());
    refused(&|tree| [tree, &[2]].concat());
    refused(&|tree| tree[1..].to_vec());
    refused(&|_| vec![4]);
    refused(&|_| Vec::new());
    refused(&|_| vec![0; 1000]);
    refused(&|_| [1, 255].repeat(1000));
    let mut claim = certified.claim.clone();
    claim.trees.extend(certified.claim.trees.clone());
    assert!(!checked(&certified.scene, &claim).is_proven());
    claim.trees = Vec::<Tree>::new();
    assert!(!checked(&certified.scene, &claim).is_proven());
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
    let known = certified.claim.witness.as_ref().expect("a witness").depth;
    assert!(known > 0.1);
    certified.check(known);
    let bytes = &certified.found.trees[0].bytes;
    let (mut exchanged, mut refused) = (0, 0);
    for number in nodes(bytes).into_iter().filter(|number| bytes[*number] == 0).take(30) {
        let middle = after(bytes, number + 1).expect("a node");
        let end = after(bytes, middle).expect("a node");
        let (first, second) = (&bytes[number + 1..middle], &bytes[middle..end]);
        let own = [&bytes[..=number], second, first, &bytes[end..]].concat();
        let claim = with(&certified, |_| own.clone());
        exchanged += 1;
        refused += usize::from(!checked(&certified.scene, &claim).is_proven());
        let claim = Claim {
            bound: known - 1e-6,
            witness: None,
            ..claim
        };
        assert!(!checked(&certified.scene, &claim).is_proven());
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
            assert!(!checked(&scene, &certified.claim).is_proven());
        }
    };
    refused(&|scene| scene.deviation *= 2.0, false);
    refused(&|scene| scene.solids[0][3][1][2] += 1e-12, true);
    refused(&|scene| scene.solids[0].truncate(5), true);
    refused(&|scene| scene.solids[0][5].swap(0, 1), true);
    let moved = |scene: &mut Scene, number: usize, by: [f64; 3]| {
        let Course::Linear(poses) = &mut scene.paths[0][number].course else {
            panic!("linear")
        };
        (0..3).for_each(|k| poses[1][0][k] += by[k]);
    };
    refused(&|scene| moved(scene, 1, [0.0, 0.0, -0.1]), true);
    refused(&|scene| moved(scene, 1, [0.0, 0.01, 0.0]), true);
    refused(&|scene| scene.paths[0].truncate(2), true);
    refused(&|scene| scene.paths.clear(), true);
    refused(&|scene| scene.outlines.clear(), true);
    refused(&|scene| scene.paths[0][1].possible = true, false);
    // A larger tool is not lifted out as the smaller one is.
    let larger = |scene: &mut Scene| {
        for curve in &mut scene.outlines[0].curves {
            if let Curve::Bezier(ends) = curve {
                ends.iter_mut().for_each(|(end, _)| end[0] *= 1.001);
            }
        }
    };
    refused(&larger, true);
    // Nor is part of its outline left out, or covered twice.
    for cover in [
        vec![],
        vec![[2, 1]],
        vec![[3, 1], [3, 1]],
        vec![[3, 2]],
        vec![[1, 0], [3, 1]],
    ] {
        let mut claim = certified.claim.clone();
        claim.covers[0] = cover;
        assert!(!checked(&certified.scene, &claim).is_proven());
    }
    // A cube that leaves out part of the target.
    let mut claim = certified.claim.clone();
    claim.root.0[1] -= 25.0;
    assert!(!checked(&certified.scene, &claim).is_proven());
    // A deeper witness.
    let mut claim = certified.claim.clone();
    claim.witness.as_mut().expect("a witness").depth += 1e-3;
    assert!(!checked(&certified.scene, &claim).is_proven());
}
