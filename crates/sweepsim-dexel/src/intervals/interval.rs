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

/// What an interval can end with: a height, and perhaps more that is known there.
pub trait Endpoint: Copy {
    /// The height.
    fn height(&self) -> f64;

    /// The same place seen from the other side: where material begins and ends change places.
    #[must_use]
    fn flipped(self) -> Self;
}

/// A height and nothing else.
impl Endpoint for f64 {
    fn height(&self) -> f64 {
        *self
    }

    fn flipped(self) -> Self {
        self
    }
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

impl Endpoint for End {
    fn height(&self) -> f64 {
        self.z
    }

    fn flipped(self) -> Self {
        Self::flipped(self)
    }
}

/// Material between two heights; `lower ≤ upper`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval<E = End> {
    /// Lower end.
    pub lower: E,
    /// Upper end.
    pub upper: E,
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
}

impl<E: Endpoint> Interval<E> {
    /// Length.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.upper.height() - self.lower.height()
    }
}
