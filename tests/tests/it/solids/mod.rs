//! Machined parts as solids: written, and read back by the library that reads STEP files, which knows nothing of how
//! they were made. Volumes are those of closed forms; faces are counted, or a solid of triangles would pass.

mod claims;
mod fixtures;
mod free_ends;
mod parts;
mod sheets;

use std::collections::BTreeMap;
use sweepsim_formats::{StepPart, parse_step};
use sweepsim_job::{Memory, Output, Request, Task};

/// The tools along their paths in a block of 60 × 40 × 15, as a job.
fn job(tools: &str, paths: &str) -> String {
    format!(
        "Job(tolerance: 1e-4, grid: Grid(min: (-2, -2), max: (62, 42), cells: (80, 55)), \
         stock: Block(min: (0, 0, 0), max: (60, 40, 15)), tools: {{ {tools} }}, paths: [{paths}])"
    )
}

/// A path of tool 1 through these tips, upright.
fn path(tips: &[[f64; 3]]) -> String {
    let pose = |[x, y, z]: &[f64; 3]| format!("(({x}, {y}, {z}), (0, 0, 1))");
    let poses: Vec<String> = tips.iter().map(pose).collect();
    format!("Path(tool: 1, poses: [{}])", poses.join(", "))
}

/// The outputs of a job's simulation, and its notes.
fn outputs(job: &str, outputs: &[Output]) -> (Memory, Vec<String>) {
    let request = Request::from_job("part.ron", job).task(Task::Simulate);
    let outcome = request.outputs(outputs.to_vec()).plan().unwrap().run(&()).unwrap();
    let mut memory = Memory::default();
    let written = outcome.write_to(&mut memory, outputs, &()).unwrap();
    (memory, written.report.notes)
}

/// The solid of a job as a STEP file, read back.
fn solid(job: &str) -> (StepPart, String) {
    let (memory, notes) = outputs(job, &[Output::Step]);
    let note = notes.into_iter().find(|note| note.starts_with("part.step")).unwrap();
    (parse_step(&memory.0["part.step"], 0.02).unwrap(), note)
}

/// How many faces of each kind the bodies of a part have.
fn kinds(part: &StepPart) -> BTreeMap<&'static str, usize> {
    let mut all = BTreeMap::new();
    for (kind, count) in part.bodies.iter().flat_map(|body| &body.faces) {
        *all.entry(*kind).or_default() += count;
    }
    all
}

#[track_caller]
fn check(job: &str, bodies: usize, faces: &[(&'static str, usize)], volume: f64) {
    let (part, note) = solid(job);
    assert_eq!((part.unit, part.bodies.len()), (1.0, bodies));
    assert!(part.bodies.iter().all(|body| body.solid));
    assert_eq!(kinds(&part), faces.iter().copied().collect(), "{note}");
    assert!(!note.contains("triangle"), "{note}");
    let found: f64 = part.bodies.iter().map(|body| body.volume.unwrap()).sum();
    assert!((found - volume).abs() < 1e-6 * volume, "{found} {volume}");
}
