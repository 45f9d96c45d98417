use std::time::Instant;
use sweepsim::*;
use sweepsim_dexel::*;
use sweepsim_motion::*;
fn main() {
    let drill = |r: f64, h: f64, l: f64| {
        Tool::from_profile(
            Profile::new(
                [0., 0.],
                vec![
                    ProfileSegment::Line { to: [r, h] },
                    ProfileSegment::Line { to: [r, l] },
                    ProfileSegment::Line { to: [0., l] },
                ],
            )
            .unwrap(),
        )
    };
    let p = |t: [f64; 3], a: [f64; 3]| Pose::new(t, a).unwrap();
    let z = [0., 0., 1.];
    let cases = [
        (drill(3.9845, 0.5977, 7.969), vec![p([0.; 3], z)], 7.305),
        (
            drill(1., 0.15, 2.),
            vec![p([0.; 3], z), p([0.; 3], [1e-3, 0., 1.])],
            1.83333,
        ),
        (
            drill(1., 0.15, 2.),
            vec![p([0.; 3], [1e-4, 0., 1.]), p([0.7, 0.1, 0.7], [1e-4, 0., 1.])],
            1.83333,
        ),
    ];
    for (tool, poses, g) in cases {
        let grid = Grid::new([-g, -g], [g, g], [11, 11]).unwrap();
        let t = Instant::now();
        let r = sweep(&tool, &Path::new(poses).unwrap(), &grid, &Options::default(), &()).unwrap();
        println!("{:?} {:?} {:?}", t.elapsed(), r.statistics, r.volume.intervals(5, 5));
    }
}
