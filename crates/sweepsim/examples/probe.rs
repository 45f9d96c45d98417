use std::time::Instant;
use sweepsim::*;
use sweepsim_dexel::*;
use sweepsim_motion::*;
fn main() {
    let n: usize = std::env::args().nth(1).map_or(200, |s| s.parse().unwrap());
    let d = |a: f64| a.to_radians();
    let p = |t: [f64; 3], a: [f64; 3]| Pose::new(t, a).unwrap();
    let s1 = vec![
        p([-20., -10., 0.], [d(15.).sin(), 0., d(15.).cos()]),
        p([20., 10., 8.], [d(15.).sin(), 0., d(15.).cos()]),
    ];
    let s2 = vec![
        p([-20., -10., 0.], [0., d(25.).sin(), d(25.).cos()]),
        p([20., 10., 8.], [0., -d(25.).sin(), d(25.).cos()]),
    ];
    let s3 = vec![p([-20., -10., 3.], [0., 0., 1.]), p([20., 10., 3.], [0., 0., 1.])];
    let s4 = vec![p([-20., -10., 3.], [0., 0., 1.]), p([-20., -10., -3.], [0., 0., 1.])];
    let s5: Vec<Pose> = (0..61)
        .map(|k| {
            let a = k as f64 * 0.1;
            p(
                [15. * a.cos(), 12. * a.sin(), 3. * (2. * a).sin()],
                [0.3 * (1.3 * a).sin(), 0.3 * a.cos(), 1.],
            )
        })
        .collect();
    let s6: Vec<Pose> = (0..61)
        .map(|k| {
            let a = k as f64 * 0.1;
            p([15. * a.cos(), 12. * a.sin(), 3.], [0., 0., 1.])
        })
        .collect();
    let conc = Profile::new(
        [0., 0.],
        vec![
            ProfileSegment::Line { to: [2., 0.] },
            ProfileSegment::Line { to: [2., 2.] },
            ProfileSegment::Arc {
                to: [8., 8.],
                centre: [8., 2.],
                turn: Turn::Cw,
            },
            ProfileSegment::Line { to: [8., 30.] },
            ProfileSegment::Line { to: [0., 30.] },
        ],
    )
    .unwrap();
    for (tn, tool) in [
        ("ball", Tool::ball(5., 30.).unwrap()),
        ("flat", Tool::flat(5., 30.).unwrap()),
        ("bull", Tool::bull(5., 1., 30.).unwrap()),
        ("form", Tool::from_profile(conc)),
    ] {
        for (sn, s) in [
            ("sweep1", &s1),
            ("sweep2", &s2),
            ("horiz", &s3),
            ("plunge", &s4),
            ("path60", &s5),
            ("planar60", &s6),
        ] {
            let grid = Grid::new([-32., -25.], [32., 25.], [n, n]).unwrap();
            let t = Instant::now();
            let r = sweep(&tool, &Path::new(s.clone()).unwrap(), &grid, &Options::default(), &()).unwrap();
            println!(
                "{tn:5} {sn:9} {:8.1} ms boxes {:8} charts {:7} crossings {:7} covered {:6} repaired {} unresolved {} vol {:.6}",
                t.elapsed().as_secs_f64() * 1e3,
                r.statistics.boxes,
                r.statistics.charts,
                r.statistics.crossings,
                r.statistics.covered,
                r.statistics.repaired,
                r.statistics.unresolved.len(),
                r.volume.volume()
            );
            for u in r.statistics.unresolved.iter().take(2) {
                println!("   {u:?}");
            }
        }
    }
}
