//! What is proven of the stock as it is at each time: shanks and holders beside it, and rapids through it. As rapids
//! count all moves that must not cut: with the spindle stopped, or before the first feed.

use super::bodies::{name_part, part};
use super::{LISTED, Proof, Proven, described, finding, place};
use crate::base::JobError;
use crate::session::CancelOnly;
use crate::verify::asked::Moving;
use crate::verify::asked::material::{about, kept_from};
use crate::verify::texts::ProgramTexts;
use std::collections::BTreeMap;
use sweepsim::Monitor;
use sweepsim_check::{Claim, Question};
use sweepsim_formats::{Measure, Statement, StatementState};
use sweepsim_proof::{Convex, Movers, Touched, Witness, Work, material_claim, touched_from};

/// What was found of bodies and rapids beside the stock; nothing of a stock that was guessed.
pub(super) struct BesideStock {
    solids: Solids,
    found: Vec<(Movers, Touched)>,
}

impl BesideStock {
    pub fn searched(proof: &Proof) -> Result<Self, JobError> {
        let solids = Solids {
            cutters: proof.asked.beside_stock(Moving::Cutters),
            bodies: proof.asked.beside_stock(Moving::Bodies),
        };
        let all = proof.asked.beside_stock.iter();
        let found = all.map(|movers| Ok((*movers, searched(proof, &solids, *movers)?)));
        let found = found.collect::<Result<_, JobError>>()?;
        Ok(Self { solids, found })
    }

    /// What is proven by it.
    pub fn proven(&self, proof: &Proof, texts: &mut ProgramTexts) -> Vec<Proven> {
        let all = self.found.iter();
        all.map(|(movers, found)| said(proof, texts, *movers, found, &self.solids))
            .collect()
    }
}

/// Of each tool.
struct Solids {
    cutters: BTreeMap<u32, Vec<Convex>>,
    bodies: BTreeMap<u32, Vec<Convex>>,
}

pub(super) fn of_tool(all: &BTreeMap<u32, Vec<Convex>>, tool: u32) -> &[Convex] {
    all.get(&tool).map_or(&[], Vec::as_slice)
}

fn searched(proof: &Proof, solids: &Solids, movers: Movers) -> Result<Touched, JobError> {
    let (session, job) = (proof.session, proof.session.job);
    let must_not_cut = job.paths.iter();
    let must_not_cut = must_not_cut.map(|path| |number: usize| kept_from(path, number).is_some());
    let must_not_cut: Vec<_> = must_not_cut.collect();
    let work = job.paths.iter().zip(&must_not_cut).map(|(path, is_rapid)| Work {
        cutter: proof.asked.cutter(path, of_tool(&solids.cutters, path.tool)),
        bodies: of_tool(&solids.bodies, path.tool),
        is_rapid,
    });
    let work: Vec<Work> = work.collect();
    let room = proof.asked.room(movers);
    // Beside statements about obstacles, which tell how far they are.
    let beside = CancelOnly(session.monitor);
    let monitor: &dyn Monitor = match proof.asked.statements.is_empty() {
        true => session.monitor,
        false => &beside,
    };
    let found = touched_from(&proof.known(None), &job.stock, &work, movers, &room, monitor);
    let found = found.map_err(|error| session.failure(format!("stock: {error}")))?;
    found.ok_or(JobError::Cancelled)
}

/// An answer to the question about some movers, if it is asked.
fn claims(proof: &Proof, solids: &Solids, movers: Movers, found: &Touched) -> Vec<(usize, Claim)> {
    let Some(scene) = &proof.scene else {
        return Vec::new();
    };
    let [bodies, cutters] = [&solids.bodies, &solids.cutters].map(|solids| proof.asked.along(solids, None));
    let own = match movers {
        Movers::Bodies => &bodies,
        Movers::Rapids => &cutters,
    };
    let questions = scene.questions.iter().enumerate();
    let asked = questions.filter(|(_, question)| question.about == about(movers));
    let claim = |(number, question): (usize, &Question)| {
        let claim = material_claim(scene, question, [own, &cutters], question.limit, found)?;
        Some((number, claim))
    };
    asked.filter_map(claim).collect()
}

fn said(proof: &Proof, texts: &mut ProgramTexts, movers: Movers, found: &Touched, solids: &Solids) -> Proven {
    let (job, room) = (proof.session.job, proof.asked.room(movers));
    let mut statement = Statement::new(about(movers), room.distance.abs());
    if room.distance > 0.0 {
        statement.measure = Measure::Distance;
    }
    let is_distance = statement.measure == Measure::Distance;
    let order = |witness: &Witness| if is_distance { -witness.depth } else { witness.depth };
    let worst = found.moves.iter();
    let worst = worst.max_by(|(_, a), (_, b)| order(a).total_cmp(&order(b))).cloned();
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
    if is_body {
        name_part(job, Moving::Bodies, &mut statement);
    }
    if statement.state == StatementState::Open {
        statement.open_count = found.open_count;
        let open = found.open.iter().take(LISTED);
        statement.open = open.map(|(path, open)| place(job, texts, *path, open)).collect();
        statement.reason = loose(&solids.cutters);
    }
    let mut findings = Vec::new();
    for (path, witness) in &found.moves {
        let why = kept_from(&job.paths[*path], witness.number).filter(|_| !is_body);
        let mut own = finding(job, texts, why.unwrap_or("collision"), *path, witness);
        own.near = is_distance && witness.depth > 0.0;
        if is_body {
            own.body = part(job, Moving::Bodies, own.tool);
        }
        findings.push(own);
    }
    Proven::of(statement, findings, claims(proof, solids, movers, found))
}

/// Why it may not be known what tools have removed.
pub(super) fn loose(cutters: &BTreeMap<u32, Vec<Convex>>) -> Option<String> {
    let loose = cutters.iter().filter(|(_, solids)| solids.iter().any(Convex::is_loose));
    let loose: Vec<String> = loose.map(|(number, _)| number.to_string()).collect();
    let tools = loose.join(", ");
    let text = || {
        format!(
            "of tools that are not round, only what a round tool within them removes is known to be removed: {tools}"
        )
    };
    (!loose.is_empty()).then(text)
}
