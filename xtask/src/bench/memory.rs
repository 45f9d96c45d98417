//! The most memory that a run needs, of child processes: `sweepsim simulate` on programs of any length, and on grids of
//! any size.

use super::raster;
use super::records::{Records, heading};
use crate::workspace;
use std::fmt::Write as _;
use std::path::{Path as FilePath, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;
use std::{fs, thread};

/// Moves of the programs, on `CELLS` × `CELLS` dexels: few, since this is about moves.
const MOVES: [usize; 8] = [1_000, 4_000, 16_000, 64_000, 200_000, 400_000, 1_000_000, 4_000_000];
const CELLS: usize = 100;
/// Sides of the grids, of a program of `FEW` moves.
const GRIDS: [usize; 4] = [250, 500, 1000, 2000];
const FEW: usize = 1_000;

/// A run's size, the most memory in MiB, and its time in seconds by the clock.
pub struct Run {
    pub size: usize,
    pub mib: f64,
    pub seconds: f64,
}

/// The command, of the same profile as this one.
fn sweepsim() -> Result<PathBuf, String> {
    let built = Command::new(env!("CARGO"))
        .args(["build", "--quiet", "--release", "--package", "sweepsim-cli"])
        .status();
    if !built.map_err(|error| format!("cargo build: {error}"))?.success() {
        return Err("the command could not be built".into());
    }
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    Ok(own.with_file_name("sweepsim"))
}

/// A job of the raster in a folder.
fn job(folder: &FilePath, moves: usize, cells: usize) -> Result<PathBuf, String> {
    let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
    fs::create_dir_all(folder).map_err(failed)?;
    let mut rows = String::from("x,y,z,i,j,k\n");
    for pose in raster::program(moves, 0.0)?.poses() {
        let ([x, y, z], [i, j, k]) = (pose.tip(), pose.axis());
        let _ = writeln!(rows, "{x:.6},{y:.6},{z:.6},{i},{j},{k}");
    }
    fs::write(folder.join("path.csv"), rows).map_err(failed)?;
    let half = 0.5 * raster::SIDE;
    let text = format!(
        "Job(\n    tolerance: 1e-6,\n    grid: Grid(min: (-{half:?}, -{half:?}), max: ({half:?}, {half:?}), cells: ({cells}, {cells})),\n    \
         stock: Block(min: (-{half:?}, -{half:?}, -10.0), max: ({half:?}, {half:?}, 2.0)),\n    \
         tools: {{ 1: Ball(radius: 3.0, length: 30.0) }},\n    paths: [Path(tool: 1, file: \"path.csv\")],\n)\n"
    );
    let file = folder.join("job.ron");
    fs::write(&file, text).map_err(failed)?;
    Ok(file)
}

/// The most memory of a process so far, in MiB: Linux keeps it.
fn peak(child: &Child) -> Option<f64> {
    let status = fs::read_to_string(format!("/proc/{}/status", child.id())).ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kib: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib / 1024.0)
}

fn run(command: &FilePath, moves: usize, cells: usize) -> Result<[f64; 2], String> {
    let folder = command.with_file_name("bench-memory");
    let job = job(&folder, moves, cells)?;
    let clock = super::Clock::start();
    let mut child = Command::new(command)
        .args(["simulate", "--only", "binary", "--out"])
        .arg(folder.join("out"))
        .arg(&job)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .map_err(|error| format!("{}: {error}", command.display()))?;
    let mut most: f64 = 0.0;
    let status = loop {
        // A process that has ended has no memory any more.
        most = peak(&child).map_or(most, |mib| most.max(mib));
        if let Some(status) = child.try_wait().map_err(|error| error.to_string())? {
            break status;
        }
        thread::sleep(Duration::from_millis(2));
    };
    let seconds = clock.wall();
    let _ = fs::remove_dir_all(&folder);
    if status.success() {
        Ok([most, seconds])
    } else {
        Err(format!("{}: {status}", job.display()))
    }
}

/// Of programs of so many moves at most, on the same grid.
pub fn by_moves(most: usize) -> Result<Vec<Run>, String> {
    let command = sweepsim()?;
    let runs = MOVES.into_iter().filter(|moves| *moves <= most);
    runs.map(|size| run(&command, size, CELLS).map(|[mib, seconds]| Run { size, mib, seconds }))
        .collect()
}

/// Of a short program on larger and larger grids.
pub fn by_grid() -> Result<Vec<Run>, String> {
    let command = sweepsim()?;
    GRIDS
        .into_iter()
        .map(|size| run(&command, FEW, size).map(|[mib, seconds]| Run { size, mib, seconds }))
        .collect()
}

/// The most memory of `sweepsim simulate`, by the length of the program and by the grid.
pub fn memory() -> Result<(), String> {
    if !workspace::root().join("Cargo.toml").exists() || !FilePath::new("/proc/self/status").exists() {
        return Err("memory is measured on Linux, in the workspace".into());
    }
    let mut records = Records::open();
    heading("Memory: three axes, a ball end, by the clock");
    println!(
        "{:<28} {:>10} {:>9} {:>14} {:>7}",
        "run", "MiB", "s", "moves/s", "before"
    );
    for found in by_moves(usize::MAX)? {
        let before = records.note(&format!("memory/moves/{}", found.size), found.mib);
        let name = format!("{} moves, {CELLS} × {CELLS}", found.size);
        println!(
            "{name:<28} {:>10.1} {:>9.2} {:>14.0} {before:>7}",
            found.mib,
            found.seconds,
            found.size as f64 / found.seconds
        );
    }
    println!(
        "{:<28} {:>10} {:>9} {:>14} {:>7}",
        "run", "MiB", "s", "bytes/dexel", "before"
    );
    for found in by_grid()? {
        let before = records.note(&format!("memory/grid/{}", found.size), found.mib);
        let name = format!("{FEW} moves, {0} × {0}", found.size);
        let each = found.mib * 1024.0 * 1024.0 / (found.size * found.size) as f64;
        println!(
            "{name:<28} {:>10.1} {:>9.2} {each:>14.1} {before:>7}",
            found.mib, found.seconds
        );
    }
    records.save()
}
