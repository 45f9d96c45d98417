//! A block that a hole is cut into, and a box that comes down on it, judged by corners of boxes.

use super::Corners;
use sweepsim_machine::{Body, Convex, Joint, Limits, Linkage, Matter, Outcome, meets};
use sweepsim_props::*;

type Cuboid = [[f64; 3]; 2];

const BLOCK: Cuboid = [[-50.0, -50.0, -40.0], [50.0, 50.0, 0.0]];

fn common(a: &Cuboid, b: &Cuboid) -> Option<Cuboid> {
    let both = [
        [0, 1, 2].map(|k| a[0][k].max(b[0][k])),
        [0, 1, 2].map(|k| a[1][k].min(b[1][k])),
    ];
    (0..3).all(|k| both[0][k] < both[1][k]).then_some(both)
}

fn is_in(inner: &Cuboid, outer: &Cuboid) -> bool {
    (0..3).all(|k| inner[0][k] >= outer[0][k] && inner[1][k] <= outer[1][k])
}

/// The block, and the hole that is cut in move 0.
struct Holed(Cuboid);

fn around(corners: &[[f64; 3]; 8]) -> Cuboid {
    [f64::min, f64::max]
        .map(|of: fn(f64, f64) -> f64| [0, 1, 2].map(|k| corners.iter().map(|c| c[k]).reduce(of).unwrap()))
}

impl Matter for Holed {
    fn is_gone(&self, corners: &[[f64; 3]; 8], number: usize, _: f64) -> bool {
        number > 0 && is_in(&around(corners), &self.0)
    }

    fn is_whole(&self, corners: &[[f64; 3]; 8], _: usize) -> bool {
        let cell = around(corners);
        is_in(&cell, &BLOCK) && common(&cell, &self.0).is_none()
    }

    fn is_left(&self, point: [f64; 3], _: usize) -> bool {
        let at = [point; 2];
        is_in(&at, &BLOCK) && !is_in(&at, &self.0)
    }
}

/// A box above a place, which comes down by so much in move 1.
#[derive(Clone, Debug)]
struct Case {
    hole: Cuboid,
    place: [f64; 2],
    half: [f64; 2],
    down: f64,
}

fn case() -> impl Strategy<Value = Case> {
    let side = || -45.0..45.0_f64;
    let hole = [side(), side()].prop_flat_map(move |[x, y]| ([x..50.0, y..50.0], 1.0..40.0_f64, Just([x, y])));
    let hole = hole.prop_map(|([x, y], depth, [a, b])| [[a, b, -depth], [x + 1.0, y + 1.0, 0.0]]);
    (hole, [side(), side()], [1.0..30.0_f64, 1.0..30.0], 1.0..60.0_f64).prop_map(|(hole, place, half, down)| Case {
        hole,
        place,
        half,
        down,
    })
}

const ABOVE: f64 = 20.0;

/// The box when it has come down by a share of its way, `grown` on all sides.
fn at(case: &Case, share: f64, grown: f64) -> Cuboid {
    let Case {
        place: [x, y],
        half: [u, v],
        down,
        ..
    } = *case;
    let z = ABOVE - share * down;
    [
        [x - u - grown, y - v - grown, z - grown],
        [x + u + grown, y + v + grown, z + 10.0 + grown],
    ]
}

/// Whether it overlaps what is left of the block.
fn meets_at(case: &Case, share: f64, grown: f64) -> bool {
    common(&at(case, share, grown), &BLOCK).is_some_and(|both| !is_in(&both, &case.hole))
}

/// The side of the largest cube that it shares with what is left of the block.
fn shared(case: &Case, share: f64) -> f64 {
    let Some(both) = common(&at(case, share, 0.0), &BLOCK) else {
        return 0.0;
    };
    let side = |part: &Cuboid| (0..3).map(|k| part[1][k] - part[0][k]).fold(f64::INFINITY, f64::min);
    // What is left of both beyond a side of the hole.
    let beyond = |k: usize, up: bool| {
        let mut part = both;
        if up {
            part[0][k] = part[0][k].max(case.hole[1][k]);
        } else {
            part[1][k] = part[1][k].min(case.hole[0][k]);
        }
        side(&part)
    };
    let parts = (0..3).flat_map(|k| [beyond(k, false), beyond(k, true)]);
    parts
        .chain(common(&both, &case.hole).is_none().then(|| side(&both)))
        .fold(0.0, f64::max)
}

fn first(when: impl Fn(f64) -> bool) -> Option<f64> {
    (0..=4000).map(|k| f64::from(k) / 4000.0).find(|share| when(*share))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]
    #[test]
    fn holes_are_free(case in case()) {
        let Case { place: [x, y], half: [u, v], down, .. } = case;
        let linkage = Linkage::new(vec![Joint::Linear(nalgebra::Vector3::z_axis())]).unwrap();
        let solid = Convex::Block { min: [x - u, y - v, ABOVE], max: [x + u, y + v, ABOVE + 10.0] };
        let body = Body::new("box", 1, vec![solid]).unwrap();
        let joint = |z: f64| [z, 0.0, 0.0, 0.0, 0.0, 0.0];
        let course = Corners(vec![joint(0.0), joint(0.0), joint(-down)]);
        let found = meets(&linkage, &body, (&Holed(case.hole), BLOCK), &course, &Limits::new(0.0));
        let nearly = first(|share| meets_at(&case, share, 0.4));
        // Places are tried 2 mm around, at sixteen times of a move.
        let certain = first(|share| shared(&case, share) > 4.0).map(|share| (16.0 * share).ceil() / 16.0);
        match found {
            Outcome::Apart(_) => prop_assert!(first(|share| meets_at(&case, share, 0.0)).is_none_or(|share| !meets_at(&case, share + 1e-9, -1e-6))),
            Outcome::Contact(contact) => {
                prop_assert_eq!(contact.number, 1);
                prop_assert!(meets_at(&case, contact.time, 1e-6), "{:?}", contact);
                prop_assert!(certain.is_none_or(|time| contact.time <= time), "{:?} {:?}", contact, certain);
            }
            // It is met, or nearly, but in slivers at most.
            Outcome::Open(number, _) => {
                prop_assert!(number == 1 && nearly.is_some() && certain.is_none(), "{:?} {:?}", nearly, certain);
            }
        }
    }
}
