//! Tools in free text, as programmers and posts write them: `(T3| 1/2 FLAT ENDMILL|H0)`, `( 1/4" DIA. 2 FLUTE E.M. )`, `(TOOL 5 - NO. 7 DRILL)`.
//!
//! Sizes: labelled ones first (`D=`, `DIA.`), then gauges of drills and taps, then the first number that says nothing else. Fractions and gauges are in inches; numbers with a unit are
//! what it says; others are in the program's unit, but for a mill or drill of more than two inches, which is one in millimetres. Gauges are those of ANSI: drills No. 1 to 80 and
//! letters (ASME B94.11M), screws No. 0 to 12 (0.060 + 0.013 n inches, ASME B1.1).

mod gauges;
mod kinds;
mod sizes;
mod words;

use crate::model::tool::{CutterKind, ToolDescription};
use kinds::Family;
use words::Words;

/// The longest comment that is looked at.
const LONGEST: usize = 300;
/// Points of spot drills and centre drills whose angle nobody says, and half of that of chamfer mills, in degrees: the commonest.
const SPOT: f64 = 90.0;
const CENTRE: f64 = 60.0;
const CHAMFER: f64 = 45.0;

/// A tool that a comment describes, and its number if it says one.
pub(super) struct Described {
    pub number: Option<u32>,
    pub tool: ToolDescription,
}

/// What a comment says of a tool. `unit` is in millimetres per unit of the program.
pub(super) fn read(comment: &str, unit: f64) -> Option<Described> {
    if comment.len() > LONGEST || !comment.bytes().any(|byte| byte.is_ascii_alphabetic()) {
        return None;
    }
    let mut words = Words::new(comment);
    let number = words.take_number();
    let family = kinds::family(&words);
    // Without a number it has to be a tool beyond doubt.
    if number.is_none() && (family.is_none() || words.is_prose()) {
        return None;
    }
    let mut tool = ToolDescription::default();
    let angle = words.take_angle(matches!(
        family,
        Some(Family::Spot | Family::Centre | Family::Chamfer | Family::Drill)
    ));
    let corner = words.take_corner();
    let lengths = words.take_lengths();
    let size = sizes::size(&words, family, unit, number.is_none())?;
    // A number alone is no tool: an operation may have one.
    let family = family.or(size.labelled.then_some(Family::Unknown))?;
    tool.diameter = Some(size.mm);
    tool.notes.extend(size.note);
    tool.flute_length = lengths.map(|length| length.mm(unit));
    let corner = corner.map(|corner| corner.mm(unit)).filter(|corner| *corner > 0.0);
    tool.kind = match family {
        Family::Ball => Some(CutterKind::Ball),
        Family::Bull => Some(CutterKind::Bull),
        Family::Mill if corner.is_some() => Some(CutterKind::Bull),
        Family::Mill | Family::Face | Family::Reamer => Some(CutterKind::Flat),
        Family::Tapered => Some(CutterKind::Tapered),
        Family::Chamfer => Some(CutterKind::Chamfer),
        Family::Drill | Family::Spot | Family::Centre => Some(CutterKind::Drill),
        Family::Lollipop => Some(CutterKind::Lollipop),
        Family::Dovetail => Some(CutterKind::Dovetail),
        Family::Tap => Some(CutterKind::Other("tap".into())),
        Family::ThreadMill => Some(CutterKind::Other("thread mill".into())),
        Family::Boring => Some(CutterKind::Other("boring bar".into())),
        Family::Probe => Some(CutterKind::Other("probe".into())),
        Family::Unknown => corner.map(|corner| match corner >= 0.5 * size.mm * (1.0 - 1e-3) {
            true => CutterKind::Ball,
            false => CutterKind::Bull,
        }),
    };
    if matches!(tool.kind, Some(CutterKind::Bull | CutterKind::Tapered)) {
        tool.corner_radius = corner;
    }
    let mut assume = |degrees: f64, what: &str| {
        tool.notes
            .push(format!("{what} of {degrees} degrees, which its comment does not say"));
        degrees
    };
    match family {
        Family::Spot => tool.point_angle = Some(angle.unwrap_or_else(|| assume(SPOT, "a point"))),
        Family::Centre => tool.point_angle = Some(angle.unwrap_or_else(|| assume(CENTRE, "a point"))),
        Family::Drill => tool.point_angle = angle,
        // Angles of 60 and more are between the flanks, smaller ones between axis and flank.
        Family::Chamfer => {
            let half = angle.map(|angle| if angle >= 60.0 { 0.5 * angle } else { angle });
            tool.taper_angle = Some(half.unwrap_or_else(|| assume(CHAMFER, "a flank")));
        }
        Family::Tapered | Family::Dovetail => tool.taper_angle = angle,
        _ => {}
    }
    tool.name = words.name();
    Some(Described { number, tool })
}

#[cfg(test)]
mod tests;
