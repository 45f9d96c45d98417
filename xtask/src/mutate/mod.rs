//! `cargo xtask mutate`: readers on files that are almost right. Whatever is in a file, a reader answers, by a result
//! or an error, without a panic, soon, and within little memory.
//!
//! Files that a reader failed on are kept in `fixtures/mutations/READER`, as small as they could be made, and tried
//! first from then on.

mod readers;

use crate::workspace;
use readers::{READERS, Reader};
use std::path::PathBuf;
use std::time::{Duration, Instant};
use std::{fs, panic};

/// A reader may take so long for a file of a few kilobytes.
const LONGEST: Duration = Duration::from_secs(2);
/// And so many bytes beyond what others took, where nothing else runs in this process.
const MOST: u64 = 256 << 20;
/// Files of shared data are taken up to this size.
const LARGEST: usize = 64 << 10;
/// How often a failure is made smaller.
const SMALLER: usize = 400;

/// SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ z >> 31
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count.max(1) as u64) as usize
    }
}

/// Mutates files of all readers, or of one, for so many minutes each; `true` if none failed.
pub fn run(only: Option<&str>, minutes: f64) -> Result<bool, String> {
    let chosen: Vec<&Reader> = READERS
        .iter()
        .filter(|r| only.is_none_or(|only| r.name == only))
        .collect();
    if chosen.is_empty() {
        let names: Vec<&str> = READERS.iter().map(|reader| reader.name).collect();
        return Err(format!("there is no such reader: expected {}", names.join(", ")));
    }
    let time = Duration::try_from_secs_f64(60.0 * minutes).map_err(|error| format!("--minutes: {error}"))?;
    // A panic is reported here, with the file.
    panic::set_hook(Box::new(|_| {}));
    let mut good = true;
    for reader in chosen {
        let begin = Instant::now();
        let seed = begin_seed();
        let (tried, failure) = search((reader, MOST), &corpus(reader, true), seed, |_| begin.elapsed() < time);
        match failure {
            None => println!("{}: {tried} files", reader.name),
            Some((file, why)) => {
                good = false;
                let file = keep(reader, &smaller((reader, MOST), file))?;
                println!("{}: {why}: {}", reader.name, file.display());
            }
        }
    }
    Ok(good)
}

/// Another one in each run.
fn begin_seed() -> u64 {
    let since = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    since.map_or(0, |since| since.as_nanos() as u64)
}

/// Tries files, those of the corpus first, as they are: how many, and the first that the reader fails on, and how.
fn search(
    reader: (&Reader, u64),
    corpus: &[Vec<u8>],
    seed: u64,
    goes_on: impl Fn(usize) -> bool,
) -> (usize, Option<(Vec<u8>, String)>) {
    let mut tried = 0;
    for file in corpus {
        tried += 1;
        if let Some(why) = fails(reader, file) {
            return (tried, Some((file.clone(), why)));
        }
    }
    let mut random = Random(seed);
    while !corpus.is_empty() && goes_on(tried) {
        tried += 1;
        let file = mutated(corpus, &mut random);
        if let Some(why) = fails(reader, &file) {
            return (tried, Some((file, why)));
        }
    }
    (tried, None)
}

/// What is wrong with the answer of a reader, which may take so many bytes, if it is.
fn fails((reader, most): (&Reader, u64), file: &[u8]) -> Option<String> {
    let (begin, before) = (Instant::now(), peak());
    let answer = panic::catch_unwind(|| (reader.read)(file));
    let (took, more) = (begin.elapsed(), peak().saturating_sub(before));
    match answer {
        Err(payload) => {
            let message = payload.downcast_ref::<String>().map(String::as_str);
            let message = message.or_else(|| payload.downcast_ref::<&str>().copied());
            Some(format!("panicked: {}", message.unwrap_or("without a message")))
        }
        Ok(Some(error)) if error.trim().is_empty() => Some("an error without a message".into()),
        Ok(_) if more > most => Some(format!("took {} MiB", more >> 20)),
        Ok(_) if took > LONGEST => Some(format!("took {took:.1?}")),
        Ok(_) => None,
    }
}

/// The most memory that this process has ever held, in bytes; 0 where the system does not tell.
fn peak() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|line| line.trim().strip_suffix(" kB")?.parse::<u64>().ok());
    kib.unwrap_or(0) << 10
}

/// What is there to begin with: files that the reader failed on, its own, and those of shared data if they are wanted.
fn corpus(reader: &Reader, shared: bool) -> Vec<Vec<u8>> {
    let mut all: Vec<Vec<u8>> = Vec::new();
    let mut take = |folder: PathBuf, fits: &dyn Fn(&str) -> bool| {
        let mut folders = vec![folder];
        while let Some(folder) = folders.pop() {
            let mut entries: Vec<PathBuf> = fs::read_dir(&folder)
                .map(|entries| entries.filter_map(|entry| Some(entry.ok()?.path())).collect())
                .unwrap_or_default();
            entries.sort();
            for path in entries {
                let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
                if path.is_dir() {
                    folders.push(path);
                } else if fits(&ending) {
                    all.extend(fs::read(&path).ok().filter(|bytes| bytes.len() <= LARGEST));
                }
            }
        }
    };
    take(kept(reader), &|_| true);
    if shared {
        let data = workspace::root().join("../shared/data");
        take(data, &|ending| reader.endings.contains(&ending));
    }
    all.extend((reader.own)());
    all
}

fn kept(reader: &Reader) -> PathBuf {
    workspace::fixtures().join("mutations").join(reader.name)
}

/// A file of the corpus with one to four changes.
fn mutated(corpus: &[Vec<u8>], random: &mut Random) -> Vec<u8> {
    const NUMBERS: [&str; 12] = [
        "0",
        "-1",
        "1e999",
        "-1e308",
        "NaN",
        "inf",
        "1e-320",
        "18446744073709551616",
        "4294967295",
        "0x",
        "1..2",
        "",
    ];
    let mut file = corpus[random.below(corpus.len())].clone();
    for _ in 0..=random.below(4) {
        let at = random.below(file.len() + 1);
        let end = (at + 1 + random.below(40)).min(file.len());
        match random.below(8) {
            0 if at < file.len() => file[at] ^= 1 << random.below(8),
            1 if at < file.len() => file[at] = random.next() as u8,
            2 => drop(file.drain(at.min(end)..end)),
            3 => {
                let part = file[at.min(end)..end].to_vec();
                file.splice(at..at, part);
            }
            4 => file.truncate(at),
            5 => {
                let other = &corpus[random.below(corpus.len())];
                let from = random.below(other.len() + 1);
                let part = other[from..(from + random.below(200)).min(other.len())].to_vec();
                file.splice(at..at, part);
            }
            _ => {
                let is_number = |byte: &u8| byte.is_ascii_digit() || b"+-.".contains(byte);
                let Some(from) = file[at..].iter().position(is_number).map(|n| at + n) else {
                    continue;
                };
                let length = file[from..].iter().take_while(|byte| is_number(byte)).count();
                file.splice(from..from + length, NUMBERS[random.below(NUMBERS.len())].bytes());
            }
        }
    }
    file
}

/// The same failure from a smaller file: parts are left out as long as the reader fails.
fn smaller(reader: (&Reader, u64), mut file: Vec<u8>) -> Vec<u8> {
    let mut length = file.len() / 2;
    let mut tries = 0;
    while length > 0 && tries < SMALLER {
        let mut at = 0;
        while at < file.len() && tries < SMALLER {
            tries += 1;
            let mut less = file.clone();
            less.drain(at..(at + length).min(file.len()));
            if fails(reader, &less).is_some() {
                file = less;
            } else {
                at += length;
            }
        }
        length /= 2;
    }
    file
}

fn keep(reader: &Reader, file: &[u8]) -> Result<PathBuf, String> {
    let folder = kept(reader);
    let number = file.iter().fold(0xCBF2_9CE4_8422_2325_u64, |all, byte| {
        (all ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01B3)
    });
    let path = folder.join(format!("{number:016x}"));
    fs::create_dir_all(&folder)
        .and_then(|()| fs::write(&path, file))
        .map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(path)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::Command;

    /// What other tests take in this process is no failure of a reader.
    const ANY: u64 = u64::MAX;

    #[test]
    fn readers_answer_whatever_is_in_a_file() {
        for reader in &READERS {
            let corpus = corpus(reader, false);
            let own = corpus.last().expect("a file of its own");
            assert_eq!((reader.read)(own), None, "{}: its own file is read", reader.name);
            let (tried, failure) = search((reader, ANY), &corpus, 1, |tried| tried < 150);
            assert!(failure.is_none(), "{}: {:?}", reader.name, failure.map(|(_, why)| why));
            assert_eq!(tried, 150);
        }
    }

    #[test]
    fn failures_are_found_and_made_small() {
        let reader = Reader {
            name: "strict",
            endings: &[],
            own: || vec![b"G1 X10 Y20\nG1 X30 Y40\n".to_vec()],
            read: |file| {
                assert!(!file.windows(3).any(|part| part == b"NaN"), "no number");
                None
            },
        };
        let hook = panic::take_hook();
        panic::set_hook(Box::new(|_| {}));
        let (_, failure) = search((&reader, ANY), &corpus(&reader, false), 1, |tried| tried < 1000);
        let (file, why) = failure.expect("one of a thousand");
        let file = smaller((&reader, ANY), file);
        panic::set_hook(hook);
        assert_eq!((file, why.as_str()), (b"NaN".to_vec(), "panicked: no number"));
    }

    #[test]
    fn a_reader_that_takes_much_memory_fails() {
        let mut alone = Command::new(std::env::current_exe().expect("this program"));
        alone.args(["--exact", "mutate::tests::alone::a_greedy_reader_fails", "--ignored"]);
        let output = alone.output().expect("this program runs");
        let text = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success() && text.contains("1 passed"), "{text}");
    }

    mod alone {
        use super::*;

        #[test]
        #[ignore = "run by the test above, in a process of its own"]
        fn a_greedy_reader_fails() {
            let reader = Reader {
                name: "greedy",
                endings: &[],
                own: Vec::new,
                read: |file| (file.repeat(1 << 20).len() < file.len()).then(|| "cannot be".into()),
            };
            assert_eq!(fails((&reader, MOST), &[1; 16]), None);
            // Where the system does not tell, nothing can be said.
            let why = fails((&reader, MOST), &[1; 512]);
            assert!(peak() == 0 || why.is_some_and(|why| why.ends_with("MiB")));
        }
    }
}
