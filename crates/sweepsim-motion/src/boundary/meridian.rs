//! Pieces of a profile in homogeneous Bernstein form, and the quarters of their surfaces of revolution.

use super::{NormalField, Patch, Revolved};
use crate::profile::{Bezier, OutlineArc};
use nalgebra::Vector2;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};
use sweepsim_spline::{Bernstein, kernel};

pub(super) fn form(degrees: &[usize], coefficients: Vec<f64>) -> Bernstein {
    Bernstein::new(degrees, coefficients).expect("as many coefficients as the degrees say, all finite")
}

/// `a(u) · b(v)` for coefficient lists in `u` and in `v`.
fn product(a: &[f64], b: &[f64]) -> Bernstein {
    let coefficients = b.iter().flat_map(|y| a.iter().map(move |x| x * y)).collect();
    form(&[a.len() - 1, b.len() - 1], coefficients)
}

/// A quarter of the unit circle from angle `start`, homogeneous and quadratic: cosine, sine, weight.
pub(super) struct Quarter {
    pub(super) cosine: [f64; 3],
    pub(super) sine: [f64; 3],
}

pub(super) const QUARTER_WEIGHT: [f64; 3] = [1.0, FRAC_1_SQRT_2, 1.0];

impl Quarter {
    pub(super) fn new(azimuth: f64, number: usize) -> Self {
        let at = |turns: f64| {
            let angle = azimuth + turns * FRAC_PI_2;
            (angle.cos(), angle.sin())
        };
        let k = number as f64;
        // The last quarter must end exactly where the first begins.
        let end = if number == 3 { at(0.0) } else { at(k + 1.0) };
        let (start, middle) = (at(k), at(k + 0.5));
        Self {
            cosine: [start.0, middle.0, end.0],
            sine: [start.1, middle.1, end.1],
        }
    }
}

/// A piece of profile in homogeneous Bernstein form: points, weights, outward normals and moments `ζ n_ρ − ρ n_ζ`.
pub(super) struct Meridian {
    rho: Vec<f64>,
    zeta: Vec<f64>,
    weight: Vec<f64>,
    normal_rho: Vec<f64>,
    normal_zeta: Vec<f64>,
    moment: Vec<f64>,
}

impl Meridian {
    pub(super) fn line(from: Vector2<f64>, to: Vector2<f64>) -> Self {
        let direction = (to - from).normalize();
        let (n, m) = (direction.y, -direction.x);
        let moment = |p: Vector2<f64>| p.y * n - p.x * m;
        Self {
            rho: vec![from.x, to.x],
            zeta: vec![from.y, to.y],
            weight: vec![1.0, 1.0],
            normal_rho: vec![n, n],
            normal_zeta: vec![m, m],
            moment: vec![moment(from), moment(to)],
        }
    }

    /// The part of an arc between the angles `start` and `start + sweep`, `|sweep| ≤ 90°`, with given ends.
    pub(super) fn arc(arc: &OutlineArc, start: f64, sweep: f64, from: Vector2<f64>, to: Vector2<f64>) -> Self {
        let middle = (0.5 * sweep).cos();
        let angle = start + 0.5 * sweep;
        // Homogeneous middle point: w₁ times the meeting point of the tangents.
        let tangents = arc.centre * middle + Vector2::new(angle.cos(), angle.sin()) * arc.radius;
        let points = [from, tangents, to];
        let weight = vec![1.0, middle, 1.0];
        let out = sweep.signum() / arc.radius;
        let normals: Vec<_> = points
            .iter()
            .zip(&weight)
            .map(|(p, w)| (p - arc.centre * *w) * out)
            .collect();
        Self {
            rho: points.iter().map(|p| p.x).collect(),
            zeta: points.iter().map(|p| p.y).collect(),
            normal_rho: normals.iter().map(|n| n.x).collect(),
            normal_zeta: normals.iter().map(|n| n.y).collect(),
            moment: points.iter().map(|p| out * p.perp(&arc.centre)).collect(),
            weight,
        }
    }

    /// A piece of a spline. With `P` the homogeneous points, `ω` the weight: the direction of travel is along
    /// `T = ω P′ − P ω′`, the normal `(T_ζ, −T_ρ)`, and the moment (over `ω`) `P_ζ T_ζ + P_ρ T_ρ`. So `N` gets the
    /// factor `ω` unless that is 1.
    ///
    /// With `P = (1 − t) A + t B` and `ω = (1 − t) α + t β`, `T = n (α B − A β)`, which has degree `2n − 2` and does
    /// not cancel.
    pub(super) fn bezier(curve: &Bezier) -> Self {
        let n = curve.points.len() - 1;
        let weight = curve.weights.clone();
        let homogeneous = |k: usize| -> Vec<f64> { curve.points.iter().zip(&weight).map(|(p, w)| p[k] * w).collect() };
        let (rho, zeta) = (homogeneous(0), homogeneous(1));
        let of = |list: &[f64]| form(&[list.len() - 1], list.to_vec());
        let times = |a: &[f64], b: &[f64]| of(a).mul(&of(b));
        let polynomial = curve.is_polynomial();
        let travel = |p: &[f64]| -> Vec<f64> {
            if polynomial {
                p.windows(2).map(|p| p[1] - p[0]).collect()
            } else {
                let (ahead, behind) = (times(&weight[..n], &p[1..]), times(&p[..n], &weight[1..]));
                ahead.sub(&behind).into_coefficients()
            }
        };
        let (t_rho, t_zeta) = (travel(&rho), travel(&zeta));
        let largest = t_rho.iter().chain(&t_zeta).fold(0.0_f64, |m, c| m.max(c.abs()));
        let over = |list: Vec<f64>| -> Vec<f64> { list.into_iter().map(|c| c / largest).collect() };
        let moment = times(&zeta, &t_zeta).add(&times(&rho, &t_rho));
        let weighted = |list: &[f64]| {
            if polynomial {
                list.to_vec()
            } else {
                times(list, &weight).into_coefficients()
            }
        };
        Self {
            normal_rho: over(weighted(&t_zeta)),
            normal_zeta: over(weighted(&t_rho).into_iter().map(|c| -c).collect()),
            moment: over(moment.into_coefficients()),
            rho,
            zeta,
            weight,
        }
    }

    /// The quarter `quarter` of its surface of revolution about the third axis.
    pub(super) fn revolve(&self, quarter: &Quarter) -> Patch {
        let zero = || form(&[2, self.moment.len() - 1], vec![0.0; 3 * self.moment.len()]);
        let minus: Vec<f64> = quarter.sine.iter().map(|s| -s).collect();
        Patch {
            position: [
                product(&quarter.cosine, &self.rho),
                product(&quarter.sine, &self.rho),
                product(&QUARTER_WEIGHT, &self.zeta),
            ],
            weight: product(&QUARTER_WEIGHT, &self.weight),
            field: NormalField {
                normal: [
                    product(&quarter.cosine, &self.normal_rho),
                    product(&quarter.sine, &self.normal_rho),
                    product(&QUARTER_WEIGHT, &self.normal_zeta),
                ],
                moment: [
                    product(&minus, &self.moment),
                    product(&quarter.cosine, &self.moment),
                    zero(),
                ],
            },
            revolved: self.quadratics().map(|meridian| Revolved {
                circle: [quarter.cosine, quarter.sine, QUARTER_WEIGHT],
                meridian,
                frame: None,
            }),
            normals: None,
        }
    }

    /// All lists with three coefficients; `None` if one has more.
    fn quadratics(&self) -> Option<[[f64; 3]; 6]> {
        let lists = [
            &self.rho,
            &self.zeta,
            &self.weight,
            &self.normal_rho,
            &self.normal_zeta,
            &self.moment,
        ];
        lists.iter().all(|list| list.len() <= 3).then(|| {
            lists.map(|list| {
                let mut raised = kernel::raised(list, 3 - list.len());
                std::array::from_fn(|_| raised.next().unwrap_or(0.0))
            })
        })
    }
}
