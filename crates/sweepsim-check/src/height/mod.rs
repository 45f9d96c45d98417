//! Why nothing that hangs together with a solid stands higher above it than `d`.
//!
//! Let `Σ` be all points at the distance `d` from the solid, on the outside. If none of them is left of the stock, what
//! is farther does not hang together with the solid: a way there would cross `Σ`. [Patches](patch) have all of
//! `Σ`. A tree divides each of them, and gives for each part a reason:
//!
//! - **Flat**: it need not be looked at.
//! - **Outside**: nothing of its hull is in the stock. The stock is in convex regions; of each, the hull of the
//!   points is beyond a plane, or cut off at its first planes until nothing is left.
//! - **Removed**: of what is left so, all points are in one convex part of a tool at one time; or each at some time
//!   of a straight stretch, along which a convex solid sweeps a convex one. So their hull was removed.
//! - **Near**: all points are nearer to one triangle than `d`. That is convex, too: so it is not in `Σ`.
//! - **Inside**: the ball around the middle that has all points meets no triangle, and the middle is in the solid.
//!
//! All this holds by a [margin](crate::Scene::margin), which is larger than roundings, what is flat, and what motions
//! deviate by.

mod patch;

pub(crate) use patch::{Patch, patches};

use crate::motion::{Placement, Stretch};
use crate::scene::Scene;
use crate::surface::{Surface, nearest_of};
use crate::tool::{Body, Cutting};
use crate::tree::{Checked, Place, Proof, Reader, Step};
use crate::vector::{V3, add, cross, dot, norm, norm_up, scaled, sub};
use crate::zone::Ring;

/// All that is needed of a question about a height.
pub(crate) struct Left<'a> {
    pub scene: &'a Scene,
    pub surface: &'a Surface,
    /// The solids of each mover, and the motions that it certainly makes: numbers of the path's.
    pub movers: Vec<Cutting<'a>>,
    pub distance: f64,
}

/// Regions are cut at so many of their planes, while there are no more points.
const CUT: usize = 6;
const MOST_POINTS: usize = 48;
/// Steps of a search for a time.
const STEPS: usize = 40;

impl Proof for &Left<'_> {
    type Part = Patch;

    fn node(&mut self, patch: &Patch, kind: u8, reader: &mut Reader, found: &mut Checked) -> Step<Patch> {
        found.bound = self.distance;
        Some(match kind {
            // Of corners, then of normals: 0 and 1, 0 and 2, 1 and 2.
            10..16 => {
                let pair = [[0, 1], [0, 2], [1, 2]][usize::from(kind - 10) % 3];
                let part = reader.float_if(kind < 13)?;
                Ok(patch.halves(part, pair)?.to_vec())
            }
            16 => Ok(patch.all_around()),
            17 => Ok(patch.threes_with_first()?),
            _ if self.holds(patch, kind, reader)? => Ok(Vec::new()),
            _ => Err("something may be left there"),
        })
    }

    fn place(&self, patch: &Patch) -> Place {
        (None, around(&patch.corners))
    }
}

impl Left<'_> {
    /// Whether a reason holds. `None` if there is no such.
    fn holds(&self, patch: &Patch, kind: u8, reader: &mut Reader) -> Option<bool> {
        if kind == 0 {
            return Some(patch.is_flat);
        }
        let (points, middle) = patch.points(self.distance).unwrap_or_default();
        let is_known = !points.is_empty();
        let within = self.within(&points);
        let holds = match kind {
            1 => within.is_empty(),
            2 => {
                let triangle = self.surface.triangles.get(reader.number()?)?;
                let near = |p: &V3| norm_up(&sub(p, &nearest_of(triangle, p))) < self.distance - self.scene.margin;
                points.iter().all(near)
            }
            3 => {
                let (mover, solid, motion) = (reader.number()?, reader.number()?, reader.number()?);
                let (bodies, path, certain) = self.movers.get(mover)?;
                let (body, motion) = (bodies.get(solid)?, *certain.get(motion)?);
                let stretch = Stretch::new(&self.scene.paths[*path][motion])?;
                let time = reader.float_if(!stretch.is_straight())?;
                { within.iter() }.all(|p| removes(body, &stretch, (time, 1.0), &Ring::point(*p), self.scene.margin))
            }
            4 => {
                let far = points.iter().map(|p| norm_up(&sub(p, &middle))).fold(0.0, f64::max);
                far + self.scene.margin < self.surface.nearest(&middle).0
                    && self.surface.is_outside(&middle) == Some(false)
            }
            _ => return None,
        };
        Some(holds && is_known)
    }

    /// Points whose hull has all of the stock that is in the hull of some.
    fn within(&self, points: &[V3]) -> Vec<V3> {
        within(self.scene, points, self.scene.margin)
    }
}

/// The same, of the stock and all that is nearer to it than `margin`: planes are so much farther out.
pub(crate) fn within(scene: &Scene, points: &[V3], margin: f64) -> Vec<V3> {
    let mut all = Vec::new();
    for region in &scene.stock {
        if region
            .iter()
            .any(|(n, c)| points.iter().all(|p| dot(n, p) > c + margin))
        {
            continue;
        }
        let cut = |points: Vec<V3>, (n, c): &(V3, f64)| match points.len() {
            ..=MOST_POINTS => below(points, |p| dot(n, p) - (c + margin)),
            _ => points,
        };
        all.extend(region.iter().take(CUT).fold(points.to_vec(), cut));
    }
    all
}

/// Whether a solid holds a ring by a margin: at a time, or without one at some time up to the `latest` of a straight
/// stretch.
pub(crate) fn removes(
    body: &Body,
    stretch: &Stretch,
    (time, latest): (Option<f64>, f64),
    ring: &Ring,
    margin: f64,
) -> bool {
    let of = |t: f64| off(body, &stretch.at(t), ring, margin);
    if let Some(time) = time {
        return (0.0..=latest).contains(&time) && of(time) <= 0.0;
    }
    // The time at which it is nearest to the axis; if the solid also rises, the best one is near.
    let [from, to] = &stretch.ends;
    let way = sub(&to.tip, &from.tip);
    let across = sub(&way, &scaled(&from.axis, dot(&way, &from.axis)));
    let near = dot(&sub(&ring.centre, &from.tip), &across) / dot(&across, &across).max(f64::MIN_POSITIVE);
    if [near.clamp(0.0, latest), 0.0, latest].iter().any(|t| of(*t) <= 0.0) {
        return true;
    }
    let (mut low, mut high) = (0.0, latest);
    for _ in 0..STEPS {
        let third = (high - low) / 3.0;
        let (a, b) = (of(low + third), of(high - third));
        if a.min(b) <= 0.0 {
            return true;
        }
        if a < b { high -= third } else { low += third }
    }
    false
}

/// How far a ring is outside of a solid, at most: not more than 0 if it is inside by a margin.
///
/// Its points are no farther from the axis of the solid than its centre and its radius, at heights around that of the
/// centre. How far a point is outside is convex, and does not fall away from the axis.
pub(crate) fn off(body: &Body, at: &Placement, ring: &Ring, margin: f64) -> f64 {
    let from = sub(&ring.centre, &at.tip);
    let along = dot(&from, &at.axis);
    let across = norm(&sub(&from, &scaled(&at.axis, along))) + ring.radius;
    let rise = ring.radius * norm(&cross(&ring.axis, &at.axis));
    let margin = margin + ring.thick + at.tip_error + 4.0 * at.axis_error * (norm(&from) + ring.radius);
    let level = |height: f64| body.level([across, height]).unwrap_or(f64::INFINITY);
    level(along - rise).max(level(along + rise)) + margin
}

/// Points whose hull is what of the hull of some points is below a plane. `above`: how far one is above it.
fn below(points: Vec<V3>, above: impl Fn(&V3) -> f64) -> Vec<V3> {
    let (low, high): (Vec<V3>, Vec<V3>) = points.into_iter().partition(|p| above(p) <= 0.0);
    let mut kept = low.clone();
    for a in &low {
        kept.extend(
            high.iter()
                .map(|b| add(a, &scaled(&sub(b, a), -above(a) / (above(b) - above(a))))),
        );
    }
    kept
}

pub(crate) fn around(points: &[V3]) -> [V3; 2] {
    let of = |pick: fn(f64, f64) -> f64| [0, 1, 2].map(|k| points.iter().map(|p| p[k]).reduce(pick).unwrap_or(0.0));
    [of(f64::min), of(f64::max)]
}
