//! The whole check: what must fit together before trees are walked, and the witness.

use crate::certificate::{Claim, Tree, unpacked};
use crate::clear::Clear;
use crate::depth::{Cell, depths};
use crate::height::{Left, off, patches};
use crate::motion::{Run, Stretch};
use crate::scene::{Course, Measure, Motion, Question, Scene};
use crate::surface::Surface;
use crate::tool::{Body, Cutting, bodies, bridged, cores};
use crate::tree::{Checked, walked};
use crate::vector::{EPS, MORE, add, norm, norm_up, scaled, sub};
use crate::zone::Ring;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

/// Checks what is claimed in answer to a question: that what is measured is at most its bound, and at least as much
/// as at its witness. `threads`: how many work at it.
#[must_use]
pub fn check(scene: &Scene, question: &Question, claim: &Claim, threads: usize) -> Checked {
    match found(scene, question, claim, threads) {
        Err(wrong) => Checked {
            wrong: Some(wrong),
            ..Checked::default()
        },
        Ok(mut checked) => {
            checked.failed.sort_by_key(|failed| failed.place);
            checked.failed.truncate(20);
            checked
        }
    }
}

/// What is claimed in answer to a question, with the solids that cover all that moves; and those that this holds, and
/// what cuts.
struct Asked<'a> {
    scene: &'a Scene,
    question: &'a Question,
    claim: &'a Claim,
    movers: &'a [Vec<Body>],
    within: &'a [Vec<Body>],
    threads: usize,
}

/// Trees of more motions are not taken.
const MOST_MOTIONS: usize = 1 << 16;

fn found(scene: &Scene, question: &Question, claim: &Claim, threads: usize) -> Result<Checked, String> {
    let is_length = |length: f64| length >= 0.0 && length.is_finite();
    if claim.about != question.about || !claim.bound.is_finite() || !is_length(scene.deviation) {
        return Err("the claim does not answer the question".into());
    }
    let (mut movers, mut within) = (Vec::new(), Vec::new());
    for (number, (path, outline)) in question.movers.iter().chain(&question.cutters).enumerate() {
        let (outline, cover) = (scene.outlines.get(*outline), claim.covers.get(number));
        let (outline, cover) = outline
            .zip(cover)
            .ok_or("something that moves has no outline, or no cover")?;
        let own = bodies(&outline.curves, cover)?;
        within.push(bridged([own.clone(), cores(&outline.cores)?].concat()));
        movers.push(own);
        scene.paths.get(*path).ok_or("something that moves has no path")?;
    }
    movers.truncate(question.movers.len());
    let asked = Asked {
        scene,
        question,
        claim,
        movers: &movers,
        within: &within,
        threads,
    };
    if matches!(question.measure, Measure::Material | Measure::MaterialInRapids) {
        return asked.material();
    }
    let triangles = scene.solids.get(question.solid).ok_or("there is no such solid")?;
    let surface = Surface::new(triangles)?;
    match question.measure {
        Measure::Height => asked.height(&surface),
        _ => asked.depth(&surface),
    }
}

/// In parts of the way to the middle of a solid.
const INNER: f64 = 1e-10;

/// No margin is less than this, in parts of the largest coordinate: more than a thousand roundings, and what is flat.
const LEAST_MARGIN: f64 = 5e-9;

impl Asked<'_> {
    /// What is found of all trees.
    fn all(&self, one: impl Fn(&Tree, &[u8]) -> Checked + Sync) -> Result<Checked, String> {
        let (next, found) = (AtomicUsize::new(0), Mutex::new(Checked::nothing()));
        let work = || {
            while let Some(tree) = self.claim.trees.get(next.fetch_add(1, Ordering::Relaxed)) {
                let bytes = unpacked(&tree.bytes);
                let own = bytes.map_or_else(|| failed("the tree is not readable"), |bytes| one(tree, &bytes));
                found.lock().expect("no thread has panicked").join(own);
            }
        };
        std::thread::scope(|scope| {
            for _ in 1..self.threads.clamp(1, 256) {
                scope.spawn(work);
            }
            work();
        });
        found.into_inner().map_err(|_| "the check did not end".into())
    }

    /// Whether each solid of each mover has trees about all of its path, once: where one ends, the next begins.
    fn each_once(&self) -> Result<(), String> {
        let mut ends: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        for tree in &self.claim.trees {
            let end = ends.entry((tree.mover, tree.solid)).or_default();
            if *end != tree.first || tree.count == 0 {
                return Err("the trees are not about each motion once".into());
            }
            *end = end.saturating_add(tree.count);
        }
        for (mover, own) in self.movers.iter().enumerate() {
            let path = self.question.movers[mover].0;
            let is_whole = |solid: usize| ends.remove(&(mover, solid)).unwrap_or(0) == self.scene.paths[path].len();
            if !(0..own.len()).all(is_whole) {
                return Err(format!("not all motions of path {path} have a tree"));
            }
        }
        let is_all = ends.is_empty().then_some(());
        is_all.ok_or("there are trees of other paths or tools".into())
    }

    /// What cuts along some paths, in motions that do.
    fn cutting<'b>(
        &self,
        along: &[(usize, usize)],
        bodies: &'b [Vec<Body>],
        does: impl Fn(&Motion) -> bool,
    ) -> Vec<Cutting<'b>> {
        let motions = |path: usize| {
            let all = self.scene.paths[path].iter().enumerate();
            all.filter(|(_, motion)| does(motion))
                .map(|(number, _)| number)
                .collect()
        };
        let along = along.iter().zip(bodies);
        along
            .map(|((path, _), own)| (&own[..], *path, motions(*path)))
            .collect()
    }

    fn material(&self) -> Result<Checked, String> {
        if self.claim.witness.is_some() {
            return Err("depths in material have no witness".into());
        }
        self.each_once()?;
        let does = |motion: &Motion| !motion.possible && !motion.idle;
        let cutters = &self.within[self.movers.len()..];
        let clear = Clear {
            scene: self.scene,
            cutters: self.cutting(&self.question.cutters, cutters, does),
            idle_only: self.question.measure == Measure::MaterialInRapids,
            bound: self.claim.bound,
        };
        self.all(|tree, bytes| {
            let body = &self.movers[tree.mover][tree.solid];
            let motions = tree.first..tree.first + tree.count;
            let zones = clear.zones(body, self.question.movers[tree.mover].0, motions);
            zones.map_or_else(|| failed("a motion is none"), |zones| walked(&clear, &zones, bytes))
        })
    }

    fn depth(&self, surface: &Surface) -> Result<Checked, String> {
        let (scene, claim) = (self.scene, self.claim);
        let (centre, half) = claim.root;
        let [low, high] = surface.bounds();
        // Added with rounding: compared with room for it.
        let room = 4.0 * EPS * (surface.size + half);
        let holds = |k: usize| centre[k] - half <= low[k] - room && centre[k] + half >= high[k] + room;
        let is_good = half > 0.0 && half.is_finite() && claim.lift >= 0.0;
        if !(is_good && (0..3).all(holds)) {
            return Err("the cube of the certificate does not hold the solid".into());
        }
        self.each_once()?;
        if claim.trees.iter().any(|tree| tree.count > MOST_MOTIONS) {
            return Err("a tree is about too many motions".into());
        }
        let new_root = || Arc::new(Cell::root(centre, half, claim.lift, surface));
        let root = Mutex::new(new_root());
        let one = |tree: &Tree, bytes: &[u8]| {
            let path = self.question.movers[tree.mover].0;
            let motions = &scene.paths[path][tree.first..tree.first + tree.count];
            let Some(stretches) = motions.iter().map(Stretch::new).collect::<Option<Vec<_>>>() else {
                return failed("a motion is none");
            };
            let body = &self.movers[tree.mover][tree.solid];
            if claim.bound < 0.0 && !starts_outside(body, &stretches, surface, -claim.bound) {
                return failed("it is not known that it is outside at the start");
            }
            let run = Run::new(body, &stretches);
            // Linear motions are exact.
            let is_exact = motions.iter().all(|own| matches!(own.course, Course::Linear(_)));
            let more = if is_exact { 0.0 } else { scene.deviation };
            // All trees share their cells, until these are many.
            let root = {
                let mut root = root.lock().expect("no thread has panicked");
                if surface.is_crowded() {
                    *root = new_root();
                }
                Arc::clone(&root)
            };
            depths((&root, surface), (&run, path), bytes, [claim.bound, more])
        };
        self.witness(surface)?;
        self.all(one)
    }

    /// Whether a witness is in the mover, and as deep in the solid as it says.
    fn witness(&self, surface: &Surface) -> Result<(), String> {
        let Some(witness) = &self.claim.witness else {
            return Ok(());
        };
        let path = self.scene.paths.get(witness.path);
        let motion = path.and_then(|path| path.get(witness.motion));
        let motion = motion.filter(|_| (0.0..=1.0).contains(&witness.time));
        let stretch = motion.and_then(Stretch::new).ok_or("the witness has no motion")?;
        let (at, place) = (stretch.at(witness.time), witness.place);
        // From the middle of a solid, it is a little farther in: then it is no matter that it is on its surface.
        let is_in = |body: &Body| {
            let middle = add(&at.tip, &scaled(&at.axis, 0.5 * (body.heights[0] + body.heights[1])));
            let inner = add(&place, &scaled(&sub(&middle, &place), INNER));
            let is_in = off(body, &at, &Ring::point(inner), 0.0) <= 0.0;
            let deep = surface.nearest(&place).0 - (norm_up(&sub(&inner, &place)) + self.scene.deviation) * MORE;
            is_in && deep >= witness.depth
        };
        let movers = self.question.movers.iter().zip(self.within);
        let mut own = movers.filter(|((path, _), _)| *path == witness.path);
        if surface.is_outside(&place) == Some(false) && own.any(|(_, bodies)| bodies.iter().any(is_in)) {
            return Ok(());
        }
        let [x, y, z] = place;
        Err(format!("nothing is so deep at the witness, ({x}, {y}, {z})"))
    }

    fn height(&self, surface: &Surface) -> Result<Checked, String> {
        let (scene, claim) = (self.scene, self.claim);
        if claim.witness.is_some() {
            return Err("heights have no witness".into());
        }
        let reach = self.movers.iter().flatten().map(|body| body.reach).fold(0.0, f64::max);
        let least = scene.deviation + LEAST_MARGIN * (surface.size + reach + claim.bound);
        if !(scene.margin >= least && scene.margin.is_finite() && claim.bound > scene.margin) {
            return Err("the margin is too small, or the height is".into());
        }
        // In front of each triangle is the outside.
        let in_front = |[a, b, c]: &[[f64; 3]; 3]| {
            let middle = scaled(&add(&add(a, b), c), 1.0 / 3.0);
            let normal = crate::vector::cross(&sub(b, a), &sub(c, a));
            let step = scaled(&normal, 1e-9 * surface.size / norm(&normal));
            surface.is_outside(&add(&middle, &step)) == Some(true)
        };
        if !surface.triangles.iter().all(in_front) {
            return Err("in front of a triangle is not the outside".into());
        }
        let patches = patches(surface).ok_or("a triangle has no area")?;
        let mut end = 0_usize;
        for tree in &claim.trees {
            if tree.first != end {
                return Err("the trees are not about each patch once".into());
            }
            end = end.saturating_add(tree.count);
        }
        if end != patches.len() {
            return Err("not all patches have a tree".into());
        }
        let left = Left {
            scene,
            surface,
            movers: self.cutting(&self.question.movers, self.within, |motion| !motion.possible),
            distance: claim.bound,
        };
        self.all(|tree, bytes| walked(&left, &patches[tree.first..tree.first + tree.count], bytes))
    }
}

fn failed(why: &'static str) -> Checked {
    let mut found = Checked::nothing();
    found.fail(None, [[0.0; 3]; 2], why);
    found
}

/// Whether a point of a solid is outside where each stretch begins: unless it was nearer than `distance` to there
/// before.
fn starts_outside(body: &Body, stretches: &[Stretch], surface: &Surface, distance: f64) -> bool {
    let height = 0.5 * (body.heights[0] + body.heights[1]);
    let [starts, ends] = [0, 1].map(|end| {
        let place = |own: &Stretch| add(&own.ends[end].tip, &scaled(&own.ends[end].axis, height));
        stretches.iter().map(place).collect::<Vec<_>>()
    });
    let is_near = |k: usize| k > 0 && norm(&sub(&starts[k], &ends[k - 1])) < 0.5 * distance;
    (0..starts.len()).all(|k| is_near(k) || surface.is_outside(&starts[k]) == Some(true))
}
