//! Statements that hold everywhere, or do not, with their places.

use super::program::Programs;
use crate::base::words::{about, capital, extreme};
use sweepsim_formats::{OpenPlace, Report, Statement, StatementState};
use sweepsim_report::{Finding, measure};

/// As many open places of a statement are shown.
const OPEN: usize = 20;

/// Tells the time of a part of a move.
type Clock<'a> = &'a dyn Fn(usize, usize, f64) -> Option<f64>;

/// All statements; those without a place are in the verdict alone.
pub(super) fn proofs(report: &Report, programs: &Programs, clock: Clock) -> Vec<Finding> {
    let mut all = Vec::new();
    for statement in report.statements.iter().flatten() {
        all.extend(known(statement, programs, clock));
        let open = statement.open.iter().take(OPEN);
        all.extend(open.map(|place| unknown(statement, place, programs, clock)));
    }
    all
}

/// The place where the extreme of a statement is attained.
fn known(statement: &Statement, programs: &Programs, clock: Clock) -> Option<Finding> {
    let witness = statement.witness.as_ref()?;
    let state = match statement.state {
        StatementState::Proven => "proven",
        StatementState::Refuted => "refuted",
        _ => "open",
    };
    let title = format!(
        "{}: {state}; the {} known place",
        about(statement),
        extreme(statement.measure)
    );
    let [least, most] = statement.enclosure.map(|end| match end < f64::MAX {
        true => format!("{} mm", measure(end)),
        false => "not known".to_owned(),
    });
    let mut facts = vec![
        ("At least".to_owned(), least),
        ("At most".to_owned(), most),
        ("Limit".to_owned(), format!("{} mm", measure(statement.limit))),
    ];
    facts.extend(witness.body.iter().map(|body| ("Body".to_owned(), body.clone())));
    let place = witness.file.as_deref().zip(witness.line);
    Some(Finding {
        title: capital(&title),
        kind: state.to_owned(),
        place: witness.place,
        clock: witness
            .path
            .zip(witness.r#move)
            .and_then(|(path, number)| clock(path, number, witness.time)),
        facts,
        excerpt: place.and_then(|(file, line)| programs.excerpt(file, line)),
    })
}

/// A box in which it is not known whether a statement holds: its middle.
fn unknown(statement: &Statement, open: &OpenPlace, programs: &Programs, clock: Clock) -> Finding {
    let size = |k: usize| measure(open.r#box[k + 3] - open.r#box[k]);
    let [dx, dy, dz] = [0, 1, 2].map(size);
    let facts = vec![("Box".to_owned(), format!("{dx} × {dy} × {dz} mm"))];
    let place = open.file.as_deref().zip(open.line);
    Finding {
        title: capital(&format!("{}: not known here", about(statement))),
        kind: "open".to_owned(),
        place: [0, 1, 2].map(|k| 0.5 * (open.r#box[k] + open.r#box[k + 3])),
        clock: open
            .path
            .zip(open.r#move)
            .and_then(|(path, number)| clock(path, number, open.time[0])),
        facts,
        excerpt: place.and_then(|(file, line)| programs.excerpt(file, line)),
    }
}
