//! How deep a solid may be below the surface near a cell.
//!
//! **Lifting.** Let `H` be a cell, `H′` its surroundings, `C` the points of the cutter in `H` at any of the times. Let
//! the cutter, lifted by a vector `w`, be above some planes `⟨nᵢ, x⟩ = eᵢ`, and every triangle in `H′` below one of
//! them. The region `Ω ⊂ H′` above all planes is convex and free of surface: all of it is outside of the solid, or all
//! inside. If one point of it is outside, so is every lifted point, and no point of `C` is deeper than `|w|`. This
//! needs `|w|` to be at most the `lift` of the cell, or lifted points may be beyond `H′`. With `dᵢ` the depth of the
//! cutter below plane `i`, the best `w` is the shortest with `⟨nᵢ, w⟩ ≥ dᵢ`.
//!
//! **Slabs.** If for two such normals, alone, the depths are `a − ⟨n, x⟩` and `b − ⟨m, x⟩`, the smaller of both is at
//! most their mean, which is nearly constant where the normals are nearly opposite: half the thickness of a rib.

use super::reach::During;
use super::trace::{NO_NORMALS, Normals, Reason, one};
use crate::solid::{Cell, MOST_PLANES, MOST_WAYS, Normal, Triangle, Way, Written, is_outside};
use nalgebra::Vector3;
use smallvec::SmallVec;

/// A bound of the depth, and what it was found with.
#[derive(Clone, Copy)]
pub(super) struct Depth {
    pub value: f64,
    /// The direction in which the solid may be lifted off.
    pub normal: Vector3<f64>,
    /// A place that may be about as deep.
    pub place: Option<Vector3<f64>>,
    /// What the bound says, and of which normals.
    pub reason: (Reason, Normals),
}

fn of_one(written: Written) -> (Reason, Normals) {
    (Reason::Lifted, one(written))
}

/// So many of the directions are tried together.
const TOGETHER: usize = 4;
/// Depths that differ by no more, in parts of half a cell, are about the same.
const ABOUT: f64 = 1e-6;
/// What is lifted above several planes is lifted by so much more, in parts of coordinates.
const ROUNDING: f64 = 1e-12;
/// Steps of a descent.
const STEPS: usize = 8;

/// A solid near a cell.
pub(super) struct Above<'a> {
    pub during: During<'a>,
    pub cell: &'a Cell,
    pub triangles: &'a [Triangle],
}

impl Above<'_> {
    /// The least bound that was found; the search for it ends at `enough`.
    pub fn depth(&self, enough: f64) -> Depth {
        let ways = self.cell.ways(self.triangles);
        let mut best = Depth {
            value: f64::INFINITY,
            normal: ways.first().map_or_else(Vector3::z, |way| way.normal),
            place: None,
            reason: (Reason::Lifted, NO_NORMALS),
        };
        let mut below = [0.0; MOST_WAYS + 1];
        for (way, below) in ways.iter().zip(&mut below) {
            *below = self.below(&way.normal);
            let value = way.top + *below;
            if way.out && value < best.value && value <= self.cell.lift {
                (best.value, best.normal, best.reason) = (value, way.normal, of_one(way.written));
                if value <= enough {
                    return best;
                }
            }
        }
        // In a hollow, each triangle is below its own plane.
        let faces = self.cell.faces(self.triangles);
        if !faces.is_empty() {
            let below = faces.iter().map(|normal| (*normal, self.below(&normal.vector)));
            self.lift(&below.collect::<SmallVec<[_; MOST_PLANES]>>(), &mut best);
            if best.value <= enough {
                return best;
            }
        }
        // Where all faces look about the same way, several planes are no better than one.
        let several = if self.cell.is_smooth(self.triangles) {
            0
        } else {
            TOGETHER
        };
        for (i, a) in ways.iter().enumerate().take(several) {
            for (j, b) in ways.iter().enumerate().take(i) {
                if a.normal.dot(&b.normal) < -0.5 {
                    self.slab(a, b, &mut best);
                } else {
                    let [a, b] = [(a.direction(), below[i]), (b.direction(), below[j])];
                    self.lift(&[a, b], &mut best);
                    for (k, c) in ways.iter().enumerate().take(j) {
                        self.lift(&[a, b, (c.direction(), below[k])], &mut best);
                    }
                }
                if best.value <= enough {
                    return best;
                }
            }
        }
        self.descend(enough, &mut best);
        best
    }

    /// How far the solid in the cell reaches against a normal.
    fn below(&self, normal: &Vector3<f64>) -> f64 {
        let down = -normal;
        self.during.reach(&down).min(self.cell.support(&down))
    }

    fn slab(&self, a: &Way, b: &Way, best: &mut Depth) {
        if !(a.out && b.out) {
            return;
        }
        let mean = -0.5 * (a.normal + b.normal);
        let value = 0.5 * (a.top + b.top) + self.cell.support(&mean);
        if value < best.value && value <= self.cell.lift {
            let off = 0.5 * (a.top - b.top - (a.normal - b.normal).dot(&self.cell.centre));
            let middle = self.cell.centre + a.normal * off / (1.0 - a.normal.dot(&b.normal)) * 2.0;
            *best = Depth {
                value,
                normal: a.normal,
                place: Some(middle),
                reason: (Reason::Slab, {
                    let mut normals = one(a.written);
                    normals[1] = Some(b.written);
                    normals
                }),
            };
        }
    }

    /// Above several planes at once.
    fn lift(&self, planes: &[(Normal, f64)], best: &mut Depth) {
        let mut tops = [f64::NEG_INFINITY; MOST_PLANES];
        let most = best.value.min(self.cell.lift);
        // Each triangle has to be below one of the planes: the first of those that the solid is about least below, so
        // that rounding does not decide, and a checker chooses the same.
        for piece in self.cell.pieces(self.triangles) {
            let (mut own, mut least) = ([f64::INFINITY; MOST_PLANES], f64::INFINITY);
            for (own, (way, below)) in own.iter_mut().zip(planes) {
                let heights = piece.corners.iter().map(|corner| way.vector.dot(corner));
                *own = heights.fold(f64::NEG_INFINITY, f64::max);
                least = least.min(*own + below);
            }
            // It has to be lifted by as much.
            if least > most {
                return;
            }
            let about = least + ABOUT * self.cell.half;
            let first = planes
                .iter()
                .zip(own)
                .position(|((_, below), own)| own + below <= about);
            if let Some(i) = first {
                tops[i] = tops[i].max(own[i]);
            }
        }
        // Planes with nothing below them are not needed, and nothing is lowered.
        let half = self.cell.half;
        // Between opposite planes, what just fits may not fit a checker.
        let rounding = ROUNDING * (self.cell.centre.amax() + half);
        let used = planes.iter().zip(tops).filter(|(_, top)| *top > f64::NEG_INFINITY);
        let (mut needs, mut own) = ([0.0; MOST_PLANES], [0.0; MOST_PLANES]);
        let (mut normals, mut written) = (SmallVec::<[Vector3<f64>; MOST_PLANES]>::new(), NO_NORMALS);
        for (i, ((way, below), top)) in used.enumerate() {
            normals.push(way.vector);
            written[i] = Some(way.written);
            needs[i] = (top + below).max(-half) + rounding;
            own[i] = (top - way.vector.dot(&self.cell.centre)).max(-half) + 0.01 * half;
        }
        let Some(lift) = shortest(&normals, &needs[..normals.len()]) else {
            return;
        };
        let value = lift.norm();
        if value >= best.value || value > self.cell.lift {
            return;
        }
        // A point above all planes, within the surroundings.
        let Some(off) = shortest(&normals, &own[..normals.len()]).filter(|off| off.amax() <= half + self.cell.lift)
        else {
            return;
        };
        if is_outside(
            &(self.cell.centre + off),
            self.cell.pieces(self.triangles),
            self.triangles,
        ) == Some(true)
        {
            let normal = lift.try_normalize(1e-9 * half).unwrap_or(normals[0]);
            let several = normals.len() > 1;
            let reason = (if several { Reason::LiftedAbove } else { Reason::Lifted }, written);
            *best = Depth {
                value,
                normal,
                place: None,
                reason,
            };
        }
    }

    /// Turns a normal towards where both solids are farther apart: by the points that touch first.
    fn descend(&self, enough: f64, best: &mut Depth) {
        let value_of = |normal: &Vector3<f64>| self.cell.top(normal, self.triangles).0 + self.below(normal);
        // From what the surface looks like, or from the axis: beside a convex wall, what is round touches it elsewhere.
        let away = self.during.on_axis(&self.cell.centre) - self.cell.centre;
        let starts = [best.normal, away].into_iter().filter_map(|start| Normal::near(&start));
        let starts = starts.map(|start| (value_of(&start.vector), start));
        let Some((mut value, mut short)) = starts.min_by(|a, b| a.0.total_cmp(&b.0)) else {
            return;
        };
        let mut normal = short.vector;
        let mut step = 1.0 / self.during.run.solid.radius().max(1e-3);
        for _ in 0..STEPS {
            let apart = self.cell.top(&normal, self.triangles).1 - self.during.farthest(&-normal).1;
            let across = apart - normal * normal.dot(&apart);
            let Some(turned) = Normal::near(&(normal - across * step)) else {
                break;
            };
            let next = value_of(&turned.vector);
            if next < value {
                (short, normal, value) = (turned, turned.vector, next);
                step *= 1.5;
            } else {
                step *= 0.25;
            }
            if value <= enough {
                break;
            }
        }
        let better = value < best.value && value <= self.cell.lift;
        if better && self.cell.way(short, self.triangles).out {
            *best = Depth {
                value,
                normal,
                place: None,
                reason: of_one(short.written),
            };
        }
    }

    /// The normal of a plane between the solid and the cell, farther than this from one of them.
    pub fn separating(&self, gap_needed: f64) -> Option<Written> {
        let gap = |normal: &Vector3<f64>| -(self.cell.support(normal) + self.during.reach(&-normal));
        // Away from the axis, or beyond one of its ends.
        let away = self.during.on_axis(&self.cell.centre) - self.cell.centre;
        let axis = self.during.ends[0].axis;
        let measured = |start: Vector3<f64>| Normal::near(&start).map(|normal| (gap(&normal.vector), normal));
        let starts = [away, axis, -axis].into_iter().filter_map(measured);
        let (mut value, mut short) = starts.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let mut normal = short.vector;
        let mut step = 1.0 / self.during.run.solid.radius().max(1e-3);
        for _ in 0..2 * STEPS {
            if value > gap_needed {
                return Some(short.written);
            }
            let corner = self.cell.centre + normal.map(|c| self.cell.half.copysign(c));
            let apart = corner - self.during.farthest(&-normal).1;
            let across = apart - normal * normal.dot(&apart);
            let turned = Normal::near(&(normal - across * step))?;
            let next = gap(&turned.vector);
            if next > value {
                (short, normal, value) = (turned, turned.vector, next);
                step *= 1.5;
            } else {
                step *= 0.25;
            }
        }
        // A step from the axis of what ends flat leads anywhere; straight from the solid costs more.
        let nearest = self.during.towards(&self.cell.centre).and_then(measured);
        let best = nearest.filter(|own| own.0 > value).unwrap_or((value, short));
        (best.0 > gap_needed).then_some(best.1.written)
    }
}

/// The shortest vector `w` with `⟨nᵢ, w⟩ ≥ dᵢ` for all `i`, of those that meet some of them exactly. Any that is found
/// meets all of them, but for rounding.
fn shortest(normals: &[Vector3<f64>], needs: &[f64]) -> Option<Vector3<f64>> {
    let size = needs.iter().fold(0.0_f64, |size, need| size.max(need.abs()));
    let meets = |w: &Vector3<f64>| {
        let all = || normals.iter().zip(needs);
        all().all(|(normal, need)| normal.dot(w) >= need - 1e-13 * size)
    };
    let mut best: Option<Vector3<f64>> = None;
    let mut take = |w: Vector3<f64>| {
        if meets(&w) && best.is_none_or(|best| w.norm_squared() < best.norm_squared()) {
            best = Some(w);
        }
    };
    take(Vector3::zeros());
    for (i, a) in normals.iter().enumerate() {
        take(a * needs[i]);
        for (j, b) in normals.iter().enumerate().take(i) {
            // w = α a + β b.
            let cosine = a.dot(b);
            let scale = 1.0 - cosine * cosine;
            if scale > 1e-4 {
                let alpha = (needs[i] - cosine * needs[j]) / scale;
                let beta = (needs[j] - cosine * needs[i]) / scale;
                take(a * alpha + b * beta);
            }
            for (k, c) in normals.iter().enumerate().take(j) {
                let across = b.cross(c);
                let volume = a.dot(&across);
                if volume.abs() > 1e-6 {
                    let sum = across * needs[i] + c.cross(a) * needs[j] + a.cross(b) * needs[k];
                    take(sum / volume);
                }
            }
        }
    }
    best
}
