//! Random machines against dense times, with the separating axes of boxes as judge.

mod matter;

use nalgebra::{Matrix3, Unit, Vector3};
use std::cell::Cell;
use sweepsim_machine::{Body, Contact, Convex, Course, JOINTS, Joint, Limits, Linkage, Outcome, Values, contacts};
use sweepsim_props::*;

/// Straight moves of all joints from corner to corner.
#[derive(Debug, Clone)]
struct Corners(Vec<Values>);

impl Course for Corners {
    fn moves(&self) -> usize {
        self.0.len() - 1
    }

    fn at(&self, number: usize, time: f64) -> Values {
        std::array::from_fn(|k| self.0[number][k] + time * (self.0[number + 1][k] - self.0[number][k]))
    }

    fn bend(&self, _: usize) -> Values {
        Values::default()
    }

    fn joined(&self, number: usize) -> bool {
        number > 0
    }
}

#[derive(Debug, Clone)]
struct Boxed {
    link: usize,
    centre: [f64; 3],
    half: [f64; 3],
}

impl Boxed {
    fn body(&self) -> Body {
        let corner = |sign: f64| std::array::from_fn(|k| self.centre[k] + sign * self.half[k]);
        let solid = Convex::Block {
            min: corner(-1.0),
            max: corner(1.0),
        };
        Body::new("box", self.link, vec![solid]).expect("finite")
    }

    /// Its twelve triangles.
    fn surface(&self) -> Body {
        let corner = |bits: usize| -> [f64; 3] {
            std::array::from_fn(|k| {
                self.centre[k]
                    + if bits >> k & 1 == 1 {
                        self.half[k]
                    } else {
                        -self.half[k]
                    }
            })
        };
        let quads = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let halves = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
        let solids = halves
            .map(|corners: [usize; 3]| Convex::Triangle(corners.map(corner)))
            .collect();
        Body::new("surface", self.link, solids).expect("finite")
    }
}

/// How far two boxes are apart along the best of the fifteen axes that decide it; negative if they overlap.
fn separation(linkage: &Linkage, a: &Boxed, b: &Boxed, at: &Values) -> f64 {
    // All in the coordinates of link 0, by images of points.
    let seen = |solid: &Boxed| {
        let place = |point: [f64; 3]| Vector3::from(linkage.place(point, solid.link, 0, at));
        let centre = place(solid.centre);
        let axes: Vec<Vector3<f64>> = (0..3)
            .map(|k| {
                let mut end = solid.centre;
                end[k] += solid.half[k];
                place(end) - centre
            })
            .collect();
        (centre, Matrix3::from_columns(&axes))
    };
    let ((p, a), (q, b)) = (seen(a), seen(b));
    let sides = |m: &Matrix3<f64>| [0, 1, 2].map(|k| m.column(k).normalize());
    let (of_a, of_b) = (sides(&a), sides(&b));
    let crosses = of_a.iter().flat_map(|u| of_b.iter().map(move |v| u.cross(v)));
    let all = of_a
        .iter()
        .copied()
        .chain(of_b)
        .chain(crosses.filter(|u| u.norm() > 1e-6).map(|u| u.normalize()));
    let reach = |m: &Matrix3<f64>, u: &Vector3<f64>| (m.transpose() * u).abs().sum();
    all.map(|u| (q - p).dot(&u).abs() - reach(&a, &u) - reach(&b, &u))
        .fold(f64::NEG_INFINITY, f64::max)
}

fn direction() -> impl Strategy<Value = Unit<Vector3<f64>>> {
    prop::array::uniform3(-1.0..1.0_f64)
        .prop_filter("not short", |v| Vector3::from(*v).norm() > 0.1)
        .prop_map(|v| Unit::new_normalize(Vector3::from(v)))
}

fn joint() -> impl Strategy<Value = Joint> {
    prop_oneof![
        direction().prop_map(Joint::Linear),
        (direction(), prop::array::uniform3(-50.0..50.0_f64)).prop_map(|(axis, pivot)| Joint::Rotary {
            axis,
            pivot: pivot.into()
        }),
    ]
}

fn boxed(link: usize) -> impl Strategy<Value = Boxed> {
    (
        prop::array::uniform3(-60.0..60.0_f64),
        prop::array::uniform3(2.0..30.0_f64),
    )
        .prop_map(move |(centre, half)| Boxed { link, centre, half })
}

type Scene = (Vec<Joint>, Boxed, Boxed, Corners);

fn scene() -> impl Strategy<Value = Scene> {
    (1..=5_usize).prop_flat_map(|joints| {
        let corner = prop::array::uniform6(-1.0..1.0_f64).prop_map(move |values| -> Values {
            std::array::from_fn(|k| if k < joints { 60.0 * values[k] } else { 0.0 })
        });
        let corners = collection::vec(corner, 2..40).prop_map(Corners);
        let ends = (0..=joints, 0..=joints).prop_flat_map(|(i, j)| (boxed(i), boxed(j)));
        (collection::vec(joint(), joints), ends, corners).prop_map(|(joints, (a, b), corners)| (joints, a, b, corners))
    })
}

const TIMES: usize = 100;

/// Whether an outcome is what dense times show; which one it was.
fn holds(linkage: &Linkage, [a, b]: [&Boxed; 2], corners: &Corners, outcome: &Outcome) -> Result<usize, TestCaseError> {
    let apart = |number: usize, time: f64| separation(linkage, a, b, &corners.at(number, time));
    let all = (0..corners.moves()).flat_map(|number| (0..=TIMES).map(move |k| (number, k as f64 / TIMES as f64)));
    let first = all.clone().find(|(number, time)| apart(*number, *time) < 0.0);
    match outcome {
        Outcome::Apart(least) => {
            prop_assert!(*least > 0.0 && first.is_none(), "{least} but {first:?}");
            // Boxes that are near are told to be: the best of fifteen axes is no more than their distance.
            let nearest = all
                .clone()
                .map(|(number, time)| apart(number, time))
                .fold(f64::INFINITY, f64::min);
            prop_assert!(nearest > 20.0 || *least > 0.6 * nearest - 0.01, "{least} {nearest}");
            Ok(0)
        }
        Outcome::Contact(Contact {
            number, time, depth, ..
        }) => {
            // At that time they overlap, and at no earlier one but for what the tolerance lets them move.
            prop_assert!(apart(*number, *time) < 1e-3, "{}", apart(*number, *time));
            let Some((n, t)) = first else {
                return Ok(2);
            };
            prop_assert!((*number, *time) <= (n, t + 1e-9), "{number} {time} but {n} {t}");
            // What is deep at dense times is deep.
            let rest = (0..=500).map(|k| time + (1.0 - time) * f64::from(k) / 500.0);
            let deepest = rest.map(|time| -apart(*number, time)).fold(0.0, f64::max);
            prop_assert!(
                *depth > 0.95 * deepest - 1e-3 && *depth < 1.5 * deepest + 0.1,
                "{depth} {deepest}"
            );
            Ok(1)
        }
        Outcome::Open(..) => Ok(3),
    }
}

/// Counts what was found, so that each kind of scene is there often.
fn random_scenes(cases: u32, outcome: impl Fn(&Linkage, &Scene) -> Outcome) -> [u32; 4] {
    let counts = Cell::new([0; 4]);
    let mut runner = test_runner::TestRunner::new_with_rng(
        ProptestConfig {
            cases,
            ..ProptestConfig::default()
        },
        test_runner::TestRng::deterministic_rng(test_runner::RngAlgorithm::ChaCha),
    );
    let run = runner.run(&scene(), |scene| {
        let linkage = Linkage::new(scene.0.clone()).expect("few joints");
        let found = outcome(&linkage, &scene);
        let kind = holds(&linkage, [&scene.1, &scene.2], &scene.3, &found)?;
        let mut all = counts.get();
        all[kind] += 1;
        counts.set(all);
        Ok(())
    });
    run.unwrap_or_else(|error| panic!("{error}"));
    counts.get()
}

#[test]
fn boxes_on_random_machines() {
    let [apart, contacts_found, only_between, open] = random_scenes(300, |linkage, (_, a, b, corners)| {
        let found = contacts(linkage, &[a.body(), b.body()], &[(0, 1)], corners, &Limits::new(0.0));
        found.into_iter().next().expect("a pair")
    });
    assert!(apart > 60 && contacts_found > 60, "{apart} {contacts_found}");
    assert!(only_between < 4 && open < 4, "{only_between} {open}");
}

/// The same by surfaces of triangles: what begins within one is found, too.
#[test]
fn surfaces_find_the_same_contacts() {
    let agree = Cell::new(0);
    random_scenes(60, |linkage, (_, a, b, corners)| {
        let bodies = [a.body(), b.body(), b.surface()];
        let found = contacts(linkage, &bodies, &[(0, 1), (0, 2)], corners, &Limits::new(0.0));
        match &found[..] {
            [Outcome::Apart(_), Outcome::Apart(_)] => agree.set(agree.get() + 1),
            [Outcome::Contact(solid), Outcome::Contact(surface)] => {
                // One that starts within the other one comes out of it later.
                if a.link != b.link && (solid.number, solid.time) > (0, 1e-6) {
                    assert_eq!(solid.number, surface.number);
                    assert!((solid.time - surface.time).abs() < 1e-3, "{solid:?} {surface:?}");
                }
                agree.set(agree.get() + 1);
            }
            other => assert!(other.iter().any(|one| matches!(one, Outcome::Open(..))), "{other:?}"),
        }
        found.into_iter().next().expect("a pair")
    });
    assert!(agree.get() > 55, "{}", agree.get());
}

/// A cube about a point of the x axis.
fn cube(link: usize, x: f64, half: f64) -> Boxed {
    Boxed {
        link,
        centre: [x, 0.0, 0.0],
        half: [half; 3],
    }
}

#[test]
fn a_clearance_is_kept_or_broken() {
    let linkage = Linkage::new(vec![Joint::Linear(Vector3::x_axis())]).expect("one joint");
    let still = cube(0, 0.0, 10.0);
    let moved = cube(1, 40.0, 10.0);
    let mut end = [0.0; JOINTS];
    end[0] = -15.0;
    let course = Corners(vec![[0.0; JOINTS], end]);
    let found = |clearance: f64| {
        let limits = Limits::new(clearance);
        contacts(&linkage, &[still.body(), moved.body()], &[(0, 1)], &course, &limits).remove(0)
    };
    // At the end 5 mm are left.
    let Outcome::Apart(least) = found(4.9) else {
        panic!("{:?}", found(4.9))
    };
    assert!((4.9..=5.0).contains(&least));
    let Outcome::Contact(contact) = found(6.0) else {
        panic!("{:?}", found(6.0))
    };
    assert!(
        (contact.time - 14.0 / 15.0).abs() < 1e-3 && (contact.distance - 6.0).abs() < 1e-2,
        "{contact:?}"
    );
    assert!((contact.place[0] - 13.0).abs() < 0.1, "{contact:?}");
    // Just as far as wanted: neither.
    assert!(matches!(found(5.0), Outcome::Open(0, time) if time > 0.99));
    // A joint that may be 0.2 mm beside its course, one way or the other.
    let mut limits = Limits::new(4.9);
    limits.slack[0] = 0.2;
    let found = contacts(&linkage, &[still.body(), moved.body()], &[(0, 1)], &course, &limits);
    assert!(!matches!(found[0], Outcome::Apart(_)), "{found:?}");
}

#[test]
fn a_body_is_there_only_during_its_moves() {
    let linkage = Linkage::new(vec![Joint::Linear(Vector3::x_axis())]).expect("one joint");
    let still = cube(0, 0.0, 10.0);
    let moved = cube(1, 0.0, 5.0);
    // 100 moves, of which the 50th to the 59th go through the box.
    let at = |k: usize| {
        let mut values = [0.0; JOINTS];
        values[0] = if (50..=59).contains(&k) { 0.0 } else { 30.0 };
        values
    };
    let course = Corners((0..=100).map(at).collect());
    let found = |moves: std::ops::Range<usize>| {
        let bodies = [still.body(), moved.body().during(moves)];
        contacts(&linkage, &bodies, &[(0, 1)], &course, &Limits::new(0.0)).remove(0)
    };
    assert!(matches!(found(0..49), Outcome::Apart(_)));
    assert!(matches!(found(60..100), Outcome::Apart(_)));
    assert!(matches!(found(0..100), Outcome::Contact(Contact { number: 49, .. })));
    assert!(matches!(found(53..70), Outcome::Contact(Contact { number: 53, .. })));
}

#[test]
fn work_is_bounded() {
    let axis = Vector3::z_axis();
    let pivot = Vector3::new(-30.0, 0.0, 0.0);
    let linkage = Linkage::new(vec![Joint::Rotary { axis, pivot }]).expect("one joint");
    let still = cube(0, 0.0, 10.0);
    let moved = cube(1, 30.0, 10.0);
    let (mut start, mut end) = ([0.0; JOINTS], [0.0; JOINTS]);
    (start[0], end[0]) = (-20.0, 20.0);
    let found = |tests: usize| {
        let limits = Limits {
            tests,
            ..Limits::new(9.0)
        };
        let bodies = [still.body(), moved.body()];
        contacts(&linkage, &bodies, &[(0, 1)], &Corners(vec![start, end]), &limits).remove(0)
    };
    assert!(matches!(found(100_000), Outcome::Contact(_)), "{:?}", found(100_000));
    assert!(matches!(found(3), Outcome::Open(0, _)), "{:?}", found(3));
}

#[test]
fn a_solid_without_points_makes_no_body() {
    let empty = [
        Convex::Hull(Vec::new()),
        Convex::Turned {
            base: [0.0; 3],
            axis: Vector3::z_axis(),
            circles: Vec::new(),
        },
    ];
    for solid in empty {
        assert!(Body::new("nothing", 0, vec![solid.clone()]).is_none());
        // Nor does it add a point to others.
        let block = Convex::Block {
            min: [10.0; 3],
            max: [20.0; 3],
        };
        let body = Body::new("block", 0, vec![block.clone(), solid]).expect("a block");
        assert_eq!(body.extent(), [[10.0; 3], [20.0; 3]]);
        assert_eq!(body.solids().collect::<Vec<_>>(), [&block]);
    }
}
