//! Sharp edges, seen in the coordinates of a move.
//!
//! An edge `C(r)` bounds the sweep where exactly one of its two faces moves inwards. Its curve takes the place of a grazing curve: `p(C(r)) = p of the line` is one equation in one unknown.
//! With a second unknown `w`, and `w = 0` in place of `g = 0`, it has the form of the equations of a patch, and is solved as these are. Both signs of `g` are the same on all of a chart.

use super::chart::{Chart, Range, magnitude};
use super::directed_motion::Directions;
use super::face::{Curve, Sight};
use super::tree::{Blur, FLAT, SMALLEST, error, g};
use crate::algebra::table::position;
use crate::cutter::cells::Cells;
use crate::cutter::patch_forms::PatchForms;
use crate::time::placement::Placing;
use nalgebra::{Matrix3, Vector3};

/// A family's cells are left to each direction where ranges are narrower than so many times what the directions differ by.
const BLURRED: f64 = 8.0;

/// The range of derivatives that vanish.
const NOTHING: Range = (0.0, 0.0);

/// An edge as it is seen along a direction.
pub(super) struct Rim<'a> {
    element: &'a PatchForms,
    placing: Placing,
    /// The parts of the unit vector along the way, ahead and up.
    way: [f64; 2],
}

impl<'a> Rim<'a> {
    pub fn new(element: &'a PatchForms, directions: &Directions) -> Self {
        let rows = directions.rows.map(Vector3::from);
        let way = Vector3::from(directions.way);
        Self {
            element,
            placing: Placing::new(&Matrix3::from_columns(&rows).transpose(), &Vector3::zeros(), None),
            way: [rows[0].dot(&way), rows[2].dot(&way)],
        }
    }
}

impl Curve for Rim<'_> {
    /// The normal is `C′ × d`, across the strip, to either side: see [`Chart::outwards`].
    #[inline]
    fn at(&self, [r, w]: [f64; 2]) -> Sight {
        let point = position(&self.element.places.along::<4>(r));
        let [place, slope] = point.map(|v| {
            let [q, p, z, _] = self.placing.turned(&v);
            [q, p, z]
        });
        let across = |[q, p, z]: [f64; 3], [ahead, up]: [f64; 2]| [p * up, z * ahead - q * up, -p * ahead];
        Sight {
            place,
            slopes: [slope, [0.0; 3]],
            g: [w, 0.0, 1.0],
            normal: across(slope, self.way),
        }
    }
}

/// What a look at a cell of an edge tells.
pub(super) enum Look {
    /// Both faces move to the same side.
    Empty,
    Chart(Box<Chart>),
    /// Not the same for all directions of a family.
    Mixed,
    /// It cannot be divided any further.
    Least,
    /// It has to be divided.
    Rough,
}

/// The sign of `g` beyond an error: −1, 0 (exactly) or 1.
fn sign((lo, hi): Range, error: f64) -> Option<i8> {
    if lo > error {
        Some(1)
    } else if hi < -error {
        Some(-1)
    } else {
        (lo == 0.0 && hi == 0.0).then_some(0)
    }
}

/// A look at a cell over which `p` has a range.
pub(super) fn look(
    (element, cells, cell): (&PatchForms, &mut Cells, u32),
    p: Range,
    directions: &Directions,
    blur: &Blur,
    system_rounding: f64,
) -> Look {
    let error = error(element, [cells.bounds(cell, 0), (0.0, 1.0)], directions);
    let is_family = directions.spread > 0.0;
    let ranges = [0, 1].map(|side| g(element, cells, cell, side, directions));
    let (lower, upper) = cells.bounds(cell, 0);
    // Exactly 0 in one direction says nothing of others.
    let alike = |sign: &i8| !(is_family && *sign == 0);
    let signs = ranges.map(|range| sign(range, error + blur.g).filter(alike));
    let rough = if upper - lower < SMALLEST {
        if is_family { Look::Mixed } else { Look::Least }
    } else if p.1 - p.0 - 2.0 * system_rounding < FLAT * system_rounding {
        Look::Least
    } else {
        Look::Rough
    };
    let [Some(before), Some(after)] = signs else {
        let blurs = |(range, known): (&Range, &Option<i8>)| {
            let narrow = range.1 - range.0 <= BLURRED * blur.g;
            known.is_none() && (narrow || sign(*range, error).is_some())
        };
        let is_mixed = is_family && ranges.iter().zip(&signs).any(blurs);
        return if is_mixed { Look::Mixed } else { rough };
    };
    // What is exactly 0 is not negative, whichever way the tip goes.
    let negative = |sign: i8| if directions.backwards { sign > 0 } else { sign < 0 };
    if negative(before) == negative(after) {
        return Look::Empty;
    }
    cells.prepare(element, cell);
    let differs = blur.slopes[0];
    let [ahead, across] = directions.slopes((element, cells, cell), (0, differs));
    let half = 0.5 * (upper - lower);
    let jacobian = [[across, NOTHING], [NOTHING, (1.0, 1.0)]];
    let blurs = [[differs, 0.0], [0.0; 2]];
    let bounds = [[lower, -half], [upper, half]];
    match Chart::new(bounds, &jacobian, &blurs, [system_rounding, 0.0], [ahead, NOTHING]) {
        Ok(mut chart) => {
            // The determinant of ∂(X, Y)/∂(r, t) has the opposite sign of p′, and one more sign is that of the jump.
            chart.jump *= if after > before { 1 } else { -1 };
            chart.outwards = outwards(element, 0.5 * (lower + upper), directions);
            Look::Chart(Box::new(chart))
        }
        Err(own) if is_family && (own.blurred || magnitude(across) <= BLURRED * differs) => Look::Mixed,
        Err(_) => rough,
    }
}

/// Whether `C′ × d` points outwards at a point (1), or inwards (−1).
fn outwards(element: &PatchForms, r: f64, directions: &Directions) -> f64 {
    let [_, slope] = position(&element.places.along::<4>(r));
    let (_, [[n, _], [m, _]]) = element.rim(r);
    let way = Vector3::from(directions.way);
    // The envelope's normal lies in the fan of the two faces, where g = 0.
    let normal = n * m.dot(&way).abs() + m * n.dot(&way).abs();
    if slope.cross(&way).dot(&normal) < 0.0 {
        -1.0
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::super::directed_motion::DirectedMotion;
    use super::super::tree::Tree;
    use super::*;
    use proptest::prelude::*;
    use sweepsim_motion::{Patch, Pose, Segment, Tool};
    use sweepsim_spline::Bernstein;

    /// Six bilinear patches, of no symmetry about the tool's axis.
    fn block() -> Tool {
        let corner = |k: usize| [0, 1, 2].map(|a| [[-1.5, -0.5, 0.0], [1.0, 1.2, 3.0]][k >> a & 1][a]);
        let faces = [
            [0, 2, 1, 3],
            [4, 5, 6, 7],
            [0, 1, 4, 5],
            [2, 6, 3, 7],
            [0, 4, 2, 6],
            [1, 3, 5, 7],
        ];
        let patch = |face: [usize; 4]| {
            let form = |values: Vec<f64>| Bernstein::new(&[1, 1], values).unwrap();
            let position = [0, 1, 2].map(|a: usize| form(face.map(|k| corner(k)[a]).to_vec()));
            Patch::new(position, form(vec![1.0; 4])).unwrap()
        };
        Tool::from_patches(faces.map(patch).to_vec(), 1e-9).unwrap()
    }

    /// `p′`, and `g` of both faces.
    fn at(element: &PatchForms, r: f64, directions: &Directions) -> (f64, [f64; 2]) {
        let [_, slope] = position(&element.places.along::<4>(r));
        let (_, normals) = element.rim(r);
        let across = Vector3::from(directions.rows[1]).dot(&slope);
        let way = Vector3::from(directions.way);
        (across, normals.map(|[n, _]| n.dot(&way)))
    }

    proptest! {
        /// What is said of a cell for a family of directions holds for each of them, at all of its points.
        #[test]
        fn looks_hold_for_all_of_a_family(
            tool in 0..4_usize, axis in [-1.0..1.0, -1.0..1.0, 0.1..1.0], way in [-2.0..2.0, -2.0..2.0, -1.0..1.0], shift in [-1e-7..1e-7, -1e-7..1e-7, -1e-7..1e-7], shares in [0.0..1.0, 0.0..1.0],
        ) {
            let tool = [Tool::flat(3.0, 9.0), Tool::bull(3.0, 1.0, 9.0), Tool::ball(3.0, 9.0), Ok(block())][tool].clone().unwrap();
            let pose = |tip| Pose::new(tip, axis).unwrap();
            let motion = |way: [f64; 3]| {
                DirectedMotion::new(&Segment::between(&pose([0.0; 3]), &pose(way)).remove(0), 1e-13)
            };
            let (Some(motion), Some(other)) = (motion(way), motion([0, 1, 2].map(|k: usize| way[k] + shift[k]))) else { return Ok(()) };
            let Some((key, family)) = motion.family() else { return Ok(()) };
            let mut all = vec![&motion];
            // A different family for a few of them.
            all.extend(other.family().is_some_and(|(own, _)| own == key).then_some(&other));
            for element in PatchForms::all(&tool).1 {
                let mut cells = Cells::new(&element);
                let blur = Tree::new(&element, &mut cells, 0, &family, 1e-13).blur;
                let mut stack = vec![(0_u32, 0)];
                while let Some((cell, depth)) = stack.pop() {
                    let (lower, upper) = cells.bounds(cell, 0);
                    let look = look((&element, &mut cells, cell), (-1.0, 1.0), &family, &blur, 1e-13);
                    for (share, motion) in shares.iter().flat_map(|share| all.iter().map(move |motion| (share, motion))) {
                        let (across, [a, b]) = at(&element, lower + share * (upper - lower), &motion.own);
                        let is_edge = (a < 0.0) != (b < 0.0);
                        match &look {
                            Look::Empty => prop_assert!(!is_edge),
                            Look::Chart(chart) => {
                                let jump = if (across > 0.0) == (a < 0.0) { 1 } else { -1 };
                                prop_assert!(is_edge && across != 0.0 && chart.jump == jump);
                            }
                            _ => {}
                        }
                    }
                    if matches!(look, Look::Rough) && depth < 24 {
                        stack.extend(cells.split(&element, cell, 0).map(|part| (part, depth + 1)));
                    }
                }
            }
        }
    }
}
