//! Formulas of any shape mean what an evaluation of the same tree says.

use crate::formulas::parse;
use sweepsim_props::*;
use sweepsim_solve::PointSolver;

/// A formula in `x` and `y` with its text, and its own evaluation.
#[derive(Clone, Debug)]
enum Tree {
    X,
    Y,
    Number(u32, u32),
    Operation(char, Box<Tree>, Box<Tree>),
    Negative(Box<Tree>),
    Power(Box<Tree>, u32),
    Function(&'static str, Box<Tree>),
}

impl Tree {
    fn text(&self) -> String {
        match self {
            Self::X => "x".to_owned(),
            Self::Y => " y".to_owned(),
            Self::Number(a, b) => format!("{a}.{b:03}"),
            Self::Operation(c, a, b) => format!("({} {c}{})", a.text(), b.text()),
            Self::Negative(a) => format!("(-{})", a.text()),
            Self::Power(a, k) => format!("({})^{k}", a.text()),
            Self::Function(name, a) => format!("{name}({})", a.text()),
        }
    }

    /// The value at a point (`NaN` where the formula is not defined), and how far rounding may have moved it (to first order, a running error analysis: each operation adds
    /// a few units in its last place, and passes on what its operands bring times its derivative).
    fn value(&self, x: f64, y: f64) -> (f64, f64) {
        let of = |t: &Self| t.value(x, y);
        let (value, passed) = match self {
            Self::X => (x, 0.0),
            Self::Y => (y, 0.0),
            Self::Number(a, b) => (f64::from(*a) + f64::from(*b) / 1000.0, 0.0),
            Self::Operation(c, a, b) => {
                let ((a, da), (b, db)) = (of(a), of(b));
                match c {
                    '+' => (a + b, da + db),
                    '-' => (a - b, da + db),
                    '*' => (a * b, a.abs() * db + b.abs() * da),
                    '/' if b == 0.0 => (f64::NAN, 0.0),
                    _ => (a / b, da / b.abs() + (a / b / b).abs() * db),
                }
            }
            Self::Negative(a) => {
                let (a, da) = of(a);
                (-a, da)
            }
            Self::Power(a, k) => {
                let ((a, da), k) = (of(a), *k as i32);
                (a.powi(k), f64::from(k) * (a.powi(k - 1) * da).abs())
            }
            Self::Function(name, a) => {
                let (a, da) = of(a);
                let (value, slope) = match *name {
                    "sin" => (a.sin(), a.cos()),
                    "cos" => (a.cos(), a.sin()),
                    "tan" => (a.tan(), 1.0 / a.cos().powi(2)),
                    "exp" => (a.exp(), a.exp()),
                    "ln" if a > 0.0 => (a.ln(), 1.0 / a),
                    "ln" => (f64::NAN, 0.0),
                    "sqrt" => (a.sqrt(), 0.5 / a.sqrt()),
                    _ => (a.atan(), 1.0 / (1.0 + a * a)),
                };
                // Of the phase of an argument beyond 1e9 solvers know nothing.
                let lost = a.abs() >= 1e9 && matches!(*name, "sin" | "cos" | "tan");
                (value, if lost { f64::INFINITY } else { slope.abs() * da })
            }
        };
        (value, passed + 4.0 * f64::EPSILON * value.abs())
    }
}

fn tree() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        Just(Tree::X),
        Just(Tree::Y),
        (0u32..4, 0u32..1000).prop_map(|(a, b)| Tree::Number(a, b))
    ];
    leaf.prop_recursive(5, 24, 2, |inner| {
        let two = (
            prop::sample::select(vec!['+', '-', '*', '/']),
            inner.clone(),
            inner.clone(),
        );
        let function = prop::sample::select(vec!["sin", "cos", "tan", "exp", "ln", "sqrt", "atan"]);
        prop_oneof![
            4 => two.prop_map(|(c, a, b)| Tree::Operation(c, Box::new(a), Box::new(b))),
            1 => inner.clone().prop_map(|a| Tree::Negative(Box::new(a))),
            2 => (inner.clone(), 0u32..4).prop_map(|(a, k)| Tree::Power(Box::new(a), k)),
            3 => (function, inner).prop_map(|(name, a)| Tree::Function(name, Box::new(a))),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// `z = f(x, y)` at `x = a`, `y = b` has the root that an evaluation gives, and none where the formula is not defined.
    #[test]
    fn text_means_what_an_evaluation_says(tree in tree(), a in -2.0f64..2.0, b in -2.0f64..2.0) {
        let (truth, error) = tree.value(a, b);
        prop_assume!(!(truth.abs() >= 50.0));
        let system = parse(
            &[&format!("z = {}", tree.text()), &format!("x = {a:?}"), &format!("y = {b:?}")],
            &["x", "y", "z"],
            &[(a - 0.25, a + 0.5), (b - 0.5, b + 0.25), (-60.0, 70.0)],
        );
        let mut solver = PointSolver::default();
        solver.options.boxes = 20_000;
        let points = solver.solve(&system, &()).unwrap();
        let holds = |z: f64| points.unresolved.iter().any(|u| u.bounds[2].lo() - 1e-9 <= z && z <= u.bounds[2].hi() + 1e-9);
        if truth.is_nan() {
            prop_assert!(points.roots.is_empty(), "{} {:?}", tree.text(), points.roots);
        } else {
            // Conditioned badly, both may be off by more than rounding: then the root is near, and its enclosure holds the truth.
            let near = points.roots.iter().any(|r| {
                let (z, slack) = (r.enclosure[2], error + 1e-9);
                let off = (r.point[2] - truth).abs();
                !(off > 1e-6 * (1.0 + truth.abs()) + 2.0 * error || z.lo() - slack > truth || z.hi() + slack < truth)
            });
            prop_assert!(near || holds(truth), "{} at {a}, {b}: {truth} ± {error} {:?}", tree.text(), points);
            prop_assert!(points.roots.len() <= 1);
        }
    }
}
