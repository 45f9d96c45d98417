//! The words and numbers of a comment.

/// A piece of a comment.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Piece {
    Word(String),
    Number(Number),
    Sign(char),
    /// Says something else than a size.
    Taken,
}

/// A number with what stands behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Number {
    pub value: f64,
    /// Millimetres per unit, if it says it; fractions are in inches.
    pub unit: Option<f64>,
    pub fraction: bool,
    /// Whether it is written with a point.
    pub point: bool,
}

impl Number {
    pub fn mm(&self, unit: f64) -> f64 {
        self.value * self.unit.unwrap_or(unit)
    }
}

/// The pieces of a comment, in capitals, and the comment itself.
pub(super) struct Words {
    pub pieces: Vec<Piece>,
    text: String,
}

/// Words that say of the number before them that it is no size.
const AFTER: [&str; 24] = [
    "FL", "FLT", "FLTS", "FLUTE", "FLUTES", "F", "LOC", "LONG", "LG", "OAL", "PITCH", "TPI", "RPM", "SFM", "IPM", "XD",
    "SHANK", "SHK", "INSERTS", "TEETH", "REACH", "HRC", "OOH", "PL",
];
/// Words that say of the number behind them that it is no size.
const BEFORE: [&str; 26] = [
    "H", "S", "F", "L", "Z", "ZMIN", "OFF", "OFFSET", "LEN", "LENGTH", "LOC", "LCF", "OAL", "TL", "LONG", "REACH",
    "STICKOUT", "OUT", "OP", "N", "SFM", "RPM", "PITCH", "SHANK", "HOLDER", "REV",
];
/// Words of comments about operations, not tools.
const PROSE: [&str; 22] = [
    "HOLE",
    "HOLES",
    "PLACES",
    "PLCS",
    "PLC",
    "POCKET",
    "POCKETS",
    "PART",
    "PARTS",
    "SIDE",
    "CONTOUR",
    "PROFILE",
    "OPERATION",
    "BOSS",
    "STOCK",
    "FINISHED",
    "TO",
    "THE",
    "USE",
    "CHANGE",
    "WITH",
    "AND",
];

impl Words {
    /// The fields of a comment that are about the tool.
    pub fn new(comment: &str) -> Self {
        let field = |field: &&str| {
            let upper = field.trim().to_ascii_uppercase();
            let register = upper.len() > 1
                && upper.starts_with(['H', 'D'])
                && upper[1..].bytes().all(|byte| byte.is_ascii_digit());
            !register && !upper.contains("STOCK TO LEAVE") && !upper.starts_with("WEAR") && !upper.starts_with("ZMIN")
        };
        let text = comment.split('|').filter(field).collect::<Vec<_>>().join("|");
        let pieces = pieces(&text.to_ascii_uppercase());
        let text = text.trim_matches(|c: char| c == '|' || c.is_whitespace()).to_owned();
        Self { pieces, text }
    }

    pub fn words(&self) -> impl Iterator<Item = &str> {
        self.pieces.iter().filter_map(|piece| match piece {
            Piece::Word(word) => Some(word.as_str()),
            _ => None,
        })
    }

    pub fn has(&self, list: &[&str]) -> bool {
        self.words().any(|word| list.contains(&word))
    }

    pub fn is_prose(&self) -> bool {
        self.has(&PROSE)
    }

    /// The comment without the number of the tool.
    pub fn name(&self) -> Option<String> {
        let text = self.text.split(['|']).map(str::trim).filter(|field| !field.is_empty());
        let joined = text.collect::<Vec<_>>().join(" ");
        let joined = joined.split_whitespace().collect::<Vec<_>>().join(" ");
        (!joined.is_empty()).then_some(joined)
    }

    fn word(&self, at: usize) -> Option<&str> {
        match self.pieces.get(at) {
            Some(Piece::Word(word)) => Some(word),
            _ => None,
        }
    }

    fn number(&self, at: usize) -> Option<Number> {
        match self.pieces.get(at) {
            Some(Piece::Number(number)) => Some(*number),
            _ => None,
        }
    }

    /// The number behind a word, past `=`, `:`, `-`, `.` and `#`.
    pub fn behind(&self, mut at: usize) -> Option<(usize, Number)> {
        while matches!(self.pieces.get(at), Some(Piece::Sign('=' | ':' | '-' | '#' | '.'))) {
            at += 1;
        }
        Some((at, self.number(at)?))
    }

    /// The number of the tool, and takes it away: `T3`, `TOOL 3`, `TOOL #3`, `TOOL NO. 3`.
    pub fn take_number(&mut self) -> Option<u32> {
        let places: Vec<usize> = (0..self.pieces.len()).collect();
        let found = places.into_iter().find_map(|at| {
            let after = match self.word(at)? {
                "T" if at == 0 || at + 2 == self.pieces.len() => at + 1,
                "TOOL" | "WERKZEUG" => match self.word(at + 1) {
                    Some("NO" | "NUMBER" | "NR" | "NUM") => at + 2,
                    _ => at + 1,
                },
                _ => return None,
            };
            let (last, number) = self.behind(after)?;
            let whole = number.unit.is_none() && !number.fraction && number.value.fract() == 0.0;
            (whole && (0.0..=99_999_999.0).contains(&number.value)).then_some((at, last, number.value as u32))
        });
        let (first, last, number) = found?;
        self.pieces[first..=last].fill(Piece::Taken);
        if first == 0 {
            // What stands before the description.
            let rest = self
                .text
                .find(|c: char| c.is_ascii_digit())
                .map_or("", |at| &self.text[at..]);
            let rest = rest.trim_start_matches(|c: char| c.is_ascii_digit());
            self.text = rest
                .trim_start_matches(|c: char| " |:=-,./".contains(c) && c != '.')
                .to_owned();
        }
        Some(number)
    }

    /// An angle in degrees, and takes it away. `pointed`: the tool ends in a cone, whose angle stands behind its size.
    pub fn take_angle(&mut self, pointed: bool) -> Option<f64> {
        for at in 0..self.pieces.len() {
            let Some(number) = self.number(at) else { continue };
            let degrees = matches!(self.word(at + 1), Some(word) if word.starts_with("DEG") || word == "GRAD")
                || self.pieces.get(at + 1) == Some(&Piece::Sign('°'));
            let named = at > 0 && self.labels(at, &["ANGLE", "ANG", "TAPER", "SIG", "POINT"]);
            let across = pointed
                && at > 0
                && (self.word(at - 1) == Some("X") || self.pieces[at - 1] == Piece::Sign('-'))
                && [60.0, 82.0, 90.0, 100.0, 118.0, 120.0, 130.0, 135.0, 140.0, 142.0].contains(&number.value);
            if (degrees || named || across) && number.value > 0.0 && number.value <= 180.0 {
                self.pieces[at] = Piece::Taken;
                return Some(number.value);
            }
        }
        None
    }

    /// Whether one of these words stands before a number, past signs.
    fn labels(&self, at: usize, words: &[&str]) -> bool {
        let mut before = at;
        while before > 0 && matches!(self.pieces[before - 1], Piece::Sign('=' | ':' | '-' | '.')) {
            before -= 1;
        }
        before > 0 && self.word(before - 1).is_some_and(|word| words.contains(&word))
    }

    /// The radius of a corner, and takes it away.
    pub fn take_corner(&mut self) -> Option<Number> {
        const NAMES: [&str; 6] = ["R", "CR", "RAD", "RADIUS", "RE", "RC"];
        for at in 0..self.pieces.len() {
            let Some(number) = self.number(at) else { continue };
            let behind = self.word(at + 1).is_some_and(|word| NAMES.contains(&word));
            let corner = self.word(at + 1) == Some("CORNER");
            // A label stands right before it: "CR CARBIDE 1/2" is none.
            if behind && self.behind(at + 2).is_none() || corner || self.labels(at, &NAMES) {
                self.pieces[at] = Piece::Taken;
                return Some(number);
            }
        }
        None
    }

    /// The length of the flutes; takes away all numbers that are no size.
    pub fn take_lengths(&mut self) -> Option<Number> {
        let mut flutes = None;
        for at in 0..self.pieces.len() {
            let Some(number) = self.number(at) else { continue };
            let after = self.word(at + 1);
            let is_flutes = matches!(after, Some("LOC")) || self.labels(at, &["LOC", "LCF", "AP"]);
            if is_flutes || after.is_some_and(|word| AFTER.contains(&word)) || self.labels(at, &BEFORE) {
                flutes = flutes.or(is_flutes.then_some(number));
                self.pieces[at] = Piece::Taken;
            }
        }
        flutes.filter(|length| length.value > 0.0)
    }
}

/// Takes a comment apart. Letters with points between are one word: `E.M.`.
fn pieces(text: &str) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let mut rest = text;
    while let Some(next) = rest.chars().next() {
        if next.is_ascii_digit() || next == '.' && rest[1..].starts_with(|c: char| c.is_ascii_digit()) {
            // T8 1/2 is no tool 8.5.
            let mixed = pieces.iter().any(|piece| matches!(piece, Piece::Number(_)))
                || !pieces
                    .iter()
                    .any(|piece| matches!(piece, Piece::Word(word) if matches!(word.as_str(), "T" | "TOOL")));
            let (number, length) = number(rest, mixed);
            pieces.push(number.map_or(Piece::Taken, Piece::Number));
            rest = &rest[length..];
        } else if next.is_alphabetic() {
            let mut word = String::new();
            let mut length = 0;
            let mut characters = rest.char_indices().peekable();
            while let Some((at, c)) = characters.next() {
                let joins = c == '.'
                    && word.chars().count() == 1
                    && characters.peek().is_some_and(|(_, next)| next.is_alphabetic());
                if !(c.is_alphabetic() || joins || c == '.' && word.len() > 1 && text_is_initials(&word, rest)) {
                    break;
                }
                length = at + c.len_utf8();
                if c != '.' {
                    word.push(c);
                }
            }
            // The point behind an abbreviation.
            let abbreviated =
                rest[length..].starts_with('.') && !rest[length + 1..].starts_with(|c: char| c.is_ascii_digit());
            rest = &rest[length + usize::from(abbreviated)..];
            pieces.push(match word.as_str() {
                "Ø" => Piece::Word("DIA".into()),
                _ => Piece::Word(word),
            });
        } else {
            if !next.is_whitespace() && !matches!(next, ',' | '_' | '(' | ')') {
                pieces.push(Piece::Sign(next));
            }
            rest = &rest[next.len_utf8()..];
        }
    }
    pieces
}

/// Whether the word so far are initials with points: `E.M.`.
fn text_is_initials(word: &str, rest: &str) -> bool {
    let dotted: String = word.chars().flat_map(|c| [c, '.']).collect();
    rest.starts_with(&dotted[..dotted.len() - 1])
}

/// A number at the start of a text, with its fraction and its unit, and its length. `mixed`: a whole part may stand before a fraction.
fn number(text: &str, mixed: bool) -> (Option<Number>, usize) {
    let plain = |text: &str| {
        text.bytes()
            .take_while(|byte| byte.is_ascii_digit() || *byte == b'.')
            .count()
    };
    let whole = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
    let mut length = plain(text);
    let point = text[..length].contains('.');
    let mut value = text[..length].parse::<f64>().ok();
    let mut is_fraction = false;
    // 1/2, 1-1/2, 1 1/2.
    let fraction = |text: &str| {
        let top = whole(text);
        let bottom = text[top..].strip_prefix('/').map(whole).filter(|digits| *digits > 0)?;
        let (a, b) = (
            text[..top].parse::<f64>().ok()?,
            text[top + 1..top + 1 + bottom].parse::<f64>().ok()?,
        );
        (b > 0.0).then_some((a / b, top + 1 + bottom))
    };
    if !point {
        let gap = text[length..]
            .bytes()
            .take_while(|byte| matches!(byte, b' ' | b'-'))
            .count();
        if let Some((part, parts)) = fraction(text) {
            (value, length, is_fraction) = (Some(part), parts, true);
        } else if let Some((part, parts)) = fraction(&text[length + gap..])
            && gap == 1
            && mixed
        {
            (value, length, is_fraction) = (value.map(|value| value + part), length + gap + parts, true);
        }
    }
    let rest = text[length..].trim_start();
    let gap = text.len() - length - rest.len();
    let ends = |suffix: &str| {
        rest.strip_prefix(suffix)
            .is_some_and(|rest| !rest.starts_with(|c: char| c.is_ascii_alphabetic()))
    };
    let suffix = [("\"", 25.4), ("''", 25.4), ("INCH", 25.4), ("IN", 25.4), ("MM", 1.0)];
    let found = suffix
        .iter()
        .find(|(suffix, _)| match suffix.as_bytes()[0].is_ascii_alphabetic() {
            true => ends(suffix) || rest.strip_prefix(suffix).is_some_and(|rest| rest.starts_with('.')),
            false => rest.starts_with(suffix),
        });
    let mut unit = is_fraction.then_some(25.4);
    if let Some((suffix, mm)) = found {
        unit = Some(*mm);
        length += gap + suffix.len();
    }
    let value = value.filter(|value| value.is_finite());
    let number = value.map(|value| Number {
        value,
        unit,
        fraction: is_fraction,
        point,
    });
    (number, length.max(1))
}
