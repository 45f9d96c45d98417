//! Lines that begin with `O`: subroutines and loops of LinuxCNC, numbers of Fanuc's programs.

use crate::gcode::syntax::cursor::Cursor;

/// The name of a subroutine, a loop or a program.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Label {
    Number(u32),
    Name(String),
}

impl std::fmt::Display for Label {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(number) => write!(f, "O{number}"),
            Self::Name(name) => write!(f, "O<{name}>"),
        }
    }
}

/// What follows the label.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Keyword {
    Sub,
    EndSub,
    Call,
    Return,
    Do,
    While,
    EndWhile,
    If,
    ElseIf,
    Else,
    EndIf,
    Repeat,
    EndRepeat,
    Break,
    Continue,
}

const KEYWORDS: [(&str, Keyword); 15] = [
    ("sub", Keyword::Sub),
    ("endsub", Keyword::EndSub),
    ("call", Keyword::Call),
    ("return", Keyword::Return),
    ("do", Keyword::Do),
    ("while", Keyword::While),
    ("endwhile", Keyword::EndWhile),
    ("if", Keyword::If),
    ("elseif", Keyword::ElseIf),
    ("else", Keyword::Else),
    ("endif", Keyword::EndIf),
    ("repeat", Keyword::Repeat),
    ("endrepeat", Keyword::EndRepeat),
    ("break", Keyword::Break),
    ("continue", Keyword::Continue),
];

/// The keyword that comes next, whole: `sub`, but not `subtract`.
pub(crate) fn keyword(cursor: &mut Cursor) -> Option<Keyword> {
    let letters = cursor.letters();
    let (word, keyword) = KEYWORDS
        .into_iter()
        .find(|(word, _)| letters.eq_ignore_ascii_case(word))?;
    cursor.at += word.len();
    Some(keyword)
}

/// Skips what may stand before the first word that counts: `/` and a block number. Says whether there was a `/`.
pub(crate) fn skip_head(cursor: &mut Cursor) -> bool {
    let optional = cursor.eat(b'/');
    if matches!(cursor.peek(), Some(b'N' | b'n')) {
        let before = *cursor;
        cursor.at += 1;
        if cursor.digits().is_none() {
            *cursor = before;
        }
    }
    optional
}

/// The cursor after the `O` of a line that begins with one.
pub(crate) fn after_letter(line: &str) -> Option<Cursor<'_>> {
    let mut cursor = Cursor::new(line);
    // The usual block begins with something else.
    let first = cursor.peek()?;
    if !matches!(first, b'O' | b'o' | b':' | b'N' | b'n' | b'/') {
        return None;
    }
    skip_head(&mut cursor);
    if !matches!(cursor.peek(), Some(b'O' | b'o' | b':')) {
        return None;
    }
    cursor.at += 1;
    Some(cursor)
}

/// A label that is written out, not computed.
pub(crate) fn label(cursor: &mut Cursor) -> Option<Label> {
    match cursor.peek()? {
        b'<' => cursor.name().ok().map(Label::Name),
        b'0'..=b'9' => {
            let digits = cursor.digits()?;
            (digits.whole && digits.value <= 99_999_999.0).then_some(Label::Number(digits.value as u32))
        }
        _ => None,
    }
}

/// Whether a line is a statement of Fanuc's macros, from the cursor on.
pub(crate) fn is_statement(mut cursor: Cursor) -> bool {
    let letters = cursor.letters();
    if letters.len() < 2 {
        return false;
    }
    let known = [
        "IF", "WHILE", "GOTO", "DO", "END", "POPEN", "PCLOS", "DPRNT", "BPRNT", "SETVN",
    ];
    known.iter().any(|word| letters.eq_ignore_ascii_case(word))
}
