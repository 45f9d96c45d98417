use sweepsim::*; use sweepsim_dexel::*; use sweepsim_motion::*;
fn main() {
    let n: usize = std::env::args().nth(1).map_or(200, |s| s.parse().unwrap());
    let runs: usize = std::env::args().nth(2).map_or(3, |s| s.parse().unwrap());
    let d = |a: f64| a.to_radians();
    let p = |t: [f64; 3], a: [f64; 3]| Pose::new(t, a).unwrap();
    let s1 = vec![p([-20., -10., 0.], [d(15.).sin(), 0., d(15.).cos()]), p([20., 10., 8.], [d(15.).sin(), 0., d(15.).cos()])];
    let s2 = vec![p([-20., -10., 0.], [0., d(25.).sin(), d(25.).cos()]), p([20., 10., 8.], [0., -d(25.).sin(), d(25.).cos()])];
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    for (name, tool) in [("ball", Tool::ball(5., 30.).unwrap()), ("flat", Tool::flat(5., 30.).unwrap()), ("bull", Tool::bull(5., 1., 30.).unwrap())] {
    for (s, poses) in [(1, s1.clone()), (2, s2.clone())] {
        let grid = if s == 1 { Grid::new([-25., -15.], [32.8, 15.], [n, n]) } else { Grid::new([-25., -22.7], [25., 22.7], [n, n]) }.unwrap();
        let path = Path::new(poses).unwrap();
        let mut reference: Option<Sweep> = None;
        for method in [Method::Charts, Method::Planes, Method::Surface, Method::Lines] {
            if method == Method::Lines && n > 200 { continue; }
            let mut best = f64::INFINITY; let mut out = None;
            for _ in 0..if method == Method::Lines { 1 } else { runs } { let t = std::time::Instant::now(); out = Some(pool.install(|| sweep(&tool, &path, &grid, &Options::default().method(method), &()).unwrap())); best = best.min(t.elapsed().as_secs_f64()); }
            let out = out.unwrap();
            let (mut topo, mut far) = (0, 0.0f64);
            if let Some(r) = &reference {
                for i in 0..n { for j in 0..n {
                    let (a, b) = (r.volume.intervals(i, j), out.volume.intervals(i, j));
                    if a.len() != b.len() { topo += 1; continue; }
                    for (x, y) in a.iter().zip(b.iter()) { far = far.max((x.lower.z - y.lower.z).abs()).max((x.upper.z - y.upper.z).abs()); }
                }}
            }
            let st = &out.statistics;
            println!("{name} sweep{s} {method}: {:.1} ms, crossings {} boxes {} charts {} repaired {} unresolved {}; topology {topo} far {far:e}", best * 1e3, st.crossings, st.boxes, st.charts, st.repaired, st.unresolved.len());
            if reference.is_none() { reference = Some(out); }
        }
    }}
}
