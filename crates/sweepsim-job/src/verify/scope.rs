//! What a verdict is about, and what it is not.

use super::asked::material::is_guessed;
use super::directions::has_walls;
use crate::base::JobError;
use crate::request::Input;
use crate::session::Session;
use crate::shards::{Purpose, TilingSet};
use crate::warnings::is_beside;
use std::collections::BTreeSet;
use sweepsim_dexel::Dexels;
use sweepsim_formats::{NotLookedAt, Scope, ScopeLines};

/// What was looked at on these tiles, and what was not: not what is left, if the first finding has ended the run.
pub(super) fn scope(session: Session, sets: &[TilingSet], stopped: bool) -> Scope {
    let mut scope = Scope::default();
    scope.extent = if is_proven(session) { "everywhere" } else { "lines" }.to_owned();
    let judged = sets.iter().filter(|set| matches!(set.purpose, Purpose::Judge { .. }));
    scope.lines = judged
        .zip(["z", "x", "y"])
        .map(|(set, along)| {
            let mut lines = ScopeLines::default();
            (lines.along, lines.spacing) = (along.to_owned(), set.grid.spacing());
            lines
        })
        .collect();
    scope.not_looked_at = not_looked_at(session, stopped);
    scope
}

/// Why nothing was judged, if no line meets material before the first move. Known: the stock along z.
pub(super) fn unmet(session: Session, along_z: &Dexels, sets: &[TilingSet]) -> Result<Option<String>, JobError> {
    let is_met = |stock: &Dexels| stock.iter().any(|(_, line)| !line.is_empty());
    if is_met(along_z) {
        return Ok(None);
    }
    let judged = sets.iter().filter(|set| matches!(set.purpose, Purpose::Judge { .. }));
    for set in judged.skip(1) {
        let stock = set.whole_stock(&session.job.stock);
        if is_met(&stock.map_err(|error| session.failure(format!("stock: {error}")))?) {
            return Ok(None);
        }
    }
    let why = match is_beside(session.job) {
        true => "none of the stock is on the grid",
        false => "no line of the dexels meets the stock",
    };
    Ok(Some(why.to_owned()))
}

/// Whether all that is looked at on the lines is looked at between them as well.
fn is_proven(session: Session) -> bool {
    session.request.judging.proof && !session.request.judging.first && !is_guessed(session.plan)
}

fn not_looked_at(session: Session, stopped: bool) -> Vec<NotLookedAt> {
    let job = session.job;
    let is_job = match session.request.input() {
        Input::File(file) => file.extension().is_some_and(|e| e.eq_ignore_ascii_case("ron")),
        Input::Job { .. } => true,
        Input::Program { .. } => false,
    };
    let needs = |of_job: &str, of_program: &str| if is_job { of_job } else { of_program }.to_owned();
    let mut all = Vec::new();
    if job.target.is_none() {
        let needs = needs("`target` in the job", "--target FILE");
        all.push(NotLookedAt::new("gouges and excess", needs, &["gouge", "excess"]));
    } else if stopped {
        all.push(NotLookedAt::new("excess", "a run without --first", &["excess"]));
    } else if session.request.judging.first && session.request.directions.is_none() && has_walls(job) {
        let needs = "a run without --first, or --directions xyz";
        all.push(NotLookedAt::new("excess on walls", needs, &["excess"]).partly(true));
    }
    let used: BTreeSet<u32> = job.paths.iter().map(|path| path.tool).collect();
    let is_bare = |number: &&u32| job.bodies.get(*number).is_none_or(Vec::is_empty);
    let bare: Vec<String> = used.iter().filter(is_bare).map(u32::to_string).collect();
    if !bare.is_empty() {
        let partly = bare.len() < used.len();
        let about = match &bare[..] {
            _ if !partly => "shanks and holders".to_owned(),
            [one] => format!("shank and holder of the tool {one}"),
            _ => format!("shanks and holders of the tools {}", bare.join(", ")),
        };
        let needs = needs(
            "`bodies` in the job",
            "a library with holders (--tools), or a job with `bodies`",
        );
        all.push(NotLookedAt::new(about, needs, &["collision"]).partly(partly));
    }
    if job.setups.iter().all(|setup| setup.fixtures.is_empty()) {
        let needs = needs("`fixtures` in the job", "a job with `fixtures`");
        all.push(NotLookedAt::new("fixtures", needs, &["fixture"]));
    }
    let mut machines = job.paths.iter().filter_map(|path| path.on_machine.as_ref());
    if machines.any(|on| on.bodies.is_empty()) {
        let needs = "`bodies` in the machine's file";
        all.push(NotLookedAt::new("bodies of the machine", needs, &["machine"]));
    }
    let judging = &session.request.judging;
    let is_ranged = judging.length_range > 0.0 || judging.offset_range != [0.0; 3];
    if is_ranged && job.paths.iter().all(|path| path.on_machine.is_none()) {
        let needs = "a machine with limits or bodies (--machine)";
        all.push(NotLookedAt::new(
            "other places of the part and lengths of tools",
            needs,
            &["machine"],
        ));
    }
    if is_guessed(session.plan) {
        let needs = needs("`stock` in the job", "--stock");
        let about = "rapids through the real stock: it was guessed";
        all.push(NotLookedAt::new(about, needs, &["rapid"]).partly(true));
    }
    all
}
