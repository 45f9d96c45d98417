//! Numbers as text.

/// The shortest text that reads back to the same `f64`: `1`, `0.1`, `1e-7`.
#[must_use]
pub fn shortest(value: f64) -> String {
    let plain = value.to_string();
    // An exponent is shorter only for many digits.
    if plain.len() < 5 {
        return plain;
    }
    let scientific = format!("{value:e}");
    if scientific.len() < plain.len() {
        scientific
    } else {
        plain
    }
}

#[cfg(test)]
mod tests {
    use super::shortest;

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
            assert_eq!(shortest(value).parse::<f64>().unwrap().to_bits(), value.to_bits());
            value *= -1.7e3;
        }
    }
}
