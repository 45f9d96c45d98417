//! STEP files: shapes whose measures are known, and files with a fault.

mod faults;
mod seams;
mod surfaces;
mod writer;

use std::f64::consts::PI;
use std::fs;

use sweepsim_formats::{Job, STEP_SHARE, StepPart, parse_step, read_coloured_mesh_file, read_mesh_file};
use writer::Writer;

const CHORD: f64 = 0.01;

fn read(text: &str) -> StepPart {
    let part = parse_step(text.as_bytes(), CHORD).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(part.face_of.len(), part.mesh.triangles.len());
    part
}

fn bounds(part: &StepPart) -> [[f64; 3]; 2] {
    let mut range = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for vertex in &part.mesh.vertices {
        for k in 0..3 {
            range[0][k] = range[0][k].min(vertex[k]);
            range[1][k] = range[1][k].max(vertex[k]);
        }
    }
    range
}

fn block(min: [f64; 3], max: [f64; 3]) -> String {
    let mut file = Writer::new(false);
    let faces = file.block_faces(min, max);
    let solid = file.solid("block", &faces);
    file.product("part", &[solid]);
    file.text()
}

#[test]
fn a_block_is_twelve_triangles() {
    let part = read(&block([1.0, 2.0, 3.0], [11.0, 22.0, 33.0]));
    assert_eq!(part.mesh.triangles.len(), 12);
    let soup = part.mesh.soup().unwrap();
    soup.check_closed().unwrap();
    assert!((soup.volume() - 6000.0).abs() < 1e-9);
    assert_eq!(bounds(&part), [[1.0, 2.0, 3.0], [11.0, 22.0, 33.0]]);
    assert_eq!(
        (part.unit, part.schemas.as_slice()),
        (1.0, &["AUTOMOTIVE_DESIGN".to_owned()][..])
    );
    let [body] = &part.bodies[..] else {
        panic!("{:?}", part.bodies)
    };
    assert_eq!(
        (body.name.as_str(), body.solid, body.faces["plane"]),
        ("part/block", true, 6)
    );
    assert!((body.volume.unwrap() - 6000.0).abs() < 1e-6);
    // Each face keeps its name and its place: the triangles of `top` are at the top.
    let tops = part
        .face_of
        .iter()
        .zip(&part.mesh.triangles)
        .filter(|(face, _)| part.faces[**face as usize].name.as_deref() == Some("top"));
    let heights: Vec<f64> = tops
        .flat_map(|(_, t)| t.map(|v| part.mesh.vertices[v as usize][2]))
        .collect();
    assert_eq!(heights, [33.0; 6]);
    assert!(part.notes.is_empty(), "{:?}", part.notes);
}

/// A plate of 40 × 30 × 10 with a hole of radius 8 and a pin of radius 5 that stands on it as a second solid.
fn plate(inches: bool) -> Writer {
    let mut file = Writer::new(inches);
    let mut faces = file.block_faces([0.0; 3], [40.0, 30.0, 10.0]);
    let pin = file.cylinder_faces([20.0, 15.0, 10.0], 5.0, 7.0);
    file.colour(faces[5], [1.0, 0.5, 0.0]);
    let pin = file.solid("pin", &pin);
    file.colour(pin, [0.0, 0.0, 1.0]);
    faces.rotate_left(2);
    let plate = file.solid("plate", &faces);
    file.product("both", &[plate, pin]);
    file
}

#[test]
fn a_cylinder_is_as_near_as_asked() {
    let text = plate(false).text();
    let mut before = 0.0;
    for chord in [0.1, 0.01, 0.001, 0.0001] {
        let part = parse_step(text.as_bytes(), chord).unwrap();
        let soup = part.mesh.soup().unwrap();
        soup.check_closed().unwrap();
        assert!(part.deviation <= chord, "{chord}: {}", part.deviation);
        // Every corner is on the cylinder, and every edge of the side no farther inside than the chord error.
        let mut sides = 0;
        for (triangle, face) in soup.triangles.iter().zip(&part.face_of) {
            if part.faces[*face as usize].kind != "cylinder" {
                continue;
            }
            sides += 1;
            let radius = |p: [f64; 3]| (p[0] - 20.0).hypot(p[1] - 15.0);
            for k in 0..3 {
                let [a, b] = [triangle[k], triangle[(k + 1) % 3]];
                assert!((radius(a) - 5.0).abs() < 1e-9);
                let middle = radius([0, 1, 2].map(|k| 0.5 * (a[k] + b[k])));
                assert!(
                    (5.0 - chord * (1.0 + 1e-9)..=5.0 + 1e-9).contains(&middle),
                    "{chord}: {middle}"
                );
            }
        }
        assert!(sides > 20, "{sides}");
        let exact = 40.0 * 30.0 * 10.0 + PI * 25.0 * 7.0;
        let missing = exact - soup.volume();
        assert!(
            missing > 0.0 && missing < 2.0 * PI * 5.0 * 7.0 * chord,
            "{chord}: {missing}"
        );
        assert!(before < soup.volume(), "finer is larger");
        before = soup.volume();
        let exact: f64 = part.bodies.iter().filter_map(|body| body.volume).sum();
        assert!((exact - 12_549.778_714_378_214).abs() < 1e-3, "{exact}");
    }
}

#[test]
fn faces_have_their_colour_or_that_of_their_body() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("part.stp");
    fs::write(&file, plate(false).text()).unwrap();
    let (mesh, colours) = read_coloured_mesh_file(&file).unwrap();
    assert_eq!(mesh.triangles.len(), colours.len());
    let mut seen = [0; 3];
    for (triangle, colour) in mesh.triangles.iter().zip(&colours) {
        let corners = triangle.map(|v| mesh.vertices[v as usize]);
        let expected = if corners.iter().any(|p| p[2] > 10.0)
            || corners
                .iter()
                .all(|p| p[2] == 10.0 && (p[0] - 20.0).hypot(p[1] - 15.0) < 6.0)
        {
            seen[0] += 1;
            Some([0, 0, 255])
        } else if corners.iter().all(|p| p[2] == 10.0) {
            seen[1] += 1;
            Some([255, 128, 0])
        } else {
            seen[2] += 1;
            None
        };
        assert_eq!(*colour, expected, "{corners:?}");
    }
    assert!(seen[0] > 20 && seen[1..] == [2, 10], "{seen:?}");
}

/// An assembly in inches: a block of 1 × 2 × 3 twice, once turned by 90° about z, and once more in an assembly of its
/// own.
fn assembly() -> Writer {
    let mut file = Writer::new(true);
    let faces = file.block_faces([0.0; 3], [1.0, 2.0, 3.0]);
    let solid = file.solid("", &faces);
    let part = file.product("brick", &[solid]);
    let inner = file.product("inner", &[]);
    let outer = file.product("outer", &[]);
    let (z, x, y) = ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let straight = file.placement([10.0, 0.0, 0.0], z, x);
    file.occurrence(part, outer, straight);
    let turned = file.placement([0.0, 10.0, 0.0], z, y);
    file.occurrence(part, inner, turned);
    let raised = file.placement([0.0, 0.0, 100.0], z, x);
    file.occurrence(inner, outer, raised);
    file
}

#[test]
fn assemblies_in_inches_are_placed_in_millimetres() {
    let part = read(&assembly().text());
    assert_eq!(part.unit, 25.4);
    let names: Vec<&str> = part.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["outer/brick", "outer/inner/brick"]);
    let soup = part.mesh.soup().unwrap();
    soup.check_closed().unwrap();
    assert!((soup.volume() - 2.0 * 6.0 * 25.4_f64.powi(3)).abs() < 1e-6);
    // The turned one reaches from x −2 to 0, y 10 to 11 and z 100 to 103.
    let expected = [[-2.0, 0.0, 0.0], [11.0, 11.0, 103.0]].map(|p| p.map(|c| 25.4 * c));
    for (found, expected) in bounds(&part).iter().flatten().zip(expected.iter().flatten()) {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
}

#[test]
fn voids_are_hollow() {
    let mut file = Writer::new(false);
    let (outer, inner) = (
        file.block_faces([0.0; 3], [10.0; 3]),
        file.block_faces([2.0; 3], [5.0; 3]),
    );
    let (outer, inner) = (file.shell(true, &outer), file.shell(true, &inner));
    let inner = file.add(&format!("ORIENTED_CLOSED_SHELL('',*,#{inner},.F.)"));
    let solid = file.add(&format!("BREP_WITH_VOIDS('it''s, (hollow)',#{outer},(#{inner}))"));
    file.product("", &[solid]);
    let part = read(&file.text());
    let soup = part.mesh.soup().unwrap();
    soup.check_closed().unwrap();
    assert!((soup.volume() - 973.0).abs() < 1e-9, "{}", soup.volume());
    assert_eq!(part.bodies[0].name, "it's, (hollow)");
    assert_eq!(part.bodies[0].faces["plane"], 12);
}

/// Wherever a mesh is read: as stock, target and fixture of a job, whose units say nothing about it.
#[test]
fn jobs_read_them_in_their_own_unit() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("brick.step"), assembly().text()).unwrap();
    fs::write(folder.path().join("pin.stp"), plate(false).text()).unwrap();
    let job = "Job(units: Inch, grid: Grid(min: (0, 0), max: (1, 1), cells: (4, 5)), stock: Mesh(\"brick.step\"),
        tools: { 1: Ball(radius: 2.0, length: 30.0) }, paths: [Path(tool: 1, poses: [((0, 0, 9), (0, 0, 1)), ((9, 9, 3), (1, 0, 1))])],
        fixtures: [Mesh(\"pin.stp\")], target: Mesh(\"pin.stp\"),
        limits: Limits(gouge: 0.001, excess: 0.01, regions: [Region(name: \"seat\", colour: \"#ff8000\", gouge: 0.0005, excess: 0.01)]))";
    let file = folder.path().join("job.ron");
    fs::write(&file, job).unwrap();
    let job = Job::read(&file).unwrap_or_else(|error| panic!("{error}"));
    let sweepsim_dexel::Stock::Mesh(stock) = &job.stock else {
        panic!()
    };
    assert!((stock.volume() - 12.0 * 25.4_f64.powi(3)).abs() < 1e-6);
    let target = job.target.as_ref().unwrap();
    // The smallest limit is that of the region.
    let chord = STEP_SHARE * 0.0005 * 25.4;
    let expected = read_at(&folder.path().join("pin.stp"), chord);
    assert_eq!(target.mesh, expected.mesh.soup().unwrap());
    assert!(target.mesh.triangles.len() > read_mesh_file(&folder.path().join("pin.stp")).unwrap().triangles.len());
    let seat = &target.by_region(job.limits.as_ref().unwrap())[1];
    assert!((seat.triangles.len(), seat.triangles[0][0][2]) == (2, 10.0), "{seat:?}");
    let notes: Vec<String> = job.notes.iter().map(ToString::to_string).collect();
    assert_eq!(notes.len(), 3, "{notes:?}");
    assert!(
        notes
            .iter()
            .any(|note| note.contains("line 1: the stock brick.step: the largest distance")),
        "{notes:?}"
    );
    assert!(
        notes.iter().any(|note| note.contains("line 3: the target pin.stp:")),
        "{notes:?}"
    );
}

fn read_at(file: &std::path::Path, chord: f64) -> StepPart {
    sweepsim_formats::read_step(file, chord).unwrap()
}
