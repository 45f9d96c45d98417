//! The meaning of G and M codes.

use super::arc::ArcPlane;

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
    Harmless,
    /// Not supported; the reason as a subject with its verb.
    Refused(&'static str),
    Unknown,
}

/// The meaning of `G value`.
pub(crate) fn g(value: f64) -> Code {
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
        50..=53 => Code::Refused("splines are"),
        100 => Code::SetOffsets,
        170 => Code::Plane([0, 1, 2]),
        180 => Code::Plane([2, 0, 1]),
        190 => Code::Plane([1, 2, 0]),
        200 => Code::Inch(true),
        210 => Code::Inch(false),
        280 | 300 => Code::Home,
        330..=339 | 760 => Code::Refused("threading is"),
        380..=389 | 310 => Code::Refused("probing is"),
        410..=429 => Code::Refused("cutter compensation is"),
        430..=432 => Code::LengthOffset,
        434 => Code::TipControl(true),
        435 => Code::Refused("tip control with axis vectors is"),
        490 => Code::TipControl(false),
        500 | 690 | 150 => Code::Harmless,
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
        // Compensation off, exact stop or blending, feed and speed modes, return levels of cycles, diameter mode off.
        90 | 400 | 610 | 611 | 640 | 80 | 930 | 940 | 950 | 960 | 970 | 980 | 990 => Code::Harmless,
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
    Refused,
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
        97..=99 => Misc::Refused,
        // Stops, spindle, coolant, clamps, overrides, digital and analog output, modal state.
        0 | 1 | 3..=5 | 7..=11 | 19 | 48..=53 | 60 | 62..=68 => Misc::Harmless,
        _ => Misc::Unknown,
    }
}
