//! Tests of what is not public.

use crate::scene::Curve;
use crate::surface::Surface;
use crate::tool::{Body, bodies};
use std::f64::consts::FRAC_PI_2;

#[test]
fn a_tetrahedron_has_an_inside() {
    let [o, x, y, z] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let triangles = [[o, y, x], [o, x, z], [o, z, y], [x, y, z]];
    let surface = Surface::new(&triangles).expect("closed");
    assert_eq!(surface.is_outside(&[0.1, 0.1, 0.1]), Some(false));
    assert_eq!(surface.is_outside(&[0.5, 0.5, 0.5]), Some(true));
    assert_eq!(surface.is_outside(&[-0.1, 0.1, 0.1]), Some(true));
    let (distance, near) = surface.nearest(&[0.1, 0.2, 0.3]);
    assert!(distance <= 0.1 && distance > 0.1 - 1e-14 && near == [0.0, 0.2, 0.3]);
    assert!(Surface::new(&triangles[1..]).is_err());
    // Inside out: nothing is inside.
    let surface = Surface::new(&triangles.map(|[a, b, c]| [a, c, b])).expect("closed");
    assert_eq!(surface.is_outside(&[0.1, 0.1, 0.1]), Some(true));
}

fn line(from: [f64; 2], to: [f64; 2]) -> Curve {
    Curve::Bezier(vec![(from, 1.0), (to, 1.0)])
}

/// A bull nose of radius 3 with a corner of 1, 10 high.
fn bull() -> Body {
    let corner = Curve::Arc {
        centre: [2.0, 1.0],
        radius: 1.0,
        angles: [-FRAC_PI_2, 0.0],
    };
    let outline = vec![
        line([0.0, 0.0], [2.0, 0.0]),
        corner,
        line([3.0, 1.0], [3.0, 10.0]),
        line([3.0, 10.0], [0.0, 10.0]),
    ];
    bodies(&outline, &[[4, 1]]).expect("a tool").remove(0)
}

#[test]
fn levels_are_distances_from_a_bull_nose() {
    let (bull, mut counts) = (bull(), [0; 2]);
    for i in 0..90 {
        for j in 0..150 {
            // Also along lines on which sides and corners meet.
            let [rho, zeta] = [f64::from(i) * 0.05, f64::from(j) * 0.1 - 2.0];
            let [right, down] = [rho - 2.0, 1.0 - zeta];
            let own = if right > 0.0 && down > 0.0 {
                right.hypot(down) - 1.0
            } else {
                let [out, up] = [rho - 3.0, (zeta - 10.0).max(-zeta)];
                match out > 0.0 && up > 0.0 {
                    true => out.hypot(up),
                    false => out.max(up),
                }
            };
            let level = bull.level([rho, zeta]).expect("part of a tool");
            assert!((level - own).abs() < 1e-12, "({rho}, {zeta}): {level} {own}");
            counts[usize::from(own > 0.0)] += 1;
        }
    }
    assert!(counts[0] > 5000 && counts[1] > 5000, "{counts:?}");
}

#[test]
fn a_hull_is_not_cut_and_removes_nothing() {
    let hull = vec![Curve::Hull(vec![[1.0, 0.0], [4.0, 2.0], [1.0, 3.0]])];
    let all = bodies(&hull, &[[1, 1]]).expect("a tool");
    assert!(all.len() == 1 && all[0].level([0.0, 1.0]).is_none() && all[0].reach > 4.0);
    assert!(bodies(&hull, &[[1, 2]]).is_err());
    // Nor does what is concave, or falls.
    let hollow = vec![
        line([0.0, 0.0], [1.0, 0.0]),
        line([1.0, 0.0], [0.5, 2.0]),
        line([0.5, 2.0], [2.0, 4.0]),
    ];
    let all = bodies(&hollow, &[[3, 1]]).expect("a tool");
    assert!(all[0].level([0.0, 1.0]).is_none());
}
