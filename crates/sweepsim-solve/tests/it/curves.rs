//! Curves: random curves against marching squares, symmetries, and the polylines' distance.

use crate::support;

use std::time::{Duration, Instant};
use support::audit::audit_curves;
use sweepsim_solve::{CurveSolver, Enclosure, SolveOptions, System};
use sweepsim_spline::Bernstein;

fn solver(tolerance: f64) -> CurveSolver {
    let mut solver = CurveSolver::new(tolerance);
    solver.options.time = Some(Duration::from_secs(60));
    solver
}

struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / f64::from(1u32 << 30) - 1.0
    }
}

fn unit(n: usize) -> Vec<Enclosure> {
    vec![Enclosure::UNIT; n]
}

/// Components by marching squares on a fine grid, saddles by the value in the middle: (loops, arcs); `None` where two grids disagree.
fn marching(form: &Bernstein) -> Option<(usize, usize)> {
    let count = |n: usize| {
        let value: Vec<bool> = (0..=n)
            .flat_map(|i| (0..=n).map(move |j| (i, j)))
            .map(|(i, j)| form.evaluate(&[i as f64 / n as f64, j as f64 / n as f64]) > 0.0)
            .collect();
        let at = |i: usize, j: usize| value[i * (n + 1) + j];
        // Edges: (i, j, 0) to the right of a grid point, (i, j, 1) above.
        let id = |i: usize, j: usize, d: usize| (i * (n + 1) + j) * 2 + d;
        let mut parent: Vec<usize> = (0..(n + 1) * (n + 1) * 2).collect();
        fn find(p: &mut [usize], mut x: usize) -> usize {
            while p[x] != x {
                p[x] = p[p[x]];
                x = p[x];
            }
            x
        }
        let mut crossed = Vec::new();
        for i in 0..n {
            for j in 0..n {
                let edges = [
                    (at(i, j) != at(i + 1, j), id(i, j, 0)),
                    (at(i + 1, j) != at(i + 1, j + 1), id(i + 1, j, 1)),
                    (at(i, j + 1) != at(i + 1, j + 1), id(i, j + 1, 0)),
                    (at(i, j) != at(i, j + 1), id(i, j, 1)),
                ];
                let on: Vec<usize> = edges.iter().filter(|e| e.0).map(|e| e.1).collect();
                let pairs: Vec<(usize, usize)> = match on[..] {
                    [a, b] => vec![(a, b)],
                    [a, b, c, d] => {
                        let middle = form.evaluate(&[(i as f64 + 0.5) / n as f64, (j as f64 + 0.5) / n as f64]) > 0.0;
                        // Bottom-right and top-left corners cut off, or the other two.
                        if middle == at(i, j) {
                            vec![(a, b), (c, d)]
                        } else {
                            vec![(a, d), (b, c)]
                        }
                    }
                    _ => vec![],
                };
                for (a, b) in pairs {
                    crossed.extend([a, b]);
                    let (x, y) = (find(&mut parent, a), find(&mut parent, b));
                    parent[x] = y;
                }
            }
        }
        // An edge that only one segment uses is an end.
        let mut uses = std::collections::BTreeMap::new();
        for e in &crossed {
            *uses.entry(*e).or_insert(0) += 1;
        }
        let mut ends = std::collections::BTreeMap::new();
        for (e, u) in &uses {
            *ends.entry(find(&mut parent, *e)).or_insert(0) += usize::from(*u == 1);
        }
        let arcs = ends.values().filter(|e| **e > 0).count();
        (ends.len() - arcs, arcs)
    };
    let (a, b) = (count(128), count(301));
    (a == b).then_some(a)
}

#[test]
fn random_plane_curves_agree_with_marching_squares() {
    let mut random = Random(7);
    let (mut compared, mut loops) = (0, 0);
    for number in 0..120 {
        let d = [2 + number % 5, 2 + number / 5 % 4];
        let form = Bernstein::from_fn(&d, |_| random.unit()).unwrap();
        let system = System::new(&unit(2), [&form]).unwrap();
        let curves = solver(1e-3).solve(&system, &()).unwrap();
        assert!(curves.singular.is_empty(), "{number}");
        audit_curves(&curves, &unit(2), &number.to_string());
        let found = (curves.loops().count(), curves.arcs().count());
        if let Some(expected) = marching(&form) {
            assert_eq!(found, expected, "{number}");
            compared += 1;
            loops += found.0;
        }
        // Vertices on the curve; and the curve near the chords: the middle of each, moved onto the curve, moves little.
        for p in curves.curves.iter().flat_map(|c| &c.points) {
            assert!(form.evaluate(&p.point).abs() < 1e-12);
        }
        for pair in curves.curves.iter().flat_map(|c| c.points.windows(2)) {
            let mut x = [0, 1].map(|j| 0.5 * (pair[0].point[j] + pair[1].point[j]));
            let start = x;
            for _ in 0..20 {
                let mut g = [0.0; 2];
                let f = form.evaluate_gradient(&x, &mut g);
                let factor = f / (g[0] * g[0] + g[1] * g[1]);
                x = [x[0] - factor * g[0], x[1] - factor * g[1]];
            }
            let moved = (x[0] - start[0]).hypot(x[1] - start[1]);
            assert!(moved < 1.2e-3, "{number}: {moved}");
        }
    }
    assert!(compared > 100 && loops > 3, "{compared}, {loops}");
}

#[test]
fn symmetries_change_no_topology() {
    let mut random = Random(8);
    let topology = |forms: &[Bernstein], bounds: &[Enclosure]| {
        let system = System::mapped(bounds, forms).unwrap();
        let curves = solver(1e-2).solve(&system, &()).unwrap();
        (curves.loops().count(), curves.arcs().count(), curves.singular.len())
    };
    let mut all = 0;
    for number in 0..40 {
        let mut form = || Bernstein::from_fn(&[2, 2, 3], |_| random.unit()).unwrap();
        let forms = [form(), form()];
        let plain = topology(&forms, &unit(3));
        assert_eq!(plain.2, 0, "{number}");
        all += plain.0 + plain.1;
        let exchanged = [forms[1].scale(3e5).assumed_exact(), forms[0].clone()];
        assert_eq!(topology(&exchanged, &unit(3)), plain, "{number}: equations exchanged");
        let cycled = forms
            .clone()
            .map(|f| Bernstein::from_fn(&[3, 2, 2], |i| f.coefficients()[i[1] + 3 * i[2] + 9 * i[0]]).unwrap());
        assert_eq!(topology(&cycled, &unit(3)), plain, "{number}: variables permuted");
        let mirrored = forms
            .clone()
            .map(|f| Bernstein::from_fn(&[2, 2, 3], |i| f.coefficients()[2 - i[0] + 3 * i[1] + 9 * i[2]]).unwrap());
        assert_eq!(topology(&mirrored, &unit(3)), plain, "{number}: mirrored");
        let far = [
            Enclosure::new(-5.0, 400.0).unwrap(),
            Enclosure::new(1e3, 1e3 + 1.0).unwrap(),
            Enclosure::new(0.0, 1e-3).unwrap(),
        ];
        assert_eq!(topology(&forms, &far), plain, "{number}: another box");
        let mixed = [
            forms[0].sub(&forms[1]).assumed_exact(),
            forms[0].add(&forms[1]).assumed_exact(),
        ];
        assert_eq!(topology(&mixed, &unit(3)), plain, "{number}: equations mixed");
    }
    assert!(all > 40, "{all}");
}

#[test]
fn pieces_handed_over_join_to_the_same_curves() {
    let mut random = Random(9);
    let mut pieces_in_all = 0;
    for number in 0..30 {
        let form = Bernstein::from_fn(&[4, 3], |_| random.unit()).unwrap();
        let system = System::new(&unit(2), [&form]).unwrap();
        let whole = solver(1e-3).solve(&system, &()).unwrap();
        let mut pieces = Vec::new();
        let rest = solver(1e-3).for_each_piece(&system, &(), |p| pieces.push(p)).unwrap();
        assert!(rest.curves.is_empty() && rest.singular.is_empty(), "{number}");
        pieces_in_all += pieces.len();
        // Each number is the end of one piece and the start of at most one other; both have it at the same place.
        let mut ends = std::collections::BTreeMap::new();
        for p in &pieces {
            ends.entry(p.ends[0]).or_insert([None, None])[0] = Some(&p.points[0].point);
            ends.entry(p.ends[1]).or_insert([None, None])[1] = p.points.last().map(|q| &q.point);
        }
        let free = ends.values().filter(|e| e.contains(&None)).count();
        assert_eq!(free, 2 * whole.arcs().count(), "{number}");
        for pair in ends.values() {
            if let [Some(a), Some(b)] = pair {
                assert_eq!(a, b, "{number}");
            }
        }
        let vertices: usize = pieces.iter().map(|p| p.points.len() - 1).sum();
        let kept: usize = whole
            .curves
            .iter()
            .map(|c| c.points.len() - usize::from(c.ends.is_some()))
            .sum();
        assert_eq!(vertices, kept, "{number}");
    }
    assert!(pieces_in_all > 60, "{pieces_in_all}");
}

#[test]
fn loops_are_found_however_small() {
    // (x − a)² + (y − b)² = r²
    for exponent in 1..=7 {
        let r = 10f64.powi(-exponent);
        let (a, b) = (0.377, 0.581);
        let x = Bernstein::variable(2, 0).sub(&Bernstein::constant(2, a));
        let y = Bernstein::variable(2, 1).sub(&Bernstein::constant(2, b));
        let circle = x
            .mul(&x)
            .add(&y.mul(&y))
            .sub(&Bernstein::constant(2, r * r))
            .assumed_exact();
        let system = System::new(&unit(2), [&circle]).unwrap();
        let curves = solver(1e-2 * r).solve(&system, &()).unwrap();
        assert_eq!((curves.loops().count(), curves.curves.len()), (1, 1), "{r}");
        assert!(curves.singular.is_empty());
    }
}

#[test]
fn bad_input_is_an_error_or_open() {
    let circle = Bernstein::from_fn(&[2, 2], |i| [0.25, -0.25, 0.25][i[0]] + [0.25, -0.25, 0.25][i[1]] - 0.1).unwrap();
    let twice = System::new(&unit(2), [&circle, &circle]).unwrap();
    assert!(solver(1e-3).solve(&twice, &()).is_err());
    let once = System::new(&unit(2), [&circle]).unwrap();
    assert!(solver(f64::NAN).solve(&once, &()).is_err());
    assert!(solver(0.0).solve(&once, &()).is_err());
    let line = System::new(&unit(1), [Bernstein::variable(1, 0)]).unwrap();
    assert!(solver(1e-3).solve(&line, &()).is_err());
    // An equation that is zero; a double circle: open, soon.
    let start = Instant::now();
    for form in [Bernstein::constant(2, 0.0), circle.mul(&circle).assumed_exact()] {
        let system = System::new(&unit(2), [&form]).unwrap();
        let mut solver = CurveSolver::with_options(1e-3, SolveOptions::default().smallest(1e-6));
        let curves = solver.solve(&system, &()).unwrap();
        assert!(!curves.singular.is_empty());
    }
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
}

#[test]
fn tangents_and_tolerances_hold_on_domains_of_any_width() {
    // The same two curves, a circle in a plane and a tilted ellipse in space, with sides from 1e-250 to 1e200.
    let square = |n: usize, axis: usize| {
        let x = Bernstein::variable(n, axis).sub(&Bernstein::constant(n, 0.5));
        x.mul(&x)
    };
    let circle = square(2, 0).add(&square(2, 1)).sub(&Bernstein::constant(2, 0.16));
    let cylinder = square(3, 0).add(&square(3, 1)).sub(&Bernstein::constant(3, 0.16));
    let plane = Bernstein::variable(3, 2)
        .sub(&Bernstein::variable(3, 0).scale(0.5))
        .sub(&Bernstein::constant(3, 0.25));
    for (widths, forms) in [
        (vec![1.0, 1.0], vec![circle.clone()]),
        (vec![1e-200, 1e-200], vec![circle.clone()]),
        (vec![1e-200, 1.0], vec![circle.clone()]),
        (vec![1e-250, 1e200], vec![circle]),
        (vec![1e-200, 1.0, 1.0], vec![cylinder.clone(), plane.clone()]),
        (vec![1e-200, 1e-100, 1e-200], vec![cylinder.clone(), plane.clone()]),
        (vec![1e-250, 1e-250, 1e-250], vec![cylinder, plane]),
    ] {
        let domain: Vec<Enclosure> = widths.iter().map(|w| Enclosure::new(0.0, *w).unwrap()).collect();
        let system = System::mapped(&domain, forms).unwrap();
        let widest = widths.iter().fold(0.0, |m: f64, w| m.max(*w));
        let curves = CurveSolver::new(1e-3 * widest).solve(&system, &()).unwrap();
        assert_eq!(
            (curves.loops().count(), curves.curves.len(), curves.singular.len()),
            (1, 1, 0),
            "{widths:?}"
        );
        let points = &curves.curves[0].points;
        for (k, p) in points.iter().enumerate() {
            let length: f64 = p.tangent.iter().map(|x| x * x).sum();
            assert!((length - 1.0).abs() < 1e-14, "{widths:?}: {:?}", p.tangent);
            // Every chord's middle is within the tolerance of the curve: by angle in the plane of the circle.
            let q = &points[(k + 1) % points.len()];
            let middle = |j: usize| 0.5 * (p.point[j] + q.point[j]) / widths[j] - 0.5;
            // Along the radius, or along either axis, whichever is shorter in the domain's units.
            let (x, y) = (middle(0), middle(1));
            let scale = 0.4 / x.hypot(y) - 1.0;
            let along = |own: f64, other: f64| (own.abs() - (0.16 - other * other).max(0.0).sqrt()).abs();
            let units = [widths[0] / widest, widths[1] / widest];
            let radial = (x * scale * units[0]).hypot(y * scale * units[1]);
            let distance = radial.min(along(x, y) * units[0]).min(along(y, x) * units[1]);
            assert!(distance <= 1e-3, "{widths:?}: {distance}");
        }
    }
}
