//! A chain of joints from the part to the tool, and how far it can carry a body.

use nalgebra::{Matrix3, Unit, Vector3};
use smallvec::SmallVec;

/// The most joints of a chain.
pub const JOINTS: usize = 6;

/// The values of all joints: millimetres of linear joints, degrees of rotary ones. Those beyond the last joint are 0.
pub type Values = [f64; JOINTS];

/// A joint between two links. It says where points of the link nearer to the tool are, as seen from the one nearer to
/// the part.
#[derive(Clone, Debug, PartialEq)]
pub enum Joint {
    /// Moved by its value along a direction.
    Linear(Unit<Vector3<f64>>),
    /// Turned by its value about an axis through a point, right-handed.
    Rotary {
        /// The direction of the axis.
        axis: Unit<Vector3<f64>>,
        /// A point of the axis, in both links with the joint at 0.
        pivot: Vector3<f64>,
    },
}

/// A turn, and then a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rigid {
    pub turn: Matrix3<f64>,
    pub shift: Vector3<f64>,
}

impl Rigid {
    pub const IDENTITY: Self = Self {
        turn: Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
        shift: Vector3::new(0.0, 0.0, 0.0),
    };

    pub fn of(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.turn * point + self.shift
    }

    /// `inner` first.
    fn after(&self, inner: &Self) -> Self {
        Self {
            turn: self.turn * inner.turn,
            shift: self.of(&inner.shift),
        }
    }

    pub fn inverse(&self) -> Self {
        let turn = self.turn.transpose();
        Self {
            turn,
            shift: -(turn * self.shift),
        }
    }
}

impl Joint {
    fn frame(&self, value: f64) -> Rigid {
        match self {
            Self::Linear(direction) => Rigid {
                turn: Matrix3::identity(),
                shift: direction.into_inner() * value,
            },
            Self::Rotary { axis, pivot } => {
                let (sine, cosine) = value.to_radians().sin_cos();
                let k = axis.into_inner();
                let turn = Matrix3::identity() * cosine + k * k.transpose() * (1.0 - cosine) + k.cross_matrix() * sine;
                Rigid {
                    turn,
                    shift: pivot - turn * pivot,
                }
            }
        }
    }
}

/// All links of a machine, in one chain: link 0 carries the part, the last one the tool, and joint `k` is between the
/// links `k` and `k + 1`. Which of them stands still does not matter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Linkage {
    joints: Vec<Joint>,
}

/// Where the joints are in some time: within `spread` of `middle + s way`, with `s` from -1 to 1, the same for all.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    pub middle: Values,
    pub way: Values,
    pub spread: Values,
}

/// How far points may be from where they are in the middle of a span, `u` being any unit vector: along it at most
/// `rest + |way·u| + Σ |sideways·u|`.
#[derive(Clone, Debug)]
pub(crate) struct Travel {
    rest: f64,
    way: Vector3<f64>,
    sideways: SmallVec<[Vector3<f64>; 3]>,
}

impl Travel {
    pub fn along(&self, u: &Vector3<f64>) -> f64 {
        let sideways: f64 = self.sideways.iter().map(|way| way.dot(u).abs()).sum();
        self.rest + self.way.dot(u).abs() + sideways
    }

    /// In any direction.
    pub fn most(&self) -> f64 {
        self.rest + self.lengths()
    }

    fn lengths(&self) -> f64 {
        self.way.norm() + self.sideways.iter().map(Vector3::norm).sum::<f64>()
    }
}

impl Linkage {
    /// A chain of at most [`JOINTS`] joints, from the part to the tool; `None` if there are more.
    #[must_use]
    pub fn new(joints: Vec<Joint>) -> Option<Self> {
        (joints.len() <= JOINTS).then_some(Self { joints })
    }

    /// The joints.
    #[must_use]
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// The number of links.
    #[must_use]
    pub fn links(&self) -> usize {
        self.joints.len() + 1
    }

    /// Where a point of link `of` is, as seen from link `from`.
    #[must_use]
    pub fn place(&self, point: [f64; 3], of: usize, from: usize, at: &Values) -> [f64; 3] {
        let frame = if from <= of {
            self.frame(from, of, at)
        } else {
            self.frame(of, from, at).inverse()
        };
        frame.of(&Vector3::from(point)).into()
    }

    /// From the coordinates of link `of` to those of link `from`, which is not nearer to the tool.
    pub(crate) fn frame(&self, from: usize, of: usize, at: &Values) -> Rigid {
        let joints = self.joints.iter().zip(at).take(of).skip(from);
        joints.fold(Rigid::IDENTITY, |outer, (joint, value)| {
            outer.after(&joint.frame(*value))
        })
    }

    /// How far points within `radius` of a point of link `of` can be from their places in the middle of a span, as seen
    /// from link `from`.
    ///
    /// From the tool to the part: an isometry keeps what points are off, a turn by `δ` more takes one at the distance
    /// `r` from its axis no farther than `δ r`, and turns what shifts have added.
    pub(crate) fn travel(&self, [from, of]: [usize; 2], span: &Span, centre: &Vector3<f64>, radius: f64) -> Travel {
        let mut centre = *centre;
        let mut travel = Travel {
            rest: 0.0,
            way: Vector3::zeros(),
            sideways: SmallVec::new(),
        };
        for k in (from..of).rev() {
            let joint = &self.joints[k];
            let (way, spread) = (span.way[k], span.spread[k]);
            let frame = joint.frame(span.middle[k]);
            match joint {
                Joint::Linear(direction) => {
                    travel.way += direction.into_inner() * way;
                    if spread > 0.0 {
                        travel.sideways.push(direction.into_inner() * spread);
                    }
                }
                Joint::Rotary { axis, pivot } => {
                    let turned = (way.abs() + spread).to_radians();
                    let distance = axis.cross(&(centre - pivot)).norm() + radius;
                    // No point moves farther than across the circle.
                    let circle = turned.min(2.0);
                    travel.rest += circle * (distance + travel.lengths());
                    travel.way = frame.turn * travel.way;
                    for way in &mut travel.sideways {
                        *way = frame.turn * *way;
                    }
                }
            }
            centre = frame.of(&centre);
        }
        travel
    }
}
