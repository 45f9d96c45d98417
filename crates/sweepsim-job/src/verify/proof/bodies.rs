//! What is proven of shanks and holders, and of all beside fixtures.

use super::{LISTED, Proof, Proven, deep, described, finding, place};
use crate::base::JobError;
use crate::verify::asked::{Asked, Moving};
use crate::verify::texts::{ProgramTexts, name_of};
use sweepsim_formats::{Job, Measure, Statement, StatementState};
use sweepsim_proof::{Closest, Cutter, Enclosed, Target, closest_from, deepest_from, depth_claim, distance_claim};

/// A solid, or why it is none, and the set-up that it is there in.
pub(super) type Obstacle<'a> = (Result<&'a Target, String>, Option<usize>);

/// What is proven of something that moves beside solids.
pub(super) fn beside(
    proof: &Proof,
    texts: &mut ProgramTexts,
    asked: &Asked,
    solids: &[Obstacle],
) -> Result<Proven, JobError> {
    let kind = if asked.about == "holder" {
        "collision"
    } else {
        asked.about
    };
    if asked.is_apart() {
        kept_away(proof, texts, (asked, kind), solids)
    } else {
        kept_out(proof, texts, (asked, kind), solids)
    }
}

/// No body comes nearer to the solids than the clearance.
fn kept_away(
    proof: &Proof,
    texts: &mut ProgramTexts,
    (asked, kind): (&Asked, &str),
    solids: &[Obstacle],
) -> Result<Proven, JobError> {
    let (job, limit, recorded) = (proof.session.job, -asked.limit, proof.scene.is_some());
    let mut statement = Statement::new(asked.about, limit);
    statement.measure = Measure::Distance;
    let (wanted, bodies) = (proof.asked.limits(asked), proof.asked.solids(asked));
    let (mut all, mut claims): (Option<Closest>, _) = (None, Vec::new());
    for (number, (solid, setup)) in solids.iter().enumerate() {
        match solid {
            Ok(solid) => {
                let movers = proof.asked.along(&bodies, *setup);
                let own: Vec<Cutter> = movers.iter().map(|(_, own)| *own).collect();
                let known = proof.known(Some(asked.obstacles[number]));
                let found = closest_from(&known, solid, &own, &wanted, recorded, proof.session.monitor);
                let mut found = found.ok_or(JobError::Cancelled)?;
                claims.extend(proof.claim(asked, number, |scene, question| {
                    distance_claim(scene, question, solid, &movers, &found)
                }));
                found.trees = Vec::new();
                renumber(&mut found.nearest, &mut found.open, &mut found.moves, &movers);
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
    name_part(job, asked.moving, &mut statement);
    let mut findings = Vec::new();
    match statement.state {
        StatementState::Refuted => {
            statement.reason = None;
            for (path, witness) in &found.moves {
                let mut own = finding(job, texts, kind, *path, witness);
                own.near = witness.depth > 0.0;
                own.body = part(job, asked.moving, own.tool);
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
    Ok(Proven::of(statement, findings, claims))
}

/// Nothing goes into the solids.
fn kept_out(
    proof: &Proof,
    texts: &mut ProgramTexts,
    (asked, kind): (&Asked, &str),
    solids: &[Obstacle],
) -> Result<Proven, JobError> {
    let (job, about, limit) = (proof.session.job, asked.about, asked.limit);
    let recorded = proof.scene.is_some();
    let mut statement = Statement::new(about, limit);
    let (wanted, all_solids) = (proof.asked.limits(asked), proof.asked.solids(asked));
    let (mut all, mut claims) = (Enclosed::default(), Vec::new());
    for (number, (solid, setup)) in solids.iter().enumerate() {
        match solid {
            Ok(solid) => {
                let movers = proof.asked.along(&all_solids, *setup);
                let own: Vec<Cutter> = movers.iter().map(|(_, own)| *own).collect();
                let known = proof.known(Some(asked.obstacles[number]));
                let found = deepest_from(&known, solid, &own, &wanted, recorded, proof.session.monitor);
                let mut found = found.ok_or(JobError::Cancelled)?;
                claims.extend(proof.claim(asked, number, |scene, question| {
                    depth_claim(scene, question, solid, &movers, &found)
                }));
                renumber(&mut found.deepest, &mut found.open, &mut found.moves, &movers);
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
    name_part(job, asked.moving, &mut statement);
    for own in &mut findings {
        own.kind = kind.to_owned();
        own.body = part(job, asked.moving, own.tool);
    }
    Ok(Proven::of(statement, findings, claims))
}

/// Says which part of the tool it was, as far as it is known.
pub(super) fn name_part(job: &Job, moving: Moving, statement: &mut Statement) {
    if let Some(witness) = &mut statement.witness {
        witness.body = witness
            .path
            .and_then(|path| part(job, moving, Some(job.paths[path].tool)));
    }
}

/// Which parts of a tool it may be, if that is not the cutter alone: `shank or holder`.
pub(super) fn part(job: &Job, moving: Moving, tool: Option<u32>) -> Option<String> {
    let bodies = job.bodies.get(&tool?).filter(|_| moving != Moving::Cutters)?;
    let cutter = (moving == Moving::Both).then_some("cutter");
    let mut names = Vec::new();
    for name in cutter.into_iter().chain(bodies.iter().map(|body| name_of(body.kind))) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let last = names.pop().filter(|last| *last != "cutter")?;
    Some(match names.is_empty() {
        true => last.to_owned(),
        false => format!("{} or {last}", names.join(", ")),
    })
}

type OfPath<T> = (usize, T);

/// Gives what was found the numbers of paths.
fn renumber<T, U>(
    extreme: &mut Option<OfPath<T>>,
    open: &mut [OfPath<U>],
    moves: &mut [OfPath<T>],
    movers: &[(usize, Cutter)],
) {
    let paths = extreme.iter_mut().chain(moves).map(|(path, _)| path);
    for path in paths.chain(open.iter_mut().map(|(path, _)| path)) {
        *path = movers[*path].0;
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
