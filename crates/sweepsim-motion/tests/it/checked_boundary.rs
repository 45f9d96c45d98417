//! What cannot be built: patches, edges, normals and pieces of revolution that are not what they claim to be.

use nalgebra::Matrix3;
use sweepsim_motion::{Edge, Lens, Lollipop, NormalField, Oval, Patch, PatchError, Revolved, Tool};
use sweepsim_props::*;
use sweepsim_spline::Bernstein;

fn tools() -> Vec<Tool> {
    let oval = Tool::oval(Oval {
        radius: 5.0,
        tip: 1.0,
        flank: 80.0,
        length: 60.0,
    })
    .expect("a cutter");
    let lens = Tool::lens(Lens {
        radius: 8.0,
        bottom: 20.0,
        corner: 0.0,
        length: 30.0,
    })
    .expect("a cutter");
    vec![
        Tool::ball(5.0, 30.0).expect("a cutter"),
        Tool::bull(5.0, 1.0, 30.0).expect("a cutter"),
        Tool::lollipop(Lollipop {
            radius: 5.0,
            neck: 2.0,
            length: 40.0,
        })
        .expect("a cutter"),
        oval,
        lens,
    ]
}

fn perturbed(form: &Bernstein, index: usize, by: f64) -> Bernstein {
    let mut c = form.coefficients().to_vec();
    let index = index % c.len();
    c[index] += by;
    Bernstein::new(form.degrees(), c).expect("finite")
}

/// What the crate makes itself passes its own checks: no tolerance is too tight.
#[test]
fn built_in_boundaries_are_what_they_claim() {
    for tool in tools() {
        for patch in tool.patches() {
            let again = Patch::with_normals(patch.position().clone(), patch.weight().clone(), patch.field().clone());
            assert!(again.is_ok(), "{again:?}");
            if let Some(revolved) = patch.revolved() {
                let again = Revolved::new(*revolved.circle(), *revolved.meridian(), revolved.frame()).expect("one");
                assert_eq!(&again, revolved);
                let made = again.patch().expect("a patch");
                for (u, v) in [(0.0, 0.3), (0.4, 0.9), (1.0, 1.0)] {
                    let (a, b) = (made.point(u, v), patch.point(u, v));
                    assert!((0..3).all(|k| (a[k] - b[k]).abs() <= 1e-12), "{a:?} {b:?}");
                }
            }
        }
        for edge in tool.edges() {
            let fields = (edge.before().clone(), edge.after().clone());
            let again = Edge::new(edge.position().clone(), edge.weight().clone(), fields.0, fields.1);
            assert!(again.is_ok(), "{again:?}");
        }
    }
}

/// Wrong normals gave wrong volumes: those that point inwards, those of another surface, moments of another origin.
#[test]
fn normals_of_another_surface_are_refused() {
    let tool = Tool::ball(5.0, 30.0).expect("a cutter");
    let patch = &tool.patches()[0];
    let with = |normal: [Bernstein; 3], moment: [Bernstein; 3]| {
        let field = NormalField::new(normal, moment)?;
        Patch::with_normals(patch.position().clone(), patch.weight().clone(), field)
    };
    let (normal, moment) = (patch.field().normal(), patch.field().moment());
    let negative = |forms: &[Bernstein; 3]| forms.each_ref().map(|form| form.scale(-1.0));
    assert_eq!(with(negative(normal), negative(moment)).err(), Some(PatchError::Inward));
    assert!(matches!(
        with(normal.clone(), negative(moment)),
        Err(PatchError::Moment { .. })
    ));
    let [x, y, z] = normal.clone();
    let turned = [y, z, x];
    let result = with(turned, moment.clone());
    assert!(
        matches!(result, Err(PatchError::Moment { .. } | PatchError::NotNormal { .. })),
        "{result:?}"
    );
    let other = &tool.patches()[1];
    let result = with(other.field().normal().clone(), other.field().moment().clone());
    assert!(
        matches!(result, Err(PatchError::Moment { .. } | PatchError::NotNormal { .. })),
        "{result:?}"
    );
}

/// A literal of degree 32 or more made the engine panic.
#[test]
fn high_degrees_are_refused() {
    let high = |degree: usize, variables: usize| Bernstein::constant(variables, 1.0).elevate(0, degree);
    let one = || [high(32, 2), high(32, 2), high(32, 2)];
    assert_eq!(
        NormalField::new(one(), one()).err(),
        Some(PatchError::Degree { degree: 32, most: 28 })
    );
    assert_eq!(
        Patch::new(one(), high(1, 2)).err(),
        Some(PatchError::Degree { degree: 32, most: 7 })
    );
    let tool = Tool::flat(5.0, 30.0).expect("a cutter");
    let edge = &tool.edges()[0];
    let raised = edge.position().each_ref().map(|form| form.elevate(0, 30));
    let made = Edge::new(
        raised,
        edge.weight().clone(),
        edge.before().clone(),
        edge.after().clone(),
    );
    assert_eq!(made.err(), Some(PatchError::Degree { degree: 32, most: 7 }));
}

/// Any coefficient off by more than rounding is found, whatever it belongs to.
#[test]
fn every_coefficient_counts() {
    for tool in tools() {
        for patch in tool.patches().iter().take(6) {
            let field = patch.field();
            for k in 0..6 {
                let count = if k < 3 {
                    field.normal()[k].coefficients().len()
                } else {
                    field.moment()[k - 3].coefficients().len()
                };
                for index in 0..count {
                    let (mut normal, mut moment) = (field.normal().clone(), field.moment().clone());
                    let form = if k < 3 { &mut normal[k] } else { &mut moment[k - 3] };
                    *form = perturbed(form, index, 1e-6);
                    let field = NormalField::new(normal, moment).expect("finite");
                    let made = Patch::with_normals(patch.position().clone(), patch.weight().clone(), field);
                    assert!(made.is_err(), "coefficient {index} of form {k}");
                }
            }
        }
        for edge in tool.edges().iter().take(3) {
            let moment = edge.before().moment();
            for k in 0..3 {
                let mut moment = moment.clone();
                moment[k] = perturbed(&moment[k], 1, 1e-6);
                let before = NormalField::new(edge.before().normal().clone(), moment).expect("finite");
                let made = Edge::new(
                    edge.position().clone(),
                    edge.weight().clone(),
                    before,
                    edge.after().clone(),
                );
                assert!(matches!(made, Err(PatchError::Moment { .. })), "{made:?}");
            }
        }
    }
}

#[test]
fn parameters_outside_are_refused_where_asked() {
    let tool = Tool::ball(5.0, 30.0).expect("a cutter");
    let patch = &tool.patches()[0];
    assert_eq!(patch.try_point(0.5, 0.25), Ok(patch.point(0.5, 0.25)));
    assert_eq!(patch.try_point(1.5, 0.25), Err(PatchError::Outside { parameter: 1.5 }));
    assert!(matches!(
        patch.try_point(0.5, f64::NAN),
        Err(PatchError::Outside { .. })
    ));
}

/// Numbers as users get them wrong.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -10.0..10.0, 1 => Just(0.0), 1 => Just(f64::NAN), 1 => Just(f64::INFINITY), 1 => Just(-1e308), 1 => Just(1e308), 1 => Just(5e-324)]
}

/// Forms of any number of variables and degrees, finite or too large to be so after a sum.
fn form() -> impl Strategy<Value = Bernstein> {
    let finite = prop_oneof![6 => -10.0..10.0, 1 => Just(0.0), 1 => Just(1e308), 1 => Just(-1e308), 1 => Just(5e-324)];
    (collection::vec(0..4_usize, 0..4), collection::vec(finite, 64)).prop_map(|(degrees, numbers)| {
        let mut index = 0;
        Bernstein::from_fn(&degrees, |_| {
            index += 1;
            numbers[index % 64]
        })
        .expect("few coefficients, all finite")
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever forms are put together: an error or a value that holds together, never a panic.
    #[test]
    fn any_forms(forms in collection::vec(form(), 10)) {
        let three = |start: usize| [0, 1, 2].map(|k| forms[start + k].clone());
        let field = NormalField::new(three(3), three(6));
        let _ = Patch::new(three(0), forms[9].clone());
        if let Ok(field) = field {
            let patch = Patch::with_normals(three(0), forms[9].clone(), field.clone());
            prop_assert!(patch.is_err(), "random normals are not those of a random surface");
            let edge = Edge::new(three(0), forms[9].clone(), field.clone(), field);
            if let Ok(edge) = edge {
                prop_assert!(edge.weight().coefficients().iter().all(|w| *w > 0.0));
            }
        }
    }

    #[test]
    fn any_numbers_of_revolution(numbers in collection::vec(number(), 27), framed in any::<bool>(), turn in collection::vec(number(), 12)) {
        let triple = |start: usize| [numbers[start], numbers[start + 1], numbers[start + 2]];
        let frame = framed.then(|| (Matrix3::from_column_slice(&turn[..9]), [turn[9], turn[10], turn[11]]));
        let made = Revolved::new([0, 3, 6].map(triple), [9, 12, 15, 18, 21, 24].map(triple), frame);
        prop_assert!(made.is_err(), "random numbers are not a surface of revolution with its normals");
    }
}
