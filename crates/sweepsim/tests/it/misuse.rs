//! Input at the limits of what numbers can hold: an error, or a result that says what is uncertain; never a panic,
//! never a silent loss.

use sweepsim::motion::Patch;
use sweepsim::prelude::*;
use sweepsim::spline::Bernstein;
use sweepsim::systems::Plane;
use sweepsim::{Ray, probe, section};
use sweepsim_props::*;

/// A block with its tip at the origin, all weights the same.
fn block(weight: f64) -> Option<Tool> {
    let corner = |x: f64, y: f64, z: f64| [x, y, z];
    let (low, high) = (-1.0, 1.0);
    let faces = [
        // Counter-clockwise seen from outside: (u, v) at (0, 0), (1, 0), (0, 1), (1, 1).
        [
            corner(low, low, 0.0),
            corner(low, high, 0.0),
            corner(high, low, 0.0),
            corner(high, high, 0.0),
        ],
        [
            corner(low, low, 3.0),
            corner(high, low, 3.0),
            corner(low, high, 3.0),
            corner(high, high, 3.0),
        ],
        [
            corner(low, low, 0.0),
            corner(high, low, 0.0),
            corner(low, low, 3.0),
            corner(high, low, 3.0),
        ],
        [
            corner(high, high, 0.0),
            corner(low, high, 0.0),
            corner(high, high, 3.0),
            corner(low, high, 3.0),
        ],
        [
            corner(low, high, 0.0),
            corner(low, low, 0.0),
            corner(low, high, 3.0),
            corner(low, low, 3.0),
        ],
        [
            corner(high, low, 0.0),
            corner(high, high, 0.0),
            corner(high, low, 3.0),
            corner(high, high, 3.0),
        ],
    ];
    let patches = faces.map(|corners| {
        let form = |k: usize| Bernstein::new(&[1, 1], corners.iter().map(|p| p[k] * weight).collect()).ok();
        let weights = Bernstein::new(&[1, 1], vec![weight; 4]).ok()?;
        Patch::new([form(0)?, form(1)?, form(2)?], weights).ok()
    });
    let patches: Option<Vec<Patch>> = patches.into_iter().collect();
    Tool::from_patches(patches?, 1e-9).ok()
}

#[test]
fn weights_that_underflow_lose_nothing_in_silence() {
    let pose = |x: f64| Pose::new([x, 0.1, 0.2], [0.1, 0.05, 1.0]).unwrap();
    let path = Path::new(vec![pose(-3.0), pose(3.0)]).unwrap();
    let grid = Grid::new([-1.0, -1.0], [1.0, 1.0], [4, 4]).unwrap();
    let plain = sweep(&block(1.0).unwrap(), &path, &grid, &Options::new(1e-6), &()).unwrap();
    assert_eq!(plain.statistics.covered, 16);
    // The products of two such weights underflow: half of them to zero, half to numbers of a few digits.
    let mut tested = 0;
    for weight in [
        1e-60, 1e-80, 1e60, 1e80, 1e-100, 1e-155, 1e-162, 1e-170, 1e-300, 1e100, 1e160, 1e300,
    ] {
        let Some(tool) = block(weight) else { continue };
        let Ok(swept) = sweep(&tool, &path, &grid, &Options::new(1e-6), &()) else {
            continue;
        };
        tested += 1;
        for line in 0..16 {
            let (i, j) = grid.place(line);
            let open = swept
                .statistics
                .unresolved
                .iter()
                .any(|dexel| (dexel.i, dexel.j) == (i, j));
            let ends =
                |volume: &Dexels| -> Vec<f64> { volume.at(line).iter().flat_map(|i| [i.lower.z, i.upper.z]).collect() };
            let (found, expected) = (ends(&swept.volume), ends(&plain.volume));
            let same = found.len() == expected.len() && found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-6);
            assert!(open || same, "{weight:e}, dexel {i} {j}: {found:?} for {expected:?}");
        }
    }
    assert!(tested > 3, "{tested}");
}

proptest! {
    /// Whatever the numbers: an error, or a plane with a frame.
    #[test]
    fn planes_are_valid_or_refused(normal in prop::array::uniform3(any::<f64>()), offset in any::<f64>()) {
        match Plane::new(normal, offset) {
            Ok(plane) => {
                let [a, b] = plane.frame();
                let lengths = [a, b].map(|v| v.iter().map(|x| x * x).sum::<f64>());
                prop_assert!(lengths.iter().all(|l| (l - 1.0).abs() < 1e-12), "{normal:?}");
                prop_assert!(plane.offset().is_finite());
            }
            Err(_) => {
                let sound = normal.iter().all(|x| x.is_finite()) && normal != [0.0; 3] && offset.is_finite();
                let largest = normal.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
                prop_assert!(!sound || !(offset / largest).is_finite());
            }
        }
    }

    /// Tolerances and chord errors of any kind: an error or a result, never a panic.
    #[test]
    fn tolerances_are_valid_or_refused(tolerance in any::<f64>(), chord in any::<f64>()) {
        let up = [0.0, 0.0, 1.0];
        let path = Path::new(vec![Pose::new([-1.0, 0.0, 0.0], up).unwrap(), Pose::new([1.0, 0.0, 0.0], up).unwrap()]).unwrap();
        let tool = Tool::flat(1.0, 5.0).unwrap();
        let grid = Grid::new([-3.0, -2.0], [3.0, 2.0], [3, 2]).unwrap();
        let options = Options::new(tolerance);
        let sound = tolerance > 0.0 && tolerance.is_finite();
        let swept = sweep(&tool, &path, &grid, &options, &());
        prop_assert!(swept.is_err() || sound);
        let ray = Ray::new([0.1, 0.2, 0.3], up).unwrap();
        prop_assert!(probe(&tool, &path, &[ray], &options, &()).is_err() || sound);
        if !(chord > 1e-3) {
            let plane = Plane::x(0.1).unwrap();
            let found = section(&[Cut::new(&tool, &path)], &plane, chord.min(0.0), &options, &());
            prop_assert!(found.is_err());
        }
    }
}

#[test]
fn empty_input_has_empty_results() {
    let plane = Plane::z(1.0).unwrap();
    let found = section(&[], &plane, 1e-3, &Options::default(), &()).unwrap();
    assert!(found.curves.is_empty() && found.loops().closed.is_empty());
    let tool = Tool::flat(1.0, 5.0).unwrap();
    let path = Path::new(vec![Pose::new([0.0; 3], [0.0, 0.0, 1.0]).unwrap()]).unwrap();
    assert!(probe(&tool, &path, &[], &Options::default(), &()).unwrap().is_empty());
}

#[test]
fn points_beside_a_simulation_have_no_source() {
    let grid = Grid::new([0.0; 2], [4.0; 2], [4, 4]).unwrap();
    let stock = Stock::Block {
        min: [0.0; 3],
        max: [4.0; 3],
    }
    .dexels(&grid)
    .unwrap();
    let done = simulate(stock, &[], &Options::default(), &()).unwrap();
    for point in [
        [f64::NAN, 1.0, 1.0],
        [f64::INFINITY, 0.0, 0.0],
        [1e300; 3],
        [-20.0, 2.0, 4.0],
    ] {
        assert_eq!(done.source_at(point), None, "{point:?}");
    }
    let top = done.source_at([2.1, 2.1, 4.0]).unwrap();
    assert!(!top.source.is_cut() && top.distance < 1.0 && top.position[2] == 4.0);
}
