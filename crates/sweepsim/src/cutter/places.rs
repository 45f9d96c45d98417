//! The homogeneous position of a patch, and its derivatives at a point.

use crate::algebra::jets::{Bicubic, Jet};
use crate::algebra::table::Table;

/// Forms of the position, arranged for their degrees.
#[derive(Clone, Debug)]
pub(super) enum Places {
    Bicubic(Box<Bicubic>),
    Any(Table),
}

impl Places {
    /// Of three numerators and a weight.
    pub fn new(table: Table) -> Self {
        match Bicubic::new(&table) {
            Some(bicubic) => Self::Bicubic(Box::new(bicubic)),
            None => Self::Any(table),
        }
    }

    /// Values, and first and second derivatives.
    #[inline]
    pub fn jet(&self, at: [f64; 2]) -> Jet<4> {
        match self {
            Self::Bicubic(bicubic) => bicubic.jet(at),
            Self::Any(table) => table.jet::<4>(at),
        }
    }

    /// Values and first derivatives.
    #[inline]
    pub fn slopes(&self, at: [f64; 2]) -> [[f64; 4]; 3] {
        match self {
            Self::Bicubic(bicubic) => bicubic.slopes(at),
            Self::Any(table) => table.at::<4>(at),
        }
    }

    /// Bounds of the rounding errors of both first derivatives, form by form; the forms have coefficients up to `sizes`.
    pub fn roundings(&self, sizes: [f64; 4]) -> [[f64; 4]; 2] {
        match self {
            Self::Bicubic(bicubic) => [[1, 0], [0, 1]].map(|orders| {
                let sums = bicubic.sizes(orders);
                let unit = 0.5 * f64::EPSILON;
                // Besides, coefficients of 64 terms, up to nine times as large, are computed with twice the digits.
                std::array::from_fn(|k| unit * (Bicubic::ROUNDINGS * sums[k] + 1e6 * unit * sizes[k]))
            }),
            Self::Any(table) => table.degrees().map(|degree| {
                let degree = degree as f64;
                sizes.map(|size| 2.0 * degree * (2.0 * degree + 8.0) * f64::EPSILON * size)
            }),
        }
    }
}
