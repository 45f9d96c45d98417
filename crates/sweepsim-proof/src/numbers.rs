//! Numbers in what is left behind for a checker.

/// Adds a number in groups of seven bits, the lowest first; each but the last has its highest bit set.
pub(crate) fn write_number(bytes: &mut impl Extend<u8>, mut number: usize) {
    while number > 0x7f {
        bytes.extend([number as u8 | 0x80]);
        number >>= 7;
    }
    bytes.extend([number as u8]);
}
