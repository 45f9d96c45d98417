//! Registers of diameters that nobody says: whether the part comes out right if they hold the sizes of their tools, or
//! if they hold wear.
//!
//! How deep cutters go below the target is enclosed for both readings, along the moves in which these differ.

use crate::base::JobError;
use crate::session::Session;
use crate::verify::asked::{self, limits};
use crate::verify::work;
use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::hash::{DefaultHasher, Hash, Hasher};
use sweepsim::motion::Path;
use sweepsim_formats::{JobPath, Report};
use sweepsim_proof::{Convex, Cutter, Limits, Target, cover_and_cores, deepest};

/// What is taken together: the tool and its registers.
type Registers<'a> = (u32, &'a [(String, usize)]);

/// Compares both readings of all registers that were assumed, and warns where only one of them gouges.
pub(in crate::verify) fn compare(session: Session, report: &mut Report) -> Result<(), JobError> {
    let job = session.job;
    let mut all: BTreeMap<Registers, Vec<&JobPath>> = BTreeMap::new();
    for path in &job.paths {
        if let Some(other) = &path.as_wear {
            all.entry((path.tool, &other.registers)).or_default().push(path);
        }
    }
    if all.is_empty() {
        return Ok(());
    }
    session.phase("registers");
    let target = job.target.as_ref().ok_or("there is no target".to_owned());
    let target = target.and_then(|target| asked::solids::of_mesh(&target.mesh, "the target", 0.0, (None, &())));
    for (registers, paths) in all {
        let about = named(registers);
        let readings = target.as_ref().map_err(String::clone).and_then(|target| {
            let others = paths.iter().map(|path| path.as_wear.as_ref()?.path.as_ref());
            let others = others.collect::<Option<Vec<_>>>();
            let others = others.ok_or("as wear, the program cannot be read".to_owned())?;
            Ok([
                reading(session, target, &paths, &others),
                reading(session, target, &others, &paths),
            ])
        });
        match readings {
            Err(reason) => report.notes.push(format!(
                "{about}: that the tool cuts as deep if it is the tool's wear, 0, was not compared: {reason}"
            )),
            Ok([size, wear]) => {
                let [size, wear] = [size?, wear?];
                let sentence = format!("{about}, {}; as its wear, 0, {}", size.said(), wear.said());
                if size.differs(&wear) {
                    report.warnings.push(format!(
                        "{sentence}: say by --diameters (in a job: diameters) which it is"
                    ));
                } else {
                    report.notes.push(sentence);
                }
            }
        }
    }
    Ok(())
}

fn named((tool, registers): Registers) -> String {
    let registers: Vec<String> = registers
        .iter()
        .map(|(register, line)| format!("{register} (line {line})"))
        .collect();
    format!("{} as the size of tool {tool}", registers.join(", "))
}

/// How deep the cutter goes below the target in one reading.
struct Reading {
    /// The deepest place that is known, if it is deeper than the largest limit of gouges; and the lines of the moves
    /// that go so deep.
    gouge: Option<(f64, Vec<String>)>,
    /// No point goes deeper.
    bound: f64,
    /// The least limit of gouges.
    limit: f64,
}

impl Reading {
    fn is_right(&self) -> bool {
        self.bound <= self.limit
    }

    /// Whether one of two gouges, and the other does not.
    fn differs(&self, other: &Self) -> bool {
        let pair = [(self, other), (other, self)];
        pair.iter().any(|(one, other)| one.gouge.is_some() && other.is_right())
    }

    fn said(&self) -> String {
        match &self.gouge {
            Some((depth, lines)) => {
                let line = if lines.len() == 1 { "line" } else { "lines" };
                format!(
                    "the tool gouges the target by {depth:.3} mm in {line} {}",
                    lines.join(", ")
                )
            }
            None if self.is_right() => format!("no move goes more than {} mm below the target", self.limit),
            None => format!(
                "it is not known whether a move goes more than {} mm below the target",
                self.limit
            ),
        }
    }
}

/// A reading, along the moves that are not in the other one.
fn reading(session: Session, target: &Target, own: &[&JobPath], others: &[&JobPath]) -> Result<Reading, JobError> {
    let job = session.job;
    let [limit, most] = limits(job, |[gouge, _]| gouge);
    let width = asked::WIDTH * limit;
    let mut runs = Vec::new();
    for (path, other) in own.iter().zip(others) {
        runs.extend(differing(path, other).into_iter().map(|run| (*path, run)));
    }
    let moves: usize = runs.iter().map(|(_, (_, run))| run.moves()).sum();
    let covers: BTreeMap<u32, Vec<Convex>> = own
        .iter()
        .filter_map(|path| {
            Some((
                path.tool,
                cover_and_cores(job.tools.get(&path.tool)?, asked::CHORDS * limit),
            ))
        })
        .collect();
    let cutters: Vec<Cutter> = runs
        .iter()
        .map(|(path, (_, run))| Cutter::new(covers.get(&path.tool).map_or(&[], Vec::as_slice), run, None))
        .collect();
    let budget = asked::PAIRS + asked::PAIRS_OF_MOVE * moves;
    let limits = Limits::new(limit, width, budget);
    let found = deepest(target, &cutters, &limits, false, session.monitor).ok_or(JobError::Cancelled)?;
    let deep = found.moves.iter().filter(|(_, witness)| witness.depth > most);
    let places = deep.clone().filter_map(|(number, witness)| {
        let (path, (first, _)) = &runs[*number];
        work::place(path, first + witness.number, session.folder())
    });
    let main = own.first().map_or("", |path| path.source.as_str());
    let gouge = deep.map(|(_, witness)| witness.depth).reduce(f64::max);
    Ok(Reading {
        gouge: gouge.map(|depth| (depth, lines(places, main))),
        bound: found.bound,
        limit,
    })
}

/// The runs of moves of a path that are not in another one, each with the number of its first move.
fn differing(path: &JobPath, other: &JobPath) -> Vec<(usize, Path)> {
    let known: HashSet<u64> = keys(&other.path).collect();
    let own = keys(&path.path).enumerate();
    let new: Vec<usize> = own
        .filter_map(|(k, key)| (!known.contains(&key)).then_some(k))
        .collect();
    let runs = new.chunk_by(|a, b| a + 1 == *b);
    runs.map(|run| (run[0], path.path.part(run[0]..run[run.len() - 1] + 1)))
        .collect()
}

/// Each move as a number. Moves of the same blocks are the same to the last bit.
fn keys(path: &Path) -> impl Iterator<Item = u64> + '_ {
    let ends = path.poses_in_order(0).zip(path.poses_in_order(1));
    ends.enumerate().map(|(number, ends)| {
        let mut hash = DefaultHasher::new();
        format!("{ends:?} {:?}", path.way(number)).hash(&mut hash);
        hash.finish()
    })
}

/// Lines as they are said, neighbours together; with their files where these are not the program's own.
fn lines(places: impl Iterator<Item = (String, usize)>, main: &str) -> Vec<String> {
    let all: BTreeSet<(String, usize)> = places.collect();
    let all: Vec<_> = all.into_iter().collect();
    let runs = all.chunk_by(|a, b| a.0 == b.0 && a.1 + 1 >= b.1);
    let mut said: Vec<String> = runs
        .map(|run| {
            let (file, first) = &run[0];
            let last = run[run.len() - 1].1;
            let file = if file == main {
                String::new()
            } else {
                format!(" of {file}")
            };
            if last > *first {
                format!("{first} to {last}{file}")
            } else {
                format!("{first}{file}")
            }
        })
        .collect();
    if said.len() > LISTED {
        let more = said.len() - LISTED;
        said.truncate(LISTED);
        said.push(format!("{more} more places"));
    }
    said
}

/// So many places are listed.
const LISTED: usize = 6;
