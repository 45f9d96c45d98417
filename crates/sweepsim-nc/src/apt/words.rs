//! What the major words of statements mean.

/// Words that neither move the tool nor say anything about it here.
pub(super) const IGNORED: [&str; 40] = [
    "PAINT",
    "END-OF-PATH",
    "TOOL PATH",
    "MACHIN",
    "FINI",
    "END",
    "SEQNO",
    "LEADER",
    "AUXFUN",
    "PREFUN",
    "CLRSRF",
    "CLPRNT",
    "INTOL",
    "OUTTOL",
    "TOLER",
    "MAXDP",
    "MAXDPM",
    "NOPOST",
    "CLAMP",
    "SET",
    "MODE",
    "CSI_MACHINE_SETUP",
    "SAFPOS",
    "VERIFY",
    "PPTOL",
    "LINTOL",
    "REWIND",
    "OPSKIP",
    "MCHTOL",
    "SLOWDN",
    "AIR",
    "LPRINT",
    "CSI_TOOL_PATH",
    "MFGNO",
    "FEATNO",
    "PROTFILE",
    "PARTFILE",
    "OFSTNO",
    "SETOOL",
    "CHANNEL",
];

/// Words of rotary axes: the tool axis of each `GOTO` already says how the part is turned.
pub(super) const ROTARY: [&str; 6] = ["ROTATE", "ROTABL", "ROTHED", "ROTAB", "LINTOL", "MULTAX"];

/// Words that move the tool in a way that is not supported.
pub(super) const REFUSED: [(&str, &str); 14] = [
    ("COPY", "copies of the path are"),
    ("INDEX", "copies of the path are"),
    ("TRACUT", "transformations of the path are"),
    ("TRANS", "shifts of the path are"),
    ("SCALE", "scaled paths are"),
    ("MIRROR", "mirrored paths are"),
    ("ARC", "ARC statements are"),
    ("ARCSLP", "helices by ARCSLP are"),
    ("HELIX", "HELIX statements are"),
    ("SPLINE", "SPLINE statements are"),
    ("THREAD", "threads are"),
    ("CALSUB", "subprograms are"),
    ("CALL", "calls are"),
    ("DEFSUB", "subprograms are"),
];

/// Words of part programs, from which a processor computes the path.
const GEOMETRY: [&str; 27] = [
    "GO", "GOFWD", "GOBACK", "GOLFT", "GORGT", "GOUP", "GODOWN", "GOFWDA", "OFFSET", "TLLFT", "TLRGT", "TLON",
    "TLONPS", "TLOFPS", "PSIS", "DNTCUT", "CUT", "INDIRV", "INDIRP", "TLAXIS", "THICK", "RESERV", "LOOPST", "LOOPND",
    "JUMPTO", "IF", "CANON",
];

/// Whether a statement belongs to a part program: it defines geometry, or drives the tool along it.
pub(super) fn is_geometry(major: &str, whole: &str) -> bool {
    // `PL1=PLANE/...`, `LN1)GOFWD`, `ST)LOOPST`.
    let name = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '(' | ')' | ' ' | '.');
    let defines = whole
        .split_once('=')
        .is_some_and(|(front, _)| !front.trim().is_empty() && front.chars().all(name));
    let last = major.rsplit([')', ',']).next().unwrap_or(major).trim();
    let first = last.split(['(', ' ']).next().unwrap_or(last);
    defines || GEOMETRY.iter().any(|word| first.eq_ignore_ascii_case(word))
}
