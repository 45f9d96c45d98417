//! How time and memory grow with moves, grid and threads: the plots of docs/performance.md.

mod proofs;

use super::clock::load;
use super::{Clock, memory, on, programs, raster, shortest_by, table1, three_axis};
use crate::plot::{Axis, Panel, Series, figure};
use crate::workspace;
use std::fmt::Write as _;
use std::fs;
use sweepsim::{Cut, Method, Options, simulate};
use sweepsim_dexel::Stock;
use sweepsim_formats::Job;
use sweepsim_motion::Tool;

const MOVES: [usize; 5] = [1_000, 3_000, 10_000, 30_000, 100_000];
/// Where the tool turns in every move, a tenth of them.
const TURNING: [usize; 3] = [1_000, 3_000, 10_000];
const CELLS: usize = 300;
const GRIDS: [usize; 5] = [125, 250, 500, 1000, 2000];
const THREADS: [usize; 4] = [1, 2, 3, 4];

/// A curve of the figures, and a line of the table for each point.
struct Curve {
    figure: &'static str,
    name: String,
    points: Vec<[f64; 2]>,
}

impl Curve {
    fn print(&self) {
        for [x, y] in &self.points {
            println!("{:<12} {:<32} {x:>9} {y:>10.4}", self.figure, self.name);
        }
    }
}

/// A piece of work that any thread may do.
type Work<'a> = &'a (dyn Fn() -> Result<(), String> + Sync);

fn text(error: impl std::fmt::Display) -> String {
    error.to_string()
}

/// Removes the raster from a block once, on one thread; seconds of processor time.
fn cut(tool: &Tool, moves: usize, lean: f64, cells: usize) -> Result<f64, String> {
    let half = 0.5 * raster::SIDE;
    let block = Stock::Block {
        min: [-half, -half, -10.0],
        max: [half, half, 2.0],
    };
    let (path, stock) = (
        raster::program(moves, lean)?,
        block.dexels(&raster::grid(cells)?).map_err(text)?,
    );
    on(1, || {
        shortest_by(Clock::seconds, || {
            simulate(stock.clone(), &[Cut::new(tool, &path)], &Options::new(1e-6), &())
                .map(drop)
                .map_err(text)
        })
    })?
}

fn by_moves() -> Result<Vec<Curve>, String> {
    let (flat, ball) = (
        Tool::flat(3.0, 30.0).map_err(text)?,
        Tool::ball(3.0, 30.0).map_err(text)?,
    );
    let curve = |name: &str, tool: &Tool, moves: &[usize], lean: f64| -> Result<Curve, String> {
        let point = |&n: &usize| cut(tool, n, lean, CELLS).map(|seconds| [n as f64, seconds]);
        let points = moves.iter().map(point).collect::<Result<_, _>>()?;
        Ok(Curve {
            figure: "moves",
            name: name.into(),
            points,
        })
    };
    Ok(vec![
        curve("3 axes, flat end", &flat, &MOVES, 0.0)?,
        curve("3 axes, ball end", &ball, &MOVES, 0.0)?,
        curve("5 axes, flat end", &flat, &TURNING, 0.5)?,
        curve("5 axes, ball end", &ball, &TURNING, 0.5)?,
    ])
}

fn by_grid() -> Result<Vec<Curve>, String> {
    let mut curves = Vec::new();
    for tool in ["flat", "ball"] {
        let seconds = |cells| {
            on(1, || {
                shortest_by(Clock::seconds, || three_axis::cut(tool, cells).map(drop))
            })?
        };
        let points = GRIDS
            .iter()
            .map(|&cells| Ok([cells as f64, seconds(cells)?]))
            .collect::<Result<_, String>>()?;
        curves.push(Curve {
            figure: "grid",
            name: format!("3,049 moves, 3 axes, {tool} end"),
            points,
        });
    }
    for (which, name) in ["Table 1, ball end, Sweep1", "Table 1, ball end, Sweep2"]
        .into_iter()
        .enumerate()
    {
        let ball = table1::cutter("ball")?;
        let seconds = |cells| -> Result<f64, String> {
            let entry = ball.entry(which, cells)?;
            on(1, || shortest_by(Clock::seconds, || entry.run(Method::default())))?
        };
        let points = GRIDS
            .iter()
            .map(|&cells| Ok([cells as f64, seconds(cells)?]))
            .collect::<Result<_, String>>()?;
        curves.push(Curve {
            figure: "grid",
            name: name.into(),
            points,
        });
    }
    Ok(curves)
}

fn by_threads() -> Result<Vec<Curve>, String> {
    let job = Job::read(&workspace::fixtures().join("jobs/impeller.ron")).map_err(text)?;
    let works: [(&str, Work); 2] = [
        ("impeller", &|| programs::once(&job).map(drop)),
        ("3,049 moves, 3 axes, ball end", &|| {
            three_axis::cut("ball", 1000).map(drop)
        }),
    ];
    let mut curves = Vec::new();
    for (name, work) in works {
        let mut best = [f64::INFINITY; THREADS.len()];
        // Several rounds: a disturbance meets all numbers of threads.
        for _ in 0..3 {
            for (threads, best) in THREADS.into_iter().zip(&mut best) {
                *best = best.min(on(threads, || shortest_by(Clock::wall, work))??);
            }
        }
        let points = THREADS
            .into_iter()
            .zip(best)
            .map(|(threads, seconds)| [threads as f64, best[0] / seconds])
            .collect();
        curves.push(Curve {
            figure: "threads",
            name: name.into(),
            points,
        });
    }
    Ok(curves)
}

fn in_mib(figure: &'static str, name: &str, runs: &[memory::Run]) -> Vec<Curve> {
    let points = runs.iter().map(|run| [run.size as f64, run.mib]).collect();
    vec![Curve {
        figure,
        name: name.into(),
        points,
    }]
}

fn panel(curves: &[Curve], name: &str, title: &str, labels: [&str; 2], logarithmic: bool) -> Panel {
    let axis = |k: usize| Axis {
        label: labels[k].into(),
        logarithmic,
        range: None,
    };
    let chosen = curves.iter().filter(|curve| curve.figure == name).enumerate();
    let series = chosen.map(|(colour, curve)| Series {
        name: curve.name.clone(),
        colour: colour % 5,
        dashed: false,
        joined: true,
        points: curve.points.clone(),
    });
    Panel {
        title: title.into(),
        axes: [axis(0), axis(1)],
        series: series.collect(),
    }
}

/// The curves of the table that is stored.
fn stored(table: &str) -> Vec<Curve> {
    let mut curves: Vec<Curve> = Vec::new();
    for line in table.lines().skip(1) {
        let words: Vec<&str> = line.split(';').collect();
        let [figure, name, x, y] = words[..] else { continue };
        let (Ok(x), Ok(y)) = (x.parse(), y.parse()) else {
            continue;
        };
        let known = FIGURES.iter().find(|(known, _)| *known == figure);
        let Some((figure, _)) = known else { continue };
        match curves
            .iter_mut()
            .find(|curve| curve.figure == *figure && curve.name == name)
        {
            Some(curve) => curve.points.push([x, y]),
            None => curves.push(Curve {
                figure,
                name: name.into(),
                points: vec![[x, y]],
            }),
        }
    }
    curves
}

/// Measures the curves of a figure.
type Measure = fn() -> Result<Vec<Curve>, String>;

/// The figures, and what measures them.
const FIGURES: [(&str, Measure); 7] = [
    ("grid", by_grid),
    ("moves", by_moves),
    ("threads", by_threads),
    ("memory", || {
        memory::by_moves(usize::MAX).map(|runs| in_mib("memory", "100 × 100 dexels", &runs))
    }),
    ("memory-grid", || {
        memory::by_grid().map(|runs| in_mib("memory-grid", "1,000 moves", &runs))
    }),
    ("proofs", proofs::by_moves),
    ("proofs-triangles", proofs::by_triangles),
];

/// Measures the figures whose names contain `filter`, and writes `docs/performance.csv` and
/// `docs/pictures/performance-*.svg`; others stay as they are stored.
pub fn scaling(filter: Option<&str>) -> Result<(), String> {
    println!(
        "{:<12} {:<32} {:>9} {:>10}   (seconds on one thread, ratios, MiB)",
        "figure", "work", "x", "y"
    );
    let docs = workspace::root().join("docs");
    let mut curves = stored(&fs::read_to_string(docs.join("performance.csv")).unwrap_or_default());
    for (figure, measured) in FIGURES {
        if filter.is_none_or(|filter| figure.contains(filter)) {
            println!("load of the last minute: {:.1}", load().unwrap_or(f64::NAN));
            let found = measured()?;
            found.iter().for_each(Curve::print);
            curves.retain(|curve| curve.figure != figure);
            curves.extend(found);
        }
    }
    curves.sort_by_key(|curve| FIGURES.iter().position(|(figure, _)| *figure == curve.figure));
    let mut table = String::from("figure;work;x;y\n");
    for curve in &curves {
        for [x, y] in &curve.points {
            let _ = writeln!(table, "{};{};{x};{y:.5}", curve.figure, curve.name);
        }
    }
    let write = |name: &str, text: &str| fs::write(docs.join(name), text).map_err(|error| format!("{name}: {error}"));
    write("performance.csv", &table)?;
    // What has not been measured yet has no plot.
    let draw = |file: &str, figures: &[&str], panels: &[Panel], label: &str| {
        if curves.iter().any(|curve| figures.contains(&curve.figure)) {
            write(file, &figure(panels, panels.len(), label))
        } else {
            Ok(())
        }
    };
    let times = [
        panel(
            &curves,
            "moves",
            "Time by moves, 300 × 300 dexels",
            ["moves", "seconds, one thread"],
            true,
        ),
        panel(
            &curves,
            "grid",
            "Time by grid",
            ["dexels along a side", "seconds, one thread"],
            true,
        ),
    ];
    draw(
        "pictures/performance-moves.svg",
        &["moves"],
        &times[..1],
        "Seconds on one thread against the number of moves",
    )?;
    draw(
        "pictures/performance-grid.svg",
        &["grid"],
        &times[1..],
        "Seconds on one thread against the dexels along a side",
    )?;
    let threads = panel(
        &curves,
        "threads",
        "Speed by threads, two cores",
        ["threads", "speed / that of one thread"],
        false,
    );
    draw(
        "pictures/performance-threads.svg",
        &["threads"],
        &[threads],
        "Speed against the number of threads",
    )?;
    let seconds = |name: &str, title: &str, x: &str| panel(&curves, name, title, [x, "seconds, one thread"], true);
    let proofs = [
        seconds("proofs", "Proofs by moves, 100,000 triangles", "moves"),
        seconds("proofs-triangles", "Proofs by triangles, 16,000 moves", "triangles"),
    ];
    draw(
        "pictures/performance-proofs.svg",
        &["proofs", "proofs-triangles"],
        &proofs,
        "Seconds of proofs on one thread against moves, and against the triangles of the target",
    )?;
    let memory = [
        panel(&curves, "memory", "Memory by moves", ["moves", "MiB at most"], true),
        panel(
            &curves,
            "memory-grid",
            "Memory by grid",
            ["dexels along a side", "MiB at most"],
            true,
        ),
    ];
    draw(
        "pictures/performance-memory.svg",
        &["memory", "memory-grid"],
        &memory,
        "The most memory against moves, and against the grid",
    )
}
