//! Solids of dexels without tools: any surfaces, any dexels.

use std::f64::consts::PI;
use sweepsim_dexel::{AnalyticSurface, Stock, SurfaceEnd, TriDexels};
use sweepsim_formats::{StepPart, parse_step};
use sweepsim_solid::{Solid, SolidError, SolidOptions, StepHeader, Surface, write_step};

fn of(stock: &Stock, surfaces: &[AnalyticSurface]) -> (Solid, StepPart) {
    let dexels = TriDexels::new([-10.0; 3], [10.0; 3], [37, 41, 39], stock).unwrap();
    let (mesh, ends) = dexels.surface_with_ends().unwrap();
    let all: Vec<Surface> = surfaces.iter().copied().map(Surface::Analytic).collect();
    let solid = Solid::new(
        &mesh,
        &ends,
        &|_: &SurfaceEnd| all.clone(),
        SolidOptions::new(1e-6, 0.55),
    )
    .unwrap();
    let mut file = Vec::new();
    write_step(&solid, &StepHeader::default(), &mut file).unwrap();
    (solid, parse_step(&file, 0.02).unwrap())
}

fn sphere(radius: f64) -> AnalyticSurface {
    AnalyticSurface::Sphere {
        centre: [0.3, 0.2, -0.1],
        radius,
    }
}

fn ball(radius: f64) -> Stock {
    Stock::Ball {
        centre: [0.3, 0.2, -0.1],
        radius,
    }
}

/// A whole sphere has no border, and a pole wherever its axis is: it is divided.
#[test]
fn balls_and_hollow_balls() {
    let (solid, part) = of(&ball(8.0), &[sphere(8.0)]);
    assert_eq!(solid.summary.faces.keys().copied().collect::<Vec<_>>(), ["sphere"]);
    let exact = 4.0 / 3.0 * PI * 512.0;
    let volume = part.bodies[0].volume.unwrap();
    assert!((volume - exact).abs() < 1e-5 * exact, "{volume} {exact}");

    let hollow = Stock::Difference(Box::new(ball(8.0)), vec![ball(5.0)]);
    let (solid, part) = of(&hollow, &[sphere(8.0), sphere(5.0)]);
    assert_eq!((solid.bodies.len(), solid.bodies[0].hollows.len()), (1, 1));
    let exact = 4.0 / 3.0 * PI * (512.0 - 125.0);
    let volume = part.mesh.soup().unwrap().volume();
    assert!((volume - exact).abs() < 0.02 * 1200.0, "{volume} {exact}");
}

/// Without surfaces all faces are triangles: those of the mesh, but for such as have no width.
#[test]
fn unknown_surfaces_are_triangles() {
    let (solid, part) = of(&ball(5.0), &[sphere(4.9)]);
    assert_eq!(solid.summary.faces.keys().copied().collect::<Vec<_>>(), ["facet"]);
    assert_eq!(solid.summary.share(), 0.0);
    let exact = 4.0 / 3.0 * PI * 125.0;
    let volume = part.mesh.soup().unwrap().volume();
    assert!((volume - exact).abs() < 0.01 * exact, "{volume} {exact}");
}

/// A drum whose axis is along none of the dexels: round it, and its border with each end.
#[test]
fn oblique_drum() {
    let axis = [2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0];
    let base = axis.map(|c: f64| -6.0 * c);
    let top = axis.map(|c| 6.0 * c);
    let drum = Stock::Cylinder {
        base,
        axis,
        radius: 4.0,
        height: 12.0,
    };
    let plane = |origin| AnalyticSurface::Plane { origin, normal: axis };
    let side = AnalyticSurface::Cylinder {
        origin: base,
        axis,
        radius: 4.0,
    };
    let (solid, part) = of(&drum, &[plane(base), plane(top), side]);
    assert_eq!((solid.summary.faces["plane"], solid.summary.faces["cylinder"]), (2, 2));
    assert_eq!(solid.summary.faces.len(), 2);
    let exact = PI * 16.0 * 12.0;
    let volume = part.bodies[0].volume.unwrap();
    assert!((volume - exact).abs() < 1e-6 * exact, "{volume} {exact}");
}

#[test]
fn bad_input_is_an_error() {
    let dexels = TriDexels::new([-10.0; 3], [10.0; 3], [20; 3], &ball(8.0)).unwrap();
    let (mut mesh, ends) = dexels.surface_with_ends().unwrap();
    let none = |_: &SurfaceEnd| Vec::new();
    let options = SolidOptions::new(f64::NAN, 1.0);
    assert!(matches!(
        Solid::new(&mesh, &ends, &none, options),
        Err(SolidError::Length { .. })
    ));
    let options = SolidOptions::new(1e-6, 1.0);
    let last = mesh.triangles.pop().unwrap();
    assert!(matches!(
        Solid::new(&mesh, &ends, &none, options),
        Err(SolidError::Mesh)
    ));
    mesh.triangles.push([last[1], last[0], last[2]]);
    assert!(matches!(
        Solid::new(&mesh, &ends, &none, options),
        Err(SolidError::Open)
    ));
    mesh.triangles.clear();
    assert!(matches!(
        Solid::new(&mesh, &ends, &none, options),
        Err(SolidError::Empty)
    ));
}
