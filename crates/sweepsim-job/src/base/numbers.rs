//! Numbers for people.

/// `1234567` as `1,234,567`.
#[must_use]
pub fn count(number: u64) -> String {
    sweepsim_report::grouped(&number.to_string())
}

/// A number of things, with an `s` in the plural.
#[must_use]
pub fn counted(number: u64, one: &str) -> String {
    let many = match one {
        _ if number == 1 => one.to_owned(),
        "torus" => "tori".to_owned(),
        _ if one.ends_with("ch") => format!("{one}es"),
        _ => format!("{one}s"),
    };
    format!("{} {many}", count(number))
}

/// A measure that is less is none; and one that is less than this is written with a power of ten.
const LEAST: f64 = 5e-13;
const SMALL: f64 = 1e-6;

/// A measure with five significant digits, and thousands separators; a very small one with two.
#[must_use]
pub fn measure(value: f64) -> String {
    if !value.is_finite() {
        return value.to_string();
    }
    if value.abs() < LEAST {
        return "0".to_owned();
    }
    let sign = if value < 0.0 { "−" } else { "" };
    if value.abs() < SMALL {
        return format!("{sign}{:.1e}", value.abs());
    }
    let whole = value.abs().log10().floor();
    let decimals = (4.0 - whole).clamp(0.0, 12.0) as usize;
    let text = format!("{:.decimals$}", value.abs());
    let (front, rest) = text.split_at(text.find('.').unwrap_or(text.len()));
    match front.parse() {
        Ok(front) => format!("{sign}{}{rest}", count(front)),
        Err(_) => format!("{sign}{text}"),
    }
}

/// A length in a sentence: as [`measure`], without zeros at the end.
#[must_use]
pub fn length(value: f64) -> String {
    let text = measure(value);
    match text.contains('.') && !text.contains('e') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// A duration in seconds.
#[must_use]
pub fn seconds(value: f64) -> String {
    if value >= 100.0 {
        format!("{value:.0} s")
    } else if value >= 1.0 {
        format!("{value:.1} s")
    } else {
        format!("{:.0} ms", value * 1e3)
    }
}

/// A file size.
#[must_use]
pub fn bytes(value: u64) -> String {
    match value {
        0..1_000 => format!("{value} B"),
        1_000..1_000_000 => format!("{:.1} kB", value as f64 / 1e3),
        1_000_000..1_000_000_000 => format!("{:.1} MB", value as f64 / 1e6),
        _ => format!("{:.1} GB", value as f64 / 1e9),
    }
}

/// A point.
#[must_use]
pub fn point(place: [f64; 3]) -> String {
    let [x, y, z] = place.map(measure);
    format!("({x}, {y}, {z})")
}

/// A direction of the part: one of its axes by name, or its numbers.
#[must_use]
pub fn direction(v: [f64; 3]) -> String {
    let along = (0..3).find(|k| (v[*k].abs() - 1.0).abs() < 1e-12);
    match along {
        Some(k) => format!("{}{}", if v[k] < 0.0 { "−" } else { "+" }, ["X", "Y", "Z"][k]),
        None => point(v),
    }
}

/// A duration on a machine.
#[must_use]
pub fn clock(duration: f64) -> String {
    if duration < 60.0 {
        return seconds(duration);
    }
    let whole = duration.round() as u64;
    let (hours, minutes, rest) = (whole / 3600, whole / 60 % 60, whole % 60);
    if hours > 0 {
        format!("{hours} h {minutes} min")
    } else {
        format!("{minutes} min {rest} s")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_easy_to_read() {
        assert_eq!(count(0), "0");
        assert_eq!(count(999), "999");
        assert_eq!(count(1_234_567), "1,234,567");
        assert_eq!(counted(1, "move"), "1 move");
        assert_eq!(counted(1000, "move"), "1,000 moves");
        assert_eq!(counted(1, "torus"), "1 torus");
        assert_eq!(counted(9, "torus"), "9 tori");
        assert_eq!(counted(2, "patch"), "2 patches");
        assert_eq!(measure(60847.04), "60,847");
        assert_eq!(measure(-0.012_345_67), "−0.012346");
        assert_eq!(measure(12.0), "12.000");
        assert_eq!([0.0, -5.2e-15, 4e-13].map(measure), ["0"; 3]);
        assert_eq!(measure(-6e-13), "−6.0e-13");
        assert_eq!([5.051e-9, 1e-6].map(measure), ["5.1e-9", "0.0000010000"]);
        assert_eq!(measure(f64::NAN), "NaN");
        assert_eq!(
            [12.0, 0.5, -90.25, 1234.0, 0.0].map(length),
            ["12", "0.5", "−90.25", "1,234", "0"]
        );
        assert_eq!([1e-6, 1e-10].map(length), ["0.000001", "1.0e-10"]);
        assert_eq!(seconds(0.0123), "12 ms");
        assert_eq!([5.25, 75.4, 3725.0].map(clock), ["5.2 s", "1 min 15 s", "1 h 2 min"]);
        assert_eq!(bytes(1_500_000), "1.5 MB");
        assert_eq!(bytes(86_400_000_000), "86.4 GB");
    }
}
