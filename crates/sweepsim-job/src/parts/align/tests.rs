//! Planted motions come back, faults stay, and what is not determined is named.

use super::*;
use nalgebra::{Translation3, UnitQuaternion};
use sweepsim_dexel::{FaceSurfaces, Stock, TriDexels, TriangleSoup};

/// Numbers from −1 to 1, the same in each run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// A turn by up to an angle, and a shift by up to a length.
    fn motion(&mut self, angle: f64, shift: f64) -> Isometry3<f64> {
        let axis = Vector3::new(self.next(), self.next(), self.next()).normalize();
        let turn = UnitQuaternion::from_scaled_axis(axis * (angle * self.next()));
        Isometry3::from_parts(
            Translation3::new(shift * self.next(), shift * self.next(), shift * self.next()),
            turn,
        )
    }
}

fn mesh(stock: &Stock) -> Mesh {
    TriDexels::new([-13.1; 3], [13.3; 3], [60; 3], stock)
        .unwrap()
        .surface()
        .unwrap()
}

fn block(min: [f64; 3], max: [f64; 3]) -> Stock {
    Stock::Block { min, max }
}

/// A block with a step and a slot: no turn brings it onto itself.
fn bracket() -> Stock {
    let whole = block([-10.0, -6.0, -4.0], [10.0, 6.0, 5.0]);
    let cut = vec![
        block([1.0, -9.0, 0.5], [20.0, 9.0, 9.0]),
        block([-7.0, 1.0, 2.0], [-3.0, 9.0, 9.0]),
    ];
    Stock::Difference(whole.into(), cut)
}

fn moved(mesh: &Mesh, motion: &Isometry3<f64>) -> Mesh {
    let mut moved = mesh.clone();
    moved
        .vertices
        .iter_mut()
        .for_each(|p| *p = (motion * Point3::from(*p)).coords.into());
    moved
}

/// How far the corners of a part are from where they were before they were displaced and laid back.
fn error(mesh: &Mesh, displaced: &Isometry3<f64>, found: &Isometry3<f64>) -> f64 {
    let both = found * displaced;
    let far = mesh
        .vertices
        .iter()
        .map(|p| (both * Point3::from(*p) - Point3::from(*p)).norm());
    far.fold(0.0, f64::max)
}

#[test]
fn planted_motions_come_back() {
    let goal = mesh(&bracket());
    let mut random = Random(7);
    // Small ones, and any orientation at all. The surfaces are the same, so what is left is rounding: on flat faces the
    // last steps are exact.
    for (angle, shift, cases) in [(0.15, 2.0, 2), (std::f64::consts::PI, 50.0, 2)] {
        for case in 0..cases {
            let planted = random.motion(angle, shift);
            let found = register(&Alignment::Best, [&moved(&goal, &planted), &goal], true, None).unwrap();
            let error = error(&goal, &planted, &found.motion);
            assert!(error < 1e-9, "{angle} {case}: {error}");
            assert!(
                found.report.rms < 1e-10 && found.report.undetermined.is_empty(),
                "{:?}",
                found.report
            );
        }
    }
    // What lies there already stays.
    let found = register(&Alignment::Best, [&goal, &goal], true, None).unwrap();
    assert!(error(&goal, &Isometry3::identity(), &found.motion) < 1e-12);
}

#[test]
fn a_fault_stays_a_fault() {
    let goal = mesh(&bracket());
    // A pad of 0.3 mm on 6 of 480 mm² that look up or down.
    let part = mesh(&Stock::Union(vec![
        bracket(),
        block([-9.0, -5.0, 4.0], [-6.0, -3.0, 5.3]),
    ]));
    let planted = Random(3).motion(0.1, 1.0);
    let found = register(&Alignment::Best, [&moved(&part, &planted), &goal], true, None).unwrap();
    assert!((found.report.largest - 0.3).abs() < 0.02, "{}", found.report.largest);
    // All other points take a share of it: that of its area in all that looks up or down, times at most 1 + 3 + 3 in a
    // corner, as of any plane through the points of a rectangle.
    let error = error(&goal, &planted, &found.motion);
    assert!(error > 1e-6 && error < 0.3 * 7.0 * 6.0 / 480.0, "{error}");
}

/// A plate, whose motions in its plane change nothing; a ball, whose turns do; and a round bar.
#[test]
fn what_is_not_determined_is_named() {
    let corners = [[-9.0, -5.0], [9.0, -5.0], [9.0, 5.0], [-9.0, 5.0]].map(|[x, y]| [x, y, 2.0]);
    let [a, b, c, d] = corners;
    let plate = TriangleSoup {
        triangles: vec![[a, b, c], [a, c, d]],
    }
    .indexed()
    .unwrap();
    // Smaller, so that its edges are over the other one.
    let mut part = plate.clone();
    part.vertices
        .iter_mut()
        .for_each(|p| *p = [0.7 * p[0] + 0.1, 0.7 * p[1], p[2] + 0.25]);
    let found = register(&Alignment::Best, [&part, &plate], true, None).unwrap();
    assert_eq!(found.report.undetermined[0], "shifts across (0, 0, 1)");
    assert!(found.report.undetermined[1].starts_with("a turn about (0, 0, 1) through ("));
    assert_eq!(found.report.undetermined.len(), 2);
    let [x, y, z] = found.report.translation;
    assert!(
        x.abs() < 1e-9 && y.abs() < 1e-9 && (z + 0.25).abs() < 1e-12,
        "{x} {y} {z}"
    );

    let ball = mesh(&Stock::Ball {
        centre: [1.0, 2.0, -1.0],
        radius: 8.0,
    });
    let shift = Isometry3::translation(0.4, -0.2, 0.3);
    let found = register(&Alignment::Best, [&moved(&ball, &shift), &ball], true, None).unwrap();
    let turns = &found.report.undetermined;
    assert!(
        turns.len() == 3 && turns.iter().all(|turn| turn.starts_with("a turn about")),
        "{turns:?}"
    );
    let through = |turn: &String| {
        let numbers = turn
            .rsplit_once('(')
            .unwrap()
            .1
            .trim_end_matches(')')
            .split(", ")
            .map(|n| n.parse::<f64>().unwrap());
        Vector3::from_iterator(numbers)
    };
    assert!(
        turns
            .iter()
            .all(|turn| (through(turn) - Vector3::new(1.0, 2.0, -1.0)).norm() < 0.1),
        "{turns:?}"
    );

    let bar = mesh(&Stock::Cylinder {
        base: [2.0, 1.0, -6.0],
        axis: [0.0, 0.0, 1.0],
        radius: 4.0,
        height: 12.0,
    });
    let found = register(&Alignment::Best, [&moved(&bar, &shift), &bar], true, None).unwrap();
    let [turn] = &found.report.undetermined[..] else {
        panic!("{:?}", found.report.undetermined)
    };
    assert!(turn.starts_with("a turn about (0, 0, 1) through (2"), "{turn}");
}

/// A convex solid of named planes: triangles, their faces, and the planes.
fn faces_of(mesh: &Mesh, planes: &[(&str, [f64; 3], [f64; 3])]) -> TargetFaces {
    let mut faces = TargetFaces::default();
    let on = |p: [f64; 3], (_, origin, normal): &(&str, [f64; 3], [f64; 3])| {
        (0..3).map(|k| (p[k] - origin[k]) * normal[k]).sum::<f64>().abs() < 1e-6
    };
    let face_of = mesh.triangles.iter().map(|t| {
        let own = planes
            .iter()
            .position(|plane| t.iter().all(|v| on(mesh.vertices[*v as usize], plane)));
        own.unwrap_or_else(|| panic!("a triangle in no plane")) as u32
    });
    let surfaces = planes.iter().map(|(_, origin, normal)| {
        Some(AnalyticSurface::Plane {
            origin: *origin,
            normal: *normal,
        })
    });
    faces.surfaces = FaceSurfaces::new(face_of.collect(), surfaces.collect(), 1e-6);
    let named = |(k, (name, ..)): (usize, &(&str, [f64; 3], [f64; 3]))| {
        StepFace::new(100 + k, Some((*name).to_owned()), "plane", faces.surfaces.surfaces[k])
    };
    faces.faces = planes.iter().enumerate().map(named).collect();
    faces
}

/// A block with a slanted end: bottom, front, slope, and the others.
fn wedge(end: f64) -> (Mesh, TargetFaces) {
    let profile = [[-8.0, -3.0], [end, -3.0], [end - 4.0, 5.0], [-8.0, 5.0]];
    let at = |k: usize, y: f64| [profile[k % 4][0], y, profile[k % 4][1]];
    let mut triangles = Vec::new();
    for k in 0..4 {
        let [a, b, c, d] = [at(k, -5.0), at(k + 1, -5.0), at(k + 1, 5.0), at(k, 5.0)];
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    triangles.extend([
        [at(0, -5.0), at(2, -5.0), at(1, -5.0)],
        [at(0, -5.0), at(3, -5.0), at(2, -5.0)],
    ]);
    triangles.extend([
        [at(0, 5.0), at(1, 5.0), at(2, 5.0)],
        [at(0, 5.0), at(2, 5.0), at(3, 5.0)],
    ]);
    let soup = TriangleSoup { triangles };
    let sign = soup.volume().signum();
    let triangles = soup
        .triangles
        .into_iter()
        .map(|[a, b, c]| if sign > 0.0 { [a, b, c] } else { [a, c, b] });
    let mesh = TriangleSoup {
        triangles: triangles.collect(),
    }
    .indexed()
    .unwrap();
    let slope = {
        let size = 80.0_f64.sqrt();
        [8.0 / size, 0.0, 4.0 / size]
    };
    let planes = [
        ("bottom", [0.0, 0.0, -3.0], [0.0, 0.0, -1.0]),
        ("slope", [end, 0.0, -3.0], slope),
        ("top", [0.0, 0.0, 5.0], [0.0, 0.0, 1.0]),
        ("left", [-8.0, 0.0, 0.0], [-1.0, 0.0, 0.0]),
        ("front", [0.0, -5.0, 0.0], [0.0, -1.0, 0.0]),
        ("back", [0.0, 5.0, 0.0], [0.0, 1.0, 0.0]),
    ];
    let faces = faces_of(&mesh, &planes);
    (mesh, faces)
}

fn datum(names: [&str; 3]) -> Alignment {
    Alignment::Datum(names.map(str::to_owned))
}

/// The slope of the part is 0.3 mm too far out: datums elsewhere take no notice, and one on it takes it all.
#[test]
fn three_two_one_is_exact_on_its_faces() {
    let ((part, _), (goal, faces)) = (wedge(8.3), wedge(8.0));
    let mut random = Random(11);
    let mut tried = 0;
    for names in [
        ["bottom", "front", "left"],
        ["left", "bottom", "back"],
        ["top", "left", "front"],
        ["front", "top", "left"],
    ] {
        let planted = random.motion(0.08, 0.7);
        let found = register(&datum(names), [&moved(&part, &planted), &goal], true, Some(&faces)).unwrap();
        let error = error(&part, &planted, &found.motion);
        assert!(error < 1e-10, "{names:?}: {error}");
        assert!(
            found.report.rms < 1e-10 && found.report.datums == names,
            "{:?}",
            found.report
        );
        tried += 1;
    }
    assert_eq!(tried, 4);
    // The slope as the second: the part is turned and shifted until that lies on it, and the bottom stays.
    let planted = random.motion(0.05, 0.5);
    let found = register(
        &datum(["bottom", "slope", "front"]),
        [&moved(&part, &planted), &goal],
        true,
        Some(&faces),
    )
    .unwrap();
    let both = found.motion * planted;
    let shift = both.translation.vector;
    assert!(
        (shift - Vector3::new(-0.3, 0.0, 0.0)).norm() < 1e-10 && both.rotation.angle() < 1e-10,
        "{shift}"
    );
}

#[test]
fn datums_that_cannot_hold_a_part_are_errors() {
    let (goal, faces) = wedge(8.0);
    let told = |names: [&str; 3]| {
        let found = register(&datum(names), [&goal, &goal], true, Some(&faces));
        found.map(|_| String::new()).unwrap_or_else(|error| error.to_string())
    };
    assert!(told(["bottom", "top", "front"]).contains("bottom and top are parallel"));
    assert!(told(["bottom", "left", "slope"]).contains("slope is parallel to the edge of bottom and left"));
    assert!(told(["bottom", "left", "hole"]).contains("no face hole: expected one like bottom, slope, top"));
    let none = register(&datum(["a", "b", "c"]), [&goal, &goal], true, None)
        .unwrap_err()
        .to_string();
    assert!(none.contains("datum needs the faces of a STEP file"), "{none}");
    assert_eq!(
        "datum=a,b".parse::<Alignment>(),
        Err("datum has 2 faces: expected three".to_owned())
    );
    assert!("nearest".parse::<Alignment>().is_err());
    assert_eq!("datum=a, b,#12".parse(), Ok(datum(["a", "b", "#12"])));
}

/// A drum that is too thick by 0.2 mm on one side of no axis: its axis and its ends are what is aligned.
#[test]
fn features_do_not_look_at_radii() {
    let drum = |radius: f64| {
        mesh(&Stock::Cylinder {
            base: [1.0, -2.0, -5.0],
            axis: [0.0, 0.0, 1.0],
            radius,
            height: 9.0,
        })
    };
    let (part, goal) = (drum(6.2), drum(6.0));
    let mut faces = TargetFaces::default();
    let face_of = goal.triangles.iter().map(|t| {
        let heights = t.map(|v| goal.vertices[v as usize][2]);
        if heights.iter().all(|z| (z + 5.0).abs() < 1e-9) {
            1
        } else {
            u32::from(heights.iter().all(|z| (z - 4.0).abs() < 1e-9)) * 2
        }
    });
    let plane = |z: f64| {
        Some(AnalyticSurface::Plane {
            origin: [0.0, 0.0, z],
            normal: [0.0, 0.0, 1.0],
        })
    };
    let side = AnalyticSurface::Cylinder {
        origin: [1.0, -2.0, 0.0],
        axis: [0.0, 0.0, 1.0],
        radius: 6.0,
    };
    faces.surfaces = FaceSurfaces::new(face_of.collect(), vec![Some(side), plane(-5.0), plane(4.0)], 0.02);
    let planted = Isometry3::from_parts(
        Translation3::new(0.5, -0.3, 0.2),
        UnitQuaternion::from_scaled_axis(Vector3::new(0.03, -0.02, 0.0)),
    );
    let found = register(
        &Alignment::Features,
        [&moved(&part, &planted), &goal],
        true,
        Some(&faces),
    )
    .unwrap();
    // The turn about the axis is not determined; all else comes back, but for the chords of the part's triangles: lines
    // 0.44 mm apart leave 0.004 mm, over a height of 9 mm.
    let both = found.motion * planted;
    let axis = both * Vector3::z() - Vector3::z();
    let centre = both * Point3::new(1.0, -2.0, 0.0) - Point3::new(1.0, -2.0, 0.0);
    assert!(axis.norm() < 9e-4 && centre.norm() < 0.004, "{axis} {centre}");
    assert!(
        found.report.undetermined.len() == 1 && found.report.largest < 0.02,
        "{:?}",
        found.report
    );
}
