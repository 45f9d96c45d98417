//! Stock as programs and projects describe it.

/// The stock that a program or a project describes, in the program's coordinates. Lengths are in millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum StockDescription {
    /// A block between two corners.
    Block {
        /// The corner with the smallest coordinates.
        min: [f64; 3],
        /// The corner with the largest coordinates.
        max: [f64; 3],
    },
    /// A block of which only the size is known, not the place.
    Size([f64; 3]),
    /// An upright cylinder.
    Cylinder {
        /// The centre of its lower face.
        base: [f64; 3],
        /// Its radius.
        radius: f64,
        /// Its height.
        height: f64,
    },
}
