//! Drilling, boring, tapping and thread milling.
//!
//! Sources: *TNC 620, Cycle Programming* (340 56x-02), chapters 3 and 4. Of thread milling the helix is made over the whole depth, and the hole before it; countersinks at the front
//! are left out.

use crate::controls::heidenhain::interpreter::Reader;
use crate::controls::heidenhain::language::line::Line;
use crate::controls::heidenhain::state::Defined;
use crate::drive::{HoleCycle, HoleWork, Pecks, UNKNOWN_TOOL, WayOut};
use crate::text::assumption::Assumption;
use crate::text::error::{Located, NcProblem};

/// By how much cycle 202 leaves the wall, in mm.
const FROM_THE_WALL: f64 = 0.2;

impl Reader<'_> {
    /// What one of the cycles 200 to 209, 240, 241, 262 to 265 and 267 makes.
    pub(in crate::controls::heidenhain) fn holes(
        &mut self,
        number: u32,
        line: &Line,
    ) -> Result<Vec<HoleCycle>, Located> {
        let tool = match number {
            208 | 262..=267 => {
                let width = self.defined(number, line).span(335)?;
                self.cutter_radius(UNKNOWN_TOOL.min(0.5 * width))
            }
            _ => None,
        };
        if matches!(number, 200 | 203 | 205 | 241) && self.defined(number, line).number(395)? == 1.0 {
            let what = format!("how deep the point of the drill is below the depth of cycle {number} (Q395=1)");
            let taken = "not at all: the depth is that of the point";
            self.track.assume(Assumption::new(what, taken, "Q395=0"));
        }
        let defined = self.defined(number, line);
        let hole = hole(&defined, tool)?;
        let front = defined.find(359)?.is_some_and(|_| matches!(number, 263..=267)) && defined.span(358)? != 0.0;
        if front {
            self.track.note(format!(
                "the countersink at the front (Q358) of cycle {number} is left out"
            ));
        }
        Ok(hole)
    }
}

/// The direction of `Q214`.
fn direction(defined: &Defined) -> Result<Option<[f64; 2]>, Located> {
    Ok(match defined.number(214)? {
        0.0 => None,
        1.0 => Some([-1.0, 0.0]),
        2.0 => Some([0.0, -1.0]),
        3.0 => Some([1.0, 0.0]),
        4.0 => Some([0.0, 1.0]),
        other => {
            let what = format!("Q214 of cycle {}", defined.number);
            return Err(defined.fail(NcProblem::value(what, other, "0, 1, 2, 3 or 4")));
        }
    })
}

fn hole(defined: &Defined, tool: Option<f64>) -> Result<Vec<HoleCycle>, Located> {
    let number = defined.number;
    let clearance = defined.need(200)?.abs();
    let aside = direction(defined)?;
    let surface = defined.span(203)?;
    let start = surface + clearance;
    let dwell = match number {
        204 => defined.find(255)?,
        208 | 262..=267 => None,
        _ => defined.find(211)?,
    };
    // The bottom is given below.
    let mut hole = HoleCycle::new(start, start, dwell, false);
    hole.end = start.max(surface + defined.span(204)?);
    if number == 204 {
        back_boring(defined, &mut hole, aside, surface, clearance)?;
        return Ok(vec![hole]);
    }
    let depth = match number {
        // As deep as the cone of a point of 90 degrees is wide.
        240 if defined.find(343)? == Some(1.0) => {
            let depth = -0.5 * defined.need(344)?.abs();
            if depth == 0.0 { defined.depth(201)? } else { depth }
        }
        _ => defined.depth(201)?,
    };
    hole.bottom = surface + depth;
    hole.feed = defined.feed(206)?;
    hole.out = WayOut::RapidToStart;
    let pecks = |infeed: f64, [decrease, least]: [f64; 2]| {
        HoleWork::Pecks(Pecks {
            first: surface - infeed,
            infeed,
            decrease,
            least: least.max(1e-3),
            clears: true,
            above: clearance.min(1.0),
            rounding: 1e-9,
            ..Pecks::default()
        })
    };
    let infeed = defined.length(202)?.filter(|infeed| *infeed > 0.0);
    match number {
        200 | 203 | 205 => {
            if let Some(infeed) = infeed {
                // Without a least infeed they decrease to the decrement: no shorter ones are known of.
                let decrement = defined.span(212)?.max(0.0);
                let least = defined.length(205)?.filter(|least| *least > 0.0);
                hole.work = pecks(infeed, [decrement, least.unwrap_or(decrement)]);
            }
            if let (203, Some(out)) = (number, defined.feed(208)?.filter(|feed| *feed > 0.0)) {
                hole.out = WayOut::FeedToStart(Some(out));
            }
        }
        208 | 262..=267 => {
            let mut all = Vec::new();
            // The hole before the thread: drilled, or at once by the thread mill.
            if let (263 | 264, Some(deep)) = (number, defined.length(356)?.filter(|deep| *deep < 0.0)) {
                let mut before = HoleCycle {
                    bottom: surface + deep,
                    ..hole.clone()
                };
                if let (264, Some(infeed)) = (number, infeed) {
                    before.work = pecks(infeed, [0.0; 2]);
                }
                all.push(before);
            }
            hole.feed = hole.feed.or(defined.feed(207)?);
            hole.work = helix(defined, tool, &hole)?;
            all.push(hole);
            return Ok(all);
        }
        // Out in rapid.
        240 => {}
        // Boring, reaming and tapping.
        _ => {
            if let (207 | 209, Some(speed)) = (number, defined.speed) {
                let pitch = defined.need(239)?.abs() / defined.unit;
                hole.feed = Some(if defined.per_revolution { pitch } else { pitch * speed });
            }
            let out = defined.feed(208)?.filter(|feed| *feed > 0.0);
            hole.out = WayOut::FeedToStart(out);
            if number == 202 {
                hole.aside = aside.unwrap_or_default().map(|c| c * FROM_THE_WALL);
            }
        }
    }
    Ok(vec![hole])
}

/// Cycle 204.
fn back_boring(
    defined: &Defined,
    hole: &mut HoleCycle,
    aside: Option<[f64; 2]>,
    surface: f64,
    clearance: f64,
) -> Result<(), Located> {
    let Some(aside) = aside else {
        let problem = NcProblem::syntax("cycle 204 without a direction beside the middle: expected Q214=1, 2, 3 or 4");
        return Err(defined.fail(problem));
    };
    let [depth, thickness, off, edge] = [249, 250, 251, 252].map(|parameter| defined.need(parameter));
    let (depth, thickness, off, edge) = (depth?, thickness?, off?, edge?);
    if !(depth > 0.0 && thickness > 0.0) {
        let found = format!("{depth} and {thickness}");
        return Err(defined.fail(NcProblem::value("Q249 and Q250 of cycle 204", found, "positive")));
    }
    hole.bottom = surface + (-thickness - clearance - edge);
    hole.feed = defined.feed(253)?;
    hole.aside = aside.map(|c| c * off);
    hole.work = HoleWork::Back {
        up: surface + (-thickness + depth - edge),
        feed: defined.feed(254)?,
        rapid: false,
    };
    Ok(())
}

/// Around in the hole (208, 262 to 265), or around the stud (267).
fn helix(defined: &Defined, tool: Option<f64>, hole: &HoleCycle) -> Result<HoleWork, Located> {
    let number = defined.number;
    let (diameter, pitch) = (defined.need(335)?, defined.need(if number == 208 { 334 } else { 239 })?);
    let Some(tool) = tool else {
        return Err(defined.fail(NcProblem::syntax(format!(
            "the radius of the tool of cycle {number} is not known: expected it in the tool table, or TOOL DEF … R"
        ))));
    };
    let outside = number == 267;
    let radius = if outside {
        0.5 * diameter + tool
    } else {
        0.5 * diameter - tool
    };
    if !(radius > 0.0 && pitch != 0.0) {
        let problem = NcProblem::value(
            format!("the hole of cycle {number}"),
            format!("{diameter} mm wide, with an infeed of {} mm", pitch.abs()),
            format!("wider than the tool, {} mm, with a positive infeed", 2.0 * tool),
        );
        return Err(defined.fail(problem));
    }
    let sense = if defined.find(351)? == Some(-1.0) { -1.0 } else { 1.0 };
    let sense = if outside { -sense } else { sense };
    let turns = sense * ((hole.start - hole.bottom) / pitch.abs());
    Ok(HoleWork::Helix { radius, turns, outside })
}
