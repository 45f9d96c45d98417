//! `cargo xtask shards`: time and memory of single shards of runs that are too large for one machine, one after the
//! other, and what they add up to: the plots of docs/cluster.md.

use super::sweepsim;
use crate::plot::{Axis, Panel, Series, figure};
use crate::workspace;
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
const MOVES: [usize; 3] = [100_000, 1_000_000, 10_000_000];
const FEW: usize = 10_000;
const COARSE: usize = 2_500;

const HEADER: &str = "side,moves,shard,begin s,cut s,MiB";

/// What a shard cost.
#[derive(Clone, Copy)]
struct Cost {
    /// Processor seconds until the shard knows its tiles; and then, until it has cut them.
    begin: f64,
    cut: f64,
    /// The most memory, in MiB.
    mib: f64,
}

/// A run of a grid of `side`² dexels and so many moves, and what shards of it cost.
struct Run {
    side: usize,
    moves: usize,
    costs: Vec<Cost>,
}

/// Measures single shards into `docs/shards.csv`, unless only the plots of it are to be drawn anew.
pub fn run(plot: bool) -> Result<bool, String> {
    let table = workspace::root().join("docs/shards.csv");
    let failed = |error: std::io::Error| format!("{}: {error}", table.display());
    if !plot {
        let sweepsim = sweepsim()?;
        let folder = sweepsim.with_file_name("shards");
        let mut text = format!("{HEADER}\n");
        println!("{HEADER}");
        let few = GRIDS.map(|side| [side, FEW]).into_iter();
        for [side, moves] in few.chain(MOVES.map(|moves| [COARSE, moves])) {
            let (job, out) = (job(&folder, side, moves)?, folder.join("out"));
            // Of so many shards, the last has no tile: it only begins.
            let [begin, _] = measure(&sweepsim, &job, &out, "99999/100000")?;
            for shard in MEASURED {
                let [seconds, mib] = measure(&sweepsim, &job, &out, &format!("{shard}/{SHARDS}"))?;
                let cut = (seconds - begin).max(0.01);
                let line = format!("{side},{moves},{shard},{begin:.2},{cut:.2},{mib:.0}");
                println!("{line}");
                text.push_str(&line);
                text.push('\n');
            }
        }
        fs::remove_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        fs::write(&table, text).map_err(failed)?;
    }
    store(&read(&fs::read_to_string(&table).map_err(failed)?)?)?;
    Ok(true)
}

/// The table, by run.
fn read(text: &str) -> Result<Vec<Run>, String> {
    let mut runs: Vec<Run> = Vec::new();
    for line in text.lines().skip(1) {
        let numbers: Vec<f64> = line.split(',').filter_map(|field| field.parse().ok()).collect();
        let [side, moves, _, begin, cut, mib] = numbers[..] else {
            return Err(format!("docs/shards.csv: expected {HEADER}, not {line}"));
        };
        let (side, moves, cost) = (side as usize, moves as usize, Cost { begin, cut, mib });
        match runs.last_mut() {
            Some(last) if (last.side, last.moves) == (side, moves) => last.costs.push(cost),
            _ => runs.push(Run {
                side,
                moves,
                costs: vec![cost],
            }),
        }
    }
    Ok(runs)
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

/// How long a run takes on so many cores, of which each computes eight shards: each of these begins anew. What merge
/// takes is not in it.
fn predicted(begin: f64, cut: f64, cores: f64) -> f64 {
    8.0 * begin + cut / cores
}

impl Run {
    fn mean(&self, of: fn(&Cost) -> f64) -> f64 {
        self.costs.iter().map(of).sum::<f64>() / self.costs.len() as f64
    }

    fn model(&self, colour: usize) -> Series {
        let (begin, cut) = (self.mean(|cost| cost.begin), SHARDS as f64 * self.mean(|cost| cost.cut));
        let points = [1.0, 4.0, 16.0, 64.0, 250.0, 1000.0].map(|cores| [cores, predicted(begin, cut, cores)]);
        series(
            &format!("{}² dexels, {} moves", self.side, self.moves),
            colour,
            points.to_vec(),
        )
    }
}

fn series(name: &str, colour: usize, points: Vec<[f64; 2]>) -> Series {
    Series {
        name: name.into(),
        colour,
        dashed: false,
        joined: true,
        points,
    }
}

/// Writes `docs/pictures/shards.svg`.
fn store(all: &[Run]) -> Result<(), String> {
    let grids: Vec<&Run> = all.iter().filter(|run| run.moves == FEW).collect();
    let moves: Vec<&Run> = all.iter().filter(|run| run.side == COARSE).collect();
    let curve = |name: &str, colour: usize, list: &[&Run], x: fn(&Run) -> usize, of: fn(&Cost) -> f64| {
        series(
            name,
            colour,
            list.iter().map(|run| [x(run) as f64, run.mean(of)]).collect(),
        )
    };
    let panel = |title: &str, labels: [&str; 2], series: Vec<Series>| Panel {
        title: title.into(),
        axes: labels.map(|label| Axis {
            label: label.into(),
            logarithmic: true,
            range: None,
        }),
        series,
    };
    let times = |list: &[&Run], x: fn(&Run) -> usize| {
        vec![
            curve("begin: read, share out", 0, list, x, |cost| cost.begin),
            curve("cut", 1, list, x, |cost| cost.cut),
        ]
    };
    let memory = |list: &[&Run], x: fn(&Run) -> usize| vec![curve("memory", 2, list, x, |cost| cost.mib)];
    let (side, number) = (|run: &Run| run.side, |run: &Run| run.moves);
    let last = [grids.last(), moves.last()].into_iter().flatten();
    let models = last.zip(3..).map(|(run, colour)| run.model(colour)).collect();
    let panels = [
        panel(
            "one shard of 64, 10,000 moves",
            ["dexels along a side", "s"],
            times(&grids, side),
        ),
        panel("one shard of 64, 2,500² dexels", ["moves", "s"], times(&moves, number)),
        panel(
            "one shard of 64, 10,000 moves",
            ["dexels along a side", "MiB"],
            memory(&grids, side),
        ),
        panel(
            "one shard of 64, 2,500² dexels",
            ["moves", "MiB"],
            memory(&moves, number),
        ),
        panel("all shards, by the model", ["cores", "s"], models),
    ];
    let words = "Time and memory of one shard of 64 against the size of the grid and the number of moves, and the time of all shards against cores";
    let file = workspace::root().join("docs/pictures/shards.svg");
    fs::write(&file, figure(&panels, 2, words)).map_err(|error| format!("{}: {error}", file.display()))
}
