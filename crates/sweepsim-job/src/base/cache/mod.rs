//! What earlier runs of a program have found, by digests of all that it depends on: it is taken only where it would be
//! found again to the bit.
//!
//! A folder holds a file for each request. It is read once and replaced once, as a whole. Whatever is wrong with it, it
//! is done without, and that is said.

mod digest;
mod file;

pub(crate) use digest::{Digest, Key};

use file::{Entries, Unfit};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::SystemTime;
use sweepsim_formats::{AtomicFile, io_reason};

/// The extension of the files.
const EXTENSION: &str = "sweepcache";
/// A file is not made larger, and not so all files of a folder.
const MOST: u64 = 1 << 30;
const MOST_OF_FOLDER: u64 = 1 << 32;

/// What is known of a request.
#[derive(Debug)]
pub(crate) struct RunCache {
    file: PathBuf,
    earlier: Entries,
    now: Mutex<Now>,
    /// Digests of the stock and of the target, which many entries depend on.
    pub stock: OnceLock<Key>,
    pub target: OnceLock<Key>,
}

/// What happens to it in a run.
#[derive(Debug, Default)]
struct Now {
    used: BTreeSet<Key>,
    made: BTreeMap<Key, Vec<u8>>,
    /// Bytes of both.
    size: u64,
    /// Moves that were judged again, of so many.
    judged: Option<[usize; 2]>,
    notes: Vec<String>,
    /// Whether there is something that the file does not have.
    is_new: bool,
}

impl RunCache {
    /// Of a request by this name, in a folder.
    pub fn open(folder: &Path, name: &str) -> Self {
        let file = folder.join(format!("{name}.{EXTENSION}"));
        let mut notes = Vec::new();
        let earlier = Entries::read(&file).unwrap_or_else(|unfit| {
            if unfit != Unfit::Missing {
                notes.push(format!("{} {unfit}: nothing of it was used", file.display()));
            }
            Entries::default()
        });
        let now = Now {
            notes,
            ..Now::default()
        };
        Self {
            file,
            earlier,
            now: Mutex::new(now),
            stock: OnceLock::new(),
            target: OnceLock::new(),
        }
    }

    fn now(&self) -> MutexGuard<'_, Now> {
        self.now.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether something is known by this key.
    pub fn has(&self, key: &Key) -> bool {
        self.earlier.get(key).is_some()
    }

    /// What an earlier run has found, without keeping it.
    pub fn peek(&self, key: &Key) -> Option<&[u8]> {
        self.earlier.get(key)
    }

    /// What an earlier run has found. It will be kept.
    pub fn get(&self, key: &Key) -> Option<&[u8]> {
        let found = self.earlier.get(key)?;
        let mut now = self.now();
        if now.used.insert(*key) {
            now.size += found.len() as u64;
        }
        Some(found)
    }

    /// Keeps what was found for later runs, if there is room.
    pub fn put(&self, key: Key, value: Vec<u8>) {
        let mut now = self.now();
        if now.size + value.len() as u64 > MOST {
            let full = "is full: less of the program is known to the next run";
            let note = format!("{} {full}", self.file.display());
            if !now.notes.contains(&note) {
                now.notes.push(note);
            }
            return;
        }
        now.size += value.len() as u64;
        now.is_new = true;
        now.made.insert(key, value);
    }

    /// What was taken for known is not: it cannot be read.
    pub fn spoilt(&self) {
        let note = format!("{} {}: some of it was not used", self.file.display(), Unfit::Damaged);
        let mut now = self.now();
        if !now.notes.contains(&note) {
            now.notes.push(note);
        }
    }

    /// Says how many moves were judged again, of so many: along one direction, or beside fixtures.
    pub fn judged(&self, moves: [usize; 2]) {
        let mut now = self.now();
        let known = now.judged.unwrap_or_default();
        now.judged = Some([0, 1].map(|k| known[k].max(moves[k])));
    }

    /// Moves that were judged again, of so many.
    pub fn moves(&self) -> Option<[usize; 2]> {
        self.now().judged
    }

    /// What is to be said of it.
    pub fn notes(&self) -> Vec<String> {
        self.now().notes.clone()
    }

    pub fn file(&self) -> &Path {
        &self.file
    }

    /// Writes what was used and what was found, unless that is what the file holds. A file that cannot be written is
    /// done without.
    pub fn save(&self) {
        // Others may go on meanwhile.
        let (used, mut own) = {
            let mut now = self.now();
            if !std::mem::take(&mut now.is_new) {
                return;
            }
            (now.used.clone(), std::mem::take(&mut now.made))
        };
        let used = used.iter().filter_map(|key| Some((key, self.earlier.get(key)?)));
        let made = own.iter().map(|(key, value)| (key, &value[..]));
        let all: BTreeMap<&Key, &[u8]> = used.chain(made).collect();
        let folder = self.file.parent().unwrap_or(Path::new(""));
        let write = || {
            let failed = |error: std::io::Error| io_reason(&error);
            fs::create_dir_all(folder).map_err(failed)?;
            let mut file = AtomicFile::create(&self.file).map_err(|error| error.to_string())?;
            file::write(&all, &mut file).map_err(failed)?;
            file.commit().map_err(|error| error.to_string())
        };
        let written = write();
        self.now().made.append(&mut own);
        match written {
            Ok(()) => self.leave_room(folder),
            Err(why) => {
                let note = format!("the cache could not be written: {why}");
                self.now().notes.push(note);
            }
        }
    }

    /// Removes the files that were written longest ago, as long as all of the folder are too large.
    fn leave_room(&self, folder: &Path) {
        let mut files: Vec<(SystemTime, u64, PathBuf)> = Vec::new();
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let (path, about) = (entry.path(), entry.metadata());
            if let (true, Ok(about)) = (path.extension().is_some_and(|own| own == EXTENSION), about) {
                files.push((about.modified().unwrap_or(SystemTime::UNIX_EPOCH), about.len(), path));
            }
        }
        let mut size: u64 = files.iter().map(|(_, size, _)| size).sum();
        files.sort();
        for (_, own, path) in files {
            if size <= MOST_OF_FOLDER {
                break;
            }
            // Another process may have been faster.
            if path != self.file && fs::remove_file(&path).is_ok() {
                size -= own;
            }
        }
    }
}
