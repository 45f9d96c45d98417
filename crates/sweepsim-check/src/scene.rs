//! What a certificate is about, as plain numbers: the caller reads it out of the program's files.

use crate::vector::V3;
use sha2::{Digest, Sha256};

/// A target, tools, and the paths of these. All lengths are in the same unit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// The target: triangles, counter-clockwise seen from outside.
    pub triangles: Vec<[V3; 3]>,
    /// The cutters, each by its number.
    pub tools: Vec<(u32, Outline)>,
    /// The paths.
    pub paths: Vec<Path>,
    /// No point of a cutter is farther than this from where [pieces](Move::Pieces) say.
    pub deviation: f64,
}

/// A tool of revolution: its outline in `(ρ, ζ)`, from the tip on the axis to the top on the axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline {
    /// The curves, one after the other.
    pub curves: Vec<Curve>,
    /// For a tool without an outline: points in whose hull, turned about the axis, the tool is. This is not checked.
    pub points: Vec<[f64; 2]>,
}

/// A curve of an outline.
#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    /// A straight line.
    Line([[f64; 2]; 2]),
    /// An arc of a circle.
    Arc {
        /// Its ends.
        ends: [[f64; 2]; 2],
        /// The centre.
        centre: [f64; 2],
        /// The radius.
        radius: f64,
        /// The angle at which it begins, in radians from `ρ` towards `ζ`.
        start: f64,
        /// By how much that angle grows; negative where the tool is outside of the circle.
        sweep: f64,
    },
    /// A rational Bézier curve: control points and weights.
    Bezier(Vec<([f64; 2], f64)>),
}

/// The path of a tool.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Path {
    /// The number of the tool.
    pub tool: u32,
    /// Tip and axis, a unit vector, before the first move and after each.
    pub poses: Vec<[V3; 2]>,
    /// The moves from each pose to the next.
    pub moves: Vec<Move>,
    /// Other courses that moves may take: the number of the move, and its poses. All these moves are linear.
    pub others: Vec<(usize, Vec<[V3; 2]>)>,
}

/// How a tool gets from one pose to the next.
#[derive(Clone, Debug, PartialEq)]
pub enum Move {
    /// The tip goes straight, while the axis turns the shortest way, as one rational arc, or as two if by more
    /// than 90°.
    Linear,
    /// Along rational curves, within the [deviation](Scene::deviation) of what the program says.
    Pieces(Vec<Piece>),
}

/// A rational motion for `t` from 0 to 1, by the Bernstein coefficients of its numerators and weights.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Piece {
    /// The tip times the weight.
    pub tips: Vec<V3>,
    /// The weight of the tip, positive.
    pub tip_weights: Vec<f64>,
    /// The axis times its weight: at most one coefficient if it keeps still.
    pub axes: Vec<V3>,
    /// The weight of the axis, positive.
    pub axis_weights: Vec<f64>,
}

impl Scene {
    /// The SHA-256 of all its numbers, in hexadecimal.
    #[must_use]
    pub fn digest(&self) -> String {
        let mut all = Numbers(Sha256::new());
        all.put(&[self.deviation]);
        all.count(self.triangles.len());
        self.triangles.iter().flatten().for_each(|corner| all.put(corner));
        all.count(self.tools.len());
        for (number, outline) in &self.tools {
            all.count(*number as usize);
            all.count(outline.points.len());
            outline.points.iter().for_each(|point| all.put(point));
            all.count(outline.curves.len());
            outline.curves.iter().for_each(|curve| all.curve(curve));
        }
        all.count(self.paths.len());
        for path in &self.paths {
            all.count(path.tool as usize);
            all.count(path.poses.len());
            path.poses.iter().flatten().for_each(|vector| all.put(vector));
            all.count(path.moves.len());
            path.moves.iter().for_each(|own| all.motion(own));
            all.count(path.others.len());
            for (number, poses) in &path.others {
                all.count(*number);
                all.count(poses.len());
                poses.iter().flatten().for_each(|vector| all.put(vector));
            }
        }
        hexadecimal(&all.0.finalize())
    }
}

/// What is digested: each number by its eight bytes, each list after its length.
struct Numbers(Sha256);

impl Numbers {
    fn put(&mut self, numbers: &[f64]) {
        // Zero has two signs, and one value.
        let bytes = numbers.iter().flat_map(|number| (number + 0.0).to_le_bytes());
        self.0.update(bytes.collect::<Vec<u8>>());
    }

    fn count(&mut self, count: usize) {
        self.0.update((count as u64).to_le_bytes());
    }

    fn curve(&mut self, curve: &Curve) {
        match curve {
            Curve::Line(ends) => {
                self.count(0);
                self.put(ends.as_flattened());
            }
            Curve::Arc {
                ends,
                centre,
                radius,
                start,
                sweep,
            } => {
                self.count(1);
                self.put(ends.as_flattened());
                self.put(&[centre[0], centre[1], *radius, *start, *sweep]);
            }
            Curve::Bezier(controls) => {
                self.count(2);
                self.count(controls.len());
                controls.iter().for_each(|([x, y], w)| self.put(&[*x, *y, *w]));
            }
        }
    }

    fn motion(&mut self, own: &Move) {
        let Move::Pieces(pieces) = own else {
            return self.count(0);
        };
        self.count(1 + pieces.len());
        for piece in pieces {
            for (points, weights) in [(&piece.tips, &piece.tip_weights), (&piece.axes, &piece.axis_weights)] {
                self.count(points.len());
                self.put(points.as_flattened());
                self.count(weights.len());
                self.put(weights);
            }
        }
    }
}

/// Bytes as text.
pub(crate) fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
