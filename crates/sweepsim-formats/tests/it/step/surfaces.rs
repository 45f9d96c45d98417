//! Faces with their names and surfaces: distances from what a file describes, and limits by face.

use super::writer::Writer;
use super::{block, read_at};
use std::fs;
use sweepsim_dexel::{AnalyticSurface, DistanceTo};
use sweepsim_formats::{Job, RegionPlace, parse_step};

/// A bar of 5 mm in radius, with triangles that are 0.2 mm from it, measures 5.0000 anywhere.
#[test]
fn a_coarse_bar_is_as_round_as_its_file_says() {
    let mut file = Writer::new(false);
    let faces = file.cylinder_faces([1.0, 2.0, -3.0], 5.0, 8.0);
    let solid = file.solid("bar", &faces);
    file.product("part", &[solid]);
    let part = parse_step(file.text().as_bytes(), 0.2).unwrap();
    let side = part.faces.iter().find(|face| face.is_called("side")).unwrap();
    let Some(AnalyticSurface::Cylinder { origin, axis, radius }) = side.surface else {
        panic!("{side:?}")
    };
    assert_eq!((origin[0], origin[1], axis, radius), (1.0, 2.0, [0.0, 0.0, 1.0], 5.0));
    let soup = part.mesh.soup().unwrap();
    let coarse = DistanceTo::new(&soup).unwrap();
    let exact = coarse.clone().with_surfaces(part.surfaces());
    let mut worst = [0.0_f64; 2];
    for n in 0..500 {
        let turn = f64::from(n) * 0.7;
        let p = [
            1.0 + 5.0 * turn.cos(),
            2.0 + 5.0 * turn.sin(),
            -2.0 + 0.012 * f64::from(n),
        ];
        for (tree, worst) in [&coarse, &exact].into_iter().zip(&mut worst) {
            *worst = worst.max(tree.nearest(p).unwrap().distance.abs());
        }
    }
    assert!(worst[0] > 0.03 && worst[1] < 1e-12, "{worst:?}");
    // Above the top, its plane counts.
    assert!((exact.nearest([1.0, 2.5, 6.5]).unwrap().distance - 1.5).abs() < 1e-12);
}

/// A washer whose top is crowned: part of a torus with a minor radius of 10 and a major one of 2, on the far side of
/// its axis.
#[test]
fn a_torus_that_meets_itself_is_read() {
    let height = |r: f64| (100.0 - (r + 2.0).powi(2)).sqrt();
    for kind in [
        "TOROIDAL_SURFACE('',#{},2.0,10.0)",
        "DEGENERATE_TOROIDAL_SURFACE('',#{},2.0,1.0E1,.F.)",
    ] {
        let mut file = Writer::new(false);
        let places = [[1.0, 5.0], [3.0, 5.0], [1.0, height(1.0)], [3.0, height(3.0)]].map(|[r, z]| [r, 0.0, z]);
        let vertices = places.map(|place| file.vertex(place));
        let circles: [usize; 4] =
            std::array::from_fn(|k| file.circle(vertices[k], [0.0, 0.0, places[k][2]], places[k][0]));
        let [inner, outer] = [0, 1].map(|k| file.line([vertices[k], vertices[k + 2]], [places[k], places[k + 2]]));
        let placement = file.placement([-2.0, 0.0, 0.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]);
        let arc = file.add(&format!("CIRCLE('',#{placement},10.0)"));
        let arc = file.add(&format!("EDGE_CURVE('',#{},#{},#{arc},.T.)", vertices[3], vertices[2]));
        let upright = file.placement([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
        let [hole, side] = [1.0, 3.0].map(|radius| file.add(&format!("CYLINDRICAL_SURFACE('',#{upright},{radius:?})")));
        let under = file.plane([0.0, 0.0, 5.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]);
        // What lies ahead need not be across the axis.
        let far = file.placement([0.0; 3], [0.0, 0.0, 2.0], [-1.0, 0.0, 0.4]);
        let crown = file.add(&kind.replace("{}", &far.to_string()));
        let around =
            |low: usize, seam: usize, high: usize| vec![(low, true), (seam, true), (high, false), (seam, false)];
        // The normals of the torus on its far side look down, those of a cylinder outwards.
        let into = vec![(circles[2], true), (inner, false), (circles[0], false), (inner, true)];
        let (into, over) = (file.face("", hole, &[into]), around(circles[3], arc, circles[2]));
        let into = file.reversed(into);
        let over = file.face("", crown, &[over]);
        let faces = [
            into,
            file.reversed(over),
            file.face("", side, &[around(circles[1], outer, circles[3])]),
            file.face("", under, &[vec![(circles[1], false)], vec![(circles[0], true)]]),
        ];
        let solid = file.solid("washer", &faces);
        file.product("part", &[solid]);
        let part = parse_step(file.text().as_bytes(), 0.01).unwrap();
        let soup = part.mesh.soup().unwrap();
        // By rings, and the edges of the profile.
        let ring = |k: u32| {
            let r = 1.0 + 2e-4 * (f64::from(k) + 0.5);
            2e-4 * std::f64::consts::TAU * r * (height(r) - 5.0)
        };
        let truth: f64 = (0..10_000).map(ring).sum();
        let own = part.bodies[0].volume.unwrap();
        assert!((own - truth).abs() < 1e-5 * truth, "{own} {truth}");
        assert!((soup.volume() - truth).abs() < 0.01 * 80.0, "{} {truth}", soup.volume());
        assert!(part.deviation <= 0.01, "{}", part.deviation);
        let mut seen = 0;
        for (corners, face) in soup.triangles.iter().zip(&part.face_of) {
            if part.faces[*face as usize].kind == "revolved surface" {
                assert!(corners.iter().all(|[x, y, z]| (z - height(x.hypot(*y))).abs() < 1e-9));
                seen += 1;
            }
        }
        assert!(seen > 50, "{seen}");
    }
}

/// Faces of placed parts are where the part is: all six planes of a block in an assembly, in inches.
#[test]
fn surfaces_are_placed_with_their_bodies() {
    let part = parse_step(super::assembly().text().as_bytes(), 0.01).unwrap();
    let soup = part.mesh.soup().unwrap();
    let surfaces = part.surfaces();
    let mut seen = 0;
    for (number, corners) in soup.triangles.iter().enumerate() {
        let surface = surfaces.of_triangle(number).unwrap();
        for p in corners {
            // Corners are on edges, so on the surfaces; numbers of the file are in inches.
            let (distance, _) = surface.distance(*p).unwrap();
            assert!(distance.abs() < 1e-9, "{distance} of {surface:?}");
            seen += 1;
        }
    }
    assert!(seen > 50, "{seen}");
}

#[test]
fn limits_may_be_those_of_a_face() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("part.step"), block([0.0; 3], [8.0, 6.0, 4.0])).unwrap();
    let top = read_at(&folder.path().join("part.step"), 0.01);
    let top = top.faces.iter().find(|face| face.is_called("top")).unwrap();
    assert_eq!(top.label(), "top");
    let number = format!("#{}", top.entity);
    let job = |face: &str| {
        let text = format!(
            "Job(\n    stock: Block(min: (0, 0, 0), max: (8, 8, 8)),\n    tools: {{}},\n    paths: [],\n    target: Mesh(\"part.step\"),\n    \
             limits: Limits(gouge: 0.02, excess: 0.1, regions: [Region(name: \"seat\", {face}, gouge: 0.01, excess: 0)]),\n)"
        );
        Job::parse(&text, &folder.path().join("job.ron"))
    };
    for name in ["top", &number] {
        let read = job(&format!("face: \"{name}\"")).unwrap();
        let limits = read.limits.unwrap();
        assert_eq!(limits.regions[0].place, RegionPlace::Face(name.to_owned()));
        let parts = read.target.unwrap().by_region(&limits);
        assert_eq!((parts[0].triangles.len(), parts[1].triangles.len()), (10, 2), "{name}");
        assert!(parts[1].triangles.iter().flatten().all(|p| p[2] == 4.0));
    }
    let none = job("face: \"lid\"").unwrap_err().to_string();
    assert!(
        none.contains("no surface of the target is left for region seat: expected a box, a colour or a face of it"),
        "{none}"
    );
    let two = job("face: \"top\", colour: \"#ff0000\"").unwrap_err().to_string();
    assert!(
        two.contains("a region has one place: expected `within`, `colour` or `face`"),
        "{two}"
    );
}
