//! What is proven at every time of the program and in every place: nothing depends on the lines of the dexels.

use super::certificate::{Asked, Certified, limits};
use super::texts::ProgramTexts;
use super::work;
use crate::base::JobError;
use crate::session::Session;
use sweepsim_formats::{Job, OpenPlace, ReportedFinding, Statement, StatementState, StatementWitness, Verdict};
use sweepsim_proof::{Enclosed, Fault, OpenBox, Target, Witness, deepest_recorded};

/// As many faults of the target are named.
const FAULTS: usize = 3;
/// As many open places are listed.
const LISTED: usize = 100;

/// A statement with the moves that were seen to break it.
pub(super) struct Proven {
    pub statement: Statement,
    pub findings: Vec<ReportedFinding>,
    /// For whoever wants to check it.
    pub certified: Option<Certified>,
}

/// What is proven of gouges; nothing without a target.
pub(super) fn gouges(session: Session, texts: &mut ProgramTexts) -> Result<Option<Proven>, JobError> {
    let job = session.job;
    let Some(target) = &job.target else {
        return Ok(None);
    };
    let [least, most] = limits(job);
    let mut statement = Statement::new("gouge", least);
    let solid = match Target::new(&target.mesh) {
        Ok(solid) if target.mesh.volume() > 0.0 => solid,
        Ok(_) => {
            statement.reason = Some("the target is inside out".to_owned());
            return Ok(Some(Proven::open(statement)));
        }
        Err(error) => {
            statement.reason = Some(format!("the target is no solid: {error}"));
            return Ok(Some(Proven::open(statement)));
        }
    };
    session.phase("proof");
    if let Some(reason) = faulty(&solid) {
        statement.reason = Some(reason);
        return Ok(Some(Proven::open(statement)));
    }
    let asked = Asked::new(job);
    let cutters = asked.cutters(job);
    let own: Vec<_> = cutters.iter().map(|(_, cutter)| *cutter).collect();
    let found = deepest_recorded(&solid, &own, &asked.limits, session.monitor).ok_or(JobError::Cancelled)?;
    let certified = Certified::new(job, &solid, &asked, &found);
    let known = found.deepest.as_ref().map_or(0.0, |(_, witness)| witness.depth);
    statement.enclosure = [known, found.bound];
    statement.state = if found.bound <= least {
        StatementState::Proven
    } else if known > most {
        StatementState::Refuted
    } else {
        StatementState::Open
    };
    if statement.state == StatementState::Open && known > least {
        statement.reason = Some("the limits differ from region to region, and the depth is between them".to_owned());
    }
    let witness = found.deepest.as_ref();
    statement.witness = witness.map(|(path, witness)| described(job, texts, *path, witness));
    statement.open_count = found.open_count;
    statement.open = found
        .open
        .iter()
        .take(LISTED)
        .map(|(path, open)| place(job, texts, *path, open))
        .collect();
    let findings = if statement.state == StatementState::Refuted {
        beyond(job, texts, &found, most)
    } else {
        Vec::new()
    };
    Ok(Some(Proven {
        statement,
        findings,
        certified,
    }))
}

/// What is wrong with the triangles of a target, with some of the places.
fn faulty(solid: &Target) -> Option<String> {
    let faults = solid.faults(FAULTS + 1);
    if faults.is_empty() {
        return None;
    }
    let place = |fault: &Fault| {
        let (what, at) = match fault {
            Fault::Doubled(at) => ("has a face twice", at),
            Fault::Crossing(at) => ("intersects itself", at),
            _ => return "is no solid".to_owned(),
        };
        let [x, y, z] = at.map(|c| format!("{c:.3}"));
        format!("{what} at ({x}, {y}, {z})")
    };
    let mut named: Vec<String> = faults.iter().take(FAULTS).map(place).collect();
    if faults.len() > FAULTS {
        named.push("…".to_owned());
    }
    Some(format!("the target {}", named.join(", ")))
}

impl Proven {
    fn open(statement: Statement) -> Self {
        Self {
            statement,
            findings: Vec::new(),
            certified: None,
        }
    }
}

fn described(job: &Job, texts: &mut ProgramTexts, path: usize, witness: &Witness) -> StatementWitness {
    let mut described = StatementWitness::default();
    (described.path, described.r#move) = (path, witness.number);
    (described.time, described.place) = (witness.time, witness.place);
    if let Some((file, line)) = work::place(&job.paths[path], witness.number, &texts.folder) {
        described.text = texts.line(&file, line);
        (described.file, described.line) = (Some(file), Some(line));
    }
    described
}

fn place(job: &Job, texts: &ProgramTexts, path: usize, open: &OpenBox) -> OpenPlace {
    let mut place = OpenPlace::default();
    (place.path, place.r#move) = (path, open.first.0);
    place.time = [open.first.1, open.last.1];
    let ([a, b, c], [d, e, f]) = (open.low, open.high);
    place.r#box = [a, b, c, d, e, f];
    if let Some((file, line)) = work::place(&job.paths[path], open.first.0, &texts.folder) {
        (place.file, place.line) = (Some(file), Some(line));
    }
    place
}

/// The moves that were seen to go deeper than the limit.
fn beyond(job: &Job, texts: &mut ProgramTexts, found: &Enclosed, limit: f64) -> Vec<ReportedFinding> {
    let deep = found.moves.iter().filter(|(_, witness)| witness.depth > limit);
    deep.map(|(number, witness)| {
        let path = &job.paths[*number];
        let mut finding = ReportedFinding::default();
        finding.kind = "gouge".to_owned();
        finding.between = true;
        (finding.tool, finding.path, finding.r#move) = (Some(path.tool), Some(*number), Some(witness.number));
        finding.setup = job.has_setups.then_some(path.setup);
        if let Some((file, line)) = work::place(path, witness.number, &texts.folder) {
            finding.text = texts.line(&file, line);
            (finding.file, finding.line) = (Some(file), Some(line));
        }
        finding.time = Some(witness.time);
        (finding.place, finding.depth) = (witness.place, witness.depth);
        finding
    })
    .collect()
}

/// The same statement, if what was found on the lines refutes it.
pub(super) fn with_lines(mut statement: Statement, findings: &[ReportedFinding]) -> Statement {
    let gouges = findings.iter().filter(|finding| finding.kind == "gouge");
    let Some(deepest) = gouges.max_by(|a, b| a.depth.total_cmp(&b.depth)) else {
        return statement;
    };
    if statement.state == StatementState::Open {
        statement.state = StatementState::Refuted;
        // On a line, the cutter is where no cutter may be: deeper than the limit, by how much is not said.
        statement.enclosure[0] = statement.enclosure[0].max(statement.limit);
        statement.reason = None;
        let mut witness = StatementWitness::default();
        (witness.path, witness.r#move) = (deepest.path.unwrap_or_default(), deepest.r#move.unwrap_or_default());
        (witness.file, witness.line) = (deepest.file.clone(), deepest.line);
        (witness.text, witness.place) = (deepest.text.clone(), deepest.place);
        witness.time = deepest.time.unwrap_or_default();
        statement.witness = Some(witness);
    }
    statement
}

/// The verdict, if statements are asked for as well.
pub(super) fn verdict(found: Verdict, statements: &[Statement]) -> Verdict {
    let any = |state| statements.iter().any(|statement| statement.state == state);
    match found {
        Verdict::Fail => Verdict::Fail,
        _ if any(StatementState::Refuted) => Verdict::Fail,
        _ if any(StatementState::Open) => Verdict::Undecided,
        _ => Verdict::Pass,
    }
}
