//! Solids of revolution that cover tools, and that they hold.

use crate::below::prism;
use sweepsim_motion::{Bounds, Dovetail, Lollipop, Patch, Profile, ProfileSegment, Tool, Turn};

/// The radius of a convex polygon beside the axis at a height.
fn radius(solid: &[[f64; 2]], height: f64) -> Option<f64> {
    let at = |pair: &[[f64; 2]]| {
        let ([a, low], [b, high]) = (pair[0], pair[1]);
        let part = (height - low) / (high - low);
        (high > low && (0.0..=1.0).contains(&part)).then_some(a + (b - a) * part)
    };
    solid.windows(2).filter_map(at).reduce(f64::max)
}

/// The largest radius of all that there are.
fn widest(solids: &[Vec<[f64; 2]>], height: f64) -> f64 {
    solids
        .iter()
        .filter_map(|solid| radius(solid, height))
        .fold(0.0, f64::max)
}

const STEPS: u32 = 24;

/// Points of a tool's surface, `(ρ, ζ)`.
fn surface(tool: &Tool) -> Vec<[f64; 2]> {
    let steps = || (0..=STEPS).map(|k| f64::from(k) / f64::from(STEPS));
    let point = |(patch, u, v): (&Patch, f64, f64)| {
        let [x, y, z] = patch.point(u, v);
        [x.hypot(y), z]
    };
    let all = tool.patches().iter();
    all.flat_map(|patch| steps().flat_map(move |u| steps().map(move |v| (patch, u, v))))
        .map(point)
        .collect()
}

/// Nothing of the surface is outside of the hulls, or in a core. How many points were beside a core.
fn bounded(tool: &Tool) -> usize {
    let Bounds { hulls, cores, .. } = tool.bounds();
    let mut beside = 0;
    for [rho, zeta] in surface(tool) {
        let around = widest(hulls, zeta);
        assert!(rho <= around + 1e-9, "{rho} {zeta} {around:?}");
        let within = widest(cores, zeta);
        assert!(rho >= within - 1e-9, "{rho} {zeta} {within}");
        beside += usize::from(within > 0.0);
    }
    let turns = |p: &[[f64; 2]]| (p[1][0] - p[0][0]) * (p[2][1] - p[1][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[1][0]);
    for solid in hulls.iter().chain(cores) {
        assert!(solid.windows(3).all(|three| turns(three) > -1e-12), "{solid:?}");
        assert!(solid[0][0] == 0.0 && solid[solid.len() - 1][0] == 0.0);
    }
    beside
}

fn spline() -> Tool {
    let points = vec![[1.0, 0.0], [4.0, 0.0], [1.5, 5.0], [4.0, 6.0], [5.0, 9.0]];
    let profile = vec![
        ProfileSegment::Line { to: [1.0, 0.0] },
        ProfileSegment::Spline {
            degree: 3,
            points,
            weights: None,
            knots: None,
        },
        ProfileSegment::Line { to: [5.0, 30.0] },
        ProfileSegment::Line { to: [0.0, 30.0] },
    ];
    Tool::from_profile(Profile::new([0.0, 0.0], profile).expect("a profile"))
}

/// A cutter that rounds edges, with a hollow below.
fn hollow() -> Tool {
    let profile = vec![
        ProfileSegment::Line { to: [1.0, -0.5] },
        ProfileSegment::Line { to: [2.0, -0.5] },
        ProfileSegment::Arc {
            to: [5.0, 2.5],
            centre: [5.0, -0.5],
            turn: Turn::Cw,
        },
        ProfileSegment::Line { to: [5.0, 12.0] },
        ProfileSegment::Line { to: [0.0, 12.0] },
    ];
    Tool::from_profile(Profile::new([0.0, 0.0], profile).expect("a profile"))
}

#[test]
fn tools_of_revolution_are_close_between_both() {
    let lollipop = Lollipop {
        radius: 4.0,
        neck: 1.5,
        length: 30.0,
    };
    let dovetail = Dovetail {
        radius: 6.0,
        angle: 60.0,
        height: 5.0,
        neck: 2.5,
        length: 30.0,
    };
    let tools = [
        Tool::ball(3.0, 10.0),
        Tool::flat(3.0, 10.0),
        Tool::bull(3.0, 1.0, 10.0),
        Tool::lollipop(lollipop),
        Tool::dovetail(dovetail),
        Ok(spline()),
        Ok(hollow()),
    ];
    for tool in tools.map(|tool| tool.expect("a tool")) {
        let (radius, top) = (tool.bounding_cylinder().radius, tool.bounding_cylinder().z[1]);
        let free = Tool::from_patches(tool.patches().to_vec(), 1e-9).expect("the same tool");
        assert!(free.profile().is_none());
        for own in [&tool, &free] {
            assert!(bounded(own) > 1000);
            let Bounds { hulls, cores, .. } = own.bounds();
            let corners = |all: &[Vec<[f64; 2]>]| all.iter().map(Vec::len).sum::<usize>();
            assert!(
                hulls.len() < 100 && corners(hulls) < 800,
                "{} {}",
                hulls.len(),
                corners(hulls)
            );
            assert!(
                cores.len() < 100 && corners(cores) < 800,
                "{} {}",
                cores.len(),
                corners(cores)
            );
            // As far apart as their corners are off, measured across: steep lines count less.
            let apart = |k: u32| {
                let at = |k: f64| top * (k + 0.37) / 1000.0;
                let width = |k: f64| [widest(hulls, at(k)), widest(cores, at(k))];
                let ([a, b], k) = (width(f64::from(k)), f64::from(k));
                let slope = (width(k + 0.1)[0] - width(k - 0.1)[0]) / (at(k + 0.1) - at(k - 0.1));
                (a - b) / slope.hypot(1.0)
            };
            let apart = (1..999).map(apart).fold(0.0, f64::max);
            assert!(apart < 3e-3 * radius, "{apart}");
        }
    }
}

/// Between the tip on the axis and a rim below it, there is no tool.
#[test]
fn nothing_is_within_a_hollow() {
    let tool = hollow();
    for own in [
        &tool,
        &Tool::from_patches(tool.patches().to_vec(), 1e-9).expect("the same tool"),
    ] {
        assert!(bounded(own) > 1000);
        let Bounds { hulls, cores, .. } = own.bounds();
        assert_eq!(widest(cores, -0.2), 0.0);
        assert!(widest(hulls, -0.2) > 2.0 && widest(cores, 0.2) > 2.0);
    }
}

#[test]
fn prisms_are_between_cylinders() {
    let cross = [[0, 0], [-1, 0], [0, -1], [-1, -1], [1, 0]];
    let tool = prism(&cross, 16.0);
    assert!(bounded(&tool) > 1000);
    let bounds = tool.bounds();
    let (outer, inner) = (widest(&bounds.hulls, 7.3), widest(&bounds.cores, 7.3));
    assert!(inner > 0.99 && inner <= 1.0, "{inner}");
    assert!(outer >= 5_f64.sqrt() && outer < 2.26, "{outer}");
}

/// Around the axis there is no tool.
#[test]
fn nothing_is_within_a_tool_beside_its_axis() {
    let horseshoe = [[-1, -2], [0, -2], [-2, -1], [-2, 0], [1, -1], [1, 0], [-2, -2], [1, -2]];
    let tool = prism(&horseshoe, 16.0);
    bounded(&tool);
    assert!(tool.bounds().cores.is_empty());
    let beside = prism(&[[1, 0], [2, 0]], 16.0);
    bounded(&beside);
    assert!(beside.bounds().cores.is_empty());
}
