//! `cargo xtask study`: the tool sampled in time, as the field does, against exact dexels: errors, and times on one
//! thread.

mod columns;
mod cutter;
mod errors;
mod hull;
mod pictures;
mod report;

use crate::bench::{Clock, on, shortest};
use crate::workspace;
use columns::{Bridge, Columns, Sampled};
use cutter::Cutter;
use errors::{Errors, Point};
use sweepsim::{Cut, Options, simulate};
use sweepsim_dexel::Dexels;
use sweepsim_formats::Job;

/// The paper's four examples: the fixture jobs, and what they are.
const EXAMPLES: [(&str, &str); 4] = [
    ("teapot-exterior", "Teapot, exterior: flat end"),
    ("teapot-interior", "Teapot, interior: ball end"),
    ("impeller", "Impeller: ball ends"),
    ("railing", "Railing: form tool"),
];
/// The coarsest spacing of placed tools, in mm; each of the next is half of the one before.
const COARSEST: f64 = 2.0;
/// A tool is placed so densely that no point of its axis, up to so many radii above the tip, moves farther than the
/// spacing.
const RADII: f64 = 4.0;

/// One way to sample an example.
struct Row {
    bridge: Bridge,
    /// mm.
    spacing: f64,
    /// Placed tools or hulls.
    places: usize,
    seconds: f64,
    errors: Errors,
    /// Material left, or removed too much if negative, in mm³.
    left: f64,
}

/// What was found about an example.
struct Study {
    name: &'static str,
    title: &'static str,
    moves: usize,
    cells: [usize; 2],
    /// Of the exact simulation.
    seconds: f64,
    /// Removed, in mm³.
    removed: f64,
    points: usize,
    rows: Vec<Row>,
}

impl Study {
    fn of(&self, bridge: Bridge) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(move |row| row.bridge == bridge)
    }
}

/// Studies the examples whose names contain `filter`; runs of the sampler that would take more than `limit` seconds are
/// left out beyond twice the time of the exact simulation. Writes the tables and pictures of the docs if all are
/// studied.
pub fn run(filter: Option<&str>, limit: f64) -> Result<(), String> {
    let chosen = EXAMPLES
        .iter()
        .filter(|(name, _)| filter.is_none_or(|filter| name.contains(filter)));
    let mut studies = Vec::new();
    for (name, title) in chosen {
        let study = example(name, title, limit)?;
        report::print(&study);
        studies.push(study);
    }
    if filter.is_none() {
        report::store(&studies)?;
        pictures::store(&studies)?;
    }
    Ok(())
}

/// Draws the pictures of the docs from the stored table.
pub fn draw() -> Result<(), String> {
    pictures::store(&report::stored()?)
}

fn example(name: &'static str, title: &'static str, limit: f64) -> Result<Study, String> {
    let file = workspace::fixtures().join("jobs").join(name).with_extension("ron");
    let job = Job::read(&file).map_err(|error| error.to_string())?;
    let stock = job.stock.dexels(&job.grid).map_err(|error| error.to_string())?;
    let exact = |stock: Dexels| {
        let cuts: Vec<Cut> = job
            .paths
            .iter()
            .map(|cut| Cut::new(&job.tools[&cut.tool], &cut.path))
            .collect();
        let done = simulate(stock, &cuts, &Options::new(job.tolerance), &());
        done.map(|done| done.remaining).map_err(|error| error.to_string())
    };
    let remaining = exact(stock.clone())?;
    let seconds = on(1, || shortest(|| exact(stock.clone()).map(drop)))??;
    let cutters = job.paths.iter().map(|cut| Cutter::of(&job.tools[&cut.tool]));
    let cutters: Vec<Cutter> = cutters.collect::<Result<_, _>>()?;
    let points = errors::points(&remaining);
    let mut study = Study {
        name,
        title,
        moves: job.paths.iter().map(|cut| cut.path.moves()).sum(),
        cells: job.grid.cells(),
        seconds,
        removed: stock.volume() - remaining.volume(),
        points: points.len(),
        rows: Vec::new(),
    };
    let sampler = Sampler {
        job: &job,
        cutters: &cutters,
        stock: &stock,
        points: &points,
        volume: remaining.volume(),
    };
    let bridges: &[Bridge] = if cutters.iter().all(Cutter::is_ball) {
        &[Bridge::Union, Bridge::Hulls]
    } else {
        &[Bridge::Union]
    };
    for &bridge in bridges {
        let mut spacing = COARSEST;
        loop {
            let row = sampler.row(bridge, spacing);
            // Well past the time of the exact simulation in any case.
            let enough = 2.0 * row.seconds > limit && row.seconds > 2.0 * study.seconds;
            study.rows.push(row);
            if enough {
                break;
            }
            spacing *= 0.5;
        }
    }
    Ok(study)
}

struct Sampler<'a> {
    job: &'a Job,
    cutters: &'a [Cutter],
    stock: &'a Dexels,
    points: &'a [Point],
    volume: f64,
}

impl Sampler<'_> {
    fn row(&self, bridge: Bridge, spacing: f64) -> Row {
        let cuts = || -> Vec<(&Cutter, Vec<Sampled>)> {
            let paths = self.job.paths.iter().zip(self.cutters);
            let sampled = |cutter: &Cutter, path| {
                Sampled::path(path, cutter, (RADII * cutter.radius).min(cutter.length), spacing)
            };
            paths
                .map(|(cut, cutter)| (cutter, sampled(cutter, &cut.path)))
                .collect()
        };
        let whole = Columns::of(self.stock);
        let (mut seconds, mut begun) = (f64::INFINITY, 0.0);
        let (mut places, mut left) = (0, 0.0);
        // Twice, unless it takes long.
        while begun < 1.0 {
            let mut columns = whole.clone();
            let start = Clock::start();
            places = cuts()
                .iter()
                .map(|(cutter, path)| columns.remove(cutter, path, bridge))
                .sum();
            let took = start.seconds();
            seconds = seconds.min(took);
            begun += took.max(0.5);
            left = columns.volume() - self.volume;
        }
        let cuts = cuts();
        let borrowed: Vec<(&Cutter, &[Sampled])> =
            cuts.iter().map(|(cutter, path)| (*cutter, path.as_slice())).collect();
        let errors = errors::errors(self.points, &borrowed, bridge);
        Row {
            bridge,
            spacing,
            places,
            seconds,
            errors,
            left,
        }
    }
}

#[cfg(test)]
mod tests;
