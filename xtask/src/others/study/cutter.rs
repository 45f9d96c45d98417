//! A tool as the samplers see it: a solid of revolution, placed and intersected with a vertical line in closed form.
//! Independent of the engine.

use nalgebra::Vector3;
use sweepsim_dexel::{DistanceTo, TriangleSoup};
use sweepsim_motion::{MeridianShape, Tool};

/// Chords of the profile of a tool that is neither a ball end nor a flat end.
const CHORDS: usize = 64;
/// Each patch of such a tool becomes this many squares in each direction, of two triangles each, for distances.
const SIDES: usize = 60;

/// A tool.
pub struct Cutter {
    shape: Shape,
    pub radius: f64,
    pub length: f64,
}

enum Shape {
    /// A hemisphere below a cylinder.
    Ball,
    Flat,
    /// Frusta between `(ρ, ζ)` for lines, triangles for distances.
    Form(Vec<[f64; 2]>, Box<DistanceTo>),
}

/// Where a tool is: its tip, and its axis as a unit vector; and the orientation, for tools that are not quite of
/// revolution.
#[derive(Clone, Copy)]
pub struct Place {
    pub tip: Vector3<f64>,
    pub axis: Vector3<f64>,
    pub turn: nalgebra::Matrix3<f64>,
}

impl Place {
    pub fn point(&self, height: f64) -> Vector3<f64> {
        self.tip + self.axis * height
    }
}

impl Cutter {
    /// The same shape as a tool of the engine.
    ///
    /// # Errors
    /// The tool is neither a ball end, nor a flat end, nor a closed free-form surface about the axis.
    pub fn of(tool: &Tool) -> Result<Self, String> {
        let bound = tool.bounding_cylinder();
        let curves = tool.meridians();
        let arcs = curves
            .iter()
            .filter(|c| matches!(c.shape, MeridianShape::Arc { .. }))
            .count();
        let (shape, radius) = match (curves.len(), arcs) {
            (0, _) => form(tool)?,
            (3, 0) => (Shape::Flat, bound.radius),
            (3, 1) if curves[0].to[0] == curves[0].to[1] => (Shape::Ball, bound.radius),
            _ => return Err("only ball ends, flat ends and free-form tools are sampled".into()),
        };
        let length = bound.z[1];
        Ok(Self { shape, radius, length })
    }

    pub fn is_ball(&self) -> bool {
        matches!(self.shape, Shape::Ball)
    }

    /// The rectangle over a placed tool.
    pub fn bounds(&self, place: &Place) -> [[f64; 2]; 2] {
        let (lowest, top) = (
            place.point(if self.is_ball() { self.radius } else { 0.0 }),
            place.point(self.length),
        );
        [0, 1].map(|k| {
            // Of a disc across the axis.
            let disc = self.radius * (1.0 - place.axis[k] * place.axis[k]).max(0.0).sqrt();
            let end = if self.is_ball() { self.radius } else { disc };
            [
                (lowest[k] - end).min(top[k] - disc),
                (lowest[k] + end).max(top[k] + disc),
            ]
        })
    }

    /// The intervals in which the vertical line through `(x, y)` lies inside the placed tool.
    pub fn cut(&self, place: &Place, [x, y]: [f64; 2], mut cut: impl FnMut(f64, f64)) {
        let line = AxisLine::new(place, [x, y]);
        match &self.shape {
            Shape::Flat => {
                if let Some([low, high]) = line.cylinder(self.radius, [0.0, self.length]) {
                    cut(low, high);
                }
            }
            Shape::Ball => {
                let barrel = line.cylinder(self.radius, [self.radius, self.length]);
                let end = ball(place.point(self.radius), self.radius, [x, y]);
                if let Some([low, high]) = joined(barrel, end) {
                    cut(low, high);
                }
            }
            Shape::Form(profile, _) => {
                for ends in profile.windows(2) {
                    line.frustum(ends[0], ends[1], &mut cut);
                }
            }
        }
    }

    /// The signed distance of a point from the placed tool, negative inside.
    pub fn distance(&self, place: &Place, p: &Vector3<f64>) -> f64 {
        let from = p - place.tip;
        let height = from.dot(&place.axis);
        if let Shape::Form(_, surface) = &self.shape {
            let own = place.turn.transpose() * from;
            // The triangles of neighbouring patches do not share corners, so the sign is unknown; points of the exact
            // surface are not inside.
            return surface
                .nearest(own.into())
                .map_or(f64::INFINITY, |near| near.distance.abs());
        }
        let rho = (from.norm_squared() - height * height).max(0.0).sqrt();
        if self.is_ball() && height <= self.radius {
            return rho.hypot(height - self.radius) - self.radius;
        }
        let middle = 0.5 * self.length;
        let (aside, above) = (rho - self.radius, (height - middle).abs() - middle);
        if aside > 0.0 && above > 0.0 {
            return aside.hypot(above);
        }
        aside.max(above)
    }
}

/// The interval from the lowest to the highest of two that make up a convex solid.
fn joined(a: Option<[f64; 2]>, b: Option<[f64; 2]>) -> Option<[f64; 2]> {
    match (a, b) {
        (Some(a), Some(b)) => Some([a[0].min(b[0]), a[1].max(b[1])]),
        (a, b) => a.or(b),
    }
}

/// A vertical line in a ball.
pub fn ball(centre: Vector3<f64>, radius: f64, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
    let square = radius * radius - (x - centre.x).powi(2) - (y - centre.y).powi(2);
    (square > 0.0).then(|| [centre.z - square.sqrt(), centre.z + square.sqrt()])
}

/// A vertical line beside an axis: at height `z` above the tip its distance from the axis has the square
/// `a z² + 2 b z + c`, and it is `s + z·a_z` along the axis.
pub struct AxisLine {
    tip: f64,
    up: f64,
    along: f64,
    a: f64,
    b: f64,
    c: f64,
}

impl AxisLine {
    pub fn new(place: &Place, [x, y]: [f64; 2]) -> Self {
        let (w, up) = ([x - place.tip.x, y - place.tip.y], place.axis.z);
        let along = w[0] * place.axis.x + w[1] * place.axis.y;
        Self {
            tip: place.tip.z,
            up,
            along,
            a: place.axis.x * place.axis.x + place.axis.y * place.axis.y,
            b: -along * up,
            c: w[0] * w[0] + w[1] * w[1] - along * along,
        }
    }

    /// Where `a z² + 2 b z + c ≤ 0`, for an upright parabola.
    fn inside(a: f64, b: f64, c: f64) -> Option<[f64; 2]> {
        if a < 1e-18 {
            return (c <= 0.0).then_some([f64::NEG_INFINITY, f64::INFINITY]);
        }
        let square = b * b - a * c;
        if square <= 0.0 {
            return None;
        }
        let q = -(b + square.sqrt().copysign(b));
        let (one, other) = (q / a, c / q);
        Some([one.min(other), one.max(other)])
    }

    /// Where the heights along the axis are in this range.
    fn slab(&self, [low, high]: [f64; 2]) -> Option<[f64; 2]> {
        if self.up.abs() < 1e-12 {
            return (low <= self.along && self.along <= high).then_some([f64::NEG_INFINITY, f64::INFINITY]);
        }
        let (one, other) = ((low - self.along) / self.up, (high - self.along) / self.up);
        Some([one.min(other), one.max(other)])
    }

    /// The interval in the cylinder about the axis, between two heights along it.
    pub fn cylinder(&self, radius: f64, heights: [f64; 2]) -> Option<[f64; 2]> {
        let round = Self::inside(self.a, self.b, self.c - radius * radius)?;
        let slab = self.slab(heights)?;
        let (low, high) = (round[0].max(slab[0]), round[1].min(slab[1]));
        (low < high).then_some([self.tip + low, self.tip + high])
    }

    /// The intervals in the frustum between two circles about the axis, `(ρ, ζ)`.
    fn frustum(&self, from: [f64; 2], to: [f64; 2], mut cut: impl FnMut(f64, f64)) {
        let Some(slab) = self.slab([from[1].min(to[1]), from[1].max(to[1])]) else {
            return;
        };
        let mut within = |low: f64, high: f64| {
            let (low, high) = (low.max(slab[0]), high.min(slab[1]));
            if low < high {
                cut(self.tip + low, self.tip + high);
            }
        };
        let rise = to[1] - from[1];
        if rise.abs() < 1e-12 {
            return;
        }
        // ρ = p + k z along the line.
        let slope = (to[0] - from[0]) / rise;
        let (p, k) = (from[0] + slope * (self.along - from[1]), slope * self.up);
        let (a, b, c) = (self.a - k * k, self.b - p * k, self.c - p * p);
        if a >= 0.0 {
            if let Some([low, high]) = Self::inside(a, b, c) {
                within(low, high);
            }
        } else if let Some([low, high]) = Self::inside(-a, -b, -c) {
            // Outside between the two roots: inside both nappes, of which the slab keeps one.
            within(f64::NEG_INFINITY, low);
            within(high, f64::INFINITY);
        } else {
            within(f64::NEG_INFINITY, f64::INFINITY);
        }
    }
}

/// The mean profile of a free-form tool about its axis, its triangles, and its largest radius.
fn form(tool: &Tool) -> Result<(Shape, f64), String> {
    let mut triangles = Vec::new();
    for patch in tool.patches() {
        let row = |i: usize| -> Vec<[f64; 3]> {
            let at = |j: usize| patch.point(i as f64 / SIDES as f64, j as f64 / SIDES as f64);
            (0..=SIDES).map(at).collect()
        };
        let rows: Vec<_> = (0..=SIDES).map(row).collect();
        for (below, above) in rows.iter().zip(&rows[1..]) {
            for j in 0..SIDES {
                triangles.push([below[j], above[j], above[j + 1]]);
                triangles.push([below[j], above[j + 1], below[j + 1]]);
            }
        }
    }
    // Where a side shrinks to a point.
    triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    let heights = triangles.iter().flatten().map(|p| p[2]);
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| {
        (low.min(z), high.max(z))
    });
    let level = |k: usize| low + (high - low) * (0.001 + 0.998 * k as f64 / CHORDS as f64);
    let mut sums = [[0.0; 2]; CHORDS + 1];
    for [a, b, _] in &triangles {
        for (k, sum) in sums.iter_mut().enumerate() {
            let share = (level(k) - a[2]) / (b[2] - a[2]);
            if (0.0..=1.0).contains(&share) {
                let radius = (a[0] + share * (b[0] - a[0])).hypot(a[1] + share * (b[1] - a[1]));
                *sum = [sum[0] + radius, sum[1] + 1.0];
            }
        }
    }
    let profile: Vec<[f64; 2]> = (0..=CHORDS).map(|k| [sums[k][0] / sums[k][1], level(k)]).collect();
    let radius = triangles.iter().flatten().map(|p| p[0].hypot(p[1])).fold(0.0, f64::max);
    if profile.iter().any(|[rho, _]| !rho.is_finite()) {
        return Err("the tool's surface does not enclose its axis".into());
    }
    let soup = TriangleSoup { triangles };
    let surface = DistanceTo::new(&soup).map_err(|error| error.to_string())?;
    Ok((Shape::Form(profile, Box::new(surface)), radius))
}
