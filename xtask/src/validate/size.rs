//! Sizes of the simulated plate against those of its model, and of the twenty parts that the shop measured.

use super::qif::{self, Characteristic};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use sweepsim_dexel::Dexels;
use sweepsim_job::{Request, Task};
use sweepsim_nc::{ReadOptions, read_file};

/// The shop clamps the plate turned by 180 degrees about z: a point of the program is this less a point of the model.
/// The outline says how far that is off.
const TURNED: [f64; 2] = [123.175, -2.412];
/// Radii of the flat end mills by tool, as the program's comments say; T7 and T23 are spot drills of 90 degrees.
const FLAT: [(u32, f64); 5] = [(15, 38.1), (3, 6.35), (4, 3.175), (5, 1.5875), (1, 1.1811)];
const SPOT: [(u32, f64); 2] = [(7, 6.35), (23, 1.5875)];
/// The distance of dexels where areas are measured, in millimetres, and the number along a line where lengths are.
const SPACING: f64 = 0.025;
const FINE: usize = 20_000;
/// Half the plate's thickness.
const MIDDLE: f64 = 2.5;
/// What is worth a look, in millimetres.
const FAR: f64 = 0.02;

/// Arcs of a wall about z: names, centre, nominal diameter, and the sector that it covers in degrees.
type Arc = (&'static [&'static str], [f64; 2], f64, [f64; 2]);
const ROUND: [f64; 2] = [0.0, 360.0];
const LOWER: [f64; 2] = [180.0, 360.0];
const UPPER: [f64; 2] = [0.0, 180.0];
/// The characteristics do not say where they are: those of the same nominal diameter have one list of names.
const FOURS: [&str; 8] = [
    "Diameter 1",
    "Diameter 2",
    "Diameter 5",
    "Diameter 6",
    "Diameter 7",
    "Diameter 8",
    "Diameter 9",
    "Diameter 10",
];
const THREES: [&str; 3] = ["Diameter 3", "Diameter 11", "Diameter 12"];
const TENS: [&str; 2] = ["Diameter 4", "Diameter 13"];
const FIVES: [&str; 3] = ["Diameter 18", "Diameter 19", "Diameter 20"];
const ENDS: [&str; 4] = ["Diameter 21", "Diameter 22", "Diameter 23", "Diameter 24"];
const ARCS: [Arc; 19] = [
    (&FOURS, [107.5, 31.16], 4.0, ROUND),
    (&FOURS, [107.5, 51.16], 4.0, ROUND),
    (&FOURS, [5.0, 25.58], 4.0, ROUND),
    (&FOURS, [5.0, 35.58], 4.0, ROUND),
    (&FOURS, [5.0, 45.58], 4.0, ROUND),
    (&FOURS, [50.0, 5.0], 4.0, ROUND),
    (&FOURS, [60.0, 5.0], 4.0, ROUND),
    (&FOURS, [70.0, 5.0], 4.0, ROUND),
    (&THREES, [24.3934, 25.6066], 3.0, ROUND),
    (&THREES, [35.0, 30.0], 3.0, ROUND),
    (&THREES, [45.6066, 25.6066], 3.0, ROUND),
    (&TENS, [107.5, 41.16], 10.0, ROUND),
    (&TENS, [35.0, 15.0], 10.0, [60.0, 300.0]),
    (&FIVES, [43.7071, 37.41], 5.0, LOWER),
    (&FIVES, [43.7071, 62.41], 5.0, UPPER),
    (&ENDS, [27.9571, 50.66], 4.0, LOWER),
    (&ENDS, [27.9571, 64.16], 4.0, UPPER),
    (&ENDS, [35.4571, 50.66], 4.0, LOWER),
    (&ENDS, [35.4571, 64.16], 4.0, UPPER),
];
/// Slots along y: the name of the distance of the centres of their ends, x, and both ends.
const SLOTS: [(&str, f64, [f64; 2], f64); 3] = [
    ("Distance 3", 43.7071, [37.41, 62.41], 5.0),
    ("Distances 6 and 7", 27.9571, [50.66, 64.16], 4.0),
    ("Distances 6 and 7", 35.4571, [50.66, 64.16], 4.0),
];
const SINKS: [[f64; 2]; 4] = [[18.27, 5.5], [18.27, 65.66], [101.73, 5.5], [101.73, 65.66]];

/// A block: its line, places that its tool passes, and the tool's radius.
type Way = (usize, Vec<[f64; 2]>, f64);

struct Shop<'a> {
    program: &'a Path,
    /// Where the tool of each block goes.
    ways: Vec<Way>,
}

impl Shop<'_> {
    /// The plate in a window of the program, seen along z.
    fn plate(&self, low: [f64; 2], high: [f64; 2], cells: [usize; 2]) -> Result<Dexels, String> {
        let mut tools = String::new();
        for (number, radius) in FLAT {
            let _ = write!(tools, "{number}: Flat(radius: {radius}, length: 40), ");
        }
        for (number, radius) in SPOT {
            let _ = write!(
                tools,
                "{number}: Profile(start: (0, 0), segments: [Line(({radius}, {radius})), Line(({radius}, 40)), Line((0, 40))]), "
            );
        }
        let text = format!(
            "Job(grid: Grid(min: ({}, {}), max: ({}, {}), cells: ({}, {})), stock: Block(min: (0, -77, -5), max: (127, 1, 0)), tools: {{ {tools} }}, paths: [Path(file: {:?})])",
            low[0], low[1], high[0], high[1], cells[0], cells[1], self.program
        );
        let plan = Request::from_job("plate.ron", text).task(Task::Simulate).plan();
        let outcome = plan.and_then(|plan| plan.run(&())).map_err(|error| error.to_string())?;
        Ok(outcome.part().clone())
    }

    /// Radius of an arc of a wall at a depth below the top: from the area within its sector.
    fn radius(&self, (_, centre, nominal, sector): Arc, depth: f64) -> Result<f64, String> {
        let reach = 0.5 * nominal + 0.6;
        let count = (2.0 * reach / SPACING).round() as usize;
        let centre = turned(centre);
        let [low, high] = [-reach, reach].map(|r| [centre[0] + r, centre[1] + r]);
        let plate = self.plate(low, high, [count, count])?;
        let step = 2.0 * reach / count as f64;
        let mut free = 0_usize;
        for (i, j) in (0..count * count).map(|k| (k % count, k / count)) {
            let at = [i, j].map(|k| (k as f64 + 0.5) * step - reach);
            // In the model, half a turn from here.
            let angle = (at[1].atan2(at[0]).to_degrees() + 180.0).rem_euclid(360.0);
            if (sector[0]..sector[1]).contains(&angle) && at[0].hypot(at[1]) < reach && !solid(&plate, i, j, depth) {
                free += 1;
            }
        }
        Ok((2.0 * free as f64 * step * step / (sector[1] - sector[0]).to_radians()).sqrt())
    }

    /// Where a line along x or y of the model at half the thickness is free or solid: the least and the largest place
    /// that is.
    fn extent(&self, axis: usize, across: f64, range: [f64; 2], wanted_solid: bool) -> Result<[f64; 2], String> {
        let (mut low, mut high, mut cells) = ([across - 0.01; 2], [across + 0.01; 2], [1; 2]);
        (low[axis], high[axis], cells[axis]) = (range[0], range[1], FINE);
        let [high, low] = [low, high].map(turned);
        let plate = self.plate(low, high, cells)?;
        let found = (0..FINE).filter(|k| {
            let (i, j) = if axis == 0 { (*k, 0) } else { (0, *k) };
            solid(&plate, i, j, MIDDLE) == wanted_solid
        });
        let step = (range[1] - range[0]) / FINE as f64;
        let (mut least, mut largest) = (f64::INFINITY, f64::NEG_INFINITY);
        for k in found {
            least = least.min(range[1] - (k + 1) as f64 * step);
            largest = largest.max(range[1] - k as f64 * step);
        }
        Ok([least, largest])
    }

    /// The first block whose tool reaches farthest from a centre, of those that stay within a circle.
    fn line(&self, centre: [f64; 2], within: f64) -> Option<usize> {
        let far = |at: &[f64; 2], radius: f64| (at[0] - centre[0]).hypot(at[1] - centre[1]) + radius;
        let inside = self.ways.iter().filter_map(|(line, places, radius)| {
            let reach = places.iter().map(|at| far(at, *radius)).fold(0.0, f64::max);
            (reach < within).then_some((*line, reach))
        });
        let all: Vec<(usize, f64)> = inside.collect();
        let most = all.iter().map(|(_, reach)| *reach).fold(0.0, f64::max);
        all.iter()
            .find(|(_, reach)| *reach > most - 1e-4)
            .map(|(line, _)| *line)
    }
}

/// From the model to the program and back: half a turn about z.
fn turned([x, y]: [f64; 2]) -> [f64; 2] {
    [TURNED[0] - x, TURNED[1] - y]
}

/// Whether a dexel is material at a depth below the top of the plate.
fn solid(plate: &Dexels, i: usize, j: usize, depth: f64) -> bool {
    plate
        .intervals(i, j)
        .heights()
        .any(|[low, high]| low <= -depth && -depth <= high)
}

/// The places that each block's tool passes, in the model's coordinates.
fn ways(program: &Path) -> Result<Vec<Way>, String> {
    let mut options = ReadOptions::default();
    options.arc_tolerance = 1e-4;
    let program = read_file(program, &options).map_err(|error| error.to_string())?;
    let mut found: BTreeMap<usize, (Vec<[f64; 2]>, f64)> = BTreeMap::new();
    let mut before = [0.0; 2];
    for pose in program.poses.in_order() {
        let tip = pose.pose.tip();
        let at = turned([tip[0], tip[1]]);
        let radius = FLAT
            .iter()
            .find(|(number, _)| pose.tool == Some(*number))
            .map(|(_, radius)| *radius);
        if let (Some(radius), false, true) = (radius, pose.rapid, pose.joined && tip[2] < -MIDDLE) {
            let entry = found.entry(pose.line).or_insert_with(|| (vec![before], radius));
            entry.0.push(at);
        }
        before = at;
    }
    Ok(found
        .into_iter()
        .map(|(line, (places, radius))| (line, places, radius))
        .collect())
}

/// Measures the simulated plate; returns the table.
pub fn run(folder: &Path) -> Result<String, String> {
    let program = folder.join("plate-1.nc");
    let lines = std::fs::read_to_string(&program).map_err(|error| error.to_string())?;
    let lines: Vec<&str> = lines.lines().collect();
    let text = std::fs::read_to_string(folder.join("plate-results.qif")).map_err(|error| error.to_string())?;
    let measured = qif::read(&text)?;
    let shop = Shop {
        program: &program,
        ways: ways(&program)?,
    };
    let mut table = Table::new(&measured, &lines);

    let across = shop.extent(1, 112.0, [-1.5, 72.5], true)?;
    let along = shop.extent(0, 20.0, [-1.5, 121.5], true)?;
    table.row("Distance 1", &["Distance 1"], 71.16, across[1] - across[0], None);
    for arc in ARCS {
        let diameter = 2.0 * shop.radius(arc, MIDDLE)?;
        let line = shop.line(arc.1, 0.5 * arc.2 + 0.3);
        let name = format!("Ø{} at {}, {}", arc.2, arc.1[0], arc.1[1]);
        table.row(&name, arc.0, arc.2, diameter, line);
    }
    for (name, x, ends, width) in SLOTS {
        let free = shop.extent(1, x, [ends[0] - 4.0, ends[1] + 4.0], false)?;
        let names: &[&str] = if name == "Distance 3" {
            &["Distance 3"]
        } else {
            &["Distance 6", "Distance 7"]
        };
        let radii =
            [(ends[0], LOWER), (ends[1], UPPER)].map(|(y, half)| shop.radius((&[], [x, y], width, half), MIDDLE));
        let [one, other] = radii;
        let distance = free[1] - free[0] - one? - other?;
        table.row(&format!("slot at x = {x}"), names, ends[1] - ends[0], distance, None);
    }
    let names = ["Diameter 14", "Diameter 15", "Diameter 16", "Diameter 17"];
    for centre in SINKS {
        let at = |depth: f64| shop.radius((&[], centre, 9.4, ROUND), depth);
        let (top, low, high) = (at(1e-3)?, at(0.5)?, at(1.5)?);
        let drill = lines.iter().position(|line| line.contains("G81")).map(|k| k + 1);
        table.row(
            &format!("countersink at {}, {}", centre[0], centre[1]),
            &names,
            9.4,
            2.0 * top,
            drill,
        );
        let angle = 2.0 * (low - high).atan().to_degrees();
        let angles = ["Cone Angle 1", "Cone Angle 2", "Cone Angle 3", "Cone Angle 4"];
        table.row(
            &format!("cone at {}, {}", centre[0], centre[1]),
            &angles,
            90.0,
            angle,
            None,
        );
    }
    let [x, y] = SINKS[0];
    let middle = |axis: usize, across: f64, at: f64| {
        let free = shop.extent(axis, across, [at - 3.0, at + 3.0], false)?;
        Ok::<f64, String>(0.5 * (free[0] + free[1]))
    };
    table.row("Distance 5", &["Distance 5"], x, middle(0, y, x)? - along[0], None);
    table.row("Distance 4", &["Distance 4"], y, middle(1, x, y)? - across[0], None);
    let off = [
        0.5 * (along[0] + along[1]) - 60.0,
        0.5 * (across[0] + across[1]) - 35.58,
    ];
    Ok(format!(
        "The middle of the simulated outline is {:.4}, {:.4} mm beside that of the model.\n\n{}",
        off[0], off[1], table.text
    ))
}

struct Table<'a> {
    text: String,
    measured: &'a BTreeMap<String, Characteristic>,
    lines: &'a [&'a str],
}

impl<'a> Table<'a> {
    fn new(measured: &'a BTreeMap<String, Characteristic>, lines: &'a [&'a str]) -> Self {
        let text = "| feature | characteristics | nominal | simulated | measured, mean (least … largest) | simulated − nominal | line |\n| --- | --- | --- | --- | --- | --- | --- |\n";
        Self {
            text: text.to_owned(),
            measured,
            lines,
        }
    }

    fn row(&mut self, name: &str, names: &[&str], nominal: f64, simulated: f64, line: Option<usize>) {
        let own: Vec<&Characteristic> = names.iter().filter_map(|name| self.measured.get(*name)).collect();
        let means: Vec<f64> = own.iter().map(|one| one.mean()).collect();
        let all = own.iter().flat_map(|one| &one.values).copied();
        let (least, largest) = (
            all.clone().fold(f64::INFINITY, f64::min),
            all.fold(f64::NEG_INFINITY, f64::max),
        );
        let mean = means.iter().sum::<f64>() / means.len() as f64;
        let short: Vec<&str> = names
            .iter()
            .map(|name| name.rsplit(' ').next().unwrap_or(name))
            .collect();
        let kind = names
            .first()
            .map_or("", |name| name.rsplit_once(' ').map_or(*name, |(kind, _)| kind));
        let line = line.filter(|_| (simulated - nominal).abs() > FAR);
        let line = line.map_or(String::new(), |line| {
            format!("{line}: `{}`", self.lines[line - 1].trim())
        });
        let _ = writeln!(
            self.text,
            "| {name} | {kind} {} | {nominal} | {simulated:.3} | {mean:.3} ({least:.3} … {largest:.3}) | {:+.3} | {line} |",
            short.join(", "),
            simulated - nominal
        );
    }
}
