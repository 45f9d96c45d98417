//! Numbers as text.

/// The shortest text that reads back to the same `f64`; without an exponent, if that takes up to four characters: `1`, `0.1`, `1000`, `1e-7`.
#[must_use]
pub fn shortest(value: f64) -> String {
    // Most numbers have a fraction and no zeros to be saved: theirs are the digits of any shortest text.
    if (0.01..1e12).contains(&value.abs()) {
        let mut buffer = zmij::Buffer::new();
        let text = buffer.format_finite(value);
        if !text.ends_with(".0") {
            return text.to_owned();
        }
    }
    let plain = value.to_string();
    // An exponent is shorter only in place of zeros at an end.
    if plain.len() < 5 || (value.abs() >= 1.0 && plain.contains('.')) {
        return plain;
    }
    let scientific = format!("{value:e}");
    if scientific.len() < plain.len() {
        scientific
    } else {
        plain
    }
}

/// For notes: six significant digits, so that ten times a millionth is `0.00001` and not `0.000009999999999999999`.
pub(crate) fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::{rounded, shortest};

    #[test]
    fn notes_are_rounded() {
        for (value, near) in [
            (10.0 * 1e-6, 1e-5),
            (1e-3, 1e-3),
            (0.1 + 0.2, 0.3),
            (1.0 / 3.0, 0.333_333),
        ] {
            assert_eq!(rounded(value), near);
        }
        assert!(rounded(f64::NAN).is_nan());
    }

    #[test]
    fn is_short_and_exact() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "-0"),
            (1.5, "1.5"),
            (1e-7, "1e-7"),
            (1e22, "1e22"),
            (123.25, "123.25"),
        ] {
            assert_eq!(shortest(value), text);
        }
        let mut value = 1.234_567_891_234_567_8e-300_f64;
        while value.is_finite() {
            let rounded = format!("{value:.2e}").parse().unwrap();
            for value in [value, value.trunc(), (value * 8.0).round() / 8.0, rounded, 0.01 + value] {
                let (text, [plain, scientific]) = (shortest(value), [value.to_string(), format!("{value:e}")]);
                assert_eq!(text.parse::<f64>().unwrap().to_bits(), value.to_bits());
                let is_plain = plain.len() < 5 || plain.len() <= scientific.len();
                let shorter = if is_plain { plain } else { scientific };
                assert_eq!(text, shorter);
            }
            value *= if (1e-4..1e14).contains(&value.abs()) {
                -1.003
            } else {
                -1.7e3
            };
        }
    }
}
