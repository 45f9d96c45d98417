//! Tori that meet themselves.
//!
//! A torus whose minor radius `r` is larger than the major one, `R`, has points with `R + r cos v < 0` on the far side of
//! its axis, and crowned heads and lenses are made of these. The library takes each point of such a torus for one of the
//! near side. As a surface of revolution, of the circle about the axis, it has the same parameters and the same normals,
//! and there points are looked for at all of them.

use super::scan::Scan;

/// A torus as a surface of revolution, from its keyword to the semicolon, and what that refers to; `None` of a torus that
/// does not meet itself, or is not placed as it should be. Numbers from `next` on are free.
pub(super) fn revolved(scan: &Scan, text: &[u8], torus: u64, next: &mut u64) -> Option<String> {
    let torus = scan.attributes(text, torus as usize)?;
    let [_, placement, major, minor, ..] = torus[..] else {
        return None;
    };
    let (major, minor) = (number(major)?, number(minor)?);
    if minor <= major {
        return None;
    }
    let placement = scan.attributes(text, reference(placement)?)?;
    let [_, origin, axis, ahead] = placement[..] else {
        return None;
    };
    let vector = |at: &[u8]| vector(scan.attributes(text, reference(at)?)?.get(1)?);
    let (centre, z, x) = (vector(origin)?, vector(axis)?, vector(ahead)?);
    let length = x.iter().map(|c| c * c).sum::<f64>().sqrt();
    let centre: [f64; 3] = std::array::from_fn(|k| centre[k] + major * x[k] / length);
    let across: [f64; 3] = std::array::from_fn(|k| x[(k + 1) % 3] * z[(k + 2) % 3] - x[(k + 2) % 3] * z[(k + 1) % 3]);
    let words = |[x, y, z]: [f64; 3]| format!("({x:.17},{y:.17},{z:.17})");
    let [point, direction, place, circle, turn] = std::array::from_fn(|k| *next + k as u64);
    *next += 5;
    let [origin, axis, ahead] = [origin, axis, ahead].map(String::from_utf8_lossy);
    Some(format!(
        "SURFACE_OF_REVOLUTION('',#{circle},#{turn});\n\
         #{point}=CARTESIAN_POINT('',{});\n#{direction}=DIRECTION('',{});\n\
         #{place}=AXIS2_PLACEMENT_3D('',#{point},#{direction},{ahead});\n\
         #{circle}=CIRCLE('',#{place},{minor:.17});\n#{turn}=AXIS1_PLACEMENT('',{origin},{axis});",
        words(centre),
        words(across),
    ))
}

fn reference(attribute: &[u8]) -> Option<usize> {
    let words = std::str::from_utf8(attribute).ok()?;
    words.trim().strip_prefix('#')?.parse().ok()
}

fn number(attribute: &[u8]) -> Option<f64> {
    std::str::from_utf8(attribute).ok()?.trim().parse().ok()
}

fn vector(attribute: &[u8]) -> Option<[f64; 3]> {
    let words = std::str::from_utf8(attribute).ok()?.trim();
    let inside = words.strip_prefix('(')?.strip_suffix(')')?;
    let all: Option<Vec<f64>> = inside.split(',').map(|c| c.trim().parse().ok()).collect();
    all?.try_into().ok()
}
