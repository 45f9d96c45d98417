//! One part, programmed for many machines: each program is read back and cut, and the dexels are the same.

use nalgebra::{Rotation3, Vector3};
use std::fmt::Write as _;
use sweepsim::{Options, sweep};
use sweepsim_dexel::{Dexels, Grid};
use sweepsim_motion::{Path, Pose, Tool};
use sweepsim_nc::{Machine, Program, ProgramPose, ReadOptions, gcode, heidenhain, siemens, write};

/// A pass: the tilt of the tool about Y and its turn about Z, in degrees, and the tips.
type Pass = (f64, f64, Vec<[f64; 3]>);

/// Passes across a block from above and from the sides. Within a pass the tool keeps its direction.
fn passes() -> Vec<Pass> {
    let mut all = Vec::new();
    for (index, (tilt, turn)) in [(0.0, 0.0), (25.0, 40.0), (40.0, -70.0), (15.0, 130.0), (30.0, 200.0)]
        .into_iter()
        .enumerate()
    {
        let base = Vector3::new(0.0, 0.0, -1.0 - 0.3 * index as f64);
        let along = Rotation3::from_axis_angle(&Vector3::z_axis(), (50.0 * index as f64).to_radians()) * Vector3::x();
        let side = Vector3::z().cross(&along);
        let tips = [-7.0, -2.0, 3.0, 8.0].into_iter().enumerate().map(|(k, s)| {
            let point = base + along * s + side * (0.7 * k as f64 - 1.0) + Vector3::z() * (0.2 * k as f64);
            // As a program says it.
            <[f64; 3]>::from(point).map(|c| (c * 1e6).round() / 1e6)
        });
        all.push((tilt, turn, tips.collect()));
    }
    all
}

fn direction(tilt: f64, turn: f64) -> [f64; 3] {
    let ((st, ct), (sc, cc)) = (tilt.to_radians().sin_cos(), turn.to_radians().sin_cos());
    [st * cc, st * sc, ct]
}

fn pose(tip: [f64; 3], axis: [f64; 3]) -> Pose {
    Pose::new(tip, axis).expect("a pose")
}

/// The part as poses: a rapid to each pass, and feed moves along it.
fn part() -> Program {
    let mut program = Program::default();
    for (tilt, turn, tips) in passes() {
        for (k, tip) in tips.into_iter().enumerate() {
            let mut made = ProgramPose::new(pose(tip, direction(tilt, turn)), program.poses.len() + 1);
            made.rapid = k == 0;
            made.joined = !program.poses.is_empty();
            made.tool = Some(1);
            made.feed = Some(500.0);
            program.poses.push(made);
        }
    }
    program
}

/// What the feed moves of a program sweep, as the reader says that the tool moves.
fn dexels(program: &Program) -> Dexels {
    let tool = Tool::bull(2.0, 0.5, 20.0).expect("a tool");
    let grid = Grid::new([-12.0; 2], [12.0; 2], [24; 2]).expect("a grid");
    let mut all: Option<Dexels> = None;
    for run in program.poses.chunk_by(|_, next| next.joined && !next.rapid) {
        if run.len() < 2 {
            continue;
        }
        let moves = run[1..].iter().map(|pose| pose.way()).collect();
        let path = Path::with_moves(run.iter().map(|pose| pose.pose).collect(), moves).expect("a path");
        let swept = sweep(&tool, &path, &grid, &Options::default(), &()).expect("a sweep");
        assert!(swept.statistics.unresolved.is_empty());
        match &mut all {
            None => all = Some(swept.volume),
            Some(all) => all.unite_all(&swept.volume).expect("the same grid"),
        }
    }
    all.expect("feed moves")
}

/// Compares intervals; those thinner than the tolerance may be missing from either.
fn assert_same(name: &str, found: &Dexels, expected: &Dexels) {
    let tolerance = 1e-5;
    let mut compared = 0;
    for (i, j) in (0..24).flat_map(|i| (0..24).map(move |j| (i, j))) {
        let solid = |dexels: &Dexels| -> Vec<[f64; 2]> {
            let heights = dexels.intervals(i, j).heights();
            heights.filter(|[low, high]| high - low > tolerance).collect()
        };
        let (a, b) = (solid(found), solid(expected));
        assert_eq!(a.len(), b.len(), "{name}: line {i}, {j}: {a:?}, expected {b:?}");
        for (a, b) in a.iter().zip(&b) {
            let off = (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
            assert!(off < tolerance, "{name}: line {i}, {j}: {a:?}, expected {b:?}");
        }
        compared += a.len();
    }
    assert!(compared > 150, "{name}: only {compared} intervals");
}

#[test]
fn machines_tip_control_and_tilted_planes_cut_the_same_part() {
    let part = part();
    let expected = dexels(&part);
    for name in [
        "trunnion-ac",
        "trunnion-bc",
        "head-bc",
        "head-ac",
        "head-b-table-c",
        "head-a-table-c",
        "nutating-head-bc",
    ] {
        let machine = Machine::named(name).expect("a machine");
        for tip_control in [false, true] {
            let posted = write::GcodeOptions::for_machine(machine.clone(), tip_control);
            let text = write::gcode(&part, &posted).expect("within reach").text;
            let mut options = ReadOptions::default();
            options.machine = machine.clone();
            let read = gcode::read(&text, &options).unwrap_or_else(|error| panic!("{name}: {error}\n{text}"));
            assert_same(&format!("{name}, tip control {tip_control}"), &dexels(&read), &expected);
        }
    }
    // In tilted planes: the tips in the plane's coordinates.
    let (mut fanuc, mut sinumerik, mut klartext) = (
        String::from("G21 G90\n"),
        String::from("T1 D1 G90\n"),
        String::from("BEGIN PGM A MM\nTOOL CALL 1 Z S1000\n"),
    );
    for (tilt, turn, tips) in passes() {
        let rotation = |axis, degrees: f64| Rotation3::from_axis_angle(&axis, degrees.to_radians());
        let (x, y, z) = (Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis());
        let normal = direction(tilt, turn);
        let (about_x, about_y) = (
            (-normal[1]).atan2(normal[2]).to_degrees(),
            normal[0].asin().to_degrees(),
        );
        let _ = writeln!(fanuc, "G69\nG68.2 X0 Y0 Z0 I{} J{tilt} K0\nG53.1", turn + 90.0);
        let _ = writeln!(
            sinumerik,
            "CYCLE800()\nCYCLE800(0,\"\",0,57,0,0,0,{about_x:.12},{about_y:.12},0,0,0,0,1)"
        );
        let _ = writeln!(
            klartext,
            "PLANE RESET STAY\nPLANE SPATIAL SPA+0 SPB{tilt:+} SPC{turn:+} TURN FMAX"
        );
        let frames = [
            rotation(z, turn + 90.0) * rotation(x, tilt),
            rotation(x, about_x) * rotation(y, about_y),
            rotation(z, turn) * rotation(y, tilt),
        ];
        for (k, tip) in tips.iter().enumerate() {
            let [a, b, c] = frames.map(|frame| frame.inverse() * Vector3::from(*tip));
            let code = if k == 0 { "G0" } else { "G1 F500" };
            let _ = writeln!(fanuc, "{code} X{:.12} Y{:.12} Z{:.12}", a.x, a.y, a.z);
            let _ = writeln!(sinumerik, "{code} X{:.12} Y{:.12} Z{:.12}", b.x, b.y, b.z);
            let feed = if k == 0 { "FMAX" } else { "F500" };
            let _ = writeln!(klartext, "L X{:+.12} Y{:+.12} Z{:+.12} {feed}", c.x, c.y, c.z);
        }
    }
    let options = ReadOptions::default();
    for (name, read) in [
        ("G68.2", gcode::read(&fanuc, &options)),
        ("CYCLE800", siemens::read(&sinumerik, &options)),
        ("PLANE SPATIAL", heidenhain::read(&klartext, &options)),
    ] {
        let read = read.unwrap_or_else(|error| panic!("{name}: {error}\n{fanuc}{sinumerik}{klartext}"));
        assert_same(name, &dexels(&read), &expected);
    }
}
