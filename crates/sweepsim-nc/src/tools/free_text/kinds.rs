//! What kind of tool a comment is about, by its words: English ones, and the usual German ones.

use super::words::Words;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Family {
    Mill,
    Face,
    Ball,
    Bull,
    Tapered,
    Chamfer,
    Drill,
    Spot,
    Centre,
    Reamer,
    Tap,
    ThreadMill,
    Boring,
    Probe,
    Lollipop,
    Dovetail,
    /// Its size is labelled, its kind not said.
    Unknown,
}

/// The kind that the words say; the more special ones first.
pub(super) fn family(words: &Words) -> Option<Family> {
    let any = |list: &[&str]| words.has(list);
    let starts = |list: &[&str]| {
        words
            .words()
            .any(|word| list.iter().any(|start| word.starts_with(start)))
    };
    let ends = |end: &str| words.words().any(|word| word.ends_with(end));
    let drill = starts(&["DRILL", "BOHRER"]) || any(&["DRL"]) || ends("DRILL") || ends("BOHRER");
    let mill = any(&["MILL", "EM", "FEM", "CUTTER"]) || ends("MILL") || ends("FRAESER") || ends("FRÄSER");
    Some(match () {
        () if starts(&["PROBE", "RENISHAW", "TOUCHPROBE", "EDGEFINDER", "TASTER"]) => Family::Probe,
        () if starts(&["THREAD"]) && mill || starts(&["THREADMILL", "GEWINDEFR"]) => Family::ThreadMill,
        () if any(&["TAP", "TAPS", "TAPPING", "HANDTAP", "ROLLTAP"]) || starts(&["GEWINDEBOHRER"]) => Family::Tap,
        () if starts(&["REAM", "REIBAHLE"]) => Family::Reamer,
        () if any(&["BORINGBAR", "BORINGHEAD"]) || starts(&["BORING"]) || any(&["BORE"]) && any(&["BAR", "HEAD"]) => {
            Family::Boring
        }
        () if drill && any(&["CENTER", "CENTRE", "CTR"]) || starts(&["CENTERDR", "CENTREDR", "ZENTRIER"]) => {
            Family::Centre
        }
        () if starts(&["SPOT", "NCDRILL", "ANBOHRER", "NCANBOHRER"]) || drill && any(&["NC", "SPOTTING"]) => {
            Family::Spot
        }
        () if starts(&[
            "CHAMF",
            "CHMF",
            "CHFR",
            "COUNTERSINK",
            "CSINK",
            "CSK",
            "ENGRAV",
            "VBIT",
            "DEBUR",
            "FASEN",
            "GRAVUR",
            "ENTGRAT",
            "ENTFR",
        ]) || any(&["SINK"])
            || any(&["V"]) && any(&["BIT", "CUTTER"]) =>
        {
            Family::Chamfer
        }
        () if starts(&["LOLLIPOP"]) => Family::Lollipop,
        () if starts(&["DOVETAIL"]) => Family::Dovetail,
        () if starts(&["TAPER"]) && (mill || starts(&["BALL"])) => Family::Tapered,
        () if starts(&["BALL", "SPHERICAL", "KUGEL"]) || any(&["BN", "BEM", "BNEM"]) => Family::Ball,
        () if starts(&["BULL", "TORUS", "TOROID"]) => Family::Bull,
        () if any(&["FACE", "SHELL"]) && mill
            || starts(&["FACEMILL", "SHELLMILL", "FLYCUT", "PLANFR", "PLAN", "MESSERKOPF"]) =>
        {
            Family::Face
        }
        () if drill && !any(&["SLOT"]) => Family::Drill,
        () if mill
            || drill
            || starts(&["SCHAFT"])
            || any(&["FLAT", "SQUARE", "SLOT", "CBORE", "COUNTERBORE", "ROUGHER", "FACE"]) =>
        {
            Family::Mill
        }
        () if starts(&["FLUTE"]) => Family::Mill,
        () => return None,
    })
}
