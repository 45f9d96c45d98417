//! What is different on Okuma's OSP controls for milling.
//!
//! Sources: what the posts of Fusion and HSM for OSP-E100M and OSP-P300 write, and what their users say of it; no manual was found. `G15 H` selects a work offset, `G16 H0` is a move
//! in machine coordinates, `G56 H` a length offset that `G53` ends, `G71 Z` the level to which cycles return with `M53` (with `M54` to R), `G181` to `G189` the cycles of
//! `G81` to `G89`, `G274` and `G284` rigid tapping, `G169` and `G170` tip control on and off, `CALL OO88 PA= PB= PC=` an offset that turns with the table.

use super::codes::{Code, LengthCode, MotionMode};
use super::offsets::OKUMA;
use super::syntax::block::Block;

/// The meaning of `G value` where it is another than elsewhere.
pub(crate) fn code(value: f64, block: &Block) -> Option<Code> {
    if value.fract() != 0.0 || !(0.0..=999.0).contains(&value) {
        return None;
    }
    let offset = block.get('H').filter(|h| h.fract() == 0.0 && (0.0..=999.0).contains(h));
    Some(match (value as u32, offset) {
        (15, Some(h)) => Code::WorkOffset(OKUMA + h as u32),
        (16, Some(0.0)) => Code::MachineCoordinates,
        (16, _) => Code::Refused("a work offset for one block is"),
        (53, _) => Code::CancelLength,
        (54 | 55, _) => Code::Refused("a length offset along X or Y is"),
        (56, _) => Code::Length(LengthCode::Table),
        (71, _) if block.has('Z') => Code::ReturnLevel,
        (10, _) if !block.has('L') => Code::Harmless,
        (11, _) => Code::Refused("turned coordinates are"),
        (116, _) => Code::ChangeTool,
        (130 | 131, _) => Code::Ignored("high-speed modes (G131) change no programmed point: ignored"),
        (169, _) => Code::TipControl(true),
        (170, _) => Code::TipControl(false),
        (cycle @ 181..=189, _) => Code::Motion(MotionMode::Cycle((cycle - 100) as u8)),
        (tapping @ (274 | 284), _) => Code::Motion(MotionMode::Cycle((tapping - 200) as u8)),
        _ => return None,
    })
}

/// The angles of `CALL OO88 PA= PB= PC=`, in whatever order; `None` for another call.
pub(crate) fn turned_offset(call: &str) -> Option<[f64; 3]> {
    let rest = call.trim_start().strip_prefix("OO88")?;
    let angle = |name: &str| {
        let at = rest.find(name)? + name.len();
        let number: String = rest[at..]
            .chars()
            .take_while(|c| c.is_ascii_digit() || "+-.".contains(*c))
            .collect();
        number.parse::<f64>().ok()
    };
    Some(["PA=", "PB=", "PC="].map(|name| angle(name).unwrap_or(0.0)))
}

/// The name and the arguments of a call: `CALL OO88 PA=90`, with a block number before it or not.
pub(crate) fn call(line: &str) -> Option<&str> {
    let line = line.trim_start().trim_start_matches('/');
    let line = match line.strip_prefix(['N', 'n']) {
        Some(rest) => rest.trim_start_matches(|c: char| c.is_ascii_digit()).trim_start(),
        None => line,
    };
    line.strip_prefix("CALL")
}
