//! Faces that go once around and have no seam, as NX writes them.

use super::writer::Writer;
use std::f64::consts::PI;
use sweepsim_formats::{StepPart, parse_step};

/// What is between two rims: a surface, with the height of its centre, and whether it looks away from its inside.
enum Side {
    /// A level plane, and whether it looks up.
    Level(f64, bool),
    Cylinder(f64, bool),
    /// The height of the apex, the tangent of half its angle, whether it widens upwards, and whether it looks outwards.
    Cone(f64, f64, bool, bool),
    Sphere(f64, f64, bool),
    Torus(f64, [f64; 2], bool),
}

use Side::*;

/// A solid's name, sides, rims and volume.
type Case = (&'static str, Vec<Side>, Vec<[f64; 2]>, f64);

/// A turned solid: the sides of a profile that has the material to its left as it goes, and the rims (radius, height)
/// between them; poles have no radius. `angles`: where the rims begin.
fn turned(sides: &[Side], rims: &[[f64; 2]], angles: &[f64]) -> String {
    let mut file = Writer::new(false);
    let edges: Vec<Option<usize>> = rims
        .iter()
        .zip(angles.iter().cycle())
        .map(|([radius, z], angle)| {
            let begin = file.vertex([radius * angle.cos(), radius * angle.sin(), *z]);
            (*radius > 0.0).then(|| file.circle(begin, [0.0, 0.0, *z], *radius))
        })
        .collect();
    let mut faces = Vec::new();
    for (number, side) in sides.iter().enumerate() {
        let mut placed = |z: f64, up: f64| file.placement([0.0, 0.0, z], [0.0, 0.0, up], [0.6, 0.8, 0.0]);
        let (surface, outwards) = match side {
            Level(z, up) => (format!("PLANE('',#{})", placed(*z, 1.0)), *up),
            Cylinder(radius, outwards) => (
                format!("CYLINDRICAL_SURFACE('',#{},{radius:?})", placed(1.0, 1.0)),
                *outwards,
            ),
            Cone(apex, slope, widens, outwards) => {
                // Placed where its radius is 1.
                let up = if *widens { 1.0 } else { -1.0 };
                let place = placed(apex + up / slope, up);
                (format!("CONICAL_SURFACE('',#{place},1.,{:?})", slope.atan()), *outwards)
            }
            Sphere(z, radius, outwards) => (
                format!("SPHERICAL_SURFACE('',#{},{radius:?})", placed(*z, 1.0)),
                *outwards,
            ),
            Torus(z, [major, minor], outwards) => (
                format!("TOROIDAL_SURFACE('',#{},{major:?},{minor:?})", placed(*z, 1.0)),
                *outwards,
            ),
        };
        let surface = file.add(&surface);
        let ends = [(edges[number], true), (edges[(number + 1) % rims.len()], false)];
        let loops: Vec<_> = ends
            .into_iter()
            .filter_map(|(edge, along)| Some(vec![(edge?, along)]))
            .collect();
        let face = file.face("", surface, &loops);
        faces.push(if outwards { face } else { file.reversed(face) });
    }
    let solid = file.solid("turned", &faces);
    file.product("part", &[solid]);
    file.text()
}

fn holds(name: &str, part: &StepPart, truth: f64, chord: f64) {
    let own = part.bodies[0].volume.unwrap();
    assert!((own - truth).abs() < 1e-5 * truth, "{name}: {own}, not {truth}");
    let soup = part.mesh.soup().unwrap();
    soup.check_closed().unwrap();
    // Less than 400 mm² are not flat.
    assert!(
        (soup.volume() - truth).abs() < 400.0 * chord,
        "{name}: {}, not {truth}",
        soup.volume()
    );
    assert!(part.deviation <= chord, "{name}: {}", part.deviation);
}

#[test]
fn rims_alone_bound_faces() {
    let half = 8.0 / (3.0 * PI);
    let cases: [Case; 9] = [
        (
            "bar",
            vec![Level(0.0, false), Cylinder(5.0, true), Level(8.0, true)],
            vec![[0.0, 0.0], [5.0, 0.0], [5.0, 8.0], [0.0, 8.0]],
            PI * 200.0,
        ),
        (
            "tube",
            vec![
                Cylinder(5.0, true),
                Level(8.0, true),
                Cylinder(3.0, false),
                Level(0.0, false),
            ],
            vec![[5.0, 0.0], [5.0, 8.0], [3.0, 8.0], [3.0, 0.0]],
            PI * 128.0,
        ),
        (
            "tip",
            vec![Level(0.0, false), Cone(6.0, 4.0 / 6.0, false, true)],
            vec![[0.0, 0.0], [4.0, 0.0], [0.0, 6.0]],
            PI * 32.0,
        ),
        (
            "countersink",
            vec![
                Level(0.0, false),
                Cylinder(5.0, true),
                Level(8.0, true),
                Cone(6.0, 1.0, true, false),
            ],
            vec![[0.0, 0.0], [5.0, 0.0], [5.0, 8.0], [2.0, 8.0], [0.0, 6.0]],
            PI * (200.0 - 8.0 / 3.0),
        ),
        (
            "dome",
            vec![Level(0.0, false), Sphere(-3.0, 5.0, true)],
            vec![[0.0, 0.0], [4.0, 0.0], [0.0, 2.0]],
            PI * 4.0 * 13.0 / 3.0,
        ),
        (
            "belly",
            vec![Level(0.0, false), Sphere(3.0, 5.0, true)],
            vec![[0.0, 0.0], [4.0, 0.0], [0.0, 8.0]],
            PI * 64.0 * 7.0 / 3.0,
        ),
        (
            "dimple",
            vec![
                Level(0.0, false),
                Cylinder(5.0, true),
                Level(8.0, true),
                Sphere(11.0, 5.0, false),
            ],
            vec![[0.0, 0.0], [5.0, 0.0], [5.0, 8.0], [4.0, 8.0], [0.0, 6.0]],
            PI * (200.0 - 4.0 * 13.0 / 3.0),
        ),
        (
            "bulge",
            vec![Level(0.0, false), Torus(2.0, [6.0, 2.0], true), Level(4.0, true)],
            vec![[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [0.0, 4.0]],
            PI * (144.0 + 4.0 * PI * (6.0 + half)),
        ),
        (
            "spool",
            vec![Level(0.0, false), Torus(2.0, [6.0, 2.0], false), Level(4.0, true)],
            vec![[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [0.0, 4.0]],
            PI * (144.0 - 4.0 * PI * (6.0 - half)),
        ),
    ];
    for (name, sides, rims, truth) in &cases {
        // All rims begin where the surfaces do, or elsewhere, or each in a place of its own.
        for angles in [&[0.8_f64.atan2(0.6)][..], &[-2.0], &[0.3, 2.9, -1.7]] {
            let text = turned(sides, rims, angles);
            let part = parse_step(text.as_bytes(), 0.01).unwrap_or_else(|error| panic!("{name} {angles:?}: {error}"));
            holds(&format!("{name} {angles:?}"), &part, *truth, 0.01);
        }
    }
}

/// The seam of a shaft is not where its keyway is, although both rims begin there.
#[test]
fn seams_are_beside_holes() {
    let mut file = Writer::new(false);
    let [a, b] = [[5.0, 0.0, 0.0], [5.0, 0.0, 8.0]].map(|place| file.vertex(place));
    let [low, high] = [(a, 0.0), (b, 8.0)].map(|(vertex, z)| file.circle(vertex, [0.0, 0.0, z], 5.0));
    // The keyway: x from 3, y from −1 to 1, z from 2 to 6.
    let x = 24_f64.sqrt();
    let place = |k: usize| [[3.0, x][k & 1], [-1.0, 1.0][k >> 1 & 1], [2.0, 6.0][k >> 2]];
    let vertices: Vec<usize> = (0..8).map(|k| file.vertex(place(k))).collect();
    let mut line = |i: usize, j: usize| file.line([vertices[i], vertices[j]], [place(i), place(j)]);
    let [y0, y1, y2, y3] = [(0, 2), (4, 6), (0, 4), (2, 6)].map(|(i, j)| line(i, j));
    let [x0, x1, x2, x3] = [(0, 1), (2, 3), (4, 5), (6, 7)].map(|(i, j)| line(i, j));
    let [z0, z1] = [(1, 5), (3, 7)].map(|(i, j)| line(i, j));
    let [arc0, arc1] = [(1, 3, 2.0), (5, 7, 6.0)].map(|(i, j, z)| {
        let placement = file.placement([0.0, 0.0, z], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]);
        let circle = file.add(&format!("CIRCLE('',#{placement},5.0)"));
        file.add(&format!(
            "EDGE_CURVE('',#{},#{},#{circle},.T.)",
            vertices[i], vertices[j]
        ))
    });
    let placement = file.placement([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
    let side = file.add(&format!("CYLINDRICAL_SURFACE('',#{placement},5.0)"));
    let hole = vec![(z0, true), (arc1, true), (z1, false), (arc0, false)];
    let mut faces = vec![file.face("side", side, &[hole, vec![(high, false)], vec![(low, true)]])];
    let mut plane = |origin, normal, x, uses| {
        let plane = file.plane(origin, normal, x);
        faces.push(file.face("", plane, &[uses]));
    };
    let (ahead, up) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    plane([0.0; 3], [0.0, 0.0, -1.0], ahead, vec![(low, false)]);
    plane([0.0, 0.0, 8.0], up, ahead, vec![(high, true)]);
    let floor = vec![(y0, true), (y3, true), (y1, false), (y2, false)];
    plane([3.0, 0.0, 0.0], ahead, up, floor);
    let near = vec![(y2, true), (x2, true), (z0, false), (x0, false)];
    plane([0.0, -1.0, 0.0], [0.0, 1.0, 0.0], ahead, near);
    let far = vec![(x1, true), (z1, true), (x3, false), (y3, false)];
    plane([0.0, 1.0, 0.0], [0.0, -1.0, 0.0], ahead, far);
    let below = vec![(x0, true), (arc0, true), (x1, false), (y0, false)];
    plane([0.0, 0.0, 2.0], up, ahead, below);
    let above = vec![(y1, true), (x3, true), (arc1, false), (x2, false)];
    plane([0.0, 0.0, 6.0], [0.0, 0.0, -1.0], ahead, above);
    let solid = file.solid("shaft", &faces);
    file.product("part", &[solid]);
    let part = parse_step(file.text().as_bytes(), 0.01).unwrap();
    // The part of the circle beyond x = 3 between the walls.
    let across = x + 25.0 * 0.2_f64.asin() - 6.0;
    holds("shaft", &part, PI * 200.0 - 4.0 * across, 0.01);
}
