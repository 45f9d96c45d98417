//! A three-axis program of short moves: what the closed forms of translations are for.

use super::records::{Records, heading};
use super::{on, raster, shortest};
use sweepsim::{Cut, Method, Options, simulate, sweep};
use sweepsim_dexel::Stock;
use sweepsim_motion::{Apt, Path, Tool};

/// Passes, and moves in each.
const PASSES: [usize; 2] = [50, 60];
/// Tools of the table.
pub const TOOLS: [&str; 4] = ["flat", "ball", "bull", "cone"];

/// A tool with this name.
fn tool(name: &str) -> Result<Tool, String> {
    let cone = Apt {
        d: 6.0,
        r: 0.0,
        e: 3.0,
        f: 0.0,
        a: 45.0,
        b: 0.0,
        h: 30.0,
    };
    let tool = match name {
        "flat" => Tool::flat(3.0, 30.0),
        "ball" => Tool::ball(3.0, 30.0),
        "bull" => Tool::bull(3.0, 1.0, 30.0),
        _ => {
            return Tool::apt(&cone)
                .map(|(tool, _)| tool)
                .map_err(|error| error.to_string());
        }
    };
    tool.map_err(|error| error.to_string())
}

/// A raster over a wavy surface: 50 passes of 60 moves, joined by short ones, 3,049 in all, none along the grid.
pub fn path() -> Result<Path, String> {
    Path::new(raster::poses(PASSES, raster::SIDE, 0.0)?).map_err(|error| error.to_string())
}

/// Sweeps the program once with a tool of this name, on `cells` × `cells` lines. The number of crossings.
pub fn once(name: &str, cells: usize, method: Method) -> Result<u64, String> {
    let grid = raster::grid(cells)?;
    let options = Options::new(1e-6).method(method);
    let swept = sweep(&tool(name)?, &path()?, &grid, &options, &()).map_err(|error| error.to_string())?;
    match swept.statistics.unresolved.len() {
        0 => Ok(swept.statistics.crossings),
        open => Err(format!("{open} dexels are unresolved")),
    }
}

/// Removes the program from a block once, which its lowest cuts leave a bottom. The number of crossings.
pub fn cut(name: &str, cells: usize) -> Result<u64, String> {
    let grid = raster::grid(cells)?;
    let half = 0.5 * raster::SIDE;
    let block = Stock::Block {
        min: [-half, -half, -10.0],
        max: [half, half, 2.0],
    };
    let stock = block.dexels(&grid).map_err(|error| error.to_string())?;
    let (tool, path) = (tool(name)?, path()?);
    let done = simulate(stock, &[Cut::new(&tool, &path)], &Options::new(1e-6), &());
    done.map(|done| done.statistics.crossings)
        .map_err(|error| error.to_string())
}

/// The program with several tools on 1,000 × 1,000 lines, one thread: swept by closed forms and by charts, and removed
/// from a block.
pub fn three_axis() -> Result<(), String> {
    let mut records = Records::open();
    heading("Three axes: a raster of 3,049 moves, 1,000 × 1,000 lines, one thread, processor time");
    println!(
        "{:<8} {:>11} {:>9} {:>7} {:>9} {:>7} {:>11} {:>9} {:>7}",
        "tool", "crossings", "sweep, s", "before", "charts, s", "before", "crossings", "cut, s", "before"
    );
    for name in TOOLS {
        let timed = |method| on(1, || shortest(|| once(name, 1000, method).map(drop)))?;
        let crossings = once(name, 1000, Method::default())?;
        let (closed, charts) = (timed(Method::default())?, timed(Method::General)?);
        let removed = cut(name, 1000)?;
        let simulated = on(1, || shortest(|| cut(name, 1000).map(drop)))??;
        let mut noted = |what: &str, seconds| records.note(&format!("three-axis/{name}/{what}"), seconds);
        let before = [noted("sweep", closed), noted("charts", charts), noted("cut", simulated)];
        println!(
            "{name:<8} {crossings:>11} {closed:>9.3} {:>7} {charts:>9.3} {:>7} {removed:>11} {simulated:>9.3} {:>7}",
            before[0], before[1], before[2]
        );
    }
    records.save()
}
