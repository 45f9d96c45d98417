//! Lines that miss a piece of surface or of an edge, where its own parameters do not show it.
//!
//! Where a face contains the direction of the lines, the gradients of `X`, `Y` and `g` with respect to `u` and `v` are parallel, and no range of a single one of them
//! tells a line in the face from one beside it, unless boxes are as small as the distance between the two. If a flat end turns about a line in its bottom,
//! that is so along a whole surface in `(u, v, t)`. But the bottom is *flat*: with a normal `n` of the face, fixed in the tool, `⟨n, F⟩` is the same all over it, and a
//! point at the height `z` of the line `(x, y)` is there at time `t` only if
//!
//! ```text
//! ⟨n, F⟩ = ⟨A n, D⟩,        D = (x, y, z) − b(t),
//! ```
//!
//! where the height, however uncertain, counts no more than the face leans away from it. The same point moves by
//!
//! ```text
//! g = ⟨N, Ω × AᵀD + Aᵀb′⟩.
//! ```
//!
//! On curved faces, too, the first is of second order in the sides of the cell, where `X` and `Y` are of first.
//!
//! Where many points of the box are on one line, as the apex of a drill that turns about it, those around them lie in directions from there, and
//! so does a line near it. What separates the two is a straight line in the plane of the dexels' feet, which is found from the control points. So it is with a ruling that slides
//! along itself, as on the wall of a tool that moves along its own tilted axis: it passes beside the line next to it all the way, and the tip's way has the same direction.

use crate::algebra::ranges::{Triples, products, range_of};
use crate::algebra::separate::is_separate;
use crate::cutter::cells::Cells;
use crate::cutter::patch_forms::PatchForms;
use crate::envelope::enclosures::{Brick, ROUNDING, Size};
use crate::time::pieces::Times;
use nalgebra::Vector3;
use smallvec::SmallVec;

pub(super) type Range = (f64, f64);

/// Whether none of the points of a cell of a patch in a piece of time is on the line `(x, y)` and has `g = 0`.
pub(super) fn is_absent(
    of @ (element, cells): (&PatchForms, &Cells),
    (times, size): (&Times, &Size),
    brick: Brick,
    line: [f64; 2],
) -> bool {
    if is_beside(of, (times, size), brick, line) {
        return true;
    }
    let (cell, piece) = brick;
    let arm = arm(
        &cells.position(element, cell),
        (times, size),
        piece,
        line.map(|x| (x, x)),
    );
    middle_normal(element, cells, cell).is_some_and(|normal| is_off(of, (times, size), brick, &arm, &normal))
        || moves_across(of, times, brick, &arm)
}

/// Whether none of the points of a cell of an edge in a piece of time is on the line `(x, y)`.
pub(super) fn is_absent_from_edge(
    of @ (element, cells): (&PatchForms, &Cells),
    (times, size): (&Times, &Size),
    brick: Brick,
    line: [f64; 2],
) -> bool {
    if is_beside(of, (times, size), brick, line) {
        return true;
    }
    // Across the edge and, at about the middle of the time, the line: neither the place along the edge nor the height counts.
    let (cell, piece) = brick;
    let upright = times.rows(piece, 2);
    let along = middle(&cells.slope(element, cell, 0));
    let across = along.cross(&Vector3::from(upright[upright.len() / 2]));
    across.try_normalize(0.0).is_some_and(|normal| {
        let arm = arm(
            &cells.position(element, cell),
            (times, size),
            piece,
            line.map(|x| (x, x)),
        );
        is_off(of, (times, size), brick, &arm, &normal.into())
    })
}

/// Whether a line in the plane of `X` and `Y` separates the cell, on the whole of its way, from the line `(x, y)`.
fn is_beside(
    (element, cells): (&PatchForms, &Cells),
    (times, size): (&Times, &Size),
    (cell, piece): Brick,
    line: [f64; 2],
) -> bool {
    let rows = [0, 1].map(|r| times.rows(piece, r));
    let (ends, off) = times.chord(piece);
    let from = ends.map(|end| [line[0] - end[0], line[1] - end[1]]);
    let uncertain = off.map(|off| off + 2.0 * size.system_rounding);
    is_separate(rows, &cells.position(element, cell), &from, uncertain)
}

/// The vector from the tip to any point of the lines, whose coordinates have these ranges, that is as high as some point of the cell.
pub(super) fn arm(position: &Triples, (times, size): (&Times, &Size), piece: u32, lines: [Range; 2]) -> [Range; 3] {
    let from_tip = |r: usize| {
        let (lo, hi) = times.tip(piece, r);
        (
            lines[r].0 - hi - size.system_rounding,
            lines[r].1 - lo + size.system_rounding,
        )
    };
    let (lo, hi) = products(times.rows(piece, 2), position);
    [
        from_tip(0),
        from_tip(1),
        (lo - size.system_rounding, hi + size.system_rounding),
    ]
}

/// Whether the cell's points differ from the end of the arm in a direction that is fixed in the tool.
fn is_off(
    (element, cells): (&PatchForms, &Cells),
    (times, size): (&Times, &Size),
    (cell, piece): Brick,
    arm: &[Range; 3],
    direction: &[f64; 3],
) -> bool {
    let seen = seen(times, piece, arm, direction);
    let own = products(&[*direction], &cells.position(element, cell));
    let error = 2.0 * size.system_rounding;
    seen.0 > own.1 + error || seen.1 < own.0 - error
}

/// The range of the end of the arm in a direction that is fixed in the tool.
pub(super) fn seen(times: &Times, piece: u32, arm: &[Range; 3], direction: &[f64; 3]) -> Range {
    let rows = [0, 1, 2].map(|r| times.rows(piece, r));
    // Convex combinations of what the control rows give, as products of such combinations are.
    hull((0..rows[0].len()).map(|k| reach(arm, &[0, 1, 2].map(|r| dot(&rows[r][k], direction)))))
}

/// Whether `g` has the same sign at all points of the cell to which the arm from the tip reaches.
fn moves_across(
    (element, cells): (&PatchForms, &Cells),
    times: &Times,
    (cell, piece): Brick,
    arm: &[Range; 3],
) -> bool {
    let rows = [0, 1, 2].map(|r| times.rows(piece, r));
    let [normals, _] = cells.field(element, cell, 0);
    let (spins, travels) = times.twist(piece);
    // `Ω × Aᵀeᵣ` for each pair of a spin and a control row.
    let turning = |spin: &[f64; 3], k: usize| [0, 1, 2].map(|r| cross(spin, &rows[r][k]));
    let pairs = || {
        spins
            .iter()
            .flat_map(|spin| (0..rows[0].len()).map(move |k| turning(spin, k)))
    };
    let pairs: SmallVec<[[[f64; 3]; 3]; 9]> = pairs().collect();
    let g = hull((0..normals.len()).map(|j| {
        let turned = hull(pairs.iter().map(|arms| reach(arm, &arms.map(|v| normals.dot(&v, j)))));
        let carried = range_of(travels.iter().map(|v| normals.dot(v, j)));
        (turned.0 + carried.0, turned.1 + carried.1)
    }));
    // The velocity's components: they multiply what is missing from the normals, and rounding.
    let largest = arm.map(|(lo, hi)| lo.abs().max(hi.abs()));
    let turned = |k: usize| {
        pairs
            .iter()
            .map(move |arms| (0..3).map(|r| largest[r] * arms[r][k].abs()).sum::<f64>())
    };
    let carried = |k: usize| travels.iter().map(move |v| v[k].abs());
    let velocity = [0, 1, 2].map(|k| range_of(turned(k)).1 + range_of(carried(k)).1);
    let [spin, travel] = times.sizes();
    let longest: f64 = largest.iter().sum();
    let rounding = [0, 1, 2].map(|k| longest * (spin[(k + 1) % 3] + spin[(k + 2) % 3]) + travel[k]);
    let [_, normal] = element.rounding;
    let [_, missing] = cells.missing(cell).value;
    let error: f64 = (0..3)
        .map(|k| velocity[k] * missing[k] + ROUNDING * rounding[k] * normal[k])
        .sum();
    g.0 > error || g.1 < -error
}

/// A unit vector along the mean of a cell's normals.
pub(super) fn middle_normal(element: &PatchForms, cells: &Cells, cell: u32) -> Option<[f64; 3]> {
    let [normals, _] = cells.field(element, cell, 0);
    let normal = middle(&normals).try_normalize(0.0)?;
    normal.iter().all(|x| x.is_finite()).then(|| normal.into())
}

/// The sum of some vectors.
fn middle(vectors: &Triples) -> Vector3<f64> {
    Vector3::from([vectors.x, vectors.y, vectors.z].map(|list| list.iter().sum()))
}

/// The range of `⟨arm, v⟩`.
fn reach(arm: &[Range; 3], v: &[f64; 3]) -> Range {
    let mut sum = (0.0, 0.0);
    for ((lo, hi), factor) in arm.iter().zip(v) {
        let (a, b) = (lo * factor, hi * factor);
        sum = if a <= b {
            (sum.0 + a, sum.1 + b)
        } else {
            (sum.0 + b, sum.1 + a)
        };
    }
    sum
}

/// The range of all; unknown if one of them is.
fn hull(all: impl IntoIterator<Item = Range>) -> Range {
    range_of(all.into_iter().flat_map(|(lo, hi)| [lo, hi]))
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    Vector3::from(*a).cross(&Vector3::from(*b)).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::envelope::{AnyBox, EdgeMap, JointSide, PatchMap, PlacedMap};
    use sweepsim_motion::{Apt, Law, Path, Pose, Segment, Tool};
    use sweepsim_props::*;
    use sweepsim_solve::{ChartMap, Enclosure};

    const SIZE: Size = Size {
        spacing: [0.1; 2],
        system_rounding: 64.0 * f64::EPSILON * 50.0,
    };

    fn tool(kind: usize) -> Tool {
        let drill = Apt {
            d: 4.0,
            r: 0.0,
            e: 2.0,
            f: 0.0,
            a: 31.0,
            b: 0.0,
            h: 7.0,
        };
        match kind {
            0 => Tool::ball(2.0, 7.0).unwrap(),
            1 => Tool::flat(2.0, 7.0).unwrap(),
            2 => Tool::bull(2.0, 0.5, 7.0).unwrap(),
            _ => Tool::apt(&drill).unwrap().0,
        }
    }

    /// Turns about a line along z that the tip moves along, or not quite: `off` from it. Or along the tool's own axis, or not quite, without a turn.
    fn motion(off: [f64; 4], turns: bool) -> Segment {
        let [x, y, tilt, rise] = off;
        let poses = [0.3, -0.2].map(|side| {
            let own = [0.3, 1.0, rise];
            let along = [8.0 * side * own[0], side * (8.0 * own[1] + x), side * (8.0 * rise + y)];
            let about = ([0.0, x * side, rise * side], [side, 1.0 + y, tilt * side]);
            let (tip, axis) = if turns { about } else { (along, own) };
            Pose::new(tip, axis).unwrap()
        });
        let path = Path::with_law(poses.into(), Law::Slerp).unwrap();
        path.segments(0, 10.0, 1e-6).remove(0)
    }

    fn around<const N: usize>(place: [f64; N], shares: [f64; 3], size: f64) -> [Enclosure; N] {
        std::array::from_fn(|k| {
            let lower = (place[k] - size * shares[k]).max(0.0);
            Enclosure::hull(lower, (place[k] + size * (1.0 - shares[k])).min(1.0).max(lower + 1e-12))
        })
    }

    /// Sizes of boxes and distances of lines, down to almost nothing.
    fn scale() -> impl Strategy<Value = f64> {
        (0..28_i32).prop_map(|k| 0.5_f64.powi(k))
    }

    fn offs() -> impl Strategy<Value = [f64; 4]> {
        let small = || prop_oneof![Just(0.0), -1e-6..1e-6, -0.3..0.3];
        let rise = prop_oneof![Just(0.0), Just(5.0)];
        ([small(), small(), small()], rise).prop_map(|([x, y, tilt], rise)| [x, y, tilt, rise])
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]

        /// The line through a point with `g = 0` is never absent from a box that holds the point, nor that through a point of an edge or of a tool at rest.
        #[test]
        fn lines_through_a_box_are_not_absent(
            kind in 0..4_usize, off in offs(), place in [0.0..1.0, 0.0..1.0, 0.0..1.0], shares in [0.0..1.0, 0.0..1.0, 0.0..1.0], size in scale(),
            turns in any::<bool>(),
        ) {
            let (patches, edges) = PatchForms::all(&tool(kind));
            let segment = motion(off, turns);
            let [u, v, t] = place;
            for element in &patches {
                let (mut times, mut cells) = (Times::new(&segment), Cells::new(element));
                let mut map = PatchMap::new(element, &mut cells, &mut times, SIZE);
                let g = |map: &PatchMap, u: f64| map.evaluate(&[u, v, t]).value[2];
                let (mut low, mut high) = (0.0, 1.0);
                if (g(&map, low) < 0.0) != (g(&map, high) < 0.0) {
                    let falls = g(&map, high) < 0.0;
                    while high - low > 1e-15 {
                        let middle = 0.5 * (low + high);
                        *(if (g(&map, middle) < 0.0) == falls { &mut high } else { &mut low }) = middle;
                    }
                    let [x, y, _] = map.evaluate(&[low, v, t]).value;
                    let cell = map.place(&around([low, v, t], shares, size));
                    prop_assert!(!map.is_absent(&cell, &[x, y, 0.0]), "patch");
                    let line = [x, y, 0.0].map(|q| Enclosure::hull(q, q));
                    if let Some([in_u, in_v, _]) = map.clipped(&cell, &line) {
                        prop_assert!(in_u.contains(low) && in_v.contains(v), "{in_u:?} {in_v:?}");
                    }
                    // Nor is the point beyond the part of the box where `g` can vanish.
                    let enclosures = map.values(&cell).map(|values| (values, map.jacobian(&cell)));
                    if let Some((values, jacobian)) = enclosures
                        && let Some(part) = map.part(&cell, &values, &jacobian)
                    {
                        let bounds = map.bounds(&part);
                        prop_assert!(bounds[0].contains(low) && bounds[1].contains(v), "{bounds:?}");
                        map.drop_part(part);
                    }
                }
                let mut cells = Cells::new(element);
                let pose = (segment.start(), segment.tips()[0].into());
                let mut map = PlacedMap::new(element, &mut cells, pose, [JointSide::Beyond(false), JointSide::Beyond(true)], SIZE);
                let cell = map.place(&around([u, v], shares, size));
                prop_assert!(!map.is_absent(&cell, &map.evaluate(&[u, v]).value), "at rest");
            }
            for element in &edges {
                let (mut times, mut cells) = (Times::new(&segment), Cells::new(element));
                let mut map = EdgeMap::new(element, &mut cells, &mut times, SIZE);
                let cell = map.place(&around([u, t], shares, size));
                prop_assert!(!map.is_absent(&cell, &map.evaluate(&[u, t]).value), "edge");
            }
        }

        /// A bottom that a line lies in at all times is told from a line beside it, however near, on the whole of it and for a tenth of the turn.
        #[test]
        fn lines_beside_a_bottom_that_turns_about_a_line_are_absent(size in -9.0..-1.0, angle in 0.4..2.5, start in 0.0..0.9) {
            let distance = 10.0_f64.powf(size);
            let (patches, _) = PatchForms::all(&tool(1));
            let segment = motion([0.0, 0.0, 0.0, 5.0], true);
            let line = [distance * f64::cos(angle), distance * f64::sin(angle), 0.0];
            let mut bottoms = 0;
            for element in &patches {
                let (mut times, mut cells) = (Times::new(&segment), Cells::new(element));
                let mut map = PatchMap::new(element, &mut cells, &mut times, SIZE);
                let cell = map.place(&[Enclosure::UNIT, Enclosure::UNIT, Enclosure::hull(start, start + 0.1)]);
                let is_near = map.values(&cell).is_some_and(|[x, y, _]| x.contains(line[0]) && y.contains(line[1]));
                bottoms += usize::from(is_near && map.is_absent(&cell, &line));
            }
            prop_assert!(bottoms > 0);
        }
    }
}
