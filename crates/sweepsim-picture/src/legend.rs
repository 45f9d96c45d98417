//! The colour map of values, and the scale beside a picture that explains it.

use crate::base::glyphs::{ink, write};
use crate::base::image::Image;
use crate::base::vector::{Vector, mix};
use crate::shade::srgb;

/// The share of an image's width that the scale needs: a value for [`View::legend`](crate::View::legend).
pub const WIDTH: f64 = 0.13;

/// Linear colours of the values −1, −0.5, 0, 0.5 and 1: blue, pale grey, red, darker towards both ends.
const COLOURS: [Vector; 5] = [
    [0.008, 0.040, 0.270],
    [0.070, 0.300, 0.660],
    [0.700, 0.690, 0.660],
    [0.800, 0.240, 0.070],
    [0.330, 0.012, 0.020],
];

/// The sRGB colour of a value between −1 (blue) and 1 (red); values beyond have the colours of the ends.
#[must_use]
pub fn rgb(value: f32) -> [u8; 3] {
    colour(value).map(|c| srgb(c, 0.0))
}

/// The linear colour of a value between −1 and 1.
pub(crate) fn colour(value: f32) -> Vector {
    let place = (value.clamp(-1.0, 1.0) + 1.0) * 2.0;
    let below = (place as usize).min(3);
    mix(COLOURS[below], COLOURS[below + 1], place - below as f32)
}

/// Draws a scale from `-range` to `range` millimetres at the right edge of an image.
pub fn draw(image: &mut Image, range: f32) {
    let [width, height] = image.size().map(|n| n as f32);
    let size = height.min(0.75 * width);
    let text = 0.024 * size;
    let (bar, top, length) = (0.028 * size, 0.12 * height, 0.76 * height);
    // Enough decimals to tell the marks apart.
    let decimals = (2.0 - (range / 2.0).log10().floor()).clamp(0.0, 9.0) as usize;
    let label = |value: f32| {
        let number = if !(1e-6..1e6).contains(&range) {
            format!("{value:+.1e}")
        } else {
            format!("{value:+.decimals$}")
        };
        if value == 0.0 { "0".to_owned() } else { number }
    };
    let widest = (label(range).chars().count() as f32 * 5.9) * text / 6.0;
    let left = (width - 0.03 * size - widest - bar - 0.6 * text).max(0.0);
    let dark = [38, 44, 54];
    for y in top as usize..(top + length) as usize {
        let value = 1.0 - 2.0 * (y as f32 + 0.5 - top) / length;
        let rgb = rgb(value);
        for x in left as usize..(left + bar) as usize {
            let rim = x == left as usize || x + 1 == (left + bar) as usize;
            ink(image, x, y, if rim { dark } else { rgb }, 1.0);
        }
    }
    for x in left as usize..(left + bar) as usize {
        ink(image, x, top as usize, dark, 1.0);
        ink(image, x, (top + length) as usize, dark, 1.0);
    }
    let beside = left + bar + 0.6 * text;
    for k in 0..=4 {
        let value = 1.0 - 0.5 * k as f32;
        let y = top + length * 0.25 * k as f32;
        for x in (left + bar) as usize..(left + bar + 0.35 * text) as usize {
            ink(image, x, y as usize, dark, 1.0);
        }
        write(image, &label(value * range), [beside, y - 0.5 * text], text, dark);
    }
    write(image, "mm", [left, top - 2.2 * text], text, dark);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_run_from_blue_to_red_through_grey() {
        let [low, middle, high] = [-1.0, 0.0, 1.0].map(colour);
        assert!(low[2] > 4.0 * low[0] && high[0] > 4.0 * high[2]);
        assert!((middle[0] - middle[2]).abs() < 0.1 && middle[1] > 0.5);
        assert_eq!(colour(7.0), high);
        // Both halves darken monotonically towards their ends.
        let light = |value: f32| colour(value).iter().sum::<f32>();
        for k in 1..=20 {
            let (inner, outer) = ((k - 1) as f32 * 0.05, k as f32 * 0.05);
            assert!(light(outer) < light(inner) && light(-outer) < light(-inner), "{outer}");
        }
    }

    #[test]
    fn every_character_looks_different() {
        let picture = |text: &str| {
            let mut image = Image::new([30, 30], vec![255; 2700]).unwrap();
            write(&mut image, text, [5.0, 5.0], 18.0, [0; 3]);
            image.rgb().to_vec()
        };
        let all: Vec<_> = "0123456789.-+mexyz".chars().map(|c| picture(&c.to_string())).collect();
        for (k, one) in all.iter().enumerate() {
            assert!(one.iter().any(|c| *c < 60), "{k}");
            assert!(all[..k].iter().all(|other| other != one), "{k}");
        }
        assert!(picture(" ").iter().all(|c| *c == 255));
    }

    #[test]
    fn the_scale_fits_pictures_of_any_size() {
        for size in [[1, 1], [3, 900], [900, 3], [400, 300]] {
            for range in [0.0, 1e-9, 0.05, 123.0, f32::INFINITY, f32::NAN] {
                let mut image = Image::new(size, vec![200; 3 * size[0] * size[1]]).unwrap();
                draw(&mut image, range);
                assert_eq!(image.size(), size);
                if size == [400, 300] {
                    assert!(image.rgb().iter().any(|c| *c != 200));
                }
            }
        }
    }
}
