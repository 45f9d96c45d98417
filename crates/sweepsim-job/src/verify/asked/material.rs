//! What is asked of proofs about the stock as it is at each time.

use crate::session::Plan;
use sweepsim_check::{Measure, Question};
use sweepsim_formats::{Job, JobPath};
use sweepsim_proof::{Movers, regions};

/// Why a move must not cut, by the kind of finding if it does.
pub(in crate::verify) fn kept_from(path: &JobPath, number: usize) -> Option<&'static str> {
    let why = [
        ("rapid", &path.rapid),
        ("spindle", &path.spindle_stopped),
        ("feed", &path.no_feed),
    ];
    why.into_iter()
        .find_map(|(kind, flags)| flags.get(number).then_some(kind))
}

/// Whether the stock of a job was guessed.
pub(in crate::verify) fn is_guessed(plan: &Plan) -> bool {
    plan.guessed().iter().any(|guess| guess.about == "stock")
}

/// What must not touch the stock in a job, whose stock was not guessed.
pub(super) fn movers(job: &Job) -> Vec<Movers> {
    let must_not_cut = |path: &JobPath| (0..path.path.moves()).any(|number| kept_from(path, number).is_some());
    let rapids = job.paths.iter().any(must_not_cut).then_some(Movers::Rapids);
    let has_bodies = job.bodies.values().any(|own| !own.is_empty());
    rapids.into_iter().chain(has_bodies.then_some(Movers::Bodies)).collect()
}

/// The name of a statement.
pub(in crate::verify) fn about(movers: Movers) -> &'static str {
    match movers {
        Movers::Bodies => "collision",
        Movers::Rapids => "rapid",
    }
}

/// The question that asks it, if a checker can know the stock. `outlines`: of what moves along each path, that of what
/// cuts first.
pub(super) fn question(job: &Job, movers: Movers, limit: f64, outlines: &[&[usize]]) -> Option<Question> {
    regions(&job.stock, 0.0).filter(|regions| !regions.is_empty())?;
    let of = |own: &dyn Fn(&[usize]) -> Vec<usize>| {
        let all = outlines.iter().enumerate();
        all.flat_map(|(path, outlines)| own(outlines).into_iter().map(move |outline| (path, outline)))
            .collect::<Vec<_>>()
    };
    let cutters = of(&|outlines| outlines.iter().take(1).copied().collect());
    let (measure, own) = match movers {
        Movers::Bodies => {
            let bodies = of(&|outlines| outlines.iter().skip(1).copied().collect());
            (Measure::Material, bodies)
        }
        Movers::Rapids => (Measure::MaterialInRapids, cutters.clone()),
    };
    // Proofs name cutters by their paths.
    (cutters.len() == job.paths.len()).then(|| Question {
        about: about(movers).to_owned(),
        measure,
        limit,
        solid: 0,
        movers: own,
        cutters,
    })
}
