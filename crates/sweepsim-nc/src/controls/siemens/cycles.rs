//! Drilling cycles.

use super::interpreter::Reader;
use crate::model::event::EventKind;
use crate::text::error::NcProblem;

/// The most infeeds of one hole.
const MOST_PECKS: usize = 10_000;

/// A drilling cycle, with lengths in millimetres along the third axis of the plane.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cycle {
    /// Where the tool returns to.
    retract: f64,
    /// The surface and the safety clearance above it.
    reference: f64,
    clearance: f64,
    depth: f64,
    dwell: f64,
    /// How the tool comes out: at the feed rather than rapidly.
    feeds_out: bool,
    /// The depth of the first infeed, by how much infeeds decrease, and whether the tool leaves the hole between them.
    pecks: Option<(f64, f64, bool)>,
}

impl Cycle {
    /// `CYCLE81(RTP, RFP, SDIS, DP, DPR)` and its kin.
    pub fn new(name: &str, arguments: &[Option<f64>], unit: f64) -> Result<Self, NcProblem> {
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
        let pecks = (name == "CYCLE83").then(|| {
            let first = match (length(5), length(6)) {
                (_, Some(relative)) if relative != 0.0 => reference - relative.abs(),
                (Some(first), _) => first,
                (None, _) => depth,
            };
            (first.max(depth), length(7).unwrap_or(0.0).abs(), get(11) == Some(1.0))
        });
        let dwell = match name {
            "CYCLE83" => get(8),
            "CYCLE81" | "CYCLE840" => None,
            _ => get(5),
        };
        Ok(Self {
            retract,
            reference,
            clearance,
            depth,
            dwell: dwell.unwrap_or(0.0).max(0.0),
            feeds_out: matches!(name, "CYCLE84" | "CYCLE840" | "CYCLE85" | "CYCLE89"),
            pecks,
        })
    }
}

impl Reader<'_> {
    /// Drills at the current place.
    pub(super) fn drill(&mut self, cycle: &Cycle) -> Result<(), NcProblem> {
        let Some(here) = self.track.known() else {
            if self.uncertain {
                return Ok(());
            }
            return Err(NcProblem::syntax(
                "a cycle at an unknown position: expected a move to X, Y and Z before it",
            ));
        };
        let w = self.modes.plane[2];
        let abc = self.track.abc;
        self.track.calls()?;
        let go = |reader: &mut Self, height: f64, rapid: bool| {
            let mut target = here;
            target[w] = height;
            reader.track.line(target, abc, rapid)
        };
        let above = cycle.reference + cycle.clearance;
        go(self, above, true)?;
        let (first, degression, leaves) = cycle.pecks.unwrap_or((cycle.depth, 0.0, false));
        let mut infeed = cycle.reference - first;
        let mut at = first;
        let mut pecks = 0;
        loop {
            go(self, at, false)?;
            if cycle.dwell > 0.0 {
                self.track.event(EventKind::Dwell { seconds: cycle.dwell })?;
            }
            pecks += 1;
            if at <= cycle.depth || infeed <= 0.0 {
                break;
            }
            if pecks >= MOST_PECKS {
                return Err(NcProblem::value("the number of infeeds of one hole", pecks, "smaller"));
            }
            // Infeeds decrease to the degression, and not below it.
            infeed = (infeed - degression).max(degression).max(1e-3);
            if leaves {
                go(self, above, true)?;
                go(self, at + 1.0_f64.min(infeed), true)?;
            } else {
                go(self, at + 1.0_f64.min(infeed), true)?;
            }
            at = (at - infeed).max(cycle.depth);
        }
        go(
            self,
            if cycle.feeds_out { above } else { cycle.retract },
            !cycle.feeds_out,
        )?;
        if cycle.feeds_out {
            go(self, cycle.retract, true)?;
        }
        self.track.returns();
        Ok(())
    }
}
