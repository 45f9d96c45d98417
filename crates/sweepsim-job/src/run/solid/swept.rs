//! The surfaces that moves leave on which the tool turns or winds.

use super::surfaces::{Piece, along, cross, dot, sub};
use sweepsim_motion::{Path, TipCourse};
use sweepsim_solid::{Surface, SweptPiece, SweptSheet};

/// Parts into which a move may be divided, how near the parts are to its law, in millimetres, and how far from the tip.
const MOST_PARTS: usize = 8;
const DEVIATION: f64 = 1e-9;
const REACH: f64 = 100.0;

/// The surfaces that a move may leave, which is neither straight nor about the direction of the tool.
pub(super) fn swept(tool: &[Piece], path: &Path, number: usize, is_still: bool) -> Vec<Surface> {
    // On helices, walls are cylinders, and the sheets of rims fold all along them: their faces would hardly be found.
    let taken = |piece: &&Piece| !is_still || matches!(piece, Piece::Arc { .. });
    let pieces = tool.iter().filter(taken).flat_map(|piece| sweeping(*piece));
    let pieces: Vec<SweptPiece> = pieces.collect();
    let arc = match path.way(number).course {
        TipCourse::Arc(arc) if is_still => Some(arc),
        _ => None,
    };
    let sheets = match arc {
        Some(arc) => {
            let (from, to) = (path.pose(number), path.pose(number + 1));
            let arc = arc.through(from.tip(), to.tip());
            let (centre, normal) = (arc.centre(), arc.normal());
            let off = sub(from.tip(), centre);
            let start = along(off, -dot(off, normal), normal);
            let aside = cross(normal, start);
            let [low, high] = [from.tip(), to.tip()].map(|tip| dot(sub(tip, centre), normal));
            let at = |t: f64| {
                let (sin, cos) = (arc.angle() * t).sin_cos();
                let level = along(centre, low + (high - low) * t, normal);
                (along(along(level, cos, start), sin, aside), from.axis())
            };
            SweptSheet::all(&at, &pieces)
        }
        None => {
            let parts = path.segments_of_symmetric(number, REACH, DEVIATION);
            if parts.len() > MOST_PARTS {
                return Vec::new();
            }
            let all = parts.iter().flat_map(|part| {
                let at = |t: f64| {
                    let (turn, tip) = part.at(t);
                    (tip, turn.column(2).into_owned().into())
                };
                SweptSheet::all(&at, &pieces)
            });
            all.collect()
        }
    };
    sheets.into_iter().map(Surface::Swept).collect()
}

/// What a piece leaves on both sides of its way.
fn sweeping(piece: Piece) -> Vec<SweptPiece> {
    match piece {
        Piece::Line(from, to) => [true, false].map(|left| SweptPiece::Line { from, to, left }).into(),
        Piece::Arc { centre, radius } if centre[0].abs() < 1e-12 * radius => vec![SweptPiece::Ball {
            height: centre[1],
            radius,
        }],
        Piece::Arc { centre, radius } if centre[0] > 0.0 => {
            let torus = |upper| SweptPiece::Circle {
                at: centre,
                tube: radius,
                upper,
            };
            vec![torus(true), torus(false)]
        }
        Piece::Arc { .. } => Vec::new(),
        Piece::Rim(at) => vec![SweptPiece::Circle {
            at,
            tube: 0.0,
            upper: true,
        }],
    }
}
