//! Programs that nobody here wrote.

mod verified;

use super::folder;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use sweepsim_nc::{Program, ReadOptions, read_file};

fn tilt(pose: &sweepsim_motion::Pose) -> f64 {
    pose.axis()[2].clamp(-1.0, 1.0).acos().to_degrees()
}

fn read(file: &Path) -> Program {
    read_file(file, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn impeller() {
    let data = folder();
    let program = read(&data.join("5axis/linuxcnc/impeller-7bl-xyzac.ngc"));
    let tilts: Vec<f64> = program.poses.iter().map(|pose| tilt(&pose.pose)).collect();
    let (low, high) = tilts
        .iter()
        .fold((f64::MAX, 0.0_f64), |(low, high), &t| (low.min(t), high.max(t)));
    println!(
        "{} poses, tilt {low}..{high}, {:#?}",
        program.poses.len(),
        program.notes
    );
    assert!((4400..=4600).contains(&program.poses.len()), "{}", program.poses.len());
    assert!(low < 1e-9 && (high - 74.49).abs() < 0.01);
    assert_eq!(program.sections().count(), 1);
    // The first cutting move, by hand from A -71.841, C -35.930.
    let pose = program.poses[2].pose;
    assert_eq!(pose.tip(), [6.302, -11.560, 27.743]);
    let (a, c) = (f64::to_radians(-71.841), f64::to_radians(-35.930));
    let axis = [c.sin() * a.sin(), c.cos() * a.sin(), a.cos()];
    assert!(
        pose.axis()
            .iter()
            .zip(axis)
            .all(|(found, expected)| (found - expected).abs() < 1e-15)
    );
    assert!(program.poses[1].rapid && !program.poses[2].rapid);
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn boats() {
    let data = folder();
    for name in ["boat-xyzac.ngc", "boat-xyzbc.ngc"] {
        let program = read(&data.join("5axis/linuxcnc").join(name));
        println!("{name}: {} poses, {:#?}", program.poses.len(), program.notes);
        assert!(program.poses.len() > 100);
        assert!(program.poses.iter().all(|pose| pose.tool == Some(1)));
        assert!(program.poses.iter().any(|pose| tilt(&pose.pose) > 1.0), "{name} tilts");
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn three_axes() {
    let data = folder();
    let mut options = ReadOptions::default();
    options.arc_tolerance = 1e-2;
    let mut poses = 0;
    let mut refused = Vec::new();
    for folder in [
        "3axis/linuxcnc",
        "3axis/camotics",
        "5axis/linuxcnc",
        "5axis/spinner_u5_840d",
    ] {
        let mut files: Vec<PathBuf> = std::fs::read_dir(data.join(folder))
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .collect();
        files.sort();
        for file in files {
            let extension = file.extension().unwrap_or_default().to_string_lossy().into_owned();
            if !["nc", "ngc", "gcode", "mpf"].contains(&extension.as_str()) {
                continue;
            }
            let name = file.file_name().unwrap().to_string_lossy().into_owned();
            match read_file(&file, &options) {
                Ok(program) => {
                    println!(
                        "{name}: {} poses in {} sections",
                        program.poses.len(),
                        program.sections().count()
                    );
                    for note in &program.notes {
                        println!("    {note}");
                    }
                    poses += program.poses.len();
                    assert!(
                        program
                            .poses
                            .windows(2)
                            .all(|pair| !pair[1].joined || pair[0].pose != pair[1].pose)
                    );
                }
                Err(error) => {
                    println!("{error}");
                    assert!(error.position().is_some(), "{error}");
                    refused.push(name);
                }
            }
        }
    }
    println!("{poses} poses");
    // A subroutine without a move, and a variable of the machine's own.
    let expected = ["428remap.ngc", "xyzab-tdr-demo.ngc"];
    assert_eq!(refused, expected);
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn meshes() {
    let data = folder();
    for (name, least) in [("Dem-target2.STL", 10), ("SupPetriLED.STL", 10)] {
        let soup = sweepsim_formats::read_stl(&data.join("3axis/solidworks_apt").join(name)).unwrap();
        assert!(soup.triangles.len() > least);
    }
}

/// All program files in a folder and below, but for tool tables, meshes and texts about them.
fn programs_below(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    entries.sort();
    for path in entries {
        let extension = path
            .extension()
            .unwrap_or_default()
            .to_string_lossy()
            .to_ascii_lowercase();
        if path.is_dir() {
            programs_below(&path, found);
        } else if matches!(extension.as_str(), "nc" | "ngc" | "gcode" | "mpf" | "apt" | "txt") {
            found.push(path);
        }
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn every_program_is_read_or_says_why_not() {
    let data = folder();
    let (mut read, mut poses) = (0, 0);
    let mut refused: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for part in ["3axis", "5axis"] {
        let mut files = Vec::new();
        programs_below(&data.join(part), &mut files);
        for file in files {
            match read_file(&file, &ReadOptions::default()) {
                Ok(program) => {
                    read += 1;
                    poses += program.poses.len();
                }
                Err(error) => {
                    println!("{error}");
                    let name = file.file_name().unwrap().to_string_lossy().into_owned();
                    refused.entry(error.problem().to_string()).or_default().push(name);
                }
            }
        }
    }
    println!("{read} read, {poses} poses");
    let reasons = [
        // A variable of the machine's kinematics.
        ("#<_hal[xyzab_tdr_kins.x-rot-point]> has no value here", 1),
        // Tables in the literature's own formats.
        ("the content of this path file is not recognised", 2),
        // A subroutine that only switches the kinematics.
        ("this program has no move", 1),
    ];
    assert_eq!(refused.len(), reasons.len(), "{refused:#?}");
    for ((why, files), (reason, count)) in refused.iter().zip(reasons) {
        assert!(why.starts_with(reason) && files.len() == count, "{why}: {files:?}");
    }
    assert_eq!(read, 69);
}

/// What is known of the G-code programs: poses, sections, rapids, events, and the corners of the box that the tip stays
/// in, in mm. The corners were checked against the words in the files; poses depend on the chords of arcs, which are
/// within 0.01 mm.
#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn what_is_known_of_programs() {
    type Known = (&'static str, [usize; 4], [f64; 3], [f64; 3]);
    const KNOWN: [Known; 12] = [
        (
            "camotics/bear.nc",
            [15_156, 1, 4, 2],
            [0.0, 0.0, -17.368],
            [79.999, 79.998, 20.0],
        ),
        (
            "camotics/botomata_bottom.nc",
            [12_224, 3, 550, 51],
            [-44.132, -145.732, -20.0],
            [44.132, 44.132, 2.0],
        ),
        (
            "camotics/engrave.ngc",
            [2102, 1, 7, 14],
            [-36.22, -25.97, 0.0],
            [34.86, 25.61, 25.0],
        ),
        (
            "camotics/flower_mold.nc",
            [16_557, 1, 4, 1],
            [0.0, 0.0, -9.235],
            [57.125, 57.099, 5.08],
        ),
        (
            "camotics/slant_test.nc",
            [18, 1, 10, 0],
            [0.0, 0.0, -5.0],
            [10.0, 10.0, 1.0],
        ),
        (
            "camotics/vcarve.ngc",
            [3735, 1, 119, 0],
            [-1.648, 0.0, -0.411],
            [12.271, 4.834, 2.54],
        ),
        (
            "linuxcnc/Cereal.ngc",
            [2428, 1, 52, 2],
            [-96.382, -36.282, -4.057],
            [97.789, 0.0, 100.0],
        ),
        (
            "linuxcnc/LHchips4.ngc",
            [12_581, 1, 70, 5],
            [-7.413, -6.959, -37.0],
            [75.516, 107.503, 60.0],
        ),
        (
            "linuxcnc/arcspiral.ngc",
            [2218, 1, 3, 1],
            [-49.476, -50.274, -2.54],
            [47.879, 48.678, 25.4],
        ),
        (
            "linuxcnc/circle_small_segments_ncd.ngc",
            [10_001, 1, 1, 0],
            [-25.4, -25.4, 0.0],
            [25.4, 25.4, 0.0],
        ),
        (
            "linuxcnc/trochoidal.ngc",
            [11_351, 1, 11, 0],
            [-34.071, 0.0, -1.0],
            [59.071, 108.568, 5.0],
        ),
        (
            "linuxcnc/zigzag_0.002_0.001.ngc",
            [2002, 1, 2, 0],
            [0.0, -0.0254, 0.0],
            [101.6, 0.0254, 0.0],
        ),
    ];
    let mut options = ReadOptions::default();
    options.arc_tolerance = 1e-2;
    for (name, counts, low, high) in KNOWN {
        let program = read_file(&folder().join("3axis").join(name), &options).unwrap_or_else(|error| panic!("{error}"));
        let rapids = program.poses.iter().filter(|pose| pose.rapid).count();
        let found = [
            program.poses.len(),
            program.sections().count(),
            rapids,
            program.events.len(),
        ];
        assert_eq!(found, counts, "{name}");
        for k in 0..3 {
            let along = program.poses.iter().map(|pose| pose.pose.tip()[k]);
            let (least, most) = along.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
            assert!(
                (least - low[k]).abs() < 1e-3 && (most - high[k]).abs() < 1e-3,
                "{name} {k}: {least} {most}"
            );
        }
    }
}

/// Stages of a program with three tools and two work offsets, which it sets itself.
#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn botomata() {
    let program = read(&folder().join("3axis/camotics/botomata_bottom.nc"));
    let changes: Vec<u32> = program
        .events
        .iter()
        .filter_map(|event| match event.kind {
            sweepsim_nc::EventKind::ToolChange(tool) => Some(tool),
            _ => None,
        })
        .collect();
    let mut tools: Vec<u32> = program.poses.iter().filter_map(|pose| pose.tool).collect();
    tools.dedup();
    assert_eq!(tools, [1, 2, 3]);
    assert!(changes.starts_with(&[1]) && changes.ends_with(&[3]), "{changes:?}");
    assert!(program.poses.iter().all(|pose| pose.call.is_none()));
}
