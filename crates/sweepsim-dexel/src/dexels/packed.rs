//! Ends as they are stored: 16 bytes.
//!
//! The height is stored exactly. The normal is projected onto an octahedron, which is unfolded to a square: two numbers
//! of 16 bits, which turn it by at most 6.5e-5 and keep axis directions exact. The source is an index into the chunk's
//! table of moves and a time, in 32 bits.

use crate::intervals::Endpoint;

/// An end without its table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Packed {
    pub z: f64,
    pub normal: Octahedral,
    /// Number of the move, then the time; [`Packed::STOCK`] without a move.
    pub source: u32,
}

impl Packed {
    /// No move: times are below half of their range, so no move has this number.
    pub const STOCK: u32 = u32::MAX;
}

impl Endpoint for Packed {
    fn height(&self) -> f64 {
        self.z
    }

    fn flipped(self) -> Self {
        Self {
            normal: self.normal.opposite(),
            ..self
        }
    }
}

/// A direction: the point of the octahedron `|x| + |y| + |z| = 1` there, its lower half folded out over the upper.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Octahedral([i16; 2]);

/// Half the width of the square.
const FULL: i32 = 32767;

/// The sign of a coordinate, with that of 0 up.
fn sign(c: i32) -> i32 {
    if c < 0 { -1 } else { 1 }
}

impl Octahedral {
    /// The nearest direction, or nearly so. A zero or non-finite vector is taken as up.
    #[inline]
    pub fn new(normal: [f32; 3]) -> Self {
        // Of every other end.
        if normal == [0.0, 0.0, 1.0] {
            return Self([0, 0]);
        }
        let n = normal.map(f64::from);
        let size = n.iter().map(|c| c.abs()).sum::<f64>();
        if !(size > 0.0 && size.is_finite()) {
            return Self([0, 0]);
        }
        // To the nearest number: half more, then towards 0.
        let scale = f64::from(FULL) / size;
        let [x, y] = [0, 1].map(|k| (n[k] * scale + 0.5_f64.copysign(n[k])) as i32);
        // Rounding may leave the face.
        let over = (x.abs() + y.abs() - FULL).max(0);
        let x = x - over * sign(x);
        Self::folded(x, y, n[2] < 0.0)
    }

    fn folded(x: i32, y: i32, below: bool) -> Self {
        let [x, y] = if below {
            [(FULL - y.abs()) * sign(x), (FULL - x.abs()) * sign(y)]
        } else {
            [x, y]
        };
        Self([x as i16, y as i16])
    }

    /// The point of the octahedron, in units of `1/FULL`.
    fn point(self) -> [i32; 3] {
        let [x, y] = self.0.map(i32::from);
        let z = FULL - x.abs() - y.abs();
        if z < 0 {
            [(FULL - y.abs()) * sign(x), (FULL - x.abs()) * sign(y), z]
        } else {
            [x, y, z]
        }
    }

    pub(super) fn bytes(self) -> [u8; 4] {
        let [[a, b], [c, d]] = self.0.map(i16::to_le_bytes);
        [a, b, c, d]
    }

    pub(super) fn of_bytes([a, b, c, d]: [u8; 4]) -> Self {
        let own = [[a, b], [c, d]].map(i16::from_le_bytes);
        Self(own.map(|c| c.max(-i16::MAX)))
    }

    /// Exactly the opposite direction.
    pub fn opposite(self) -> Self {
        let [x, y, z] = self.point();
        Self::folded(-x, -y, z > 0)
    }

    /// The unit vector.
    pub fn vector(self) -> [f32; 3] {
        let p = self.point().map(f64::from);
        let length = p.iter().map(|c| c * c).sum::<f64>().sqrt();
        p.map(|c| (c / length) as f32)
    }
}

/// A unit vector as two numbers of 16 bits, as [`Dexels`](crate::Dexels) store it: the point of the octahedron
/// `|x| + |y| + |z| = 1` in its direction, with the lower half folded out over the upper, from −32767 to 32767.
/// Directions turn by at most 6.5e-5.
///
/// ```
/// use sweepsim_dexel::{pack_normal, unpack_normal};
/// assert_eq!(unpack_normal(pack_normal([0.0, -1.0, 0.0])), [0.0, -1.0, 0.0]);
/// ```
#[must_use]
pub fn pack_normal(normal: [f32; 3]) -> [i16; 2] {
    Octahedral::new(normal).0
}

/// The unit vector of [`pack_normal`]. Any numbers have one: −32768 is taken as −32767.
#[must_use]
pub fn unpack_normal(packed: [i16; 2]) -> [f32; 3] {
    Octahedral(packed.map(|c| c.max(-i16::MAX))).vector()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::*;

    fn angle(a: [f32; 3], b: [f32; 3]) -> f64 {
        let (a, b) = (a.map(f64::from), b.map(f64::from));
        let d = [0, 1, 2].map(|k| a[k] - b[k]);
        d.iter().map(|c| c * c).sum::<f64>().sqrt()
    }

    fn check(n: [f32; 3]) {
        let packed = Octahedral::new(n);
        let vector = packed.vector();
        assert!(angle(vector, n) < 6.6e-5, "{n:?} {vector:?}");
        assert_eq!(Octahedral::new(vector).vector(), vector);
        assert_eq!(
            packed.opposite().vector().map(|c| c + 0.0),
            vector.map(|c| 0.0 - c),
            "{n:?}"
        );
        assert_eq!(unpack_normal(pack_normal(n)), vector);
    }

    proptest! {
        #[test]
        fn directions_are_kept(n in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0], flat in 0..4usize) {
            let mut n = n;
            if flat < 3 {
                n[flat] *= 1e-6;
            }
            let length = n.iter().map(|c| c * c).sum::<f64>().sqrt();
            prop_assume!(length > 1e-3);
            check(n.map(|c| (c / length) as f32));
        }
    }

    #[test]
    fn axes_are_exact_and_anything_is_a_direction() {
        for k in 0..3 {
            for up in [-1.0, 1.0] {
                let mut n = [0.0; 3];
                n[k] = up;
                check(n);
                assert_eq!(Octahedral::new(n).vector(), n);
            }
        }
        for n in [[0.0; 3], [f32::NAN, 0.0, 1.0], [f32::INFINITY; 3]] {
            assert_eq!(Octahedral::new(n).vector(), [0.0, 0.0, 1.0]);
        }
        check([0.0, -0.6, -0.8]);
        for bits in [[i16::MIN; 2], [i16::MAX; 2], [i16::MIN, 0], [i16::MAX, -5]] {
            check(unpack_normal(bits));
        }
        assert_eq!(size_of::<Packed>(), 16);
    }
}
