//! The bisector of two plane curves: points equidistant from both. It is the curve of pairs of feet `(s, t)` whose
//! normals meet at equal distances; two unknowns and one equation (Elber and Kim 1998), with the point itself found
//! afterwards.
//!
//! `cargo run -p sweepsim-solve --example bisector`

use sweepsim_solve::{Bernstein, CurveSolver, Enclosure, System};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Two cubic arcs, in variables s and t.
    let curve = |c: [[f64; 4]; 2], axis: usize| {
        let degrees = if axis == 0 { [3, 0] } else { [0, 3] };
        c.map(|c| Bernstein::from_fn(&degrees, |i| c[i[axis]]).map(Bernstein::assumed_exact))
    };
    let [px, py] = curve([[0.0, 0.3, 0.7, 1.0], [0.0, 0.2, -0.1, 0.1]], 0);
    let [qx, qy] = curve([[0.0, 0.3, 0.7, 1.0], [0.7, 0.9, 0.6, 0.9]], 1);
    let (p, q) = ([px?, py?], [qx?, qy?]);
    let (dp, dq) = (
        [p[0].derivative(0), p[1].derivative(0)],
        [q[0].derivative(1), q[1].derivative(1)],
    );
    let dot = |a: &[Bernstein; 2], b: &[Bernstein; 2]| a[0].mul(&b[0]).add(&a[1].mul(&b[1]));
    // The point x is on both normals: (x − p)·p' = 0, (x − q)·q' = 0; by Cramer's rule x = X / W with W = p' × q'.
    let w = dp[0].mul(&dq[1]).sub(&dp[1].mul(&dq[0]));
    let (a, b) = (dot(&p, &dp), dot(&q, &dq));
    let x = [a.mul(&dq[1]).sub(&b.mul(&dp[1])), b.mul(&dp[0]).sub(&a.mul(&dq[0]))];
    // |x − p|² = |x − q|², multiplied by W: 2 X·(q − p) = W (|q|² − |p|²).
    let across = [q[0].sub(&p[0]), q[1].sub(&p[1])];
    let equation = dot(&x, &across).scale(2.0).sub(&w.mul(&dot(&q, &q).sub(&dot(&p, &p))));
    let system = System::new(&[Enclosure::UNIT; 2], [equation])?;
    let curves = CurveSolver::new(1e-3).solve(&system, &())?;
    println!(
        "{} arcs, {} loops of feet",
        curves.arcs().count(),
        curves.loops().count()
    );
    let mut points = 0;
    for feet in curves.curves.iter().flat_map(|c| &c.points) {
        let at = |f: &Bernstein| f.evaluate(&feet.point);
        let weight = at(&w);
        // Parallel normals: the point is at infinity, or undetermined.
        if weight.abs() < 1e-6 {
            continue;
        }
        let point = [at(&x[0]) / weight, at(&x[1]) / weight];
        let distance = |c: &[Bernstein; 2]| (point[0] - at(&c[0])).hypot(point[1] - at(&c[1]));
        assert!((distance(&p) - distance(&q)).abs() < 1e-9 * (1.0 + distance(&p)) / weight.abs());
        points += 1;
    }
    println!("{points} points of the bisector");
    assert!(points > 10);
    Ok(())
}
