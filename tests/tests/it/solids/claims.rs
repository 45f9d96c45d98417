//! What is said of a solid, measured in the file.

use super::{job, kinds, outputs, path, solid};
use sweepsim_dexel::DistanceTo;
use sweepsim_formats::{parse_step, read_tri_dexels};
use sweepsim_job::Output;

/// Every end of a dexel is on the surfaces of the file, within the tolerance.
#[test]
fn ends_of_dexels_are_on_the_surfaces() {
    let slot = path(&[
        [15.0, 20.0, 30.0],
        [15.0, 14.0, 12.0],
        [45.0, 26.0, 12.0],
        [45.0, 26.0, 30.0],
    ]);
    let (memory, _) = outputs(
        &job("1: Ball(radius: 5, length: 30)", &slot),
        &[Output::Step, Output::Tridexels],
    );
    let part = parse_step(&memory.0["part.step"], 0.02).unwrap();
    let near = DistanceTo::new(&part.mesh.soup().unwrap())
        .unwrap()
        .with_surfaces(part.surfaces());
    let dexels = read_tri_dexels(&mut &memory.0["part.tridexels"][..]).unwrap();
    let (_, ends) = dexels.surface_with_ends().unwrap();
    let (mut cut, mut farthest) = (0, 0.0_f64);
    for end in ends.ends.iter().filter(|end| end.source.is_cut()) {
        farthest = farthest.max(near.nearest(end.place).unwrap().distance.abs());
        cut += 1;
    }
    assert!(cut > 500 && farthest < 1e-4, "{cut} {farthest}");
    // Triangles alone are not as near.
    let chords = DistanceTo::new(&part.mesh.soup().unwrap()).unwrap();
    let off = ends
        .ends
        .iter()
        .map(|end| chords.nearest(end.place).unwrap().distance.abs());
    assert!(off.fold(0.0, f64::max) > 1e-3);
}

/// Where sheets fold, faces are not found: triangles keep the solid closed, and are said.
#[test]
fn folds_of_five_axis_sheets_are_triangles() {
    let tilted = "Path(tool: 1, poses: [((-10, 20, 12), (0, 0, 1)), ((30, 20, 11), (0.2, 0.1, 1)), ((70, 20, 12), (0, -0.2, 1))])";
    let (part, note) = solid(&job("1: Flat(radius: 5, length: 30)", tilted).replace("(80, 55)", "(26, 18)"));
    let faces = kinds(&part);
    // Many more planes than the block's: the sides, and the top in two.
    assert!(faces["plane"] > 100 && note.contains("triangles are "), "{note}");
    let [body] = &part.bodies[..] else {
        panic!("{} bodies", part.bodies.len())
    };
    let triangles = part.mesh.soup().unwrap();
    assert_eq!(triangles.check_closed(), Ok(()));
    let volume = body.volume.unwrap();
    assert!(
        (volume - triangles.volume()).abs() < 5.0 && volume < 35_000.0,
        "{volume}"
    );
}

/// The same bytes every time, whatever the number of threads.
#[test]
fn a_file_is_the_same_every_time() {
    let slot = path(&[
        [15.0, 20.0, 30.0],
        [15.0, 14.0, 12.0],
        [45.0, 26.0, 10.0],
        [45.0, 26.0, 30.0],
    ]);
    let text = job("1: Bull(radius: 5, corner: 1, length: 30)", &slot);
    let make = || outputs(&text, &[Output::Step]).0.0["part.step"].clone();
    let one = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap()
        .install(make);
    assert_eq!(one, make());
}

#[test]
fn nothing_left_is_said() {
    use sweepsim_job::{Memory, Request, Task};
    let all = "Job(grid: Grid(min: (0, 0), max: (10, 10), cells: (20, 20)), stock: Block(min: (1, 1, 0), max: (9, 9, 2)), \
               tools: { 1: Flat(radius: 20, length: 30) }, paths: [Path(tool: 1, poses: [((-30, 5, -1), (0, 0, 1)), ((40, 5, -1), (0, 0, 1))])])";
    let plan = Request::from_job("all.ron", all)
        .task(Task::Simulate)
        .outputs([Output::Step])
        .plan();
    let outcome = plan.unwrap().run(&()).unwrap();
    let mut memory = Memory::default();
    let error = outcome
        .write_to(&mut memory, &[Output::Step], &())
        .unwrap_err()
        .to_string();
    assert!(error.contains("part.step") && error.contains("no material"), "{error}");
    assert!(memory.0.is_empty());
}
