//! What is proven of what is left standing.

use super::process::loose;
use super::{Known, LISTED, Proof, Proven};
use crate::base::JobError;
use crate::verify::asked::{Asked, limits};
use sweepsim_formats::{Measure, OpenPlace, ReportedFinding, Statement, StatementState, StatementWitness};
use sweepsim_proof::{Cutter, Target, height_claim, highest_from};

/// If the lines have seen material that is left, how much is left has so many patches to be known better.
const PATCHES: usize = 200_000;

/// What is proven of excess.
pub(super) fn excess(
    proof: &Proof,
    asked: &Asked,
    solid: &Result<Target, String>,
    lines: &Known,
) -> Result<Proven, JobError> {
    let (session, job) = (proof.session, proof.session.job);
    let [least, most] = limits(job, |[_, excess]| excess);
    let mut statement = Statement::new("excess", least);
    statement.measure = Measure::Height;
    let solid = match solid {
        Ok(solid) => solid,
        Err(reason) => {
            statement.reason = Some(reason.clone());
            return Ok(Proven::open(statement));
        }
    };
    let cutters = proof.asked.solids(asked);
    let movers = proof.asked.along(&cutters, None);
    let along: Vec<Cutter> = movers.iter().map(|(_, cutter)| *cutter).collect();
    let mut wanted = proof.asked.limits(asked);
    wanted.expected = lines.excess;
    if lines.is_left {
        wanted.pairs = PATCHES;
    }
    let known = proof.known(Some(asked.obstacles[0]));
    let along = &along[..];
    let left = highest_from(
        &known,
        (solid, &job.stock),
        along,
        &wanted,
        proof.scene.is_some(),
        session.monitor,
    );
    let left = left.map_err(|error| session.failure(format!("stock: {error}")))?;
    let left = left.ok_or(JobError::Cancelled)?;
    let claims = proof.claim(asked, 0, |scene, question| {
        height_claim(scene, question, &movers, &left)
    });
    let known = left.highest.map_or(0.0, |(_, height)| height);
    statement.enclosure = [known, left.bound.min(f64::MAX)];
    statement.state = if left.bound <= least {
        StatementState::Proven
    } else if known > most {
        StatementState::Refuted
    } else {
        StatementState::Open
    };
    statement.witness = left.highest.map(|(place, _)| {
        let mut witness = StatementWitness::default();
        witness.place = place;
        witness
    });
    let mut findings = Vec::new();
    match statement.state {
        StatementState::Refuted => {
            let mut finding = ReportedFinding::default();
            finding.kind = "excess".to_owned();
            finding.between = true;
            finding.depth = known;
            finding.place = left.highest.map_or([0.0; 3], |(place, _)| place);
            findings.push(finding);
        }
        StatementState::Open => {
            statement.reason = if known > least {
                Some(super::between_limits([least, most], known, "high"))
            } else {
                loose(&cutters)
            };
            statement.open_count = left.open_count;
            let place = |[low, high]: &[[f64; 3]; 2]| {
                let mut place = OpenPlace::default();
                place.r#box = [low[0], low[1], low[2], high[0], high[1], high[2]];
                place
            };
            statement.open = left.open.iter().take(LISTED).map(place).collect();
        }
        _ => {}
    }
    Ok(Proven::of(statement, findings, claims))
}
