//! The first job of the README, and a corner of a shop's plate.

use super::{kinds, outputs};
use std::collections::BTreeMap;
use std::path::Path;
use sweepsim_formats::{StepPart, parse_step};
use sweepsim_job::{Outcome, Output, Request, Task};

#[test]
fn quickstart_on_very_coarse_lines() {
    let (faces, _) = quickstart([20, 14]);
    assert!(faces.contains_key("B-spline surface"), "{faces:?}");
}

/// On coarse lines, faces with edges too far from them for readers become triangles.
#[test]
#[ignore = "slow: thirty seconds"]
fn quickstart_on_coarse_and_usual_lines() {
    for cells in [[60, 40], [75, 50]] {
        let (faces, off) = quickstart(cells);
        assert!(faces["B-spline surface"] >= 5 && off < 5e-3, "{faces:?} {off}");
        // Where the groove ends, the last place of the ball.
        assert!(faces.contains_key("sphere"), "{faces:?}");
    }
}

/// What the tools sweep, on lines 1 mm apart: sides of triangles without width become several edges, not in a plane.
#[test]
#[ignore = "slow: fifteen seconds"]
fn sweep_of_the_quickstart_on_coarse_lines() {
    let (part, outcome) = read_back("quickstart.ron", Task::Sweep, [60, 40]);
    let faces = kinds(&part);
    assert!(faces["cylinder"] >= 4 && faces["plane"] > 1000, "{faces:?}");
    let volume: f64 = part.bodies.iter().map(|body| body.volume.unwrap()).sum();
    let dexels = outcome.part().volume();
    assert!((volume - dexels).abs() < 5e-3 * dexels, "{volume} {dexels}");
}

/// The solid of a job among the fixtures.
fn read_back(job: &str, task: Task, cells: [usize; 2]) -> (StepPart, Outcome) {
    let job = format!("{}/../fixtures/jobs/{job}", env!("CARGO_MANIFEST_DIR"));
    let request = Request::from_file(job).task(task).cells(cells).outputs([Output::Step]);
    let outcome = request.plan().unwrap().run(&()).unwrap();
    let mut memory = sweepsim_job::Memory::default();
    outcome.write_to(&mut memory, &[Output::Step], &()).unwrap();
    (parse_step(&memory.0["part.step"], 0.05).unwrap(), outcome)
}

/// A pocket, and a groove for five axes: the faces, and how far the volume is from that of the dexels.
fn quickstart(cells: [usize; 2]) -> (BTreeMap<&'static str, usize>, f64) {
    let (part, outcome) = read_back("quickstart.ron", Task::Simulate, cells);
    let faces = kinds(&part);
    assert!(faces["cylinder"] >= 3 && faces["plane"] > 200, "{faces:?}");
    let [body] = &part.bodies[..] else {
        panic!("{} bodies", part.bodies.len())
    };
    let (volume, dexels) = (body.volume.unwrap(), outcome.part().volume());
    (faces, (volume - dexels).abs() / dexels)
}

/// Holes, a countersink and slots, as a CAM system wrote them in inches.
#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn corner_of_a_plate() {
    let program = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/shop/nist_smstestbed/plate-1.nc");
    let flat = [(15, 38.1), (3, 6.35), (4, 3.175), (5, 1.5875), (1, 1.1811)];
    let tools = flat.map(|(number, radius)| format!("{number}: Flat(radius: {radius}, length: 40)"));
    let drills = [(7, 6.35), (23, 1.5875)].map(|(number, r): (u32, f64)| {
        format!("{number}: Profile(start: (0, 0), segments: [Line(({r}, {r})), Line(({r}, 40)), Line((0, 40))])")
    });
    let job = format!(
        "Job(grid: Grid(min: (-1, -78), max: (32, -42), cells: (60, 66)), stock: Block(min: (0, -77, -5), max: (31, -43, 0)), \
         tools: {{ {}, {} }}, paths: [Path(file: {program:?})])",
        tools.join(", "),
        drills.join(", ")
    );
    let (memory, notes) = outputs(&job, &[Output::Step]);
    let part = parse_step(&memory.0["part.step"], 0.05).unwrap();
    let faces = kinds(&part);
    assert!(faces["cylinder"] >= 6 && faces["cone"] >= 2, "{faces:?}");
    let note = notes.iter().find(|note| note.starts_with("part.step")).unwrap();
    let share = note.split("triangles are ").nth(1).map_or(0.0, |rest| {
        rest.split(' ')
            .next()
            .and_then(|number| number.parse().ok())
            .unwrap_or(100.0)
    });
    assert!(share < 2.0, "{note}");
}
