//! What is proven of the stock as it is at each time: shanks and holders beside it, and rapids through it. As rapids
//! count all moves that must not cut: with the spindle stopped, or before the first feed.

use super::bodies::{bodies, body, clearance, contact, tolerance};
use super::{CHORDS, LISTED, Proven, cutters, described, finding, place};
use crate::base::JobError;
use crate::session::Session;
use crate::verify::scope::is_guessed;
use crate::verify::texts::ProgramTexts;
use std::collections::BTreeMap;
use sweepsim_formats::{Job, JobPath, Measure, Statement, StatementState};
use sweepsim_proof::{Convex, Cutter, Movers, Room, Touched, Work, touched};

/// The most parts that are looked at in a statement: so many, and so many for each move.
const PARTS: usize = 200_000;
const PARTS_OF_MOVE: usize = 100;
/// Segments are so near to their path, as a share of the room.
const DEVIATION: f64 = 0.5e-3;

/// What is proven of bodies and rapids beside the stock; nothing of a stock that was guessed.
pub(super) fn beside_stock(session: Session, texts: &mut ProgramTexts) -> Result<Vec<Proven>, JobError> {
    let job = session.job;
    if is_guessed(session) {
        return Ok(Vec::new());
    }
    let solids = Solids {
        cutters: cutters(job, CHORDS * contact(job)),
        bodies: bodies(job, tolerance(session)),
    };
    let mut all = Vec::new();
    if job
        .paths
        .iter()
        .any(|path| (0..path.path.moves()).any(|number| path.rapid.get(number)))
    {
        all.push(judged(session, texts, &solids, Movers::Rapids)?);
    }
    if job.bodies.values().any(|own| !own.is_empty()) {
        all.push(judged(session, texts, &solids, Movers::Bodies)?);
    }
    Ok(all)
}

/// Of each tool.
struct Solids {
    cutters: BTreeMap<u32, Vec<Convex>>,
    bodies: BTreeMap<u32, Vec<Convex>>,
}

/// Why a move must not cut, by the kind of finding if it does.
fn kept_from(path: &JobPath, number: usize) -> Option<&'static str> {
    let why = [
        ("rapid", &path.rapid),
        ("spindle", &path.spindle_stopped),
        ("feed", &path.no_feed),
    ];
    why.into_iter()
        .find_map(|(kind, flags)| flags.get(number).then_some(kind))
}

fn of_tool(all: &BTreeMap<u32, Vec<Convex>>, tool: u32) -> &[Convex] {
    all.get(&tool).map_or(&[], Vec::as_slice)
}

fn judged(session: Session, texts: &mut ProgramTexts, solids: &Solids, movers: Movers) -> Result<Proven, JobError> {
    let job = session.job;
    let (about, wanted) = match movers {
        Movers::Bodies => ("collision", clearance(session)),
        Movers::Rapids => ("rapid", 0.0),
    };
    let (limit, distance) = match wanted > 0.0 {
        true => (wanted, wanted),
        false => (contact(job), -contact(job)),
    };
    let is_rapid = job
        .paths
        .iter()
        .map(|path| |number: usize| kept_from(path, number).is_some());
    let is_rapid: Vec<_> = is_rapid.collect();
    let work = job.paths.iter().zip(&is_rapid).map(|(path, is_rapid)| Work {
        cutter: Cutter {
            solids: of_tool(&solids.cutters, path.tool),
            path: &path.path,
            others: Some(&path.other_courses),
        },
        bodies: of_tool(&solids.bodies, path.tool),
        is_rapid,
    });
    let work: Vec<Work> = work.collect();
    let room = Room {
        distance,
        deviation: DEVIATION * limit,
        parts: PARTS + PARTS_OF_MOVE * job.moves(),
    };
    let found = touched(&job.stock, &work, movers, &room, session.monitor);
    let found = found.map_err(|error| session.failure(format!("stock: {error}")))?;
    let found = found.ok_or(JobError::Cancelled)?;
    let mut statement = Statement::new(about, limit);
    if wanted > 0.0 {
        statement.measure = Measure::Distance;
    }
    Ok(said(job, texts, statement, &found, solids))
}

fn said(job: &Job, texts: &mut ProgramTexts, mut statement: Statement, found: &Touched, solids: &Solids) -> Proven {
    let is_distance = statement.measure == Measure::Distance;
    let depths = |moves: &[_]| -> Option<(usize, sweepsim_proof::Witness)> {
        let of =
            |(_, witness): &&(usize, sweepsim_proof::Witness)| if is_distance { -witness.depth } else { witness.depth };
        moves.iter().max_by(|a, b| of(a).total_cmp(&of(b))).cloned()
    };
    let worst = depths(&found.moves);
    let is_known = found.open_count == 0 && worst.is_none();
    statement.state = match &worst {
        Some(_) => StatementState::Refuted,
        None if is_known => StatementState::Proven,
        None => StatementState::Open,
    };
    let seen = worst.as_ref().map(|(_, witness)| witness.depth);
    statement.enclosure = match (is_distance, is_known) {
        (false, true) => [0.0, statement.limit],
        (false, false) => [seen.unwrap_or(0.0), f64::MAX],
        (true, true) => [statement.limit, f64::MAX],
        (true, false) => [0.0, seen.unwrap_or(f64::MAX)],
    };
    statement.witness = worst.map(|(path, witness)| described(job, texts, path, &witness));
    let is_body = statement.about == "collision";
    if let Some(witness) = statement.witness.as_mut().filter(|_| is_body) {
        witness.body = witness.path.and_then(|path| body(job, Some(job.paths[path].tool)));
    }
    if statement.state == StatementState::Open {
        statement.open_count = found.open_count;
        let open = found.open.iter().take(LISTED);
        statement.open = open.map(|(path, open)| place(job, texts, *path, open)).collect();
        statement.reason = loose(solids);
    }
    let mut findings = Vec::new();
    for (path, witness) in &found.moves {
        let why = kept_from(&job.paths[*path], witness.number).filter(|_| !is_body);
        let mut own = finding(job, texts, why.unwrap_or("collision"), *path, witness);
        own.near = is_distance && witness.depth > 0.0;
        if is_body {
            own.body = body(job, own.tool);
        }
        findings.push(own);
    }
    Proven::of(statement, findings)
}

/// Tools of which it is not known what they remove.
fn loose(solids: &Solids) -> Option<String> {
    let loose = solids
        .cutters
        .iter()
        .filter(|(_, solids)| solids.iter().all(Convex::is_loose));
    let loose: Vec<String> = loose.map(|(number, _)| number.to_string()).collect();
    let tools = loose.join(", ");
    let text = || format!("it is not known what tools of free-form patches have removed for certain: {tools}");
    (!loose.is_empty()).then(text)
}
