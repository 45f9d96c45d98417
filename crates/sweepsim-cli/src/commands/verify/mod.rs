//! `verify`: what is wrong with a program, and how far its result is from the target.

mod axes;
mod fixtures;
pub(super) mod targets;
mod work;

pub(super) use work::setups;

use super::task::sweeping;
use super::tri_surface::stock_aside;
use crate::arguments::{Directions, JudgeOptions, Output, RunOptions};
use crate::session::{Failure, JobSession, phase, words};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use sweepsim::motion::{Assembly, BodyKind, Tool};
use sweepsim::verify::{
    DeviationKind, Deviations, Finding, MoveState, OtherCourse, RapidCourses, Scene, Target, ToolPath, Verification,
    VerifyOptions, deviations, joined, verify,
};
use sweepsim::{Monitor, Statistics};
use sweepsim_dexel::Dexels;
use sweepsim_formats::{Job, JobPath, MoveSummary, PathSummary, Report, ReportedFinding, Verdict};

/// Longer programs are judged move by move only if that is asked for: each move takes a sweep of its own.
const PLOTTED: usize = 1000;

/// What remains of the stock.
pub(super) struct Verified {
    pub remaining: Dexels,
    pub statistics: Statistics,
    pub volume_removed: f64,
    /// The number of uncertified dexels along x and y.
    pub uncertified: usize,
    pub target: Option<Target>,
    /// What each move does, if asked for.
    pub moves: Vec<MoveSummary>,
}

/// Verifies the job of a session, and describes the findings in the report.
pub(super) fn verified(
    session: &JobSession,
    options: &RunOptions,
    judging: &JudgeOptions,
    report: &mut Report,
) -> Result<Verified, Failure> {
    let (job, progress) = (&session.job, &session.progress);
    progress.phase("stock");
    let stock = phase(report, "stock", || job.stock.dexels(&job.grid));
    let stock = stock.map_err(|error| session.failure(format!("stock: {error}")))?;
    let look = Look::new(session, stock.clone(), report)?;
    let larger = larger(job, judging, report);
    let assemblies = assemblies(session, [0.0; 2])?;
    let larger = match larger {
        [0.0, 0.0] => None,
        margins => Some(self::assemblies(session, margins)?),
    };
    let courses: Vec<Vec<OtherCourse>> = job.paths.iter().map(other_courses).collect();
    let states: Vec<Vec<MoveState>> = job.paths.iter().map(states).collect();
    let go_on = if judging.first {
        ControlFlow::Break(())
    } else {
        ControlFlow::Continue(())
    };
    let judge = |look: &Look, verifying: &VerifyOptions, report: &mut Report| {
        let states = states.iter().zip(&courses);
        let toolpaths = job.paths.iter().zip(states).map(|(path, (states, courses))| {
            let toolpath = ToolPath::new(&assemblies[&path.tool], &path.path);
            let toolpath = toolpath.with_states(states).with_other_courses(courses);
            let toolpath = match &larger {
                Some(larger) => toolpath.with_larger(&larger[&path.tool]),
                None => toolpath,
            };
            match &look.fixtures[path.setup] {
                Some(fixtures) => toolpath.with_fixtures(fixtures),
                None => toolpath,
            }
        });
        let program: Vec<ToolPath> = toolpaths.collect();
        let mut scene = Scene::new(look.stock.clone());
        if let Some(target) = &look.target {
            scene = scene.with_target(target);
        }
        let done = phase(report, "sweep", || {
            verify(scene, &program, verifying, &mut |_| go_on, progress as &dyn Monitor)
        });
        done.map_err(|error| session.failed(error))
    };
    progress.phase("verify");
    // The page plots what each move does, where that costs little.
    let plotted = session.outputs.wants(Output::Report) && job.moves() <= PLOTTED;
    let verifying = VerifyOptions::new(sweeping(job, options));
    let each = verifying.clone().each_move(judging.moves || plotted);
    let mut done = judge(&look, &each, report)?;
    let mut uncertified = 0;
    if options.directions == Some(Directions::Xyz) {
        let aside = phase(report, "stock", || stock_aside(job));
        let aside = aside.map_err(|error| session.failure(format!("--directions xyz: {error}")))?;
        for (stock, name) in aside.into_iter().zip(["along x", "along y"]) {
            let look = Look::new(session, stock, report)?;
            progress.phase(name);
            let more = judge(&look, &verifying, report)?;
            done.findings = joined([done.findings, more.findings]);
            done.undecided.extend(more.undecided);
            done.stopped |= more.stopped;
            uncertified += more.unresolved.len();
        }
        done.undecided.sort_unstable();
        done.undecided.dedup();
    }
    let Look { target, .. } = look;
    progress.phase("deviation");
    let found = target
        .as_ref()
        .filter(|_| !done.stopped)
        .map(|target| phase(report, "deviation", || deviations(&stock, &done.remaining, target)));
    describe(report, session, &done, found.as_ref());
    let moves = work::describe(report, session, &done);
    let statistics = {
        let mut statistics = Statistics::default();
        statistics.moves = job.moves();
        statistics.crossings = done.crossings;
        statistics.unresolved = done.unresolved;
        statistics
    };
    Ok(Verified {
        volume_removed: stock.volume() - done.remaining.volume(),
        remaining: done.remaining,
        statistics,
        uncertified,
        target,
        moves,
    })
}

/// What is judged along one direction.
struct Look {
    stock: Dexels,
    /// The fixtures of each set-up.
    fixtures: Vec<Option<Dexels>>,
    target: Option<Target>,
}

impl Look {
    fn new(session: &JobSession, stock: Dexels, report: &mut Report) -> Result<Self, Failure> {
        let grid = *stock.grid();
        let fixtures = phase(report, "stock", || fixtures::of_setups(session, &grid))?;
        session.progress.phase("target");
        let target = phase(report, "target", || targets::of_job(&session.job, &grid))
            .map_err(|error| session.failure(format!("target: {error}")))?;
        Ok(Self {
            stock,
            fixtures,
            target,
        })
    }
}

/// The cutters, each with its bodies, all round larger by these margins.
fn assemblies(session: &JobSession, [cutter, body]: [f64; 2]) -> Result<BTreeMap<u32, Assembly>, Failure> {
    let job = &session.job;
    let mut all = BTreeMap::new();
    for (number, tool) in &job.tools {
        let taken = |solid: &Tool, larger: f64, name: &str| {
            let taken = solid.offset(larger);
            taken.map_err(|error| session.failure(format!("{name} of tool {number}: {error}")))
        };
        let mut whole = Assembly::new(taken(tool, cutter, "the cutter")?);
        for own in job.bodies.get(number).into_iter().flatten() {
            whole = whole.with(own.kind, taken(&own.solid, body, "a body")?);
        }
        all.insert(*number, whole);
    }
    Ok(all)
}

/// The other courses of a path's rapids.
fn other_courses(path: &JobPath) -> Vec<OtherCourse> {
    let courses = path.other_courses.iter();
    courses
        .map(|course| OtherCourse::new(course.number, course.path.clone(), course.times.clone()))
        .collect()
}

/// By how much cutters and bodies are taken larger, and why, in the notes.
fn larger(job: &Job, judging: &JudgeOptions, report: &mut Report) -> [f64; 2] {
    let clearance = judging.clearance.unwrap_or(job.clearance);
    let [dx, dy] = job.grid.spacing();
    let between = if judging.sure { 0.5 * dx.hypot(dy) } else { 0.0 };
    let reasons = [
        (clearance, "for their clearance"),
        (between, "for what may hide between dexels"),
    ];
    let reasons = reasons.iter().filter(|(by, _)| *by > 0.0);
    let reasons: Vec<String> = reasons
        .map(|(by, why)| format!("{} mm {why}", words::length(*by)))
        .collect();
    if !reasons.is_empty() && !job.bodies.is_empty() {
        report.notes.push(format!(
            "shanks and holders are taken larger all round, by {}: findings say what touches and what only comes near",
            reasons.join(" and ")
        ));
    }
    if between > 0.0 {
        let between = words::length(between);
        report.notes.push(format!(
            "so are cutters in rapids and beside fixtures, by {between} mm; gouges are those on the dexels"
        ));
    }
    [between, clearance + between]
}

fn states(path: &JobPath) -> Vec<MoveState> {
    let is = |list: &[bool], number: usize| list.get(number).copied().unwrap_or_default();
    let state = |(number, rapid): (usize, &bool)| {
        let state = if *rapid { MoveState::RAPID } else { MoveState::FEED };
        state
            .with_spindle_stopped(is(&path.spindle_stopped, number))
            .with_no_feed(is(&path.no_feed, number))
    };
    path.rapid.iter().enumerate().map(state).collect()
}

fn describe(report: &mut Report, session: &JobSession, done: &Verification, found: Option<&Deviations>) {
    let job = &session.job;
    let mut texts = ProgramTexts::new(session);
    let mut findings: Vec<ReportedFinding> = done
        .findings
        .iter()
        .map(|finding| reported(finding, job, &mut texts))
        .collect();
    findings.extend(axes::findings(job, report, &mut texts));
    // A stable sort: of one move, what happens first comes first.
    let when = |finding: &ReportedFinding| (finding.path, finding.r#move);
    findings.sort_by(|a, b| {
        let time = |finding: &ReportedFinding| finding.time.unwrap_or_default();
        when(a).cmp(&when(b)).then(time(a).total_cmp(&time(b)))
    });
    if done.stopped {
        // The first was asked for.
        findings.truncate(1);
    }
    let paths = job.paths.iter().zip(&done.paths).map(|(path, removal)| {
        let mut summary = PathSummary::default();
        (summary.tool, summary.moves, summary.removed) = (path.tool, path.path.moves(), removal.volume);
        summary.setup = job.has_setups.then_some(path.setup);
        summary
    });
    report.paths = Some(paths.collect());
    if let Some(found) = found {
        report.gouge = Some(targets::summed(&found.gouge));
        report.excess = Some(targets::summed(&found.excess));
        report.regions = Some(targets::regions(found, job.limits.as_ref()));
        let excess = found
            .regions
            .iter()
            .filter(|region| region.kind == DeviationKind::Excess);
        findings.extend(excess.map(|region| {
            let mut finding = ReportedFinding::default();
            finding.kind = "excess".to_owned();
            (finding.place, finding.depth, finding.volume) = (region.place, region.depth, region.volume);
            finding.region = targets::name(region, job.limits.as_ref());
            finding
        }));
        if found.beyond_stock > 0.0 {
            report.notes.push(format!(
                "{:.3} mm³ of the target are outside the stock: they were missing before the first cut",
                found.beyond_stock
            ));
        }
        if job.limits.is_none() {
            report.notes.push(format!(
                "the job has no limits: gouges and excess of more than {} mm count",
                targets::LIMIT
            ));
        }
    } else if job.target.is_none() {
        report
            .notes
            .push("the job has no target: gouges and excess were not looked for".to_owned());
    }
    for (number, moved) in &done.undecided {
        report.notes.push(format!(
            "path {number}, move {moved}: a body follows its cutter so closely that it is not known whether it touches the workpiece"
        ));
    }
    let missed = found.is_some_and(|found| !found.regions.is_empty());
    report.verdict = Some(if findings.is_empty() && !missed {
        Verdict::Pass
    } else {
        Verdict::Fail
    });
    report.findings = Some(findings);
}

fn reported(finding: &Finding, job: &Job, texts: &mut ProgramTexts) -> ReportedFinding {
    let path = &job.paths[finding.path];
    let bodies = job.bodies.get(&path.tool);
    let body = finding
        .body
        .and_then(|number| bodies?.get(number))
        .map(|body| match body.kind {
            BodyKind::Shank => "shank",
            BodyKind::Holder => "holder",
            _ => "body",
        });
    let mut reported = ReportedFinding::default();
    reported.kind = finding.kind.name().to_owned();
    reported.tool = Some(path.tool);
    reported.body = body.map(str::to_owned);
    reported.path = Some(finding.path);
    reported.setup = job.has_setups.then_some(path.setup);
    reported.r#move = Some(finding.number);
    if let Some((file, line)) = work::place(path, finding.number, &texts.folder) {
        reported.text = texts.line(&file, line);
        (reported.file, reported.line) = (Some(file), Some(line));
    }
    reported.near = finding.near;
    reported.courses = finding.courses.map(|courses| {
        match courses {
            RapidCourses::Own => "straight",
            RapidCourses::Other => "dog-leg",
            _ => "both",
        }
        .to_owned()
    });
    reported.time = Some(finding.time);
    (reported.place, reported.depth, reported.volume) = (finding.place, finding.depth, finding.volume);
    reported
}

/// The lines of the programs of a job, read on demand.
struct ProgramTexts {
    folder: PathBuf,
    files: BTreeMap<String, Vec<String>>,
}

impl ProgramTexts {
    fn new(session: &JobSession) -> Self {
        Self {
            folder: session.file().parent().unwrap_or(Path::new("")).to_owned(),
            files: BTreeMap::new(),
        }
    }

    /// A line of a file, without the space around it.
    fn line(&mut self, file: &str, line: usize) -> Option<String> {
        let lines = self.files.entry(file.to_owned()).or_insert_with(|| {
            let text = std::fs::read(self.folder.join(file)).unwrap_or_default();
            String::from_utf8_lossy(&text)
                .lines()
                .map(|line| line.trim().to_owned())
                .collect()
        });
        lines.get(line.checked_sub(1)?).cloned()
    }
}
