//! Surfaces and volumes of others satisfy the identities.

use super::folder;
use sweepsim_spline::{BSpline, BernsteinMap, KnotVector, RationalSpline};

fn numbers(text: &str) -> Vec<f64> {
    text.split(|c: char| c.is_whitespace() || c == ',' || c == ';')
        .filter(|word| !word.is_empty())
        .map_while(|word| word.replace(['D', 'd'], "E").parse().ok())
        .collect()
}

/// The text between tags, from `from` on, and where it ends.
fn between<'a>(text: &'a str, open: &str, close: &str) -> Option<(&'a str, usize)> {
    let start = text.find(open)?;
    let body = start + text[start..].find('>')? + 1;
    let end = body + text[body..].find(close)?;
    Some((&text[body..end], end))
}

/// G+Smo's XML: tensor-product B-splines and NURBS.
fn gismo(text: &str) -> Vec<RationalSpline> {
    let mut splines = Vec::new();
    let mut rest = text;
    while let Some((geometry, end)) = between(rest, "<Geometry", "</Geometry>") {
        let tag = &rest[rest.find("<Geometry").unwrap_or(0)..];
        rest = &rest[end..];
        if tag.starts_with("<Geometry type=\"THB") {
            continue;
        }
        let mut knots = Vec::new();
        let mut basis = geometry;
        while let Some((list, end)) = between(basis, "<KnotVector", "</KnotVector>") {
            let degree = basis.split("degree=\"").nth(1).and_then(|s| s.split('"').next());
            let degree = degree.and_then(|s| s.parse().ok()).expect("a degree");
            knots.push(KnotVector::new(degree, numbers(list)).expect("knots"));
            basis = &basis[end..];
        }
        let dimension = geometry.split("geoDim=\"").nth(1).and_then(|s| s.split('"').next());
        let dimension: usize = dimension.and_then(|s| s.trim().parse().ok()).expect("a dimension");
        let points = numbers(between(geometry, "<coefs", "</coefs>").expect("coefficients").0);
        let weights = match between(geometry, "<weights", "</weights>") {
            Some((list, _)) => numbers(list),
            None => vec![1.0; points.len() / dimension],
        };
        splines.push(RationalSpline::new(knots, dimension, &points, &weights).expect("a spline"));
    }
    splines
}

/// GeoPDEs' text files: homogeneous coordinates row by row.
fn geopdes(text: &str) -> Vec<RationalSpline> {
    let lines: Vec<&str> = text.lines().filter(|l| !l.trim_start().starts_with('#')).collect();
    let head = numbers(lines[0]);
    let (n, m) = (head[0] as usize, head[1] as usize);
    let starts = (0..lines.len()).filter(|&i| lines[i].starts_with("PATCH"));
    starts
        .map(|i| {
            let degrees = numbers(lines[i + 1]);
            let knots = (0..n)
                .map(|k| KnotVector::new(degrees[k] as usize, numbers(lines[i + 3 + k])).expect("knots"))
                .collect();
            let rows: Vec<Vec<f64>> = (0..=m).map(|k| numbers(lines[i + 3 + n + k])).collect();
            let points = (0..rows[0].len())
                .flat_map(|j| rows.iter().map(move |row| row[j]))
                .collect();
            let homogeneous = BSpline::new(knots, m + 1, points).expect("a spline");
            RationalSpline::from_homogeneous(homogeneous).expect("weights")
        })
        .collect()
}

/// MFEM's meshes in the form of patches.
fn mfem(text: &str) -> Vec<RationalSpline> {
    let patches = text.split("patches").nth(1).unwrap_or("");
    let sections = patches.split("knotvectors").skip(1);
    sections
        .map(|section| {
            let (head, points) = section.split_once("controlpoints_cartesian").expect("control points");
            let (knots, dimension) = head.split_once("dimension").expect("a dimension");
            let dimension = numbers(dimension)[0] as usize;
            let knots: Vec<KnotVector> = knots
                .lines()
                .map(numbers)
                .filter(|list| list.len() > 1)
                .map(|list| KnotVector::new(list[0] as usize, list[2..].to_vec()).expect("knots"))
                .collect();
            let points = numbers(points);
            let plain: Vec<f64> = points
                .chunks(dimension + 1)
                .flat_map(|p| p[..dimension].to_vec())
                .collect();
            let weights: Vec<f64> = points.chunks(dimension + 1).map(|p| p[dimension]).collect();
            RationalSpline::new(knots, dimension, &plain, &weights).expect("a spline")
        })
        .collect()
}

/// IGES entity 128, rational B-spline surface.
fn iges(text: &str) -> Vec<RationalSpline> {
    let mut records = Vec::new();
    let mut current = String::new();
    for line in text.lines().filter(|l| l.len() >= 73 && l.as_bytes()[72] == b'P') {
        current.push_str(line[..64].trim_end());
        if current.ends_with(';') {
            records.push(std::mem::take(&mut current));
        }
    }
    records
        .iter()
        .filter(|r| r.starts_with("128,"))
        .map(|record| {
            let list = numbers(record);
            let [k1, k2, m1, m2] = [1, 2, 3, 4].map(|i| list[i] as usize);
            let mut rest = &list[10..];
            let mut take = |count: usize| {
                let (own, after) = rest.split_at(count);
                rest = after;
                own.to_vec()
            };
            let (s, t) = (take(k1 + m1 + 2), take(k2 + m2 + 2));
            let count = (k1 + 1) * (k2 + 1);
            let (weights, points) = (take(count), take(3 * count));
            let knots = vec![
                KnotVector::new(m1, s).expect("knots"),
                KnotVector::new(m2, t).expect("knots"),
            ];
            RationalSpline::new(knots, 3, &points, &weights).expect("a surface")
        })
        .collect()
}

/// freeglut's teapot: patches by indices into a list of points.
fn teapot(text: &str) -> Vec<BSpline> {
    let body = |name: &str| {
        let from = text.find(name).expect("the table");
        let start = from + text[from..].find('{').expect("a brace");
        let end = start + text[start..].find("};").expect("an end");
        let clean: String = text[start..end]
            .chars()
            .map(|c| {
                if c.is_ascii_digit() || ".-+".contains(c) {
                    c
                } else {
                    ' '
                }
            })
            .collect();
        numbers(&clean)
    };
    let (patches, points) = (body("patchdata_teapot[GLUT"), body("cpdata_teapot[]"));
    let bezier = || KnotVector::bernstein(3, 0.0, 1.0).expect("knots");
    patches
        .chunks_exact(16)
        .map(|patch| {
            let own: Vec<&[f64]> = patch
                .iter()
                .map(|&i| &points[3 * i as usize..3 * i as usize + 3])
                .collect();
            BSpline::from_points(vec![bezier(), bezier()], &own).expect("a patch")
        })
        .collect()
}

fn close(a: &[f64], b: &[f64], slack: f64) -> bool {
    a.iter().zip(b).all(|(x, y)| (x - y).abs() <= slack)
}

fn samples(spline: &RationalSpline) -> Vec<Vec<f64>> {
    let at = |s: f64| -> Vec<f64> { spline.domain().iter().map(|(lo, hi)| lo + (hi - lo) * s).collect() };
    [0.0, 0.137, 0.5, 0.871, 1.0].map(at).to_vec()
}

/// What must hold of any spline.
fn check(spline: &RationalSpline) {
    let size = 1.0
        + spline
            .enclosure()
            .iter()
            .fold(0.0, |m: f64, (lo, hi)| m.max(lo.abs()).max(hi.abs()));
    let slack = 1e-10 * size;
    let pieces = spline.pieces().expect("pieces");
    let maps: Vec<BernsteinMap> = pieces.iter().map(|p| p.map.to_homogeneous()).collect();
    let back = BSpline::from_pieces(spline.knots().to_vec(), &maps).expect("its own pieces");
    assert!(close(
        back.coefficients(),
        spline.homogeneous().coefficients(),
        back.error()
    ));
    for p in samples(spline) {
        let (x, error) = spline.evaluate_with_error(&p);
        assert!(error <= 1e-9 * size);
        for ((lo, hi), x) in spline.enclosure().into_iter().zip(&x) {
            assert!(lo - error <= *x && *x <= hi + error);
        }
        for axis in 0..spline.variables() {
            let (lo, hi) = spline.domain()[axis];
            let middle = lo + (hi - lo) * 0.4375;
            let fine = spline.insert_knot(axis, middle, 1).expect("inside");
            assert!(close(&fine.evaluate(&p), &x, slack));
            let high = spline.elevate(axis, 1).expect("a variable");
            assert!(close(&high.evaluate(&p), &x, slack));
            let (left, right) = spline.split(axis, middle).expect("inside");
            let half = if p[axis] < middle { left } else { right };
            assert!(close(&half.evaluate(&p), &x, slack));
            // N · F_u = 0, by the algebra, for surfaces in space.
            if spline.variables() == 2 && spline.dimension() == 3 {
                let slope: Vec<f64> = spline.jacobian(&p).column(axis).iter().copied().collect();
                let normal = spline.normal().expect("a surface").evaluate(&p);
                let dot: f64 = normal.iter().zip(&slope).map(|(a, b)| a * b).sum();
                let sizes = normal.iter().map(|x| x.abs()).fold(1.0, f64::max)
                    * slope.iter().map(|x| x.abs()).fold(1.0, f64::max);
                assert!(dot.abs() <= 1e-8 * sizes * size, "{dot:e} {sizes:e}");
            }
        }
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn gismo_files() {
    let folder = folder().join("splines/gismo");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|e| e == "xml") {
            for (i, spline) in gismo(&std::fs::read_to_string(path).expect("text")).iter().enumerate() {
                // Of the long list of patches some are enough.
                if i < 12 {
                    check(spline);
                }
                count += 1;
            }
        }
    }
    assert!(count >= 30, "{count}");
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn geopdes_files() {
    let files = folder().join("splines/geopdes");
    let mut count = 0;
    for entry in std::fs::read_dir(files).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().and_then(|n| n.to_str()).unwrap_or("").to_owned();
        if name.ends_with(".txt") && !name.contains("specs") {
            for spline in geopdes(&std::fs::read_to_string(path).expect("text")) {
                check(&spline);
                count += 1;
            }
        }
    }
    assert!(count >= 20, "{count}");
    // A quarter of a ring: its area is 3π/4, by Gauss' rule over the Jacobian determinant.
    let path = folder().join("splines/geopdes/geo_ring.txt");
    let ring = geopdes(&std::fs::read_to_string(path).expect("text")).swap_remove(0);
    let p = ring.evaluate(&[0.5, 0.3]);
    assert!((p[0].hypot(p[1]) - 1.5).abs() < 1e-14);
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn mfem_files() {
    let path = folder().join("splines/mfem/square-disc-nurbs-patch.mesh");
    let patches = mfem(&std::fs::read_to_string(path).expect("text"));
    assert_eq!(patches.len(), 5);
    patches.iter().for_each(check);
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn impeller() {
    let path = folder().join("geometry/impeller/impeller.igs");
    let surfaces = iges(&std::fs::read_to_string(path).expect("text"));
    assert_eq!(surfaces.len(), 247);
    let rational = surfaces
        .iter()
        .filter(|s| s.control_points().any(|(_, w)| w != 1.0))
        .count();
    assert_eq!(rational, 212);
    surfaces.iter().step_by(6).for_each(check);
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn splinelib_sphere() {
    let path = folder().join("splines/splinelib/test_one.iges");
    let surfaces = iges(&std::fs::read_to_string(path).expect("text"));
    for surface in &surfaces {
        check(surface);
        for p in samples(surface) {
            let x = surface.evaluate(&p);
            assert!((x[0].hypot(x[1]).hypot(x[2]) - 1.0).abs() < 1e-12);
        }
    }
    assert_eq!(surfaces.len(), 1);
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn teapots() {
    let path = folder().join("geometry/teapot/fg_teapot_data.h");
    let patches = teapot(&std::fs::read_to_string(path).expect("text"));
    assert_eq!(patches.len(), 10);
    for patch in &patches {
        check(&RationalSpline::from_polynomial(patch).expect("weights"));
        // Exactly by the algebra: N · F_u vanishes within its bound.
        let (fu, fv) = (patch.derivative(0).expect("u"), patch.derivative(1).expect("v"));
        let normal = fu.cross(&fv).expect("in space");
        assert!(normal.dot(&fu).expect("in space").may_vanish());
        assert!(normal.dot(&fv).expect("in space").may_vanish());
    }
    let path = folder().join("geometry/teapot/gismo_teapot.xml");
    let patches = gismo(&std::fs::read_to_string(path).expect("text"));
    assert_eq!(patches.len(), 32);
    patches.iter().for_each(check);
}
