//! What the enclosure of a Jacobian tells about a section's curve: whether it is regular, and along which variables it is monotone.

use nalgebra::{Const, DimMin, Matrix2, ToTypenum};
use sweepsim_solve::Enclosure;

/// A bound of the rounding of an entry of `K J`, in parts of `|K| |J|`: some forty roundings for at most three unknowns.
const INVERSE: f64 = 1e-14;

/// The equations without that of `Y`: row 0 is `X`, row 2 is `g`.
pub(super) fn rows<const N: usize>() -> impl Iterator<Item = usize> {
    (0..N).filter(|r| *r != 1)
}

/// The Jacobian of `X` (and `g`) with respect to the variables other than `over`; with one variable, a unit row completes it.
pub(super) fn without<const N: usize>(jacobian: &[[f64; N]; N], over: usize) -> Matrix2<f64> {
    let mut matrix = Matrix2::identity();
    for (n, r) in rows::<N>().enumerate() {
        for (m, k) in (0..N).filter(|k| *k != over).enumerate() {
            matrix[(n, m)] = jacobian[r][k];
        }
    }
    matrix
}

/// Whether the Jacobian of `X` (and `g`) with respect to the variables other than `over` has one sign of its determinant.
pub(super) fn minor_is_definite<const N: usize>(jacobian: &[[Enclosure; N]; N], over: usize) -> bool {
    let mut others = (0..N).filter(|k| *k != over);
    let (a, b) = (others.next(), others.next());
    let (lo, hi) = match (a, b) {
        (Some(a), Some(b)) => {
            let [p, q] = [jacobian[0][a], jacobian[0][b]];
            let [r, s] = [jacobian[2][a], jacobian[2][b]];
            let (first, second) = (product(p, s), product(q, r));
            (first.lo() - second.hi(), first.hi() - second.lo())
        }
        (Some(a), None) => (jacobian[0][a].lo(), jacobian[0][a].hi()),
        _ => (0.0, 0.0),
    };
    let margin = 8.0 * f64::EPSILON * lo.abs().max(hi.abs());
    lo > margin || hi < -margin
}

fn product(a: Enclosure, b: Enclosure) -> Enclosure {
    let all = [a.lo() * b.lo(), a.lo() * b.hi(), a.hi() * b.lo(), a.hi() * b.hi()];
    Enclosure::hull(
        all.iter().fold(f64::INFINITY, |m, x| m.min(*x)),
        all.iter().fold(f64::NEG_INFINITY, |m, x| m.max(*x)),
    )
}

/// Whether no matrix of the enclosure is singular: `‖I − K J‖∞ < 1`, `K` the inverse of its middle, in coordinates scaled to the box.
pub(super) fn regular<const N: usize>(bounds: &[Enclosure; N], jacobian: &[[Enclosure; N]; N]) -> bool
where
    Const<N>: DimMin<Const<N>, Output = Const<N>> + ToTypenum,
{
    type Square<const N: usize> = nalgebra::SMatrix<f64, N, N>;
    let half = bounds.map(Enclosure::radius);
    let middle = Square::<N>::from_fn(|i, j| jacobian[i][j].mid() * half[j]);
    let radius = Square::<N>::from_fn(|i, j| jacobian[i][j].radius() * half[j]);
    let Some(inverse) = middle.try_inverse() else {
        return false;
    };
    let size = inverse.abs();
    let rest = (Square::<N>::identity() - inverse * middle).abs() + size * radius + size * middle.abs() * INVERSE;
    (0..N).all(|i| rest.row(i).sum() < 1.0)
}
