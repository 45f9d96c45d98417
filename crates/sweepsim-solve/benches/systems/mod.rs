//! Dense systems for timing, shared by benches and examples of the crate.

use sweepsim_solve::{Enclosure, System};
use sweepsim_spline::Bernstein;

/// A named system.
pub struct Named {
    /// Its name.
    pub name: &'static str,
    /// The system.
    pub system: System,
    /// How many roots it has, if that is known, else 0.
    pub roots: usize,
}

fn unit(n: usize) -> Vec<Enclosure> {
    vec![Enclosure::UNIT; n]
}

/// The variable `lo + width·u` as a form.
fn variable(n: usize, axis: usize, lo: f64, width: f64) -> Bernstein {
    Bernstein::variable(n, axis)
        .scale(width)
        .add(&Bernstein::constant(n, lo))
}

/// `Π (x − k/9)`, `k = 1…8`, in each of two variables, as full 9 × 9 tensors: 64 roots.
pub fn wilkinson_grid() -> Named {
    let product = |axis: usize| {
        (1..=8).fold(Bernstein::constant(2, 1.0), |p, k| {
            p.mul(&variable(2, axis, -f64::from(k) / 9.0, 1.0))
        })
    };
    let forms = [product(0), product(1)].map(|f| f.elevated_to(&[8, 8]).assumed_exact());
    Named {
        name: "wilk_grid_8x8",
        system: System::new(&unit(2), &forms).expect("a valid system"),
        roots: 64,
    }
}

/// Two full forms of degree (8, 8) with pseudo-random coefficients.
pub fn dense_degree_8() -> Named {
    let mut state = 12u64;
    let mut next = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / f64::from(1u32 << 30) - 1.0
    };
    let mut form = || Bernstein::from_fn(&[8, 8], |_| next()).expect("a valid form");
    Named {
        name: "dense_deg8_2d",
        system: System::new(&unit(2), [form(), form()]).expect("a valid system"),
        roots: 0,
    }
}

/// `T₄(x) = 0.3 y z` and so on, as full 5 × 5 × 5 tensors: 64 roots.
pub fn chebyshev_3d() -> Named {
    let v = |axis| variable(3, axis, -1.0, 2.0);
    let one = Bernstein::constant(3, 1.0);
    let form = |a: usize| {
        let square = v(a).mul(&v(a));
        let chebyshev = square.mul(&square).scale(8.0).sub(&square.scale(8.0)).add(&one);
        let product = v((a + 1) % 3).mul(&v((a + 2) % 3)).scale(0.3);
        chebyshev.sub(&product).elevated_to(&[4, 4, 4]).assumed_exact()
    };
    Named {
        name: "dense_cheb4_3d",
        system: System::mapped(&[Enclosure::new(-1.0, 1.0).unwrap(); 3], [form(0), form(1), form(2)])
            .expect("a valid system"),
        roots: 64,
    }
}

/// The conformations of cyclohexane: 16 roots in `[−20, 20]³`.
pub fn cyclohexane() -> Named {
    let v = |axis| variable(3, axis, -20.0, 40.0);
    let one = Bernstein::constant(3, 1.0);
    let form = |a: usize, b: usize| {
        let first = v(a).mul(&v(a)).mul(&one.add(&v(b).mul(&v(b))));
        let second = v(b).mul(&v(b).sub(&v(a).scale(24.0)));
        first.add(&second).add(&one.scale(13.0)).assumed_exact()
    };
    Named {
        name: "cyclohexane",
        system: System::mapped(
            &[Enclosure::new(-20.0, 20.0).unwrap(); 3],
            [form(1, 2), form(2, 0), form(0, 1)],
        )
        .expect("a valid system"),
        roots: 16,
    }
}

/// Where a dexel line meets the envelope of a sphere along a cubic path with a turning frame (Eq. 6), in the degrees
/// that a general surface has: (4,4,8), (2,2,3), (2,2,5).
pub fn sphere_sweep() -> Named {
    Named {
        name: "sphere_sweep_eq6",
        system: System::new(&unit(3), sphere_sweep_forms()).expect("a valid system"),
        roots: 0,
    }
}

/// The envelope, and two coordinates less the line's.
fn sphere_sweep_forms() -> [Bernstein; 3] {
    let n = 3;
    let one = Bernstein::constant(n, 1.0);
    // A stereographic patch: (2u, 2v, 1 − u² − v²) / (1 + u² + v²) for u, v in [−1, 1].
    let (u, v) = (variable(n, 0, -1.0, 2.0), variable(n, 1, -1.0, 2.0));
    let squares = u.mul(&u).add(&v.mul(&v));
    let weight = one.add(&squares);
    let sphere = [u.scale(2.0), v.scale(2.0), one.sub(&squares)];
    // A frame that turns about x, and a cubic path.
    let along = |c: &[f64]| Bernstein::from_fn(&[0, 0, c.len() - 1], |i| c[i[2]]).expect("a valid form");
    let angle: f64 = 0.8;
    let (w, c, s) = (
        along(&[1.0, (angle / 2.0).cos(), 1.0]),
        along(&[1.0, (angle / 2.0).cos(), angle.cos()]),
        along(&[0.0, (angle / 2.0).sin(), angle.sin()]),
    );
    let path = [
        along(&[0.0, 1.0, 2.0, 3.0]),
        along(&[0.0, 1.0, -0.5, 0.8]),
        along(&[0.0, 0.2, 0.9, 0.3]),
    ];
    let turned = [
        sphere[0].mul(&w),
        c.mul(&sphere[1]).sub(&s.mul(&sphere[2])),
        s.mul(&sphere[1]).add(&c.mul(&sphere[2])),
    ];
    let envelope = (0..3).fold(Bernstein::constant(n, 0.0), |sum, i| {
        sum.add(&turned[i].mul(&path[i].derivative(2)))
    });
    let envelope = envelope.mul(&weight).mul(&w).mul(&w);
    let x = sphere[0].add(&path[0].sub(&one.scale(1.5)).mul(&weight));
    let y = turned[1].add(&path[1].sub(&one.scale(0.4)).mul(&weight).mul(&w));
    [envelope, x, y].map(Bernstein::assumed_exact)
}

/// Where the same envelope meets a plane (Eq. 4): one arc.
pub fn sphere_section() -> Named {
    let [envelope, x, _] = sphere_sweep_forms();
    Named {
        name: "sphere_section_eq4",
        system: System::new(&unit(3), [envelope, x]).expect("a valid system"),
        roots: 0,
    }
}

/// Where a dexel line meets what a circular edge sweeps along the same motion (Eq. 7), in the degrees (2, 3) and (2,
/// 5).
pub fn edge_sweep() -> Named {
    let n = 2;
    let one = Bernstein::constant(n, 1.0);
    let u = variable(n, 0, -1.0, 2.0);
    let square = u.mul(&u);
    let weight = one.add(&square);
    let along = |c: &[f64]| Bernstein::from_fn(&[0, c.len() - 1], |i| c[i[1]]).expect("a valid form");
    let angle: f64 = 0.8;
    let (w, c) = (
        along(&[1.0, (angle / 2.0).cos(), 1.0]),
        along(&[1.0, (angle / 2.0).cos(), angle.cos()]),
    );
    let (x, y) = (along(&[0.0, 1.0, 2.0, 3.0]), along(&[0.0, 1.0, -0.5, 0.8]));
    let first = u.scale(2.0).add(&x.sub(&one.scale(1.5)).mul(&weight));
    let second = c
        .mul(&one.sub(&square))
        .add(&y.sub(&one.scale(0.6)).mul(&weight).mul(&w));
    let forms = [first, second].map(Bernstein::assumed_exact);
    Named {
        name: "edge_sweep_eq7",
        system: System::new(&unit(n), forms).expect("a valid system"),
        roots: 2,
    }
}

/// Combinations of `(xᵢ − 3/10)(xᵢ − 4/5) + Σ dᵢⱼₖ xⱼ xₖ`, with factors of up to 3/100 for all products of two
/// variables, by a random matrix: no equation shows where a root is.
pub fn quadrics(n: usize, name: &'static str) -> Named {
    let mut state = 17u64;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1 << 23) - 1.0
    };
    // For each equation, the factors of all products of two variables, squares among them.
    let own: Vec<Vec<Vec<f64>>> = (0..n)
        .map(|i| {
            let factor = |j: usize, k: usize, r: f64| if j == k { f64::from(u8::from(i == j)) } else { 0.03 * r };
            (0..n)
                .map(|j| (0..=j).map(|k| factor(j, k, random())).collect())
                .collect()
        })
        .collect();
    let forms: Vec<Bernstein> = (0..n)
        .map(|_| {
            let weights: Vec<f64> = (0..n).map(|_| random()).collect();
            let sum = |of: &dyn Fn(usize) -> f64| weights.iter().enumerate().map(|(e, w)| w * of(e)).sum::<f64>();
            let products: Vec<Vec<f64>> = (0..n)
                .map(|j| (0..=j).map(|k| sum(&|e| own[e][j][k])).collect())
                .collect();
            let form = Bernstein::from_fn(&vec![2; n], |index| {
                // Products of two variables have products of their coefficients; a square has 0, 0, 1.
                let x: Vec<f64> = index.iter().map(|k| 0.5 * *k as f64).collect();
                let product = |j: usize, k: usize| if j == k { f64::floor(x[j]) } else { x[j] * x[k] };
                let squares = (0..n).flat_map(|j| (0..=j).map(move |k| (j, k)));
                let squares = squares.map(|(j, k)| products[j][k] * product(j, k)).sum::<f64>();
                squares + sum(&|e| 0.24 - 1.1 * x[e])
            });
            form.expect("a valid form")
        })
        .collect();
    Named {
        name,
        system: System::new(&unit(n), &forms).expect("a valid system"),
        roots: 1 << n,
    }
}

/// All systems with points as solutions.
pub fn all() -> Vec<Named> {
    vec![
        sphere_sweep(),
        edge_sweep(),
        wilkinson_grid(),
        dense_degree_8(),
        chebyshev_3d(),
        cyclohexane(),
        quadrics(6, "quadrics_6"),
    ]
}
