//! Okuma's user task: variables by name, labels of letters, jumps and calls, as statements or as lines of words and `#<…>`.
//!
//! Source: programs for OSP controls in public repositories, and what their users say of them; no manual was found. Common variables `VC1` and `VC[1]` and those of the system begin with V; others
//! belong to their program.

/// A line that has more than words.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Statement {
    /// The line in words and variables.
    Words(String),
    /// `GOTO NA1`, `IF [VC1 GT 5] NA1`: the condition in variables, and the label.
    Jump { condition: Option<String>, label: String },
    /// `CALL OSUB Q2 PA=5`.
    Call {
        name: String,
        times: u32,
        arguments: Vec<(String, String)>,
    },
    /// `RTS`.
    Return,
    /// The name of a program, or nothing but a label.
    Name,
    /// Something that moves nothing: `CLEAR`, `DRAW`.
    Ignored(String),
}

/// Words between values.
const OPERATORS: [&str; 11] = ["EQ", "NE", "LT", "LE", "GT", "GE", "AND", "OR", "XOR", "EOR", "MOD"];
const FUNCTIONS: [&str; 16] = [
    "SIN", "COS", "TAN", "ASIN", "ACOS", "ATAN", "ATAN2", "SQRT", "ABS", "ROUND", "FIX", "FUP", "DROUND", "DFIX",
    "DFUP", "EXP",
];

/// What a line says beyond words; none for lines of words alone.
pub(crate) fn statement(line: &str) -> Option<Statement> {
    let text = without_comments(line);
    let text = text.trim().trim_start_matches('/').trim_start();
    let (label, rest) = label(text);
    let rest = rest.trim();
    if label && rest.is_empty() {
        return Some(Statement::Name);
    }
    if let Some(name) = text
        .strip_prefix('O')
        .filter(|name| name.starts_with(|c: char| c.is_ascii_alphabetic()))
    {
        return (identifier(name).len() == name.trim().len()).then_some(Statement::Name);
    }
    match identifier(rest) {
        "GOTO" => return jump(&rest[4..]).map(|label| Statement::Jump { condition: None, label }),
        "IF" => {
            let rest = rest[2..].trim_start();
            let end = closing(rest)?;
            let label = jump(rest[end + 1..].trim_start().trim_start_matches("GOTO"))?;
            let condition = Some(variables(&rest[..=end]));
            return Some(Statement::Jump { condition, label });
        }
        "CALL" => return call(rest[4..].trim()),
        "RTS" => return Some(Statement::Return),
        _ => {}
    }
    let translated = words(rest)?;
    // A number of the block stays.
    let head = &text[..text.len() - rest.len()];
    let head = if label { "" } else { head };
    Some(match translated {
        Line::Words(words) if words != rest || label => Statement::Words(format!("{head}{words}")),
        Line::Words(_) => return None,
        Line::Other(name) => Statement::Ignored(name),
    })
}

/// The labels that lines begin with: `NA1 …`.
pub(crate) fn label_of(line: &str) -> Option<String> {
    let text = line.trim_start().trim_start_matches('/').trim_start();
    let name = identifier(text);
    label(text).0.then(|| name.to_ascii_uppercase())
}

/// The name of a program: `OSUB`.
pub(crate) fn program_of(line: &str) -> Option<String> {
    let name = line.trim_start().strip_prefix('O')?;
    let name = identifier(name);
    (!name.is_empty()).then(|| name.to_ascii_uppercase())
}

/// Whether a text begins with a label of letters, and what follows.
fn label(text: &str) -> (bool, &str) {
    let name = identifier(text);
    let after = text[name.len()..].trim_start();
    let letters = name.len() > 1 && name.starts_with('N') && name.as_bytes()[1].is_ascii_alphabetic();
    match letters && !after.starts_with(['=', '[']) {
        true => (true, after),
        false => (false, text),
    }
}

/// Letters and digits from a letter on.
fn identifier(text: &str) -> &str {
    if !text.starts_with(|c: char| c.is_ascii_alphabetic()) {
        return "";
    }
    let end = text.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(text.len());
    &text[..end]
}

fn jump(text: &str) -> Option<String> {
    let label = identifier(text.trim());
    label.starts_with('N').then(|| label.to_ascii_uppercase())
}

fn call(text: &str) -> Option<Statement> {
    let name = text.strip_prefix('O')?;
    let name = &name[..name.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(name.len())];
    if name.is_empty() {
        return None;
    }
    let (mut times, mut arguments) = (1, Vec::new());
    for word in text[1 + name.len()..].split_whitespace() {
        if let Some((name, value)) = word.split_once('=') {
            arguments.push((name.to_ascii_lowercase(), variables(value)));
        } else if let Some(count) = word.strip_prefix('Q').and_then(|digits| digits.parse().ok()) {
            times = count;
        } else {
            return None;
        }
    }
    Some(Statement::Call {
        name: name.to_ascii_uppercase(),
        times,
        arguments,
    })
}

fn without_comments(line: &str) -> String {
    let mut depth = 0_usize;
    let kept = |c: &char| {
        depth += usize::from(*c == '(');
        let outside = depth == 0;
        depth -= usize::from(*c == ')' && depth > 0);
        outside
    };
    line.chars().filter(kept).collect()
}

/// Where the bracket that a text begins with closes.
fn closing(text: &str) -> Option<usize> {
    let mut depth = 0_usize;
    for (at, c) in text.char_indices() {
        match c {
            '[' => depth += 1,
            ']' => depth = depth.checked_sub(1)?,
            _ => {}
        }
        if depth == 0 {
            return (c == ']').then_some(at);
        }
    }
    None
}

enum Line {
    Words(String),
    Other(String),
}

/// Words with values by `=`, and assignments.
fn words(text: &str) -> Option<Line> {
    let mut out = String::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let name = identifier(rest);
        let letters = name.bytes().take_while(u8::is_ascii_alphabetic).count();
        if name.is_empty() {
            out.push(first);
            rest = &rest[first.len_utf8()..];
            continue;
        }
        if letters == 1 {
            // A word: its letter, then a number or `=`.
            let after = rest[1..].trim_start();
            let Some(value) = after.strip_prefix('=') else {
                out.push_str(&rest[..1]);
                rest = &rest[1..];
                continue;
            };
            let end = expression_end(value);
            out.push_str(&format!("{first}[{}]", variables(value[..end].trim())));
            rest = &value[end..];
            continue;
        }
        let mut after = &rest[name.len()..];
        let index = match after.trim_start().starts_with('[') {
            true => {
                let text = after.trim_start();
                let end = closing(text)?;
                after = &text[end + 1..];
                Some(&text[1..end])
            }
            false => None,
        };
        let Some(value) = after.trim_start().strip_prefix('=') else {
            return (out.trim().is_empty() && index.is_none()).then(|| Line::Other(name.to_owned()));
        };
        // Texts and hexadecimal numbers say nothing about moves.
        if value.trim_start().starts_with(['\'', '"', '’', '#']) {
            return Some(Line::Other(name.to_owned()));
        }
        let end = expression_end(value);
        out.push_str(&format!(
            "{}={} ",
            variable(name, index),
            variables(value[..end].trim())
        ));
        rest = &value[end..];
    }
    Some(Line::Words(out))
}

/// Where an expression ends: before the next word with a value.
fn expression_end(text: &str) -> usize {
    let mut depth = 0_usize;
    for (at, c) in text.char_indices() {
        match c {
            '[' => depth += 1,
            ']' => depth = depth.saturating_sub(1),
            _ if c.is_whitespace() && depth == 0 => {
                let next = text[at..].trim_start();
                let name = identifier(next);
                let operator = OPERATORS.contains(&name) || next.starts_with(['+', '-', '*', '/']) || next.is_empty();
                let before = text[..at].trim_end().ends_with(['+', '-', '*', '/', '=']) || text[..at].trim().is_empty();
                let after_operator = OPERATORS
                    .iter()
                    .any(|word| text[..at].trim_end().ends_with(&format!(" {word}")));
                if !(operator || before || after_operator) {
                    return at;
                }
            }
            _ => {}
        }
    }
    text.len()
}

/// A variable as `#<name>`; common ones begin with an underscore.
fn variable(name: &str, index: Option<&str>) -> String {
    let name = name.to_ascii_lowercase();
    let letters = name.bytes().take_while(u8::is_ascii_alphabetic).count();
    // VC1 is VC[1].
    let index = match (index, &name[letters..]) {
        (Some(index), _) => Some(index),
        (None, "") => None,
        (None, digits) if name.starts_with('v') => Some(digits),
        _ => None,
    };
    let (common, base) = (
        name.starts_with('v'),
        if index.is_some() { &name[..letters] } else { &name[..] },
    );
    let index = index.map_or_else(String::new, |index| format!("[{}]", index.trim()));
    format!("#<{}{base}{index}>", if common { "_" } else { "" })
}

/// An expression with its variables as `#<name>`.
fn variables(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let name = identifier(rest);
        if name.is_empty() {
            out.push(first);
            rest = &rest[first.len_utf8()..];
            continue;
        }
        rest = &rest[name.len()..];
        let upper = name.to_ascii_uppercase();
        let bracket = rest.trim_start().starts_with('[');
        if OPERATORS.contains(&upper.as_str()) {
            out.push_str(&format!(" {} ", if upper == "EOR" { "XOR" } else { &upper }));
        } else if bracket && FUNCTIONS.contains(&upper.as_str()) {
            out.push_str(match upper.as_str() {
                "ATAN2" => "ATAN",
                "DROUND" => "ROUND",
                "DFIX" => "FIX",
                "DFUP" => "FUP",
                name => name,
            });
        } else {
            let index = rest.trim_start();
            let end = if bracket { closing(index) } else { None };
            match end {
                Some(end) => {
                    out.push_str(&variable(name, Some(&index[1..end])));
                    rest = &index[end + 1..];
                }
                None => out.push_str(&variable(name, None)),
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_user_tasks() {
        let words = |line: &str| match statement(line) {
            Some(Statement::Words(words)) => words.trim().to_owned(),
            other => panic!("{line}: {other:?}"),
        };
        assert_eq!(words("VC1=5"), "#<_vc[1]>=5");
        assert_eq!(
            words("PX1=VZOFX[2]-PX*COS[PA1] (MOVED)"),
            "#<px1>=#<_vzofx[2]>-#<px>*COS[#<pa1>]"
        );
        assert_eq!(words("N10 G0 X=VC1+5 Y=-PL"), "N10 G0 X[#<_vc[1]>+5] Y[-#<pl>]");
        assert_eq!(
            words("G1 X=VC[2] Z-3. F=VC3 * 2"),
            "G1 X[#<_vc[2]>] Z-3. F[#<_vc[3]> * 2]"
        );
        assert_eq!(words("NLAP1 G1 X5"), "G1 X5");
        for plain in ["G0 X5 Y-3", "N100 G1 Z-1 F100", "(NOTE) M8", "O1000 (PART)", "T1 M6"] {
            assert_eq!(statement(plain), None, "{plain}");
        }
        assert_eq!(
            statement("IF [VC1 GT 5] NA1"),
            Some(Statement::Jump {
                condition: Some("[#<_vc[1]>  GT  5]".into()),
                label: "NA1".into()
            })
        );
        assert_eq!(
            statement("NLAP GOTO N100"),
            Some(Statement::Jump {
                condition: None,
                label: "N100".into()
            })
        );
        assert_eq!(
            statement("CALL OSUB Q2 PA=5 PB=VC1"),
            Some(Statement::Call {
                name: "SUB".into(),
                times: 2,
                arguments: vec![("pa".into(), "5".into()), ("pb".into(), "#<_vc[1]>".into())]
            })
        );
        assert_eq!(statement("RTS"), Some(Statement::Return));
        assert_eq!(statement("OSUB"), Some(Statement::Name));
        assert_eq!(
            (statement("NA1"), label_of("NA1 G0")),
            (Some(Statement::Name), Some("NA1".into()))
        );
        assert_eq!(statement("CLEAR"), Some(Statement::Ignored("CLEAR".into())));
        assert_eq!(
            statement("VUACM[1]='END OF BAR'"),
            Some(Statement::Ignored("VUACM".into()))
        );
    }
}
