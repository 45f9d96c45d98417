//! Parsers of option values.

use std::path::Path;
use sweepsim::systems::Plane;
use sweepsim_job::{DeviationLimits, StockOption};
use sweepsim_picture::{Axis, CuttingPlane, Image, View};

/// Parses one of several names, which clap lists in its help.
pub(super) fn parsed<T, const N: usize>(names: [&'static str; N]) -> clap::builder::ValueParser
where
    T: std::str::FromStr<Err: std::error::Error + Send + Sync + 'static> + Clone + Send + Sync + 'static,
{
    use clap::builder::TypedValueParser;
    clap::builder::PossibleValuesParser::new(names)
        .try_map(|name| name.parse::<T>())
        .into()
}

pub(super) fn cells(text: &str) -> Result<[usize; 2], String> {
    let parts: Vec<_> = text.split(['x', 'X', '×']).map(str::parse).collect();
    match parts[..] {
        [Ok(columns), Ok(rows)] => Ok([columns, rows]),
        _ => Err("expected two whole numbers, like 300x200".to_owned()),
    }
}

pub(super) fn size(text: &str) -> Result<[usize; 2], String> {
    let size = cells(text)?;
    let most = Image::MAX_SIDE;
    if size.iter().all(|n| (1..=most).contains(n)) {
        Ok(size)
    } else {
        Err(format!("expected 1 to {most} each way"))
    }
}

pub(super) fn limits(text: &str) -> Result<DeviationLimits, String> {
    if Path::new(text)
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("ron"))
    {
        return Ok(DeviationLimits::Job(text.into()));
    }
    let pair = pair(text).map(DeviationLimits::Both);
    pair.map_err(|expected| expected + ", or a job (.ron)")
}

/// Limits for gouges and for excess.
pub(super) fn pair(text: &str) -> Result<[f64; 2], String> {
    let numbers: Vec<_> = text.split(',').map(|word| word.trim().parse::<f64>()).collect();
    match numbers[..] {
        [Ok(gouge), Ok(excess)] if gouge >= 0.0 && excess >= 0.0 && gouge.is_finite() && excess.is_finite() => {
            Ok([gouge, excess])
        }
        _ => Err("expected two lengths, for gouges and for excess, like 0.02,0.1".to_owned()),
    }
}

/// `5,5,2`: lengths along x, y and z.
pub(super) fn triple(text: &str) -> Result<[f64; 3], String> {
    let numbers: Vec<_> = text.split(',').map(|word| word.trim().parse::<f64>()).collect();
    match numbers[..] {
        [Ok(x), Ok(y), Ok(z)] if [x, y, z].iter().all(|way| *way >= 0.0 && way.is_finite()) => Ok([x, y, z]),
        _ => Err("expected three lengths, along x, y and z, like 5,5,2".to_owned()),
    }
}

/// `D3=0.25`, or `3=0.25`.
pub(super) fn diameter(text: &str) -> Result<(u32, f64), String> {
    let parts = text.trim().trim_start_matches(['D', 'd']).split_once('=');
    match parts.map(|(number, size)| (number.trim().parse(), size.trim().parse::<f64>())) {
        Some((Ok(number), Ok(size))) if size >= 0.0 && size.is_finite() => Ok((number, size)),
        _ => Err("expected the number of a register and a diameter of 0 or more, like D3=0.25".to_owned()),
    }
}

/// `G55=100,0,0`.
pub(super) fn offset(text: &str) -> Result<(String, [f64; 3]), String> {
    let expected = || "expected a work offset and three numbers, like G55=100,0,0".to_owned();
    let (name, list) = text.split_once('=').ok_or_else(expected)?;
    let numbers: Vec<_> = list.split(',').map(|word| word.trim().parse::<f64>()).collect();
    let name: String = name.chars().filter(|c| !c.is_whitespace()).collect();
    let name = if name.starts_with(['g', 'G']) {
        name.to_ascii_uppercase()
    } else {
        name.to_ascii_lowercase()
    };
    match numbers[..] {
        [Ok(x), Ok(y), Ok(z)] if !name.is_empty() && [x, y, z].iter().all(|c| c.is_finite()) => Ok((name, [x, y, z])),
        _ => Err(expected()),
    }
}

pub(super) fn area(text: &str) -> Result<[f64; 4], String> {
    let numbers: Vec<_> = text.split(',').map(|word| word.trim().parse::<f64>()).collect();
    match numbers[..] {
        [Ok(x0), Ok(y0), Ok(x1), Ok(y1)] if x0 < x1 && y0 < y1 && [x0, y0, x1, y1].iter().all(|c| c.is_finite()) => {
            Ok([x0, y0, x1, y1])
        }
        _ => Err("expected four numbers, the lower and the upper corner, like 0,0,60,40".to_owned()),
    }
}

pub(super) fn camera(text: &str) -> Result<View, String> {
    let iso = View::default();
    let mut view = iso;
    let mut angles = Vec::new();
    for word in text.split(',').map(str::trim) {
        let named = match word {
            "iso" => Some([iso.azimuth, iso.elevation]),
            "front" => Some([-90.0, 0.0]),
            "right" => Some([0.0, 0.0]),
            "back" => Some([90.0, 0.0]),
            "left" => Some([180.0, 0.0]),
            "top" => Some([-90.0, 90.0]),
            "bottom" => Some([-90.0, -90.0]),
            _ => None,
        };
        match (named, word, word.parse::<f64>()) {
            (Some(named), ..) if angles.is_empty() => angles.extend(named),
            (None, "orthographic", _) => view.orthographic = true,
            (None, "perspective", _) => view.orthographic = false,
            (None, _, Ok(angle)) if angle.is_finite() && angles.len() < 2 => angles.push(angle),
            _ => angles.push(f64::NAN),
        }
    }
    match angles[..] {
        [] => Ok(view),
        [azimuth, elevation] if azimuth.is_finite() && elevation.abs() <= 90.0 => {
            (view.azimuth, view.elevation) = (azimuth, elevation);
            Ok(view)
        }
        _ => Err(
            "expected iso, front, back, left, right, top, bottom or two angles like -58,40 (the second from -90 to 90), \
             and perhaps orthographic"
                .to_owned(),
        ),
    }
}

pub(super) fn section(text: &str) -> Result<CuttingPlane, String> {
    let parts = text
        .split_once('=')
        .map(|(axis, at)| (axis.trim(), at.trim().parse::<f64>()));
    let axis = match parts {
        Some(("x", _)) => Some(Axis::X),
        Some(("y", _)) => Some(Axis::Y),
        Some(("z", _)) => Some(Axis::Z),
        _ => None,
    };
    match (axis, parts) {
        (Some(axis), Some((_, Ok(at)))) if at.is_finite() => Ok(CuttingPlane { axis, at }),
        _ => Err("expected an axis and a number, like z=5".to_owned()),
    }
}

/// The side of a tile.
pub(super) fn tile(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(lines @ 8..=4096) => Ok(lines),
        _ => Err("expected a whole number from 8 to 4096".to_owned()),
    }
}

/// A length in millimetres that may be 0.
pub(super) fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value >= 0.0 && value.is_finite() => Ok(value),
        _ => Err("expected a number of millimetres, 0 or greater".to_owned()),
    }
}

pub(super) fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("expected a positive number of millimetres".to_owned()),
    }
}

/// `auto`, `block:` and six numbers, or a file.
pub(crate) fn stock(text: &str) -> Result<StockOption, String> {
    if text.eq_ignore_ascii_case("auto") {
        return Ok(StockOption::Auto);
    }
    let Some(list) = text.strip_prefix("block:") else {
        return Ok(StockOption::Mesh(text.into()));
    };
    let numbers: Result<Vec<f64>, _> = list.split(',').map(|word| word.trim().parse()).collect();
    match numbers.ok().and_then(|n| <[f64; 6]>::try_from(n).ok()) {
        Some([a, b, c, x, y, z]) if a < x && b < y && c < z && [a, b, c, x, y, z].iter().all(|n| n.is_finite()) => {
            Ok(StockOption::Block([[a, b, c], [x, y, z]]))
        }
        _ => Err("expected the lower and the upper corner in millimetres, like block:0,0,-20,60,40,0".to_owned()),
    }
}

/// `x=1.5`, `y=…`, `z=…`, or `a,b,c=d` for the plane `a x + b y + c z = d`.
pub(crate) fn plane(text: &str) -> Result<Plane, String> {
    let wrong = || "expected a plane, like x=3.5, or a,b,c=d for a x + b y + c z = d".to_owned();
    let (normal, offset) = text.split_once('=').ok_or_else(wrong)?;
    let offset: f64 = offset.trim().parse().map_err(|_| wrong())?;
    let normal: [f64; 3] = match normal.trim() {
        "x" => [1.0, 0.0, 0.0],
        "y" => [0.0, 1.0, 0.0],
        "z" => [0.0, 0.0, 1.0],
        list => {
            let numbers: Result<Vec<f64>, _> = list.split(',').map(|part| part.trim().parse()).collect();
            numbers.ok().and_then(|n| n.try_into().ok()).ok_or_else(wrong)?
        }
    };
    Plane::new(normal, offset).map_err(|_| wrong())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cameras_and_sections_are_read() {
        let top = camera("top,orthographic").unwrap();
        assert_eq!((top.azimuth, top.elevation, top.orthographic), (-90.0, 90.0, true));
        let other = camera("orthographic, -20.5, 10").unwrap();
        assert_eq!(
            (other.azimuth, other.elevation, other.orthographic),
            (-20.5, 10.0, true)
        );
        assert!(!camera("iso").unwrap().orthographic);
        for bad in [
            "",
            "under",
            "1",
            "1,2,3",
            "0,91",
            "NaN,0",
            "top,5",
            "top,front",
            "inf,1",
        ] {
            assert!(camera(bad).is_err(), "{bad}");
        }
        let plane = section("y = -2.5").unwrap();
        assert_eq!((plane.axis, plane.at), (Axis::Y, -2.5));
        for bad in ["", "x", "x=", "w=1", "x=inf", "x=1=2"] {
            assert!(section(bad).is_err(), "{bad}");
        }
        assert_eq!(area("-1,0,2.5,3"), Ok([-1.0, 0.0, 2.5, 3.0]));
        for bad in ["", "1,2,3", "0,0,0,1", "0,0,inf,1", "0,0,1,1,1"] {
            assert!(area(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn cells_are_two_numbers() {
        assert_eq!(cells("300x200"), Ok([300, 200]));
        assert_eq!(cells("3×2"), Ok([3, 2]));
        for bad in ["300", "x", "300x", "3x4x5", "-1x3", "1.5x2", "99999999999999999999x1"] {
            assert!(cells(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn planes_are_read() {
        assert_eq!(plane("x=3.5"), Ok(Plane::x(3.5).unwrap()));
        assert_eq!(plane(" z = -1 "), Ok(Plane::z(-1.0).unwrap()));
        let slanted = Plane::new([1.0, 0.0, 2.0], 4.0).unwrap();
        assert_eq!(plane("1,0,2=4"), Ok(slanted));
        for bad in [
            "",
            "x",
            "x=",
            "w=1",
            "1,2=3",
            "0,0,0=1",
            "1,2,3,4=5",
            "x=NaN",
            "inf,0,0=1",
        ] {
            assert!(plane(bad).is_err(), "{bad}");
        }
    }
}
