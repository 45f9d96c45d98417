//! The meaning of G and M codes.

use super::arc::ArcPlane;
use super::interpreter::Values;

/// How the tool moves, until another word says otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MotionMode {
    Rapid,
    Feed,
    Arc { counter_clockwise: bool },
}

/// What a G code does to the geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Code {
    Motion(MotionMode),
    CancelMotion,
    Plane(ArcPlane),
    Inch(bool),
    /// G70 and G71: units, or cycles if the block has their words.
    InchOrCycle(bool),
    Absolute(bool),
    AbsoluteCentres(bool),
    TipControl(bool),
    LengthOffset,
    WorkOffset(usize),
    MachineCoordinates,
    Home,
    SetOffsets,
    LocalShift,
    ShiftHere,
    CancelShift {
        forget: bool,
    },
    RestoreShift,
    Dwell,
    /// G5: a spline, or a high-speed mode.
    SplineOrMode,
    /// G5.1: a spline, or a high-speed mode.
    SplineOrContouring,
    /// G64: corners may be rounded.
    Blending,
    /// Changes no geometry; its words are its own. What to note.
    Ignored(&'static str),
    Harmless,
    /// Not supported; the reason as a subject with its verb.
    Refused(&'static str),
    Unknown,
}

/// The meaning of `G value` in a block: some codes mean different things with different words, on different controls.
pub(crate) fn g_in(value: f64, values: &Values) -> Code {
    const HIGH_SPEED: Code = Code::Ignored("high-speed modes (G5 P10000, G5.1 Q1) change no programmed point: ignored");
    let given = |letters| values.first(letters).is_some();
    match g(value) {
        Code::SplineOrMode if given("XYZABCIJKQ") || !given("P") => Code::Refused("splines are"),
        // P10001 and on call high-speed cycles, which move axes.
        Code::SplineOrMode => match values.get('P') {
            Some(0.0 | 10_000.0) if !given("LR") => HIGH_SPEED,
            _ => Code::Refused("high-speed modes other than P0 and P10000 are"),
        },
        Code::SplineOrContouring if given("XYZABCIJK") || !given("Q") => Code::Refused("splines are"),
        // Q2 is smooth interpolation: it changes the path. R is a level of precision.
        Code::SplineOrContouring => match values.get('Q') {
            Some(0.0 | 1.0) if !given("LP") => HIGH_SPEED,
            _ => Code::Refused("high-speed modes other than Q0 and Q1 are"),
        },
        // On lathes and on some mills (bolt circles) these are cycles, which have such words.
        Code::InchOrCycle(_) if given("IJKLPQRDUW") => Code::Refused("cycles are"),
        code => code,
    }
}

/// The meaning of `G value`.
fn g(value: f64) -> Code {
    let tenths = (value * 10.0).round();
    if (value * 10.0 - tenths).abs() > 1e-6 || !(0.0..=9999.0).contains(&tenths) {
        return Code::Unknown;
    }
    match tenths as u32 {
        0 => Code::Motion(MotionMode::Rapid),
        10 => Code::Motion(MotionMode::Feed),
        20 => Code::Motion(MotionMode::Arc {
            counter_clockwise: false,
        }),
        30 => Code::Motion(MotionMode::Arc {
            counter_clockwise: true,
        }),
        40 => Code::Dwell,
        50 => Code::SplineOrMode,
        51 => Code::SplineOrContouring,
        52 | 53 => Code::Refused("splines are"),
        100 => Code::SetOffsets,
        170 => Code::Plane([0, 1, 2]),
        180 => Code::Plane([2, 0, 1]),
        190 => Code::Plane([1, 2, 0]),
        200 => Code::Inch(true),
        210 => Code::Inch(false),
        // Siemens's G700 and G710 are units of feeds too.
        700 => Code::InchOrCycle(true),
        710 => Code::InchOrCycle(false),
        7000 => Code::Inch(true),
        7100 => Code::Inch(false),
        280 | 300 => Code::Home,
        330..=339 | 760 => Code::Refused("threading is"),
        380..=389 | 310 => Code::Refused("probing is"),
        410..=429 => Code::Refused("cutter compensation is"),
        430..=432 => Code::LengthOffset,
        434 => Code::TipControl(true),
        435 => Code::Refused("tip control with axis vectors is"),
        490 => Code::TipControl(false),
        // The ends of scaling, rotation, polar coordinates, and of Haas's G254 and G268, whose beginnings are refused.
        500 | 690 | 150 | 2550 | 2690 => Code::Harmless,
        640 => Code::Blending,
        1870 => Code::Ignored("smoothness (G187) changes no programmed point: ignored"),
        510 => Code::Refused("scaling is"),
        511 => Code::Refused("mirroring is"),
        680..=689 => Code::Refused("rotated frames are"),
        160 => Code::Refused("polar coordinates are"),
        520 => Code::LocalShift,
        530 => Code::MachineCoordinates,
        540 | 550 | 560 | 570 | 580 | 590 => Code::WorkOffset((tenths as usize - 540) / 10),
        591..=593 => Code::WorkOffset(tenths as usize - 591 + 6),
        650..=679 => Code::Refused("macro calls are"),
        730 | 740 | 810..=890 => Code::Refused("canned cycles are"),
        800 => Code::CancelMotion,
        900 => Code::Absolute(true),
        910 => Code::Absolute(false),
        901 => Code::AbsoluteCentres(true),
        911 => Code::AbsoluteCentres(false),
        920 => Code::ShiftHere,
        921 => Code::CancelShift { forget: true },
        922 => Code::CancelShift { forget: false },
        923 => Code::RestoreShift,
        // Compensation off, exact stop, look-ahead, feed and speed modes, return levels of cycles, diameter mode off.
        90 | 400 | 610 | 611 | 80 | 930 | 940 | 950 | 960 | 970 | 980 | 990 => Code::Harmless,
        70 => Code::Refused("lathe diameters are"),
        _ => Code::Unknown,
    }
}

/// The meaning of an M code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Misc {
    Harmless,
    ToolChange,
    SetTool,
    End,
    TipControl(bool),
    /// M99: the end of a main program.
    Return,
    /// Not supported; the reason as a subject with its verb.
    Refused(&'static str),
    Unknown,
}

/// The meaning of `M value`.
pub(crate) fn m(value: f64) -> Misc {
    if value.fract() != 0.0 || !(0.0..=999.0).contains(&value) {
        return Misc::Unknown;
    }
    match value as u32 {
        2 | 30 => Misc::End,
        6 => Misc::ToolChange,
        61 => Misc::SetTool,
        128 | 428 => Misc::TipControl(true),
        129 | 429 => Misc::TipControl(false),
        99 => Misc::Return,
        96..=98 | 198 => Misc::Refused("subroutines are"),
        72 | 73 => Misc::Refused("saved modes are"),
        91 | 92 => Misc::Refused("machine coordinates by M code are"),
        // Stops, spindle, coolant, clamps, overrides, digital and analog output, modal state.
        0 | 1 | 3..=5 | 7..=11 | 19 | 48..=53 | 60 | 62..=68 => Misc::Harmless,
        _ => Misc::Unknown,
    }
}
