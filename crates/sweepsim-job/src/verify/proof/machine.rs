//! What is proven of the machine's bodies: they stay apart from each other, and from all that moves with the part and
//! the tool, at every time of every path.
//!
//! Tools, shanks and holders beside the workpiece and fixtures are the subject of other statements.

use super::pairs::{Judged, OnPath, Range, judged};
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
use sweepsim_machine::{Contact, Outcome};

/// The statement about the machines of a job, if any has bodies.
pub(super) fn apart(proof: &Proof, texts: &mut ProgramTexts) -> Result<Option<Proven>, JobError> {
    let job = proof.session.job;
    let clearance = |on: &OnMachine| on.course.machine().description().clearance;
    let with_bodies = || {
        let all = job.paths.iter().enumerate();
        let on = all.filter_map(|(number, path)| Some((number, path.on_machine.as_ref()?)));
        on.filter(|(_, on)| !on.bodies.is_empty())
    };
    let judging = &proof.session.request.judging;
    let range = Range {
        offset: judging.offset_range,
        length: judging.length_range,
    };
    let limit = with_bodies().map(|(_, on)| clearance(on)).reduce(f64::max);
    let mut machines = job.paths.iter().filter_map(|path| path.on_machine.as_ref());
    let first = machines.next().filter(|_| limit.is_some() || range.is_some());
    let Some(first) = first else {
        return Ok(None);
    };
    let mut all = Seen::new(limit.unwrap_or_default());
    if range.is_some() {
        all.narrow = narrow(&range, proof.session, first);
    }
    let mut paths = Vec::new();
    for (number, on) in with_bodies() {
        paths.extend(OnPath::new(job, number, &on.course, range));
    }
    for judged in judged(proof, &paths)? {
        all.add(job, texts, &judged);
    }
    Ok(Some(all.said()))
}

/// Axes that have not enough room to their limits.
fn narrow(range: &Range, session: Session, on: &OnMachine) -> Vec<String> {
    let spread = range.spread(&on.course);
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

    fn add(&mut self, job: &Job, texts: &mut ProgramTexts, judged: &Judged) {
        let [a, b] = &judged.names;
        let pair = (judged.path, [a.as_str(), b.as_str()]);
        match &judged.outcome {
            Outcome::Apart(least) => self.least = self.least.min(*least),
            Outcome::Contact(contact) if judged.is_sure => self.touch(job, texts, pair, contact),
            Outcome::Contact(contact) => self.open(job, texts, pair, (contact.number, contact.time)),
            Outcome::Open(piece, time) => self.open(job, texts, pair, (*piece, *time)),
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
