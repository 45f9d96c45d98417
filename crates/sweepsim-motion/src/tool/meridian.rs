//! The outline of a tool of revolution, curve by curve, with the patches and edges that each makes.

use super::Tool;
use crate::boundary::{joins_smoothly, of_piece};
use crate::profile::{OutlinePiece, Shape};
use std::ops::Range;

/// The shape of a [`MeridianCurve`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum MeridianShape {
    /// A straight line.
    Line,
    /// An arc of a circle.
    Arc {
        /// Centre of the circle, `(ρ, ζ)`.
        centre: [f64; 2],
        /// Its radius.
        radius: f64,
        /// The angle from `ρ` towards `ζ`, seen from the centre, at which the arc begins, in radians.
        start: f64,
        /// By how much that angle grows along the arc; negative where the surface is concave.
        sweep: f64,
    },
    /// A Bézier curve of degree 2 or more.
    Spline,
}

/// A curve of the outline of a tool of revolution, in `(ρ, ζ)`: splines are cut at their knots.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeridianCurve {
    /// Where it begins.
    pub from: [f64; 2],
    /// Where it ends.
    pub to: [f64; 2],
    /// Its unit directions at the start and at the end; the normal out of the tool is to the right.
    pub directions: [[f64; 2]; 2],
    /// Its shape.
    pub shape: MeridianShape,
    /// Control points and weights of a spline; none for lines and arcs.
    pub controls: Vec<([f64; 2], f64)>,
    /// The [patches](Tool::patches) of its surface of revolution.
    pub patches: Range<usize>,
    /// The [edges](Tool::edges) where it begins: none if it joins the curve before it smoothly.
    pub edges: Range<usize>,
}

/// Quarters of a circle.
const QUARTERS: usize = 4;

impl Tool {
    /// The curves of the outline, from the tip to the top; none for tools without a [profile](Tool::profile).
    ///
    /// ```
    /// use sweepsim_motion::Tool;
    /// let curves = Tool::flat(3.0, 20.0)?.meridians();
    /// assert_eq!(curves[1].from, [3.0, 0.0]);
    /// assert_eq!((curves[1].patches.clone(), curves[1].edges.clone()), (1..5, 0..4));
    /// # Ok::<(), sweepsim_motion::ProfileError>(())
    /// ```
    #[must_use]
    pub fn meridians(&self) -> Vec<MeridianCurve> {
        let pieces = self.profile().map_or_else(Vec::new, |profile| profile.pieces());
        let (mut patches, mut edges) = (0, 0);
        let mut before: Option<&OutlinePiece> = None;
        let curve = |piece| {
            let count = of_piece(piece).len();
            let sharp = before.is_some_and(|before| !joins_smoothly(before, piece));
            let rims = if sharp { QUARTERS } else { 0 };
            before = Some(piece);
            patches += count;
            edges += rims;
            MeridianCurve {
                from: piece.from.into(),
                to: piece.to.into(),
                directions: [false, true].map(|end| piece.direction(end).into()),
                shape: match &piece.shape {
                    Shape::Line => MeridianShape::Line,
                    Shape::Bezier(_) => MeridianShape::Spline,
                    Shape::Arc(arc) => MeridianShape::Arc {
                        centre: arc.centre.into(),
                        radius: arc.radius,
                        start: arc.start,
                        sweep: arc.sweep,
                    },
                },
                controls: match &piece.shape {
                    Shape::Bezier(curve) => {
                        let points = curve.points.iter().map(|point| (*point).into());
                        points.zip(curve.weights.iter().copied()).collect()
                    }
                    _ => Vec::new(),
                },
                patches: patches - count..patches,
                edges: edges - rims..edges,
            }
        };
        pieces.iter().map(curve).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::{Lens, Lollipop};

    #[test]
    fn all_patches_and_edges_belong_to_a_curve() {
        let lens = Lens {
            radius: 5.0,
            bottom: 20.0,
            corner: 1.0,
            length: 30.0,
        };
        let lollipop = Lollipop {
            radius: 4.0,
            neck: 1.5,
            length: 30.0,
        };
        let tools = [
            Tool::ball(3.0, 10.0),
            Tool::flat(3.0, 10.0),
            Tool::bull(3.0, 1.0, 10.0),
            Tool::lens(lens),
            Tool::lollipop(lollipop),
        ];
        for tool in tools.map(|tool| tool.expect("a tool")) {
            let curves = tool.meridians();
            let last = curves.last().expect("a curve");
            assert_eq!(
                [last.patches.end, last.edges.end],
                [tool.patches().len(), tool.edges().len()]
            );
            for pair in curves.windows(2) {
                assert_eq!(pair[0].to, pair[1].from);
            }
            for curve in &curves {
                for patch in &tool.patches()[curve.patches.clone()] {
                    let [x, y, z] = patch.point(0.3, 0.7);
                    let rho = x.hypot(y);
                    let off = match curve.shape {
                        MeridianShape::Arc { centre, radius, .. } => (rho - centre[0]).hypot(z - centre[1]) - radius,
                        _ => {
                            let [a, b] = curve.directions[0];
                            (rho - curve.from[0]) * b - (z - curve.from[1]) * a
                        }
                    };
                    assert!(off.abs() < 1e-12, "{off} {curve:?}");
                }
            }
        }
    }
}
