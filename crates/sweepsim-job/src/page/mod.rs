//! `report.html`: the report for people. The words are put together here, the page itself by `sweepsim-report`.

mod axes;
mod course;
mod deviation;
mod machine;
mod moments;
mod program;
mod proofs;
mod solids;
mod surface;
mod tables;
mod verdict;

use crate::base::JobError;
use crate::base::words::{self, clock};
use crate::request::Task;
use crate::session::Session;
use course::Courses;
use deviation::Deviated;
use program::Programs;
use sweepsim::verify::Target;
use sweepsim_dexel::{Dexels, Mesh, Source, TriDexels};
use sweepsim_formats::{Job, Measure, MoveSummary, Report, StatementState};
use sweepsim_report::{Area, DexelLayer, Fact, LayerEnd, Page, Picture, Plot, Scene, Solid, Table, measure};

/// What the page is made of.
pub(crate) struct PageSource<'a> {
    pub session: Session<'a>,
    pub report: &'a Report,
    pub dexels: &'a Dexels,
    /// The part along three axes with its surface, if the run made them.
    pub solid: Option<(&'a TriDexels, &'a Mesh)>,
    pub target: Option<&'a Target>,
    /// What each move does, if that is known.
    pub moves: &'a [MoveSummary],
    pub threads: usize,
    /// The duration of the run in seconds.
    pub total: f64,
    /// part.png.
    pub picture: Option<&'a [u8]>,
}

/// The page as HTML. `meanwhile` is done when the page asks nothing more of a cache.
pub(crate) fn html(source: &PageSource, meanwhile: impl FnOnce() + Send) -> Result<String, JobError> {
    let PageSource {
        session,
        report,
        dexels,
        ..
    } = *source;
    let (job, task) = (session.job, session.request.task);
    let programs = Programs::new(session);
    let deviated = || source.target.map(|target| Deviated::new(session, dexels, target));
    let others = || rayon::join(|| course::made(source, &programs), || solids::solids(job, task));
    let (deviated, (made, (solids, fewer))) = rayon::join(deviated, others);
    let made = made?;
    let mut page = Page::new(&report.job);
    let [nx, ny] = report.cells;
    page.lead = format!(
        "{}: {} on {} × {} dexels",
        match task {
            Task::Simulate => "What is left of the stock",
            Task::Verify => "Verification",
            Task::Sweep | Task::Section => "The swept volume",
        },
        words::counted(report.moves as u64, "move"),
        words::count(nx as u64),
        words::count(ny as u64),
    );
    page.verdict = verdict::verdict(report);
    let clock = |path: usize, number: usize, time: f64| made.clock(path, number, time);
    page.findings = verdict::findings(report, &programs, &clock);
    page.proofs = proofs::proofs(report, &programs, &clock);
    page.facts = facts(source);
    page.plots = plots(source, &made);
    page.axes = axes::plots(source, &made);
    page.histogram = deviated.as_ref().and_then(|found| found.histogram(report));
    page.tables = tables::setups(source);
    page.tables.push(tables::tools(source, &made));
    page.tables.extend(tables::faces(report));
    page.tables.extend(tables::axes(report));
    page.tables.push(phases(source));
    if !report.dexels.unresolved.is_empty() {
        page.tables.insert(0, unresolved(report));
    }
    page.notes.clone_from(&report.warnings);
    page.notes.extend(report.notes.iter().cloned());
    page.notes.extend(made.notes.iter().cloned());
    page.pictures.extend(source.picture.map(|png| Picture {
        caption: "The result".to_owned(),
        png: png.to_vec(),
    }));
    page.footer = format!(
        "sweepsim {}, method {}, {}, tolerance {} mm.",
        env!("CARGO_PKG_VERSION"),
        report.method,
        words::counted(source.threads as u64, "thread"),
        job.tolerance,
    );
    page.notes.extend(fewer);
    let scene = scene(source, deviated.as_ref(), made, programs, solids);
    if let Some(own) = scene.surface.as_ref().filter(|own| own.whole > own.triangles.len()) {
        let note = surface::fewer("the part's surface", own.whole, own.triangles.len(), own.farthest);
        page.notes.push(note);
    }
    page.scene = Some(scene);
    let (html, ()) = rayon::join(|| page.html(), meanwhile);
    Ok(html)
}

/// The part with what is known of its surface.
fn part(dexels: &Dexels, deviated: Option<&Deviated>, first_moves: &[u32]) -> DexelLayer {
    let grid = dexels.grid();
    let area = Area {
        min: grid.min(),
        max: grid.max(),
        cells: grid.cells(),
    };
    let mut number = 0;
    DexelLayer::new(area, |i, j, line| {
        for interval in dexels.intervals(i, j).iter() {
            let own = deviated.map_or([f32::NAN; 2], |found| found.ends[number]);
            number += 1;
            let end = |end: sweepsim_dexel::End, deviation| LayerEnd {
                z: end.z,
                normal: end.normal,
                deviation,
                maker: number_of(end.source, first_moves),
            };
            line.push([end(interval.lower, own[0]), end(interval.upper, own[1])]);
        }
    })
}

/// What made a piece of the surface: 0 for the stock, otherwise 1 plus the number of the move in the whole program.
fn number_of(source: Source, first_moves: &[u32]) -> u32 {
    match source {
        Source::Stock => 0,
        Source::Cut { path, segment, .. } => first_moves.get(path as usize).map_or(0, |first| first + segment + 1),
    }
}

fn scene(
    source: &PageSource,
    deviated: Option<&Deviated>,
    made: Courses,
    programs: Programs,
    solids: Vec<Solid>,
) -> Scene {
    let job = source.session.job;
    let mut scene = Scene::new(part(source.dexels, deviated, &made.first_moves));
    let frame = job.grid.frame();
    let [x, y, z] = frame.axes();
    scene.frame = [frame.origin(), x, y, z];
    scene.limits = source.target.map(Target::limits);
    scene.surface = source
        .solid
        .map(|(solid, mesh)| surface::surface(solid, mesh, source.target, &made.first_moves));
    scene.solids = solids;
    scene.tools = solids::tools(job);
    let numbers: Vec<u32> = job.tools.keys().copied().collect();
    let tool = |number| numbers.binary_search(&number).unwrap_or_default() as u16;
    let ends = made.first_moves.iter().skip(1).copied().chain([made.moves]);
    scene.paths = job
        .paths
        .iter()
        .zip(ends)
        .map(|(path, end)| (end, tool(path.tool)))
        .collect();
    scene.setups = setups_of(job, &made);
    if let Some((machine, bodies)) = machine::machine(source, &made) {
        scene.machine = Some(machine);
        scene.solids.extend(bodies);
    }
    scene.programs = programs.into_texts();
    scene.track = Some(made.track);
    scene.course = made.moments.lines;
    scene.surface_course = made.moments.surface;
    scene
}

/// The set-ups by name, each with the number of moves up to its end; none if the job does not list any.
fn setups_of(job: &Job, made: &Courses) -> Vec<(u32, String)> {
    let name = |number: usize| job.setup_name(number);
    let end = |number: usize| {
        let next = job.paths.iter().position(|path| path.setup > number);
        next.map_or(made.moves, |path| made.first_moves[path])
    };
    let setups = 0..job.setups.len();
    setups.filter_map(|number| Some((end(number), name(number)?))).collect()
}

fn facts(source: &PageSource) -> Vec<Fact> {
    let report = source.report;
    let volume = report.volume.unwrap_or_default();
    let mut facts = Vec::new();
    match report.volume_removed {
        Some(removed) => {
            let part = 100.0 * removed / (removed + volume).max(f64::MIN_POSITIVE);
            let share = format!("{part:.1} % of the stock");
            facts.push(Fact::new("Removed", format!("{} mm³", measure(removed)), share));
            facts.push(Fact::new("Left", format!("{} mm³", measure(volume)), ""));
        }
        None => facts.push(Fact::new("Swept", format!("{} mm³", measure(volume)), "")),
    }
    for (name, found) in [
        ("Deepest gouge found", report.gouge),
        ("Highest excess found", report.excess),
    ] {
        if let Some(found) = found {
            let max = if found.max < 1e-9 { 0.0 } else { found.max };
            let small = format!("beyond the limit on {} mm²", measure(found.area));
            facts.push(Fact::new(name, format!("{} mm", measure(max)), small));
        }
    }
    for statement in report.statements.iter().flatten() {
        let (state, [least, most]) = (statement.state, statement.enclosure);
        let least = || format!("at least {} mm", measure(least));
        let most = || format!("at most {} mm", measure(most));
        let (title, [proven, refuted]): (_, [&dyn Fn() -> String; 2]) =
            match (statement.about.as_str(), statement.measure) {
                ("excess", _) => ("Height of excess", [&most, &least]),
                ("fixture", Measure::Distance) => ("Distance from fixtures", [&least, &most]),
                ("fixture", _) => ("Depth in fixtures", [&most, &least]),
                ("holder", Measure::Distance) => ("Holder from target", [&least, &most]),
                ("holder", _) => ("Holder in target", [&most, &least]),
                ("collision", Measure::Distance) => ("Holder from stock", [&least, &most]),
                ("collision", _) => ("Holder in stock", [&most, &least]),
                ("machine", _) => ("Distance of machine bodies", [&least, &most]),
                ("rapid", _) => ("Rapids in stock", [&most, &least]),
                _ => ("Depth of gouges", [&most, &least]),
            };
        let (value, words) = match state {
            StatementState::Proven => (proven(), "proven everywhere"),
            StatementState::Refuted => (refuted(), "refuted"),
            _ => ("open".to_owned(), "not proven"),
        };
        let limit = format!("{words}; the limit is {} mm", measure(statement.limit));
        facts.push(Fact::new(title, value, limit));
    }
    if let Some(work) = report
        .work
        .filter(|work| work.untimed == 0 && work.total_seconds() > 0.0)
    {
        let rapid = format!("{} of it in rapids", clock(work.rapid_seconds));
        facts.push(Fact::new("Machine time", clock(work.total_seconds()), rapid));
    }
    let counts = &report.dexels;
    let audit = match counts.unresolved.len() as u64 {
        0 => "certified".to_owned(),
        open => format!("{} unresolved", words::count(open)),
    };
    let covered = format!(
        "{} with material, {} after a repair",
        words::count(counts.covered as u64),
        words::count(counts.repaired as u64)
    );
    facts.push(Fact::new("Dexels", audit, covered));
    let rapid = format!("{} of them rapid", words::count(report.rapid_moves as u64));
    facts.push(Fact::new("Moves", words::count(report.moves as u64), rapid));
    facts
}

/// Removal and engagement along the program.
fn plots(source: &PageSource, made: &Courses) -> Vec<Plot> {
    let mut plots = Vec::new();
    let timed = made.track.unit == "s";
    if !made.moments.removal.is_empty() {
        // mm³/s as cm³/min.
        let (name, unit, factor) = if timed {
            ("Removal rate", "cm³/min", 0.06)
        } else {
            ("Material removed", "mm³ per mm", 1.0)
        };
        plots.push(Plot {
            name: name.to_owned(),
            unit: unit.to_owned(),
            steps: made
                .moments
                .removal
                .iter()
                .map(|[from, to, rate]| [*from, *to, factor * rate])
                .collect(),
        });
    }
    let mut along = |name: &str, value: fn(&MoveSummary) -> f64| {
        let step = |row: &MoveSummary| {
            let clock = |time| made.clock(row.path, row.number, time);
            Some([clock(0.0)?, clock(1.0)?, value(row)])
        };
        plots.push(Plot {
            name: name.to_owned(),
            unit: "mm".to_owned(),
            steps: source.moves.iter().filter_map(step).collect(),
        });
    };
    if !source.moves.is_empty() {
        along("Axial depth", |row| row.depth);
        along("Radial width", |row| row.width);
    }
    plots
}

fn phases(source: &PageSource) -> Table {
    let seconds = source.report.seconds.iter();
    let mut rows: Vec<Vec<String>> = seconds
        .map(|(name, s)| vec![name.clone(), words::seconds(*s)])
        .collect();
    rows.push(vec!["in all".to_owned(), words::seconds(source.total)]);
    Table {
        title: "Computing time".to_owned(),
        rows,
        numbers: vec![1],
        ..Table::default()
    }
}

fn unresolved(report: &Report) -> Table {
    let rows = report.dexels.unresolved.iter();
    Table {
        title: "Unresolved dexels".to_owned(),
        note: "The intervals of these dexels are not certified.".to_owned(),
        columns: ["i", "j", "Why"].map(str::to_owned).into(),
        rows: rows
            .map(|dexel| vec![dexel.i.to_string(), dexel.j.to_string(), dexel.reason.clone()])
            .collect(),
        numbers: vec![0, 1],
        ..Table::default()
    }
}
