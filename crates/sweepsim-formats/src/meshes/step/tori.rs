//! Tori that meet themselves.
//!
//! A torus whose minor radius `r` is larger than the major one, `R`, has points with `R + r cos v < 0` on the far side
//! of its axis, and crowned heads and lenses are made of these. The library takes each point of such a torus for one of
//! the near side. The surface of revolution of its circle has the same parameters and the same normals, and there the
//! library looks for points on both sides.

use nalgebra::Vector3;

/// A torus as a surface of revolution, from its keyword to the semicolon, and what that refers to; `None` of a torus
/// that does not meet itself, or is not placed as it should be. `attributes`: of each entity. Numbers from `next` on
/// are free.
pub(super) fn revolved<'a>(
    torus: u64,
    attributes: impl Fn(usize) -> Option<Vec<&'a [u8]>>,
    next: &mut u64,
) -> Option<String> {
    let torus = attributes(torus as usize)?;
    let [_, placement, major, minor, ..] = torus[..] else {
        return None;
    };
    let (major, minor) = (number(major)?, number(minor)?);
    if !(minor > major) {
        return None;
    }
    let placement = attributes(reference(placement)?)?;
    let [_, origin, axis, ahead] = placement[..] else {
        return None;
    };
    let vector = |at: &[u8]| vector(attributes(reference(at)?)?.get(1)?);
    let (centre, z, ahead) = (vector(origin)?, vector(axis)?.normalize(), vector(ahead)?);
    let x = (ahead - z * z.dot(&ahead)).normalize();
    let words = |v: Vector3<f64>| format!("({:.17},{:.17},{:.17})", v.x, v.y, v.z);
    let first = *next;
    *next = next.checked_add(6)?;
    let [point, direction, other, place, circle, turn] = std::array::from_fn(|k| first + k as u64);
    let [origin, axis] = [origin, axis].map(String::from_utf8_lossy);
    Some(format!(
        "SURFACE_OF_REVOLUTION('',#{circle},#{turn});\n\
         #{point}=CARTESIAN_POINT('',{});\n#{direction}=DIRECTION('',{});\n#{other}=DIRECTION('',{});\n\
         #{place}=AXIS2_PLACEMENT_3D('',#{point},#{direction},#{other});\n\
         #{circle}=CIRCLE('',#{place},{minor:.17});\n#{turn}=AXIS1_PLACEMENT('',{origin},{axis});",
        words(centre + x * major),
        words(x.cross(&z)),
        words(x),
    ))
}

fn reference(attribute: &[u8]) -> Option<usize> {
    let words = std::str::from_utf8(attribute).ok()?;
    words.trim().strip_prefix('#')?.parse().ok()
}

fn number(attribute: &[u8]) -> Option<f64> {
    std::str::from_utf8(attribute).ok()?.trim().parse().ok()
}

fn vector(attribute: &[u8]) -> Option<Vector3<f64>> {
    let words = std::str::from_utf8(attribute).ok()?.trim();
    let inside = words.strip_prefix('(')?.strip_suffix(')')?;
    let all: Option<Vec<f64>> = inside.split(',').map(|c| c.trim().parse().ok()).collect();
    let all: [f64; 3] = all?.try_into().ok()?;
    Some(all.into())
}
