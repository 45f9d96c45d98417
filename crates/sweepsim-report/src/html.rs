//! Text that is safe in HTML.

/// Text with the characters that HTML gives a meaning escaped; for elements and quoted attributes.
pub(crate) fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            // Not allowed in HTML at all.
            '\0'..='\x08' | '\x0b' | '\x0c' | '\x0e'..='\x1f' | '\x7f' => safe.push('\u{fffd}'),
            c => safe.push(c),
        }
    }
    safe
}

/// JSON for a script element: no text in it can end the element.
pub(crate) fn json<T: serde::Serialize>(value: &T) -> String {
    let text = serde_json::to_string(value).expect("plain data with names as keys can be serialised");
    text.replace('<', "\\u003c")
}

/// A length, area or volume for people: about four significant digits, without zeros at the end, with thousands
/// separators.
///
/// ```
/// use sweepsim_report::measure;
/// assert_eq!([measure(0.02), measure(-12.3456), measure(32_875.4)], ["0.02", "−12.35", "32,875"]);
/// ```
#[must_use]
pub fn measure(value: f64) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    let whole = if value == 0.0 { 0.0 } else { value.abs().log10().floor() };
    let decimals = (3.0 - whole).clamp(0.0, 6.0) as usize;
    let text = format!("{:.decimals$}", value.abs());
    let text = match text.split_once('.') {
        Some((front, rest)) => {
            let rest = rest.trim_end_matches('0');
            let point = if rest.is_empty() { "" } else { "." };
            format!("{}{point}{rest}", grouped(front))
        }
        None => grouped(&text),
    };
    if value < 0.0 && text != "0" {
        format!("−{text}")
    } else {
        text
    }
}

/// Digits in groups of three.
///
/// ```
/// assert_eq!(["999", "1234567"].map(sweepsim_report::grouped), ["999", "1,234,567"]);
/// ```
#[must_use]
pub fn grouped(digits: &str) -> String {
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_leaves_its_element() {
        assert_eq!(escape("</script><b x='\"&"), "&lt;/script&gt;&lt;b x=&#39;&quot;&amp;");
        assert_eq!(escape("G1\u{0}X1"), "G1\u{fffd}X1");
        assert_eq!(json(&"</script><!--"), "\"\\u003c/script>\\u003c!--\"");
    }

    #[test]
    fn numbers_are_easy_to_read() {
        let cases = [
            (0.0, "0"),
            (0.02, "0.02"),
            (1234.5678, "1,235"),
            (12.3456, "12.35"),
            (-0.5, "−0.5"),
            (1e7, "10,000,000"),
            (f64::NAN, "–"),
            (-1e-9, "0"),
        ];
        for (value, words) in cases {
            assert_eq!(measure(value), words, "{value}");
        }
    }
}
