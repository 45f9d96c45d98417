//! What is proven of shanks and holders, and of all beside fixtures.

use super::{CHORDS, LISTED, Proven, along, cutters, deep, described, finding, floor, pairs, place, solids};
use crate::base::JobError;
use crate::session::Session;
use crate::verify::texts::{ProgramTexts, name_of};
use std::collections::BTreeMap;
use sweepsim_formats::{Job, Measure, Statement, StatementState};
use sweepsim_proof::{Closest, Convex, Cutter, Enclosed, Limits, Target, closest, cover, deepest};

/// What goes no deeper into something than this touches it, in millimetres.
const CONTACT: f64 = 1e-3;
/// Distances are enclosed in so large a part of the clearance.
const WIDTH: f64 = 0.1;

/// The bodies of all tools, as solids.
pub(super) fn bodies(job: &Job, tolerance: f64) -> BTreeMap<u32, Vec<Convex>> {
    let of_tool = |(number, own): (&u32, &Vec<sweepsim::motion::Body>)| {
        let solids = own.iter().flat_map(|body| cover(&body.solid, tolerance));
        (*number, solids.collect())
    };
    job.bodies.iter().map(of_tool).collect()
}

pub(super) fn clearance(session: Session) -> f64 {
    session.request.judging.clearance.unwrap_or(session.job.clearance)
}

/// What is proven of bodies and the target; nothing without bodies.
pub(super) fn beside_target(
    session: Session,
    texts: &mut ProgramTexts,
    solid: &Result<Target, String>,
) -> Result<Option<Proven>, JobError> {
    let job = session.job;
    if job.bodies.values().all(Vec::is_empty) {
        return Ok(None);
    }
    let all = [(solid.as_ref().map_err(String::clone), None)];
    let bodies = bodies(job, tolerance(session));
    Ok(Some(kept_away(
        session,
        texts,
        ("holder", "collision"),
        &along(job, &bodies),
        &all,
    )?))
}

/// What is proven of cutters, of bodies and fixtures; nothing without these.
pub(super) fn beside_fixtures(session: Session, texts: &mut ProgramTexts) -> Result<Vec<Proven>, JobError> {
    let job = session.job;
    let mut all = Vec::new();
    for (setup, own) in job.setups.iter().enumerate() {
        for fixture in &own.fixtures {
            match solids::around(fixture, "a fixture") {
                Ok(solids) => all.extend(solids.into_iter().map(|solid| (Ok(solid), Some(setup)))),
                Err(reason) => all.push((Err(reason), Some(setup))),
            }
        }
    }
    if all.is_empty() {
        return Ok(Vec::new());
    }
    let all: Vec<_> = all
        .iter()
        .map(|(solid, setup)| (solid.as_ref().map_err(String::clone), *setup))
        .collect();
    let mut solids = cutters(job, CHORDS * contact(job));
    let bodies = bodies(job, tolerance(session));
    let mut proven = Vec::new();
    if clearance(session) > 0.0 && bodies.values().any(|own| !own.is_empty()) {
        proven.push(kept_away(
            session,
            texts,
            ("fixture", "fixture"),
            &along(job, &bodies),
            &all,
        )?);
    } else {
        for (number, own) in bodies {
            solids.entry(number).or_default().extend(own);
        }
    }
    proven.insert(
        0,
        kept_out(session, texts, ("fixture", "fixture"), &along(job, &solids), &all)?,
    );
    Ok(proven)
}

pub(super) fn contact(job: &Job) -> f64 {
    floor(job).max(CONTACT)
}

/// Concave outlines are replaced by chords within this.
pub(super) fn tolerance(session: Session) -> f64 {
    CHORDS * clearance(session).max(contact(session.job))
}

/// A solid, or why it is none, and the set-up that it is there in.
type Obstacle<'a> = (Result<&'a Target, String>, Option<usize>);

/// No body comes nearer to the solids than the clearance; or, without one, goes into them.
fn kept_away(
    session: Session,
    texts: &mut ProgramTexts,
    kinds: (&str, &str),
    bodies: &[Cutter],
    solids: &[Obstacle],
) -> Result<Proven, JobError> {
    let (job, limit) = (session.job, clearance(session));
    if limit <= 0.0 {
        return kept_out(session, texts, kinds, bodies, solids);
    }
    let mut statement = Statement::new(kinds.0, limit);
    statement.measure = Measure::Distance;
    let wanted = Limits {
        depth: limit,
        width: WIDTH * limit,
        pairs: pairs(job),
    };
    let mut all: Option<Closest> = None;
    for (solid, setup) in solids {
        match solid {
            Ok(solid) => {
                let (numbers, own) = of_setup(job, bodies, *setup);
                let mut found = closest(solid, &own, &wanted, session.monitor).ok_or(JobError::Cancelled)?;
                renumber(&mut found.nearest, &mut found.open, &mut found.moves, &numbers);
                all = Some(match all {
                    Some(all) => joined(all, found),
                    None => found,
                });
            }
            Err(reason) => statement.reason = Some(reason.clone()),
        }
    }
    let Some(found) = all else {
        statement.enclosure = [0.0, f64::MAX];
        return Ok(Proven::open(statement));
    };
    let known = found.nearest.as_ref().map_or(f64::MAX, |(_, witness)| witness.depth);
    let bound = if statement.reason.is_some() { 0.0 } else { found.bound };
    statement.enclosure = [bound.min(f64::MAX), known];
    statement.state = if known < limit {
        StatementState::Refuted
    } else if bound >= limit {
        StatementState::Proven
    } else {
        StatementState::Open
    };
    let nearest = found.nearest.as_ref();
    statement.witness = nearest.map(|(path, witness)| described(job, texts, *path, witness));
    name_body(job, &mut statement);
    let mut findings = Vec::new();
    match statement.state {
        StatementState::Refuted => {
            statement.reason = None;
            for (path, witness) in &found.moves {
                let mut own = finding(job, texts, kinds.1, *path, witness);
                own.near = witness.depth > 0.0;
                own.body = body(job, own.tool);
                findings.push(own);
            }
        }
        StatementState::Open => {
            statement.open_count = found.open_count;
            let open = found.open.iter().take(LISTED);
            statement.open = open.map(|(path, open)| place(job, texts, *path, open)).collect();
        }
        _ => {}
    }
    Ok(Proven::of(statement, findings))
}

/// Nothing goes into the solids.
fn kept_out(
    session: Session,
    texts: &mut ProgramTexts,
    (about, kind): (&str, &str),
    movers: &[Cutter],
    solids: &[Obstacle],
) -> Result<Proven, JobError> {
    let (job, limit) = (session.job, contact(session.job));
    let mut statement = Statement::new(about, limit);
    let wanted = Limits {
        depth: limit,
        width: 0.5 * limit,
        pairs: pairs(job),
    };
    let mut all = Enclosed::default();
    for (solid, setup) in solids {
        match solid {
            Ok(solid) => {
                let (numbers, own) = of_setup(job, movers, *setup);
                let mut found = deepest(solid, &own, &wanted, session.monitor).ok_or(JobError::Cancelled)?;
                renumber(&mut found.deepest, &mut found.open, &mut found.moves, &numbers);
                all.bound = all.bound.max(found.bound);
                all.open.extend(found.open);
                all.open_count += found.open_count;
                all.moves.extend(found.moves);
                if let Some(deepest) = found.deepest
                    && all
                        .deepest
                        .as_ref()
                        .is_none_or(|(_, known)| deepest.1.depth > known.depth)
                {
                    all.deepest = Some(deepest);
                }
            }
            Err(reason) => {
                statement.reason = Some(reason.clone());
                all.bound = f64::MAX;
            }
        }
    }
    let mut findings = deep(job, texts, &mut statement, &all, limit);
    if statement.state == StatementState::Refuted {
        statement.reason = None;
    }
    if about == "holder" {
        name_body(job, &mut statement);
    }
    for own in &mut findings {
        own.kind = kind.to_owned();
        if about == "holder" {
            own.body = body(job, own.tool);
        }
    }
    Ok(Proven::of(statement, findings))
}

/// Says which body it was, in a statement about bodies alone.
fn name_body(job: &Job, statement: &mut Statement) {
    if let Some(witness) = &mut statement.witness {
        witness.body = witness.path.and_then(|path| body(job, Some(job.paths[path].tool)));
    }
}

/// The kind of the bodies of a tool, if there is only one.
pub(super) fn body(job: &Job, tool: Option<u32>) -> Option<String> {
    let own = job.bodies.get(&tool?)?;
    let kind = own.first()?.kind;
    own.iter()
        .all(|body| body.kind == kind)
        .then(|| name_of(kind).to_owned())
}

/// What moves in a set-up, with the numbers of the paths.
fn of_setup<'a>(job: &Job, movers: &[Cutter<'a>], setup: Option<usize>) -> (Vec<usize>, Vec<Cutter<'a>>) {
    let own = |number: &usize| setup.is_none_or(|setup| job.paths[*number].setup == setup);
    let numbers: Vec<usize> = (0..movers.len()).filter(own).collect();
    let movers = numbers.iter().map(|number| movers[*number]).collect();
    (numbers, movers)
}

type OfPath<T> = (usize, T);

fn renumber<T, U>(extreme: &mut Option<OfPath<T>>, open: &mut [OfPath<U>], moves: &mut [OfPath<T>], numbers: &[usize]) {
    let paths = extreme.iter_mut().chain(moves).map(|(path, _)| path);
    for path in paths.chain(open.iter_mut().map(|(path, _)| path)) {
        *path = numbers[*path];
    }
}

fn joined(mut all: Closest, other: Closest) -> Closest {
    all.bound = all.bound.min(other.bound);
    all.open.extend(other.open);
    all.open_count += other.open_count;
    all.moves.extend(other.moves);
    if let Some(nearest) = other.nearest
        && all
            .nearest
            .as_ref()
            .is_none_or(|(_, known)| nearest.1.depth < known.depth)
    {
        all.nearest = Some(nearest);
    }
    all
}
