//! Random tools: outlines with splines, tapers, whole balls, and the cutters of the other tests.

use crate::brute_force::cases::{Cutter, any_tool};
use sweepsim_motion::{Profile, ProfileSegment, Taper, Tool, Turn};
use sweepsim_props::*;

fn line(rho: f64, zeta: f64) -> ProfileSegment {
    ProfileSegment::Line { to: [rho, zeta] }
}

/// A body whose outline is a rational spline, and a neck on it; and both alone, the neck from inside the body.
pub fn spline_tools() -> impl Strategy<Value = [Tool; 3]> {
    let knots = 3_usize..5;
    let radii = collection::vec(0.8..2.4, 5);
    let weights = collection::vec(0.5..2.0, 5);
    (knots, radii, weights, 0.3..0.7).prop_map(|(degree, radii, weights, neck)| {
        // Heights ascend, so that the outline does not cross itself.
        let points: Vec<[f64; 2]> = radii
            .iter()
            .enumerate()
            .map(|(k, rho)| [*rho, 1.1 * k as f64])
            .collect();
        let top = points[4][1];
        let body = || {
            vec![
                line(radii[0], 0.0),
                ProfileSegment::Spline {
                    degree,
                    knots: None,
                    points: points.clone(),
                    weights: Some(weights.clone()),
                },
            ]
        };
        let solid = |start: f64, segments| Tool::from_profile(Profile::new([0.0, start], segments).expect("a profile"));
        let mut whole = body();
        whole.extend([line(neck, top), line(neck, 7.0), line(0.0, 7.0)]);
        let mut alone = body();
        alone.push(line(0.0, top));
        let stick = vec![line(neck, 2.0), line(neck, 7.0), line(0.0, 7.0)];
        [solid(0.0, whole), solid(0.0, alone), solid(2.0, stick)]
    })
}

pub fn tools() -> impl Strategy<Value = Cutter> {
    let splines = spline_tools().prop_map(|[tool, ..]| Cutter {
        name: format!("{:?}", tool.profile()),
        tool,
        radius: 2.4,
    });
    let barrel = (0.2..0.9, 1.05..40.0, 0.0..20.0).prop_map(|(tip, flank, angle): (f64, f64, f64)| {
        let (radius, angle) = (2.0, f64::min(angle, 15.0 * (flank - 1.04)));
        let (tip, flank) = (tip * radius, flank * radius / angle.to_radians().cos());
        let measures = Taper {
            radius,
            tip,
            flank,
            angle,
            length: 90.0,
        };
        Cutter {
            name: format!("Tool::taper({measures:?})"),
            tool: Tool::taper(measures).expect("a cutter"),
            radius,
        }
    });
    let ball = ProfileSegment::Arc {
        to: [0.0, 3.0],
        centre: [0.0, 1.5],
        turn: Turn::Ccw,
    };
    let ball = Tool::from_profile(Profile::new([0.0, 0.0], vec![ball]).expect("a profile"));
    let ball = Cutter {
        name: "a whole ball".into(),
        tool: ball,
        radius: 1.5,
    };
    prop_oneof![3 => splines, 1 => barrel, 1 => Just(ball), 3 => any_tool()]
}
