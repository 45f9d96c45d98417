//! Drilling cycles.

use crate::drive::{HoleCycle, HoleWork, Pecks};
use crate::text::error::NcProblem;

/// `CYCLE81(RTP, RFP, SDIS, DP, DPR)` and its kin: with levels along the third axis of the plane.
pub(super) fn hole_cycle(name: &str, arguments: &[Option<f64>], unit: f64) -> Result<HoleCycle, NcProblem> {
    if !matches!(
        name,
        "CYCLE81" | "CYCLE82" | "CYCLE83" | "CYCLE84" | "CYCLE840" | "CYCLE85" | "CYCLE86" | "CYCLE89"
    ) {
        return Err(NcProblem::unsupported(
            format!("{name} is"),
            "expected CYCLE81, 82, 83, 84, 840, 85, 86 or 89, or the moves that it makes",
        ));
    }
    let get = |index: usize| arguments.get(index).copied().flatten();
    let length = |index: usize| get(index).map(|value| value * unit);
    let need = |index: usize, parameter: &str| {
        length(index).ok_or_else(|| NcProblem::syntax(format!("{name} without {parameter}: expected a number")))
    };
    let (retract, reference) = (need(0, "RTP")?, need(1, "RFP")?);
    let clearance = length(2).unwrap_or(0.0).abs();
    // The depth is absolute, or relative to the surface.
    let depth = match (length(3), length(4)) {
        (_, Some(relative)) if relative != 0.0 => reference - relative.abs(),
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
    let degression = length(7).unwrap_or(0.0).abs();
    let infeed = reference - first;
    let work = if name == "CYCLE83" && infeed > 0.0 {
        // Infeeds decrease to the degression, and not below it.
        HoleWork::Pecks(Pecks {
            first,
            infeed,
            decrease: degression,
            least: degression.max(1e-3),
            rounding: 0.0,
            dwells: true,
            clears: get(11) == Some(1.0),
            above: 1.0,
        })
    } else {
        HoleWork::Plunge
    };
    let dwell = match name {
        "CYCLE83" => get(8),
        "CYCLE81" | "CYCLE840" => None,
        _ => get(5),
    };
    let feeds_out = matches!(name, "CYCLE84" | "CYCLE840" | "CYCLE85" | "CYCLE89");
    Ok(HoleCycle {
        end: retract,
        work,
        ..HoleCycle::new(reference + clearance, depth, dwell, feeds_out)
    })
}
