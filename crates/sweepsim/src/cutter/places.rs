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

    /// Bounds of the rounding errors of values or of first derivatives, form by form; the forms have coefficients up to `sizes`.
    pub fn roundings(&self, orders: [usize; 2], sizes: [f64; 4]) -> [f64; 4] {
        match self {
            Self::Bicubic(bicubic) => {
                let sums = bicubic.sizes(orders);
                let unit = 0.5 * f64::EPSILON;
                // Besides, coefficients of 64 terms, up to nine times as large, are computed with twice the digits.
                std::array::from_fn(|k| unit * (Bicubic::ROUNDINGS * sums[k] + 1e6 * unit * sizes[k]))
            }
            Self::Any(table) => {
                let degrees = table.degrees().map(|degree| degree as f64);
                let grown = [0, 1].map(|axis| if orders[axis] == 0 { 1.0 } else { 2.0 * degrees[axis] });
                let most = if orders == [0, 0] {
                    degrees[0] + degrees[1]
                } else {
                    orders[0] as f64 * degrees[0] + orders[1] as f64 * degrees[1]
                };
                sizes.map(|size| grown[0] * grown[1] * (2.0 * most + 8.0) * f64::EPSILON * size)
            }
        }
    }
}
