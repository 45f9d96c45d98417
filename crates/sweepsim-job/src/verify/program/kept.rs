//! States between two runs of a program that are kept for later runs.
//!
//! A state is known by a digest of all that it follows from: stock, target and options, and the toolpaths up to there,
//! with their tools. Earlier ones are farther apart: from where a change is, no more than a quarter of what follows has
//! to be judged in addition.

use super::runs::RunKeys;
use crate::base::cache::{Digest, Key, RunCache};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use sweepsim::verify::{Checkpoints, TileNotes, TileState};
use sweepsim_dexel::{Dexels, Grid};

/// States are kept where this part of the program, this part of that, and so on is left.
const LEFT: f64 = 0.8;

/// The states of all tiles of a set.
pub(super) struct KeptStates<'a> {
    cache: &'a RunCache,
    keys: &'a RunKeys,
    /// What a state follows from beside the toolpaths.
    base: Key,
    tiles: Vec<Grid>,
    /// The number of runs that are known, and the states after these.
    start: usize,
    states: Mutex<Option<Vec<TileState>>>,
    /// Whether the states after so many runs are to be kept.
    wanted: Vec<bool>,
    /// Of each tile, how often something was removed from it up to the last state that was kept, and the key of that.
    last: Mutex<BTreeMap<usize, (u64, Key)>>,
}

/// How dexels are kept: themselves, or by the key of an earlier state with the same.
const WHOLE: u8 = 0;
const SAME: u8 = 1;

impl<'a> KeptStates<'a> {
    pub fn new(cache: &'a RunCache, base: Key, keys: &'a RunKeys, tiles: Vec<Grid>) -> Self {
        let mut kept = Self {
            cache,
            keys,
            base,
            tiles,
            start: 0,
            states: Mutex::new(None),
            wanted: vec![false; keys.count() + 1],
            last: Mutex::new(BTreeMap::new()),
        };
        for runs in (1..=keys.count()).rev() {
            if !kept.is_known(runs) {
                continue;
            }
            let all = 0..kept.tiles.len();
            let states: Option<Vec<TileState>> = all.clone().map(|tile| kept.state(tile, runs)).collect();
            if states.is_some() {
                let from = |tile| Some((tile, (0, kept.dexels_key(&kept.key(tile, runs))?)));
                kept.last = Mutex::new(all.filter_map(from).collect());
                (kept.start, kept.states) = (runs, Mutex::new(states));
                break;
            }
            cache.spoilt();
        }
        kept.choose();
        kept
    }

    fn key(&self, tile: usize, runs: usize) -> Key {
        let own = Digest::of("state").bytes(&self.base).bytes(self.keys.after(runs));
        own.number(tile).value(&self.tiles[tile]).key()
    }

    /// Whether all of it can be read.
    fn is_known(&self, runs: usize) -> bool {
        (0..self.tiles.len()).all(|tile| {
            let key = self.key(tile, runs);
            self.cache.has(&key) && self.dexels_key(&key).is_some_and(|own| self.cache.has(&own))
        })
    }

    /// Where the dexels of a state are.
    fn dexels_key(&self, key: &Key) -> Option<Key> {
        match self.cache.peek(key)?.split_first()? {
            (&WHOLE, _) => Some(*key),
            (&SAME, rest) => rest.get(..32)?.try_into().ok(),
            _ => None,
        }
    }

    /// Chooses where states are kept: of those that are known, the last of each place; else the last run of the place.
    fn choose(&mut self) {
        let mut places: BTreeMap<usize, usize> = BTreeMap::new();
        for runs in 1..=self.keys.count() {
            if runs > self.start || self.is_known(runs) {
                places.insert(self.place(runs), runs);
            }
        }
        for runs in places.into_values() {
            if runs <= self.start {
                (0..self.tiles.len()).for_each(|tile| self.keep_on(tile, runs));
            } else {
                self.wanted[runs] = true;
            }
        }
    }

    /// Keeps a known state for the next run, too.
    fn keep_on(&self, tile: usize, runs: usize) {
        let key = self.key(tile, runs);
        self.cache.get(&key);
        if let Some(dexels) = self.dexels_key(&key) {
            self.cache.get(&dexels);
        }
    }

    /// Which part of the program is left after some runs.
    fn place(&self, runs: usize) -> usize {
        let [done, all] = [runs, self.keys.count()].map(|runs| self.keys.moves(runs) as f64);
        if runs == self.keys.count() {
            return usize::MAX;
        }
        (((all - done) / all).ln() / LEFT.ln()) as usize
    }

    fn state(&self, tile: usize, runs: usize) -> Option<TileState> {
        let key = self.key(tile, runs);
        let value = self.cache.get(&key)?;
        let (how, rest) = value.split_first()?;
        let (length, rest) = match *how {
            WHOLE => rest.split_first_chunk::<8>()?,
            SAME => rest.get(32..)?.split_first_chunk::<8>()?,
            _ => return None,
        };
        let (notes, own) = rest.split_at_checked(usize::try_from(u64::from_le_bytes(*length)).ok()?)?;
        let notes: TileNotes = serde_json::from_slice(notes).ok()?;
        let state = match *how {
            WHOLE => own,
            _ => {
                let value = self.cache.get(&self.dexels_key(&key)?)?;
                let (length, rest) = value.strip_prefix(&[WHOLE])?.split_first_chunk::<8>()?;
                rest.get(usize::try_from(u64::from_le_bytes(*length)).ok()?..)?
            }
        };
        let dexels = Dexels::from_state(self.tiles[tile], state)?;
        notes.is_of(self.keys.of_paths()).then(|| TileState::new(dexels, notes))
    }

    /// Moves that are judged again, of so many.
    pub fn again(&self) -> [usize; 2] {
        let all = self.keys.moves(self.keys.count());
        [all - self.keys.moves(self.start), all]
    }
}

impl Checkpoints for KeptStates<'_> {
    fn start(&self) -> Option<(usize, Vec<TileState>)> {
        let states = self.states.lock().unwrap_or_else(PoisonError::into_inner).take();
        Some((self.start, states?))
    }

    fn wants(&self, runs: usize) -> bool {
        self.wanted[runs]
    }

    fn keep(&self, (tile, runs): (usize, usize), remaining: &Dexels, notes: &TileNotes, changes: u64) {
        let Ok(notes) = serde_json::to_vec(notes) else { return };
        let key = self.key(tile, runs);
        let known = { self.last.lock().unwrap_or_else(PoisonError::into_inner) }
            .get(&tile)
            .copied();
        let mut value = Vec::new();
        let same = known.filter(|(before, _)| *before == changes);
        match same {
            Some((_, other)) => {
                value.push(SAME);
                value.extend(other);
            }
            None => value.push(WHOLE),
        }
        value.extend((notes.len() as u64).to_le_bytes());
        value.extend(notes);
        if same.is_none() {
            value.extend(remaining.state());
            let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
            last.insert(tile, (changes, key));
        }
        self.cache.put(key, value);
    }
}
