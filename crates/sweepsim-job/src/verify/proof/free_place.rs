//! A place for the part at which nothing collides and no axis leaves its limits: a box of offsets, proven as a whole.
//!
//! A free place is looked for near the present one, farther and farther away; then it is made larger, side by side, as
//! far as that is proven. All of it is bounded by a number of trials.

use super::Proof;
use super::pairs::{OnPath, Range};
use crate::base::{JobError, words};
use crate::session::Session;
use crate::verify::proof::pairs::with_remains;
use sweepsim_formats::{Job, OnMachine};
use sweepsim_machine::{Course, Outcome};
use sweepsim_nc::AxesCourse;
use sweepsim_proof::Remains;

/// Distances from the first place at which the part is tried, in millimetres.
const WAYS: [f64; 9] = [0.0, 1.0, 3.0, 10.0, 20.0, 40.0, 80.0, 160.0, 320.0];
/// A place is free if it is so with this much room each way,
const HALF: f64 = 0.5;
/// and grows by these steps, the last time.
const STEPS: [f64; 7] = [64.0, 32.0, 16.0, 8.0, 4.0, 2.0, 1.0];
/// The most places that are tried, and the most steps of growth; of long programs, fewer, so that no more moves are
/// looked at in all.
const TRIED: usize = 250;
const GROWN: usize = 150;
const MOVES: usize = 500_000;
/// Of the distances to the stock as it is left, so few are computed as in a verdict.
const SHARE: usize = 10;
/// Curved courses of axes are looked at so many times in a move; what they go beyond that is bounded.
const SAMPLES: usize = 16;

/// A box of offsets of the part, in the machine's directions.
pub(in crate::verify) type Offsets = [[f64; 3]; 2];

/// Another place for the part, if there is a free one, and what is said of it.
pub(in crate::verify) fn propose(session: Session) -> Result<(Option<Offsets>, Option<String>), JobError> {
    if session.job.paths.iter().all(|path| path.on_machine.is_none()) {
        let note = "no other place of the part is looked for: there is no machine that it could be on";
        return Ok((None, Some(note.to_owned())));
    }
    session.phase("place");
    let proof = Proof::new(session, false, false);
    let found = free(&proof, session.request.judging.length_range)?;
    let note = match found {
        Some([low, high]) => {
            let side = |k: usize| {
                let [low, high] = [low[k], high[k]].map(words::length);
                format!("{low} … {high} mm along {}", ['X', 'Y', 'Z'][k])
            };
            format!(
                "proven free of collisions of the machine and within its limits, if the part and its zero are moved by: {}, {}, {}",
                side(0),
                side(1),
                side(2)
            )
        }
        None => "no other place of the part was found at which the machine is free of collisions and within its limits"
            .to_owned(),
    };
    Ok((found, Some(note)))
}

/// A box of offsets for which the program is proven to collide nowhere and to stay within the limits of all linear
/// axes, with the range of lengths that is asked for. `None` if none was found, or a rotary axis is beyond its limits
/// anyway.
fn free(proof: &Proof, length: f64) -> Result<Option<Offsets>, JobError> {
    let found = with_remains(proof, |remains| Search::new(proof, length, Some(remains)).run())?;
    Ok(found.unwrap_or_else(|| Search::new(proof, length, None).run()))
}

struct Search<'a> {
    proof: &'a Proof<'a>,
    job: &'a Job,
    length: f64,
    remains: Option<&'a Remains<'a>>,
    /// The pair that failed last is looked at first: its path, and its number.
    failed: (usize, usize),
}

impl<'a> Search<'a> {
    fn new(proof: &'a Proof<'a>, length: f64, remains: Option<&'a Remains<'a>>) -> Self {
        Self {
            proof,
            job: proof.session.job,
            length,
            remains,
            failed: (0, 0),
        }
    }

    /// At most so many trials, of long programs fewer.
    fn trials(&self, most: usize) -> usize {
        most.min(MOVES / self.job.moves().max(1))
    }

    fn machines(&self) -> impl Iterator<Item = (usize, &'a OnMachine)> + use<'a> {
        let all = self.job.paths.iter().enumerate();
        all.filter_map(|(number, path)| Some((number, path.on_machine.as_ref()?)))
    }

    fn run(&mut self) -> Option<Offsets> {
        let first = self.first()?;
        let centre = self.centre(first)?;
        let mut found: Offsets = [centre.map(|c| c - HALF), centre.map(|c| c + HALF)];
        let mut trials = self.trials(GROWN);
        for step in STEPS {
            // One side after the other, as long as any grows.
            let mut open = [true; 6];
            while open.contains(&true) {
                for (side, open) in open.iter_mut().enumerate().filter(|(_, open)| **open) {
                    if trials == 0 || self.proof.session.monitor.cancelled() {
                        return Some(found);
                    }
                    trials -= 1;
                    let (k, end) = (side / 2, side % 2);
                    let mut slab = found;
                    slab[1 - end][k] = found[end][k];
                    slab[end][k] = found[end][k] + if end == 1 { step } else { -step };
                    *open = slab[end][k].abs() <= WAYS[WAYS.len() - 1] && self.is_free(slab);
                    if *open {
                        found[end][k] = slab[end][k];
                    }
                }
            }
        }
        Some(found)
    }

    /// The nearest offset at which the linear axes may be within their limits.
    fn first(&self) -> Option<[f64; 3]> {
        let mut offset = [0.0; 3];
        // Two times, since a table that turns mixes them.
        for _ in 0..2 {
            for k in 0..3 {
                let letter = ['X', 'Y', 'Z'][k];
                let mut room = [f64::INFINITY; 2];
                for (_, on) in self.machines() {
                    let own = rooms(&on.course.moved(offset).ok()?, letter);
                    room = [room[0].min(own[0]), room[1].min(own[1])];
                }
                let needed = [0, 1].map(|side| (HALF - room[side]).max(0.0));
                let direction = self.machines().next()?.1.course.machine().linear()[k].direction;
                let is_plain = direction.is_none();
                // Towards the limit that has room.
                if is_plain && (needed[0] > 0.0) != (needed[1] > 0.0) {
                    offset[k] += needed[0] - needed[1];
                }
            }
        }
        Some(offset)
    }

    /// The nearest of some free places.
    fn centre(&mut self, first: [f64; 3]) -> Option<[f64; 3]> {
        let mut trials = self.trials(TRIED);
        for way in WAYS {
            let sides = (0..27).map(|n| [n % 3, n / 3 % 3, n / 9].map(|k| f64::from(k - 1)));
            let mut sides: Vec<[f64; 3]> = sides.filter(|side| (*side == [0.0; 3]) == (way == 0.0)).collect();
            // Along an axis first.
            sides.sort_by_key(|side: &[f64; 3]| side.iter().filter(|c| **c != 0.0).count());
            for side in sides {
                if trials == 0 || self.proof.session.monitor.cancelled() {
                    return None;
                }
                trials -= 1;
                let at = [0, 1, 2].map(|k| first[k] + way * side[k]);
                if self.is_free([at.map(|c| c - HALF), at.map(|c| c + HALF)]) {
                    return Some(at);
                }
            }
        }
        None
    }

    /// Whether all of a box is proven.
    fn is_free(&mut self, [low, high]: Offsets) -> bool {
        let centre = [0, 1, 2].map(|k| 0.5 * (low[k] + high[k]));
        let range = Range {
            offset: [0, 1, 2].map(|k| 0.5 * (high[k] - low[k])),
            length: self.length,
        };
        let mut moved = Vec::new();
        for (number, on) in self.machines() {
            let Ok(course) = on.course.moved(centre) else {
                return false;
            };
            if !is_within(&course, &range) {
                return false;
            }
            moved.push((number, course));
        }
        let paths = moved
            .iter()
            .filter_map(|(number, course)| OnPath::new(self.job, *number, course, range));
        let paths: Vec<OnPath> = paths.collect();
        let (path, pair) = self.failed;
        if let Some(own) = paths.get(path).filter(|own| pair < own.pairs())
            && !self.is_apart(own, pair..pair + 1)
        {
            return false;
        }
        for (number, own) in paths.iter().enumerate() {
            if !self.is_apart(own, 0..own.pairs()) {
                self.failed.0 = number;
                return false;
            }
        }
        true
    }

    fn is_apart(&mut self, own: &OnPath, pairs: std::ops::Range<usize>) -> bool {
        let first = pairs.start;
        let found = own.judge(pairs);
        let failed = found.iter().enumerate().find(|(pair, outcome)| match outcome {
            Outcome::Apart(_) => false,
            outcome if own.needs_stock(first + pair, outcome) => {
                let left = self
                    .remains
                    .map(|remains| own.with_remains(first + pair, remains, SHARE));
                !matches!(left, Some(Outcome::Apart(_)))
            }
            _ => true,
        });
        if let Some((pair, _)) = failed {
            self.failed.1 = first + pair;
        }
        failed.is_none()
    }
}

/// Whether all axes have room to their limits, wherever the part is in a range.
fn is_within(course: &AxesCourse, range: &Range) -> bool {
    let spread = range.spread(course);
    course.chain().letters().iter().zip(spread).all(|(letter, spread)| {
        let [below, above] = rooms(course, *letter);
        below.min(above) >= spread
    })
}

/// How much room an axis has to its limits, below and above, wherever the program and not the machine says where it is.
fn rooms(course: &AxesCourse, letter: char) -> [f64; 2] {
    let Some([low, high]) = course.limits(letter) else {
        return [f64::INFINITY; 2];
    };
    let Some(joint) = course.chain().letters().iter().position(|own| *own == letter) else {
        return [f64::INFINITY; 2];
    };
    let mut room = [f64::INFINITY; 2];
    for piece in 0..course.moves() {
        let bend = course.bend(piece)[joint];
        let steps = if bend > 0.0 { SAMPLES } else { 1 };
        let beyond = bend / (8.0 * (steps * steps) as f64);
        let [from, to] = course.fixed(piece, letter);
        for step in 0..=steps {
            if step == 0 && from || step == steps && to {
                continue;
            }
            let value = course.at(piece, step as f64 / steps as f64)[joint];
            room = [room[0].min(value - low - beyond), room[1].min(high - value - beyond)];
        }
    }
    room
}
