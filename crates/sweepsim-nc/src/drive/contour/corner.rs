//! Corners of compensated contours: where two offset curves meet.

/// A point or a direction in a plane.
pub(crate) type Flat = [f64; 2];

pub(crate) fn minus(a: Flat, b: Flat) -> Flat {
    [a[0] - b[0], a[1] - b[1]]
}

pub(crate) fn plus(a: Flat, s: f64, b: Flat) -> Flat {
    [a[0] + s * b[0], a[1] + s * b[1]]
}

pub(crate) fn dot(a: Flat, b: Flat) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(crate) fn cross(a: Flat, b: Flat) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

pub(crate) fn length(a: Flat) -> f64 {
    a[0].hypot(a[1])
}

/// The curve that an offset move lies on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Curve {
    /// Through a point, along a unit direction.
    Line { point: Flat, direction: Flat },
    Circle {
        centre: Flat,
        radius: f64,
        counter_clockwise: bool,
    },
}

impl Curve {
    /// How far behind `end` a point of the curve is: what is taken away where the curve ends there instead. Negative on a line if the point
    /// is ahead; on a circle between 0 and a full turn.
    fn behind(&self, end: Flat, point: Flat) -> f64 {
        match *self {
            Self::Line { direction, .. } => dot(minus(end, point), direction),
            Self::Circle {
                centre,
                radius,
                counter_clockwise,
            } => {
                let (a, b) = (minus(point, centre), minus(end, centre));
                let angle = cross(a, b).atan2(dot(a, b));
                let angle = if counter_clockwise { angle } else { -angle };
                radius * angle
            }
        }
    }
}

/// The points where two curves meet.
pub(crate) fn meetings(a: &Curve, b: &Curve) -> Vec<Flat> {
    match (*a, *b) {
        (
            Curve::Line { point, direction },
            Curve::Line {
                point: other,
                direction: along,
            },
        ) => {
            let sine = cross(direction, along);
            if sine.abs() < 1e-12 {
                return Vec::new();
            }
            let s = cross(minus(other, point), along) / sine;
            vec![plus(point, s, direction)]
        }
        (Curve::Line { point, direction }, Curve::Circle { centre, radius, .. })
        | (Curve::Circle { centre, radius, .. }, Curve::Line { point, direction }) => {
            let foot = plus(point, dot(minus(centre, point), direction), direction);
            let distance = length(minus(foot, centre));
            let square = radius * radius - distance * distance;
            if square < 0.0 {
                return Vec::new();
            }
            let half = square.sqrt();
            vec![plus(foot, half, direction), plus(foot, -half, direction)]
        }
        (
            Curve::Circle { centre, radius, .. },
            Curve::Circle {
                centre: other,
                radius: second,
                ..
            },
        ) => {
            let between = minus(other, centre);
            let distance = length(between);
            if distance == 0.0 {
                return Vec::new();
            }
            let along = (distance * distance + radius * radius - second * second) / (2.0 * distance);
            let square = radius * radius - along * along;
            if square < 0.0 {
                return Vec::new();
            }
            let unit = [between[0] / distance, between[1] / distance];
            let foot = plus(centre, along, unit);
            let half = square.sqrt();
            vec![
                plus(foot, half, [-unit[1], unit[0]]),
                plus(foot, -half, [-unit[1], unit[0]]),
            ]
        }
    }
}

/// The end of a line at an angle (in radians) of which one coordinate is given, the first or the second; `None` if the
/// line never has it.
pub(crate) fn end_at_angle(start: Flat, [x, y]: Flat, first_is_given: bool, angle: f64) -> Option<Flat> {
    let (sin, cos) = angle.sin_cos();
    let (goes, way) = match first_is_given {
        true => (cos, x - start[0]),
        false => (sin, y - start[1]),
    };
    (goes.abs() > 1e-9).then(|| plus(start, way / goes, [cos, sin]))
}

/// The direction of an arc about `centre` at `at`.
pub(crate) fn arc_tangent(at: Flat, centre: Flat, counter_clockwise: bool) -> Flat {
    let [x, y] = minus(at, centre);
    let r = length([x, y]);
    if counter_clockwise {
        [-y / r, x / r]
    } else {
        [y / r, -x / r]
    }
}

/// Where the tool leaves the first curve for the second one, at an inside corner near `corner`. `end` is where the first one would end,
/// `start` where the second one would start. `None` if they do not meet so that both become shorter.
pub(crate) fn inside_corner(first: &Curve, end: Flat, second: &Curve, start: Flat, corner: Flat) -> Option<Flat> {
    let slack = 1e-9;
    let near = |point: &Flat| length(minus(*point, corner));
    let points = meetings(first, second);
    let shortens = |point: &Flat| first.behind(end, *point) >= -slack && second.behind(start, *point) <= slack;
    points
        .into_iter()
        .filter(shortens)
        .min_by(|a, b| near(a).total_cmp(&near(b)))
}

/// Of the points where two curves meet, the one nearest to `corner`.
pub(crate) fn nearest_meeting(first: &Curve, second: &Curve, corner: Flat) -> Option<Flat> {
    let near = |point: &Flat| length(minus(*point, corner));
    meetings(first, second)
        .into_iter()
        .min_by(|a, b| near(a).total_cmp(&near(b)))
}

/// Where the tool leaves the first curve for the second one, at an outside corner near `corner`, if both are extended.
pub(crate) fn outside_corner(first: &Curve, end: Flat, second: &Curve, start: Flat, corner: Flat) -> Option<Flat> {
    let slack = 1e-9;
    let near = |point: &Flat| length(minus(*point, corner));
    meetings(first, second)
        .into_iter()
        .filter(|point| first.behind(end, *point) <= slack && second.behind(start, *point) >= -slack)
        .min_by(|a, b| near(a).total_cmp(&near(b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_meet_where_both_are() {
        let line = Curve::Line {
            point: [0.0, 1.0],
            direction: [1.0, 0.0],
        };
        let circle = |centre, radius| Curve::Circle {
            centre,
            radius,
            counter_clockwise: true,
        };
        for (a, b) in [
            (line, circle([3.0, 0.0], 2.0)),
            (circle([3.0, 0.0], 2.0), circle([5.0, 1.0], 1.5)),
        ] {
            for point in meetings(&a, &b) {
                for curve in [a, b] {
                    let off = match curve {
                        Curve::Line { point: on, direction } => cross(minus(point, on), direction),
                        Curve::Circle { centre, radius, .. } => length(minus(point, centre)) - radius,
                    };
                    assert!(off.abs() < 1e-12);
                }
            }
        }
        assert!(meetings(&line, &circle([0.0, 9.0], 1.0)).is_empty());
        assert!(meetings(&line, &line).is_empty());
        assert!(meetings(&circle([0.0, 0.0], 1.0), &circle([0.1, 0.0], 5.0)).is_empty());
    }
}
