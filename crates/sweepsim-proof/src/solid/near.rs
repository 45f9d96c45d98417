//! What of a solid is near a cell.

use super::depth;
use super::pieces::{Piece, Pieces, meets};
use super::way::Triangle;
use nalgebra::Vector3;
use sweepsim_dexel::DistanceTo;

/// What is in the surroundings of a cell.
#[derive(Clone, Debug)]
pub(crate) enum Near {
    /// Some of the surface.
    Surface(Pieces),
    /// So much of the surface that the cell is divided before it is looked at: the triangles.
    Many(Vec<u32>),
    /// All of the surroundings are in the solid.
    Inside,
    /// None of them is.
    Outside,
}

impl Near {
    /// What of it is in a smaller cube; more than `most` pieces are many.
    pub fn within(
        &self,
        cube: (&Vector3<f64>, f64),
        most: usize,
        triangles: &[Triangle],
        distance: &DistanceTo,
    ) -> Self {
        let pieces = match self {
            Self::Surface(pieces) => Pieces::within(pieces.iter(triangles), cube),
            Self::Many(numbers) => {
                let is_near = |number: &u32| meets(&triangles[*number as usize].corners, cube);
                let numbers: Vec<u32> = numbers.iter().copied().filter(is_near).collect();
                if numbers.len() > most {
                    return Self::Many(numbers);
                }
                Pieces::within(numbers.iter().map(|number| Piece::all_of(*number, triangles)), cube)
            }
            Self::Inside | Self::Outside => return self.clone(),
        };
        match pieces.len() {
            0 if depth(distance, cube.0) < 0.0 => Self::Outside,
            0 => Self::Inside,
            _ => Self::Surface(pieces),
        }
    }

    /// How many triangles there are.
    pub fn count(&self) -> usize {
        match self {
            Self::Surface(pieces) => pieces.len(),
            Self::Many(numbers) => numbers.len(),
            Self::Inside | Self::Outside => 0,
        }
    }

    /// How much memory it takes.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Surface(pieces) => pieces.bytes(),
            Self::Many(numbers) => size_of_val(&numbers[..]),
            Self::Inside | Self::Outside => 0,
        }
    }
}
