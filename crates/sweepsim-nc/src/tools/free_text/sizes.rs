//! The diameter that a comment says.

use super::gauges::{letter, screw, wire};
use super::kinds::Family;
use super::words::{Number, Piece, Words};

/// Bare numbers above which a tool of an inch program is one in millimetres, in inches: mills and drills, and what faces.
const WIDEST: [f64; 2] = [2.0, 8.0];
const INCH: f64 = 25.4;

/// A diameter.
pub(super) struct Size {
    pub mm: f64,
    /// Whether the comment says that it is one.
    pub labelled: bool,
    /// What was taken for granted.
    pub note: Option<String>,
}

impl Size {
    fn inches(inches: f64) -> Self {
        Self {
            mm: inches * INCH,
            labelled: false,
            note: None,
        }
    }
}

/// The diameter. `sure`: a number that says nothing of itself is none unless it stands first or has a point.
pub(super) fn size(words: &Words, family: Option<Family>, unit: f64, sure: bool) -> Option<Size> {
    let pieces = &words.pieces;
    let word = |at: usize| match pieces.get(at) {
        Some(Piece::Word(word)) => word.as_str(),
        _ => "",
    };
    let number = |at: usize| match pieces.get(at) {
        Some(Piece::Number(number)) => Some(*number),
        _ => None,
    };
    let of = |number: Number, labelled: bool| measured(number, family, unit, labelled);
    const NAMES: [&str; 7] = ["DIA", "DIAM", "DIAMETER", "DM", "DC", "DURCHMESSER", "PHI"];
    for at in 0..pieces.len() {
        if !NAMES.contains(&word(at)) || word(at + 1).starts_with("OFF") {
            continue;
        }
        let before = at.checked_sub(1).and_then(number);
        if let Some(number) = before.or_else(|| words.behind(at + 1).map(|(_, number)| number)) {
            return of(number, true);
        }
    }
    // `D=6`, `D10`.
    for at in 0..pieces.len() {
        if word(at) == "D"
            && let Some((place, number)) = words.behind(at + 1)
            && (place > at + 1 || family.is_some())
        {
            return of(number, true);
        }
    }
    match family {
        Some(Family::Tap | Family::ThreadMill) => {
            if let Some(found) = threaded(words, unit) {
                return Some(found);
            }
        }
        Some(Family::Drill | Family::Reamer | Family::Spot) => {
            for at in 0..pieces.len() {
                let gauge = match (word(at), &pieces[at]) {
                    ("NO" | "NUMBER" | "NUM" | "WIRE", _) | (_, Piece::Sign('#')) => words
                        .behind(at + 1)
                        .and_then(|(_, number)| wire(number.value).filter(|_| !number.point)),
                    ("LET" | "LETTER" | "LTR", _) => letter(word(at + 1)),
                    (one, _) if one.len() == 1 && word(at + 1).starts_with("DR") && !matches!(one, "U" | "T") => {
                        letter(one)
                    }
                    _ => None,
                };
                if let Some(gauge) = gauge {
                    return Some(Size::inches(gauge));
                }
            }
        }
        _ => {}
    }
    let first = pieces
        .iter()
        .position(|piece| !matches!(piece, Piece::Taken | Piece::Sign(_)));
    for at in 0..pieces.len() {
        let Some(number) = number(at) else { continue };
        let certain = number.unit.is_some() || number.point || first == Some(at) || word(at.wrapping_sub(1)) == "D";
        if number.value > 0.0 && (certain || !sure) {
            return of(number, number.unit.is_some() && family.is_some());
        }
    }
    None
}

/// The diameter that a number is.
fn measured(number: Number, family: Option<Family>, unit: f64, labelled: bool) -> Option<Size> {
    if !(number.value > 0.0) {
        return None;
    }
    let widest = WIDEST[usize::from(family == Some(Family::Face))];
    let metric = number.unit.is_none() && unit == INCH && number.value > widest;
    let note = metric.then(|| {
        format!(
            "{} in its comment is taken as millimetres: it would be wide for inches",
            number.value
        )
    });
    Some(Size {
        mm: if metric { number.value } else { number.mm(unit) },
        labelled,
        note,
    })
}

/// The outer diameter of a thread: `M6X1`, `1/4-20`, `10-32`, `#10-32`, `4.00-0.7`.
fn threaded(words: &Words, unit: f64) -> Option<Size> {
    let pieces = &words.pieces;
    for (at, piece) in pieces.iter().enumerate() {
        let Piece::Number(number) = piece else { continue };
        let before = at.checked_sub(1).map(|before| &pieces[before]);
        if matches!(before, Some(Piece::Word(word)) if word == "M") {
            return Some(Size {
                mm: number.value,
                labelled: true,
                note: None,
            });
        }
        let numbered =
            matches!(before, Some(Piece::Sign('#'))) || matches!(before, Some(Piece::Word(word)) if word == "NO");
        let pitch = match (pieces.get(at + 1), pieces.get(at + 2)) {
            (Some(Piece::Sign('-')), Some(Piece::Number(pitch))) => Some(*pitch),
            (Some(Piece::Word(x)), Some(Piece::Number(pitch))) if x == "X" => Some(*pitch),
            _ => None,
        };
        if number.unit.is_some() {
            return Some(Size {
                mm: number.mm(unit),
                labelled: true,
                note: None,
            });
        }
        match pitch {
            // A pitch in millimetres is a small number; in threads an inch it is not.
            Some(pitch) if pitch.point && pitch.value < 8.0 => {
                return Some(Size {
                    mm: number.value,
                    labelled: true,
                    note: None,
                });
            }
            Some(pitch) if !number.point && pitch.value >= 8.0 => return screw(number.value).map(Size::inches),
            _ if numbered => return screw(number.value).map(Size::inches),
            _ => {}
        }
    }
    None
}
