//! Programs that nobody here wrote.

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
    // Expressions and calls.
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
        ("O-words (subroutines, loops) are not supported yet", 1),
        ("statements like `DEF` are not supported yet", 3),
        // Tables in the literature's own formats.
        ("the content of this path file is not recognised", 2),
        ("variables and expressions are not supported yet", 1),
    ];
    assert_eq!(refused.len(), reasons.len(), "{refused:#?}");
    for ((why, files), (reason, count)) in refused.iter().zip(reasons) {
        assert!(why.starts_with(reason) && files.len() == count, "{why}: {files:?}");
    }
    assert_eq!(read, 32);
}

/// LinuxCNC's own programs that must be refused.
#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn bad_programs_are_refused() {
    let mut files = Vec::new();
    programs_below(&folder().join("conformance/linuxcnc/interp/bad"), &mut files);
    let read: Vec<&str> = files
        .iter()
        .filter(|file| read_file(file, &ReadOptions::default()).is_ok())
        .filter_map(|file| file.file_name()?.to_str())
        .collect();
    assert_eq!(files.len(), 23);
    // Its path is known, although a machine would not start without a feed.
    assert_eq!(read, ["no-feed-rate.ngc"]);
}
