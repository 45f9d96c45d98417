//! The judge's own machine: joints, hulls, and how far these are apart.

use nalgebra::{Isometry3, Point3, Translation3, Unit, UnitQuaternion, Vector3};
use sweepsim_nc::{BodyShape, Carries, MachineDescription};

/// A body as points whose hull it is.
pub struct Hull {
    pub name: String,
    link: usize,
    points: Vec<Vector3<f64>>,
}

fn circle(base: Vector3<f64>, axis: Vector3<f64>, radius: f64) -> Vec<Vector3<f64>> {
    let side = axis.cross(&Vector3::new(0.3, 0.5, 0.8)).normalize();
    let (u, v) = (side * radius, axis.normalize().cross(&side) * radius);
    (0..48)
        .map(|k| f64::from(k) * std::f64::consts::TAU / 48.0)
        .map(|t| base + u * t.cos() + v * t.sin())
        .collect()
}

fn corners(min: [f64; 3], max: [f64; 3]) -> Vec<Vector3<f64>> {
    (0..8)
        .map(|n| Vector3::from_fn(|k, _| if n >> k & 1 == 0 { min[k] } else { max[k] }))
        .collect()
}

/// The machine as the judge sees it: joints from the part to the tool.
pub struct Judge {
    /// Letter, direction, a point of the axis, whether it carries the part.
    joints: Vec<(char, Vector3<f64>, Vector3<f64>, bool)>,
    pub hulls: Vec<Hull>,
    /// The number of hulls that belong to the machine.
    own: usize,
    length: f64,
    /// Where the part's zero is in machine coordinates.
    zero: [f64; 3],
}

impl Judge {
    pub fn new(machine: &MachineDescription, stock: [[f64; 3]; 2], radius: f64, height: f64) -> Self {
        let rotary = |axis: &sweepsim_nc::RotaryAxis, part| {
            (
                axis.letter,
                Vector3::from(axis.axis).normalize(),
                Vector3::from(axis.pivot),
                part,
            )
        };
        let linear = |carries: Carries| {
            let axes = machine.linear.iter().filter(move |axis| axis.carries == carries);
            axes.map(move |axis| {
                let along = Vector3::ith(axis.letter as usize - 'X' as usize, 1.0);
                (axis.letter, along, Vector3::zeros(), carries == Carries::Part)
            })
        };
        let mut joints: Vec<_> = machine.table.iter().map(|axis| rotary(axis, true)).collect();
        joints.extend(linear(Carries::Part));
        joints.extend(linear(Carries::Tool));
        joints.extend(machine.head.iter().map(|axis| rotary(axis, false)));
        let base = joints.iter().filter(|joint| joint.3).count();
        let link = |on: &str| match joints.iter().position(|joint| joint.0.to_string() == on) {
            Some(n) if joints[n].3 => n,
            Some(n) => n + 1,
            None => base,
        };
        let mut hulls: Vec<Hull> = Vec::new();
        for body in &machine.bodies {
            let points = match &body.shape {
                BodyShape::Block { min, max } => corners(*min, *max),
                BodyShape::Cylinder { from, to, radius } => {
                    let (from, to) = (Vector3::from(*from), Vector3::from(*to));
                    [from, to]
                        .iter()
                        .flat_map(|end| circle(*end, to - from, *radius))
                        .collect()
                }
                other => panic!("{other:?}"),
            };
            let (name, link) = (body.name.clone(), link(&body.on));
            hulls.push(Hull { name, link, points });
        }
        let own = hulls.len();
        hulls.push(Hull {
            name: "raw stock".into(),
            link: 0,
            points: corners(
                [0, 1, 2].map(|k| stock[0][k] + machine.part_zero[k]),
                [0, 1, 2].map(|k| stock[1][k] + machine.part_zero[k]),
            ),
        });
        let ends = [0.0, height].map(|z| Vector3::new(0.0, 0.0, z - machine.tool_length));
        let cutter = ends.iter().flat_map(|end| circle(*end, Vector3::z(), radius)).collect();
        hulls.push(Hull {
            name: "cutter of tool 1".into(),
            link: joints.len(),
            points: cutter,
        });
        Self {
            joints,
            hulls,
            own,
            length: machine.tool_length,
            zero: machine.part_zero,
        }
    }

    /// From the coordinates of a link to those of the part.
    fn frame(&self, link: usize, [xyz, abc]: [[f64; 3]; 2]) -> Isometry3<f64> {
        let mut all = Isometry3::identity();
        for (letter, axis, pivot, _) in &self.joints[..link] {
            all *= match letter {
                'X'..='Z' => {
                    let k = *letter as usize - 'X' as usize;
                    let length = if k == 2 { self.length } else { 0.0 };
                    Isometry3::from(Translation3::from(axis * (xyz[k] + self.zero[k] + length)))
                }
                _ => {
                    let angle = abc[*letter as usize - 'A' as usize].to_radians();
                    let turn = UnitQuaternion::from_axis_angle(&Unit::new_unchecked(*axis), angle);
                    Isometry3::rotation_wrt_point(turn, Point3::from(*pivot))
                }
            };
        }
        all
    }

    pub fn pairs(&self) -> Vec<(usize, usize)> {
        let mut pairs = Vec::new();
        for a in 0..self.own {
            for b in a + 1..self.hulls.len() {
                let (i, j) = (self.hulls[a].link, self.hulls[b].link);
                if i != j && (b >= self.own || i.abs_diff(j) > 1) {
                    pairs.push((a, b));
                }
            }
        }
        pairs
    }

    /// The points of a hull, in the coordinates of the part.
    fn seen(&self, n: usize, at: [[f64; 3]; 2]) -> Vec<Vector3<f64>> {
        let frame = self.frame(self.hulls[n].link, at);
        let points = self.hulls[n].points.iter();
        points.map(|p| (frame * Point3::from(*p)).coords).collect()
    }

    /// Bounds of the distance of two hulls.
    pub fn apart(&self, (a, b): (usize, usize), at: [[f64; 3]; 2]) -> [f64; 2] {
        Self::between(&self.seen(a, at), &self.seen(b, at))
    }

    /// Points of the stock that a move leaves of those that are left.
    pub fn cut(
        &self,
        left: &mut Vec<Vector3<f64>>,
        places: impl Iterator<Item = [[f64; 3]; 2]>,
        radius: f64,
        height: f64,
    ) {
        for at in places {
            let from_part = self.frame(self.joints.len(), at).inverse();
            left.retain(|point| {
                let own = (from_part * Point3::from(*point)).coords;
                let up = own.z + self.length;
                !(own.xy().norm() <= radius && (0.0..=height).contains(&up))
            });
        }
    }

    /// How near the nearest of some points is to a hull, from above.
    pub fn nearest(&self, hull: usize, points: &[Vector3<f64>], at: [[f64; 3]; 2]) -> f64 {
        let own = self.seen(hull, at);
        let (mut low, mut high) = (own[0], own[0]);
        for point in &own {
            (low, high) = (low.inf(point), high.sup(point));
        }
        let near = points.iter().filter(|p| (*p - p.sup(&low).inf(&high)).norm() < 10.0);
        near.map(|point| Self::between(&own, std::slice::from_ref(point))[1])
            .fold(f64::INFINITY, f64::min)
    }

    /// Whether a pair is of the stock.
    pub fn is_stock(&self, (_, b): (usize, usize)) -> bool {
        b == self.own
    }

    /// A point each 5 mm in the stock.
    pub fn points_of_stock(&self, [low, high]: [[f64; 3]; 2]) -> Vec<Vector3<f64>> {
        let along = |k: usize| {
            let steps = ((high[k] - low[k]) / 5.0) as usize;
            (0..steps).map(move |n| low[k] + self.zero[k] + 5.0 * n as f64 + 2.5)
        };
        let mut all = Vec::new();
        for x in along(0) {
            for y in along(1) {
                all.extend(along(2).map(|z| Vector3::new(x, y, z)));
            }
        }
        all
    }

    fn between(p: &[Vector3<f64>], q: &[Vector3<f64>]) -> [f64; 2] {
        let nearest = |points: &[Vector3<f64>], u: &Vector3<f64>| {
            *points.iter().min_by(|a, b| a.dot(u).total_cmp(&b.dot(u))).unwrap()
        };
        let mean = |points: &[Vector3<f64>]| points.iter().sum::<Vector3<f64>>() / points.len() as f64;
        let mut v = mean(q) - mean(p);
        let mut low = f64::NEG_INFINITY;
        for _ in 0..400 {
            let s = nearest(q, &v) - nearest(p, &-v);
            low = low.max(s.dot(&v) / v.norm());
            if v.norm() - low < 0.02 || low > 5.0 {
                break;
            }
            let way = s - v;
            v += way * (-v.dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
        }
        [low, v.norm()]
    }
}
