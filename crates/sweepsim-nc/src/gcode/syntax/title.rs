//! Titles of programs, which look like words but are none.

use super::words;

/// What follows `O` in the subroutines and loops of LinuxCNC.
const KEYWORDS: [&str; 14] = [
    "sub",
    "endsub",
    "call",
    "return",
    "do",
    "while",
    "endwhile",
    "if",
    "elseif",
    "else",
    "endif",
    "repeat",
    "endrepeat",
    "break",
];
/// The most characters of a title in a note.
const LONGEST: usize = 60;

/// The title that a line consists of: `OFinal ToolPath`, `O1000 BRACKET`, `O<BRACKET>`, `<BRACKET>`.
pub(crate) fn of(line: &str) -> Option<String> {
    let line = line.trim_start_matches('\u{feff}').trim();
    let named = |text: &str| {
        let name = text.strip_prefix('<')?.strip_suffix('>')?;
        (!name.contains(['<', '>', '#', '[', '='])).then(|| name.trim().to_owned())
    };
    let title = if line.starts_with('<') {
        named(line)?
    } else {
        let rest = line.strip_prefix(['O', 'o'])?.trim_start();
        if rest.starts_with('<') {
            named(rest)?
        } else {
            let text = rest.trim_start_matches(|c: char| c.is_ascii_digit()).trim_start();
            let word: String = text.chars().take_while(char::is_ascii_alphabetic).collect();
            let keyword =
                KEYWORDS.contains(&word.to_ascii_lowercase().as_str()) || word.eq_ignore_ascii_case("continue");
            if word.len() < 2 || keyword || text.contains(['=', '#', '[', '<']) {
                return None;
            }
            text.to_owned()
        }
    };
    Some(title.chars().take(LONGEST).collect())
}

/// The comment behind the number of a program: `O0000(BRACKET)`.
pub(crate) fn in_comment(rest: &str) -> Option<String> {
    let name = rest.trim_start().strip_prefix('(')?.split(')').next()?.trim();
    (!name.is_empty()).then(|| name.chars().take(LONGEST).collect())
}

/// The number of lines before the first `%` if they are a title: none of them a block, and not all empty. A tape begins at its `%`.
pub(crate) fn leader(text: &str) -> usize {
    let mut title = false;
    for (index, line) in text.lines().enumerate() {
        match words::plain(line) {
            Ok(block) if block.tape => return if title { index } else { 0 },
            Ok(block) if block.is_empty() => {}
            Ok(_) => return 0,
            Err(_) => title = true,
        }
    }
    0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles() {
        for (line, title) in [
            ("OFinal ToolPath", "Final ToolPath"),
            ("O1000 BRACKET 2", "BRACKET 2"),
            (" o0007bracket (x)", "bracket (x)"),
            ("O<BRACKET-2>", "BRACKET-2"),
            ("<Bracket.nc>", "Bracket.nc"),
        ] {
            assert_eq!(of(line).as_deref(), Some(title), "{line}");
        }
        // Numbers, subroutines, loops and blocks.
        for line in [
            "O1000",
            "O1000 (BRACKET)",
            "o100 sub",
            "o100 if [#1 gt 2]",
            "o<a> call",
            "o<a> sub",
            "O#1 call",
            "O1000 G0 X1",
            "OFF=1",
            "G0 X1",
            "O",
            "",
            "<a> X1",
            "o1continue",
        ] {
            assert_eq!(of(line), None, "{line}");
        }
    }

    #[test]
    fn leaders_end_at_the_tape() {
        assert_eq!(leader("PART 12 OF 3\n\n%\nG0 X0"), 2);
        assert_eq!(leader("%\nG0 X0\n%"), 0);
        assert_eq!(leader("(PART)\n%\nG0 X0\n%"), 0);
        assert_eq!(leader("G0 X0\nPART 12\n%"), 0, "a block comes first");
        assert_eq!(leader("PART 12\nG0 X0\n%"), 0, "a block comes first");
        assert_eq!(leader("PART 12\n"), 0);
    }
}
