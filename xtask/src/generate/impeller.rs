//! A radial impeller with seven blades, out of a cylinder, by two ball ends: our own, simple and analytic.
//!
//! About the `z` axis: the hub is the surface of revolution `z = hub(r)`, the blades' tops lie on `z = shroud(r)`, and
//! the middle of a blade is a logarithmic spiral `φ = TWIST · ln(r / INNER)` seen from above. First a large ball end
//! turns the shroud in one spiral. Then a small one runs in and out of each channel, fanned out between the blades,
//! leaning outwards along the channel and, near a blade, over it, which makes the blades thinner towards their tops.

use super::toolpath::{Accuracy, Placement, csv, decimals, sample};
use libm::{cos, log, sin};
use nalgebra::Vector3;
use std::f64::consts::TAU;

pub(super) const BLADES: usize = 7;

/// The cylinder, base at `z = 0`.
pub(super) const RADIUS: f64 = 30.0;
const HEIGHT: f64 = 20.0;

/// Where the channels begin.
const INNER: f64 = 9.5;

/// Radians per e-fold of the radius.
const TWIST: f64 = 0.55;

/// Thickness of a blade where it stands on the hub.
const BLADE: f64 = 2.2;

/// The ball ends and the length of both.
const SHROUD_BALL: f64 = 5.0;
pub(super) const CHANNEL_BALL: f64 = 1.5;
pub(super) const LENGTH: f64 = 40.0;

const ACCURACY: Accuracy = Accuracy { chord: 0.02, turn: 0.2 };

/// Between neighbouring passes, at the outer radius of the channel and between the turns of the shroud's spiral.
const CHANNEL_STEP: f64 = 1.7;
const SHROUD_STEP: f64 = 2.5;

/// Tangent of the tool's lean: outwards along the channel (at its inner and at its outer end), over a blade, and
/// outwards on the shroud.
const LEAN_ALONG: [f64; 2] = [0.55, 0.15];
const LEAN_OVER: f64 = 0.1;
const LEAN_SHROUD: f64 = 0.25;

/// Height of the tip between channels.
pub(super) const SAFE: f64 = 30.0;

/// The job and its paths.
pub fn files() -> Vec<(&'static str, String)> {
    vec![
        ("jobs/impeller.ron", job()),
        ("paths/impeller-shroud.csv", csv(&shroud_path())),
        ("paths/impeller-channels.csv", csv(&channels_path())),
    ]
}

fn job() -> String {
    let edge = RADIUS + 0.5;
    format!(
        "\
// A radial impeller with {BLADES} blades out of a cylinder: the shroud by a large ball end, the channels by a small
// one. Written by `cargo xtask generate` (xtask/src/generate/impeller.rs).
Job(
    units: Mm,
    tolerance: 1e-6,
    grid: Grid(min: (-{edge:?}, -{edge:?}), max: ({edge:?}, {edge:?}), cells: (300, 300)),
    stock: Cylinder(base: (0.0, 0.0, 0.0), axis: (0.0, 0.0, 1.0), radius: {RADIUS:?}, height: {HEIGHT:?}),
    tools: {{
        1: Ball(radius: {SHROUD_BALL:?}, length: {LENGTH:?}),
        2: Ball(radius: {}, length: {LENGTH:?}),
    }},
    paths: [
        Path(tool: 1, file: \"../paths/impeller-shroud.csv\"),
        Path(tool: 2, file: \"../paths/impeller-channels.csv\"),
    ],
)
",
        decimals(CHANNEL_BALL),
    )
}

/// A curve over the radius: its height and its slope.
pub(super) struct Revolved {
    pub low: f64,
    pub rise: f64,
}

/// The hub falls from the boss to the back plate, the shroud from the eye to the outlet: parabolas with their vertex at
/// the rim.
pub(super) const HUB: Revolved = Revolved { low: 3.0, rise: 11.0 };
const SHROUD: Revolved = Revolved { low: 7.5, rise: 12.5 };

impl Revolved {
    pub fn height(&self, r: f64) -> f64 {
        let inwards = (RADIUS - r) / (RADIUS - INNER);
        self.low + self.rise * inwards * inwards
    }

    fn slope(&self, r: f64) -> f64 {
        -2.0 * self.rise * (RADIUS - r) / ((RADIUS - INNER) * (RADIUS - INNER))
    }

    /// The centre of a ball that rests on the curve at radius `r`: `(radius, height)`.
    fn ball_centre(&self, r: f64, ball: f64) -> (f64, f64) {
        let slope = self.slope(r);
        let scale = ball / (1.0 + slope * slope).sqrt();
        (r - slope * scale, self.height(r) + scale)
    }
}

/// The tool whose ball of radius `ball` is centred at `centre`.
fn centred(centre: Vector3<f64>, axis: Vector3<f64>, ball: f64) -> Placement {
    let axis = axis.normalize();
    Placement {
        tip: centre - axis * ball,
        axis,
    }
}

/// One spiral from outside the stock to the eye, then up.
fn shroud_path() -> Vec<Placement> {
    let (outer, inner) = (RADIUS + 2.0, INNER);
    let turns = ((outer - inner) / SHROUD_STEP).ceil();
    let curve = |s: f64| {
        let (r, z) = SHROUD.ball_centre(outer + (inner - outer) * s, SHROUD_BALL);
        let radial = Vector3::new(cos(TAU * turns * s), sin(TAU * turns * s), 0.0);
        centred(
            radial * r + Vector3::z() * z,
            Vector3::z() + radial * LEAN_SHROUD,
            SHROUD_BALL,
        )
    };
    let accuracy = Accuracy {
        chord: 0.05,
        ..ACCURACY
    };
    let quarters = 4.0 * turns;
    let mut path = vec![curve(0.0).lifted(SAFE)];
    // By quarter turns: the samples of a longer piece could all lie on its chord.
    let mut quarter = 0.0;
    while quarter < quarters {
        path.extend(sample(&curve, quarter / quarters, (quarter + 1.0) / quarters, accuracy));
        quarter += 1.0;
    }
    path.push(curve(1.0).lifted(SAFE));
    path
}

/// The angle of the first blade's middle at a radius.
pub(super) fn blade(r: f64) -> f64 {
    TWIST * log(r / INNER)
}

/// The tool in the first channel: `across` from 0 (at the blade of `φ = 0` on the inside) to 1 (at the next), `along`
/// from 0 at the inner end to 1 outside the stock. The ball rests on `floor`.
pub(super) fn in_channel(floor: &Revolved, across: f64, along: f64) -> Placement {
    let (inner, outer) = (INNER, RADIUS + CHANNEL_BALL);
    let touched = inner + (outer - inner) * along;
    let (r, z) = floor.ball_centre(touched, CHANNEL_BALL);
    // The blades are measured along the circle of radius r; the spiral crosses it at a constant angle, so the walls are
    // further apart there by 1/sin of it.
    let slant = (1.0 + TWIST * TWIST).sqrt();
    let margin = (0.5 * BLADE + CHANNEL_BALL) * slant / r;
    let angle = blade(r) + margin + (TAU / BLADES as f64 - 2.0 * margin) * across;
    let radial = Vector3::new(cos(angle), sin(angle), 0.0);
    let sideways = Vector3::new(-radial.y, radial.x, 0.0);
    let forward = (radial + sideways * TWIST) / slant;
    let left = Vector3::new(-forward.y, forward.x, 0.0);
    let lean_along = LEAN_ALONG[0] + (LEAN_ALONG[1] - LEAN_ALONG[0]) * along;
    let lean_over = LEAN_OVER * (2.0 * across - 1.0);
    centred(
        radial * r + Vector3::z() * z,
        Vector3::z() + forward * lean_along + left * lean_over,
        CHANNEL_BALL,
    )
}

/// All channels, one after the other.
fn channels_path() -> Vec<Placement> {
    let width = TAU / BLADES as f64 * RADIUS - BLADE - 2.0 * CHANNEL_BALL;
    let passes = (width / CHANNEL_STEP).ceil() as usize + 1;
    let mut channel = Vec::new();
    for pass in 0..passes {
        let across = pass as f64 / (passes - 1) as f64;
        let (from, to) = if pass % 2 == 0 { (1.0, 0.0) } else { (0.0, 1.0) };
        channel.extend(sample(&|along| in_channel(&HUB, across, along), from, to, ACCURACY));
    }
    let ends = [channel[0], channel[channel.len() - 1]].map(|end| end.lifted(SAFE));
    channel.insert(0, ends[0]);
    channel.push(ends[1]);
    (0..BLADES)
        .flat_map(|blade| {
            let angle = TAU * blade as f64 / BLADES as f64;
            let turn = (cos(angle), sin(angle));
            channel
                .iter()
                .map(move |placement| placement.turned(turn))
                .collect::<Vec<_>>()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ball_rests_on_the_hub() {
        for (across, along) in [(0.0, 0.1), (0.5, 0.5), (1.0, 0.9)] {
            let tool = in_channel(&HUB, across, along);
            let centre = tool.tip + tool.axis * CHANNEL_BALL;
            let r = centre.xy().norm();
            let nearest = (0..=4000)
                .map(|k| INNER - 3.0 + 30.0 * f64::from(k) / 4000.0)
                .map(|x| (r - x).hypot(centre.z - HUB.height(x)))
                .fold(f64::INFINITY, f64::min);
            assert!(
                (nearest - CHANNEL_BALL).abs() < 1e-4,
                "the ball is {nearest} from the hub"
            );
        }
    }

    #[test]
    fn the_paths_are_of_a_sensible_size() {
        let moves = shroud_path().len() + channels_path().len();
        assert!((1_000..2_500).contains(&moves), "{moves} moves");
        let channels = channels_path();
        assert_eq!(channels.len() % BLADES, 0);
        assert!(channels.iter().chain(&shroud_path()).all(|tool| tool.tip.z > 0.0));
    }
}
