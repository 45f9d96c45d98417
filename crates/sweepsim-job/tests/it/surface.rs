//! Surfaces as files.

use crate::aside::made;
use std::path::Path;
use sweepsim_job::{Judging, Output, Request, Task};

/// What `simulate` writes may be the next stock, or a target; what `verify` writes is looked at.
#[test]
fn the_part_of_a_simulation_does_not_cross_itself() {
    let job = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/jobs/motions.ron");
    let crossings = |task: Task| crossings(Request::from_file(&job).task(task).cells([80, 80]));
    assert!(crossings(Task::Verify) > 0);
    assert_eq!(crossings(Task::Simulate), 0);
}

fn crossings(request: Request) -> usize {
    let mut judging = Judging::default();
    judging.proof = false;
    let outcome = request.judging(judging).plan().unwrap().run(&()).unwrap();
    let (memory, _) = made(&outcome, &[Output::Mesh]);
    let mesh = sweepsim_formats::read_ply(&memory.0["part.ply"]).unwrap();
    let soup = mesh.soup().unwrap();
    soup.check_closed().unwrap();
    soup.faults(10).len()
}

/// Beside thin slivers, what is held for a pair of triangles may make the next ones cross: a dozen times here.
#[test]
fn slivers_do_not_cross_themselves() {
    let job = "Job(
        grid: Grid(min: (20, 4), max: (44, 28), cells: (60, 60)),
        stock: Block(min: (0, 0, -15), max: (60, 40, 0)),
        tools: {1: Flat(radius: 2, length: 40)},
        paths: [Path(tool: 1, moves: [
            Start(((42.60631, 24.883219, -1.063), (0, 0, 1))),
            Arc(to: ((28.729432, 22.718541, -1.063), (0, 0, 1)), centre: (34.597814, 30.660584, -1.063), turn: Ccw),
            Line(((29.310526, 17.465263, -3.733), (0, 0, 1))),
            Arc(to: ((42.955193, 18.187271, -3.733), (0, 0, 1)), centre: (36.600919, 8.980772, -3.733), turn: Ccw),
            Line(((8.761997, 4.098012, -1.589), (0, 0, 1))),
        ])],
    )";
    assert_eq!(crossings(Request::from_job("slivers.ron", job).task(Task::Simulate)), 0);
}
