//! Colours of surfaces and of the background.

use crate::base::vector::{Vector, add, along, dot, mix, scale, smooth_step, times, unit};
use crate::camera::Camera;
use crate::legend;
use crate::light::{Around, Lights, NET_REACH};

/// A patch of surface within a pixel.
#[derive(Clone, Copy)]
pub(crate) struct PixelPatch {
    pub at: Vector,
    pub normal: Vector,
    pub around: Around,
    /// 1 for cut, 0 for stock; in pictures of values the value from −1 to 1, or NaN if unknown.
    pub value: f32,
    pub matter: Matter,
}

/// What a sample sees.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Matter {
    /// A face coloured by what made it.
    Metal,
    /// A face coloured by its value.
    Value,
    /// The inside, cut open by a section.
    Section,
    /// A face of the tool.
    Tool,
}

/// Bronze for faces that a tool cut, steel for those of the stock.
const CUT: Vector = [0.66, 0.345, 0.155];
const STOCK: Vector = [0.135, 0.19, 0.26];
/// Pale clay with fine stripes for the inside of a part.
const CLAY: Vector = [0.60, 0.50, 0.43];
/// Pale brass for the tool.
const TOOL: Vector = [0.62, 0.56, 0.36];
/// Stripes per radius of the part, and their brightness.
const STRIPES: f32 = 34.0;
const STRIPE: f32 = 0.82;
/// A face whose value is unknown.
const UNKNOWN: Vector = [0.055, 0.05, 0.06];
const LAMP: Vector = [2.75, 2.62, 2.42];
const SKY: Vector = [0.78, 0.86, 1.0];
const GROUND: Vector = [0.52, 0.50, 0.47];

/// The blurred reflection of the surroundings in a direction.
fn surroundings(d: Vector) -> Vector {
    let sky = mix([1.05, 1.05, 1.05], [0.36, 0.44, 0.58], smooth_step(0.05, 0.95, d[2]));
    mix([0.24, 0.23, 0.225], sky, smooth_step(-0.25, 0.22, d[2]))
}

/// The light from a patch to the eye: linear, tone-mapped to 0…1.
pub(crate) fn shade(camera: &Camera, lights: &Lights, patch: &PixelPatch) -> Vector {
    let n = unit(patch.normal);
    let view = camera.towards(patch.at);
    let (base, shine) = match patch.matter {
        Matter::Metal => (mix(STOCK, CUT, patch.value), 0.32 + 0.30 * patch.value),
        Matter::Value if patch.value.is_nan() => (UNKNOWN, 0.1),
        Matter::Value => (legend::colour(patch.value), 0.08),
        Matter::Tool => (TOOL, 0.45),
        Matter::Section => (scale(CLAY, stripes(patch.at, n)), 0.0),
    };
    let cosine = dot(n, lights.lamp);
    let lamp = if cosine > 0.0 { lights.lamp_at(patch.at, n) } else { 0.0 };
    let open = (patch.around.sky + patch.around.ground).min(1.0);
    let diffuse = add(
        scale(LAMP, lamp * cosine.max(0.0) * 0.60),
        add(
            scale(SKY, 0.62 * patch.around.sky.powf(1.3)),
            add(
                scale(GROUND, 0.5 * patch.around.ground),
                // Light reflected by other faces of the part.
                scale(base, 0.08 + 0.45 * (1.0 - open)),
            ),
        ),
    );
    // Metal tints its reflections with its own colour, except at grazing angles.
    let facing = dot(n, view).clamp(0.0, 1.0);
    let mirrored = along(scale(view, -1.0), 2.0 * dot(n, view), n);
    let fresnel = (1.0 - facing).powi(5);
    let tint = mix(mix(base, [0.8; 3], 0.25), [1.0; 3], 0.6 * fresnel);
    let halfway = unit(add(view, lights.lamp));
    let glint = dot(n, halfway).max(0.0);
    let glint = 0.55 * glint.powi(28) + 0.35 * glint.powi(120);
    let specular = add(
        scale(surroundings(mirrored), 0.75 * open * open.sqrt()),
        scale(LAMP, glint * lamp * smooth_step(0.0, 0.15, cosine)),
    );
    let light = add(
        scale(times(base, diffuse), 1.0 - 0.45 * shine),
        scale(times(tint, specular), shine),
    );
    light.map(|c| film(0.74 * c))
}

/// Diagonal stripes on a plane, with soft edges.
fn stripes(p: Vector, n: Vector) -> f32 {
    // Stripes look alike on planes across all three axes.
    let axis = (0..3).fold(0, |a, k| if n[k].abs() > n[a].abs() { k } else { a });
    let phase = (p[(axis + 1) % 3] + p[(axis + 2) % 3]) * STRIPES;
    let wave = (phase.fract() + 1.0).fract();
    let edge = smooth_step(0.0, 0.12, wave) * (1.0 - smooth_step(0.38, 0.5, wave));
    1.0 + edge * (STRIPE - 1.0)
}

/// Tone mapping: Narkowicz's fit of the ACES film curve, which never clips highlights.
fn film(x: f32) -> f32 {
    ((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)).clamp(0.0, 1.0)
}

/// The background at a point of the image, from −1 to 1 to the right and up.
pub(crate) fn background(camera: &Camera, lights: &Lights, ground: f32, x: f32, y: f32) -> Vector {
    let low = [0.64, 0.665, 0.69];
    let high = [0.90, 0.915, 0.93];
    let vignette = 1.0 - 0.10 * smooth_step(0.6, 1.9, x * x + y * y);
    let colour = scale(mix(low, high, smooth_step(-1.1, 0.9, y)), vignette);
    let [from, ray] = camera.sight(x, y);
    let distance = (ground - from[2]) / ray[2];
    if !(ray[2] < 0.0 && distance > 0.0 && distance.is_finite()) {
        return colour;
    }
    let p = along(from, distance, ray);
    let near = 1.0 - smooth_step(0.6 * NET_REACH, 0.98 * NET_REACH, p[0].hypot(p[1]));
    let [sky, lamp] = lights.ground(p[0], p[1]);
    let shadow = 1.0 - near * (0.62 * (1.0 - sky) + 0.30 * (1.0 - lamp));
    times(colour, mix([0.12, 0.15, 0.20], [1.0; 3], shadow.clamp(0.0, 1.0)))
}

/// The sRGB byte of a linear value, after adding `noise` in bytes.
pub(crate) fn srgb(x: f32, noise: f32) -> u8 {
    let x = x.clamp(0.0, 1.0);
    let y = if x <= 0.003_130_8 {
        12.92 * x
    } else {
        1.055 * x.powf(1.0 / 2.4) - 0.055
    };
    (255.0 * y + 0.5 + noise) as u8
}
