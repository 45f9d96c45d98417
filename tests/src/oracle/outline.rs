//! A profile as a figure of the `(ρ, ζ)` half-plane: what is inside, and how far the boundary is.
//!
//! A solid of revolution and a point: the nearest point of the boundary lies in the point's own half-plane through the
//! axis, so distances in space are distances in the plane.

use nalgebra::Vector2;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use sweepsim_motion::{Profile, ProfileSegment, Turn};

/// A piece of an outline along which `ζ` is monotone.
#[derive(Clone, Debug)]
pub(crate) enum Piece {
    Line {
        from: Vector2<f64>,
        to: Vector2<f64>,
    },
    /// Counter-clockwise from `from` to `to`, at most half a turn, on the right or left half of its circle.
    Arc {
        centre: Vector2<f64>,
        radius: f64,
        from: Vector2<f64>,
        to: Vector2<f64>,
        right: bool,
    },
}

/// An outline, ready for questions.
#[derive(Clone, Debug)]
pub struct Outline {
    pieces: Vec<Piece>,
    zeta: [f64; 2],
    rho: f64,
}

impl Outline {
    /// The outline of a profile.
    #[must_use]
    pub fn new(profile: &Profile) -> Self {
        let mut pieces = Vec::new();
        let mut from = Vector2::from(profile.start());
        for segment in profile.segments() {
            match segment {
                ProfileSegment::Line { to } => {
                    let to = Vector2::from(*to);
                    pieces.push(Piece::Line { from, to });
                    from = to;
                }
                &ProfileSegment::Arc { to, centre, turn } => {
                    let to = Vector2::from(to);
                    match turn {
                        Turn::Ccw => split_arc(centre.into(), from, to, &mut pieces),
                        Turn::Cw => split_arc(centre.into(), to, from, &mut pieces),
                    }
                    from = to;
                }
                ProfileSegment::Spline {
                    degree,
                    knots,
                    points,
                    weights,
                } => {
                    let at = curve(*degree, knots.as_deref(), points, weights.as_deref());
                    for k in 1..=CHORDS {
                        let to = at(k as f64 / CHORDS as f64);
                        pieces.push(Piece::Line { from, to });
                        from = to;
                    }
                }
                other => unreachable!("the oracle knows no {other:?}"),
            }
        }
        let mut outline = Self {
            pieces,
            zeta: [f64::INFINITY, f64::NEG_INFINITY],
            rho: 0.0,
        };
        for piece in &outline.pieces {
            let [[rho_from, zeta_from], [rho_to, zeta_to]] = piece.ends();
            outline.zeta[0] = outline.zeta[0].min(zeta_from).min(zeta_to);
            outline.zeta[1] = outline.zeta[1].max(zeta_from).max(zeta_to);
            outline.rho = outline.rho.max(rho_from).max(rho_to);
            if let Piece::Arc {
                centre,
                radius,
                right: true,
                ..
            } = piece
                && piece.spans(centre.y)
            {
                outline.rho = outline.rho.max(centre.x + radius);
            }
        }
        outline
    }

    /// The largest radius.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.rho
    }

    /// The lowest and the highest `ζ`.
    #[must_use]
    pub fn heights(&self) -> [f64; 2] {
        self.zeta
    }

    pub(crate) fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// Whether `(ρ, ζ)` is inside: a ray in the direction of `+ρ` leaves an odd number of times.
    #[must_use]
    pub fn contains(&self, rho: f64, zeta: f64) -> bool {
        self.pieces
            .iter()
            .filter(|piece| piece.spans(zeta) && piece.rho_at(zeta) > rho)
            .count()
            % 2
            == 1
    }

    /// Distance of `(ρ, ζ)` from the outline (the axis is none of it); negative inside.
    #[must_use]
    pub fn signed_distance(&self, rho: f64, zeta: f64) -> f64 {
        let p = Vector2::new(rho, zeta);
        let distance = self
            .pieces
            .iter()
            .map(|piece| piece.distance(p))
            .fold(f64::INFINITY, f64::min);
        if self.contains(rho, zeta) { -distance } else { distance }
    }
}

/// The number of chords for a spline: for a curve of length `L` and curvature at most `κ` run through evenly, they are
/// within `κ (L/4096)²/8`.
const CHORDS: usize = 4096;

/// The point of a spline at a part of its domain, by de Boor's algorithm.
fn curve<'a>(
    degree: usize,
    knots: Option<&[f64]>,
    points: &'a [[f64; 2]],
    weights: Option<&'a [f64]>,
) -> impl Fn(f64) -> Vector2<f64> + 'a {
    let count = points.len();
    let even = |i: usize| i.clamp(degree, count) as f64;
    let knots = knots.map_or_else(|| (0..=count + degree).map(even).collect(), <[f64]>::to_vec);
    move |part| {
        let x = knots[degree] + (knots[count] - knots[degree]) * part;
        let span = (degree..count)
            .rfind(|k| knots[*k] <= x && knots[*k] < knots[k + 1])
            .unwrap_or(degree);
        let mut row: Vec<(Vector2<f64>, f64)> = (span - degree..=span)
            .map(|i| (weights.map_or(1.0, |w| w[i]), i))
            .map(|(w, i)| (Vector2::from(points[i]) * w, w))
            .collect();
        for level in 1..=degree {
            for j in (level..=degree).rev() {
                let i = span - degree + j;
                let s = (x - knots[i]) / (knots[i + degree + 1 - level] - knots[i]);
                row[j] = (
                    row[j - 1].0 * (1.0 - s) + row[j].0 * s,
                    row[j - 1].1 * (1.0 - s) + row[j].1 * s,
                );
            }
        }
        row[degree].0 / row[degree].1
    }
}

/// Cuts a counter-clockwise arc where it is highest and lowest.
fn split_arc(centre: Vector2<f64>, from: Vector2<f64>, to: Vector2<f64>, pieces: &mut Vec<Piece>) {
    let (a, b) = (from - centre, to - centre);
    let radius = 0.5 * (a.norm() + b.norm());
    let start = a.y.atan2(a.x);
    let mut sweep = b.y.atan2(b.x) - start;
    if sweep <= 0.0 {
        sweep += TAU;
    }
    // The tops and bottoms strictly inside; those within rounding of an end need no separate piece.
    let first = ((start - FRAC_PI_2) / PI).floor() as i32;
    let mut at = from;
    let mut angle = start;
    let mut push = |at: Vector2<f64>, next: Vector2<f64>, from: f64, to: f64| {
        pieces.push(Piece::Arc {
            centre,
            radius,
            from: at,
            to: next,
            right: (0.5 * (from + to)).cos() > 0.0,
        });
    };
    for extreme in first..first + 4 {
        let cut = FRAC_PI_2 + PI * f64::from(extreme);
        if cut > start + 1e-12 && cut < start + sweep - 1e-12 {
            let next = centre + Vector2::new(0.0, radius.copysign(cut.sin()));
            push(at, next, angle, cut);
            (at, angle) = (next, cut);
        }
    }
    push(at, to, angle, start + sweep);
}

impl Piece {
    pub(crate) fn ends(&self) -> [[f64; 2]; 2] {
        let (Self::Line { from, to } | Self::Arc { from, to, .. }) = self;
        [[from.x, from.y], [to.x, to.y]]
    }

    /// Whether the level `ζ` meets the piece: half-open, so that a level through a joint counts it once.
    fn spans(&self, zeta: f64) -> bool {
        let [[_, a], [_, b]] = self.ends();
        a.min(b) <= zeta && zeta < a.max(b)
    }

    fn rho_at(&self, zeta: f64) -> f64 {
        match *self {
            Self::Line { from, to } => from.x + (to.x - from.x) * ((zeta - from.y) / (to.y - from.y)),
            Self::Arc {
                centre, radius, right, ..
            } => {
                let up = zeta - centre.y;
                let half = (radius * radius - up * up).max(0.0).sqrt();
                if right { centre.x + half } else { centre.x - half }
            }
        }
    }

    fn distance(&self, p: Vector2<f64>) -> f64 {
        match *self {
            Self::Line { from, to } => {
                let d = to - from;
                let s = ((p - from).dot(&d) / d.norm_squared()).clamp(0.0, 1.0);
                (p - (from + d * s)).norm()
            }
            Self::Arc {
                centre,
                radius,
                from,
                to,
                ..
            } => {
                let q = p - centre;
                // At most half a turn: in its sector means left of one end and right of the other.
                if (from - centre).perp(&q) >= 0.0 && q.perp(&(to - centre)) >= 0.0 {
                    (q.norm() - radius).abs()
                } else {
                    (p - from).norm().min((p - to).norm())
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_motion::Tool;

    #[test]
    fn a_bull_nose_has_the_distances_of_its_parts() {
        let outline = Outline::new(
            Tool::bull(5.0, 2.0, 20.0)
                .unwrap()
                .profile()
                .expect("a solid of revolution"),
        );
        assert_eq!((outline.radius(), outline.heights()), (5.0, [0.0, 20.0]));
        let diagonal = 0.5_f64.sqrt();
        for (rho, zeta, expected) in [
            (0.0, 10.0, -5.0),
            (0.0, -1.5, 1.5),
            (7.0, 12.0, 2.0),
            (2.9, 0.5, -0.5),
            (3.0 + 3.0 * diagonal, 2.0 - 3.0 * diagonal, 1.0),
            (3.0 + 1.5 * diagonal, 2.0 - 1.5 * diagonal, -0.5),
            (8.0, 24.0, 5.0),
        ] {
            let found = outline.signed_distance(rho, zeta);
            assert!(
                (found - expected).abs() < 1e-14,
                "({rho}, {zeta}): {found} for {expected}"
            );
        }
    }

    #[test]
    fn a_concave_arc_hollows_the_tool() {
        let outline = crate::tools::concave()
            .profile()
            .expect("a solid of revolution")
            .clone();
        let outline = Outline::new(&outline);
        // The circle about (8, 2) with radius 6 is air; what lies above it is tool.
        assert!((outline.signed_distance(8.0 - 5.0, 2.0) - 1.0).abs() < 1e-14);
        assert!((outline.signed_distance(5.0, 2.0 + 5.0) - (6.0 - 34.0_f64.sqrt())).abs() < 1e-14);
        let beyond = 6.5 * 0.5_f64.sqrt();
        assert!((outline.signed_distance(8.0 - beyond, 2.0 + beyond) + 0.5).abs() < 1e-14);
    }

    #[test]
    fn an_arc_of_more_than_half_a_turn_is_cut_at_top_and_bottom() {
        let outline = Outline::new(
            crate::tools::lollipop(3.0, 1.0, 20.0)
                .profile()
                .expect("a solid of revolution"),
        );
        assert_eq!(outline.radius(), 3.0);
        assert!(outline.contains(2.99, 3.0) && !outline.contains(3.01, 3.0) && outline.contains(0.5, 6.5));
        assert!((outline.signed_distance(4.0, 3.0) - 1.0).abs() < 1e-14);
        assert!((outline.signed_distance(0.0, 3.0) + 3.0).abs() < 1e-14);
    }

    #[test]
    fn a_level_through_a_joint_counts_it_once() {
        for tool in [Tool::ball(2.0, 9.0), Tool::flat(2.0, 9.0), Tool::bull(3.0, 1.0, 9.0)] {
            let outline = Outline::new(tool.unwrap().profile().expect("a solid of revolution"));
            for piece in outline.pieces() {
                for [rho, zeta] in piece.ends() {
                    assert!(
                        rho == 0.0 || outline.contains(0.5 * rho, zeta) == (zeta < 9.0),
                        "({rho}, {zeta})"
                    );
                }
            }
        }
    }
}
