//! Recognises patches that are pieces of surfaces of revolution about the tool's axis: their normals have low degrees.
//!
//! With a circle `c² + s² = a²` in `u` and a meridian `ρ, ζ` over `ω` in `v`, `F = (c ρ, s ρ, a ζ) / (a ω)`, the
//! normals are parallel to `N = (c n_ρ, s n_ρ, a n_ζ)` with `n_ρ = ζ′ω − ζω′` and `n_ζ = ρω′ − ρ′ω`, and
//! `ω F × N = (−s m, c m, 0)` with `m = ζ n_ρ − ρ n_ζ`. `F_u × F_v` has many times that degree; its common factors, a
//! multiple of `ρ` among them, are dropped, and with them the zeros at poles on the axis.

use super::NormalField;
use sweepsim_spline::Bernstein;

/// Coefficients must match to within this many roundings of the largest, which
/// is less than the roundings that the sweep allows for.
const ROUNDINGS: f64 = 8.0;

/// The circle and the meridian of a patch, in their Bernstein coefficients.
struct Revolution {
    circle: [Vec<f64>; 3],
    /// Radius, height and weight.
    meridian: [Vec<f64>; 3],
}

/// Forms of the same degrees as coefficients `[i][j]` of the polynomials in `u` and in `v`.
struct Grid {
    rows: usize,
    c: Vec<f64>,
}

impl Grid {
    fn new(form: &Bernstein, swapped: bool) -> Self {
        let (rows, columns) = (form.degrees()[0] + 1, form.degrees()[1] + 1);
        let c = form.coefficients();
        if !swapped {
            return Self { rows, c: c.to_vec() };
        }
        let turned = (0..rows).flat_map(|i| (0..columns).map(move |j| c[i + rows * j]));
        Self {
            rows: columns,
            c: turned.collect(),
        }
    }

    fn columns(&self) -> impl Iterator<Item = &[f64]> {
        self.c.chunks_exact(self.rows)
    }

    fn column(&self, j: usize) -> &[f64] {
        &self.c[self.rows * j..][..self.rows]
    }

    fn largest(&self) -> f64 {
        self.c.iter().fold(0.0, |m: f64, c| m.max(c.abs()))
    }

    /// Whether this is the product of the two lists.
    fn is_product(&self, a: &[f64], b: &[f64], size: f64) -> bool {
        let slack = ROUNDINGS * f64::EPSILON * size;
        let mut pairs = self.columns().zip(b);
        pairs.all(|(column, b)| column.iter().zip(a).all(|(c, a)| (c - a * b).abs() <= slack))
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn form(c: &[f64]) -> Bernstein {
    // As many coefficients as the degree requires.
    Bernstein::new(&[c.len() - 1], c.to_vec()).unwrap_or_else(|_| Bernstein::constant(1, 0.0))
}

impl Revolution {
    fn new(x: &Grid, y: &Grid, z: &Grid, weight: &Grid) -> Option<Self> {
        // The circle, from where the radius is largest; its weight from the first column.
        let girth = |j: usize| dot(x.column(j), x.column(j)) + dot(y.column(j), y.column(j));
        let widest = (0..x.columns().count()).max_by(|a, b| girth(*a).total_cmp(&girth(*b)))?;
        let first = weight.column(0);
        let a: Vec<f64> = first.iter().map(|w| w / first[0]).collect();
        let radius = x.column(widest)[0].hypot(y.column(widest)[0]);
        if radius == 0.0 {
            return None;
        }
        let over = |list: &[f64]| -> Vec<f64> { list.iter().map(|c| c / radius).collect() };
        let (c, s) = (over(x.column(widest)), over(y.column(widest)));
        let one = form(&c)
            .mul(&form(&c))
            .add(&form(&s).mul(&form(&s)))
            .sub(&form(&a).mul(&form(&a)));
        let round = dot(&a, &a);
        let size = dot(&c, &c) + dot(&s, &s);
        let largest = a.iter().fold(0.0, |m: f64, a| m.max(a * a));
        if one.magnitude() > ROUNDINGS * f64::EPSILON * largest {
            return None;
        }
        let columns = x.columns().zip(y.columns());
        let rho: Vec<f64> = columns.map(|(x, y)| (dot(x, &c) + dot(y, &s)) / size).collect();
        let zeta: Vec<f64> = z.columns().map(|z| dot(z, &a) / round).collect();
        let omega: Vec<f64> = weight.columns().map(|w| w[0]).collect();
        let wide = x.largest().max(y.largest());
        let all = x.is_product(&c, &rho, wide)
            && y.is_product(&s, &rho, wide)
            && z.is_product(&a, &zeta, z.largest())
            && weight.is_product(&a, &omega, weight.largest())
            && rho.iter().all(|rho| *rho >= -ROUNDINGS * f64::EPSILON * wide);
        all.then_some(Self {
            circle: [c, s, a],
            meridian: [rho, zeta, omega],
        })
    }

    /// `N` and `M`, as forms in `(u, v)`.
    fn field(&self) -> Option<NormalField> {
        let [c, s, a] = self.circle.each_ref().map(|list| form(list));
        let [rho, zeta, omega] = &self.meridian;
        let constant = omega.iter().all(|w| *w == omega[0]);
        let q = omega.len() - 1;
        if q == 0 {
            return None;
        }
        // ζ′ω − ζω′ = q (ζ₊ω₋ − ζ₋ω₊) with the forms of the first q coefficients and of the last, one degree lower.
        let wedge = |list: &[f64]| {
            if constant {
                return form(list).derivative(0);
            }
            let (before, after) = (form(&list[..q]), form(&list[1..]));
            after.mul(&form(&omega[..q])).sub(&before.mul(&form(&omega[1..])))
        };
        // If the circle runs counter-clockwise and the meridian upwards, F_u × F_v points out.
        let [(c0, s0), (c1, s1)] = [0, 1].map(|i| (self.circle[0][i], self.circle[1][i]));
        let sense = if c0 * s1 - s0 * c1 > 0.0 { 1.0 } else { -1.0 };
        let (out, up) = (wedge(zeta).scale(sense), wedge(rho).scale(-sense));
        let moment = form(zeta).mul(&out).sub(&form(rho).mul(&up));
        // Both times ω, or the moment over it where it is constant.
        let (out, up, moment) = if constant {
            (out, up, moment.scale(1.0 / omega[0]))
        } else {
            (out.mul(&form(omega)), up.mul(&form(omega)), moment)
        };
        let product = |in_u: &Bernstein, in_v: &Bernstein| in_u.tensor_product(in_v);
        let zero = Bernstein::constant(2, 0.0);
        Some(NormalField {
            normal: [product(&c, &out), product(&s, &out), product(&a, &up)],
            moment: [product(&s.scale(-1.0), &moment), product(&c, &moment), zero],
        })
    }
}

/// The normals of a patch and their moments, if it is a piece of a surface of revolution about the third axis with
/// circles in `u` or in `v`.
pub(super) fn field(position: &[Bernstein; 3], weight: &Bernstein) -> Option<NormalField> {
    let alike = position.iter().all(|form| form.degrees() == weight.degrees());
    if !alike || weight.variables() != 2 {
        return None;
    }
    [false, true].into_iter().find_map(|swapped| {
        let grids = position.each_ref().map(|form| Grid::new(form, swapped));
        let [x, y, z] = &grids;
        if x.rows < 3 {
            return None;
        }
        let field = Revolution::new(x, y, z, &Grid::new(weight, swapped))?.field()?;
        if !swapped {
            return Some(field);
        }
        // Swapped variables, and hence the opposite side.
        let turn = |form: &Bernstein| form.scale(-1.0).extend(2, &[1, 0]).ok();
        let all = |forms: &[Bernstein; 3]| Some([turn(&forms[0])?, turn(&forms[1])?, turn(&forms[2])?]);
        Some(NormalField {
            normal: all(&field.normal)?,
            moment: all(&field.moment)?,
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::boundary::normals::normals;
    use nalgebra::Vector3;
    use sweepsim_props::*;

    /// A piece of a surface of revolution: an arc of `sweep` from `start`, and homogeneous points of the meridian.
    /// Swapped, circles are in `v`.
    fn patch(start: f64, sweep: f64, meridian: &[[f64; 3]], swapped: bool) -> ([Bernstein; 3], Bernstein) {
        let (middle, half) = (start + 0.5 * sweep, (0.5 * sweep).cos());
        let end = start + sweep;
        let circle = [
            [start.cos(), start.sin(), 1.0],
            [middle.cos(), middle.sin(), half],
            [end.cos(), end.sin(), 1.0],
        ];
        let form = |value: &dyn Fn([f64; 3], [f64; 3]) -> f64| {
            let c = meridian
                .iter()
                .flat_map(|m| circle.iter().map(|c| value(*c, *m)))
                .collect();
            let form = Bernstein::new(&[2, meridian.len() - 1], c).unwrap();
            if swapped {
                form.extend(2, &[1, 0]).unwrap()
            } else {
                form
            }
        };
        let position = [
            form(&|c, m| c[0] * m[0]),
            form(&|c, m| c[1] * m[0]),
            form(&|c, m| c[2] * m[1]),
        ];
        (position, form(&|c, m| c[2] * m[2]))
    }

    fn at(forms: &[Bernstein; 3], place: &[f64]) -> Vector3<f64> {
        Vector3::from([0, 1, 2].map(|k| forms[k].evaluate(place)))
    }

    proptest! {
        /// The closed form agrees with the general one up to a positive factor, and its moments are `F × N`.
        #[test]
        fn closed_and_general_normals_agree(
            start in -3.0..3.0, sweep in prop_oneof![0.2..1.6, -1.6..-0.2],
            points in collection::vec((0.5..9.0, -9.0..9.0, 0.5..2.0), 2..5),
            rational in any::<bool>(), swapped in any::<bool>(), place in [0.0..1.0, 0.0..1.0],
        ) {
            let weight = |w: f64| if rational { w } else { 1.0 };
            let meridian: Vec<[f64; 3]> = points.iter().map(|(rho, zeta, w)| [rho * weight(*w), zeta * weight(*w), weight(*w)]).collect();
            let (position, weight) = patch(start, sweep, &meridian, swapped);
            let (closed, general) = (field(&position, &weight).unwrap(), normals(&position, &weight).0);
            let (n, m) = (at(&closed.normal, &place), at(&closed.moment, &place));
            let long = at(&general.normal, &place);
            // Coefficients of the general normals are below 1e7, and suffer from cancellation.
            prop_assert!(n.cross(&long).norm() <= 1e-13 * 1e7 * n.norm() && n.dot(&long) > -1e-6 * n.norm());
            if long.norm() > 1e-3 {
                prop_assert!(n.dot(&long) > 0.0);
            }
            let f = at(&position, &place) / weight.evaluate(&place);
            let size = closed.normal.iter().map(Bernstein::magnitude).fold(0.0, f64::max);
            prop_assert!((f.cross(&n) - m).amax() <= 1e-12 * size);
            let degree = |field: &NormalField| field.moment.iter().map(|form| form.degrees().iter().sum::<usize>()).max();
            prop_assert!(degree(&closed) < degree(&general));
        }

        /// A surface that differs from one of revolution by slightly more than rounding is not recognised as one.
        #[test]
        fn others_are_left_alone(which in 0..3_usize, coefficient in 0..9_usize, error in prop_oneof![Just(1e-3), Just(1e-9), Just(1e-12)]) {
            let meridian = [[2.0, 0.0, 1.0], [3.0, 1.0, 1.0], [2.5, 4.0, 1.0]];
            let (mut position, weight) = patch(0.3, 1.2, &meridian, false);
            prop_assert!(field(&position, &weight).is_some());
            let mut c = position[which].coefficients().to_vec();
            c[coefficient] += 4.0 * error;
            position[which] = Bernstein::new(&[2, 2], c).unwrap();
            prop_assert!(field(&position, &weight).is_none());
        }
    }
}
