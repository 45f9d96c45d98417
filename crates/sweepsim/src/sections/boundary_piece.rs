//! Points on the boundary of a swept volume, patch by patch: the envelope, edges, kinks and caps, as used by sections and surfaces.

use crate::cutter::patch_forms::PatchForms;
use crate::time::path_parts::PathPart;
use crate::time::pieces::Times;
use nalgebra::Vector3;
use sweepsim_motion::{Segment, SegmentEnd, Tool};

/// The origin of a piece of a swept volume's boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum BoundaryPiece {
    /// The envelope of this patch of the tool (Eq. 2).
    Patch(usize),
    /// The envelope of this sharp edge (Eq. 3).
    Edge(usize),
    /// This patch at the start of a move: the start cap of a path, or where its direction changes.
    Placed(usize),
    /// This patch at the end of the path: its end cap.
    Last(usize),
}

/// A point of a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BoundaryPoint {
    /// The position.
    pub position: [f64; 3],
    /// Unit normal of the envelope, out of the tool.
    pub normal: [f64; 3],
    /// The time in the move, in `[0, 1]`.
    pub t: f64,
}

/// A prepared tool, with one part of a path.
pub(crate) struct Moving<'a> {
    pub patches: &'a [PatchForms],
    pub edges: &'a [PatchForms],
    pub parts: &'a [PathPart],
    pub at: usize,
    times: Times,
}

/// A point, and two conditions: it belongs to the boundary of the move where their signs differ.
pub(crate) struct BoundarySample {
    pub point: BoundaryPoint,
    pub sides: Option<[f64; 2]>,
}

impl<'a> Moving<'a> {
    pub fn new(patches: &'a [PatchForms], edges: &'a [PatchForms], parts: &'a [PathPart], at: usize) -> Self {
        Self {
            patches,
            edges,
            parts,
            at,
            times: Times::new(&parts[at].segment),
        }
    }

    pub fn part(&self) -> &'a PathPart {
        &self.parts[self.at]
    }

    /// The point of a piece at its parameters: `u, v, t` of patches, `r, t` of edges, `u, v` of placed patches.
    pub fn see(&self, piece: BoundaryPiece, x: &[f64]) -> BoundarySample {
        match piece {
            BoundaryPiece::Patch(k) => {
                let seen = self.on_patch(k, [x[0], x[1]], x[2]);
                BoundarySample {
                    point: seen.0,
                    sides: None,
                }
            }
            BoundaryPiece::Edge(k) => self.on_edge(k, x[0], x[1]),
            BoundaryPiece::Placed(k) => {
                let (point, field) = self.on_patch(k, [x[0], x[1]], 0.0);
                let before = self.at.checked_sub(1).map_or(1.0, |k| {
                    condition(
                        &self.parts[k].segment,
                        SegmentEnd::Finish,
                        self.part().segment.start(),
                        &field,
                    )
                });
                let after = condition(
                    &self.part().segment,
                    SegmentEnd::Start,
                    self.part().segment.start(),
                    &field,
                );
                BoundarySample {
                    point,
                    sides: Some([before, after]),
                }
            }
            BoundaryPiece::Last(k) => {
                let (point, field) = self.on_patch(k, [x[0], x[1]], 1.0);
                let before = condition(
                    &self.part().segment,
                    SegmentEnd::Finish,
                    self.part().segment.end(),
                    &field,
                );
                BoundarySample {
                    point,
                    sides: Some([before, -1.0]),
                }
            }
        }
    }

    /// Converts a time of the part to a time of its move.
    fn time(&self, t: f64) -> f64 {
        let part = self.part();
        f64::from(part.start) + f64::from(part.share) * part.segment.time(t)
    }

    /// The point, and normal and moment in the tool.
    fn on_patch(&self, k: usize, at: [f64; 2], t: f64) -> (BoundaryPoint, [Vector3<f64>; 2]) {
        let (position, [normal, arm]) = self.patches[k].face(at);
        let moment = self.times.at(t);
        let seen = BoundaryPoint {
            position: (moment.turn * position + moment.tip).into(),
            normal: unit(moment.turn * normal),
            t: self.time(t),
        };
        (seen, [normal, arm])
    }

    fn on_edge(&self, k: usize, r: f64, t: f64) -> BoundarySample {
        let (position, fields) = self.edges[k].rim(r);
        let moment = self.times.at(t);
        let [a, b] = fields.map(|[normal, arm]| moment.own_spin.dot(&arm) + moment.travel.dot(&normal));
        // The envelope's normal lies in the fan of the two patches, where g = 0.
        let [n, m] = fields.map(|[normal, _]| moment.turn * normal);
        let (p, q) = (a.abs() / n.norm(), b.abs() / m.norm());
        let (n, m) = (n / n.norm(), m / m.norm());
        BoundarySample {
            point: BoundaryPoint {
                position: (moment.turn * position + moment.tip).into(),
                normal: unit(n * q + m * p),
                t: self.time(t),
            },
            sides: Some([a, b]),
        }
    }

    /// The pieces of the part, except the end cap, which only the last part has.
    pub fn pieces(&self, tool: &Tool) -> Vec<BoundaryPiece> {
        let (patches, edges) = (tool.patches().len(), tool.edges().len());
        let mut pieces: Vec<BoundaryPiece> = (0..patches).map(BoundaryPiece::Patch).collect();
        pieces.extend((0..edges).map(BoundaryPiece::Edge));
        pieces.extend((0..patches).map(BoundaryPiece::Placed));
        if self.at + 1 == self.parts.len() {
            pieces.extend((0..patches).map(BoundaryPiece::Last));
        }
        pieces
    }

    /// No point of a tool with this reach moves faster, per unit of `t`.
    pub fn speed(&self, reach: f64) -> f64 {
        let segment = &self.part().segment;
        let (tips, tip_weights) = segment.tip_rate();
        let (turns, turn_weights) = segment.turn_rate();
        let tip = tips.iter().zip(&tip_weights).map(|(rate, w)| rate.norm() / w);
        let turn = turns.iter().zip(&turn_weights).map(|(rate, w)| rate.norm() / w);
        tip.fold(0.0, f64::max) + turn.fold(0.0, f64::max) * reach
    }
}

/// `g` of a normal and moment in the tool, under the motion at a placement.
fn condition(
    segment: &Segment,
    end: SegmentEnd,
    turn: nalgebra::Matrix3<f64>,
    [normal, moment]: &[Vector3<f64>; 2],
) -> f64 {
    let back = turn.transpose();
    let [spin, travel] = segment.velocity(end).map(Vector3::from);
    (back * spin).dot(moment) + (back * travel).dot(normal)
}

fn unit(v: Vector3<f64>) -> [f64; 3] {
    let length = v.norm();
    if length > 0.0 { (v / length).into() } else { v.into() }
}
