//! Findings as they are reported: with their lines, sorted, and with the verdict.

use super::proof::Certified;
use super::texts::{ProgramTexts, name_of};
use super::{axes, proof, targets, work};
use crate::base::{JobError, words};
use crate::session::{Session, phase};
use sweepsim::verify::{DeviationKind, Deviations, Finding, Judgement, RapidCourses};
use sweepsim_dexel::DistanceTo;
use sweepsim_formats::{Job, PathSummary, Report, ReportedFinding, Verdict};

/// Less of the target is not said to be outside of the stock, in cubic millimetres.
const BEYOND: f64 = 5e-4;

pub(super) fn describe(
    report: &mut Report,
    session: Session,
    done: &Judgement,
    found: Option<&Deviations>,
    distance: Option<&DistanceTo>,
) -> Result<Option<Certified>, JobError> {
    let job = session.job;
    let mut texts = ProgramTexts::new(session);
    let mut findings: Vec<ReportedFinding> = done
        .findings
        .iter()
        .map(|finding| reported(finding, job, &mut texts))
        .collect();
    findings.extend(axes::findings(job, report, &mut texts));
    let (mut statements, mut certified) = (Vec::new(), None);
    if session.request.judging.proof && !done.stopped {
        let regions = found.iter().flat_map(|found| &found.regions);
        let known = proof::Known {
            findings: &findings,
            is_left: { regions }.any(|region| region.kind == DeviationKind::Excess),
            gouge: found.map_or(0.0, |found| found.gouge.max),
            excess: found.map_or(0.0, |found| found.excess.max),
            distance,
        };
        let new;
        (statements, new, certified) = phase(report, "proof", || proof::statements(session, &mut texts, known))?;
        findings.extend(new);
        report.statements = Some(statements.clone());
    }
    let is_placed_well = job.paths.iter().any(|path| path.on_machine.is_some())
        && findings
            .iter()
            .all(|own| !["machine", "limit"].contains(&own.kind.as_str()));
    if session.request.judging.place && !done.stopped && !is_placed_well {
        let (place, note) = phase(report, "place", || proof::propose(session))?;
        report.free_place = place;
        report.notes.extend(note);
    }
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
        let mut gouge = targets::summed(&found.gouge);
        // A move that gouges is in the figure whatever direction saw it.
        let deepest = findings.iter().filter(|finding| finding.kind == "gouge");
        gouge.max = deepest.map(|finding| finding.depth).fold(gouge.max, f64::max);
        report.gouge = Some(gouge);
        report.excess = Some(targets::summed(&found.excess));
        report.regions = Some(targets::regions(found, job.limits.as_ref()));
        let excess: Vec<_> = found
            .regions
            .iter()
            .filter(|region| region.kind == DeviationKind::Excess)
            .collect();
        // What the lines have seen is known better from them.
        findings.retain(|finding| finding.kind != "excess" || excess.is_empty());
        findings.extend(excess.into_iter().map(|region| {
            let mut finding = ReportedFinding::default();
            finding.kind = "excess".to_owned();
            (finding.place, finding.depth, finding.volume) = (region.place, region.depth, region.volume);
            finding.region = targets::name(region, job.limits.as_ref());
            finding
        }));
        // Less is rounding of the lines' ends.
        if found.beyond_stock >= BEYOND {
            report.notes.push(format!(
                "{:.3} mm³ of the target are outside the stock: they were missing before the first cut",
                found.beyond_stock
            ));
        }
        let corners = job
            .target
            .iter()
            .flat_map(|target| target.mesh.triangles.iter().flatten());
        let limit = job.limits.as_ref().map_or(targets::LIMIT, |limits| limits.gouge);
        if let Some(far) = targets::beyond(corners.copied(), &job.grid, limit) {
            report.notes.push(format!(
                "the target reaches {} mm beyond the grid: what is missing there is not seen",
                words::length(far)
            ));
        }
        if job.limits.is_none() {
            report.notes.push(format!(
                "the job has no limits: gouges and excess of more than {} mm count",
                targets::LIMIT
            ));
        }
    }
    for (number, moved) in &done.undecided {
        report.notes.push(format!(
            "path {number}, move {moved}: a body follows its cutter so closely that it is not known whether it touches the workpiece"
        ));
    }
    let missed = found.is_some_and(|found| !found.regions.is_empty());
    let on_lines = if findings.is_empty() && !missed {
        Verdict::Pass
    } else {
        Verdict::Fail
    };
    report.verdict = Some(proof::verdict(on_lines, &statements));
    report.findings = Some(findings);
    Ok(certified)
}

fn reported(finding: &Finding, job: &Job, texts: &mut ProgramTexts) -> ReportedFinding {
    let path = &job.paths[finding.path];
    let bodies = job.bodies.get(&path.tool);
    let body = finding
        .body
        .and_then(|number| bodies?.get(number))
        .map(|body| name_of(body.kind));
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
