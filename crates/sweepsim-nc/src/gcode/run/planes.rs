//! The planes of `G68.2`: by angles, by three points, by two vectors.
//!
//! Sources: Fanuc B-63942EN and Mazak's *Inclined-plane machining* (96 Vortex i, `G68.2 P1`: roll, pitch and yaw in the order `Q`); LinuxCNC's
//! `interp_workplane.cc` for the words of each block of `P2` and `P3` and for `G68.4`. Projection angles (`P4`) were found nowhere in words precise enough to read them.

use nalgebra::{Matrix3, Vector3};

use super::interpreter::Reader;
use crate::gcode::syntax::block::Block;
use crate::machines::WorkFrame;
use crate::model::read_options::Controller;
use crate::text::error::NcProblem;

/// The blocks so far of a plane that takes several.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PlaneBlocks {
    /// `P`: 2 by three points, 3 by two vectors.
    kind: u32,
    /// By `Q`.
    given: [Option<PlaneWords>; 4],
}

/// The words of one of them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct PlaneWords {
    /// X, Y, Z.
    point: [f64; 3],
    /// I, J, K.
    vector: [f64; 3],
    /// R.
    turn: f64,
}

impl Reader {
    /// The plane of a block of `G68.2` or `G68.4`; `None` if further blocks have to come.
    pub(crate) fn plane_of(&mut self, block: &Block) -> Result<Option<WorkFrame>, NcProblem> {
        let word = |letter: char| block.get(letter).unwrap_or(0.0);
        let origin = ['X', 'Y', 'Z'].map(|letter| word(letter) * self.unit());
        let vector = ['I', 'J', 'K'].map(word);
        match block.get('P').unwrap_or(0.0) {
            kind @ (0.0 | 1.0) => self.plane_by_angles(kind == 1.0, block, origin, vector).map(Some),
            kind @ (2.0 | 3.0) => self.plane_by_blocks(kind as u32, block, origin, vector),
            4.0 => Err(NcProblem::unsupported(
                "tilted planes by projection angles (G68.2 P4) are",
                "expected P0 to P3",
            )),
            kind => Err(NcProblem::value("P of G68.2", kind, "0, 1, 2 or 3")),
        }
    }

    /// `P0`: each angle about an axis as turned so far, Z, X, Z unless `Q` says otherwise. `P1`: about the fixed axes, X first unless `Q` says otherwise.
    fn plane_by_angles(
        &self,
        fixed: bool,
        block: &Block,
        origin: [f64; 3],
        angles: [f64; 3],
    ) -> Result<WorkFrame, NcProblem> {
        let usual = if fixed { 123.0 } else { 313.0 };
        let order = block.get('Q').unwrap_or(usual);
        let Some(axes) = axes(order) else {
            return Err(NcProblem::value(
                "Q, the order of axes of a tilted plane",
                order,
                "three digits from 1 to 3, no two alike beside each other",
            ));
        };
        // LinuxCNC gives the angles in the order of the turns; the others by axis, I about X: that is one angle an axis.
        let by_axis = fixed && self.rules.controller != Some(Controller::LinuxCnc);
        if by_axis && (axes[0] == axes[2])
            || !fixed && order != usual && self.rules.controller != Some(Controller::LinuxCnc)
        {
            return Err(NcProblem::unsupported(
                format!("the order of axes Q{order} is"),
                if fixed {
                    "expected one with each of 1, 2 and 3"
                } else {
                    "expected Q313, or none"
                },
            ));
        }
        let turns = axes.iter().enumerate().map(|(k, axis)| {
            let angle = if by_axis { angles[*axis] } else { angles[k] };
            WorkFrame::turned(*axis, angle)
        });
        let turned = turns.fold(WorkFrame::default(), |all, turn| {
            if fixed { turn.then(&all) } else { all.then(&turn) }
        });
        Ok(WorkFrame::shifted(origin)
            .then(&turned)
            .then(&WorkFrame::turned(2, block.get('R').unwrap_or(0.0))))
    }

    fn plane_by_blocks(
        &mut self,
        kind: u32,
        block: &Block,
        origin: [f64; 3],
        vector: [f64; 3],
    ) -> Result<Option<WorkFrame>, NcProblem> {
        let (first, last) = if kind == 2 { (0, 3) } else { (1, 2) };
        let mut blocks = self.pending.plane.take().unwrap_or(PlaneBlocks {
            kind,
            ..PlaneBlocks::default()
        });
        let began = blocks.given.iter().any(Option::is_some);
        let next = if began {
            1 + blocks.given.iter().rposition(Option::is_some).unwrap_or(0)
        } else {
            first
        };
        let q = match block.get('Q') {
            // The origin of three points may be left out: it is the first of them.
            Some(q) if blocks.kind == kind && (q == next as f64 || kind == 2 && !began && q == 1.0) => q as usize,
            q => {
                let found = q.map_or_else(|| "none".to_owned(), |q| q.to_string());
                return Err(NcProblem::value(
                    format!("Q of G68.2 P{kind}"),
                    found,
                    format!("{next} here"),
                ));
            }
        };
        blocks.given[q] = Some(PlaneWords {
            point: origin,
            vector,
            turn: block.get('R').unwrap_or(0.0),
        });
        if q < last {
            self.pending.plane = Some(blocks);
            return Ok(None);
        }
        let given = |q: usize| blocks.given[q].unwrap_or_default();
        let (x, z, origin, turn) = if kind == 2 {
            let [a, b, c] = [1, 2, 3].map(|q| Vector3::from(given(q).point));
            let first = blocks.given[0].unwrap_or(PlaneWords {
                point: given(1).point,
                ..PlaneWords::default()
            });
            (b - a, (b - a).cross(&(c - a)), first.point, first.turn)
        } else {
            let first = given(1);
            (
                Vector3::from(first.vector),
                Vector3::from(given(2).vector),
                first.point,
                first.turn,
            )
        };
        let (Some(z), true) = (z.try_normalize(0.0), x.norm() > 0.0) else {
            return Err(NcProblem::syntax(if kind == 2 {
                "the three points of this plane are on one line: expected others"
            } else {
                "a direction of this plane is (0, 0, 0): expected I, J and K of X with Q1, of Z with Q2"
            }));
        };
        // Rounded directions are not quite at right angles.
        let across = x - z * z.dot(&x);
        if across.norm() < 1e-6 * x.norm() {
            return Err(NcProblem::syntax(
                "X of this plane is along its Z: expected another direction",
            ));
        }
        let x = across.normalize();
        let frame = WorkFrame::with_matrix(Matrix3::from_columns(&[x, z.cross(&x), z]), origin.into());
        Ok(Some(frame.then(&WorkFrame::turned(2, turn))))
    }

    /// A block other than the next one of the plane: none may come between.
    pub(crate) fn check_plane_blocks(&mut self, block: &Block) -> Result<(), NcProblem> {
        let goes_on = |blocks: &PlaneBlocks| {
            let mut codes = block.words().iter().filter(|word| word.letter == 'G');
            codes.any(|word| matches!(word.value, 68.2 | 68.4 | 268.0))
                && block.get('P') == Some(f64::from(blocks.kind))
        };
        match self.pending.plane {
            Some(blocks) if !goes_on(&blocks) => {
                self.pending.plane = None;
                Err(NcProblem::syntax(format!(
                    "the plane of G68.2 P{} is not complete: expected its next Q before this",
                    blocks.kind
                )))
            }
            _ => Ok(()),
        }
    }
}

/// The axes of three digits from 1 to 3.
fn axes(order: f64) -> Option<[usize; 3]> {
    if order.fract() != 0.0 || !(111.0..=333.0).contains(&order) {
        return None;
    }
    let digits = order as usize;
    let axes = [digits / 100, digits / 10 % 10, digits % 10];
    let good = axes.iter().all(|axis| (1..=3).contains(axis)) && axes[0] != axes[1] && axes[1] != axes[2];
    good.then(|| axes.map(|axis| axis - 1))
}
