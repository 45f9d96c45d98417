//! Derivatives of the position, replaced on each cell by forms of degree 2 with a bound of the difference, as [`Reduced`](super::reduced::Reduced) does with normals.
//!
//! `F_u = (P_u w − P w_u)/w²` of a rational bicubic patch has 49 control points in each variable, which cost more than all other bounds of a cell. Third derivatives of
//! `F_u` are bounded by Leibniz's rule, from those of `P = w F` and of `w`: the derivative of order `(a, b)` of `F` is
//! `(P⁽ᵃᵇ⁾ − Σ (a over i)(b over j) w⁽ⁱʲ⁾ F⁽ᵃ⁻ⁱ ᵇ⁻ʲ⁾)/w`, with the sum over all `(i, j) ≠ (0, 0)`.

use crate::cutter::direct::Direct;
use crate::cutter::reduced::{COMBINED, beyond};
use crate::time::pieces::Sizes;
use sweepsim_motion::Patch;
use sweepsim_spline::Bernstein;

/// What a patch's `F_u` and `F_v` lack on a cell when they are replaced by forms of degree 2.
#[derive(Clone, Debug)]
pub(super) struct Tangents {
    /// Of each component of both, the rounding of a reduced coefficient, and bounds of the third derivatives in each variable.
    sizes: [[(f64, [f64; 2]); 3]; 2],
    /// Of each component of both, for each pole at a side of the other variable, what bounds the third derivative in its own variable near it.
    near_poles: Option<NearPoles>,
}

type NearPoles = [[[Option<NearPole>; 2]; 3]; 2];

/// Along a pole, all derivatives in the pole's own variable vanish, and beside it they grow with the distance.
#[derive(Clone, Copy, Debug)]
struct NearPole {
    /// A bound at the pole, where the side is a point only up to rounding.
    there: f64,
    /// How fast it may grow.
    growth: f64,
}

/// Orders of derivatives that are bounded: up to this, less one, in each variable.
const ORDERS: usize = 5;
/// Bounds of derivatives, by their orders in `u` and in `v`. Those that nothing needs are infinite.
type Derivatives = [[f64; ORDERS]; ORDERS];

const CHOOSE: [[f64; ORDERS]; ORDERS] = [
    [1.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0, 0.0],
    [1.0, 2.0, 1.0, 0.0, 0.0],
    [1.0, 3.0, 3.0, 1.0, 0.0],
    [1.0, 4.0, 6.0, 4.0, 1.0],
];

/// Whether the third derivatives of `F_u` and `F_v`, their growth beside a pole, or those that they depend on, have these orders.
fn is_needed(a: usize, b: usize) -> bool {
    (a <= 1 || b <= 1) && a + b <= ORDERS
}

/// Bounds of the derivatives of a form whose coefficients are off by up to `error`.
fn derivatives(form: &Bernstein, error: f64) -> Derivatives {
    let mut all = [[f64::INFINITY; ORDERS]; ORDERS];
    let mut in_u = form.clone();
    for (a, row) in all.iter_mut().enumerate() {
        let mut own = in_u.clone();
        for (b, bound) in row.iter_mut().enumerate().filter(|(b, _)| is_needed(a, *b)) {
            // A difference of coefficients is off by twice as much as they are, and has one rounding.
            let grown = [(0, a), (1, b)].map(|(axis, order)| (2.0 * form.degree(axis) as f64).powi(order as i32));
            *bound = own.magnitude() + grown[0] * grown[1] * error;
            own = own.derivative(1);
        }
        in_u = in_u.derivative(0);
    }
    all
}

impl Tangents {
    /// Coefficients of a form of degree 2 in both variables.
    pub const POINTS: usize = 9;

    /// `None` if the bounds are so large that they would keep cells small: where weights differ much.
    pub fn new(patch: &Patch, direct: &Direct) -> Option<Self> {
        /// On a cell of a quarter of the patch's sides, what is missing is less than this part of the slope.
        const SHARE: f64 = 0.1;
        let weight = patch.weight();
        let lightest = weight.coefficients().iter().copied().fold(f64::INFINITY, f64::min);
        let heaviest = weight.magnitude();
        let of_weight = derivatives(weight, 16.0 * f64::EPSILON * heaviest);
        let mut sizes = [[(0.0, [0.0; 2]); 3]; 2];
        let mut shares = [[0.0_f64; 2]; 2];
        let mut near_poles = [[[None; 2]; 3]; 2];
        let poles = patch.shrunk_sides();
        for k in 0..3 {
            let position = &patch.position()[k];
            let centre = direct.centre()[k];
            let size = position.magnitude() + centre.abs() * heaviest;
            let about = position.sub(&weight.scale(centre));
            let own = derivatives(&about, 64.0 * f64::EPSILON * size);
            let mut bounds = [[f64::INFINITY; ORDERS]; ORDERS];
            for (a, b) in (0..ORDERS).flat_map(|a| (0..ORDERS).map(move |b| (a, b))) {
                if !is_needed(a, b) {
                    continue;
                }
                let mut sum = own[a][b];
                for (i, j) in (0..=a).flat_map(|i| (0..=b).map(move |j| (i, j))).skip(1) {
                    sum += CHOOSE[a][i] * CHOOSE[b][j] * of_weight[i][j] * bounds[a - i][b - j];
                }
                // A few dozen roundings of terms of the same sign.
                bounds[a][b] = sum / lightest * (1.0 + 128.0 * f64::EPSILON);
            }
            for (axis, [u, v]) in [[1, 0], [0, 1]].into_iter().enumerate() {
                let third = [bounds[u + 3][v], bounds[u][v + 3]];
                // The nodes are off by a rounding of the cell's ends each.
                let off = 2.0 * f64::EPSILON * (bounds[u + 1][v] + bounds[u][v + 1]);
                let rounding = COMBINED * (direct.of_slopes[axis][k] + off + 8.0 * f64::EPSILON * bounds[u][v]);
                sizes[axis][k] = (rounding, third);
                for side in (0..2).filter(|side| poles[1 - axis][*side]) {
                    let growth = if axis == 0 { bounds[4][1] } else { bounds[1][4] };
                    let there = along_side((position, weight), axis, side);
                    near_poles[axis][k][side] = Some(NearPole { there, growth });
                }
                shares[axis][0] = shares[axis][0].max(beyond(third, [0.25; 2]));
                shares[axis][1] = shares[axis][1].max(bounds[u][v]);
            }
        }
        let good = shares.iter().all(|[missing, size]| *missing <= SHARE * size);
        let finite = |(rounding, third): &(f64, [f64; 2])| rounding.is_finite() && third.iter().all(|x| x.is_finite());
        (good && sizes.as_flattened().iter().all(finite)).then_some(Self {
            sizes,
            near_poles: (poles != [[false; 2]; 2]).then_some(near_poles),
        })
    }

    /// Bounds of what is missing from `F_u` and `F_v` on a cell, component by component.
    pub fn missing(&self, lower: [f64; 2], upper: [f64; 2]) -> Sizes {
        let widths = [0, 1].map(|axis| upper[axis] - lower[axis]);
        let missing = |(rounding, third): &(f64, [f64; 2])| beyond(*third, widths) + rounding;
        let Some(near_poles) = &self.near_poles else {
            return self.sizes.each_ref().map(|slope| slope.each_ref().map(missing));
        };
        let mut sizes = self.sizes;
        for (axis, (sizes, near_poles)) in sizes.iter_mut().zip(near_poles).enumerate() {
            let distances = [upper[1 - axis], 1.0 - lower[1 - axis]];
            for ((_, third), near) in sizes.iter_mut().zip(near_poles) {
                for (near, distance) in near.iter().zip(distances) {
                    if let Some(near) = near {
                        third[axis] = third[axis].min(near.there + distance * near.growth);
                    }
                }
            }
        }
        sizes.each_ref().map(|slope| slope.each_ref().map(missing))
    }
}

/// A bound of the fourth derivative of `F` along a side, in its own variable, of which this is the number: that of `F` less one of its points, which is but rounding where the side is a pole.
fn along_side((position, weight): (&Bernstein, &Bernstein), axis: usize, side: usize) -> f64 {
    let degrees = [0, 1].map(|axis| position.degree(axis).max(weight.degree(axis)));
    let [position, weight] = [position, weight].map(|form| form.elevated_to(&degrees));
    let row = |form: &Bernstein| -> Vec<f64> {
        let (n, other) = (degrees[axis], side * degrees[1 - axis]);
        let index = |i: usize| {
            if axis == 0 {
                other * (n + 1) + i
            } else {
                i * (degrees[0] + 1) + other
            }
        };
        (0..=n).map(|i| form.coefficients()[index(i)]).collect()
    };
    let [own, weights] = [&position, &weight].map(row);
    let point = own[0] / weights[0];
    let largest = |list: &[f64]| list.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    // Rounded once more in the difference.
    let sizes = largest(&own) + point.abs() * largest(&weights);
    let off: Vec<f64> = own.iter().zip(&weights).map(|(p, w)| p - point * w).collect();
    let off = largest(&off) + 4.0 * f64::EPSILON * sizes;
    let lightest = weights.iter().copied().fold(f64::INFINITY, f64::min);
    let mut of_weight = weights;
    let mut bounds = [0.0; ORDERS];
    let mut of_weights = [0.0; ORDERS];
    for a in 0..ORDERS {
        of_weights[a] = largest(&of_weight);
        let degree = of_weight.len().saturating_sub(1) as f64;
        of_weight = of_weight.windows(2).map(|pair| degree * (pair[1] - pair[0])).collect();
        let own = off * (2.0 * degrees[axis] as f64).powi(a as i32);
        let rest: f64 = (1..=a).map(|i| CHOOSE[a][i] * of_weights[i] * bounds[a - i]).sum();
        bounds[a] = (own + rest) / lightest * (1.0 + 128.0 * f64::EPSILON);
    }
    bounds[ORDERS - 1]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::ranges::Triples;
    use crate::cutter::cells::Cells;
    use crate::cutter::patch_forms::PatchForms;
    use sweepsim_motion::Tool;
    use sweepsim_props::*;

    fn form(degrees: [usize; 2], value: &dyn Fn(usize) -> f64) -> Bernstein {
        let count = (degrees[0] + 1) * (degrees[1] + 1);
        Bernstein::new(&degrees, (0..count).map(value).collect()).unwrap()
    }

    /// A bent sheet; its lower side in `v` may be a point.
    fn sheet(degrees: [usize; 2], has_pole: bool, bumps: &[f64], weights: &[f64]) -> Option<Patch> {
        let [p, q] = degrees;
        let x = |i: usize| (i % (p + 1)) as f64 / p as f64;
        let y = |i: usize| (i / (p + 1)) as f64 / q as f64;
        let weight = |i: usize| weights[i % weights.len()];
        let far = |i: usize| if has_pole { y(i) } else { 1.0 };
        let position = [
            form(degrees, &|i| weight(i) * far(i) * 3.0 * f64::sin(x(i))),
            form(degrees, &|i| {
                weight(i) * far(i) * if has_pole { -f64::cos(x(i)) } else { y(i) }
            }),
            form(degrees, &|i| weight(i) * (20.0 + far(i) * bumps[i])),
        ];
        // Bumps may make a fold, which is no patch.
        Patch::new(position, form(degrees, &weight)).ok()
    }

    /// Three forms with these degrees at a point.
    fn value(list: &Triples, degrees: [usize; 2], at: [f64; 2]) -> [f64; 3] {
        [list.x, list.y, list.z].map(|list| form(degrees, &|i| list[i]).evaluate(&at))
    }

    proptest! {
        /// On any cell and on parts of it, the reduced slopes, normals and moments, and the derivatives of the latter two, differ from those of the patch by no more than
        /// what is said to be missing; and that shrinks with the third power of the cell.
        #[test]
        fn samples_are_within_their_bounds(
            degrees in prop_oneof![2 => Just([3, 3]), 1 => [2_usize..5, 2_usize..5]], has_pole in any::<bool>(), spread in prop_oneof![Just(0.0), Just(0.04), Just(0.2)],
            bumps in collection::vec(-0.08..0.08, 25), numbers in collection::vec(-1.0..1.0, 25),
            corner in [0.0..0.9, 0.0..0.9], width in [1e-3..0.1, 1e-3..0.1], is_whole in any::<bool>(), axis in 0_usize..2, near in prop::option::of(1.0..9.0_f64),
            places in collection::vec([0.0..=1.0, 0.0..=1.0], 8),
        ) {
            let weights: Vec<f64> = numbers.iter().map(|x| 1.0 + spread * x).collect();
            let Some(patch) = sheet(degrees, has_pole, &bumps, &weights) else { return Ok(()) };
            let elements = PatchForms::of_patches(std::slice::from_ref(&patch));
            let element = &elements[0];
            prop_assert!(element.tangents.is_some() || spread > 0.1);
            prop_assume!(element.tangents.is_some());
            let (lower, upper) = if is_whole { ([0.0; 2], [1.0; 2]) } else { (corner, [0, 1].map(|k| corner[k] + width[k])) };
            let (lower, upper) = match near {
                Some(digits) => ([lower[0], 0.0], [upper[0], 10_f64.powf(-digits)]),
                None => (lower, upper),
            };
            let mut cells = Cells::new(element);
            let whole = cells.place(element, lower, upper);
            let parts = cells.split(element, whole, axis);
            let again = cells.split(element, parts[0], 1 - axis);
            let last = cells.split(element, again[1], axis);
            for cell in [whole, parts[1], again[0], last[0]] {
                cells.prepare(element, cell);
                let sides = [0, 1].map(|axis| cells.bounds(cell, axis));
                let missing = cells.missing(cell);
                let [normals, moments] = cells.field(element, cell, 0);
                for at in &places {
                    let place = [0, 1].map(|k| sides[k].0 + at[k] * (sides[k].1 - sides[k].0));
                    let slopes = slopes(&patch, place);
                    for axis in 0..2 {
                        let found = value(&cells.slope(element, cell, axis), [2; 2], *at);
                        for k in 0..3 {
                            let off = (found[k] - slopes[axis][k]).abs();
                            prop_assert!(off <= missing.tangents[axis][k] + 1e-12, "{axis} {k}: {off} {:?}", missing.tangents);
                        }
                    }
                    for (vector, (list, forms)) in [(moments, patch.field().moment()), (normals, patch.field().normal())].into_iter().enumerate() {
                        let found = value(&list, [2; 2], *at);
                        for k in 0..3 {
                            let off = (found[k] - forms[k].evaluate(&place)).abs();
                            prop_assert!(off <= missing.value[vector][k] + 1e-12, "{vector} {k}: {off} {:?}", missing.value);
                        }
                        for axis in 0..2 {
                            let low = [0, 1].map(|k| if k == axis { 1 } else { 2 });
                            let found = value(&cells.field_slope(cell, 0, axis)[1 - vector], low, *at);
                            for k in 0..3 {
                                let off = (found[k] - forms[k].derivative(axis).evaluate(&place)).abs();
                                let width = sides[axis].1 - sides[axis].0;
                                prop_assert!(off <= missing.slopes[axis][vector][k] + 1e-12 / width, "{off} {:?}", missing.slopes);
                            }
                        }
                    }
                }
            }
            if has_pole {
                // Of the slopes along the pole, next to nothing is missing beside it.
                let most = 1e3 * upper[1] + 1e-9;
                prop_assert!(cells.missing(whole).tangents[0].iter().all(|missing| *missing < most), "{:?} {upper:?}", cells.missing(whole).tangents);
            }
            let (all, part) = (cells.missing(parts[0]).tangents, cells.missing(last[0]).tangents);
            for (all, part) in all.as_flattened().iter().zip(part.as_flattened()) {
                prop_assert!(*part <= 0.14 * all + 1e-11, "{part} {all}");
            }
        }
    }

    /// Both derivatives of the position, by the quotient rule.
    fn slopes(patch: &Patch, at: [f64; 2]) -> [[f64; 3]; 2] {
        let weight = patch.weight();
        [0, 1].map(|axis| {
            patch.position().each_ref().map(|form| {
                let (w, growth) = (weight.evaluate(&at), weight.derivative(axis).evaluate(&at));
                (form.derivative(axis).evaluate(&at) - form.evaluate(&at) / w * growth) / w
            })
        })
    }

    /// Where weights differ much, slopes keep their own forms; so do they where nothing else is reduced.
    #[test]
    fn extreme_weights_are_left_alone() {
        let sheet = |degrees, weights: &[f64]| sheet(degrees, false, &[0.0; 25], weights).unwrap();
        let steep: Vec<f64> = (0..16).map(|i| 30.0_f64.powi(i % 4)).collect();
        let patches = [sheet([3, 3], &steep), sheet([1, 1], &[1.0])];
        assert!(
            PatchForms::of_patches(&patches)
                .iter()
                .all(|element| element.tangents.is_none())
        );
        let ball = Tool::ball(2.0, 9.0).unwrap();
        assert!(
            PatchForms::all(&ball)
                .0
                .iter()
                .all(|element| element.tangents.is_none())
        );
    }
}
