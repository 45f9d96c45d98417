//! Which surface each interval end is on.

use super::groups::FREE;
use crate::chart::Label;
use crate::net::Net;
use crate::surface::Surface;
use nalgebra::Vector3;
use std::collections::{BTreeMap, BTreeSet};
use sweepsim_dexel::{Source, SurfaceEnd};

/// How far normals of ends may be turned from those of their surface: the cosine of 0.03.
const COSINE: f64 = 0.999_55;
/// How often labels are made smoother.
const ROUNDS: usize = 12;

/// The labels of ends.
pub(crate) struct Labels {
    pub all: Vec<Label>,
    /// Of each end; [`FREE`] for none.
    pub of: Vec<u32>,
    /// The plane that divides two labels of one surface.
    pub dividers: BTreeMap<(u32, u32), Surface>,
}

/// Whether an end is on a surface, and on which side the material is.
fn on(end: &SurfaceEnd, surface: &Surface, tolerance: f64) -> Option<(f64, bool)> {
    let (distance, grows) = surface.at(end.place.into())?;
    let cosine = Vector3::from(end.normal?).dot(&grows);
    (distance.abs() <= tolerance && cosine.abs() >= COSINE).then_some((distance.abs(), cosine > 0.0))
}

/// A key of the moves and of the stock.
fn key(end: &SurfaceEnd) -> (u32, u32, bool) {
    match end.source {
        Source::Cut { path, segment, .. } => (path, segment, false),
        Source::Stock => (u32::MAX, u32::MAX, end.at_box),
    }
}

/// Gives each end the surface of its source that it is nearest to, or that of ends beside it.
pub(crate) fn labels(net: &Net, candidates: &dyn Fn(&SurfaceEnd) -> Vec<Surface>, tolerance: f64, size: f64) -> Labels {
    let ends = &net.ends.ends;
    let mut order: Vec<u32> = (0..ends.len() as u32).collect();
    order.sort_by_key(|end| key(&ends[*end as usize]));
    let mut known: BTreeMap<Vec<u64>, u32> = BTreeMap::new();
    let mut labels = Labels {
        all: Vec::new(),
        of: vec![FREE; ends.len()],
        dividers: BTreeMap::new(),
    };
    for group in order.chunk_by(|a, b| key(&ends[*a as usize]) == key(&ends[*b as usize])) {
        let mut own = candidates(&ends[group[0] as usize]);
        for number in group {
            let end = &ends[*number as usize];
            // A stock may have many faces.
            if end.source == Source::Stock && *number != group[0] {
                own = candidates(end);
            }
            let found = own
                .iter()
                .filter_map(|surface| Some((on(end, surface, tolerance)?, surface)));
            let nearest = found.min_by(|((a, _), _), ((b, _), _)| a.total_cmp(b));
            if let Some(((_, outward), surface)) = nearest {
                labels.of[*number as usize] = *known.entry(bits(surface, outward)).or_insert_with(|| {
                    labels.all.push(Label {
                        surface: surface.clone(),
                        outward,
                        pole: None,
                    });
                    labels.all.len() as u32 - 1
                });
            }
        }
    }
    let (first, beside) = net.neighbours();
    let around = |end: usize| &beside[first[end] as usize..first[end + 1] as usize];
    labels.unite(ends, &around, tolerance, size);
    labels.spread(ends, &around, tolerance);
    labels.smooth(ends, &around, tolerance);
    labels
}

/// Equal surfaces to the bit have equal keys.
fn bits(surface: &Surface, outward: bool) -> Vec<u64> {
    use sweepsim_dexel::AnalyticSurface as A;
    let (kind, numbers): (u64, Vec<f64>) = match surface {
        Surface::Analytic(A::Plane { origin, normal }) => {
            // Which of its points it is given by does not matter.
            let height = Vector3::from(*origin).dot(&Vector3::from(*normal));
            (0, [&normal[..], &[height]].concat())
        }
        Surface::Analytic(A::Cylinder { origin, axis, radius }) => (1, [&origin[..], &axis[..], &[*radius]].concat()),
        Surface::Analytic(A::Cone { apex, axis, angle }) => (2, [&apex[..], &axis[..], &[*angle]].concat()),
        Surface::Analytic(A::Sphere { centre, radius }) => (3, [&centre[..], &[*radius]].concat()),
        Surface::Analytic(A::Torus {
            centre,
            axis,
            major,
            minor,
        }) => (4, [&centre[..], &axis[..], &[*major, *minor]].concat()),
        Surface::Elliptic(sheet) => (5, sheet.numbers().to_vec()),
        Surface::Swept(sheet) => (6, sheet.numbers()),
        Surface::Analytic(_) => (7, Vec::new()),
    };
    let numbers = numbers.into_iter().map(|c| (c + 0.0).to_bits());
    [kind, u64::from(outward)].into_iter().chain(numbers).collect()
}

impl Labels {
    /// Whether an end is on the surface of a label, on its side.
    fn fits(&self, end: &SurfaceEnd, label: u32, tolerance: f64) -> bool {
        let label = &self.all[label as usize];
        let place = end.place.into();
        // The tip of a cone is on it, whatever its normal.
        if label.surface.at(place).is_none() {
            return label.surface.off(place) <= tolerance;
        }
        on(end, &label.surface, tolerance).is_some_and(|(_, outward)| outward == label.outward)
    }

    /// Makes one of surfaces that lie beside each other and are the same, up to a share of the tolerance.
    fn unite<'a>(&mut self, ends: &[SurfaceEnd], around: &impl Fn(usize) -> &'a [u32], tolerance: f64, size: f64) {
        let mut root: Vec<u32> = (0..self.all.len() as u32).collect();
        fn find(root: &mut [u32], mut label: u32) -> u32 {
            while root[label as usize] != label {
                root[label as usize] = root[root[label as usize] as usize];
                label = root[label as usize];
            }
            label
        }
        let mut tried = BTreeSet::new();
        for end in 0..ends.len() {
            for other in around(end) {
                let (a, b) = (self.of[end], self.of[*other as usize]);
                if a == FREE || b == FREE || a >= b || !tried.insert((a, b)) {
                    continue;
                }
                let (a, b) = (find(&mut root, a), find(&mut root, b));
                let [one, two] = [a, b].map(|label| &self.all[label as usize]);
                // Of the same surface, so that errors do not add up.
                let same = one
                    .surface
                    .same(&two.surface, ends[end].place.into(), size, 0.5 * tolerance);
                if a != b && one.outward == two.outward && same {
                    root[a.max(b) as usize] = a.min(b);
                }
            }
        }
        for label in self.of.iter_mut().filter(|label| **label != FREE) {
            *label = find(&mut root, *label);
        }
    }

    /// Ends without a surface get that of an end beside them, if they are on it; or if nothing is known of where they
    /// are exactly.
    fn spread<'a>(&mut self, ends: &[SurfaceEnd], around: &impl Fn(usize) -> &'a [u32], tolerance: f64) {
        let mut next: Vec<usize> = (0..ends.len()).filter(|end| self.of[*end] != FREE).collect();
        while let Some(end) = next.pop() {
            for other in around(end) {
                let other = *other as usize;
                if self.of[other] == FREE && self.fits(&ends[other], self.of[end], tolerance) {
                    self.of[other] = self.of[end];
                    next.push(other);
                }
            }
        }
        for end in 0..ends.len() {
            if self.of[end] == FREE && ends[end].normal.is_none() {
                self.of[end] = most(around(end).iter().map(|other| self.of[*other as usize])).map_or(FREE, |(l, _)| l);
            }
        }
    }

    /// Ends that are on two surfaces get that of most ends beside them.
    fn smooth<'a>(&mut self, ends: &[SurfaceEnd], around: &impl Fn(usize) -> &'a [u32], tolerance: f64) {
        for _ in 0..ROUNDS {
            let mut changed = 0;
            for end in 0..ends.len() {
                let labels = || around(end).iter().map(|other| self.of[*other as usize]);
                let own = labels().filter(|label| *label == self.of[end]).count();
                let fitting = labels().filter(|label| {
                    *label != FREE && *label != self.of[end] && self.fits(&ends[end], *label, tolerance)
                });
                if let Some((label, count)) = most(fitting)
                    && count > own
                {
                    self.of[end] = label;
                    changed += 1;
                }
            }
            if changed == 0 {
                break;
            }
        }
    }

    /// The plane that divides two labels of one surface.
    pub fn divider(&self, a: u32, b: u32) -> Option<&Surface> {
        self.dividers.get(&(a.min(b), a.max(b)))
    }
}

/// The label that occurs most often, and how often; the lowest of several.
fn most(labels: impl Iterator<Item = u32>) -> Option<(u32, usize)> {
    let mut counts: BTreeMap<u32, usize> = BTreeMap::new();
    labels
        .filter(|label| *label != FREE)
        .for_each(|label| *counts.entry(label).or_default() += 1);
    counts.into_iter().rev().max_by_key(|(_, count)| *count)
}
