//! Tools cut off at a height.

use super::Tool;
use crate::boundary::Patch;
use nalgebra::Vector3;
use sweepsim_spline::Bernstein;

/// A patch is cut along a parameter at one of this many equal parts of its range.
const PARTS: usize = 16;
/// Rounding of a height, relative to the tool's reach.
const ROUNDING: f64 = 1e-12;

/// A side of a patch: the variable that is constant there, and whether it is 1.
#[derive(Clone, Copy, PartialEq)]
struct CutSide {
    axis: usize,
    upper: bool,
}

impl CutSide {
    const ALL: [Self; 4] = [
        Self::new(0, false),
        Self::new(0, true),
        Self::new(1, false),
        Self::new(1, true),
    ];

    const fn new(axis: usize, upper: bool) -> Self {
        Self { axis, upper }
    }
}

impl Tool {
    /// A solid with the same points below a height, and fewer above it; `None` if it is not found.
    ///
    /// A profile is cut where [one straight line of it alone](crate::Profile::below) rises through that height. Of
    /// other tools, patches above it are left out, and those that pass through it are cut along a parameter somewhat
    /// higher. Straight lines from the rim of the hole to one point in the middle close it, if no line along the axis
    /// meets them twice.
    ///
    /// ```
    /// use sweepsim_motion::Tool;
    /// let long = Tool::flat(3.0, 20.0)?;
    /// let short = long.below(5.0).expect("a shorter tool");
    /// assert_eq!(short.bounding_cylinder().z, [0.0, 5.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn below(&self, height: f64) -> Option<Self> {
        match &self.profile {
            Some(profile) => profile.below(height).map(Self::from_profile),
            None => self.patches_below(height + ROUNDING * self.reach),
        }
    }

    fn patches_below(&self, height: f64) -> Option<Self> {
        let (above, others): (Vec<_>, Vec<_>) = self.patches.iter().partition(|patch| is_above(patch, height, None));
        let cuts: Vec<_> = others.iter().map(|patch| cut(patch, height)).collect();
        // The same parameter for all patches of a ring, so that they still join.
        let common = |side: CutSide| {
            let parts = cuts.iter().flatten().filter(|(own, _)| *own == side);
            parts.map(|(_, part)| *part).max()
        };
        let left_out: Vec<_> = above
            .iter()
            .flat_map(|patch| CutSide::ALL.map(|side| places(patch, side)))
            .collect();
        let (mut patches, mut rim) = (Vec::new(), Vec::new());
        for (patch, cut) in others.iter().zip(&cuts) {
            let kept = match cut {
                Some((side, _)) => kept(patch, *side, common(*side)?)?,
                None => (*patch).clone(),
            };
            for side in CutSide::ALL {
                let points = control(&kept, side);
                if points.iter().any(|(p, _)| p.z < height) {
                    continue;
                }
                let is_cut = cut.is_some_and(|(own, _)| own == side);
                if is_cut || self.joins(&places(&kept, side), &left_out) {
                    rim.push((points, side));
                }
            }
            patches.push(kept);
        }
        let points: Vec<_> = rim
            .iter()
            .flat_map(|(points, _)| points.iter().map(|(p, _)| *p))
            .collect();
        let mut apex = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
        apex.z = points.iter().map(|p| p.z).fold(f64::NEG_INFINITY, f64::max);
        let [_, top] = self.cylinder.z;
        if points.is_empty() || apex.z >= top - ROUNDING * self.reach {
            return None;
        }
        for (points, side) in rim {
            patches.push(lid(&points, side, &apex)?);
        }
        Self::from_patches(patches, self.tolerance).ok()
    }

    /// Whether a side is one of those that are left out, and no pole.
    fn joins(&self, [a, middle, b]: &[Vector3<f64>; 3], left_out: &[[Vector3<f64>; 3]]) -> bool {
        let near = |a: &Vector3<f64>, b: &Vector3<f64>| (a - b).norm() <= self.tolerance + ROUNDING * self.reach;
        let is_pole = near(a, b) && near(a, middle);
        let is_same = |[c, between, d]: &[Vector3<f64>; 3]| {
            near(middle, between) && (near(a, c) && near(b, d) || near(a, d) && near(b, c))
        };
        !is_pole && left_out.iter().any(is_same)
    }
}

/// Whether all of a patch is above a height, or its part between a parameter and a side.
fn is_above(patch: &Patch, height: f64, beyond: Option<(CutSide, f64)>) -> bool {
    let (z, weight) = (&patch.position()[2], patch.weight());
    let above = |z: &Bernstein, weight: &Bernstein| {
        let mut pairs = z.coefficients().iter().zip(weight.coefficients());
        pairs.all(|(z, w)| *z >= height * w)
    };
    let Some((side, at)) = beyond else {
        return above(z, weight);
    };
    let [lo, hi] = if side.upper { [at, 1.0] } else { [0.0, at] };
    above(&z.restrict(side.axis, lo, hi), &weight.restrict(side.axis, lo, hi))
}

/// The side from which most of a patch can be cut off, all of it above a height, and how many parts remain.
fn cut(patch: &Patch, height: f64) -> Option<(CutSide, usize)> {
    let remain = |side: CutSide| {
        let is_enough = |part: &usize| is_above(patch, height, Some((side, place(side, *part))));
        (1..PARTS).find(is_enough).map(|part| (side, part))
    };
    CutSide::ALL
        .into_iter()
        .filter_map(remain)
        .min_by_key(|(_, part)| *part)
}

/// The parameter at which a patch is cut so that some parts of it remain.
fn place(side: CutSide, part: usize) -> f64 {
    let share = part as f64 / PARTS as f64;
    if side.upper { share } else { 1.0 - share }
}

fn kept(patch: &Patch, side: CutSide, part: usize) -> Option<Patch> {
    let at = place(side, part);
    let [lo, hi] = if side.upper { [0.0, at] } else { [at, 1.0] };
    let form = |form: &Bernstein| form.restrict(side.axis, lo, hi).assumed_exact();
    let first = patch.weight().coefficients()[0];
    // Parts of a constant are that constant, whatever the roundings: normals of polynomial patches have about half the
    // degree.
    let weight = if patch.weight().coefficients().iter().all(|w| *w == first) {
        patch.weight().clone()
    } else {
        form(patch.weight())
    };
    Patch::new(patch.position().each_ref().map(form), weight).ok()
}

/// The control points of a side, and their weights.
fn control(patch: &Patch, side: CutSide) -> Vec<(Vector3<f64>, f64)> {
    let degrees = patch.weight().degrees();
    let along = 1 - side.axis;
    let end = if side.upper { degrees[side.axis] } else { 0 };
    let index = |k: usize| {
        let [i, j] = if along == 0 { [k, end] } else { [end, k] };
        i + j * (degrees[0] + 1)
    };
    let point = |k: usize| {
        let w = patch.weight().coefficients()[index(k)];
        let p = patch
            .position()
            .each_ref()
            .map(|form| form.coefficients()[index(k)] / w);
        (Vector3::from(p), w)
    };
    (0..=degrees[along]).map(point).collect()
}

/// The ends and the middle of a side.
fn places(patch: &Patch, side: CutSide) -> [Vector3<f64>; 3] {
    let end = if side.upper { 1.0 } else { 0.0 };
    [0.0, 0.5, 1.0].map(|r| {
        let [u, v] = if side.axis == 0 { [end, r] } else { [r, end] };
        Vector3::from(patch.point(u, v))
    })
}

/// The lines from a side to a point, as a patch that faces as one does that goes on beyond the side; `None` unless it
/// faces up everywhere.
fn lid(points: &[(Vector3<f64>, f64)], side: CutSide, apex: &Vector3<f64>) -> Option<Patch> {
    // Seen from above, the control polygon turns about the apex in one direction, and so does the side.
    let sense = if (side.axis == 1) == side.upper { 1.0 } else { -1.0 };
    let turns = points.windows(2).all(|pair| {
        let [a, b] = [pair[0].0 - apex, pair[1].0 - apex];
        sense * a.xy().perp(&b.xy()) > 0.0
    });
    if !turns {
        return None;
    }
    let form = |value: &dyn Fn(&Vector3<f64>) -> f64| {
        let degree = points.len() - 1;
        let degrees = if side.axis == 0 { [1, degree] } else { [degree, 1] };
        let form = Bernstein::from_fn(&degrees, |at| {
            let (point, weight) = &points[at[1 - side.axis]];
            let is_apex = (at[side.axis] == 1) == side.upper;
            weight * value(if is_apex { apex } else { point })
        });
        form.ok()
    };
    let position = [form(&|p| p.x)?, form(&|p| p.y)?, form(&|p| p.z)?];
    Patch::new(position, form(&|_| 1.0)?).ok()
}
