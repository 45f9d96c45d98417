//! What explains a picture: its axes and its scale.

use crate::base::glyphs::{stroke, write};
use crate::base::image::Image;
use crate::base::vector::dot;
use crate::camera::Camera;
use crate::scene::Scene;

/// Smaller images have neither axes nor scale: there is no room.
const LEAST: f32 = 240.0;
/// The colour of texts and of the scale.
const INK: [u8; 3] = [38, 44, 54];
/// The axes: name and colour.
const AXES: [(&str, [u8; 3]); 3] = [("x", [176, 58, 46]), ("y", [47, 125, 70]), ("z", [40, 84, 160])];

/// Draws the directions of the axes in the lower left corner of an image, and beside them a length, as long as it is in
/// the middle of the part.
pub(crate) fn draw(image: &mut Image, scene: &Scene, camera: &Camera) {
    let [width, height] = image.size().map(|n| n as f32);
    let size = height.min(0.75 * width);
    if size < 0.75 * LEAST {
        return;
    }
    let (text, arm) = (0.022 * size, 0.055 * size);
    let pen = (0.0022 * size).max(1.0);
    let origin = [0.09 * size, height - 0.09 * size];
    // The farthest first: the nearer ones cover it.
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| camera.forward[*b].total_cmp(&camera.forward[*a]));
    for axis in order {
        let (name, colour) = AXES[axis];
        let along = [camera.right[axis], -camera.up[axis]];
        let tip = [0, 1].map(|k| origin[k] + arm * along[k]);
        stroke(image, [origin, tip], pen, colour);
        // The name stands beyond the tip, or beside an axis that points at the viewer.
        let length = along[0].hypot(along[1]);
        let beyond = if length > 0.15 {
            along.map(|c| c / length)
        } else {
            [0.7, 0.7]
        };
        let middle = [0, 1].map(|k| tip[k] + 0.85 * text * beyond[k]);
        write(
            image,
            name,
            [middle[0] - 0.33 * text, middle[1] - 0.5 * text],
            text,
            colour,
        );
    }
    if scene.triangles.is_empty() {
        return;
    }
    // Across the line of sight, where the centre of the part is.
    let scale = camera.pixels(-dot(camera.eye(), camera.forward), width);
    let Some((length, pixels)) = round_length(scene.radius, scale, 0.16 * width) else {
        return;
    };
    let (left, base) = (origin[0] + 2.2 * arm, height - 0.045 * size);
    let right = left + pixels;
    stroke(image, [[left, base], [right, base]], pen, INK);
    for x in [left, right] {
        stroke(image, [[x, base - 0.4 * text], [x, base + 0.4 * text]], pen, INK);
    }
    write(image, &format!("{length} mm"), [left, base - 1.9 * text], text, INK);
}

/// The longest length of the form 1, 2 or 5 × 10ⁿ that takes at most so many pixels, in the mesh's units and in pixels.
/// `radius` is the mesh's size for a unit of the scene, `scale` the pixels of such a unit.
fn round_length(radius: f64, scale: f32, most: f32) -> Option<(f64, f32)> {
    let longest = radius * f64::from(most) / f64::from(scale);
    if !(1e-9..1e12).contains(&longest) {
        return None;
    }
    let power = longest.log10().floor() as i32;
    // Parsed, not multiplied: 2e-1 is 0.2.
    let candidates = [(5, power), (2, power), (1, power), (5, power - 1)];
    let lengths = candidates.map(|(digit, power)| format!("{digit}e{power}").parse::<f64>());
    let length = lengths.into_iter().flatten().find(|length| *length <= longest)?;
    Some((length, (length / radius) as f32 * scale))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_round_and_as_long_as_there_is_room() {
        for radius in [1e-3, 0.7, 33.0, 4e5] {
            for scale in [80.0, 333.3] {
                let (length, pixels) = round_length(radius, scale, 100.0).unwrap();
                assert!((f64::from(pixels) - length / radius * f64::from(scale)).abs() < 1e-3);
                assert!(pixels <= 100.0 && pixels > 39.9, "{pixels}");
                let digits: String = length.to_string().chars().filter(|c| ('1'..='9').contains(c)).collect();
                assert!(["1", "2", "5"].contains(&digits.as_str()), "{length}");
            }
        }
        assert_eq!(round_length(f64::NAN, 1.0, 1.0), None);
        assert_eq!(round_length(1.0, 0.0, 1.0), None);
    }
}
