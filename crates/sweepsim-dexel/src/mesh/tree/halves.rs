//! Where parts of triangles are divided between two boxes.
//!
//! A box is looked into about as often as its surface is large. So parts are divided where the surfaces of both boxes,
//! each times the number of parts in it, have the least sum (MacDonald, Booth: *Heuristics for ray tracing using space
//! subdivision*, 1990), at one of a few planes across each axis.

use super::parts::TrianglePart;

/// So many strips lie between the planes across each axis.
const STRIPS: usize = 16;
/// Of the parts, each half has at least this share.
const LEAST: f64 = 0.05;

/// The box around some others.
#[derive(Clone, Copy)]
pub(super) struct Hull {
    pub low: [f64; 3],
    pub high: [f64; 3],
}

impl Hull {
    pub const NOTHING: Self = Self {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    pub fn add(&mut self, low: [f64; 3], high: [f64; 3]) {
        for k in 0..3 {
            (self.low[k], self.high[k]) = (self.low[k].min(low[k]), self.high[k].max(high[k]));
        }
    }

    /// Half of it.
    fn surface(&self) -> f64 {
        let [a, b, c] = [0, 1, 2].map(|k| (self.high[k] - self.low[k]).max(0.0));
        a * b + b * c + c * a
    }
}

/// Puts those of one half first, and tells how many they are.
pub(super) fn halved(parts: &mut [TrianglePart]) -> usize {
    let middle = parts.len() / 2;
    // Not of the boxes: what is long along an axis may all have one place there.
    let ends = [0, 1, 2].map(|k| {
        let places = parts.iter().map(|part| part.place[k]);
        places.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], c| [a.min(c), b.max(c)])
    });
    let mut best: Option<(f64, usize, usize)> = None;
    for (axis, [from, to]) in ends.iter().enumerate() {
        let scale = STRIPS as f64 / (to - from);
        if !scale.is_finite() {
            continue;
        }
        let mut strips = [(Hull::NOTHING, 0_usize); STRIPS];
        for part in &*parts {
            let strip = &mut strips[strip_of(part.place[axis], *from, scale)];
            strip.0.add(part.low, part.high);
            strip.1 += 1;
        }
        // From each strip on.
        let mut above = [(0.0, 0); STRIPS];
        let (mut hull, mut count) = (Hull::NOTHING, 0);
        for (strip, above) in strips.iter().zip(&mut above).rev() {
            hull.add(strip.0.low, strip.0.high);
            count += strip.1;
            *above = (hull.surface(), count);
        }
        let (mut hull, mut count) = (Hull::NOTHING, 0);
        for k in 1..STRIPS {
            hull.add(strips[k - 1].0.low, strips[k - 1].0.high);
            count += strips[k - 1].1;
            let (surface, others) = above[k];
            let cost = hull.surface() * count as f64 + surface * others as f64;
            let is_even = count.min(others) as f64 >= LEAST * parts.len() as f64;
            if is_even && best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, k));
            }
        }
    }
    if let Some((_, axis, strip)) = best {
        let [from, to] = ends[axis];
        let scale = STRIPS as f64 / (to - from);
        let is_below = |part: &TrianglePart| strip_of(part.place[axis], from, scale) < strip;
        return partitioned(parts, is_below);
    }
    let length = |k: usize| ends[k][1] - ends[k][0];
    let axis = (0..3).fold(0, |a, k| if length(k) > length(a) { k } else { a });
    parts.select_nth_unstable_by(middle, |a, b| a.place[axis].total_cmp(&b.place[axis]));
    middle
}

fn strip_of(place: f64, from: f64, scale: f64) -> usize {
    (((place - from) * scale) as usize).min(STRIPS - 1)
}

/// Puts those for which something holds first, and tells how many they are.
fn partitioned(parts: &mut [TrianglePart], holds: impl Fn(&TrianglePart) -> bool) -> usize {
    let mut count = 0;
    for k in 0..parts.len() {
        if holds(&parts[k]) {
            parts.swap(count, k);
            count += 1;
        }
    }
    count
}
