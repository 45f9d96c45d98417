//! Surfaces: known topology, watertight, oriented, on the surface; singular ones are named.

use crate::support;

use support::audit::{audit_surface, solve_surface};
use support::expression::{Polynomial, parse};
use sweepsim_solve::{Enclosure, SurfaceSolver, System};

fn system(expression: &str, half: f64) -> System {
    let names = ["x", "y", "z"].map(String::from);
    let bounds = [Enclosure::new(-half, half).unwrap(); 3];
    let polynomial = Polynomial::of(&parse(expression, &names), 3).unwrap();
    System::mapped(&bounds, [polynomial.equation(&bounds)]).unwrap()
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
        let surface = solve_surface(&system, 0.05, name);
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
        let sphere = solve_surface(&system("x**2+y**2+z**2-1", 1.5), tolerance, "sphere");
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
    let cone = solve_surface(&system("x**2+y**2-1.7*z**2", 1.1), 0.05, "cone");

    assert_eq!(cone.unresolved.len(), 1);
    assert!(
        cone.unresolved[0]
            .bounds
            .iter()
            .all(|b| b.contains(0.0) && b.hi() - b.lo() < 0.1)
    );
    // Two disks with a hole around the apex each: annuli.
    assert_eq!((cone.euler_characteristic(), cone.components()), (0, 2));
    let planes = system("x*y", 1.1);
    let options = SurfaceSolver::new(0.1).options.smallest(1.0 / 64.0);
    let crossing = SurfaceSolver::with_options(0.1, options).solve(&planes, &()).unwrap();
    assert!(!crossing.unresolved.is_empty());
    audit_surface(&crossing, "planes");
}

#[test]
fn bad_input_is_an_error() {
    let sphere = system("x**2+y**2+z**2-1", 1.5);
    for tolerance in [0.0, -1.0, f64::NAN] {
        assert!(SurfaceSolver::new(tolerance).solve(&sphere, &()).is_err());
    }
    let names = ["x", "y"].map(String::from);
    let bounds = [Enclosure::new(-1.0, 1.0).unwrap(); 2];
    let plane = Polynomial::of(&parse("x", &names), 2).unwrap().equation(&bounds);
    let flat = System::mapped(&bounds, [plane]).unwrap();
    assert!(SurfaceSolver::new(0.1).solve(&flat, &()).is_err());
}
