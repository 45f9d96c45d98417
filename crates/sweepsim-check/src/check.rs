//! The whole check: what must fit together before trees are walked, and the witness.

use crate::cell::{Budget, Cell};
use crate::certificate::Claim;
use crate::motion::{Run, Stretch, stretches};
use crate::scene::{Move, Scene};
use crate::solid::{self, Body};
use crate::surface::Surface;
use crate::tree::{Tree, parts};
use crate::vector::{EPS, MORE, V3, dot, norm, scaled, size, sub};
use crate::walk::{Failed, Found, Walk};
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What a check has found.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Checked {
    /// No cutter goes deeper, if nothing failed: the largest bound of all leaves.
    pub bound: f64,
    /// The nodes of all trees.
    pub nodes: usize,
    /// What does not hold: some of it.
    pub failed: Vec<Failed>,
    /// How much that is.
    pub failed_count: usize,
    /// What is wrong with the certificate as a whole.
    pub wrong: Vec<String>,
}

impl Checked {
    /// Whether the enclosure that the certificate states is proven.
    #[must_use]
    pub fn is_proven(&self) -> bool {
        self.failed_count == 0 && self.wrong.is_empty()
    }
}

/// Checks what a certificate claims of a scene: that its enclosure holds the largest depth of any point of any cutter
/// at any time. `threads`: how many work at it.
#[must_use]
pub fn check(scene: &Scene, claim: &Claim, threads: usize) -> Checked {
    let mut checked = Checked::default();
    if let Err(wrong) = checked_by(scene, claim, threads, &mut checked) {
        checked.wrong.push(wrong);
    }
    checked
}

/// Trees of more moves are not taken.
const MOST_MOVES: usize = 4096;

fn checked_by(scene: &Scene, claim: &Claim, threads: usize, checked: &mut Checked) -> Result<(), String> {
    if claim.about != "gouge" {
        return Err(format!("`{}` is not known: expected `gouge`", claim.about));
    }
    let [lo, hi] = claim.enclosure;
    if !(lo >= 0.0 && hi >= lo && hi.is_finite() && scene.deviation >= 0.0 && scene.deviation.is_finite()) {
        return Err("the enclosure has no finite ends".into());
    }
    let surface = Surface::new(&scene.triangles)?;
    let mut bodies: BTreeMap<u32, Vec<Body>> = BTreeMap::new();
    for (number, outline) in &scene.tools {
        let solids = claim.tools.get(number).map_or(&[][..], |solids| solids);
        let own = solid::covering(outline, solids).map_err(|why| format!("tool {number}: {why}"))?;
        bodies.insert(*number, own);
    }
    let (centre, half) = claim.root;
    let [low, high] = surface.bounds();
    let holds = |k: usize| centre[k] - half <= low[k] && centre[k] + half >= high[k];
    // Added with rounding: compared with room for it.
    let room = 4.0 * EPS * (surface.size + half);
    let has_room = (0..3).all(|k| low[k] - (centre[k] - half) >= -room && centre[k] + half - high[k] >= -room);
    if !(half > 0.0 && half.is_finite() && (0..3).all(holds) && has_room) {
        return Err("the cube of the certificate does not hold the target".into());
    }
    let bytes = claim.bytes().ok_or("the trees are not readable")?;
    let trees = in_order(scene, &bodies, &bytes)?;
    let (budget, root) = (Budget::new(), Cell::root(centre, half, &surface));
    let (next, all) = (AtomicUsize::new(0), Mutex::new(Found::default()));
    let work = || {
        while let Some(tree) = trees.get(next.fetch_add(1, Ordering::Relaxed)) {
            let own = one(scene, &bodies, (&surface, &budget, &root), tree, hi);
            if let Ok(mut all) = all.lock() {
                all.nodes += own.nodes;
                all.bound = all.bound.max(own.bound);
                all.failed_count += own.failed_count;
                all.failed.extend(own.failed);
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..threads.clamp(1, 256) {
            scope.spawn(work);
        }
        work();
    });
    let found = all.into_inner().map_err(|_| "the check did not end")?;
    (checked.nodes, checked.bound) = (found.nodes, found.bound);
    (checked.failed, checked.failed_count) = (found.failed, found.failed_count);
    checked.failed.sort_by_key(|failed| (failed.path, failed.number));
    checked.failed.truncate(20);
    witness(scene, claim, &surface)
}

/// The trees, if they are about all moves of all paths and all solids of their tools, each once.
fn in_order<'a>(scene: &Scene, bodies: &BTreeMap<u32, Vec<Body>>, bytes: &'a [u8]) -> Result<Vec<Tree<'a>>, String> {
    let all = parts(bytes).ok_or("the trees are not readable")?;
    let mut known: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for tree in &all {
        // In order: where the last one ended, the next begins.
        let end = known.entry((tree.path, tree.solid)).or_default();
        if *end != tree.first || tree.count == 0 || tree.count > MOST_MOVES {
            return Err("the trees are not about each move once".into());
        }
        *end += tree.count;
    }
    for (number, path) in scene.paths.iter().enumerate() {
        let solids = bodies.get(&path.tool).ok_or("a path has no tool")?;
        let is_path = path.poses.len() == path.moves.len() + 1;
        let others = path.others.windows(2).all(|pair| pair[0].0 <= pair[1].0)
            && path.others.iter().all(|(own, _)| *own < path.moves.len());
        if !is_path || !others {
            return Err(format!("path {number} is none"));
        }
        for solid in 0..solids.len() {
            let end = known.remove(&(number, solid)).unwrap_or_default();
            if end != path.moves.len() {
                return Err(format!("not all moves of path {number} have a tree"));
            }
        }
    }
    if !known.is_empty() {
        return Err("there are trees of other paths or tools".into());
    }
    Ok(all)
}

/// How far pieces may be from the poses at their ends.
fn joins(scene: &Scene, surface: &Surface) -> f64 {
    2.0 * scene.deviation + 1e-9 * surface.size
}

fn one(
    scene: &Scene,
    bodies: &BTreeMap<u32, Vec<Body>>,
    (surface, budget, root): (&Surface, &Budget, &Cell),
    tree: &Tree,
    hi: f64,
) -> Found {
    let path = &scene.paths[tree.path];
    let failed = |why| Found {
        failed: vec![Failed {
            path: tree.path,
            number: tree.first,
            low: [0.0; 3],
            high: [0.0; 3],
            why,
        }],
        failed_count: 1,
        ..Found::default()
    };
    let own = stretches(path, tree.first..tree.first + tree.count, joins(scene, surface));
    let Some(own) = own.filter(|own| !own.is_empty()) else {
        return failed("the moves are no path");
    };
    let run = Run::new(&bodies[&path.tool][tree.solid], &own);
    // Linear moves are exact.
    let moves = &path.moves[tree.first..tree.first + tree.count];
    let is_exact = moves.iter().all(|own| *own == Move::Linear);
    let more = if is_exact { 0.0 } else { scene.deviation };
    Walk::new((surface, budget), &run, tree, (hi, more)).walked(root)
}

/// Whether the lower end of the enclosure is attained: the witness is in the cutter, and as deep in the target.
fn witness(scene: &Scene, claim: &Claim, surface: &Surface) -> Result<(), String> {
    let lo = claim.enclosure[0];
    let Some(witness) = &claim.witness else {
        return if lo > 0.0 {
            Err("there is no witness".into())
        } else {
            Ok(())
        };
    };
    let path = scene.paths.get(witness.path).ok_or("the witness has no path")?;
    let outline = scene.tools.iter().find(|(number, _)| *number == path.tool);
    let (_, outline) = outline.ok_or("the witness has no tool")?;
    let [first, count] = witness.moves;
    let is_there = count <= MOST_MOVES && first.checked_add(count).is_some_and(|end| end <= path.moves.len());
    let all = is_there
        .then(|| stretches(path, first..first + count, joins(scene, surface)))
        .flatten();
    let (piece, t) = witness.piece;
    let stretch: Option<&Stretch> = all.as_ref().and_then(|all| all.get(piece));
    let stretch = stretch.filter(|stretch| (0.0..=1.0).contains(&t) && stretch.number == witness.number);
    let end = stretch.ok_or("the witness has no move")?.at(t);
    let place: V3 = witness.place;
    let off = sub(&place, &end.tip);
    let along = dot(&off, &end.axis);
    let across = norm(&sub(&off, &scaled(&end.axis, along)));
    let errors = end.tip_error + end.axis_error * norm(&off) * 4.0 + 64.0 * EPS * (size(&place) + norm(&off));
    let off = (solid::off_tool(outline, [across, along]) + errors) * MORE;
    let (distance, _) = surface.nearest(&place);
    let is_inside = surface.is_outside(&place) == Some(false);
    // A point of the cutter is within this of the place.
    let depth = distance - (off + scene.deviation) * MORE;
    if !(is_inside && depth >= lo) {
        let [x, y, z] = place;
        return Err(format!("the cutter is not so deep at the witness, ({x}, {y}, {z})"));
    }
    Ok(())
}
