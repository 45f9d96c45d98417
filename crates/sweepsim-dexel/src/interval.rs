//! Intervals of material on a line, and what their ends remember.

/// Which motion made an end, and when.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    /// Number of the path, or [`Source::STOCK`]'s.
    pub path: u16,
    /// Number of the move in the path.
    pub segment: u32,
    /// Time in the move, from 0 to 1.
    pub t: f32,
}

impl Source {
    /// An end that no tool made.
    pub const STOCK: Self = Self {
        path: u16::MAX,
        segment: 0,
        t: 0.0,
    };
}

/// An end of an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// Height.
    pub z: f64,
    /// Unit normal of the surface, out of the material.
    pub normal: [f32; 3],
    /// What made it.
    pub source: Source,
}

impl End {
    /// The same place seen from the other side.
    #[must_use]
    pub fn flipped(self) -> Self {
        Self {
            normal: self.normal.map(|c| -c),
            ..self
        }
    }
}

/// Material between two heights; `lower.z ≤ upper.z`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub lower: End,
    /// Upper end.
    pub upper: End,
}

impl Interval {
    /// Material between two heights that no tool made, with horizontal ends.
    #[must_use]
    pub fn between(lower: f64, upper: f64) -> Self {
        let end = |z, up| End {
            z,
            normal: [0.0, 0.0, up],
            source: Source::STOCK,
        };
        Self {
            lower: end(lower, -1.0),
            upper: end(upper, 1.0),
        }
    }

    /// Length.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.upper.z - self.lower.z
    }
}

/// `a ∖ b`, both sorted and disjoint. New ends get the normals of `b`, flipped. Intervals without length are dropped.
pub(crate) fn difference(a: &[Interval], b: &[Interval], out: &mut Vec<Interval>) {
    out.clear();
    let mut first = 0;
    for piece in a {
        while first < b.len() && b[first].upper.z <= piece.lower.z {
            first += 1;
        }
        let mut lower = piece.lower;
        for cut in &b[first..] {
            if cut.lower.z >= piece.upper.z {
                break;
            }
            if cut.lower.z > lower.z {
                out.push(Interval {
                    lower,
                    upper: cut.lower.flipped(),
                });
            }
            lower = cut.upper.flipped();
        }
        if lower.z < piece.upper.z {
            out.push(Interval {
                lower,
                upper: piece.upper,
            });
        }
    }
}

/// `a ∪ b`, both sorted and disjoint; intervals that touch become one.
pub(crate) fn union(a: &[Interval], b: &[Interval], out: &mut Vec<Interval>) {
    out.clear();
    let (mut i, mut j) = (0, 0);
    while i < a.len() || j < b.len() {
        let take_a = j == b.len() || (i < a.len() && a[i].lower.z <= b[j].lower.z);
        let next = if take_a { a[i] } else { b[j] };
        if take_a {
            i += 1;
        } else {
            j += 1;
        }
        match out.last_mut() {
            Some(last) if next.lower.z <= last.upper.z => {
                if next.upper.z > last.upper.z {
                    last.upper = next.upper;
                }
            }
            _ => out.push(next),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Disjoint, sorted, with gaps: from a set of distinct heights.
    fn intervals() -> impl Strategy<Value = Vec<Interval>> {
        proptest::collection::btree_set(0..40u32, 0..12).prop_map(|heights| {
            let z: Vec<f64> = heights.into_iter().map(f64::from).collect();
            z.chunks_exact(2)
                .map(|pair| Interval::between(pair[0], pair[1]))
                .collect()
        })
    }

    fn inside(set: &[Interval], z: f64) -> bool {
        set.iter().any(|i| i.lower.z < z && z < i.upper.z)
    }

    proptest! {
        #[test]
        fn operations_agree_with_points(a in intervals(), b in intervals()) {
            let (mut minus, mut plus) = (Vec::new(), Vec::new());
            difference(&a, &b, &mut minus);
            union(&a, &b, &mut plus);
            for set in [&minus, &plus] {
                prop_assert!(set.iter().all(|i| i.lower.z < i.upper.z));
                prop_assert!(set.windows(2).all(|w| w[0].upper.z <= w[1].lower.z));
                // Normals point out of the material.
                prop_assert!(set.iter().all(|i| i.lower.normal[2] == -1.0 && i.upper.normal[2] == 1.0));
            }
            prop_assert!(plus.windows(2).all(|w| w[0].upper.z < w[1].lower.z));
            for k in 0..40 {
                let z = f64::from(k) + 0.5;
                prop_assert_eq!(inside(&minus, z), inside(&a, z) && !inside(&b, z));
                prop_assert_eq!(inside(&plus, z), inside(&a, z) || inside(&b, z));
            }
        }
    }
}
