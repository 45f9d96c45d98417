//! Detects the format of a text from its first distinctive line.

use crate::gcode;

/// The format of a text. Lines count from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Content {
    Gcode,
    /// A table of poses.
    Table,
    /// APT, CLSF, NCL.
    Apt {
        line: usize,
    },
    /// Programs of Siemens's 840D.
    Siemens,
    /// Klartext of Heidenhain's controls.
    Heidenhain {
        line: usize,
    },
    /// Rows of numbers without a header.
    Numbers {
        line: usize,
    },
    Binary,
    Unknown,
}

/// Words of APT that a slash follows, and
const APT: [&str; 32] = [
    "CIRCLE",
    "COOLNT",
    "CSYS",
    "CUTCOM",
    "CUTTER",
    "CYCLE",
    "FEDRAT",
    "FROM",
    "GODLTA",
    "GOTO",
    "GOHOME",
    "INSERT",
    "INTOL",
    "LOAD",
    "LOADTL",
    "MACHIN",
    "MODE",
    "MSYS",
    "MULTAX",
    "OUTTOL",
    "PAINT",
    "PARTNO",
    "PPRINT",
    "SELECT",
    "SPINDL",
    "TLDATA",
    "TOOL PATH",
    "TPRINT",
    "TRNTYP",
    "UNIT",
    "UNITS",
    "SETUP",
];
/// those that can stand without.
const APT_ALONE: [&str; 4] = ["PARTNO", "PPRINT", "MACHIN", "FINI"];
/// The maximum number of indistinctive lines, such as titles, before the distinctive one.
const MOST_OTHER: usize = 5;
/// Words of Siemens's controls,
const SIEMENS: [&str; 16] = [
    "DEF",
    "PROC",
    "EXTERN",
    "MSG",
    "TRAORI",
    "TRAFOOF",
    "TRANS",
    "WORKPIECE",
    "CYCLE800",
    "CYCLE832",
    "MCALL",
    "SUPA",
    "AROT",
    "ATRANS",
    "GOTOF",
    "GOTOB",
];
/// which may also come after this many lines of plain G-code.
const SIEMENS_LINES: usize = 60;

impl Content {
    pub(crate) fn of(text: &str) -> Self {
        if text.contains('\0') {
            return Self::Binary;
        }
        let mut other = 0;
        if text.lines().take(SIEMENS_LINES).any(is_archive) {
            return Self::Siemens;
        }
        for (index, line) in text.lines().enumerate() {
            let line_number = index + 1;
            let line = line.trim_start_matches('\u{feff}').trim();
            if line.is_empty() || line.starts_with(['%', '(', ';']) && !line.starts_with("$$") {
                continue;
            }
            if gcode::okuma_title(line).is_some() {
                return Self::Gcode;
            }
            if is_apt(line) {
                return Self::Apt { line: line_number };
            }
            if is_heidenhain(line) {
                return Self::Heidenhain { line: line_number };
            }
            if is_header(line) {
                return Self::Table;
            }
            if is_numbers(line) {
                return Self::Numbers { line: line_number };
            }
            if is_siemens(line) {
                return Self::Siemens;
            }
            if gcode::is_block(line) || gcode::is_subroutine_or_variable(line) {
                let siemens = text.lines().take(SIEMENS_LINES).any(is_siemens);
                return if siemens { Self::Siemens } else { Self::Gcode };
            }
            other += 1;
            if other > MOST_OTHER {
                break;
            }
        }
        Self::Unknown
    }
}

/// The rest of a line after a block number, with or without its N.
fn after_number(line: &str) -> &str {
    let rest = line.strip_prefix(['N', 'n']).unwrap_or(line);
    rest.trim_start_matches(|c: char| c.is_ascii_digit()).trim_start()
}

fn is_apt(line: &str) -> bool {
    if line.starts_with("$$") {
        return true;
    }
    let upper = line.to_ascii_uppercase();
    let end = upper.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(upper.len());
    if APT_ALONE.contains(&&upper[..end]) && !upper[end..].starts_with(['=', '[', '(']) {
        return true;
    }
    upper
        .split_once('/')
        .is_some_and(|(word, _)| APT.contains(&word.trim_end()))
}

fn is_heidenhain(line: &str) -> bool {
    let upper = after_number(line).to_ascii_uppercase();
    let mut words = upper.split_whitespace();
    matches!(
        (words.next(), words.next()),
        (Some("BEGIN"), Some("PGM")) | (Some("BLK"), Some("FORM")) | (Some("TOOL"), Some("CALL" | "DEF"))
    )
}

/// The header of a table of poses.
fn is_header(line: &str) -> bool {
    let names: Vec<String> = line.split(',').map(|name| name.trim().to_ascii_lowercase()).collect();
    ["x", "y", "z", "i", "j", "k"]
        .iter()
        .all(|name| names.iter().any(|found| found == name))
}

fn is_numbers(line: &str) -> bool {
    let mut words = line
        .split(|c: char| c.is_whitespace() || c == ',' || c == ';')
        .filter(|word| !word.is_empty())
        .peekable();
    words.peek().is_some() && words.all(|word| word.parse::<f64>().is_ok_and(f64::is_finite))
}

/// The header of a program in an archive of a Siemens control.
fn is_archive(line: &str) -> bool {
    let upper = line.trim().to_ascii_uppercase();
    upper.starts_with("%_N_") && (upper.ends_with("_MPF") || upper.ends_with("_SPF"))
}

fn is_siemens(line: &str) -> bool {
    let upper = after_number(line.trim()).to_ascii_uppercase();
    let end = upper.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(upper.len());
    SIEMENS.contains(&&upper[..end])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_line_that_tells() {
        for (text, content) in [
            ("%\n(part)\nO100\nN10 G21\n", Content::Gcode),
            ("OFinal ToolPath\nG0 X1", Content::Gcode),
            ("X1 Y2 Z3", Content::Gcode),
            ("N30 DEF REAL _x", Content::Siemens),
            ("%_N_PART_MPF\nN10 MSG(\"x\")", Content::Siemens),
            ("N10 G17 G90\nN20 SUPA G0 Z0 D0", Content::Siemens),
            ("x, y, z, i, j, k\n0,0,0,0,0,1", Content::Table),
            ("rapid,X,Y,Z,I,J,K", Content::Table),
            ("$$ made by hand\nGOTO/1,2,3", Content::Apt { line: 1 }),
            ("\nPARTNO bracket\nUNITS / MM", Content::Apt { line: 2 }),
            ("TOOL PATH/FINISH,TOOL,D10", Content::Apt { line: 1 }),
            ("goto / 1, 2, 3", Content::Apt { line: 1 }),
            ("0 BEGIN PGM 12 MM", Content::Heidenhain { line: 1 }),
            ("; part\nBEGIN PGM PART MM", Content::Heidenhain { line: 2 }),
            ("5 TOOL CALL 3 Z S2000", Content::Heidenhain { line: 1 }),
            ("1.5 -2 3e-1 0 0 1", Content::Numbers { line: 1 }),
            ("a text\nof two lines", Content::Unknown),
            ("GOTO 10", Content::Unknown),
            ("", Content::Unknown),
            ("a\nlonger\ntext\nin\nwhich\none\nline\nis\nG1\nX1", Content::Unknown),
            ("o<pocket> sub\nG1 X1", Content::Gcode),
            ("#1 = 5\nG1 X#1", Content::Gcode),
            ("$BRACKET.MIN%\nO1\nG15 H1", Content::Gcode),
            ("G0\0X1", Content::Binary),
        ] {
            assert_eq!(Content::of(text), content, "{text:?}");
        }
    }
}
