//! A patch, seen in the coordinates of a move.

use super::directed_motion::Directions;
use crate::cutter::patch_forms::PatchForms;
use crate::time::placement::{Placing, Twisted};
use nalgebra::{Matrix3, Vector3};

/// A patch as it is seen along a direction.
pub(super) struct Face<'a> {
    element: &'a PatchForms,
    placing: Placing,
    way: Twisted,
}

/// A point of a patch: everything in the coordinates `(q, p, z)`, from the tip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sight {
    pub place: [f64; 3],
    pub slopes: [[f64; 3]; 2],
    /// `g`, and its derivatives.
    pub g: [f64; 3],
    pub normal: [f64; 3],
}

impl<'a> Face<'a> {
    pub fn new(element: &'a PatchForms, directions: &Directions) -> Self {
        let [q, p, z] = directions.rows.map(|row| Vector3::from(row).transpose());
        let frame = element.frame();
        Self {
            element,
            placing: Placing::new(&Matrix3::from_rows(&[q, p, z]), &Vector3::zeros(), frame),
            way: Twisted::new(&Vector3::zeros(), &directions.way.into(), frame),
        }
    }

    #[inline]
    pub fn at(&self, at: [f64; 2]) -> Sight {
        let (point, g) = match &self.element.revolution {
            Some(revolution) => {
                let turned = revolution.at(&self.placing, at);
                (turned.point(), turned.envelopes(&self.way))
            }
            None => {
                let (point, fields) = self.element.point(&self.placing, at);
                (point, fields.envelopes(&self.way))
            }
        };
        let three = |[q, p, z, _]: [f64; 4]| [q, p, z];
        Sight {
            place: three(point.place),
            slopes: point.slopes.map(three),
            g,
            normal: three(point.normal),
        }
    }
}
