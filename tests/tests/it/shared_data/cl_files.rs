//! CL files, rows of poses and tool libraries that nobody here wrote.

use super::folder;
use std::path::PathBuf;
use sweepsim_motion::TipCourse;
use sweepsim_nc::{CutterKind, Program, ReadOptions, StockDescription, read_file, tools};

fn exact(file: &str) -> Program {
    let mut options = ReadOptions::default();
    options.exact_arcs = true;
    read_file(&folder().join("3axis/solidworks_apt").join(file), &options).unwrap_or_else(|error| panic!("{error}"))
}

/// Lower and upper corner of all poses.
fn extents(program: &Program) -> [[f64; 3]; 2] {
    let tips = program.poses.iter().map(|pose| pose.pose.tip());
    tips.fold([[f64::MAX; 3], [f64::MIN; 3]], |[low, high], tip| {
        [
            [0, 1, 2].map(|k| low[k].min(tip[k])),
            [0, 1, 2].map(|k| high[k].max(tip[k])),
        ]
    })
}

fn arcs(program: &Program) -> usize {
    program
        .poses
        .iter()
        .filter(|pose| matches!(pose.way().course, TipCourse::Arc(_)))
        .count()
}

fn text(file: &str) -> String {
    std::fs::read_to_string(folder().join("3axis/solidworks_apt").join(file)).unwrap()
}

/// What the text itself says, counted without the reader.
fn counted(file: &str, word: &str) -> usize {
    text(file).lines().filter(|line| line.starts_with(word)).count()
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn solidworks() {
    // Tools, stock, number of poses with exact arcs: by hand from the text's holes and moves.
    for (file, tools, stock) in [
        ("Dem-target2.apt", &[5, 14, 16][..], [220.0, 220.0, 24.0]),
        ("RotateThick.apt", &[15, 16, 18, 20], [313.08, 100.0, 9.0]),
        ("Sacrifice-Board.apt", &[1, 2, 11, 12], [440.0, 170.0, 30.0]),
        ("SupPetriLED.apt", &[1, 16, 17], [119.0, 119.0, 30.0]),
        ("Teflon-gasket.apt", &[2, 6, 16], [30.0, 30.0, 35.0]),
        ("Telemecanique-Tilt-Support2.apt", &[1, 3], [37.75, 30.0, 45.0]),
        ("shimemcunha.apt", &[12, 13, 16], [36.257509, 35.632301, 1.400453]),
    ] {
        let program = exact(file);
        println!(
            "{file}: {} poses, {} arcs, {:?}, {:#?}",
            program.poses.len(),
            arcs(&program),
            extents(&program),
            program.notes
        );
        assert_eq!(program.stock, Some(StockDescription::Size(stock)), "{file}");
        let used: std::collections::BTreeSet<u32> = program.poses.iter().filter_map(|pose| pose.tool).collect();
        for tool in tools {
            assert!(
                program.tools.contains_key(tool),
                "{file}: tool {tool} of {:?}",
                program.tools.keys()
            );
        }
        for (number, tool) in &program.tools {
            assert!(used.contains(number), "{file}: tool {number} is used");
            assert!(matches!(tool.kind, Some(CutterKind::Apt(_))) && tool.stick_out.is_some());
            tool.build()
                .unwrap_or_else(|error| panic!("{file}: tool {number}: {error}"));
        }
        // Each CIRCLE is one move, and each point of the text is reached.
        assert_eq!(arcs(&program), counted(file, "CIRCLE"), "{file}");
        assert_eq!(program.sections().count(), counted(file, "LOAD/TOOL"), "{file}");
        for (line, point) in text(file)
            .lines()
            .enumerate()
            .filter(|(_, line)| line.starts_with("GOTO"))
        {
            let numbers: Vec<f64> = point[5..].split(',').map(|word| word.parse().unwrap()).collect();
            let reached = program.poses.iter().any(|pose| {
                let tip = pose.pose.tip();
                (0..2).all(|k| (tip[k] - numbers[k]).abs() < 1e-9)
            });
            assert!(reached, "{file}:{}: {point}", line + 1);
        }
        // Straight and full circles: no arc is nearly a full turn without being one.
        for pose in &program.poses {
            if let TipCourse::Arc(arc) = pose.way().course {
                let rest = std::f64::consts::TAU - arc.angle().abs();
                assert!(rest.abs() < 1e-9 || rest > 1e-3, "{file}:{}: {rest}", pose.line);
            }
        }
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn poses_by_hand() {
    let program = exact("Dem-target2.apt");
    // The first hole: pecks at 5, 7, ... 23 and 24.6205 below the point.
    let hole: Vec<f64> = program
        .poses
        .iter()
        .filter(|pose| pose.line == 18 && !pose.rapid)
        .map(|pose| pose.pose.tip()[2])
        .collect();
    let by_hand: Vec<f64> = (0..10).map(|k| -5.0 - 2.0 * f64::from(k)).chain([-24.6205]).collect();
    assert_eq!(hole, by_hand);
    assert_eq!(program.poses[1].feed, None);
    assert_eq!(program.poses[2].feed, Some(670.56));
    // The part's walls lie within the path by the tool's radius, 1 mm; the drill goes around them.
    let [low, high] = extents(&program);
    assert!((low[2] - -24.6205).abs() < 1e-9 && high[2] == 25.0);
    // A face along a tilted axis: turned by CSYS, but written in the world's frame.
    let program = exact("shimemcunha.apt");
    let pose = program.poses[0].pose;
    assert_eq!(pose.tip(), [-52.364775, 15.632301, 25.448882]);
    assert!((pose.axis()[0] - 0.005061).abs() < 1e-7 && program.poses[0].rapid);
    // Full circles and their radii.
    let program = exact("SupPetriLED.apt");
    let full: Vec<f64> = program
        .poses
        .iter()
        .filter_map(|pose| match pose.way().course {
            TipCourse::Arc(arc) if (arc.angle() - std::f64::consts::TAU).abs() < 1e-9 => {
                let (tip, centre) = (pose.pose.tip(), arc.centre());
                Some((tip[0] - centre[0]).hypot(tip[1] - centre[1]))
            }
            _ => None,
        })
        .collect();
    assert!((full[0] - 5.45).abs() < 1e-9 && full.len() > 20);
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn part_programs_are_refused() {
    let folder = folder().join("tools/apt360_part_programs");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    files.sort();
    assert_eq!(files.len(), 11);
    for file in files {
        let error = read_file(&file, &ReadOptions::default()).unwrap_err();
        assert!(
            error
                .problem()
                .to_string()
                .starts_with("APT part programs, whose path follows from geometry"),
            "{error}"
        );
        assert!(error.position().is_some());
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn curved_layers() {
    let (mut files, mut poses) = (0, 0);
    for part in ["freeform", "simple_curve"] {
        for entry in std::fs::read_dir(folder().join("5axis/curved_layers").join(part)).unwrap() {
            let file = entry.unwrap().path();
            let rows = std::fs::read_to_string(&file).unwrap();
            let program = read_file(&file, &ReadOptions::default()).unwrap();
            files += 1;
            poses += program.poses.len();
            // The first row, as written.
            let first: Vec<f64> = rows
                .split_whitespace()
                .take(6)
                .map(|word| word.parse().unwrap())
                .collect();
            assert_eq!(program.poses[0].pose.tip()[..], first[..3]);
            let axis = program.poses[0].pose.axis();
            let length = first[3].hypot(first[4]).hypot(first[5]);
            assert!((0..3).all(|k| (axis[k] * length - first[3 + k]).abs() < 1e-12));
            assert!(program.poses.len() <= rows.lines().count());
            assert!(program.notes[0].message.starts_with("rows of six numbers"));
        }
    }
    println!("{files} files, {poses} poses");
    assert_eq!(
        files,
        28 - usize::from(!folder().join("5axis/curved_layers/freeform/1.txt").exists())
    );
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn freecad_library() {
    let library = tools::read_library(&folder().join("tools/freecad/Library/Default.fctl"), false).unwrap();
    assert_eq!(
        library.tools.keys().copied().collect::<Vec<_>>(),
        [1, 2, 3, 4, 5, 6, 7, 8, 9]
    );
    let mill = &library.tools[&1];
    assert_eq!(
        (mill.diameter, mill.flute_length, mill.shank_diameter),
        (Some(5.0), Some(30.0), Some(3.0))
    );
    for number in [1, 2, 3, 4, 5, 6, 7] {
        let tool = &library.tools[&number];
        let built = tool.build().unwrap_or_else(|error| panic!("{:?}: {error}", tool.name));
        assert!(built.cutter.is_revolved());
    }
    assert_eq!(library.tools[&4].corner_radius, Some(1.5));
    assert_eq!(
        (library.tools[&5].taper_angle, library.tools[&5].tip_diameter),
        (Some(30.0), Some(1.0))
    );
    // Probes and thread cutters have their envelopes, once it is known how long these are.
    for number in [8, 9] {
        let mut tool = library.tools[&number].clone();
        tool.flute_length = tool.flute_length.or(Some(10.0));
        let built = tool.build().unwrap_or_else(|error| panic!("{:?}: {error}", tool.name));
        assert!(
            built.notes.iter().any(|note| note.ends_with("its envelope")),
            "{:?}",
            built.notes
        );
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn tool_tables() {
    let table = tools::read_library(&folder().join("tools/linuxcnc/vk45_tool.tbl"), true).unwrap();
    assert_eq!(
        table.tools[&52].name.as_deref(),
        Some("1/2 4ftl, 0.03cr, tialn, 1.75stick, sk16-2")
    );
    assert!((table.offsets[&52].diameter - 0.498 * 25.4).abs() < 1e-12);
    assert!(table.tools.len() > 40, "{}", table.tools.len());
    let small = tools::read_library(&folder().join("tools/linuxcnc/cutsim_tooltable.tbl"), false).unwrap();
    assert_eq!(small.tools.keys().copied().collect::<Vec<_>>(), [1, 2, 3, 4, 5, 99999]);
    for name in ["xyzac-trt.tbl", "xyzbc-trt.tbl"] {
        tools::read_library(&folder().join("5axis/linuxcnc").join(name), false).unwrap();
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn camotics_projects() {
    let folder = folder().join("3axis/camotics");
    let mut projects: Vec<PathBuf> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "camotics"))
        .collect();
    projects.sort();
    let mut beside = 0;
    for project in &projects {
        let library = tools::read_library(project, false).unwrap();
        let Some(StockDescription::Block { min, max }) = library.stock else {
            panic!("{}", project.display())
        };
        for (number, tool) in &library.tools {
            tool.build()
                .unwrap_or_else(|error| panic!("{}: tool {number}: {error}", project.display()));
        }
        // The stock is in millimetres: the program cuts within it.
        // These bounds were stored for another version of the part, mirrored in y.
        if project.ends_with("botomata_bottom.camotics") {
            assert!(min[1] > -50.0 && max[1] > 140.0);
            continue;
        }
        let Some(program) = library
            .programs
            .first()
            .map(|name| folder.join(name))
            .filter(|file| file.exists())
        else {
            continue;
        };
        let Ok(program) = read_file(&program, &ReadOptions::default()) else {
            continue;
        };
        let cuts = program
            .poses
            .iter()
            .filter(|pose| !pose.rapid)
            .map(|pose| pose.pose.tip());
        let inside = cuts
            .clone()
            .filter(|tip| (0..2).all(|k| tip[k] > min[k] - 15.0 && tip[k] < max[k] + 15.0))
            .count();
        assert!(inside as f64 > 0.9 * cuts.count() as f64, "{}", project.display());
        beside += 1;
    }
    println!("{} projects, {beside} with their program", projects.len());
    assert!(projects.len() >= 10 && beside >= 5);
}
