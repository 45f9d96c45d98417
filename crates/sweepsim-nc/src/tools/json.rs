//! Access to JSON values by name.

use serde_json::Value;

use crate::text::error::{NcError, NcProblem, TextPosition};

/// The value of a text.
pub(super) fn parse(text: &str) -> Result<Value, NcError> {
    serde_json::from_str(text.trim_start_matches('\u{feff}')).map_err(|error| {
        let line = error.line().max(1);
        let whole = text.lines().nth(line - 1).unwrap_or("");
        let problem = NcProblem::syntax(format!("this is not JSON: {error}"));
        NcError::new(problem, Some(TextPosition::in_line(line, whole, error.column(), 1)))
    })
}

/// A finite number.
pub(super) fn number(value: &Value, name: &str) -> Option<f64> {
    let found = value.get(name)?;
    let number = found.as_f64().or_else(|| found.as_str()?.trim().parse().ok())?;
    number.is_finite().then_some(number)
}

/// A text that is not empty.
pub(super) fn string(value: &Value, name: &str) -> Option<String> {
    let text = value.get(name)?.as_str()?.trim();
    (!text.is_empty()).then(|| text.to_owned())
}

/// A tool number.
pub(super) fn tool_number(value: &Value) -> Option<u32> {
    value
        .as_u64()
        .or_else(|| value.as_str()?.trim().parse().ok())
        .and_then(|number| u32::try_from(number).ok())
}

/// A measure with its unit, `6 mm`, `0.25 in`, `118 deg`, `45.0000 °`: in millimetres or degrees. `None` for formulas.
pub(super) fn measure(text: &str, default_unit: f64) -> Option<f64> {
    let text = text.trim();
    let end = text
        .find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | '-' | '+')))
        .unwrap_or(text.len());
    let value: f64 = text[..end].parse().ok()?;
    let factor = match text[end..].trim() {
        "" => default_unit,
        "mm" | "deg" | "°" => 1.0,
        "cm" => 10.0,
        "m" => 1000.0,
        "um" | "µm" | "μm" => 1e-3,
        "in" | "\"" | "inch" => 25.4,
        "rad" => 180.0 / std::f64::consts::PI,
        _ => return None,
    };
    Some(value * factor).filter(|value| value.is_finite())
}
