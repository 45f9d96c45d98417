//! Assembles pieces in cells into arcs, loops and singular points.

use super::subdivide::{OpenCell, Search};
use super::trace::Vertex;
use super::{Curve, CurveEnd, CurvePoint, Curves, Singular};
use crate::Enclosure;
use crate::numbers::{MAX_UNKNOWNS, Row};
use crate::search::Cause;

/// Open cells close to one another, with a box around them.
struct Cluster {
    members: Vec<usize>,
    lo: Row,
    hi: Row,
}

impl Cluster {
    fn of(open: &[OpenCell], number: usize, n: usize) -> Self {
        let (mut lo, mut hi) = (open[number].lo, open[number].hi);
        let widest = (0..n).fold(0.0, |w: f64, j| w.max(hi[j] - lo[j]));
        for j in 0..n {
            lo[j] -= widest;
            hi[j] += widest;
        }
        Self {
            members: vec![number],
            lo,
            hi,
        }
    }

    fn unite(&mut self, other: Self, n: usize) {
        self.members.extend(other.members);
        for j in 0..n {
            self.lo[j] = self.lo[j].min(other.lo[j]);
            self.hi[j] = self.hi[j].max(other.hi[j]);
        }
    }
}

/// Unites clusters until no two of their boxes meet. Each union takes one pass over the clusters so far, so that thousands of cells take
/// milliseconds.
fn unite_near(cells: impl Iterator<Item = Cluster>, n: usize) -> Vec<Cluster> {
    let meet = |a: &Cluster, b: &Cluster| (0..n).all(|j| a.lo[j] <= b.hi[j] && b.lo[j] <= a.hi[j]);
    let mut clusters: Vec<Cluster> = Vec::new();
    for mut next in cells {
        while let Some(near) = clusters.iter().position(|c| meet(c, &next)) {
            next.unite(clusters.swap_remove(near), n);
        }
        clusters.push(next);
    }
    for cluster in &mut clusters {
        cluster.members.sort_unstable();
    }
    clusters.sort_by_key(|c| c.members[0]);
    clusters
}

impl Search<'_> {
    /// Joins pieces at shared crossings.
    pub(super) fn assemble(self, skin: f64) -> Curves {
        let n = self.system.layout.n;
        // Open cells that are close, relative to the size of the cluster so far, form one cluster, since some cells around a singular
        // point are settled. Each cluster has the crossings that belong to only one of its cells.
        let clusters = unite_near((0..self.open.len()).map(|o| Cluster::of(&self.open, o, n)), n);
        let mut at_group: Vec<Option<usize>> = vec![None; self.crossings.len()];
        let mut singular = Vec::new();
        for (number, cluster) in clusters.iter().enumerate() {
            let members: Vec<&OpenCell> = cluster.members.iter().map(|o| &self.open[*o]).collect();
            let mut all: Vec<usize> = members.iter().flat_map(|o| o.crossings.iter().copied()).collect();
            all.sort_unstable();
            for same in all.chunk_by(|a, b| a == b) {
                if same.len() == 1 {
                    at_group[same[0]] = Some(number);
                }
            }
            singular.push(Singular {
                bounds: self.system.outward(&cluster.lo, &cluster.hi),
                cause: members[0].cause,
                branches: Vec::new(),
            });
        }
        // Each crossing belongs to at most two pieces.
        let mut at: Vec<[Option<usize>; 2]> = vec![[None; 2]; self.crossings.len()];
        for (p, piece) in self.pieces.iter().enumerate() {
            for end in piece.ends {
                let slot = usize::from(at[end][0].is_some());
                at[end][slot] = Some(p);
            }
        }
        let mut used = vec![false; self.pieces.len()];
        let mut curves = Vec::new();
        // Pieces are directed: `ends[0]` to `ends[1]` is the direction of the wedge product. Walk back to the first, then forward.
        for start in 0..self.pieces.len() {
            if used[start] {
                continue;
            }
            let mut first = start;
            let mut closed = false;
            loop {
                let back = at[self.pieces[first].ends[0]]
                    .iter()
                    .flatten()
                    .copied()
                    .find(|p| *p != first);
                match back {
                    Some(p) if p == start => {
                        closed = true;
                        break;
                    }
                    Some(p) => first = p,
                    None => break,
                }
            }
            if closed {
                first = start;
            }
            let mut chain = Vec::new();
            let mut piece = first;
            loop {
                used[piece] = true;
                chain.push(piece);
                let next = at[self.pieces[piece].ends[1]]
                    .iter()
                    .flatten()
                    .copied()
                    .find(|p| *p != piece);
                match next {
                    Some(p) if !used[p] => piece = p,
                    _ => break,
                }
            }
            // Two pieces that share both ends also form a loop.
            let ends = [
                self.pieces[chain[0]].ends[0],
                self.pieces[chain[chain.len() - 1]].ends[1],
            ];
            closed = ends[0] == ends[1] && chain.len() > 1;
            let mut points: Vec<CurvePoint> = Vec::new();
            let mut handles = Vec::new();
            for p in &chain {
                let vertices = &self.pieces[*p].trace.vertices;
                handles.extend_from_slice(&self.pieces[*p].trace.handles);
                let skip = usize::from(!points.is_empty());
                points.extend(vertices[skip..].iter().map(|v| self.tracer.outer(v)));
            }
            if closed {
                points.pop();
            }
            if skin > 0.0 && self.only_in_skin(&chain) {
                // The curve may still touch the region.
                singular.extend(self.touch(&points));
                continue;
            }
            if let (Some(a), Some(b)) = (at_group[ends[0]], at_group[ends[1]]) {
                // A bit of curve within the cluster's box is part of the cluster.
                let inside = |p: &CurvePoint| singular[a].bounds.iter().zip(&p.point).all(|(b, x)| b.contains(*x));
                if a == b && !closed && points.iter().all(inside) {
                    continue;
                }
            }
            let number = curves.len();
            let mut end = |k: usize| -> CurveEnd {
                match at_group[ends[k]] {
                    Some(group) if !self.crossings[ends[k]].outer => {
                        singular[group].branches.push((number, k == 1));
                        CurveEnd::Singular(group)
                    }
                    _ => CurveEnd::Boundary,
                }
            };
            let ends = if closed { None } else { Some([end(0), end(1)]) };
            curves.push(Curve { points, handles, ends });
        }
        Curves {
            curves,
            singular,
            skin,
            statistics: self.statistics,
        }
    }

    /// The part of the region that a polyline in the skin may touch: within the tolerance of its hull.
    fn touch(&self, points: &[CurvePoint]) -> Option<Singular> {
        let region = self.system.outward(&self.system.region.0, &self.system.region.1);
        let side = |(j, side): (usize, &Enclosure)| {
            let hull = points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), p| {
                (lo.min(p.point[j]), hi.max(p.point[j]))
            });
            let pad = self.tracer.tolerance * (1.0 + 1e-12) + 4.0 * f64::EPSILON * side.magnitude();
            Enclosure::hull(hull.0 - pad, hull.1 + pad).intersection(*side)
        };
        let bounds = region.iter().enumerate().map(side).collect::<Option<Vec<_>>>()?;
        Some(Singular {
            bounds,
            cause: Cause::Skin,
            branches: Vec::new(),
        })
    }

    /// Whether no vertex of the chain and no midpoint of its segments lies in the region itself.
    fn only_in_skin(&self, chain: &[usize]) -> bool {
        let n = self.system.layout.n;
        let region = &self.system.region;
        let inside = |x: &Row| (0..n).all(|j| region.0[j] <= x[j] && x[j] <= region.1[j]);
        !chain.iter().any(|p| {
            let vertices = &self.pieces[*p].trace.vertices;
            let middle = |w: &[Vertex]| {
                let mut x = [0.0; MAX_UNKNOWNS];
                for j in 0..n {
                    x[j] = 0.5 * (w[0].point[j] + w[1].point[j]);
                }
                x
            };
            vertices.iter().any(|v| inside(&v.point)) || vertices.windows(2).any(|w| inside(&middle(w)))
        })
    }
}
