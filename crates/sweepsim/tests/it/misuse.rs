//! Input at the limits of what numbers can hold: an error, or a result that says what is uncertain; never a panic, never a silent loss.

use sweepsim::{Options, sweep};
use sweepsim_dexel::Grid;
use sweepsim_motion::{Patch, Path, Pose, Tool};
use sweepsim_spline::Bernstein;

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
            let ends = |volume: &sweepsim_dexel::Dexels| -> Vec<f64> {
                volume.at(line).iter().flat_map(|i| [i.lower.z, i.upper.z]).collect()
            };
            let (found, expected) = (ends(&swept.volume), ends(&plain.volume));
            let same = found.len() == expected.len() && found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-6);
            assert!(open || same, "{weight:e}, dexel {i} {j}: {found:?} for {expected:?}");
        }
    }
    assert!(tested > 3, "{tested}");
}
