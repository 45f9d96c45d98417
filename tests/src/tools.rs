//! Tools for tests: the built-in ones and those that are hard.

use sweepsim_motion::{Profile, ProfileSegment, Tool, Turn};

fn line(rho: f64, zeta: f64) -> ProfileSegment {
    ProfileSegment::Line { to: [rho, zeta] }
}

fn arc(to: [f64; 2], centre: [f64; 2], turn: Turn) -> ProfileSegment {
    ProfileSegment::Arc { to, centre, turn }
}

fn tool(segments: Vec<ProfileSegment>) -> Tool {
    Tool::from_profile(Profile::new([0.0, 0.0], segments).expect("a profile"))
}

/// A pilot of radius 2, a concave quarter circle of radius 6 about `(8, 2)`, and a body of radius 8: corners at every
/// joint but none smooth.
#[must_use]
pub fn concave() -> Tool {
    scaled_concave(1.0)
}

/// [`concave`], larger by a factor.
#[must_use]
pub fn scaled_concave(k: f64) -> Tool {
    tool(vec![
        line(2.0 * k, 0.0),
        line(2.0 * k, 2.0 * k),
        arc([8.0 * k, 8.0 * k], [8.0 * k, 2.0 * k], Turn::Cw),
        line(8.0 * k, 30.0 * k),
        line(0.0, 30.0 * k),
    ])
}

/// A drill: a cone of `point` height, a cylinder above it.
///
/// # Panics
/// When the measures are not positive, or the length not above the point.
#[must_use]
pub fn drill(radius: f64, point: f64, length: f64) -> Tool {
    tool(vec![line(radius, point), line(radius, length), line(0.0, length)])
}

/// A lollipop: more than a half ball on a thinner neck.
///
/// # Panics
/// When the neck is not thinner than the ball, or the length not above it.
#[must_use]
pub fn lollipop(radius: f64, neck: f64, length: f64) -> Tool {
    let joint = radius + (radius * radius - neck * neck).sqrt();
    tool(vec![
        arc([neck, joint], [0.0, radius], Turn::Ccw),
        line(neck, length),
        line(0.0, length),
    ])
}

/// One of each kind.
///
/// # Panics
/// Never: the measures are good.
#[must_use]
pub fn zoo() -> Vec<Tool> {
    vec![
        Tool::ball(3.0, 20.0).expect("a ball end"),
        Tool::flat(4.0, 20.0).expect("a flat end"),
        Tool::bull(5.0, 1.5, 20.0).expect("a bull nose"),
        concave(),
        drill(4.0, 1.2, 25.0),
        lollipop(3.0, 1.0, 20.0),
    ]
}
