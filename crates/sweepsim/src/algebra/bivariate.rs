//! Code shared by cells of forms in `(u, v)` and in `t`, and forms that are products.

use sweepsim_spline::Bernstein;

/// One more than the largest degree of a coefficient tensor.
pub(crate) const MOST: usize = 32;

/// The two factors of `a(u) b(v)`, if a form is such a product up to rounding; constant factors have degree 0.
pub(crate) fn factors(form: &Bernstein) -> Option<[Bernstein; 2]> {
    let [p, q] = [0, 1].map(|axis| form.degree(axis));
    let at = |i: usize, j: usize| form.coefficients()[i + (p + 1) * j];
    let corner = at(0, 0);
    let slack = 8.0 * f64::EPSILON * form.magnitude() * form.magnitude();
    let rank_one = (0..=q).all(|j| (0..=p).all(|i| (at(i, j) * corner - at(i, 0) * at(0, j)).abs() <= slack));
    if !rank_one || corner == 0.0 {
        return None;
    }
    let in_u = Bernstein::from_fn(&[p, 0], |index| at(index[0], 0)).ok()?;
    let in_v = Bernstein::from_fn(&[0, q], |index| at(0, index[1]) / corner).ok()?;
    Some([lowered(in_u), lowered(in_v)])
}

/// Degree 0 where all coefficients are equal.
fn lowered(form: Bernstein) -> Bernstein {
    let first = form.coefficients()[0];
    if form.coefficients().iter().all(|c| *c == first) {
        Bernstein::constant(2, first)
    } else {
        form
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_of_products_and_of_others() {
        let (a, b) = ([1.0, 0.5, 2.0], [3.0, 1.0]);
        let product = Bernstein::from_fn(&[2, 1], |index| a[index[0]] * b[index[1]]).expect("finite");
        let [in_u, in_v] = factors(&product).expect("a product");
        assert_eq!((in_u.degrees(), in_v.degrees()), (&[2, 0][..], &[0, 1][..]));
        let again = in_u.mul(&in_v);
        for (x, y) in again.coefficients().iter().zip(product.coefficients()) {
            assert!((x - y).abs() <= 4.0 * f64::EPSILON * 6.0);
        }
        let constant = factors(&Bernstein::constant(2, 2.0)).expect("a product");
        assert_eq!(constant.map(|form| form.degrees().to_vec()), [[0, 0], [0, 0]]);
        let sum = product.add(&Bernstein::variable(2, 0));
        assert_eq!(factors(&sum), None);
    }
}
