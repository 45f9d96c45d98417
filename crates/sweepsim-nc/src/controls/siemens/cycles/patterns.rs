//! Patterns of places where a cycle is called.
//!
//! Sources: as of [`milling`](super::milling); CYCLE801 was compared with two other readers.

use super::arguments::Arguments;
use super::milling::MOST_PLACES;
use crate::controls::siemens::interpreter::Reader;
use crate::controls::siemens::state::Modal;
use crate::text::assumption::Assumption;
use crate::text::error::NcProblem;

/// Where the modal cycle is called.
pub(in crate::controls::siemens) const PATTERNS: [&str; 3] = ["HOLES1", "HOLES2", "CYCLE801"];

/// `HOLES1(SPCA, SPCO, STA1, FDIS, DBH, NUM)`, `HOLES2(CPA, CPO, RAD, STA1, INDA, NUM)`, `CYCLE801(SPCA, SPCO, STA, DIS1, DIS2, NUM1, NUM2)`: places in the plane; `None` for others.
fn pattern(arguments: &Arguments) -> Option<Result<Vec<[f64; 2]>, NcProblem>> {
    let name = arguments.name;
    let count = |index: usize| {
        let count = arguments.get(index).unwrap_or(1.0);
        NcProblem::whole(
            format!("the number of places of {name}"),
            count,
            1..=MOST_PLACES,
            "a whole number from 1 on",
        )
    };
    let (x, y) = (arguments.length(0), arguments.length(1));
    let turned = |angle: f64, a: f64, b: f64| {
        let (sin, cos) = angle.to_radians().sin_cos();
        [x + a * cos - b * sin, y + a * sin + b * cos]
    };
    let angle = |index: usize| arguments.get(index).unwrap_or(0.0);
    Some(match name {
        "HOLES1" => count(5).map(|count| {
            let (first, step) = (arguments.length(3), arguments.length(4));
            (0..count)
                .map(|k| turned(angle(2), first + f64::from(k) * step, 0.0))
                .collect()
        }),
        "HOLES2" => count(5).map(|count| {
            let step = arguments
                .get(4)
                .filter(|step| *step != 0.0)
                .unwrap_or(360.0 / f64::from(count));
            let radius = arguments.length(2);
            (0..count)
                .map(|k| turned(angle(3) + f64::from(k) * step, radius, 0.0))
                .collect()
        }),
        "CYCLE801" => count(5).and_then(|columns| {
            let rows = count(6)?;
            if columns.saturating_mul(rows) > MOST_PLACES {
                return Err(NcProblem::value(
                    "the number of places of CYCLE801",
                    columns * rows,
                    "at most 10000",
                ));
            }
            let (across, along) = (arguments.length(3), arguments.length(4));
            let place = |k: u32| {
                let (row, column) = (k / columns, k % columns);
                // To and fro.
                let column = if row % 2 == 0 { column } else { columns - 1 - column };
                turned(angle(2), f64::from(column) * across, f64::from(row) * along)
            };
            Ok((0..columns * rows).map(place).collect())
        }),
        _ => return None,
    })
}

impl Reader<'_> {
    /// A pattern: the modal cycle at each of its places.
    pub(in crate::controls::siemens) fn places(&mut self, arguments: &Arguments) -> Result<bool, NcProblem> {
        let name = arguments.name;
        let Some(places) = pattern(arguments) else {
            return Ok(false);
        };
        let places = places?;
        let Some(Modal::Cycle(cycle)) = self.modes.modal_call.clone() else {
            let taken = "no cycle is modal: it moves nothing";
            self.track
                .assume(Assumption::new(format!("what {name} calls"), taken, "MCALL before it"));
            return Ok(true);
        };
        for place in places {
            self.go_to_place(place, f64::NEG_INFINITY)?;
            self.track.cycle_here(&cycle, self.modes.plane, self.uncertain)?;
        }
        Ok(true)
    }

    /// In rapid over a place, not below a level.
    pub(in crate::controls::siemens) fn go_to_place(&mut self, [a, b]: [f64; 2], level: f64) -> Result<(), NcProblem> {
        let [u, v, w] = self.modes.plane;
        let Some(mut at) = self.track.known() else {
            // The cycle says from where it begins.
            (self.track.xyz[u], self.track.xyz[v]) = (Some(a), Some(b));
            return Ok(());
        };
        if at[w] < level {
            at[w] = level;
            self.track.line(at, self.track.abc, true)?;
        }
        (at[u], at[v]) = (a, b);
        self.track.line(at, self.track.abc, true)
    }
}
