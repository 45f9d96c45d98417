//! Triangles, and normals that can be written down.

use nalgebra::Vector3;

/// A triangle of the surface.
#[derive(Clone, Debug)]
pub(crate) struct Triangle {
    /// Its number among all that were given.
    pub number: u32,
    pub corners: [Vector3<f64>; 3],
    /// Unit normal, out of the solid.
    pub normal: Vector3<f64>,
}

/// How a normal is written down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Written {
    /// That of a triangle.
    OfTriangle(u32),
    /// Three numbers of any length.
    Given([f32; 3]),
}

/// A unit normal that can be written down exactly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Normal {
    pub vector: Vector3<f64>,
    pub written: Written,
}

impl Normal {
    /// The nearest to a direction that has three short numbers. `None` if it has no length.
    pub fn near(direction: &Vector3<f64>) -> Option<Self> {
        let short = direction.try_normalize(1e-12)?.map(|c| c as f32);
        Some(Self {
            vector: short.map(f64::from).try_normalize(0.5)?,
            written: Written::Given(short.into()),
        })
    }

    pub fn of(triangle: &Triangle) -> Self {
        Self {
            vector: triangle.normal,
            written: Written::OfTriangle(triangle.number),
        }
    }
}

/// A direction in which a cutter may be lifted off what is near a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Way {
    pub normal: Vector3<f64>,
    pub written: Written,
    /// The highest value along it of the surface in the surroundings.
    pub top: f64,
    /// Whether beyond that the surroundings are outside of the solid.
    pub out: bool,
}

impl Way {
    /// Its direction alone.
    pub fn direction(&self) -> Normal {
        Normal {
            vector: self.normal,
            written: self.written,
        }
    }
}
