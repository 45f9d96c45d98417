//! Programs of a Siemens 840D, made by a CAM system for a machine whose B and C axes carry the part (doi
//! 10.5281/zenodo.15735480).

use super::folder;
use sweepsim_motion::TipCourse;
use sweepsim_nc::{EventKind, Program, ProgramPose, ReadOptions, read_file};

struct Known {
    name: &'static str,
    poses: usize,
    sections: usize,
    tools: &'static [u32],
    /// Of feed moves.
    extents: [[f64; 2]; 3],
}

fn read(name: &str) -> Program {
    let mut options = ReadOptions::default();
    options.exact_arcs = true;
    let file = folder().join("5axis/spinner_u5_840d").join(name);
    read_file(&file, &options).unwrap_or_else(|error| panic!("{error} {:#?}", error.further()))
}

fn extents(program: &Program) -> [[f64; 2]; 3] {
    std::array::from_fn(|k| {
        let along = program
            .poses
            .iter()
            .filter(|pose| !pose.rapid)
            .map(|pose| pose.pose.tip()[k]);
        along.fold([f64::MAX, f64::MIN], |[low, high], c| [low.min(c), high.max(c)])
    })
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn all_are_read() {
    for known in [
        Known {
            name: "Keychain.mpf",
            poses: 565,
            sections: 2,
            tools: &[1, 2],
            extents: [[-20.538, -4.435], [-58.0, -4.153], [-6.1835, 16.0]],
        },
        Known {
            name: "Bottle_opener.mpf",
            poses: 2673,
            sections: 3,
            tools: &[1, 2, 3],
            extents: [[-6.347, 26.003], [-7.0, 80.626], [-12.0, 14.8]],
        },
        Known {
            name: "Achskreuz.mpf",
            poses: 2517,
            sections: 24,
            tools: &[1, 2, 3, 4],
            extents: [[-64.8, 25.0], [-15.001, 65.001], [-66.001, -1.0]],
        },
    ] {
        let program = read(known.name);
        let found = extents(&program);
        assert_eq!(
            (program.poses.len(), program.sections().count()),
            (known.poses, known.sections),
            "{}",
            known.name
        );
        assert_eq!(found, known.extents, "{}", known.name);
        let changes = program.events.iter().filter_map(|event| match event.kind {
            EventKind::ToolChange(tool) => Some(tool),
            _ => None,
        });
        assert_eq!(changes.collect::<Vec<_>>(), known.tools, "{}", known.name);
        // What is left out are moves in machine coordinates, and codes that switch coolant, chips and suction.
        let rest: Vec<_> = program
            .notes
            .iter()
            .filter(|note| {
                !["machine coordinates", "is taken as T", "is not understood: ignored"]
                    .iter()
                    .any(|part| note.message.contains(part))
            })
            .collect();
        assert!(rest.is_empty(), "{rest:#?}");
    }
}

fn at(program: &Program, line: usize) -> &ProgramPose {
    program
        .poses
        .iter()
        .rfind(|pose| pose.line == line)
        .unwrap_or_else(|| panic!("no pose of line {line}"))
}

fn near(found: [f64; 3], expected: [f64; 3]) {
    let off = found
        .iter()
        .zip(expected)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    assert!(off < 1e-9, "{found:?}, expected {expected:?}");
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn poses_by_hand() {
    let program = read("Achskreuz.mpf");
    // N370 G2 X0.0 Y20. I0.0 J-7.495 from X0 Y34.99: half a circle in the plane of G54.
    let half = at(&program, 38);
    near(half.pose.tip(), [0.0, 20.0, -2.0 + 1.0]);
    let TipCourse::Arc(arc) = half.way().course else {
        panic!("{half:?}")
    };
    near(arc.centre(), [0.0, 27.495, -1.0]);
    assert!((arc.angle().abs() - std::f64::consts::PI).abs() < 1e-12);
    // B90 C0, AROT Y90: N10350, at X31 Y-15.001 Z-1. Ry(90) (x, y, z) = (z, y, −x), and the tool points along +X.
    let pose = at(&program, 1036).pose;
    near(pose.tip(), [-1.0, -15.001, -31.0]);
    near(pose.axis(), [1.0, 0.0, 0.0]);
    // B90 C90, AROT X-90, AROT Z90: Rx(−90) Rz(90) (x, y, z) = (−y, z, −x); N16030, at X12 Y46.001 Z52. The tool points
    // along +Y.
    let pose = at(&program, 1604).pose;
    near(pose.tip(), [-46.001, 52.0, -12.0]);
    near(pose.axis(), [0.0, 1.0, 0.0]);
    // In every turned frame the tool points along the frame's z: planes and axes were written independently by the CAM
    // system.
    let directions = |pose: &ProgramPose| pose.pose.axis().map(|c| (c * 2.0).round() / 2.0);
    assert!(program.poses.iter().any(|pose| directions(pose) == [-0.5, -0.5, 0.0]));
}
