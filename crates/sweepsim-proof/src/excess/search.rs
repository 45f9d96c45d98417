//! The search for the highest place that is left standing.

mod look;

use super::found::Found;
use super::known::{Blocks, nothing};
use super::order::along_a_curve;
use super::record::{Parts, PatchTrees, Record, key, parts, trees};
use super::removed::{Course, Removed};
use super::stock::{Before, regions};
use super::surface::Surface;
use crate::motion::{Cutter, Stretch};
use crate::recall::{Recall, Writing};
use crate::search::Limits;
use crate::solid::Target;
use look::Search;
use nalgebra::Vector3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;
use std::mem::take;
use std::sync::atomic::{AtomicUsize, Ordering};
use sweepsim_dexel::{MeshError, Stock};
use sweepsim_solve::Monitor;

/// What is left standing around a target.
#[derive(Clone, Debug)]
pub struct Left {
    /// A place that is left, and how far it is from the target: the farthest that was found.
    pub highest: Option<([f64; 3], f64)>,
    /// Nothing that hangs together with the target is farther from it.
    pub bound: f64,
    /// Boxes of places of which it is not known whether they are left: some of them.
    pub open: Vec<[[f64; 3]; 2]>,
    /// How many they are.
    pub open_count: usize,
    /// Patches that were looked at.
    pub patches: usize,
    /// How the bound was proven, if that was to be recorded.
    pub trees: Vec<PatchTrees>,
}

/// As many distances are tried.
const ROUNDS: usize = 16;
/// At least this part of all patches, and so many for each part of the surface, are left to be looked at when it is
/// asked whether the limit is kept.
const RESERVE: usize = 4;
const RESERVE_OF_A_PART: usize = 2;
/// What is far from the target need not be known better than this part of it.
const SHARE: f64 = 1.0 / 64.0;
/// However many parts there are, so many patches may be looked at for each of them.
const PATCHES_OF_A_PART: usize = 4;
/// The surface is divided into at least so many patches, so that all threads have work.
const PARTS: f64 = 512.0;
/// At first, so many parts of every patch are looked at.
const LOOKS: [usize; 2] = [4, 64];
/// One of so many patches is looked at before the others.
const SAMPLED: usize = 64;
/// As many looks in all: in later ones, what is left of the patches is for what is left of the surface.
const MOST_LOOKS: usize = 6;
/// So many patches are looked at one after the other: what held one may hold the next.
const TOGETHER: usize = 64;
/// Patches smaller than this part of the distance are not divided.
const FINEST: f64 = 1e-3;
/// As many open places are described, of each part of the surface.
const MOST_OPEN: usize = 4;
/// Coordinates of this size are exact to 1.
const ROUNDING: f64 = 1e-12;
/// What a checker's margin is in parts of all lengths, without deviations.
const MARGIN: f64 = 1e-8;
/// Higher places are looked for where they are higher by this part of the wanted width.
const FINER: f64 = 0.1;
/// How far a place is that is left is known this well.
const STEPS: usize = 24;

/// A checker takes points for removed, or for outside of the stock, that are so by this. What is proven here is so by
/// twice as much: roundings, and what motions deviate by, do not matter.
#[must_use]
pub fn margin(size: f64, cutters: &[Cutter], limits: &Limits) -> f64 {
    limits.deviation + MARGIN * (size + reach(cutters) + limits.depth)
}

fn reach(cutters: &[Cutter]) -> f64 {
    cutters.iter().map(|cutter| cutter.reach).fold(0.0, f64::max)
}

/// Encloses how far what is left of a stock stands beyond a target. `recorded`: with trees by which a checker can
/// follow the proof. `None` if the monitor cancelled the work.
///
/// # Errors
/// The stock has too many vertices.
pub fn highest(
    target: &Target,
    stock: &Stock,
    cutters: &[Cutter],
    limits: &Limits,
    recorded: bool,
    monitor: &dyn Monitor,
) -> Result<Option<Left>, MeshError> {
    highest_from(&(), (target, stock), cutters, limits, recorded, monitor)
}

/// The same, where some answers are known: the result is the same.
///
/// # Errors
/// Those of [`highest`].
pub fn highest_from(
    recall: &dyn Recall,
    (target, stock): (&Target, &Stock),
    cutters: &[Cutter],
    limits: &Limits,
    recorded: bool,
    monitor: &dyn Monitor,
) -> Result<Option<Left>, MeshError> {
    // Other courses of rapids are only possible.
    let own = cutters.iter().map(|cutter| Cutter {
        others: None,
        ..*cutter
    });
    let motions = || {
        own.map(|own| own.stretches(0..own.path.moves(), limits.deviation))
            .collect()
    };
    // Without some of the triangles, the patches are not those of a checker; and of a mesh, it knows no regions.
    let recorded = recorded && target.is_whole && regions(stock, 0.0).is_some();
    let patches = || {
        let surface = Surface::new(&target.triangles);
        parts(&surface, (surface.squares / PARTS).sqrt(), recorded)
    };
    let ordered = || {
        let patches = patches();
        let middle = |number| patches.get(number).middle().0;
        let order = along_a_curve(patches.len(), middle, target.size);
        (patches, order)
    };
    let (motions, (patches, order)): (Vec<Vec<Stretch>>, _) = rayon::join(motions, ordered);
    let courses = || cutters.iter().zip(&motions);
    let size = courses().fold(target.size, |size, (cutter, all)| {
        let far = all.iter().map(|stretch| stretch.low.amax().max(stretch.high.amax()));
        far.fold(size, f64::max) + cutter.reach
    });
    let margin = 2.0 * margin(target.size, cutters, limits) + ROUNDING * size;
    let courses = courses().map(|(cutter, all)| Course::new(cutter.solids, all, ROUNDING * size));
    let removed = Removed {
        courses: courses.collect(),
        margin,
    };
    let triangles = target.triangles.iter();
    let numbers = triangles.map(|own| (key(&own.corners.map(Into::into)), own.number));
    let scene = Scene {
        target,
        before: Before::new(stock, margin)?,
        removed,
        patches,
        order,
        numbers: if recorded {
            numbers.collect()
        } else {
            FxHashMap::default()
        },
        recorded,
        farthest: target.size + reach(cutters),
    };
    let blocks = recall.keeps().then(|| {
        let mut question = Writing::default();
        question.bytes(b"highest");
        question.floats(&[margin]);
        question.number(usize::from(scene.recorded));
        Blocks::new(recall, &scene.removed, question, recorded)
    });
    Ok(scene.search(limits, blocks.as_ref(), monitor))
}

/// What was found at some patches.
#[derive(Default)]
struct Looked {
    /// Of all but those that are open; the number of patches is that of all.
    settled: Found,
    open: Vec<(usize, Found)>,
    /// The greatest height of all.
    height: f64,
    records: Vec<(usize, Record)>,
}

impl Looked {
    fn with(mut self, number: usize, mut found: Found, recorded: bool) -> Self {
        self.height = self.height.max(found.height());
        self.settled.patches += take(&mut found.patches);
        if recorded {
            self.records.push((number, take(&mut found.record)));
        }
        if found.open_count > 0 {
            self.open.push((number, found));
        } else {
            self.settled = self.settled.join(found);
        }
        self
    }
}

struct Scene<'a> {
    target: &'a Target,
    before: Before,
    removed: Removed<'a>,
    patches: Parts,
    /// Their numbers, in the order in which they are looked at: what is looked at together lies together, and asks for
    /// few of the motions.
    order: Vec<usize>,
    /// The numbers of triangles by their corners, for records.
    numbers: FxHashMap<[u64; 9], u32>,
    recorded: bool,
    /// What is farther from the target is too far for a checker's margin, which has half of [`MARGIN`] for bounds.
    farthest: f64,
}

impl Scene<'_> {
    fn search(&self, limits: &Limits, blocks: Option<&Blocks>, monitor: &dyn Monitor) -> Option<Left> {
        let mut left = Left {
            highest: None,
            bound: f64::INFINITY,
            open: Vec::new(),
            open_count: 0,
            patches: 0,
            trees: Vec::new(),
        };
        let mut distance = limits.width;
        // Whether the limit is kept comes before how far below it the bound is.
        let budget = limits.pairs.max(PATCHES_OF_A_PART * self.patches.len());
        let reserve = (budget / RESERVE).max(RESERVE_OF_A_PART * self.patches.len());
        for _ in 0..ROUNDS {
            let most = budget.saturating_sub(left.patches);
            let known = left.highest.map_or(0.0, |(_, height)| height);
            let own = most.saturating_sub(if distance < limits.depth { reserve } else { 0 });
            let (found, records) = self.at_distance(distance, (known, limits.width), own, (blocks, monitor))?;
            let is_done = !found.is_left && found.open_count == 0;
            if is_done && self.recorded && distance <= self.farthest {
                left.trees = trees(&self.patches, &records);
            }
            left.patches += found.patches;
            if let Some((place, height)) = found.highest.filter(|(_, height)| *height > known) {
                left.highest = Some((place.into(), height));
            }
            if is_done {
                left.bound = distance;
                break;
            }
            // Where it is not known whether the limit is kept.
            if distance <= limits.depth {
                (left.open, left.open_count) = (found.open, found.open_count);
            }
            if let (true, Some((place, _))) = (left.open.is_empty(), left.highest) {
                (left.open, left.open_count) = (vec![[place; 2]], 1);
            }
            if most == 0 {
                break;
            }
            let known = left.highest.map_or(0.0, |(_, height)| height);
            let above = known.max(limits.expected_within()) + limits.width.max(SHARE * known);
            let is_undecided = known < limits.depth && distance < limits.depth;
            let has_room = left.patches + 2 * reserve < budget;
            distance = match found.is_left && above > distance {
                true if is_undecided && has_room => above.min(limits.depth),
                true if !is_undecided => above,
                _ if is_undecided => limits.depth,
                _ => 2.0 * distance,
            };
        }
        if left.bound <= limits.depth || left.highest.is_some_and(|(_, height)| height > limits.depth) {
            (left.open, left.open_count) = (Vec::new(), 0);
        }
        Some(left)
    }

    /// Whether anything is left at a distance from the target, and how far it reaches; and the records of all patches,
    /// if they are wanted. `known`: so far, for certain.
    fn at_distance(
        &self,
        distance: f64,
        (mut known, width): (f64, f64),
        patches: usize,
        (blocks, monitor): (Option<&Blocks>, &dyn Monitor),
    ) -> Option<(Found, Vec<Record>)> {
        let mut settled = Found::default();
        let mut records = vec![Record::default(); if self.recorded { self.patches.len() } else { 0 }];
        let mut open = self.order.clone();
        let mut still: BTreeMap<usize, Found> = BTreeMap::new();
        // Short looks everywhere, then what is left.
        for look in 0..MOST_LOOKS {
            let share = patches.saturating_sub(settled.patches) / open.len().max(1);
            let least = LOOKS[look.min(LOOKS.len() - 1)];
            if open.is_empty() || look > 0 && share < least {
                break;
            }
            let each = if look < LOOKS.len() { least } else { share };
            // What is found at some patches need not be found again at the others.
            let (some, others): (Vec<usize>, Vec<usize>) = open.iter().partition(|number| **number % SAMPLED == 0);
            for numbers in [some, others] {
                let again = self.look_at(&numbers, (distance, known, FINER * width), each, (blocks, monitor))?;
                if look > 0 {
                    numbers.iter().for_each(|number| drop(still.remove(number)));
                }
                for looked in again {
                    known = known.max(looked.height);
                    settled = settled.join(looked.settled);
                    still.extend(looked.open);
                    for (number, record) in looked.records {
                        records[number] = record;
                    }
                }
                if settled.is_left || still.values().any(|found| found.is_left) {
                    return Some((still.into_values().fold(settled, Found::join), records));
                }
            }
            open = still.keys().copied().collect();
        }
        Some((still.into_values().fold(settled, Found::join), records))
    }

    /// Looks at some patches, `each` of them in so many parts.
    fn look_at(
        &self,
        numbers: &[usize],
        (distance, known, finer): (f64, f64, f64),
        each: usize,
        (blocks, monitor): (Option<&Blocks>, &dyn Monitor),
    ) -> Option<Vec<Looked>> {
        let (done, total) = (AtomicUsize::new(0), numbers.len());
        let look = |numbers: &[usize]| {
            let (mut recent, mut around) = (None, nothing());
            let mut all = Vec::with_capacity(numbers.len());
            for number in numbers {
                if monitor.cancelled() {
                    return None;
                }
                let mut search = Search {
                    scene: self,
                    distance,
                    known,
                    finer,
                    found: Found::default(),
                    recent,
                    around,
                };
                search.look(self.patches.get(*number).clone(), each);
                // However finely it was divided, a patch is one place.
                search.found.open_count = search.found.open_count.min(1);
                (recent, around) = (search.recent, search.around);
                all.push(search.found);
            }
            Some((all, around))
        };
        let some = |numbers: &[usize]| {
            let asked = |question: &mut Writing| {
                question.floats(&[distance, known, finer]);
                question.number(each);
                numbers.iter().for_each(|number| question.number(*number));
            };
            let found = match blocks {
                Some(blocks) => blocks.found(asked, numbers.len(), || look(numbers))?,
                None => look(numbers)?.0,
            };
            monitor.advance(numbers.len() + done.fetch_add(numbers.len(), Ordering::Relaxed), total);
            let all = numbers.iter().copied().zip(found);
            Some(all.fold(Looked::default(), |looked, (number, found)| {
                looked.with(number, found, self.recorded)
            }))
        };
        numbers.par_chunks(TOGETHER).map(some).collect()
    }

    fn is_left(&self, point: &Vector3<f64>) -> bool {
        self.before.holds(point) && self.removed.misses(point)
    }

    /// How far a point is from the target; less than 0 inside.
    fn height(&self, point: &Vector3<f64>) -> f64 {
        -self.target.depth((*point).into())
    }
}
