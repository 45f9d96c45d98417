//! The surfaces that a move may leave.
//!
//! All of them, whether they are on the part or not: which one the end of a dexel is on, its place and normal tell. A
//! tool that stands leaves surfaces of revolution about its axis; one that moves straight without turning what its
//! pieces leave along the way; one that goes round its own direction surfaces of revolution about the arc's axis.
//! What other motions of tools with an outline leave, [`swept`] has.

use super::surfaces::{Piece, along, cross, cylinder, dot, plane, revolved_line, sphere, sub, torus, unit};
use super::swept::swept;
use sweepsim_motion::{Path, ProfileSegment, TipCourse, Tool, Turning};
use sweepsim_solid::{EllipticSheet, Surface};

/// Directions closer than this are the same.
const SAME: f64 = 1e-10;

/// The pieces of a tool, if it has an outline.
pub(super) fn pieces(tool: &Tool) -> Vec<Piece> {
    let Some(profile) = tool.profile() else {
        return Vec::new();
    };
    let mut all = Vec::new();
    let mut from = profile.start();
    for segment in profile.segments() {
        let end = match segment {
            ProfileSegment::Line { to } => {
                all.push(Piece::Line(from, *to));
                *to
            }
            ProfileSegment::Arc { to, centre, .. } => {
                all.push(arc(from, *to, *centre));
                *to
            }
            ProfileSegment::Spline { points, .. } => points.last().copied().unwrap_or(from),
            _ => continue,
        };
        if end[0] > 0.0 {
            all.push(Piece::Rim(end));
        }
        from = end;
    }
    all
}

/// An arc about the centre that is as far from both of its ends, as the outline has it.
fn arc(from: [f64; 2], to: [f64; 2], centre: [f64; 2]) -> Piece {
    let chord = [to[0] - from[0], to[1] - from[1]];
    let square = chord[0] * chord[0] + chord[1] * chord[1];
    let off = [0, 1].map(|k| from[k] + 0.5 * chord[k] - centre[k]);
    let shift = (off[0] * chord[0] + off[1] * chord[1]) / square;
    let centre = [0, 1].map(|k| centre[k] + shift * chord[k]);
    let far = |p: [f64; 2]| (p[0] - centre[0]).hypot(p[1] - centre[1]);
    Piece::Arc {
        centre,
        radius: 0.5 * (far(from) + far(to)),
    }
}

/// The surfaces that a move of a path may leave.
pub(super) fn left_by(tool: &[Piece], path: &Path, number: usize) -> Vec<Surface> {
    if number >= path.moves() {
        return Vec::new();
    }
    let (from, to, way) = (path.pose(number), path.pose(number + 1), path.way(number));
    let mut all = Vec::new();
    for pose in [from, to] {
        tool.iter()
            .for_each(|piece| all.extend(standing(*piece, pose.tip(), pose.axis())));
    }
    let still = match way.turning {
        Turning::Rotary { from, to, .. } => from == to,
        _ => true,
    };
    let axis = from.axis();
    let turned = cross(axis, to.axis());
    let is_carried = matches!(way.course, TipCourse::Carried(_));
    if is_carried || !still || dot(turned, turned) > SAME * SAME || dot(axis, to.axis()) < 0.0 {
        all.extend(swept(tool, path, number, false));
        return all;
    }
    match way.course {
        TipCourse::Straight | TipCourse::Carried(_) => {
            if let Some(ahead) = unit(sub(to.tip(), from.tip())) {
                tool.iter()
                    .for_each(|piece| all.extend(straight(*piece, from.tip(), axis, ahead)));
            }
        }
        TipCourse::Arc(arc) => {
            let arc = arc.through(from.tip(), to.tip());
            tool.iter()
                .for_each(|piece| all.extend(round(*piece, from.tip(), axis, arc.centre(), arc.normal())));
            let climb = dot(sub(to.tip(), from.tip()), arc.normal());
            if climb.abs() > SAME || 1.0 - dot(axis, arc.normal()).abs() > SAME * SAME {
                all.extend(swept(tool, path, number, true));
            }
        }
    }
    all
}

/// What a tool that stands leaves.
fn standing(piece: Piece, tip: [f64; 3], axis: [f64; 3]) -> Option<Surface> {
    match piece {
        Piece::Line(from, to) => revolved_line(tip, axis, from, to),
        Piece::Arc { centre, radius } if centre[0].abs() < 1e-12 * radius => {
            Some(sphere(along(tip, centre[1], axis), radius))
        }
        Piece::Arc { centre, radius } => torus(along(tip, centre[1], axis), axis, centre[0], radius),
        Piece::Rim(_) => None,
    }
}

/// What a tool leaves on a straight way.
fn straight(piece: Piece, tip: [f64; 3], axis: [f64; 3], ahead: [f64; 3]) -> Vec<Surface> {
    let slope = dot(axis, ahead);
    // Across the axis, straight ahead and to the left.
    let level = unit(along(ahead, -slope, axis)).filter(|_| slope.abs() < 1.0 - 1e-14);
    let mut all = Vec::new();
    match (piece, level) {
        (Piece::Line(from, to), Some(level)) => {
            let left = cross(axis, level);
            // Normals of the line's cone that are across the way, on both sides.
            let (out, up) = (to[0] - from[0], to[1] - from[1]);
            let size = out.hypot(up);
            let (radial, axial) = (up / size, -out / size);
            let forward = -axial * slope / (radial * dot(level, ahead));
            if radial.abs() > 1e-12 && forward.abs() <= 1.0 {
                let aside = (1.0 - forward * forward).sqrt();
                for side in [aside, -aside] {
                    let u = along(level.map(|c| c * forward), side, left);
                    let point = along(along(tip, from[1], axis), from[0], u);
                    all.extend(unit(along(u.map(|c| c * radial), axial, axis)).map(|n| plane(point, n)));
                }
            }
        }
        (Piece::Arc { centre, radius }, _) if centre[0].abs() < 1e-12 * radius => {
            all.extend(cylinder(along(tip, centre[1], axis), ahead, radius));
        }
        (Piece::Arc { centre, radius }, None) => {
            all.extend(cylinder(tip, axis, centre[0] + radius));
        }
        (Piece::Arc { centre, radius }, Some(level)) => {
            let middle = along(tip, centre[1], axis);
            let left = cross(axis, level);
            if slope.abs() < SAME {
                for side in [centre[0], -centre[0]] {
                    all.extend(cylinder(along(middle, side, left), ahead, radius));
                }
                all.extend([radius, -radius].map(|up| plane(along(middle, up, axis), axis)));
            } else {
                let sheet = EllipticSheet::swept(middle, axis, centre[0].abs(), ahead, radius);
                all.extend(sheet.map(Surface::Elliptic));
            }
        }
        (Piece::Rim([out, up]), level) => {
            let middle = along(tip, up, axis);
            if level.is_none() {
                all.extend(cylinder(tip, axis, out));
            } else if slope.abs() < SAME {
                all.push(plane(middle, axis));
            } else {
                let sheet = EllipticSheet::swept(middle, axis, out, ahead, 0.0);
                all.extend(sheet.map(Surface::Elliptic));
            }
        }
        (Piece::Line(..), None) => {}
    }
    all
}

/// What a tool leaves on an arc about an axis through a centre.
fn round(piece: Piece, tip: [f64; 3], axis: [f64; 3], centre: [f64; 3], normal: [f64; 3]) -> Vec<Surface> {
    let off = sub(tip, centre);
    let height = dot(off, normal);
    let arm = along(off, -height, normal);
    let radius = dot(arm, arm).sqrt();
    let cosine = dot(axis, normal);
    let mut all = Vec::new();
    if 1.0 - cosine.abs() < SAME * SAME + 1e-15 {
        // About the direction of the tool: heights above the tip are those along its axis.
        let point = along(centre, height, normal);
        for side in [1.0, -1.0] {
            match piece {
                Piece::Line([r, z], [s, w]) => {
                    let at = |r: f64| radius + side * r;
                    all.extend(revolved_line(point, axis, [at(r), z], [at(s), w]));
                }
                Piece::Arc {
                    centre: [r, z],
                    radius: tube,
                } => {
                    all.extend(torus(along(point, z, axis), axis, radius + side * r, tube));
                    all.push(plane(along(point, z - side * tube, axis), axis));
                }
                Piece::Rim([r, z]) => {
                    all.push(plane(along(point, z, axis), axis));
                    all.extend(cylinder(point, axis, (radius + side * r).abs()));
                }
            }
        }
        return all;
    }
    // Upright, or at any angle: a ball goes round, and a wall stays in its plane if the arc is in one through the axis.
    match piece {
        Piece::Arc {
            centre: [r, z],
            radius: tube,
        } if r.abs() < 1e-12 * tube => {
            let off = sub(along(tip, z, axis), centre);
            let height = dot(off, normal);
            let arm = along(off, -height, normal);
            all.extend(torus(along(centre, height, normal), normal, dot(arm, arm).sqrt(), tube));
        }
        Piece::Line([r, _], [s, _])
        | Piece::Arc {
            centre: [r, _],
            radius: s,
        } if cosine.abs() < SAME => {
            // The widest of the piece: of a side the radius, of a corner's torus its equator.
            let wide = if matches!(piece, Piece::Line(..)) {
                r.max(s)
            } else {
                r + s
            };
            all.extend([wide, -wide].map(|out| plane(along(tip, out, normal), normal)));
        }
        _ => {}
    }
    all
}
