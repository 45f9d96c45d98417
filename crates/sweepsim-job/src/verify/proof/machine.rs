//! What is proven of the machine's bodies: they stay apart from each other, and from all that moves with the part and
//! the tool, at every time of every path.
//!
//! Tools, shanks and holders beside the workpiece and fixtures are the subject of other statements. The stock is looked
//! at as it was before the first cut.

use super::crowd::Crowd;
use super::{LISTED, Proof, Proven};
use crate::base::{JobError, words};
use crate::session::Session;
use crate::verify::axes;
use crate::verify::texts::ProgramTexts;
use crate::verify::work;
use std::collections::BTreeSet;
use sweepsim_formats::{
    Job, JobPath, Measure, OnMachine, OpenPlace, ReportedFinding, Statement, StatementState, StatementWitness,
};
use sweepsim_machine::{Contact, Course, Limits, Outcome, Values, contacts};

/// The most distances that are computed for a pair of bodies on a path: so many, and so many for each move.
const TESTS: usize = 100_000;
const TESTS_OF_MOVE: usize = 200;

/// The statement about the machines of a job, if any has bodies.
pub(super) fn apart(proof: &Proof, texts: &mut ProgramTexts) -> Result<Option<Proven>, JobError> {
    let job = proof.session.job;
    let clearance = |on: &OnMachine| on.course.machine().description().clearance;
    let with_bodies = || {
        job.paths.iter().enumerate().filter_map(|(number, path)| {
            let on = path.on_machine.as_ref().filter(|on| !on.bodies.is_empty())?;
            Some((number, path, on))
        })
    };
    let judging = &proof.session.request.judging;
    let range = Range {
        offset: judging.offset_range,
        length: judging.length_range,
    };
    let limit = with_bodies().map(|(.., on)| clearance(on)).reduce(f64::max);
    let mut machines = job.paths.iter().filter_map(|path| path.on_machine.as_ref());
    let first = machines.next().filter(|_| limit.is_some() || range.is_some());
    let Some(first) = first else {
        return Ok(None);
    };
    let mut all = Seen::new(limit.unwrap_or_default());
    if range.is_some() {
        all.narrow = range.narrow(proof.session, first);
    }
    for (number, path, on) in with_bodies() {
        if proof.session.monitor.cancelled() {
            return Err(JobError::Cancelled);
        }
        let crowd = Crowd::new(job, path, on);
        let mut limits = Limits::new(clearance(on));
        limits.tests = TESTS + TESTS_OF_MOVE * on.course.moves();
        limits.slack = range.spread(on);
        let beside = |pair: &(usize, usize)| crowd.beside(pair.1, range.offset, range.length);
        let mut found = Vec::with_capacity(crowd.pairs.len());
        for own in crowd.pairs.chunk_by(|a, b| beside(a) == beside(b)) {
            limits.clearance = clearance(on) + own.first().map_or(0.0, beside);
            let linkage = on.course.chain().linkage();
            found.extend(contacts(linkage, &crowd.bodies, own, &on.course, &limits));
        }
        for (&(a, b), outcome) in crowd.pairs.iter().zip(found) {
            let names = [a, b].map(|body| crowd.bodies[body].name.as_str());
            let is_known = ![a, b].iter().any(|body| crowd.loose.contains(body));
            // With a range, bodies may be too near at some place of the part only, if they don't touch at this one.
            let touches = matches!(&outcome, Outcome::Contact(contact) if contact.distance == 0.0);
            let is_sure = is_known && (touches || !range.is_some());
            all.add(job, texts, (number, names), is_sure, &outcome);
        }
    }
    Ok(Some(all.said()))
}

/// How far the part may be from its place, and how much longer or shorter a tool.
struct Range {
    offset: [f64; 3],
    length: f64,
}

impl Range {
    fn is_some(&self) -> bool {
        self.length > 0.0 || self.offset.iter().any(|way| *way > 0.0)
    }

    /// How far joints may be from their course.
    fn spread(&self, on: &OnMachine) -> Values {
        on.course.chain().spread(on.course.machine(), self.offset, self.length)
    }

    /// Axes that have not enough room to their limits.
    fn narrow(&self, session: Session, on: &OnMachine) -> Vec<String> {
        let spread = self.spread(on);
        let needed = |letter: char| {
            let joint = on.course.chain().letters().iter().position(|own| *own == letter);
            joint.map_or(0.0, |joint| spread[joint])
        };
        let (axes, _) = axes::travel(session);
        let narrow = axes.iter().filter_map(|axis| {
            let room = axis.room.filter(|room| *room < needed(axis.letter))?;
            let place = axis.file.as_ref().zip(axis.line);
            let place = place.map_or_else(String::new, |(file, line)| format!(" at {file}:{line}"));
            let [room, needed] = [room, needed(axis.letter)].map(words::length);
            Some(format!(
                "{} has {room} mm to its limit{place}, and may need {needed} mm",
                axis.letter
            ))
        });
        narrow.collect()
    }
}

/// What was seen of all pairs on all paths.
struct Seen {
    statement: Statement,
    least: f64,
    nearest: f64,
    unsure: BTreeSet<String>,
    /// What else keeps it from holding.
    narrow: Vec<String>,
    findings: Vec<ReportedFinding>,
}

impl Seen {
    fn new(limit: f64) -> Self {
        let mut statement = Statement::new("machine", limit);
        statement.measure = Measure::Distance;
        Self {
            statement,
            least: f64::INFINITY,
            nearest: f64::INFINITY,
            unsure: BTreeSet::new(),
            narrow: Vec::new(),
            findings: Vec::new(),
        }
    }

    fn add(
        &mut self,
        job: &Job,
        texts: &mut ProgramTexts,
        (number, names): (usize, [&str; 2]),
        is_sure: bool,
        outcome: &Outcome,
    ) {
        match outcome {
            Outcome::Apart(least) => self.least = self.least.min(*least),
            Outcome::Contact(contact) if is_sure => self.touch(job, texts, (number, names), contact),
            Outcome::Contact(contact) => self.open(job, texts, (number, names), (contact.number, contact.time)),
            Outcome::Open(piece, time) => self.open(job, texts, (number, names), (*piece, *time)),
        }
    }

    fn touch(&mut self, job: &Job, texts: &mut ProgramTexts, (number, names): (usize, [&str; 2]), contact: &Contact) {
        let path = &job.paths[number];
        let Some(on) = &path.on_machine else { return };
        let (moved, time, is_other) = on.course.place(contact.number, contact.time);
        let mut finding = ReportedFinding::default();
        finding.kind = "machine".to_owned();
        (finding.tool, finding.path, finding.r#move) = (Some(path.tool), Some(number), Some(moved));
        finding.setup = job.has_setups.then_some(path.setup);
        if let Some((file, line)) = work::place(path, moved, &texts.folder) {
            finding.text = texts.line(&file, line);
            (finding.file, finding.line) = (Some(file), Some(line));
        }
        finding.near = contact.distance > 0.0;
        finding.courses = is_other.then(|| "dog-leg".to_owned());
        finding.time = Some(time);
        finding.depth = contact.depth;
        finding.place = tip(path, moved, time);
        let [a, b] = names;
        finding.bodies = names.map(str::to_owned).into();
        let how = match (contact.distance > 0.0, contact.depth > 0.0) {
            (true, _) => format!(" within {} mm", words::measure(contact.distance)),
            (false, true) => format!(", at most {} mm deep in this move", words::measure(contact.depth)),
            (false, false) => String::new(),
        };
        let verb = if contact.distance > 0.0 { "comes near" } else { "meets" };
        finding.detail = Some(format!("{a} {verb} {b}{how}"));
        let mut witness = StatementWitness::default();
        (witness.path, witness.r#move) = (finding.path, finding.r#move);
        (witness.file, witness.line, witness.text) = (finding.file.clone(), finding.line, finding.text.clone());
        (witness.time, witness.place) = (time, finding.place);
        witness.body = Some(a.to_owned());
        if contact.distance < self.nearest {
            self.nearest = contact.distance;
            self.statement.witness = Some(witness);
        }
        self.findings.push(finding);
    }

    fn open(
        &mut self,
        job: &Job,
        texts: &ProgramTexts,
        (number, names): (usize, [&str; 2]),
        (piece, time): (usize, f64),
    ) {
        self.statement.open_count += 1;
        self.unsure.insert(names.join(" and "));
        let path = &job.paths[number];
        let Some(on) = path.on_machine.as_ref().filter(|_| self.statement.open.len() < LISTED) else {
            return;
        };
        let (moved, time, _) = on.course.place(piece, time);
        let mut place = OpenPlace::default();
        (place.path, place.r#move, place.time) = (Some(number), Some(moved), [time, 1.0]);
        let [x, y, z] = tip(path, moved, time);
        place.r#box = [x, y, z, x, y, z];
        (place.file, place.line) = work::place(path, moved, &texts.folder).unzip();
        self.statement.open.push(place);
    }

    fn said(self) -> Proven {
        let Self {
            mut statement,
            least,
            nearest,
            unsure,
            narrow,
            findings,
        } = self;
        let least = if least.is_finite() { least } else { f64::MAX };
        (statement.state, statement.enclosure) = match (findings.is_empty(), statement.open_count) {
            (false, _) => (StatementState::Refuted, [0.0, nearest]),
            (true, 0) if narrow.is_empty() => (StatementState::Proven, [least, f64::MAX]),
            (true, _) => (StatementState::Open, [0.0, f64::MAX]),
        };
        if statement.state == StatementState::Open {
            let pairs: Vec<String> = unsure.into_iter().collect();
            let pairs = (!pairs.is_empty()).then(|| format!("not known of {}", pairs.join(", ")));
            let all: Vec<String> = pairs.into_iter().chain(narrow).collect();
            statement.reason = Some(all.join("; "));
        }
        Proven::of(statement, findings, Vec::new())
    }
}

/// Where the tip is then, in the coordinates of the part.
fn tip(path: &JobPath, number: usize, time: f64) -> [f64; 3] {
    let moves = path.path.moves();
    let end = path.path.pose((number + 1).min(moves)).tip();
    let start = path.path.pose(number.min(moves)).tip();
    // On arcs this is near.
    [0, 1, 2].map(|k| start[k] + time * (end[k] - start[k]))
}
