//! What a request has in memory instead of in files, and cells by their size.

use sweepsim_job::dexel::{Stock, TriangleSoup};
use sweepsim_job::{CompareRequest, DialectOptions, JobError, Part, Request, Task, describe, motion::Tool};

/// Faces a block.
const PROGRAM: &str = "G21 G90\nT1 M6\nS8000 M3\nG0 X-8 Y5 Z5\nG0 Z-2\nG1 X48 F600\nG1 Y15\nG1 X-8\nG0 Z5\nM30\n";

fn facing() -> Request {
    Request::from_program("facing.nc", PROGRAM)
        .task(Task::Simulate)
        .tool(1, Tool::flat(6.0, 20.0).unwrap())
        .stock(Stock::Block {
            min: [0.0, 0.0, -10.0],
            max: [40.0, 20.0, 0.0],
        })
}

#[test]
fn cells_by_their_size_cover_the_grid() {
    let cells = |side: f64| facing().cell(side).plan().unwrap().job().grid.cells();
    assert_eq!(cells(0.5), [80, 40]);
    assert_eq!(cells(0.7), [57, 29]);
    assert_eq!(cells(1e3), [1, 1]);
    for wrong in [0.0, -1.0, f64::NAN] {
        assert!(matches!(
            facing().cell(wrong).plan(),
            Err(JobError::Request { field: "cell", .. })
        ));
    }
    assert!(facing().cell(0.5).cells([8, 8]).plan().is_err());
    let many = facing().cell(1e-9).plan().unwrap_err().to_string();
    assert!(many.starts_with("cell: "), "{many}");
}

#[test]
fn what_is_left_is_the_stock_of_the_next_program() {
    let first = facing().cells([80, 40]).plan().unwrap().run(&()).unwrap();
    let left = Stock::Dexels(first.part().clone().into());
    let second = facing().stock(left).plan().unwrap().run(&()).unwrap();
    assert_eq!(second.part().grid(), first.part().grid());
    assert!(first.report().volume_removed > Some(1000.0));
    assert!(second.report().volume_removed.unwrap().abs() < 1e-6);
}

#[test]
fn parts_in_memory_are_compared_as_those_in_files() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    let outcome = facing().cells([40, 20]).plan().unwrap().run(&()).unwrap();
    sweepsim_formats::write_dexels_file(outcome.part(), &file("part.dexels")).unwrap();
    let soup = TriangleSoup::block([0.0, 0.0, -10.0], [40.0, 20.0, -2.5]);
    sweepsim_formats::write_stl(&soup.triangles, &mut std::fs::File::create(file("target.stl")).unwrap()).unwrap();
    let target = sweepsim_formats::read_mesh_file(&file("target.stl")).unwrap();
    let mut request = CompareRequest::new(file("part.dexels"), file("target.stl"));
    request.view.size = [160, 120];
    let of_files = request.read().unwrap().compare(&()).unwrap();
    let request = request
        .with_part(Part::Dexels(outcome.part().clone()))
        .with_target(Part::Mesh(target));
    std::fs::remove_dir_all(folder.path()).unwrap();
    let mut given = request.read().unwrap().compare(&()).unwrap();
    assert!(given.report.excess_volume > 300.0);
    given.report.seconds.clone_from(&of_files.report.seconds);
    assert_eq!(given.json().unwrap(), of_files.json().unwrap());
    assert_eq!(given.picture, of_files.picture);
}

#[test]
fn a_job_stays_within_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().join("root");
    std::fs::create_dir(&root).unwrap();
    std::fs::write(folder.path().join("path.nc"), PROGRAM).unwrap();
    std::fs::write(root.join("path.nc"), PROGRAM).unwrap();
    let mut within = DialectOptions::default();
    within.within = Some(root.clone());
    let job = |path: &str| {
        let text = format!(
            "Job(stock: Block(min: (0, 0, 0), max: (9, 9, 9)), tools: {{1: Ball(radius: 1, length: 5)}}, paths: [Path(file: {path:?})])"
        );
        std::fs::write(root.join("job.ron"), text).unwrap();
        describe(&root.join("job.ron"), &within).map(drop)
    };
    job("path.nc").unwrap();
    job("../root/path.nc").unwrap();
    let JobError::Format(error) = job("../path.nc").unwrap_err() else {
        panic!("an error of the job's file")
    };
    assert_eq!(error.position().map(|position| position.line), Some(1));
    assert!(error.to_string().contains("expected a file there"), "{error}");
}

#[test]
fn a_stock_with_a_corner_that_is_nowhere_is_an_error() {
    let with = |triangle: usize, corner: usize, axis: usize, value: f64| {
        let mut soup = TriangleSoup::block([0.0, 0.0, -10.0], [40.0, 20.0, 0.0]);
        soup.triangles[triangle][corner][axis] = value;
        facing()
            .stock(Stock::Mesh(soup))
            .plan()
            .map(drop)
            .unwrap_err()
            .to_string()
    };
    let why = "a coordinate that is not finite";
    assert_eq!(
        with(3, 1, 0, f64::NAN),
        format!("stock: corner 1 of triangle 3 of the mesh has {why}: x = NaN")
    );
    assert_eq!(
        with(0, 2, 2, f64::INFINITY),
        format!("stock: corner 2 of triangle 0 of the mesh has {why}: z = inf")
    );
    // Other solids are refused where they are made into dexels, if not before.
    let block = |min: [f64; 3]| {
        let block = Stock::Block {
            min,
            max: [40.0, 20.0, 0.0],
        };
        let plan = facing().stock(block).plan();
        plan.and_then(|plan| plan.run(&()).map(drop))
    };
    assert!(block([f64::NAN, 0.0, -10.0]).is_err() && block([50.0, 0.0, -10.0]).is_err());
}
