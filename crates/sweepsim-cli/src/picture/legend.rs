//! The colours of values, and the scale beside a picture that explains them.

use super::Image;
use super::vector::{Vector, mix, smooth_step};

/// Which share of a picture's width the scale takes: see [`View::aside`](super::View::aside).
pub const WIDTH: f64 = 0.13;

/// Of the values −1, −0.5, 0, 0.5 and 1, linear: from blue over pale grey to red, each half ever darker away from the middle.
const COLOURS: [Vector; 5] = [
    [0.008, 0.040, 0.270],
    [0.070, 0.300, 0.660],
    [0.700, 0.690, 0.660],
    [0.800, 0.240, 0.070],
    [0.330, 0.012, 0.020],
];

/// The colour of a value from −1 to 1, linear.
pub(super) fn colour(value: f32) -> Vector {
    let place = (value.clamp(-1.0, 1.0) + 1.0) * 2.0;
    let below = (place as usize).min(3);
    mix(COLOURS[below], COLOURS[below + 1], place - below as f32)
}

/// Strokes of the characters that numbers need, on a field of 4 × 6 with `y` down: polylines, one after the other.
fn strokes(character: char) -> (&'static [&'static [[f32; 2]]], f32) {
    const ROUND: &[[f32; 2]] = &[
        [2.0, 0.0],
        [3.2, 0.4],
        [4.0, 1.8],
        [4.0, 4.2],
        [3.2, 5.6],
        [2.0, 6.0],
        [0.8, 5.6],
        [0.0, 4.2],
        [0.0, 1.8],
        [0.8, 0.4],
        [2.0, 0.0],
    ];
    const UPPER: &[[f32; 2]] = &[
        [0.1, 1.1],
        [0.6, 0.3],
        [2.0, 0.0],
        [3.3, 0.4],
        [3.7, 1.4],
        [3.3, 2.5],
        [2.0, 2.9],
    ];
    const LOWER: &[[f32; 2]] = &[
        [2.0, 2.9],
        [3.5, 3.3],
        [4.0, 4.4],
        [3.5, 5.5],
        [2.0, 6.0],
        [0.6, 5.7],
        [0.0, 4.9],
    ];
    let strokes: &'static [&'static [[f32; 2]]] = match character {
        '0' => &[ROUND],
        '1' => &[&[[0.8, 1.2], [2.2, 0.0], [2.2, 6.0]]],
        '2' => &[&[
            [0.1, 1.5],
            [0.7, 0.4],
            [2.0, 0.0],
            [3.4, 0.4],
            [3.9, 1.6],
            [3.4, 2.9],
            [0.0, 6.0],
            [4.0, 6.0],
        ]],
        '3' => &[UPPER, LOWER],
        '4' => &[&[[3.0, 6.0], [3.0, 0.0], [0.0, 4.2], [4.0, 4.2]]],
        '5' => &[&[
            [3.7, 0.0],
            [0.6, 0.0],
            [0.3, 2.8],
            [2.0, 2.3],
            [3.4, 2.7],
            [4.0, 4.0],
            [3.5, 5.4],
            [2.0, 6.0],
            [0.6, 5.7],
            [0.0, 5.0],
        ]],
        '6' => &[&[
            [3.6, 0.6],
            [2.4, 0.0],
            [1.0, 0.8],
            [0.1, 2.6],
            [0.1, 4.4],
            [0.7, 5.6],
            [2.0, 6.0],
            [3.4, 5.5],
            [3.9, 4.2],
            [3.4, 3.0],
            [2.0, 2.5],
            [0.7, 3.0],
            [0.1, 4.2],
        ]],
        '7' => &[&[[0.0, 0.0], [4.0, 0.0], [1.4, 6.0]]],
        '8' => &[
            &[
                [2.0, 2.8],
                [0.7, 2.3],
                [0.3, 1.4],
                [0.7, 0.4],
                [2.0, 0.0],
                [3.3, 0.4],
                [3.7, 1.4],
                [3.3, 2.3],
                [2.0, 2.8],
            ],
            &[
                [2.0, 2.8],
                [3.5, 3.3],
                [4.0, 4.4],
                [3.5, 5.5],
                [2.0, 6.0],
                [0.5, 5.5],
                [0.0, 4.4],
                [0.5, 3.3],
                [2.0, 2.8],
            ],
        ],
        '9' => &[&[
            [0.4, 5.4],
            [1.6, 6.0],
            [3.0, 5.2],
            [3.9, 3.4],
            [3.9, 1.6],
            [3.3, 0.4],
            [2.0, 0.0],
            [0.6, 0.5],
            [0.1, 1.8],
            [0.6, 3.0],
            [2.0, 3.5],
            [3.3, 3.0],
            [3.9, 1.8],
        ]],
        '.' => return (&[&[[0.3, 5.9], [0.3, 6.0]]], 0.6),
        '-' => &[&[[0.4, 3.2], [3.6, 3.2]]],
        '+' => &[&[[0.3, 3.2], [3.7, 3.2]], &[[2.0, 1.5], [2.0, 4.9]]],
        'm' => {
            return (
                &[
                    &[[0.0, 6.0], [0.0, 2.3]],
                    &[[0.0, 3.1], [0.9, 2.3], [1.9, 2.4], [2.4, 3.2], [2.4, 6.0]],
                    &[[2.4, 3.1], [3.3, 2.3], [4.3, 2.4], [4.8, 3.2], [4.8, 6.0]],
                ],
                4.8,
            );
        }
        'e' => {
            return (
                &[&[
                    [0.0, 4.2],
                    [3.2, 4.2],
                    [3.0, 2.9],
                    [1.7, 2.2],
                    [0.4, 2.8],
                    [0.0, 4.2],
                    [0.5, 5.6],
                    [1.7, 6.0],
                    [3.0, 5.5],
                ]],
                3.2,
            );
        }
        _ => return (&[], 2.0),
    };
    (strokes, 4.0)
}

/// How far `p` is from a line between two points.
fn distance(p: [f32; 2], [a, b]: [[f32; 2]; 2]) -> f32 {
    let (u, v) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let square = u[0] * u[0] + u[1] * u[1];
    let t = if square > 0.0 {
        ((u[0] * v[0] + u[1] * v[1]) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (v[0] - t * u[0]).hypot(v[1] - t * u[1])
}

/// Puts ink on a pixel: `share` from 0 to 1. Pixels that are not there get none.
fn ink(image: &mut Image, x: usize, y: usize, colour: [u8; 3], share: f32) {
    let at = 3 * (y * image.size[0] + x);
    if x >= image.size[0] {
        return;
    }
    let Some(pixel) = image.rgb.get_mut(at..at + 3) else {
        return;
    };
    for (old, new) in pixel.iter_mut().zip(colour) {
        let mixed = f32::from(*old) + share.clamp(0.0, 1.0) * (f32::from(new) - f32::from(*old));
        *old = (mixed + 0.5) as u8;
    }
}

/// Writes a text whose upper left corner is at some place, `height` pixels high; says how wide it is.
fn write(image: &mut Image, text: &str, [left, top]: [f32; 2], height: f32, colour: [u8; 3]) -> f32 {
    let scale = height / 6.0;
    let pen = 0.5 * (0.72 * scale).max(1.2);
    let mut from = left;
    for character in text.chars() {
        let (strokes, width) = strokes(character);
        let reach = [width, 6.0].map(|size| size * scale + pen + 1.0);
        let first = [from, top].map(|c| (c - pen - 1.0).max(0.0) as usize);
        let last = [from + reach[0], top + reach[1]].map(|c| c.max(0.0) as usize);
        for (y, x) in (first[1]..=last[1]).flat_map(|y| (first[0]..=last[0]).map(move |x| (y, x))) {
            let p = [(x as f32 + 0.5 - from) / scale, (y as f32 + 0.5 - top) / scale];
            let segments = strokes.iter().flat_map(|line| line.windows(2));
            let away = segments
                .map(|ends| distance(p, [ends[0], ends[1]]))
                .fold(f32::INFINITY, f32::min);
            let share = smooth_step(pen + 0.6, pen - 0.6, away * scale);
            if share > 0.0 {
                ink(image, x, y, colour, share);
            }
        }
        from += (width + 1.9) * scale;
    }
    from - left
}

/// Draws the scale of values from `-range` to `range` millimetres at the right side of a picture.
pub fn draw(image: &mut Image, range: f32) {
    let [width, height] = image.size.map(|n| n as f32);
    let size = height.min(0.75 * width);
    let text = 0.024 * size;
    let (bar, top, length) = (0.028 * size, 0.12 * height, 0.76 * height);
    // As many decimals as tell the marks apart.
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
        let rgb = colour(value).map(|c| super::shade::srgb(c, 0.0));
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
        // Darker and darker away from the middle.
        let light = |value: f32| colour(value).iter().sum::<f32>();
        for k in 1..=20 {
            let (inner, outer) = ((k - 1) as f32 * 0.05, k as f32 * 0.05);
            assert!(light(outer) < light(inner) && light(-outer) < light(-inner), "{outer}");
        }
    }

    #[test]
    fn every_character_has_ink_of_its_own() {
        let picture = |text: &str| {
            let mut image = Image {
                size: [30, 30],
                rgb: vec![255; 2700],
            };
            write(&mut image, text, [5.0, 5.0], 18.0, [0; 3]);
            image.rgb
        };
        let all: Vec<_> = "0123456789.-+me".chars().map(|c| picture(&c.to_string())).collect();
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
                let mut image = Image {
                    size,
                    rgb: vec![200; 3 * size[0] * size[1]],
                };
                draw(&mut image, range);
                assert_eq!(image.rgb.len(), 3 * size[0] * size[1]);
                if size == [400, 300] {
                    assert!(image.rgb.iter().any(|c| *c != 200));
                }
            }
        }
    }
}
