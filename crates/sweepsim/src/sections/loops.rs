//! The outline of a section as closed loops, joined from the curves of its pieces.

use crate::sections::boundary_piece::BoundaryPoint;
use crate::sections::section::{Section, SectionCurve};

/// The boundary of a volume in a plane.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct SectionLoops {
    /// Closed polylines, their first point repeated at the end. Seen from the tip of the plane's normal, material is on the left: outer loops run
    /// counter-clockwise, holes clockwise.
    pub closed: Vec<Vec<[f64; 3]>>,
    /// Lines that could not be closed, since some piece of the boundary next to them is missing.
    pub open: Vec<Vec<[f64; 3]>>,
}

/// Ends farther apart than this many chord errors are not joined; each curve and each end is off by at most one.
const REACH: f64 = 8.0;
/// If ends are equally close to within this fraction, the closer points win.
const TIE: f64 = 1e-3;

impl Section {
    /// The outline as closed loops: the runs of [`outline`](Self::outline) joined end to end. Runs of two crossing curves are joined at their intersection.
    ///
    /// ```
    /// use sweepsim::prelude::*;
    /// use sweepsim::{section, systems::Plane};
    ///
    /// let up = [0.0, 0.0, 1.0];
    /// let path = Path::new(vec![Pose::new([-9.0, 0.0, 0.0], up)?, Pose::new([9.0, 0.0, 0.0], up)?])?;
    /// let tool = Tool::ball(2.0, 30.0)?;
    /// let groove = section(&[Cut::new(&tool, &path)], &Plane::x(0.5)?, 1e-3, &Options::default(), &())?;
    /// let loops = groove.loops();
    /// // The outline of the tool: one loop.
    /// assert_eq!((loops.closed.len(), loops.open.len()), (1, 0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn loops(&self) -> SectionLoops {
        let [across, up] = self.plane.frame();
        let flat = |p: &[f64; 3]| [across, up].map(|axis| (0..3).map(|k| axis[k] * p[k]).sum());
        let mut loops = SectionLoops::default();
        let mut runs: Vec<Run> = Vec::new();
        for (curve, passages) in self.curves.iter().zip(&self.passages) {
            runs_of(curve, passages, &flat, &mut runs, &mut loops.closed);
        }
        for run in &mut runs {
            run.orient();
        }
        let next = matches(&runs, REACH * self.chord);
        join(&runs, &next, REACH * self.chord, &mut loops);
        loops
    }
}

/// A point of a curve, between its vertices, just before or after another curve crosses it, where it may enter or leave the volume.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Passage {
    /// The number of the previous vertex, and the fraction of the way to the next.
    pub at: f64,
    pub point: BoundaryPoint,
    pub outer: bool,
}

/// Curves are tested this many chord errors before and after a crossing: far enough to tell them apart.
const BESIDE: f64 = 8.0;

/// Where each curve crosses the others, before testing what bounds the volume.
pub(super) fn passages(curves: &[SectionCurve], [across, up]: [[f64; 3]; 2], chord: f64) -> Vec<Vec<Passage>> {
    let flat = |p: &BoundaryPoint| [across, up].map(|axis| (0..3).map(|k| axis[k] * p.position[k]).sum::<f64>());
    let mut pieces: Vec<(usize, usize, [[f64; 2]; 2])> = Vec::new();
    for (number, curve) in curves.iter().enumerate() {
        let places: Vec<[f64; 2]> = curve.points.iter().map(flat).collect();
        pieces.extend(
            places
                .windows(2)
                .enumerate()
                .map(|(n, pair)| (number, n, [pair[0], pair[1]])),
        );
    }
    let low = |ends: &[[f64; 2]; 2], k: usize| ends[0][k].min(ends[1][k]);
    let high = |ends: &[[f64; 2]; 2], k: usize| ends[0][k].max(ends[1][k]);
    pieces.sort_by(|a, b| low(&a.2, 0).total_cmp(&low(&b.2, 0)));
    let mut found: Vec<Vec<Passage>> = vec![Vec::new(); curves.len()];
    let mut note = |number: usize, n: usize, part: f64, length: f64| {
        let [a, b] = [&curves[number].points[n], &curves[number].points[n + 1]];
        let step = BESIDE * chord / length;
        for part in [part - step, part + step]
            .into_iter()
            .filter(|part| (0.0..1.0).contains(part))
        {
            let mix = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k| a[k] + part * (b[k] - a[k]));
            let normal = mix(a.normal, b.normal);
            let size = normal.iter().map(|x| x * x).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
            found[number].push(Passage {
                at: n as f64 + part,
                point: BoundaryPoint {
                    position: mix(a.position, b.position),
                    normal: normal.map(|x| x / size),
                    t: a.t + part * (b.t - a.t),
                },
                outer: false,
            });
        }
    };
    for (first, (own, n, ends)) in pieces.iter().enumerate() {
        for (other, m, others) in pieces[first + 1..]
            .iter()
            .take_while(|piece| low(&piece.2, 0) <= high(ends, 0))
        {
            let neighbours = own == other && n.abs_diff(*m) <= 1;
            if neighbours || low(others, 1) > high(ends, 1) || high(others, 1) < low(ends, 1) {
                continue;
            }
            if let Some([s, t]) = crossing(*ends, *others) {
                let length = |[a, b]: &[[f64; 2]; 2]| sub(*b, *a)[0].hypot(sub(*b, *a)[1]);
                note(*own, *n, s, length(ends));
                note(*other, *m, t, length(others));
            }
        }
    }
    for list in &mut found {
        list.sort_by(|a, b| a.at.total_cmp(&b.at));
    }
    found
}

/// Where two segments cross, as a fraction of each.
fn crossing([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> Option<[f64; 2]> {
    let (along, other, between) = (sub(b, a), sub(d, c), sub(c, a));
    let determinant = cross(along, other);
    if determinant == 0.0 {
        return None;
    }
    let parts = [cross(between, other) / determinant, cross(between, along) / determinant];
    parts.iter().all(|part| (0.0..=1.0).contains(part)).then_some(parts)
}

/// A point in space, and its position in the plane.
#[derive(Clone, Copy, Debug)]
struct Corner {
    space: [f64; 3],
    plane: [f64; 2],
    /// The outward normal, in the plane.
    normal: [f64; 2],
}

/// Consecutive points of a curve that bound the volume, and their neighbours on the curve, which do not.
#[derive(Clone, Debug)]
struct Run {
    corners: Vec<Corner>,
    before: Option<Corner>,
    after: Option<Corner>,
}

fn sub(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Twice the extent to which a polyline has the normals on its right; negative if it runs the wrong way.
fn sense(corners: &[Corner]) -> f64 {
    let right = |pair: &[Corner]| {
        let step = sub(pair[1].plane, pair[0].plane);
        let normal = [0, 1].map(|k| pair[0].normal[k] + pair[1].normal[k]);
        -cross(step, normal)
    };
    corners.windows(2).map(right).sum()
}

impl Run {
    /// Turns the run so that material is on its left.
    fn orient(&mut self) {
        let ends = self.before.iter().chain(&self.corners).chain(&self.after);
        let all: Vec<Corner> = ends.copied().collect();
        if sense(&all) < 0.0 {
            self.corners.reverse();
            std::mem::swap(&mut self.before, &mut self.after);
        }
    }

    /// From the first point back, and from the last one forwards, to the neighbour.
    fn head(&self) -> [Corner; 2] {
        let first = self.corners[0];
        [first, self.before.unwrap_or(first)]
    }

    fn tail(&self) -> [Corner; 2] {
        let last = self.corners[self.corners.len() - 1];
        [last, self.after.unwrap_or(last)]
    }
}

/// Cuts a curve into runs; a closed curve that bounds the volume everywhere is a loop.
fn runs_of(
    curve: &SectionCurve,
    passages: &[Passage],
    flat: &dyn Fn(&[f64; 3]) -> [f64; 2],
    runs: &mut Vec<Run>,
    closed: &mut Vec<Vec<[f64; 3]>>,
) {
    let corner = |point: &BoundaryPoint| Corner {
        space: point.position,
        plane: flat(&point.position),
        normal: flat(&point.normal),
    };
    let mut corners: Vec<(Corner, bool)> = Vec::with_capacity(curve.points.len() + passages.len());
    let mut passages = passages.iter().peekable();
    for (n, (point, outer)) in curve.points.iter().zip(&curve.outer).enumerate() {
        corners.push((corner(point), *outer));
        while let Some(passage) = passages.next_if(|passage| passage.at < (n + 1) as f64) {
            corners.push((corner(&passage.point), passage.outer));
        }
    }
    let is_closed = corners.len() > 3 && corners[0].0.space == corners[corners.len() - 1].0.space;
    if is_closed {
        match corners.iter().position(|(_, outer)| !outer) {
            None => {
                let mut own: Vec<Corner> = corners.iter().map(|(corner, _)| *corner).collect();
                if sense(&own) < 0.0 {
                    own.reverse();
                }
                closed.push(own.iter().map(|corner| corner.space).collect());
                return;
            }
            Some(first) => {
                // Begin and end with a point inside the volume, so that no run is cut in two.
                corners.pop();
                let first = first % corners.len();
                corners.rotate_left(first);
                corners.push(corners[0]);
            }
        }
    }
    let mut n = 0;
    while n < corners.len() {
        if !corners[n].1 {
            n += 1;
            continue;
        }
        let end = corners[n..]
            .iter()
            .position(|(_, outer)| !outer)
            .map_or(corners.len(), |k| n + k);
        runs.push(Run {
            corners: corners[n..end].iter().map(|(corner, _)| *corner).collect(),
            before: n.checked_sub(1).map(|k| corners[k].0),
            after: corners.get(end).map(|(corner, _)| *corner),
        });
        n = end;
    }
}

/// Where two segments meet, as a fraction of the first.
fn meeting(first: [Corner; 2], second: [Corner; 2]) -> Option<f64> {
    crossing(first.map(|corner| corner.plane), second.map(|corner| corner.plane)).map(|[part, _]| part)
}

/// The distance of a point from a segment.
fn distance(point: [f64; 2], [a, b]: [Corner; 2]) -> f64 {
    let (along, to) = (sub(b.plane, a.plane), sub(point, a.plane));
    let length = dot(along, along);
    let part = if length > 0.0 {
        (dot(to, along) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let off = [0, 1].map(|k| to[k] - part * along[k]);
    dot(off, off).sqrt()
}

/// The run that follows each run, and where on the extension of its tail, unless it follows directly.
type Following = Vec<Option<(usize, Option<f64>)>>;

/// Pairs tails with heads, the closest pairs first.
fn matches(runs: &[Run], reach: f64) -> Following {
    let heads: Vec<[Corner; 2]> = runs.iter().map(Run::head).collect();
    let tails: Vec<[Corner; 2]> = runs.iter().map(Run::tail).collect();
    let length = |[a, b]: &[Corner; 2]| sub(b.plane, a.plane)[0].hypot(sub(b.plane, a.plane)[1]);
    let longest = heads.iter().map(length).fold(0.0, f64::max);
    let mut order: Vec<usize> = (0..runs.len()).collect();
    order.sort_by(|a, b| heads[*a][0].plane[0].total_cmp(&heads[*b][0].plane[0]));
    let mut pairs: Vec<(f64, usize, usize, Option<f64>)> = Vec::new();
    for (n, tail) in tails.iter().enumerate() {
        let window = reach + length(tail) + longest;
        let x = tail[0].plane[0];
        let first = order.partition_point(|k| heads[*k][0].plane[0] < x - window);
        for &k in order[first..]
            .iter()
            .take_while(|k| heads[**k][0].plane[0] <= x + window)
        {
            let head = heads[k];
            let gap = sub(head[0].plane, tail[0].plane);
            let at = meeting(*tail, head);
            let off = if at.is_some() {
                0.0
            } else {
                let of_tail = [head[0], head[1]].map(|corner| distance(corner.plane, *tail));
                let of_head = [tail[0], tail[1]].map(|corner| distance(corner.plane, head));
                of_tail.into_iter().chain(of_head).fold(f64::INFINITY, f64::min)
            };
            if off <= reach {
                pairs.push((off + TIE * gap[0].hypot(gap[1]), n, k, at));
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut next: Following = vec![None; runs.len()];
    let mut taken = vec![false; runs.len()];
    for (_, from, to, at) in pairs {
        if next[from].is_none() && !taken[to] {
            next[from] = Some((to, at));
            taken[to] = true;
        }
    }
    next
}

/// Follows the runs, around a loop or along an open line.
fn join(runs: &[Run], next: &Following, reach: f64, loops: &mut SectionLoops) {
    let mut preceded = vec![false; runs.len()];
    for (to, _) in next.iter().flatten() {
        preceded[*to] = true;
    }
    let mut done = vec![false; runs.len()];
    let (mut closed, mut open): (Vec<Vec<Corner>>, Vec<Vec<Corner>>) = (Vec::new(), Vec::new());
    // Runs without a predecessor begin open lines; all others are in loops.
    let starts = (0..runs.len()).filter(|n| !preceded[*n]);
    for start in starts.chain((0..runs.len()).filter(|n| preceded[*n])) {
        if done[start] {
            continue;
        }
        let mut line: Vec<Corner> = Vec::new();
        let mut at = start;
        let is_closed = loop {
            done[at] = true;
            line.extend(&runs[at].corners);
            let Some((to, meeting)) = next[at] else { break false };
            if let Some(part) = meeting {
                let [a, b] = runs[at].tail();
                line.push(Corner {
                    space: [0, 1, 2].map(|k| a.space[k] + part * (b.space[k] - a.space[k])),
                    plane: [0, 1].map(|k| a.plane[k] + part * (b.plane[k] - a.plane[k])),
                    normal: a.normal,
                });
            }
            if to == start {
                break true;
            }
            at = to;
        };
        line.dedup_by(|a, b| a.space == b.space);
        if is_closed || closes_on_itself(&mut line, reach) {
            closed.push(line);
        } else {
            open.push(line);
        }
    }
    // Two pieces may share a part of the boundary, like the caps of a path that ends where it begins; keep it once.
    let near = |corner: &Corner, line: &[Corner]| {
        line.windows(2)
            .any(|pair| distance(corner.plane, [pair[0], pair[1]]) <= reach)
    };
    for line in &mut closed {
        line.extend(line.first().copied());
    }
    closed.retain(|line| line.len() > 3);
    open.retain(|line| line.len() > 1 && !line.iter().all(|corner| closed.iter().any(|other| near(corner, other))));
    let space = |line: Vec<Corner>| {
        let mut line: Vec<[f64; 3]> = line.iter().map(|corner| corner.space).collect();
        line.dedup();
        line
    };
    loops.closed.extend(closed.into_iter().map(space));
    loops.open.extend(open.into_iter().map(space));
}

/// Closes a line whose end lies on an earlier part of it, and drops the part before that.
fn closes_on_itself(line: &mut Vec<Corner>, reach: f64) -> bool {
    let Some(end) = line.last().copied() else { return false };
    let on = (0..line.len().saturating_sub(3)).find(|k| distance(end.plane, [line[*k], line[*k + 1]]) <= reach);
    let Some(first) = on else { return false };
    line.drain(..=first);
    true
}
