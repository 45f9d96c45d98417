//! What is proven at every time of the program and in every place: nothing depends on the lines of the dexels.

mod bodies;
mod crowd;
mod excess;
mod free_place;
mod machine;
mod pairs;
mod process;
mod recalled;
mod registers;

pub(super) use free_place::propose;
pub(super) use registers::compare as compare_registers;

use super::asked::material::is_guessed;
use super::asked::solids;
use super::asked::{Asked, AskedAll, limits};
use super::texts::ProgramTexts;
use super::work;
use crate::base::cache::Key;
use crate::base::{JobError, words};
use crate::session::Session;
use std::sync::OnceLock;
use sweepsim_check::{Claim, Measure as Measured, Question, Scene};
use sweepsim_dexel::DistanceTo;
use sweepsim_formats::{
    Job, Measure, OpenPlace, ReportedFinding, Statement, StatementState, StatementWitness, Verdict,
};
use sweepsim_proof::{Cutter, Enclosed, Limits, OpenBox, Recall, Target, Witness, deepest_from, depth_claim};

/// As many open places are listed.
const LISTED: usize = 100;

/// What goes too deep may have to be lifted so many limits.
const LIFTS: f64 = 2.5;

/// A statement with the moves that were seen to break it.
struct Proven {
    statement: Statement,
    findings: Vec<ReportedFinding>,
    /// For whoever wants to check it: answers to some of the questions, by their numbers.
    claims: Vec<(usize, Claim)>,
}

/// What can be checked: the digest of what was asked, and an answer to each question, where there is one.
#[derive(Clone, Debug)]
pub(crate) struct Certified {
    pub scene: String,
    pub claims: Vec<Option<Claim>>,
}

/// Statements, the findings that break them, and what can be checked of them.
type All = (Vec<Statement>, Vec<ReportedFinding>, Option<Certified>);

/// What is asked, and in which request.
struct Proof<'a> {
    session: Session<'a>,
    asked: AskedAll<'a>,
    /// What a certificate is about, if one is wanted: only then, proofs are recorded.
    scene: Option<Scene>,
    /// Whether what earlier runs have proven is used; then, digests of what it is about: the stock, and each obstacle.
    recalls: bool,
    digests: Vec<OnceLock<Key>>,
}

/// What is known before anything is proven.
#[derive(Clone, Copy)]
pub(super) struct Known<'a> {
    /// What was found on the lines.
    pub findings: &'a [ReportedFinding],
    /// Whether material was left there that should not be.
    pub is_left: bool,
    /// How far the target is missed there at most.
    pub gouge: f64,
    pub excess: f64,
    /// The distance to the target, if there is one.
    pub distance: Option<&'a DistanceTo>,
}

impl<'a> Proof<'a> {
    fn new(session: Session<'a>, recorded: bool, recalls: bool) -> Self {
        let asked = AskedAll::new(session.job, session.request, is_guessed(session.plan));
        Self {
            session,
            scene: recorded.then(|| asked.scene()),
            recalls,
            digests: (0..=asked.obstacles.len()).map(|_| OnceLock::new()).collect(),
            asked,
        }
    }

    /// How far something may have to be lifted out of an obstacle.
    fn lift(&self, obstacle: usize) -> f64 {
        LIFTS * self.asked.deepest(obstacle)
    }

    /// An answer to the question that asks a statement of one of its obstacles.
    fn claim(
        &self,
        asked: &Asked,
        obstacle: usize,
        claim: impl Fn(&Scene, &Question) -> Option<Claim>,
    ) -> Vec<(usize, Claim)> {
        let is_asked = |question: &Question| {
            (question.about == asked.about && question.limit == asked.limit)
                && question.solid == asked.obstacles[obstacle]
        };
        let answer = |scene: &Scene| {
            let number = scene.questions.iter().position(is_asked)?;
            Some((number, claim(scene, &scene.questions[number])?))
        };
        self.scene.as_ref().and_then(answer).into_iter().collect()
    }
}

/// What is proven, what was seen to break it but not on the lines, and what can be checked.
pub(super) fn statements(session: Session, texts: &mut ProgramTexts, known: Known) -> Result<All, JobError> {
    session.phase("proof");
    let (all, is_crowded) = proven(session, texts, known, session.cache().is_some())?;
    match is_crowded && session.cache().is_some() {
        // What is found then must not depend on what was known.
        true => Ok(proven(session, texts, known, false)?.0),
        false => Ok(all),
    }
}

/// The same, and whether a work nearly ran out of room. `recalls`: whether what earlier runs have proven is used.
fn proven(session: Session, texts: &mut ProgramTexts, known: Known, recalls: bool) -> Result<(All, bool), JobError> {
    let proof = Proof::new(session, session.request.wants_certificate(), recalls);
    let solid_of = |number: usize, obstacle: &super::asked::Obstacle| {
        let what = match obstacle.setup {
            None => "the target",
            Some(_) => "a fixture",
        };
        let solid = obstacle.triangles.as_ref().map_err(String::clone);
        let distance = known.distance.filter(|_| obstacle.setup.is_none());
        let solid = solid.and_then(|soup| {
            let own = (distance, &proof.known(Some(number)) as &dyn Recall);
            solids::of_mesh(soup, what, proof.lift(number), own)
        });
        (number, solid, obstacle.setup)
    };
    let obstacles = proof.asked.obstacles.iter().enumerate();
    let solids = || obstacles.map(|(number, own)| solid_of(number, own)).collect();
    let (solids, digest): (Vec<_>, Option<String>) = rayon::join(solids, || proof.scene.as_ref().map(Scene::digest));
    let mut of_obstacles = |asked: &Asked| {
        let own = asked.obstacles.iter().map(|number| &solids[*number]);
        let own: Vec<_> = own
            .map(|(_, solid, setup)| (solid.as_ref().map_err(String::clone), *setup))
            .collect();
        match (asked.about, asked.measure) {
            ("gouge", _) => gouges(&proof, texts, asked, (&solids[0].1, known.gouge)),
            (_, Measured::Height) => excess::excess(&proof, asked, &solids[0].1, &known),
            _ => bodies::beside(&proof, texts, asked, &own),
        }
    };
    // One after the other: they divide the solids further. What is beside the stock needs none of these.
    let of_obstacles = || {
        let all = proof.asked.statements.iter().map(&mut of_obstacles);
        all.collect::<Result<Vec<Proven>, JobError>>()
    };
    let (of_obstacles, beside_stock) = rayon::join(of_obstacles, || process::BesideStock::searched(&proof));
    let mut all = of_obstacles?;
    all.extend(beside_stock?.proven(&proof, texts));
    all.extend(machine::apart(&proof, texts)?);
    let (mut statements, mut findings) = (Vec::new(), Vec::new());
    let questions = proof.scene.iter().flat_map(|scene| &scene.questions);
    let mut claims: Vec<Option<Claim>> = questions.map(|_| None).collect();
    for Proven {
        statement,
        findings: own,
        claims: answers,
    } in all
    {
        for (number, claim) in answers {
            claims[number] = Some(claim);
        }
        // What the lines have seen is known better from them.
        let is_new = |own: &ReportedFinding| {
            let same = |other: &ReportedFinding| {
                other.kind == own.kind && (other.path, other.r#move) == (own.path, own.r#move)
            };
            !known.findings.iter().any(same)
        };
        findings.extend(own.into_iter().filter(is_new));
        statements.push(with_lines(statement, known.findings));
    }
    let digest = digest.filter(|_| claims.iter().any(Option::is_some));
    let certified = digest.map(|scene| Certified { scene, claims });
    let is_crowded = |(_, solid, _): &(usize, Result<Target, String>, _)| solid.as_ref().is_ok_and(Target::is_crowded);
    Ok(((statements, findings, certified), solids.iter().any(is_crowded)))
}

/// What is proven of gouges. `expected`: how deep they are on the lines.
fn gouges(
    proof: &Proof,
    texts: &mut ProgramTexts,
    asked: &Asked,
    (solid, expected): (&Result<Target, String>, f64),
) -> Result<Proven, JobError> {
    let job = proof.session.job;
    let [least, most] = limits(job, |[gouge, _]| gouge);
    let mut statement = Statement::new("gouge", least);
    let solid = match solid {
        Ok(solid) => solid,
        Err(reason) => {
            statement.reason = Some(reason.clone());
            return Ok(Proven::open(statement));
        }
    };
    let solids = proof.asked.solids(asked);
    let movers = proof.asked.along(&solids, None);
    let own: Vec<Cutter> = movers.iter().map(|(_, cutter)| *cutter).collect();
    let found = deepest_from(
        &proof.known(Some(asked.obstacles[0])),
        solid,
        &own,
        &Limits {
            expected,
            ..proof.asked.limits(asked)
        },
        proof.scene.is_some(),
        proof.session.monitor,
    );
    let found = found.ok_or(JobError::Cancelled)?;
    let claims = proof.claim(asked, 0, |scene, question| {
        depth_claim(scene, question, solid, &movers, &found)
    });
    let findings = deep(job, texts, &mut statement, &found, most);
    let between = statement.state == StatementState::Open && statement.enclosure[0] > least;
    if between {
        statement.reason = Some(between_limits([least, most], statement.enclosure[0], "deep"));
    }
    Ok(Proven {
        statement,
        findings,
        claims,
    })
}

/// Why a statement about the smallest of the limits is open of which it is known that it does not keep that one.
fn between_limits([least, most]: [f64; 2], known: f64, how: &str) -> String {
    let [least, most, known] = [least, most, known].map(words::length);
    format!(
        "the limits differ from region to region, from {least} to {most} mm; it is {known} mm {how}, and only the lines \
         tell whether that is within its own region's limit"
    )
}

/// What is known of depths, in a statement about them; and the moves that go beyond `most`, if it is refuted by that.
fn deep(
    job: &Job,
    texts: &mut ProgramTexts,
    statement: &mut Statement,
    found: &Enclosed,
    most: f64,
) -> Vec<ReportedFinding> {
    let known = found.deepest.as_ref().map_or(0.0, |(_, witness)| witness.depth);
    statement.enclosure = [known, found.bound];
    statement.state = if found.bound <= statement.limit {
        StatementState::Proven
    } else if known > most {
        StatementState::Refuted
    } else {
        StatementState::Open
    };
    let witness = found.deepest.as_ref();
    statement.witness = witness.map(|(path, witness)| described(job, texts, *path, witness));
    statement.open_count = found.open_count;
    let open = found.open.iter().take(LISTED);
    statement.open = open.map(|(path, open)| place(job, texts, *path, open)).collect();
    if statement.state != StatementState::Refuted {
        return Vec::new();
    }
    let deep = found.moves.iter().filter(|(_, witness)| witness.depth > most);
    deep.map(|(path, witness)| finding(job, texts, &statement.about, *path, witness))
        .collect()
}

impl Proven {
    fn open(statement: Statement) -> Self {
        Self::of(statement, Vec::new(), Vec::new())
    }

    fn of(statement: Statement, findings: Vec<ReportedFinding>, claims: Vec<(usize, Claim)>) -> Self {
        Self {
            statement,
            findings,
            claims,
        }
    }
}

fn described(job: &Job, texts: &mut ProgramTexts, path: usize, witness: &Witness) -> StatementWitness {
    let mut described = StatementWitness::default();
    (described.path, described.r#move) = (Some(path), Some(witness.number));
    (described.time, described.place) = (witness.time, witness.place);
    if let Some((file, line)) = work::place(&job.paths[path], witness.number, &texts.folder) {
        described.text = texts.line(&file, line);
        (described.file, described.line) = (Some(file), Some(line));
    }
    described
}

fn place(job: &Job, texts: &ProgramTexts, path: usize, open: &OpenBox) -> OpenPlace {
    let mut place = OpenPlace::default();
    (place.path, place.r#move) = (Some(path), Some(open.first.0));
    place.time = [open.first.1, open.last.1];
    let ([a, b, c], [d, e, f]) = (open.low, open.high);
    place.r#box = [a, b, c, d, e, f];
    if let Some((file, line)) = work::place(&job.paths[path], open.first.0, &texts.folder) {
        (place.file, place.line) = (Some(file), Some(line));
    }
    place
}

/// A move that breaks a statement.
fn finding(job: &Job, texts: &mut ProgramTexts, kind: &str, number: usize, witness: &Witness) -> ReportedFinding {
    let path = &job.paths[number];
    let mut finding = ReportedFinding::default();
    finding.kind = kind.to_owned();
    finding.between = true;
    (finding.tool, finding.path, finding.r#move) = (Some(path.tool), Some(number), Some(witness.number));
    finding.setup = job.has_setups.then_some(path.setup);
    if let Some((file, line)) = work::place(path, witness.number, &texts.folder) {
        finding.text = texts.line(&file, line);
        (finding.file, finding.line) = (Some(file), Some(line));
    }
    finding.time = Some(witness.time);
    (finding.place, finding.depth) = (witness.place, witness.depth);
    finding
}

/// The same statement, if what was found on the lines refutes it.
fn with_lines(mut statement: Statement, findings: &[ReportedFinding]) -> Statement {
    // Collisions are with the workpiece as it is at that time, which may have more than the target.
    if statement.state != StatementState::Open || ["excess", "holder"].contains(&statement.about.as_str()) {
        return statement;
    }
    let is_distance = statement.measure == Measure::Distance;
    let own = findings
        .iter()
        .filter(|finding| finding.kind == statement.about && (is_distance || !finding.near));
    let Some(deepest) = own.max_by(|a, b| a.depth.total_cmp(&b.depth)) else {
        return statement;
    };
    statement.state = StatementState::Refuted;
    statement.reason = None;
    if !is_distance && statement.witness.is_some() && statement.enclosure[0] > statement.limit {
        return statement;
    }
    // On a line, something is where it may not be: beyond the limit, by how much is not said.
    match statement.measure {
        Measure::Distance if deepest.near => statement.enclosure = [0.0, statement.limit],
        Measure::Distance => statement.enclosure = [0.0; 2],
        _ => statement.enclosure[0] = statement.enclosure[0].max(statement.limit),
    }
    let mut witness = StatementWitness::default();
    (witness.path, witness.r#move) = (deepest.path, deepest.r#move);
    (witness.file, witness.line) = (deepest.file.clone(), deepest.line);
    (witness.text, witness.place) = (deepest.text.clone(), deepest.place);
    witness.time = deepest.time.unwrap_or_default();
    witness.body.clone_from(&deepest.body);
    statement.witness = Some(witness);
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
