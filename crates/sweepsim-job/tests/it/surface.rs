//! Surfaces as files.

use crate::aside::made;
use std::path::Path;
use sweepsim_job::{Judging, Output, Request, Task};

/// What `simulate` writes may be the next stock, or a target; what `verify` writes is looked at.
#[test]
fn the_part_of_a_simulation_does_not_cross_itself() {
    let job = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/jobs/motions.ron");
    let crossings = |task: Task| {
        let mut judging = Judging::default();
        judging.proof = false;
        let request = Request::from_file(&job).task(task).cells([80, 80]).judging(judging);
        let outcome = request.plan().unwrap().run(&()).unwrap();
        let (memory, _) = made(&outcome, &[Output::Mesh]);
        let mesh = sweepsim_formats::read_ply(&memory.0["part.ply"]).unwrap();
        let soup = mesh.soup().unwrap();
        soup.check_closed().unwrap();
        soup.faults(10).len()
    };
    assert!(crossings(Task::Verify) > 0);
    assert_eq!(crossings(Task::Simulate), 0);
}
