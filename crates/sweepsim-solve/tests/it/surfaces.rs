//! Surfaces: known topology, watertight, oriented, on the surface; singular ones are named.

use crate::support;

use std::time::Instant;
use support::expression::{Polynomial, parse};
use support::stored::all;
use sweepsim_solve::{Interval, SolveOptions, Surface, SurfaceSolver, System};

fn system(expression: &str, half: f64) -> System {
    let names = ["x", "y", "z"].map(String::from);
    let bounds = [Interval::new(-half, half); 3];
    let polynomial = Polynomial::of(&parse(expression, &names), 3).unwrap();
    System::new(&bounds, [polynomial.equation(&bounds)]).unwrap()
}

/// Every directed edge once; its reverse at most once; only boundary edges without; no vertex unused, none pinched.
fn audit(surface: &Surface, name: &str) {
    let mut sides = Vec::new();
    let mut used = vec![false; surface.vertices.len()];
    for t in &surface.triangles {
        sides.extend([(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]);
        t.iter().for_each(|v| used[*v as usize] = true);
    }
    let count = sides.len();
    sides.sort_unstable();
    sides.dedup();
    assert_eq!(sides.len(), count, "{name}: an edge twice in one direction");
    assert!(used.iter().all(|u| *u), "{name}: an unused vertex");
    // Around each vertex the triangles form one fan.
    let mut next: std::collections::BTreeMap<u32, Vec<(u32, u32)>> = std::collections::BTreeMap::new();
    for t in &surface.triangles {
        for k in 0..3 {
            next.entry(t[k]).or_default().push((t[(k + 1) % 3], t[(k + 2) % 3]));
        }
    }
    for (vertex, fan) in next {
        let starts = fan.iter().filter(|(a, _)| fan.iter().all(|(_, b)| a != b)).count();
        assert!(starts <= 1, "{name}: vertex {vertex} is pinched");
        let mut at = fan
            .iter()
            .find(|(a, _)| fan.iter().all(|(_, b)| a != b))
            .unwrap_or(&fan[0])
            .0;
        let mut steps = 0;
        while let Some((_, b)) = fan.iter().find(|(a, _)| *a == at) {
            at = *b;
            steps += 1;
            if steps > fan.len() {
                break;
            }
        }
        assert!(steps >= fan.len(), "{name}: vertex {vertex} has several fans");
    }
}

fn solve(system: &System, tolerance: f64, name: &str) -> Surface {
    let start = Instant::now();
    let surface = SurfaceSolver::new(tolerance).solve(system, &mut ()).unwrap();
    println!(
        "{name:16} χ {:3}, {} components, {:6} triangles, {:5} boundary edges, {:3} open, {:7} boxes, {:8.2} ms",
        surface.euler_characteristic(),
        surface.components(),
        surface.triangles.len(),
        surface.boundary().len(),
        surface.unresolved.len(),
        surface.statistics.boxes,
        start.elapsed().as_secs_f64() * 1e3
    );
    for open in &surface.unresolved {
        println!("{:16} open: {:?} ({} boxes)", "", open.bounds, open.boxes);
    }
    audit(&surface, name);
    surface
}

#[test]
fn surfaces_have_their_known_topology() {
    // Name, equation, half side, χ, components, whether it has a boundary.
    let cases = [
        ("sphere", "x**2+y**2+z**2-1", 1.5, 2, 1, false),
        ("thin ellipsoid", "x**2+y**2+25*z**2-1", 1.5, 2, 1, false),
        ("torus", "(x**2+y**2+z**2+0.91)**2-4*(x**2+y**2)", 1.5, 0, 1, false),
        (
            "two spheres",
            "((x-0.7)**2+y**2+z**2-0.25)*((x+0.7)**2+y**2+z**2-0.3)",
            1.5,
            4,
            2,
            false,
        ),
        (
            "near spheres",
            "((x-0.505)**2+y**2+z**2-0.25)*((x+0.505)**2+y**2+z**2-0.25)",
            1.5,
            4,
            2,
            false,
        ),
        (
            "nested spheres",
            "(x**2+y**2+z**2-0.25)*(x**2+y**2+z**2-0.3)",
            1.5,
            4,
            2,
            false,
        ),
        (
            "tanglecube",
            "x**4-5*x**2+y**4-5*y**2+z**4-5*z**2+11.8",
            3.0,
            -8,
            1,
            false,
        ),
        ("plane", "x+2*y-z/3-0.1", 1.0, 1, 1, true),
        ("cylinder", "x**2+y**2-0.5", 1.0, 0, 1, true),
        ("hyperboloid", "x**2+y**2-z**2-0.1", 1.0, 0, 1, true),
        ("two sheets", "x**2+y**2-z**2+0.1", 1.0, 2, 2, true),
        ("saddle", "x*y-z", 1.3, 1, 1, true),
        ("empty", "x**2+y**2+z**2+0.01", 1.0, 0, 0, false),
    ];
    for (name, equation, half, euler, components, bounded) in cases {
        let system = system(equation, half);
        let surface = solve(&system, 0.05, name);
        assert_eq!(
            (surface.euler_characteristic(), surface.components()),
            (euler, components),
            "{name}"
        );
        assert!(surface.unresolved.is_empty(), "{name}");
        assert_eq!(!surface.boundary().is_empty(), bounded, "{name}");
        // Boundary edges lie on the box's faces.
        for (a, _) in surface.boundary() {
            let p = surface.vertices[a as usize];
            assert!(p.iter().any(|x| (x.abs() - half).abs() < 1e-12), "{name}: {p:?}");
        }
    }
}

#[test]
fn vertices_lie_on_the_surface_and_triangles_face_the_positive_side() {
    for tolerance in [0.1, 0.01, 0.001] {
        let sphere = solve(&system("x**2+y**2+z**2-1", 1.5), tolerance, "sphere");
        let mut volume = 0.0;
        for t in &sphere.triangles {
            let p = t.map(|v| sphere.vertices[v as usize]);
            for q in &p {
                assert!((q.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-13);
            }
            // The farthest point of the chord triangle from the sphere.
            let middle = [0, 1, 2].map(|j| (p[0][j] + p[1][j] + p[2][j]) / 3.0);
            let depth = 1.0 - middle.iter().map(|x| x * x).sum::<f64>().sqrt();
            assert!(depth <= tolerance, "{depth}");
            volume += (p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1])
                - p[0][1] * (p[1][0] * p[2][2] - p[1][2] * p[2][0])
                + p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]))
                / 6.0;
        }
        assert!(
            (volume - 4.0 / 3.0 * std::f64::consts::PI).abs() < 10.0 * tolerance,
            "{volume}"
        );
        assert!(volume > 0.0);
    }
}

#[test]
fn singular_surfaces_are_named() {
    let cone = solve(&system("x**2+y**2-1.7*z**2", 1.1), 0.05, "cone");

    assert_eq!(cone.unresolved.len(), 1);
    assert!(
        cone.unresolved[0]
            .bounds
            .iter()
            .all(|b| b.contains(0.0) && b.hi - b.lo < 0.1)
    );
    // Two disks with a hole around the apex each: annuli.
    assert_eq!((cone.euler_characteristic(), cone.components()), (0, 2));
    let planes = system("x*y", 1.1);
    let options = SolveOptions {
        smallest: 1.0 / 64.0,
        ..SurfaceSolver::new(0.1).options
    };
    let crossing = SurfaceSolver::with_options(0.1, options)
        .solve(&planes, &mut ())
        .unwrap();
    assert!(!crossing.unresolved.is_empty());
    audit(&crossing, "planes");
}

#[test]
fn stored_surfaces_have_their_known_topology() {
    let Some(systems) = all() else { return };
    for stored in systems.iter().filter(|s| s.dimension == 2) {
        let surface = solve(&stored.system().unwrap(), 0.02, &stored.name);
        assert!(surface.unresolved.is_empty(), "{}", stored.name);
        if let Some(euler) = stored.expected["euler"].as_i64() {
            assert_eq!(surface.euler_characteristic(), euler);
            assert_eq!(
                surface.components() as u64,
                stored.expected["components"].as_u64().unwrap()
            );
        }
    }
}

#[test]
fn bad_input_is_an_error() {
    let sphere = system("x**2+y**2+z**2-1", 1.5);
    for tolerance in [0.0, -1.0, f64::NAN] {
        assert!(SurfaceSolver::new(tolerance).solve(&sphere, &mut ()).is_err());
    }
    let names = ["x", "y"].map(String::from);
    let bounds = [Interval::new(-1.0, 1.0); 2];
    let plane = Polynomial::of(&parse("x", &names), 2).unwrap().equation(&bounds);
    let flat = System::new(&bounds, [plane]).unwrap();
    assert!(SurfaceSolver::new(0.1).solve(&flat, &mut ()).is_err());
}
