//! Direct evaluation against the forms.

use super::*;
use crate::algebra::ranges::range_of;
use sweepsim_props::*;

/// `N` and `M` one after the other, and their derivatives: what a velocity along an axis, or a turn about it, makes of them.
fn lists(direct: &Direct, at: [f64; 2]) -> [[f64; 6]; 3] {
    let site = direct.at(at);
    let unit = |k: usize| std::array::from_fn(|i| if i == k { 1.0 } else { 0.0 });
    let zero = [0.0; 4];
    let twist = |k: usize| Twisted {
        travel: if k < 3 { unit(k) } else { zero },
        spin: if k < 3 { zero } else { unit(k - 3) },
    };
    let all: [[f64; 3]; 6] = std::array::from_fn(|k| site.envelopes(&twist(k)));
    assert!((0..6).all(|k| site.envelope(&twist(k)) == all[k][0]));
    if let Some((place, g)) = direct.value(at, &twist(4)) {
        assert_eq!((place, g), (site.place, all[4][0]));
    }
    std::array::from_fn(|d| std::array::from_fn(|k| all[k][d]))
}

fn form(degrees: [usize; 2], value: &dyn Fn(usize) -> f64) -> Bernstein {
    let count = (degrees[0] + 1) * (degrees[1] + 1);
    Bernstein::new(&degrees, (0..count).map(value).collect()).unwrap()
}

proptest! {
    /// Normals and moments from derivatives are those of the patch's own forms, within the bound of their rounding.
    #[test]
    fn products_of_derivatives_are_the_normals(
        degrees in prop_oneof![Just([3, 3]), [1_usize..5, 1_usize..5]], rational in any::<bool>(), at in [0.0..=1.0, 0.0..=1.0],
        bumps in collection::vec(-0.08..0.08, 25), weights in collection::vec(0.6..1.6, 25),
        centre in [-50.0..50.0, -50.0..50.0, -50.0..50.0],
    ) {
        let [p, q] = degrees;
        let (x, y) = (|i: usize| (i % (p + 1)) as f64 / p as f64, |i: usize| (i / (p + 1)) as f64 / q as f64);
        let weight = |i: usize| if rational { weights[i] } else { 2.0 };
        let position = [
            form(degrees, &|i| weight(i) * (centre[0] + 3.0 * x(i))),
            form(degrees, &|i| weight(i) * (centre[1] + y(i))),
            form(degrees, &|i| weight(i) * (centre[2] + bumps[i])),
        ];
        // Bumps may make a fold, which is no patch.
        let Ok(patch) = Patch::new(position, form(degrees, &weight)) else { return Ok(()) };
        let direct = Direct::new(&patch).unwrap();
        let site = direct.at(at);
        let place = patch.point(at[0], at[1]);
        for k in 0..3 {
            prop_assert!((site.place[k] - place[k]).abs() <= 1e-12);
        }
        let forms: Vec<&Bernstein> = patch.field().normal().iter().chain(patch.field().moment()).collect();
        for (k, form) in forms.iter().enumerate() {
            let error = direct.rounding[1 - k / 3][k % 3] + 64.0 * f64::EPSILON * form.magnitude();
            let lists = lists(&direct, at);
            let value = form.evaluate(&at);
            prop_assert!((lists[0][k] - value).abs() <= error, "{k}: {} {value} {error}", lists[0][k]);
            for axis in 0..2 {
                let slope = form.derivative(axis).evaluate(&at);
                prop_assert!((lists[1 + axis][k] - slope).abs() <= 1e3 * error + 1e-9);
            }
        }
        // The bound is no more than what a thousand roundings of the coordinates make, along slopes of at most 4 · 3 · 1.6 / 0.6 each way.
        let (_, most) = range_of(direct.rounding[1]);
        let farthest = centre.iter().fold(0.0_f64, |most, c: &f64| most.max(c.abs())) + 3.0;
        prop_assert!(most < 1e3 * f64::EPSILON * farthest * 2.0 * 32.0, "{most}");
    }

    /// The same on flat patches, anywhere: at poles as well, where nothing is divided.
    #[test]
    fn flat_normals_are_those_of_the_forms(
        degrees in prop_oneof![Just([3, 3]), [1_usize..5, 1_usize..5]], rational in any::<bool>(), has_pole in any::<bool>(), weights in collection::vec(0.6..1.6, 25),
        at in [0.0..=1.0, 0.0..=1.0], on_side in any::<bool>(), centre in [-50.0..50.0, -50.0..50.0, -50.0..50.0],
        tilt in (0_usize..3, -1.0..1.0, -1.0..1.0),
    ) {
        let [p, q] = degrees;
        let at = if on_side { [at[0], 0.0] } else { at };
        let tilt = [if tilt.0 > 1 { tilt.1 } else { 0.0 }, if tilt.0 > 0 { tilt.2 } else { 0.0 }];
        let y = |i: usize| (i / (p + 1)) as f64 / q as f64;
        let x = |i: usize| (i % (p + 1)) as f64 / p as f64 * if has_pole { y(i) } else { 1.0 };
        let weight = |i: usize| if rational { weights[i] } else { 2.0 };
        let position = [
            form(degrees, &|i| weight(i) * (centre[0] + 3.0 * x(i))),
            form(degrees, &|i| weight(i) * (centre[1] + y(i))),
            form(degrees, &|i| weight(i) * (centre[2] + tilt[0] * x(i) + tilt[1] * y(i))),
        ];
        let patch = Patch::new(position, form(degrees, &weight)).unwrap();
        prop_assert!(patch.plane().is_some());
        prop_assert_eq!(patch.shrunk_sides(), [[false; 2], [has_pole, false]]);
        let direct = Direct::new(&patch).unwrap();
        prop_assert!(direct.covers(at));
        let lists = lists(&direct, at);
        let forms: Vec<&Bernstein> = patch.field().normal().iter().chain(patch.field().moment()).collect();
        for (k, form) in forms.iter().enumerate() {
            let rounding = direct.rounding[1 - k / 3][k % 3];
            let error = rounding + 64.0 * f64::EPSILON * form.magnitude();
            let value = form.evaluate(&at);
            prop_assert!((lists[0][k] - value).abs() <= error, "{k}: {} {value} {error}", lists[0][k]);
            for axis in 0..2 {
                let slope = form.derivative(axis).evaluate(&at);
                prop_assert!((lists[1 + axis][k] - slope).abs() <= 1e3 * error + 1e-12);
            }
            // Where the plane is parallel to an axis, nothing is left of the component.
            if k < 3 && patch.plane().unwrap()[k] == 0.0 {
                prop_assert!(value == 0.0 && lists[0][k] == 0.0 && rounding == 0.0);
            }
        }
        let (_, most) = range_of(direct.rounding[1]);
        prop_assert!(most < 300.0 * f64::EPSILON, "{most}");
    }

    /// The same where a side has shrunk to a point, and the normals are divided by the distance from it.
    #[test]
    fn normals_near_a_pole_are_those_of_the_forms(
        upper in any::<bool>(), bumps in collection::vec(-0.08..0.08, 16), at in [0.0..=1.0, 0.0..=1.0],
        rational in any::<bool>(), weights in collection::vec(0.9..1.1, 16), pole in [-50.0..50.0, -50.0..50.0, -50.0..50.0],
    ) {
        // A sector about a line along z: v is the distance from the pole, or 1 less it. The pole may be far from the origin.
        let far = |i: usize| (if upper { 3 - i / 4 } else { i / 4 }) as f64 / 3.0;
        let angle = |i: usize| (i % 4) as f64 / 3.0 * if upper { -1.0 } else { 1.0 };
        let weight = |i: usize| if rational { weights[i] } else { 1.0 };
        let pole = if rational { pole } else { [0.0; 3] };
        let position = [
            form([3, 3], &|i| weight(i) * (pole[0] + far(i) * f64::cos(angle(i)))),
            form([3, 3], &|i| weight(i) * (pole[1] + far(i) * f64::sin(angle(i)))),
            form([3, 3], &|i| weight(i) * (pole[2] + far(i) * (1.0 + bumps[i]))),
        ];
        let patch = Patch::new(position, form([3, 3], &weight)).unwrap();
        prop_assert_eq!(patch.shrunk_sides(), [[false; 2], [!upper, upper]]);
        let direct = Direct::new(&patch).unwrap();
        prop_assume!(direct.covers(at));
        let lists = lists(&direct, at);
        let forms: Vec<&Bernstein> = patch.field().normal().iter().chain(patch.field().moment()).collect();
        for (k, form) in forms.iter().enumerate() {
            let error = direct.rounding[1 - k / 3][k % 3] + 64.0 * f64::EPSILON * form.magnitude();
            let value = form.evaluate(&at);
            prop_assert!((lists[0][k] - value).abs() <= error, "{k}: {} {value} {error}", lists[0][k]);
            for axis in 0..2 {
                let slope = form.derivative(axis).evaluate(&at);
                prop_assert!((lists[1 + axis][k] - slope).abs() <= 1e3 * error + 1e-9);
            }
        }
    }
}
