//! `cargo xtask shards`: time and memory of single shards of runs that are too large for one machine, one after the other, and what they add up to: the plots of
//! docs/cluster.md.

use super::sweepsim;
use crate::plot::{Axis, Panel, Series, figure};
use crate::workspace;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// The shards of each run, and those that are measured.
const SHARDS: usize = 64;
const MEASURED: [usize; 3] = [0, 31, 63];
/// The side of the block, and the distance of rows, in millimetres.
const SIDE: f64 = 100.0;
/// Sides of grids, cut by so many moves; and numbers of moves, on a grid of such a side.
const GRIDS: [usize; 3] = [2_500, 5_000, 10_000];
const MOVES: [usize; 4] = [10_000, 100_000, 1_000_000, 10_000_000];
const FEW: usize = 10_000;
const COARSE: usize = 2_500;

/// What a shard cost.
#[derive(Clone, Copy)]
struct Cost {
    /// Processor seconds until the shard knows its tiles; and then, until it has cut them.
    begin: f64,
    cut: f64,
    /// The most memory, in MiB.
    mib: f64,
}

/// Measures the shards of a run of any size.
pub fn run() -> Result<bool, String> {
    let sweepsim = sweepsim()?;
    let folder = sweepsim.with_file_name("shards");
    println!(
        "{:>6} {:>9} {:>6} {:>9} {:>9} {:>9}",
        "side", "moves", "shard", "begin, s", "cut, s", "MiB"
    );
    let mut all: Vec<([usize; 2], Vec<Cost>)> = Vec::new();
    let sizes = GRIDS
        .map(|side| [side, FEW])
        .into_iter()
        .chain(MOVES[1..].iter().map(|moves| [COARSE, *moves]));
    for [side, moves] in sizes {
        let job = job(&folder, side, moves)?;
        let out = folder.join("out");
        // Of so many shards, the last has no tile: it only begins.
        let [begin, _] = measure(&sweepsim, &job, &out, "99999/100000")?;
        let mut costs = Vec::new();
        for shard in MEASURED {
            let [seconds, mib] = measure(&sweepsim, &job, &out, &format!("{shard}/{SHARDS}"))?;
            let cut = (seconds - begin).max(0.01);
            let cost = Cost { begin, cut, mib };
            println!(
                "{side:>6} {moves:>9} {shard:>6} {:>9.2} {:>9.2} {:>9.0}",
                cost.begin, cost.cut, cost.mib
            );
            costs.push(cost);
        }
        all.push(([side, moves], costs));
    }
    fs::remove_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    store(&all)?;
    Ok(true)
}

/// A job with a zigzag of short moves over all of the block: its rows are as far apart as needed.
fn job(folder: &Path, side: usize, moves: usize) -> Result<PathBuf, String> {
    let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
    fs::create_dir_all(folder).map_err(failed)?;
    let rows = ((moves as f64).sqrt() as usize).max(1);
    let in_row = moves / rows;
    let mut file = BufWriter::new(File::create(folder.join("path.csv")).map_err(failed)?);
    writeln!(file, "x,y,z,i,j,k").map_err(failed)?;
    for n in 0..=moves {
        let (row, place) = (n / in_row, n % in_row);
        let along = (place as f64 + 0.5) / in_row as f64;
        let x = SIDE * if row.is_multiple_of(2) { along } else { 1.0 - along };
        let y = SIDE * (row as f64 + 0.5) / rows as f64;
        // A wave a tenth of a millimetre high, so that every move cuts.
        let z = 8.0 + 0.1 * (0.7 * x).sin() * (0.9 * y).cos();
        writeln!(file, "{x:.5},{y:.5},{z:.5},0,0,1").map_err(failed)?;
    }
    file.flush().map_err(failed)?;
    let text = format!(
        "Job(grid: Grid(min: (0, 0), max: ({SIDE}, {SIDE}), cells: ({side}, {side})), stock: Block(min: (0, 0, 0), max: ({SIDE}, {SIDE}, 10)), \
         tools: {{ 1: Ball(radius: 3, length: 30) }}, paths: [Path(tool: 1, file: \"path.csv\")])"
    );
    let job = folder.join("job.ron");
    fs::write(&job, text).map_err(failed)?;
    Ok(job)
}

/// Runs a shard on one thread, along z: processor seconds, and the most memory in MiB.
fn measure(sweepsim: &Path, job: &Path, out: &Path, shard: &str) -> Result<[f64; 2], String> {
    let mut command = Command::new(sweepsim);
    command.arg("simulate").arg(job).arg("--out").arg(out);
    command.args(["--only", "dexels", "--threads", "1", "--quiet", "--shard", shard]);
    let failed = |error: std::io::Error| format!("{}: {error}", sweepsim.display());
    let mut child = command.spawn().map_err(failed)?;
    let (mut seconds, mut mib): (f64, f64) = (0.0, 0.0);
    loop {
        // Linux keeps the most memory so far; and the time, in hundredths of a second.
        let read = |name: &str| fs::read_to_string(format!("/proc/{}/{name}", child.id())).unwrap_or_default();
        let status = read("status");
        let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        if let Some(Ok(kib)) = peak
            .and_then(|text| text.split_whitespace().next())
            .map(str::parse::<f64>)
        {
            mib = mib.max(kib / 1024.0);
        }
        let stat = read("stat");
        let fields: Vec<f64> = stat
            .rsplit(')')
            .next()
            .unwrap_or_default()
            .split_whitespace()
            .map(|field| field.parse().unwrap_or_default())
            .collect();
        if let [user, system] = fields.get(11..13).unwrap_or_default() {
            seconds = seconds.max((user + system) / 100.0);
        }
        if let Some(status) = child.try_wait().map_err(failed)? {
            return if status.success() {
                Ok([seconds, mib])
            } else {
                Err(format!("shard {shard} of {}: {status}", job.display()))
            };
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// How long a run takes on so many cores: each shard begins anew; the merge reads everything.
fn predicted(begin: f64, cut: f64, merge: f64, cores: f64) -> f64 {
    let rounds = (SHARDS as f64).max(8.0 * cores) / cores;
    rounds * begin + cut / cores + merge
}

/// Writes `docs/pictures/shards.svg`.
fn store(all: &[([usize; 2], Vec<Cost>)]) -> Result<(), String> {
    let mean = |costs: &[Cost], of: fn(&Cost) -> f64| costs.iter().map(of).sum::<f64>() / costs.len() as f64;
    let axis = |label: &str| Axis {
        label: label.into(),
        logarithmic: true,
        range: None,
    };
    let series = |name: &str, colour: usize, points: Vec<[f64; 2]>| Series {
        name: name.into(),
        colour,
        dashed: false,
        points,
    };
    let grids: Vec<_> = all.iter().filter(|([_, moves], _)| *moves == FEW).collect();
    let moves: Vec<_> = all.iter().filter(|([side, _], _)| *side == COARSE).collect();
    let curve = |of: fn(&Cost) -> f64, list: &[&([usize; 2], Vec<Cost>)], k: usize| {
        list.iter()
            .map(|(size, costs)| [size[k] as f64, mean(costs, of)])
            .collect::<Vec<_>>()
    };
    let panel = |title: &str, label: &str, y: &str, series: Vec<Series>| Panel {
        title: title.into(),
        axes: [axis(label), axis(y)],
        series,
    };
    let both = |list: &[&([usize; 2], Vec<Cost>)], k: usize| {
        vec![
            series("begin: read, share out", 0, curve(|cost| cost.begin, list, k)),
            series("cut", 1, curve(|cost| cost.cut, list, k)),
        ]
    };
    let memory =
        |list: &[&([usize; 2], Vec<Cost>)], k: usize| vec![series("memory", 2, curve(|cost| cost.mib, list, k))];
    let cores = [1.0, 4.0, 16.0, 64.0, 250.0, 1000.0];
    let scaled = |([side, moves], costs): &([usize; 2], Vec<Cost>), colour: usize| {
        let (begin, cut) = (
            mean(costs, |cost| cost.begin),
            SHARDS as f64 * mean(costs, |cost| cost.cut),
        );
        let points = cores.map(|cores| [cores, predicted(begin, cut, 0.0, cores)]);
        series(&format!("{side}², {moves} moves"), colour, points.to_vec())
    };
    let mut models: Vec<Series> = grids.iter().last().map(|run| scaled(run, 3)).into_iter().collect();
    models.extend(moves.iter().last().map(|run| scaled(run, 4)));
    let panels = [
        panel(
            "a shard of 64: grid of n², 10,000 moves",
            "n",
            "seconds",
            both(&grids, 0),
        ),
        panel(
            "a shard of 64: moves, 2,500² dexels",
            "moves",
            "seconds",
            both(&moves, 1),
        ),
        panel("memory of a shard", "n", "MiB", memory(&grids, 0)),
        panel("memory of a shard", "moves", "MiB", memory(&moves, 1)),
        panel("the whole run, by the model", "cores", "seconds", models),
    ];
    let mut text = String::new();
    let _ = write!(
        text,
        "{}",
        figure(
            &panels,
            2,
            "Time and memory of a shard of 64 against grid and moves, and time of the whole run against cores"
        )
    );
    let file = workspace::root().join("docs/pictures/shards.svg");
    fs::write(&file, text).map_err(|error| format!("{}: {error}", file.display()))
}
