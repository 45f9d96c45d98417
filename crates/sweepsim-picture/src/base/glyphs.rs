//! Strokes, and characters drawn by them: digits, signs, the unit of lengths and the names of the axes.

use crate::base::image::Image;
use crate::base::vector::smooth_step;

/// A character's strokes as polylines on a field of 4 × 6 with `y` down, and its width.
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
        'x' => &[&[[0.4, 2.3], [3.6, 6.0]], &[[3.6, 2.3], [0.4, 6.0]]],
        'y' => &[&[[0.4, 2.3], [2.0, 6.0]], &[[3.6, 2.3], [2.0, 6.0], [1.2, 7.4]]],
        'z' => &[&[[0.4, 2.3], [3.6, 2.3], [0.4, 6.0], [3.6, 6.0]]],
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

/// How far characters reach below their top; digits end at 6.
const DEEPEST: f32 = 7.5;

/// The distance of `p` from a line segment.
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

/// Blends a colour into a pixel with a weight from 0 to 1. Pixels outside the image are ignored.
pub(crate) fn ink(image: &mut Image, x: usize, y: usize, colour: [u8; 3], share: f32) {
    let [width, height] = image.size();
    if x >= width || y >= height {
        return;
    }
    let at = 3 * (y * width + x);
    for (old, new) in image.rgb_mut()[at..at + 3].iter_mut().zip(colour) {
        let mixed = f32::from(*old) + share.clamp(0.0, 1.0) * (f32::from(new) - f32::from(*old));
        *old = (mixed + 0.5) as u8;
    }
}

/// Draws a straight line with round ends, `width` pixels wide.
pub(crate) fn stroke(image: &mut Image, ends: [[f32; 2]; 2], width: f32, colour: [u8; 3]) {
    let pen = 0.5 * width;
    let side = |k: usize, limit: usize| {
        let (low, high) = (ends[0][k].min(ends[1][k]), ends[0][k].max(ends[1][k]));
        (low - pen - 1.0).max(0.0) as usize..((high + pen + 2.0).max(0.0) as usize).min(limit)
    };
    let [width, height] = image.size();
    for y in side(1, height) {
        for x in side(0, width) {
            let away = distance([x as f32 + 0.5, y as f32 + 0.5], ends);
            ink(image, x, y, colour, smooth_step(pen + 0.6, pen - 0.6, away));
        }
    }
}

/// Writes a text with its upper left corner at a point, `height` pixels high, and returns its width.
pub(crate) fn write(image: &mut Image, text: &str, [left, top]: [f32; 2], height: f32, colour: [u8; 3]) -> f32 {
    let scale = height / 6.0;
    let pen = 0.5 * (0.72 * scale).max(1.2);
    let mut from = left;
    for character in text.chars() {
        let (strokes, width) = strokes(character);
        let reach = [width, DEEPEST].map(|size| size * scale + pen + 1.0);
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
