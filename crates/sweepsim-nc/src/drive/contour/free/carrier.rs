//! Lines and circles with a sense, on which the elements of a free contour lie.

use std::f64::consts::TAU;

pub(crate) type Flat = [f64; 2];

/// Numbers of programs are rounded to 0.001 mm: points, directions and tangents that agree within some of these
/// roundings are the same.
pub(super) const SAME: f64 = 2e-3;
/// Nothing is shorter.
const SHORTEST: f64 = 1e-6;

/// A straight line or a circle with the sense in which it is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Carrier {
    /// `way` is a unit vector.
    Line { at: Flat, way: Flat },
    /// The radius is positive counter-clockwise.
    Circle { centre: Flat, radius: f64 },
}

pub(super) fn minus([a, b]: Flat, [c, d]: Flat) -> Flat {
    [a - c, b - d]
}

/// `point + size · way`.
pub(super) fn along([a, b]: Flat, size: f64, [c, d]: Flat) -> Flat {
    [a + size * c, b + size * d]
}

pub(super) fn dot([a, b]: Flat, [c, d]: Flat) -> f64 {
    a * c + b * d
}

/// A quarter turn to the left.
pub(super) fn left([x, y]: Flat) -> Flat {
    [-y, x]
}

pub(super) fn distance(a: Flat, b: Flat) -> f64 {
    let [x, y] = minus(a, b);
    x.hypot(y)
}

pub(crate) fn unit(v: Flat) -> Option<Flat> {
    let size = v[0].hypot(v[1]);
    (size > SHORTEST).then(|| v.map(|c| c / size))
}

pub(super) fn heading(angle: f64) -> Flat {
    [angle.cos(), angle.sin()]
}

impl Carrier {
    /// The way in which it is followed at one of its points.
    pub fn direction(&self, point: Flat) -> Flat {
        match *self {
            Self::Line { way, .. } => way,
            Self::Circle { centre, radius } => {
                let out = unit(minus(point, centre)).unwrap_or([1.0, 0.0]);
                left(out).map(|c| c * radius.signum())
            }
        }
    }

    /// How far a point is from it.
    pub fn off(&self, point: Flat) -> f64 {
        match *self {
            Self::Line { at, way } => dot(left(way), minus(point, at)).abs(),
            Self::Circle { centre, radius } => (distance(point, centre) - radius.abs()).abs(),
        }
    }

    /// The angle of an arc between two of its points; a full turn if they are the same.
    pub fn sweep(centre: Flat, radius: f64, from: Flat, to: Flat) -> f64 {
        let angle = |point: Flat| (point[1] - centre[1]).atan2(point[0] - centre[0]);
        let turn = (radius.signum() * (angle(to) - angle(from))).rem_euclid(TAU);
        if turn * radius.abs() < SHORTEST || (TAU - turn) * radius.abs() < SHORTEST {
            TAU
        } else {
            turn
        }
    }

    /// How long it is between two of its points; not above 0 if the second is not ahead.
    pub fn length(&self, from: Flat, to: Flat) -> f64 {
        match *self {
            Self::Line { way, .. } => dot(way, minus(to, from)),
            Self::Circle { centre, radius } => radius.abs() * Self::sweep(centre, radius, from, to),
        }
    }

    pub fn is_ahead(&self, from: Flat, to: Flat) -> bool {
        self.length(from, to) > SHORTEST
    }

    /// The points that two have in common, at most two.
    pub fn meets(&self, other: &Self) -> Vec<Flat> {
        match (*self, *other) {
            (Self::Line { at, way }, Self::Line { at: to, way: other }) => {
                let cross = dot(left(way), other);
                if cross.abs() < 1e-9 {
                    return Vec::new();
                }
                vec![along(to, -dot(left(way), minus(to, at)) / cross, other)]
            }
            (Self::Line { at, way }, Self::Circle { centre, radius })
            | (Self::Circle { centre, radius }, Self::Line { at, way }) => {
                let foot = along(at, dot(way, minus(centre, at)), way);
                chord(foot, distance(foot, centre), radius, way)
            }
            (
                Self::Circle { centre, radius },
                Self::Circle {
                    centre: other,
                    radius: wide,
                },
            ) => {
                let apart = distance(centre, other);
                let Some(way) = unit(minus(other, centre)) else {
                    return Vec::new();
                };
                let ahead = (apart * apart + radius * radius - wide * wide) / (2.0 * apart);
                chord(along(centre, ahead, way), ahead, radius, left(way))
            }
        }
    }

    /// Where two touch and go on in the same direction.
    pub fn touches(&self, other: &Self) -> Option<Flat> {
        match (*self, *other) {
            (Self::Line { .. }, Self::Line { .. }) => None,
            (Self::Line { at, way }, Self::Circle { centre, radius })
            | (Self::Circle { centre, radius }, Self::Line { at, way }) => {
                let aside = dot(left(way), minus(centre, at));
                ((aside - radius).abs() < SAME).then(|| along(centre, -aside, left(way)))
            }
            (
                Self::Circle { centre, radius },
                Self::Circle {
                    centre: other,
                    radius: wide,
                },
            ) => {
                let apart = distance(centre, other);
                let normal = unit(minus(centre, other))?.map(|c| c * (radius - wide).signum());
                ((apart - (radius - wide).abs()).abs() < SAME).then(|| along(centre, -radius, normal))
            }
        }
    }

    /// Where the centres of circles of a radius are that touch it and go on from it, or go over to it, in the same
    /// direction.
    pub fn centres(&self, radius: f64) -> Self {
        match *self {
            Self::Line { at, way } => Self::Line {
                at: along(at, radius, left(way)),
                way,
            },
            Self::Circle { centre, radius: own } => Self::Circle {
                centre,
                radius: (own - radius).abs(),
            },
        }
    }
}

/// The ends of a chord through a point of it, so far from the centre of its circle; one where it touches.
fn chord(foot: Flat, off: f64, radius: f64, way: Flat) -> Vec<Flat> {
    let square = radius * radius - off * off;
    if off.abs() > radius.abs() + SAME {
        return Vec::new();
    }
    let half = square.max(0.0).sqrt();
    if (off.abs() - radius.abs()).abs() < SHORTEST || half < SHORTEST {
        return vec![foot];
    }
    vec![along(foot, -half, way), along(foot, half, way)]
}

/// A point beside which a line passes, to the right of it by so much: 0 for a point of the line, the signed radius for
/// a circle that it touches.
#[derive(Clone, Copy, Debug)]
pub(super) struct Support(pub Flat, pub f64);

impl Support {
    /// What a tangent of a carrier passes; nothing for lines.
    pub fn of(carrier: &Carrier) -> Option<Self> {
        match *carrier {
            Carrier::Line { .. } => None,
            Carrier::Circle { centre, radius } => Some(Self(centre, radius)),
        }
    }

    /// The line of a direction.
    pub fn line(self, way: Flat) -> Carrier {
        Carrier::Line {
            at: along(self.0, -self.1, left(way)),
            way,
        }
    }

    /// The lines beside two, either way around.
    pub fn lines(self, other: Self) -> Vec<Carrier> {
        let apart = distance(self.0, other.0);
        let Some(way) = unit(minus(other.0, self.0)) else {
            return Vec::new();
        };
        // n · (q − p) = t − s for the normal n to the left.
        let sin = (other.1 - self.1) / apart;
        if sin.abs() > 1.0 + SAME / apart {
            return Vec::new();
        }
        let sin = sin.clamp(-1.0, 1.0);
        let cos = (1.0 - sin * sin).sqrt();
        let all = [cos, -cos].map(|cos| {
            // The direction d with d · way = cos and left(d) · way = sin.
            let d = along(way.map(|c| c * cos), -sin, left(way));
            self.line(d)
        });
        all.to_vec()
    }
}
