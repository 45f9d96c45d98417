//! The first job of the README against its own part, and what is said where something is not known.

use sweepsim_job::dexel::TriangleSoup;
use sweepsim_job::{Directions, Request, StatementState, Task};

#[test]
fn what_is_open_has_a_reason_or_places() {
    let job = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/jobs/quickstart.ron");
    let request = || Request::from_file(job).cells([45, 30]).directions(Directions::Z);
    let run = |request: Request| request.plan().unwrap().run(&()).unwrap();
    let mesh = run(request().task(Task::Simulate)).mesh(&()).unwrap();
    let corner = |number: &u32| mesh.vertices[*number as usize];
    let triangles = mesh.triangles.iter().map(|own| [0, 1, 2].map(|k| corner(&own[k])));
    let part = TriangleSoup {
        triangles: triangles.collect(),
    };
    let (mut open, mut proven) = (0, 0);
    for [gouge, excess] in [[1.0, 2.0], [0.53, 1.27], [0.535, 1.29]] {
        let judged = run(request().target(part.clone()).limits(gouge, excess));
        for statement in judged.report().statements.as_ref().unwrap() {
            match statement.state {
                StatementState::Open => {
                    let is_said = statement.reason.is_some() || statement.open_count > 0 && !statement.open.is_empty();
                    assert!(is_said, "{gouge} {excess}: {statement:?}");
                    open += 1;
                }
                StatementState::Proven => proven += 1,
                _ => {}
            }
        }
    }
    assert!(proven > 0, "{open}");
}
