//! Curves as cubic pieces: their distance from the curve, their number, their topology.

use sweepsim_solve::{CurveSolver, Enclosure, System};

/// The point of a cubic Bézier curve.
fn at(control: &[Vec<f64>; 4], s: f64) -> Vec<f64> {
    let r = 1.0 - s;
    let weights = [r * r * r, 3.0 * r * r * s, 3.0 * r * s * s, s * s * s];
    (0..control[0].len())
        .map(|j| (0..4).map(|k| weights[k] * control[k][j]).sum())
        .collect()
}

#[test]
fn cubics_are_within_their_tolerance_and_few() {
    // Curves whose distance is known: a circle, a circle on a tilted plane as an intersection of a sphere and a plane, a lemniscate's node.
    let circle = System::parse(
        &["x^2 + y^2 = 1"],
        &["x", "y"],
        &[Enclosure::new(-2.0, 2.1).unwrap(); 2],
    )
    .unwrap();
    let sphere = System::parse(
        &["x^2 + y^2 + z^2 = 1", "x + y + z = 0.3"],
        &["x", "y", "z"],
        &[Enclosure::new(-1.5, 1.6).unwrap(); 3],
    )
    .unwrap();
    // Distance from the circle of radius 1, and from that of radius √(1 − 0.03) about (0.1, 0.1, 0.1) in its plane.
    let plane_distance = |p: &[f64]| (p[0].hypot(p[1]) - 1.0).abs();
    let space_distance = |p: &[f64]| {
        let height = (p.iter().sum::<f64>() - 0.3) / 3f64.sqrt();
        let foot: Vec<f64> = p.iter().map(|x| x - height / 3f64.sqrt() - 0.1).collect();
        let radius = foot.iter().map(|x| x * x).sum::<f64>().sqrt();
        height.hypot(radius - 0.97f64.sqrt())
    };
    for (system, distance) in [
        (&circle, &plane_distance as &dyn Fn(&[f64]) -> f64),
        (&sphere, &space_distance),
    ] {
        let mut counts = Vec::new();
        for tolerance in [1e-4, 1e-7, 1e-10, 1e-12] {
            let curves = CurveSolver::new(tolerance).cubics().solve(system, &()).unwrap();
            assert_eq!(
                (curves.loops().count(), curves.curves.len(), curves.singular.len()),
                (1, 1, 0)
            );
            let curve = &curves.curves[0];
            assert_eq!(curve.handles.len(), curve.segments());
            counts.push(curve.segments());
            for segment in 0..curve.segments() {
                let control = curve.cubic(segment).unwrap();
                for k in 0..=32 {
                    let p = at(&control, f64::from(k) / 32.0);
                    let off = distance(&p);
                    assert!(off <= tolerance + 4e-15, "{tolerance:e}, segment {segment}: {off:e}");
                }
            }
            assert!(curve.cubic(curve.segments()).is_none());
        }
        // The circle would take 222,000 chords for 1e-10.
        assert!(counts[1] < 80 && counts[2] < 400 && counts[3] < 1_000, "{counts:?}");
    }
    let chords = CurveSolver::new(1e-4).solve(&circle, &()).unwrap();
    assert!(chords.curves[0].handles.is_empty() && chords.curves[0].cubic(0).is_none());
}

#[test]
fn cubics_have_the_topology_of_chords() {
    let corner = |form: &str| System::parse(&[form], &["x", "y"], &[Enclosure::new(-2.0, 2.0).unwrap(); 2]).unwrap();
    for form in [
        "(x^2 + y^2)^2 = x^2 - y^2",
        "y^2 = x^3",
        "y = x^3 - x",
        "(x^2 + y^2 - 1)*(x^2 + 4*y^2 - 2)",
        "x*y = 1e-6",
        "x^4 + y^4 - 3*x^2*y^2 = 0.1",
    ] {
        let system = corner(form);
        let chords = CurveSolver::new(1e-3).solve(&system, &()).unwrap();
        let cubics = CurveSolver::new(1e-6).cubics().solve(&system, &()).unwrap();
        let kinds = |c: &sweepsim_solve::Curves| (c.loops().count(), c.arcs().count(), c.singular.len());
        assert_eq!(kinds(&chords), kinds(&cubics), "{form}");
        let mut vertices = 0;
        for curve in &cubics.curves {
            assert_eq!(curve.handles.len(), curve.segments());
            vertices += curve.points.len();
            for p in &curve.points {
                assert!(p.tangent.iter().all(|t| t.is_finite()));
            }
            assert!(curve.handles.iter().flatten().all(|h| *h > 0.0 && h.is_finite()));
        }
        assert!(vertices < 4_000, "{form}: {vertices}");
    }
}

/// Graphs of functions, whose vertical distance bounds what a cubic may be off by.
#[test]
fn cubics_of_formulas_are_within_their_tolerance_and_few() {
    type Plain = fn(f64) -> f64;
    let graphs: [(&str, Plain); 9] = [
        ("y = sin(3*x)", |x| (3.0 * x).sin()),
        ("y = cos(2*x + 1) * x", |x| (2.0 * x + 1.0).cos() * x),
        ("y = exp(x) / 2 - 1", |x| x.exp() / 2.0 - 1.0),
        ("y = ln(x + 1.5)", |x| (x + 1.5).ln()),
        ("y = sqrt(x + 1.25)", |x| (x + 1.25).sqrt()),
        ("y = atan(4*x)", |x| (4.0 * x).atan()),
        ("y = tan(x)", f64::tan),
        ("y * (1 + 4*x^2) = 1", |x| 1.0 / (1.0 + 4.0 * x * x)),
        ("y = 1 / (2 + sin(5*x))", |x| 1.0 / (2.0 + (5.0 * x).sin())),
    ];
    let domain = [Enclosure::new(-1.0, 1.1).unwrap(), Enclosure::new(-2.0, 2.1).unwrap()];
    for (text, plain) in graphs {
        let system = System::parse(&[text], &["x", "y"], &domain).unwrap();
        let chords = CurveSolver::new(1e-3).solve(&system, &()).unwrap();
        let mut counts = Vec::new();
        for tolerance in [1e-4, 1e-7, 1e-10] {
            let curves = CurveSolver::new(tolerance).cubics().solve(&system, &()).unwrap();
            let kinds = |c: &sweepsim_solve::Curves| (c.loops().count(), c.arcs().count(), c.singular.len());
            assert_eq!(kinds(&chords), kinds(&curves), "{text}");
            assert!(curves.singular.is_empty() && !curves.curves.is_empty(), "{text}");
            counts.push(curves.curves.iter().map(sweepsim_solve::Curve::segments).sum::<usize>());
            for curve in &curves.curves {
                for segment in 0..curve.segments() {
                    let control = curve.cubic(segment).unwrap();
                    for k in 0..=16 {
                        let p = at(&control, f64::from(k) / 16.0);
                        let (x, y) = (p[0], p[1]);
                        // A point within `tolerance` of the graph is at most (1 + steepness) times that above or below it.
                        let steepness = (plain(x + 1e-6) - plain(x - 1e-6)).abs() / 2e-6;
                        let off = (plain(x) - y).abs();
                        assert!(
                            off <= tolerance * (1.1 + 1.1 * steepness) + 1e-14,
                            "{text}, {tolerance:e}: {off:e}"
                        );
                    }
                }
            }
        }
        // Each thousandth of the tolerance takes about 1000^(1/6) to 1000^(1/4) times as many.
        assert!(counts[2] < 400 && counts[2] <= 40 * counts[0], "{text}: {counts:?}");
    }
}

#[test]
fn zeros_on_the_skin_of_the_region_are_named() {
    let side = [Enclosure::new(-1.0, 1.0).unwrap(); 2];
    // The circle through the corners, and one that touches a side from outside.
    let corners: &[[f64; 2]] = &[[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]];
    for (equation, zeros) in [("x^2 + y^2 = 2", corners), ("(x - 2)^2 + y^2 = 1", &[[1.0, 0.0]])] {
        let system = System::parse(&[equation], &["x", "y"], &side).unwrap();
        let curves = CurveSolver::new(1e-3).solve(&system, &()).unwrap();
        for zero in zeros {
            let named = |b: &[Enclosure]| b.iter().zip(zero).all(|(b, x)| b.contains(*x));
            let found = curves.singular.iter().filter(|s| named(&s.bounds)).count();
            let on = |p: &sweepsim_solve::CurvePoint| (p.point[0] - zero[0]).hypot(p.point[1] - zero[1]) < 1e-3;
            let traced = curves.curves.iter().any(|c| c.points.iter().any(on));
            assert!(found == 1 || traced, "{equation}: {zero:?} {curves:?}");
        }
        // Nothing else is, and the boxes are no larger than the tolerance makes them.
        assert!(curves.singular.len() <= zeros.len(), "{equation}: {curves:?}");
        assert!(
            curves
                .singular
                .iter()
                .all(|s| s.bounds.iter().all(|b| b.radius() < 3e-3))
        );
    }
}
