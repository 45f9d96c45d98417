//! What almost degenerate input costs, as a multiple of its generic neighbour.

use super::records::{Records, heading};
use super::{Clock, on, shortest_by};
use sweepsim::{Options, sweep};
use sweepsim_dexel::Grid;
use sweepsim_motion::{Lollipop, Path, Pose, Tool};

const CELLS: usize = 40;
/// Distances from degeneracy, and that of the generic neighbour.
const DISTANCES: [f64; 6] = [1e-2, 1e-4, 1e-6, 1e-9, 1e-12, 0.0];
const GENERIC: f64 = 0.23;
/// As many times as its generic neighbour may a family cost at most.
const WANTED: f64 = 3.0;

/// One piece of work.
struct Work {
    tool: Tool,
    path: Path,
    grid: Grid,
    tolerance: f64,
}

/// A family: its name, its members by their distance from degeneracy, and those distances after the generic one's.
struct Family {
    name: &'static str,
    member: fn(f64) -> Result<Work, String>,
    generic: f64,
    distances: &'static [f64],
}

/// An axis `angle` away from z, in a direction not aligned with the grid.
fn leaning(angle: f64) -> [f64; 3] {
    let (s, c) = angle.sin_cos();
    [0.6_f64.cos() * s, 0.6_f64.sin() * s, c]
}

/// A work from two poses; the grid is about their middle, `shift` off it.
fn work(tool: Tool, poses: [([f64; 3], [f64; 3]); 2], shift: [f64; 2], tolerance: f64) -> Result<Work, String> {
    let text = |error: &dyn std::fmt::Display| error.to_string();
    let middle = [0, 1].map(|k| 0.5 * (poses[0].0[k] + poses[1].0[k]) + shift[k]);
    let grid =
        Grid::new(middle.map(|c| c - 20.0), middle.map(|c| c + 20.0), [CELLS; 2]).map_err(|error| text(&error))?;
    let poses = poses.map(|(tip, axis)| Pose::new(tip, axis));
    let [from, to] = poses;
    let poses = vec![from.map_err(|error| text(&error))?, to.map_err(|error| text(&error))?];
    let path = Path::new(poses).map_err(|error| text(&error))?;
    Ok(Work {
        tool,
        path,
        grid,
        tolerance,
    })
}

fn flat() -> Result<Tool, String> {
    Tool::flat(5.0, 30.0).map_err(|error| error.to_string())
}

fn ball() -> Result<Tool, String> {
    Tool::ball(5.0, 30.0).map_err(|error| error.to_string())
}

fn lollipop() -> Result<Tool, String> {
    let shape = Lollipop {
        radius: 4.0,
        neck: 1.5,
        length: 30.0,
    };
    Tool::lollipop(shape).map_err(|error| error.to_string())
}

const SHIFT: [f64; 2] = [0.137, -0.211];
const FROM: [f64; 3] = [-7.3, -4.1, 0.0];
const TO: [f64; 3] = [8.1, 5.7, 0.0];

fn families() -> Vec<Family> {
    let usual = |name, member| Family {
        name,
        member,
        generic: GENERIC,
        distances: &DISTANCES,
    };
    vec![
        usual("flat end's tilt on a level move", |d| {
            work(flat()?, [(FROM, leaning(d)), (TO, leaning(d))], SHIFT, 1e-6)
        }),
        usual("ball end's tilt on a level move", |d| {
            work(ball()?, [(FROM, leaning(d)), (TO, leaning(d))], SHIFT, 1e-6)
        }),
        usual("change of the axis in a move", |d| {
            work(ball()?, [(FROM, leaning(0.2)), (TO, leaning(0.2 + d))], SHIFT, 1e-6)
        }),
        usual("rise of an upright flat end", |d| {
            work(
                flat()?,
                [(FROM, leaning(0.0)), ([TO[0], TO[1], 10.0 * d], leaning(0.0))],
                SHIFT,
                1e-6,
            )
        }),
        usual("length of the move", |d| {
            let to = [0, 1, 2].map(|k| FROM[k] + d * (TO[k] - FROM[k]) + if k == 2 { d } else { 0.0 });
            work(ball()?, [(FROM, leaning(0.2)), (to, leaning(0.2))], SHIFT, 1e-6)
        }),
        usual("line from the wall of a level move", |d| {
            // Lines half a cell from the middle, at whole numbers: the wall is at 5.
            work(
                flat()?,
                [([-8.0, 0.0, 0.0], leaning(0.0)), ([8.0, 0.0, 0.0], leaning(0.0))],
                [0.5, 0.5 + d],
                1e-6,
            )
        }),
        usual("lollipop off its tilted axis", |d| {
            let (axis, aside) = (leaning(0.5), [0.6_f64.sin(), -0.6_f64.cos(), 0.0]);
            let to = [0, 1, 2].map(|k| 12.0 * axis[k] + 10.0 * d * aside[k]);
            work(lollipop()?, [([0.0; 3], axis), (to, axis)], SHIFT, 1e-6)
        }),
        Family {
            name: "long moves of a flat end, tool / length",
            member: |d| {
                work(
                    flat()?,
                    [
                        ([-5.0 / d, 0.3, 0.0], leaning(0.3)),
                        ([5.0 / d, 0.1, 0.2], leaning(0.3)),
                    ],
                    SHIFT,
                    1e-3,
                )
            },
            generic: GENERIC,
            distances: &[1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6],
        },
        Family {
            name: "tolerance, mm",
            member: |d| work(ball()?, [(FROM, leaning(0.2)), (TO, leaning(-0.2))], SHIFT, d),
            generic: 1e-3,
            distances: &[1e-4, 1e-5, 1e-6, 1e-7, 1e-8],
        },
    ]
}

fn timed(family: &Family, distance: f64) -> Result<(f64, usize), String> {
    let work = (family.member)(distance)?;
    let options = Options::new(work.tolerance);
    let run = || sweep(&work.tool, &work.path, &work.grid, &options, &()).map_err(|error| error.to_string());
    let open = run()?.statistics.unresolved.len();
    Ok((shortest_by(Clock::seconds, || run().map(drop))?, open))
}

/// Each family's dearest member beside the generic one, one thread, processor time.
pub fn near_degenerate() -> Result<(), String> {
    on(1, || {
        let mut records = Records::open();
        heading("Near-degenerate input, 40 × 40 lines, one thread, processor time; at most 3 is wanted");
        println!(
            "{:<42} {:>11} {:>9} {:>10} {:>7} {:>7} {:>7}",
            "family", "generic, ms", "worst, ms", "at", "ratio", "", "before"
        );
        for family in families() {
            let (generic, mut open) = timed(&family, family.generic)?;
            let mut worst = (0.0, 0.0);
            for &distance in family.distances {
                let (seconds, unresolved) = timed(&family, distance)?;
                open += unresolved;
                if seconds > worst.0 {
                    worst = (seconds, distance);
                }
            }
            let ratio = worst.0 / generic;
            let before = records.note(&format!("near-degenerate/{}", family.name.replace(',', "")), ratio);
            let mark = if ratio > WANTED { "beyond" } else { "" };
            println!(
                "{:<42} {:>11.3} {:>9.3} {:>10.0e} {ratio:>7.2} {mark:>7} {before:>7}",
                family.name,
                generic * 1e3,
                worst.0 * 1e3,
                worst.1
            );
            if open > 0 {
                println!("    {open} dexels unresolved");
            }
        }
        records.save()
    })?
}
