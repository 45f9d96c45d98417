//! Drilling cycles.

use super::arguments::Arguments;
use crate::drive::{HoleCycle, HoleWork, Pecks, WayOut};
use crate::model::event::{EventKind, Spindle};
use crate::text::error::NcProblem;

/// The drilling cycles.
pub(in crate::controls::siemens) const HOLES: [&str; 10] = [
    "CYCLE81", "CYCLE82", "CYCLE83", "CYCLE84", "CYCLE840", "CYCLE85", "CYCLE86", "CYCLE87", "CYCLE88", "CYCLE89",
];

/// `CYCLE81(RTP, RFP, SDIS, DP, DPR)` and its kin: with levels along the third axis of the plane.
pub(in crate::controls::siemens) fn hole_cycle(arguments: &Arguments) -> Result<HoleCycle, NcProblem> {
    let (name, unit) = (arguments.name, arguments.unit);
    let get = |index: usize| arguments.get(index);
    let length = |index: usize| get(index).map(|value| value * unit);
    let (retract, reference) = (arguments.need(0, "RTP")?, arguments.need(1, "RFP")?);
    let clearance = length(2).unwrap_or(0.0).abs();
    // The depth is absolute, or relative to the surface.
    let depth = match (length(3), length(4)) {
        (_, Some(relative)) if relative != 0.0 => reference - relative.abs(),
        (Some(depth), _) if arguments.is_relative() => reference - depth.abs(),
        (Some(depth), _) => depth,
        (None, _) => {
            return Err(NcProblem::syntax(format!(
                "{name} without DP or DPR: expected the depth"
            )));
        }
    };
    if depth > reference {
        return Err(NcProblem::value(
            format!("the depth of {name}"),
            depth,
            format!("below the reference plane at {reference}"),
        ));
    }
    let first = match (length(5), length(6)) {
        (_, Some(relative)) if relative != 0.0 => reference - relative.abs(),
        (Some(first), _) => first,
        (None, _) => depth,
    };
    // Negative, it is a factor: how many infeeds there are changes nothing that is left.
    let degression = length(7).unwrap_or(0.0).max(0.0);
    let infeed = reference - first;
    let work = if name == "CYCLE83" && infeed > 0.0 {
        // Infeeds decrease to the degression, and not below it.
        HoleWork::Pecks(Pecks {
            first,
            infeed,
            decrease: degression,
            least: degression.max(1e-3),
            rounding: 1e-9,
            dwells: true,
            clears: get(11) == Some(1.0),
            above: 1.0,
        })
    } else {
        HoleWork::Plunge
    };
    let dwell = match name {
        "CYCLE83" => arguments.dwell(8),
        "CYCLE81" | "CYCLE840" | "CYCLE87" => None,
        _ => arguments.dwell(5),
    };
    let feeds_out = matches!(name, "CYCLE84" | "CYCLE840" | "CYCLE85" | "CYCLE89");
    let mut hole = HoleCycle {
        end: retract,
        work,
        ..HoleCycle::new(reference + clearance, depth, dwell, feeds_out)
    };
    if matches!(name, "CYCLE87" | "CYCLE88") {
        // The operator goes on; the tool comes out in rapid.
        hole.at_bottom
            .extend([EventKind::Spindle(Spindle::Stopped), EventKind::Stop]);
    }
    if name == "CYCLE85" {
        // FFR and RFF: the feeds down and up.
        hole.feed = arguments.feed(6);
        hole.out = WayOut::FeedToStart(arguments.feed(7));
    }
    Ok(hole)
}

/// `CYCLE70(RTP, RFP, SDIS, DP, DIATH, H1, FAL, PIT, NT, MID, FFR, TYPTH, PA, PO, …)`: a thread by a mill, within a hole or (`TYPTH` 1) around a stud, at `PA`, `PO`;
/// `CYCLE78(RTP, RFP, SDIS, DP, ADPR, FDPR, LDPR, DIAM, PIT, PITA, …)`: a hole that is drilled and threaded by the same tool. The helix is made over the whole depth.
pub(in crate::controls::siemens) fn thread(arguments: &Arguments, tool: f64) -> Result<Vec<HoleCycle>, NcProblem> {
    let name = arguments.name;
    let get = |index: usize| arguments.get(index);
    let need = |index: usize, parameter: &str| arguments.need(index, parameter);
    let [retract, start, surface, bottom] = arguments.levels(None)?;
    let mills = name == "CYCLE70";
    let diameter = need(if mills { 4 } else { 7 }, "the diameter")?.abs();
    let pitch = need(if mills { 7 } else { 8 }, "PIT")?.abs();
    let outside = mills && get(11) == Some(1.0);
    let radius = match outside {
        true => 0.5 * diameter - need(5, "H1")?.abs() + tool,
        false => 0.5 * diameter - tool,
    };
    if !(radius > 0.0 && pitch > 0.0 && bottom < surface) {
        let found = format!(
            "{diameter} mm wide, {} mm deep, with a pitch of {pitch} mm",
            surface - bottom
        );
        let expected = format!(
            "wider than the tool, {} mm, below its surface, with a pitch",
            2.0 * tool
        );
        return Err(NcProblem::value(format!("the thread of {name}"), found, expected));
    }
    let hole = HoleCycle {
        end: retract,
        feed: arguments.feed(if mills { 10 } else { 15 }),
        ..HoleCycle::new(start, bottom, None, false)
    };
    let around = HoleCycle {
        work: HoleWork::Helix {
            radius,
            turns: (start - bottom) / pitch,
            outside,
        },
        ..hole.clone()
    };
    Ok(if mills { vec![around] } else { vec![hole, around] })
}
