//! Whether a point near some of a surface is outside.

use super::pieces::Piece;
use super::way::Triangle;
use nalgebra::Vector3;

/// As many targets are tried.
const TRIES: usize = 12;

/// Whether a point is outside, if all that lies between it and the pieces is among them: by the first triangle on the
/// way to the middle of one. `None` if every way meets an edge.
pub(crate) fn is_outside<'a>(
    point: &Vector3<f64>,
    pieces: impl ExactSizeIterator<Item = Piece<'a>> + Clone,
    triangles: &[Triangle],
) -> Option<bool> {
    let step = pieces.len().div_ceil(TRIES).max(1);
    pieces.clone().step_by(step).find_map(|piece| {
        let count = piece.corners.len() as f64;
        let target = piece.corners.iter().sum::<Vector3<f64>>() / count;
        let way = target - point;
        let mut first: Option<(f64, f64)> = None;
        for other in pieces.clone() {
            let triangle = &triangles[other.triangle as usize];
            let slope = triangle.normal.dot(&way);
            let [a, b, c] = triangle.corners;
            let height = triangle.normal.dot(&(a - point));
            if slope.abs() <= 1e-7 * way.norm() {
                // Along the triangle: only near its plane can it be met.
                if height.abs() <= 1e-6 * way.norm() {
                    return None;
                }
                continue;
            }
            let t = height / slope;
            if t < -1e-9 || first.is_some_and(|(before, _)| t > before + 1e-9) {
                continue;
            }
            let at = point + way * t;
            let edges = [(a, b), (b, c), (c, a)];
            // The heights above the edges, in parts of the triangle's.
            let least = edges.iter().map(|(p, q)| {
                let inwards = triangle.normal.cross(&(q - p));
                let scale = [a, b, c]
                    .iter()
                    .map(|corner| inwards.dot(&(corner - p)))
                    .fold(0.0, f64::max);
                inwards.dot(&(at - p)) / scale
            });
            let least = least.fold(f64::INFINITY, f64::min);
            if least < -1e-7 {
                continue;
            }
            if least < 1e-7 || t < 1e-9 {
                return None;
            }
            match first {
                // Two at once: it is not known which is first.
                Some((before, other)) if (t - before).abs() <= 1e-9 && other.signum() != slope.signum() => return None,
                Some((before, _)) if t > before => {}
                _ => first = Some((t, slope)),
            }
        }
        first.map(|(_, slope)| slope < 0.0)
    })
}
