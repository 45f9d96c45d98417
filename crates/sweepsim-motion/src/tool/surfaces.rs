//! B-spline surfaces as patches.

use crate::boundary::{Patch, ToolError};
use sweepsim_spline::{Bernstein, RationalSpline};

/// The pieces between knots of B-spline surfaces, as patches.
///
/// # Errors
/// [`ToolError`]: not surfaces in space, or a piece that is not a valid patch.
pub(super) fn patches(surfaces: &[RationalSpline]) -> Result<Vec<Patch>, ToolError> {
    let mut patches = Vec::new();
    for (surface, spline) in surfaces.iter().enumerate() {
        if (spline.variables(), spline.dimension()) != (2, 3) {
            return Err(ToolError::Surface {
                surface,
                variables: spline.variables(),
                dimension: spline.dimension(),
            });
        }
        let pieces = spline
            .pieces()
            .map_err(|source| ToolError::Spline { surface, source })?;
        // Pieces of a constant are that constant, whatever the roundings of knot insertion: the surface is polynomial,
        // and the normals of its patches have about half the degree.
        let mut weights = spline.control_points().map(|(_, weight)| weight);
        let first = weights.next();
        let constant = first.filter(|first| weights.all(|weight| weight == *first));
        for piece in pieces {
            let forms = piece.map.numerators();
            let position = [0, 1, 2].map(|k| forms[k].clone().assumed_exact());
            let mut weight = piece.map.weight().clone().assumed_exact();
            if let Some(constant) = constant {
                weight = Bernstein::from_fn(weight.degrees(), |_| constant).unwrap_or(weight);
            }
            patches.push(Patch::new(position, weight).map_err(|source| ToolError::Patch {
                surface,
                ranges: [piece.ranges[0], piece.ranges[1]],
                source,
            })?);
        }
    }
    Ok(patches)
}
