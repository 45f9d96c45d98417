//! The meaning of G and M codes.

use super::offsets::EXTENDED;
use super::syntax::block::Block;
use crate::drive::{ArcPlane, WorkOffset};
use crate::model::event::Coolant;
use crate::model::program::FeedMode;

/// How the tool moves, until another word says otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MotionMode {
    Rapid,
    Feed,
    Arc {
        counter_clockwise: bool,
    },
    /// G33 and G32: straight, in step with the spindle.
    Thread,
    /// A drilling cycle: 73 … 89.
    Cycle(u8),
    /// G33.1: down and back, with the spindle.
    RigidTap,
    /// G5 and G5.1: Bézier curves in the plane XY, of degree 3 and 2.
    Curve {
        cubic: bool,
    },
    /// G5.2: control points of a rational B-spline.
    Nurbs,
}

/// How G43 and its kin set the length offset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LengthCode {
    /// G43 H: from the table.
    Table,
    /// G44 H: from the table, with the other sign.
    Opposite,
    /// G43.1 X Y Z: as the words say.
    Words,
    /// G43.2: in addition to what there is.
    Add,
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
    Feed(FeedMode),
    /// G99: cycles retract to their plane R.
    RetractToPlane(bool),
    TipControl(bool),
    Length(LengthCode),
    CancelLength,
    /// G41, G42; G41.1, G42.1.
    Compensation {
        left: bool,
        by_words: bool,
    },
    CancelCompensation,
    WorkOffset(WorkOffset),
    /// G54.1 P, G154 P.
    WorkOffsetByWord,
    MachineCoordinates,
    /// G28, G30.
    Home {
        second: bool,
    },
    /// G28.1, G30.1.
    SetHome {
        second: bool,
    },
    SetOffsets,
    LocalShift,
    ShiftHere,
    CancelShift {
        forget: bool,
    },
    RestoreShift,
    Rotate,
    CancelRotation,
    Scale,
    CancelScale,
    Mirror,
    CancelMirror,
    Polar(bool),
    /// G68.2, G268.
    TiltedPlane,
    /// G68.4: in the plane there is.
    FurtherTilt,
    /// G5.3.
    EndCurve,
    /// G12, G13.
    CircularPocket {
        counter_clockwise: bool,
    },
    /// G45 to G48.
    Stretch(u32),
    CancelTilt,
    /// G53.1, G253.
    AlignTool,
    /// G254, G255.
    DynamicOffset(bool),
    /// G43.5.
    TipVectors,
    /// G234, whose axes have the signs of their letters' convention.
    TipControlByLetters,
    MacroCall,
    Dwell,
    /// Okuma's G71 Z: to which cycles return.
    ReturnLevel,
    /// Okuma's G116 T.
    ChangeTool,
    /// Brother's G100: with a rapid in the same block.
    ChangeToolOnTheWay,
    /// G31, G38.2 and their kin: a move up to where the part is.
    Probe,
    /// G5: a spline, or a high-speed mode.
    SplineOrMode,
    /// G5.1: a spline, or a high-speed mode.
    SplineOrContouring,
    /// G9: the axes rest after this block.
    StopHere,
    /// G61, G61.1, and G62, G63, which end them: whether the axes rest after each block.
    ExactStop(bool),
    /// G64: corners may be rounded.
    Blending,
    /// Changes no geometry; its words are its own. What to note.
    Ignored(&'static str),
    /// A cycle whose moves are not known, by its name.
    UnknownCycle(&'static str),
    Harmless,
    /// Not supported; the reason as a subject with its verb.
    Refused(&'static str),
    Unknown,
}

/// The meaning of `G value` in a block: some codes mean different things with different words, on different controls.
pub(crate) fn g_in(value: f64, block: &Block) -> Code {
    const HIGH_SPEED: Code = Code::Ignored("high-speed modes (G5 P10000, G5.1 Q1) change no programmed point: ignored");
    let given = |letters: &str| letters.chars().any(|letter| block.has(letter));
    match g(value) {
        // Brother changes the tool on the way.
        _ if value == 100.0 && given("T") => Code::ChangeToolOnTheWay,
        // Hurco's quality of surfaces.
        Code::EndCurve if given("P") => Code::Ignored("smoothness (G5.3 P) changes no programmed point: ignored"),
        Code::SplineOrMode if given("XY") => Code::Motion(MotionMode::Curve { cubic: true }),
        Code::SplineOrMode if given("ZABCIJKQ") || !given("P") => Code::Refused("splines without X and Y are"),
        // P1 and P2 are Mitsubishi's and Mazak's high-speed modes. P10001 and on call high-speed cycles, which move
        // axes.
        Code::SplineOrMode => match block.get('P') {
            Some(0.0 | 1.0 | 2.0 | 10_000.0) if !given("LR") => HIGH_SPEED,
            _ => Code::Refused("high-speed modes other than P0, P1, P2 and P10000 are"),
        },
        Code::SplineOrContouring if given("XY") => Code::Motion(MotionMode::Curve { cubic: false }),
        Code::SplineOrContouring if given("ZABCIJK") || !given("Q") => Code::Refused("splines without X and Y are"),
        // Q2 is smooth interpolation: it changes the path. R is a level of precision.
        Code::SplineOrContouring => match block.get('Q') {
            Some(0.0 | 1.0) if !given("LP") => HIGH_SPEED,
            _ => Code::Refused("high-speed modes other than Q0 and Q1 are"),
        },
        // On lathes and on some mills these are cycles, which have such words.
        // Holes on a circle or in a row, where a cycle is on.
        Code::InchOrCycle(inch) if block.has('L') && given("IJ") && !given("PQUW") => {
            Code::UnknownCycle(if inch { "G70" } else { "G71" })
        }
        Code::InchOrCycle(_) if given("IJKLPQRDUW") => Code::Refused("cycles are"),
        Code::Stretch(47) if block.has('P') => Code::UnknownCycle("G47 (engraving)"),
        code => code,
    }
}

/// The meaning of `G value`.
fn g(value: f64) -> Code {
    let tenths = (value * 10.0).round();
    if (value * 10.0 - tenths).abs() > 1e-6 || !(0.0..=9999.0).contains(&tenths) {
        return Code::Unknown;
    }
    let arc = |counter_clockwise| Code::Motion(MotionMode::Arc { counter_clockwise });
    match tenths as u32 {
        0 => Code::Motion(MotionMode::Rapid),
        10 => Code::Motion(MotionMode::Feed),
        20 => arc(false),
        30 => arc(true),
        40 => Code::Dwell,
        50 => Code::SplineOrMode,
        51 => Code::SplineOrContouring,
        52 => Code::Motion(MotionMode::Nurbs),
        53 => Code::EndCurve,
        100 => Code::SetOffsets,
        120 | 130 => Code::CircularPocket {
            counter_clockwise: tenths == 130.0,
        },
        1500 => Code::UnknownCycle("G150"),
        150 => Code::Polar(false),
        160 => Code::Polar(true),
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
        280 => Code::Home { second: false },
        300 => Code::Home { second: true },
        281 => Code::SetHome { second: false },
        301 => Code::SetHome { second: true },
        320 | 330 => Code::Motion(MotionMode::Thread),
        331 => Code::Motion(MotionMode::RigidTap),
        332..=339 => Code::Refused("threading is"),
        310 | 350..=389 | 1360 => Code::Probe,
        400 => Code::CancelCompensation,
        410 | 420 => Code::Compensation {
            left: tenths == 410.0,
            by_words: false,
        },
        411 | 421 => Code::Compensation {
            left: tenths == 411.0,
            by_words: true,
        },
        412..=419 | 422..=429 => Code::Refused("this kind of cutter compensation is"),
        430 => Code::Length(LengthCode::Table),
        431 => Code::Length(LengthCode::Words),
        432 => Code::Length(LengthCode::Add),
        434 => Code::TipControl(true),
        435 => Code::TipVectors,
        440 => Code::Length(LengthCode::Opposite),
        450 | 460 | 470 | 480 => Code::Stretch(tenths as u32 / 10),
        490 => Code::CancelLength,
        500 => Code::CancelScale,
        501 => Code::CancelMirror,
        510 => Code::Scale,
        511 => Code::Mirror,
        520 => Code::LocalShift,
        530 => Code::MachineCoordinates,
        540 | 550 | 560 | 570 | 580 | 590 => Code::WorkOffset((tenths as u32 - 540) / 10),
        541 | 1540 => Code::WorkOffsetByWord,
        591..=593 => Code::WorkOffset(tenths as u32 - 591 + 6),
        600 => Code::Refused("single-direction positioning is"),
        640 => Code::Blending,
        650 => Code::MacroCall,
        661 => Code::Refused("macro calls by every block are"),
        // Performed with their blocks.
        660 | 670 => Code::Harmless,
        680 => Code::Rotate,
        682 | 2680 => Code::TiltedPlane,
        684 => Code::FurtherTilt,
        2690 => Code::CancelTilt,
        681 | 683 | 685..=689 => Code::Refused("rotated frames are"),
        690 => Code::CancelRotation,
        730 | 760 | 770 | 740 | 810 | 820 | 830 | 840 | 850 | 860 | 870 | 880 | 890 => {
            Code::Motion(MotionMode::Cycle((tenths as u32 / 10) as u8))
        }
        800 => Code::CancelMotion,
        900 => Code::Absolute(true),
        910 => Code::Absolute(false),
        901 => Code::AbsoluteCentres(true),
        911 => Code::AbsoluteCentres(false),
        920 => Code::ShiftHere,
        921 => Code::CancelShift { forget: true },
        922 => Code::CancelShift { forget: false },
        923 => Code::RestoreShift,
        930 => Code::Feed(FeedMode::InverseTime),
        940 => Code::Feed(FeedMode::PerMinute),
        950 => Code::Feed(FeedMode::PerRevolution),
        980 => Code::RetractToPlane(false),
        990 => Code::RetractToPlane(true),
        // Haas's G110 to G129 are G154 P1 to P20.
        tenths @ 1100..=1290 if tenths % 10 == 0 => Code::WorkOffset(EXTENDED + (tenths - 1100) / 10 + 1),
        1870 => Code::Ignored("smoothness (G187) changes no programmed point: ignored"),
        220 | 230 => Code::Ignored("limits of the travel (G22, G23) change no programmed point: ignored"),
        106 => Code::Ignored("the retraction of the tool (G10.6) changes no programmed point: ignored"),
        // Ends of what is refused.
        131 | 401 | 502 => Code::Harmless,
        1030 => Code::Ignored("look-ahead limits (G103) change no programmed point: ignored"),
        531 | 2530 => Code::AlignTool,
        2540 => Code::DynamicOffset(true),
        2550 => Code::DynamicOffset(false),
        2340 => Code::TipControlByLetters,
        90 => Code::StopHere,
        610 | 611 => Code::ExactStop(true),
        620 | 630 => Code::ExactStop(false),
        // Look-ahead, speed modes, diameter mode off.
        80 | 960 | 970 => Code::Harmless,
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
    Stop,
    OptionalStop,
    Spindle(SpindleTurning),
    Coolant(Coolant),
    TipControl(bool),
    /// M98, M97.
    Call {
        by_block_number: bool,
    },
    /// M99: the end of a main program, or the return from a subprogram.
    Return,
    SaveModes,
    ForgetModes,
    RestoreModes,
    SaveModesForCall,
    /// Not supported; the reason as a subject with its verb.
    Refused(&'static str),
    Unknown,
}

/// How the spindle turns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum SpindleTurning {
    Clockwise,
    CounterClockwise,
    #[default]
    Stopped,
}

/// The meaning of `M value`.
pub(crate) fn m(value: f64) -> Misc {
    if value.fract() != 0.0 || !(0.0..=999.0).contains(&value) {
        return Misc::Unknown;
    }
    match value as u32 {
        0 => Misc::Stop,
        1 => Misc::OptionalStop,
        2 | 30 => Misc::End,
        3 => Misc::Spindle(SpindleTurning::Clockwise),
        4 => Misc::Spindle(SpindleTurning::CounterClockwise),
        5 => Misc::Spindle(SpindleTurning::Stopped),
        6 => Misc::ToolChange,
        7 => Misc::Coolant(Coolant::Mist),
        8 => Misc::Coolant(Coolant::Flood),
        9 => Misc::Coolant(Coolant::Off),
        88 => Misc::Coolant(Coolant::Through),
        89 => Misc::Coolant(Coolant::ThroughOff),
        61 => Misc::SetTool,
        128 | 428 => Misc::TipControl(true),
        129 | 429 => Misc::TipControl(false),
        97 => Misc::Call { by_block_number: true },
        98 => Misc::Call { by_block_number: false },
        99 => Misc::Return,
        70 => Misc::SaveModes,
        71 => Misc::ForgetModes,
        72 => Misc::RestoreModes,
        73 => Misc::SaveModesForCall,
        96 | 198 => Misc::Refused("these subprograms are"),
        91 | 92 => Misc::Refused("machine coordinates by M code are"),
        // Clamps, spindle orientation, rigid tapping, overrides, pallets, digital and analog output.
        10 | 11 | 19 | 29 | 48..=53 | 60 | 62..=68 => Misc::Harmless,
        _ => Misc::Unknown,
    }
}
