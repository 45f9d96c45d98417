//! Connected pieces of material that are missing, or left, beyond the limits.

use super::depth::{SurfaceSide, greatest};
use super::deviation::{DeviationKind, Region};
use super::lines::{Heights, Lines};
use super::target::Target;
use rayon::prelude::*;
use std::collections::BTreeMap;
use sweepsim_dexel::{Dexels, Grid};

/// Finds where the target is missing from one side to the other.
pub(super) struct Webs<'a> {
    pub remaining: &'a Dexels,
    pub target: &'a Target,
}

impl Webs<'_> {
    /// The thickness of what is missing, where it is missing along whole intervals of the target: on each line at most the distance of their ends from what
    /// remains. Walls that are off sideways are nearer than two lines to it, and no webs.
    fn thickest(&self, missing: &Lines) -> f64 {
        let grid = self.remaining.grid();
        let [dx, dy] = grid.spacing();
        let mut whole: Vec<(u32, [f64; 2])> = Vec::new();
        for (line, heights) in &missing.0 {
            // What is missing is a part of the core, which is the target less its skin.
            let own: Heights = self.target.core().at(*line as usize).heights().collect();
            let all = self.target.solid().at(*line as usize);
            let around = |piece: &[f64; 2]| all.heights().find(|[low, high]| *low <= piece[0] && piece[1] <= *high);
            let through = heights.iter().filter(|piece| own.contains(piece)).filter_map(around);
            whole.extend(through.map(|piece| (*line, piece)));
        }
        whole.sort_by(|a, b| (b.1[1] - b.1[0]).total_cmp(&(a.1[1] - a.1[0])));
        let mut best = 0.0_f64;
        for (line, piece) in whole {
            if piece[1] - piece[0] <= best {
                break;
            }
            let (i, j) = grid.place(line as usize);
            let near = piece.map(|z| {
                let place = grid.frame().to_world([grid.x(i), grid.y(j), z]);
                self.remaining
                    .nearest_end(place)
                    .map_or(f64::INFINITY, |near| near.distance)
            });
            let near = near[0].min(near[1]);
            if near > 2.0 * dx.hypot(dy) {
                best = best.max(near.min(piece[1] - piece[0]));
            }
        }
        best
    }
}

/// A region, and a box in the world that holds what is seen of it, half a cell wider.
#[derive(Clone, Debug)]
pub(super) struct Extent {
    pub region: Region,
    corners: [[f64; 3]; 2],
}

impl Extent {
    fn of(material: &Lines, grid: &Grid, region: Region) -> Self {
        let half = grid.spacing().map(|step| 0.5 * step);
        let mut corners = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for (line, heights) in &material.0 {
            let (i, j) = grid.place(*line as usize);
            let lowest = heights.iter().map(|piece| piece[0]).fold(f64::INFINITY, f64::min);
            let highest = heights.iter().map(|piece| piece[1]).fold(f64::NEG_INFINITY, f64::max);
            for n in 0..8 {
                let x = grid.x(i) + if n & 1 == 0 { -half[0] } else { half[0] };
                let y = grid.y(j) + if n & 2 == 0 { -half[1] } else { half[1] };
                let corner = grid.frame().to_world([x, y, if n & 4 == 0 { lowest } else { highest }]);
                for k in 0..3 {
                    corners[0][k] = corners[0][k].min(corner[k]);
                    corners[1][k] = corners[1][k].max(corner[k]);
                }
            }
        }
        Self { region, corners }
    }

    fn meets(&self, other: &Self) -> bool {
        let ([a, b], [c, d]) = (self.corners, other.corners);
        self.region.kind == other.region.kind && (0..3).all(|k| a[k] <= d[k] && c[k] <= b[k])
    }
}

/// The regions that lines along several directions see, the deepest first, gouges before excess. Those of different directions whose boxes meet are one.
pub(super) fn joined(looks: Vec<Vec<Extent>>) -> Vec<Region> {
    let all: Vec<(usize, Extent)> = looks
        .into_iter()
        .enumerate()
        .flat_map(|(look, regions)| regions.into_iter().map(move |region| (look, region)))
        .collect();
    let mut parent: Vec<usize> = (0..all.len()).collect();
    let several = all.iter().any(|(look, _)| *look > 0);
    for (n, (look, own)) in all.iter().enumerate().filter(|_| several) {
        for (m, (other, earlier)) in all.iter().enumerate().take(n) {
            if look != other && own.meets(earlier) {
                let (p, q) = (root(&mut parent, n), root(&mut parent, m));
                parent[p.max(q)] = p.min(q);
            }
        }
    }
    let mut groups: BTreeMap<usize, Region> = BTreeMap::new();
    for (n, (_, Extent { region, .. })) in all.into_iter().enumerate() {
        let whole = groups.entry(root(&mut parent, n)).or_insert_with(|| region.clone());
        if region.depth > whole.depth {
            (whole.place, whole.depth, whole.part) = (region.place, region.depth, region.part);
        }
        whole.area = whole.area.max(region.area);
        whole.volume = whole.volume.max(region.volume);
    }
    let mut regions: Vec<Region> = groups.into_values().collect();
    regions.sort_by(|a, b| a.kind.cmp(&b.kind).then(b.depth.total_cmp(&a.depth)));
    regions
}

/// Lines this many columns or rows apart are neighbours: what is thinner than their distance is on some of them only.
const NEAR: usize = 3;

/// The connected pieces of material: intervals of neighbouring lines that overlap.
pub(super) fn connected(
    material: &Lines,
    grid: &Grid,
    target: &Target,
    kind: DeviationKind,
    webs: &Webs,
) -> Vec<Extent> {
    let [dx, dy] = grid.spacing();
    let pieces: Vec<(u32, [f64; 2])> = material
        .0
        .iter()
        .flat_map(|(line, heights)| heights.iter().map(move |h| (*line, *h)))
        .collect();
    let mut parent: Vec<usize> = (0..pieces.len()).collect();
    let first = |line: u32| pieces.partition_point(|(at, _)| *at < line);
    for (n, (line, [low, high])) in pieces.iter().enumerate() {
        let (i, j) = grid.place(*line as usize);
        // Half of the neighbours: the others look at this one.
        let ahead = (1..=NEAR).flat_map(|a| (0..=2 * NEAR).map(move |b| (i + a, (j + b).wrapping_sub(NEAR))));
        for (a, b) in ahead.chain((1..=NEAR).map(|b| (i, j + b))) {
            let Some(other) = grid.index(a, b) else { continue };
            let others = pieces[first(other as u32)..]
                .iter()
                .take_while(|(at, _)| *at as usize == other);
            for (k, (_, [below, above])) in others.enumerate() {
                if below.max(*low) <= above.min(*high) {
                    let (p, q) = (root(&mut parent, n), root(&mut parent, first(other as u32) + k));
                    parent[p.max(q)] = p.min(q);
                }
            }
        }
    }
    let mut groups: BTreeMap<usize, Vec<(u32, Heights)>> = BTreeMap::new();
    for (n, (line, piece)) in pieces.iter().enumerate() {
        let group = groups.entry(root(&mut parent, n)).or_default();
        match group.last_mut() {
            Some((at, heights)) if at == line => heights.push(*piece),
            _ => group.push((*line, Heights::from_slice(&[*piece]))),
        }
    }
    let side = match kind {
        DeviationKind::Gouge => SurfaceSide::Inside,
        DeviationKind::Excess => SurfaceSide::Outside,
    };
    let mut regions: Vec<Extent> = groups
        .into_values()
        .collect::<Vec<_>>()
        .into_par_iter()
        .with_max_len(1)
        .map(|group| {
            let group = Lines(group);
            let (depth, place) = greatest(&group, grid, target.distance(), side);
            let web = if kind == DeviationKind::Gouge {
                webs.thickest(&group)
            } else {
                0.0
            };
            let depth = depth.max(web);
            let region = Region {
                kind,
                part: target.part_at(place),
                place,
                depth,
                area: group.0.len() as f64 * dx * dy,
                volume: group.length() * dx * dy,
            };
            Extent::of(&group, grid, region)
        })
        .collect();
    regions.sort_by(|a, b| b.region.depth.total_cmp(&a.region.depth));
    regions
}

fn root(parent: &mut [usize], mut n: usize) -> usize {
    while parent[n] != n {
        parent[n] = parent[parent[n]];
        n = parent[n];
    }
    n
}
