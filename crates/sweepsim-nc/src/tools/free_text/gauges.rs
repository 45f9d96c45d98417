//! Gauges of drills and screws, in inches.

/// Drills No. 1 to No. 80, in thousandths of an inch times ten.
const WIRE: [u16; 80] = [
    2280, 2210, 2130, 2090, 2055, 2040, 2010, 1990, 1960, 1935, 1910, 1890, 1850, 1820, 1800, 1770, 1730, 1695, 1660,
    1610, 1590, 1570, 1540, 1520, 1495, 1470, 1440, 1405, 1360, 1285, 1200, 1160, 1130, 1110, 1100, 1065, 1040, 1015,
    995, 980, 960, 935, 890, 860, 820, 810, 785, 760, 730, 700, 670, 635, 595, 550, 520, 465, 430, 420, 410, 400, 390,
    380, 370, 360, 350, 330, 320, 310, 293, 280, 260, 250, 240, 225, 210, 200, 180, 160, 145, 135,
];
/// Drills A to Z, likewise.
const LETTERS: [u16; 26] = [
    2340, 2380, 2420, 2460, 2500, 2570, 2610, 2660, 2720, 2770, 2810, 2900, 2950, 3020, 3160, 3230, 3320, 3390, 3480,
    3580, 3680, 3770, 3860, 3970, 4040, 4130,
];

/// A drill by its number.
pub(super) fn wire(number: f64) -> Option<f64> {
    let index = (number.fract() == 0.0 && number >= 1.0).then_some(number as usize - 1)?;
    WIRE.get(index).map(|size| f64::from(*size) * 1e-4)
}

/// A drill by its letter.
pub(super) fn letter(letter: &str) -> Option<f64> {
    match letter.as_bytes() {
        [letter @ b'A'..=b'Z'] => Some(f64::from(LETTERS[usize::from(letter - b'A')]) * 1e-4),
        _ => None,
    }
}

/// The outer diameter of a machine screw by its number.
pub(super) fn screw(number: f64) -> Option<f64> {
    (number.fract() == 0.0 && (0.0..=12.0).contains(&number)).then_some(0.060 + 0.013 * number)
}
