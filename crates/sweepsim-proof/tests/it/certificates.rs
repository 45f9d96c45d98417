//! Certificates of scenes with a known answer, and whatever may be done to them.

use sweepsim_check::{Checked, Claim, Scene, check};
use sweepsim_dexel::TriangleSoup;
use sweepsim_motion::{Path, Tool};
use sweepsim_proof::{Cutter, Enclosed, Limits, Target, claim, cover, deepest_recorded, scene};

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
