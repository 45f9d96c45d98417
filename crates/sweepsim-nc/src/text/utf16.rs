//! Texts in UTF-16, as Windows' editors and PowerShell's redirection write them, with a mark that says so.

/// Such a text as UTF-8, or `None` if it has no mark. What is no character is replaced by U+FFFD.
pub(crate) fn as_utf8(bytes: &[u8]) -> Option<Vec<u8>> {
    let unit: fn([u8; 2]) -> u16 = match bytes {
        [0xff, 0xfe, ..] => u16::from_le_bytes,
        [0xfe, 0xff, ..] => u16::from_be_bytes,
        _ => return None,
    };
    let (pairs, rest) = bytes[2..].as_chunks();
    let units = pairs.iter().map(|pair| unit(*pair));
    let text = char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER));
    // Half a unit is none.
    let cut_off = (!rest.is_empty()).then_some(char::REPLACEMENT_CHARACTER);
    Some(text.chain(cut_off).collect::<String>().into_bytes())
}
