//! The units of a file. The library takes those of the first context for all, and 1 for what it does not know.

use kentron::io::step::{Exchange, Value};

use super::audit::{Refused, missing};

/// The most units that are built on one another.
const MOST_LINKS: usize = 60;

/// Millimetres per unit of length, as every context of the file says in which there are shapes, and the first one.
pub(super) fn length(x: &Exchange) -> Result<f64, Refused> {
    let mut length: Option<(f64, usize)> = None;
    let mut angle: Option<(f64, usize)> = None;
    let mut first = true;
    for (context, instance) in x.of_type("GLOBAL_UNIT_ASSIGNED_CONTEXT") {
        let list = instance
            .record("GLOBAL_UNIT_ASSIGNED_CONTEXT")
            .and_then(|p| x.list(p.first()?));
        for unit in list.unwrap_or(&[]).iter().filter_map(Value::as_reference) {
            let entity = x.get(unit).map_err(|_| missing(context, unit))?;
            let (known, what) = if entity.has("LENGTH_UNIT") {
                (&mut length, "length")
            } else if entity.has("PLANE_ANGLE_UNIT") {
                (&mut angle, "angles")
            } else {
                continue;
            };
            let value = factor(x, unit, what, MOST_LINKS)?;
            match *known {
                Some((other, at)) if (value - other).abs() > 1e-9 * other && has_shapes(x, context) => {
                    let message =
                        format!("the unit of {what} differs from that of #{at}: expected one for the whole file");
                    return Err((context, message));
                }
                Some(_) => {}
                None => *known = Some((value, context)),
            }
        }
        if first && length.is_none() {
            return Err((context, "this context has no unit of length: expected one".into()));
        }
        first = false;
    }
    if let (None, Some((cone, _))) = (angle, x.of_type("CONICAL_SURFACE").next()) {
        return Err((cone, "a cone in a file without a unit of angles: expected one".into()));
    }
    let none = || {
        (
            0,
            "no unit of length is in this file: expected a context with one".to_owned(),
        )
    };
    Ok(length.ok_or_else(none)?.0)
}

/// Whether a context is one of shapes, or of nothing: colours and texts have contexts of their own.
fn has_shapes(x: &Exchange, context: usize) -> bool {
    let mut is_used = false;
    for instance in x.ids().filter_map(|number| x.get(number).ok()) {
        let refers = |values: &[Value]| values.iter().any(|value| value.as_reference() == Some(context));
        if instance.records().any(|(_, values)| refers(values)) {
            is_used = true;
            if instance
                .records()
                .any(|(name, _)| name.ends_with("SHAPE_REPRESENTATION"))
            {
                return true;
            }
        }
    }
    !is_used
}

/// Millimetres or radians per unit.
fn factor(x: &Exchange, number: usize, what: &str, deep: usize) -> Result<f64, Refused> {
    let unknown = || {
        (
            number,
            format!("#{number} is no unit of {what} that is known: expected metres, inches, radians or degrees"),
        )
    };
    let unit = x.get(number).map_err(|_| unknown())?;
    if let Some(si) = unit.record("SI_UNIT") {
        let [prefix, name] = si else { return Err(unknown()) };
        let prefix = match prefix.as_enumeration() {
            None => 1.0,
            Some("KILO") => 1e3,
            Some("DECI") => 1e-1,
            Some("CENTI") => 1e-2,
            Some("MILLI") => 1e-3,
            Some("MICRO") => 1e-6,
            Some("NANO") => 1e-9,
            Some(_) => return Err(unknown()),
        };
        return match name.as_enumeration() {
            Some("METRE") if what == "length" => Ok(1e3 * prefix),
            Some("RADIAN") if what == "angles" => Ok(prefix),
            _ => Err(unknown()),
        };
    }
    let conversion = unit
        .record("CONVERSION_BASED_UNIT")
        .filter(|_| deep > 0)
        .ok_or_else(unknown)?;
    let measure = conversion.get(1).and_then(Value::as_reference).ok_or_else(unknown)?;
    let measure = x.get(measure).map_err(|_| missing(number, measure))?;
    let with_unit = measure.records().find(|(name, _)| name.ends_with("MEASURE_WITH_UNIT"));
    let Some((_, [value, base, ..])) = with_unit else {
        return Err(unknown());
    };
    let base = base.as_reference().ok_or_else(unknown)?;
    let value = x
        .real(value)
        .filter(|value| *value > 0.0 && value.is_finite())
        .ok_or_else(unknown)?;
    let value = value * factor(x, base, what, deep - 1)?;
    let name = conversion[0].as_str().unwrap_or_default().trim().to_ascii_uppercase();
    let known = [
        ("INCH", 25.4),
        ("INCHES", 25.4),
        ("FOOT", 304.8),
        ("MILLIMETRE", 1.0),
        ("DEGREE", 1_f64.to_radians()),
    ];
    match known.iter().find(|(known, _)| *known == name) {
        Some((_, expected)) if (value - expected).abs() > 1e-4 * expected => {
            let message = format!("#{number} is called {name}, but its factor is {value}: expected {expected}");
            Err((number, message))
        }
        _ => Ok(value),
    }
}
