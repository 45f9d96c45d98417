use crate::common::{boxed, normal_of};
use std::collections::BTreeMap;
use sweepsim_dexel::internals::contour;
use sweepsim_dexel::*;
use sweepsim_props::*;

/// Every edge has two triangles, in opposite directions; the triangles around a vertex are one fan.
fn check_manifold(mesh: &Mesh) {
    let mut edges: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    let mut fans: BTreeMap<u32, Vec<(u32, u32)>> = BTreeMap::new();
    for t in &mesh.triangles {
        assert!(t[0] != t[1] && t[1] != t[2] && t[2] != t[0], "{t:?}");
        for k in 0..3 {
            let (a, b, c) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
            *edges.entry((a, b)).or_default() += 1;
            fans.entry(a).or_default().push((b, c));
        }
    }
    for ((a, b), count) in &edges {
        assert_eq!(*count, 1, "edge {a} {b}");
        assert!(edges.contains_key(&(*b, *a)), "edge {a} {b} is open");
    }
    for (vertex, fan) in fans {
        let next: BTreeMap<u32, u32> = fan.iter().copied().collect();
        let (start, mut at, mut count) = (fan[0].0, fan[0].0, 0);
        loop {
            at = next[&at];
            count += 1;
            if at == start || count > fan.len() {
                break;
            }
        }
        assert_eq!(count, fan.len(), "vertex {vertex}");
    }
}

/// And no triangles cross.
fn check_solid(mesh: &Mesh) {
    check_manifold(mesh);
    assert_eq!(mesh.soup().unwrap().faults(10), []);
}

fn volume(mesh: &Mesh) -> f64 {
    let triple = |[a, b, c]: [[f64; 3]; 3]| {
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    let corners = |t: &[u32; 3]| t.map(|v| mesh.vertices[v as usize]);
    mesh.triangles.iter().map(|t| triple(corners(t))).sum::<f64>() / 6.0
}

fn solid(cells: usize, stock: &Stock) -> TriDexels {
    TriDexels::new([-10.0; 3], [10.0; 3], [cells, cells + 1, cells + 2], stock).unwrap()
}

fn cylinder(base: [f64; 3], axis: [f64; 3], radius: f64, height: f64) -> Stock {
    Stock::Cylinder {
        base,
        axis,
        radius,
        height,
    }
}

#[test]
fn boxes_are_sharp() {
    let (min, max) = ([-6.13, -4.4, -5.77], [3.3, 5.21, 7.19]);
    let solid = solid(24, &Stock::Block { min, max });
    assert_eq!(solid.disagreements(), 0);
    let mesh = solid.surface().unwrap();
    check_manifold(&mesh);
    let exact: f64 = (0..3).map(|k| max[k] - min[k]).product();
    assert!((volume(&mesh) - exact).abs() < 1e-9 * exact, "{}", volume(&mesh));
    let mut on = [0; 4];
    for v in &mesh.vertices {
        let near = |k: usize| (v[k] - min[k]).abs().min((v[k] - max[k]).abs()) < 1e-12;
        on[(0..3).filter(|k| near(*k)).count()] += 1;
    }
    // For pictures: normals of faces only.
    let crisp = mesh.crisp(0.8).unwrap();
    assert_eq!(crisp.triangles.len(), mesh.triangles.len());
    assert_eq!(crisp.vertices.len(), mesh.vertices.len() + on[2] + 2 * on[3]);
    let level = |n: &[f32; 3]| n.iter().filter(|c| c.abs() > 1e-6).count() == 1;
    assert!(crisp.normals.iter().all(level));
    // All vertices are on faces, each edge is followed, each corner is reproduced.
    assert_eq!((on[0], on[3]), (0, 8));
    assert!(on[2] > 100);
}

/// Beside an edge that bends inwards, no triangle of a flat face lies on another.
#[test]
fn flat_faces_are_not_folded() {
    let hole = cylinder([1.3, -0.7, -2.1], [0.0, 0.0, 1.0], 6.3, 20.0);
    let (min, max) = ([-9.1; 3], [9.1; 3]);
    let part = Stock::Difference(Box::new(Stock::Block { min, max }), vec![hole]);
    let soup = solid(24, &part).surface().unwrap().soup().unwrap();
    for level in [-2.1, 9.1] {
        let is_level = |t: &&[[f64; 3]; 3]| t.iter().all(|p| (p[2] - level).abs() < 1e-6);
        let level = { soup.triangles.iter() }.filter(is_level);
        let heights: Vec<f64> = level.map(|t| normal_of(*t)[2]).collect();
        assert!(heights.len() > 300 && heights.iter().all(|up| *up >= 0.0));
    }
}

/// A box around the origin, rotated about an axis by an angle, as triangles; and its three directions.
fn turned_box(half: [f64; 3], axis: [f64; 3], angle: f64) -> (TriangleSoup, [[f64; 3]; 3]) {
    let length = axis.iter().map(|c| c * c).sum::<f64>().sqrt();
    let a = axis.map(|c| c / length);
    let (sin, cos) = angle.sin_cos();
    // Rodrigues' formula.
    let turn = |v: [f64; 3]| {
        let along = (0..3).map(|k| a[k] * v[k]).sum::<f64>();
        [0, 1, 2].map(|k| {
            let across = a[(k + 1) % 3] * v[(k + 2) % 3] - a[(k + 2) % 3] * v[(k + 1) % 3];
            cos * v[k] + sin * across + (1.0 - cos) * along * a[k]
        })
    };
    let corner = |n: usize| turn([0, 1, 2].map(|k| if n >> k & 1 == 0 { -half[k] } else { half[k] }));
    let soup = boxed(corner);
    (
        soup,
        [0, 1, 2].map(|k| turn([0, 1, 2].map(|c| if c == k { 1.0 } else { 0.0 }))),
    )
}

/// Dexels keep normals to 6.5e-5 radians. A cell's ends are at most a diagonal of it, √3 steps, from where their planes
/// meet, so at a right edge each of its two planes is off by at most 6.5e-5 · √3 steps there, and so is the vertex
/// along either of their normals.
#[test]
fn edges_of_turned_boxes_are_as_sharp_as_their_normals() {
    let half = [5.1, 3.3, 4.2];
    for (axis, angle) in [([1.0, 2.0, 3.0], 0.7), ([-2.0, 1.0, 0.3], 1.9), ([0.0, 0.0, 1.0], 0.5)] {
        let (soup, directions) = turned_box(half, axis, angle);
        let dexels = solid(40, &Stock::Mesh(soup.clone()));
        check_solid(&dexels.solid_surface().unwrap());
        let step = 0.5;
        for mesh in [dexels.surface().unwrap(), dexels.solid_surface().unwrap()] {
            check_manifold(&mesh);
            let (mut on_edges, mut on_corners, mut off_faces) = (0, 0, 0);
            for v in &mesh.vertices {
                let off = [0, 1, 2].map(|k| {
                    let along = (0..3).map(|c| directions[k][c] * v[c]).sum::<f64>();
                    (along.abs() - half[k]).abs()
                });
                let near = off
                    .iter()
                    .filter(|d| **d < 2.0 * 6.5e-5 * step * 3.0_f64.sqrt())
                    .count();
                off_faces += usize::from(near == 0);
                // Vertices on no face are in cells that an edge only just touches, where at most one line meets one of
                // its faces.
                assert!(
                    near > 0 || off.iter().filter(|d| **d < step).count() >= 2,
                    "{v:?} {off:?}"
                );
                on_edges += usize::from(near == 2);
                on_corners += usize::from(near == 3);
            }
            assert_eq!(on_corners, 8);
            assert!(
                on_edges > 200 && off_faces * 100 < mesh.vertices.len(),
                "{on_edges} {off_faces}"
            );
            // Edges that pass cells are followed: less is missing than a chamfer in each of them would remove.
            let (found, exact) = (volume(&mesh), 8.0 * half.iter().product::<f64>());
            assert!((found - exact).abs() < 1e-4 * exact, "{found} {exact}");
        }
    }
}

/// Second order: triangles follow curved faces by the square of their size over the radius, and edges likewise.
#[test]
fn volumes_converge_with_the_square_of_the_distance_of_lines() {
    let ball = |centre: [f64; 3], radius: f64| Stock::Ball { centre, radius };
    let tau = std::f64::consts::TAU;
    // A lens of two balls of radius 6, 7 apart: π (4r + d) (2r − d)² / 12.
    let lens = Stock::Intersection(vec![ball([-3.4, 0.3, 0.2], 6.0), ball([3.6, 0.3, 0.2], 6.0)]);
    let cases = [
        (ball([0.13, -0.21, 0.32], 7.7), tau * 2.0 / 3.0 * 7.7_f64.powi(3)),
        (
            cylinder([-3.0, -2.5, -4.1], [3.0, 2.0, 4.0], 4.3, 9.0),
            0.5 * tau * 4.3 * 4.3 * 9.0,
        ),
        (lens, tau / 24.0 * (24.0 + 7.0) * 25.0),
    ];
    for (stock, exact) in cases {
        let error = |cells: usize| (volume(&solid(cells, &stock).surface().unwrap()) - exact).abs() / exact;
        // Means over grids of nearly the same size, since the positions of the lines matter.
        let mean = |cells: usize| (cells..cells + 6).map(error).sum::<f64>() / 6.0;
        let (coarse, fine) = (mean(24), mean(96));
        // The ratio of the mean sizes is 98.5 / 26.5.
        let order = (coarse / fine).ln() / f64::ln(98.5 / 26.5);
        assert!(order > 1.7 && fine < 2e-3, "{order}: {coarse} {fine} {stock:?}");
    }
}

#[test]
fn edges_of_any_direction_are_sharp() {
    // A cylinder's rim, and the edge where a ball cuts it.
    let cylinder = cylinder([-5.0, -3.0, -4.0], [3.0, 2.0, 2.5], 4.0, 11.0);
    let dexels = solid(60, &cylinder);
    let solid_surface = dexels.solid_surface().unwrap();
    check_solid(&solid_surface);
    let length = f64::sqrt(9.0 + 4.0 + 6.25);
    for (mesh, most) in [
        (dexels.surface().unwrap(), 0),
        (solid_surface.clone(), solid_surface.vertices.len() / 500),
    ] {
        check_manifold(&mesh);
        let (mut rim, mut far, mut held) = (0, 0, 0);
        for v in &mesh.vertices {
            let p = [v[0] + 5.0, v[1] + 3.0, v[2] + 4.0];
            let along = (3.0 * p[0] + 2.0 * p[1] + 2.5 * p[2]) / length;
            let across = (p.iter().map(|c| c * c).sum::<f64>() - along * along).max(0.0).sqrt();
            let (side, end) = ((across - 4.0).abs(), along.abs().min((along - 11.0).abs()));
            // Cells are a third wide; on a side of curvature 1/4 their tangent planes are off by at most
            // (√3/3)²/8 = 0.04; a little more in faces that cut the rim at a flat angle. Where triangles would cross,
            // vertices may be in the middle of ends, which are on the surface and at most a diagonal apart.
            assert!(side.min(end) < 0.5 * 3.0_f64.sqrt() / 3.0, "{v:?} {side} {end}");
            held += usize::from(side.min(end) > 0.06);
            far += usize::from(side.min(end) > 0.01);
            rim += usize::from(side.max(end) < 0.02);
        }
        assert!(
            rim > 80 && far * 100 < mesh.vertices.len() && held <= most,
            "{rim} {far} {held} {}",
            mesh.vertices.len()
        );
    }
}

#[test]
fn the_box_cuts_off_what_reaches_beyond() {
    let mesh = solid(
        20,
        &Stock::Ball {
            centre: [9.0, 0.0, 0.0],
            radius: 5.0,
        },
    )
    .surface()
    .unwrap();
    check_manifold(&mesh);
    assert!(mesh.vertices.iter().all(|v| v[0] <= 10.0 + 0.1));
    let cap = std::f64::consts::PI * 16.0 * (15.0 - 4.0) / 3.0;
    let exact = 4.0 / 3.0 * std::f64::consts::PI * 125.0 - cap;
    assert!(
        (volume(&mesh) - exact).abs() < 0.02 * exact,
        "{} {exact}",
        volume(&mesh)
    );
    assert!(
        solid(5, &Stock::Union(Vec::new()))
            .surface()
            .unwrap()
            .triangles
            .is_empty()
    );
}

#[test]
fn the_same_at_any_thread_count() {
    let solid = solid(
        30,
        &Stock::Ball {
            centre: [0.1, 0.2, 0.3],
            radius: 7.0,
        },
    );
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| solid.surface().unwrap())
    };
    assert_eq!(run(1), run(3));
}

fn part() -> impl Strategy<Value = Stock> {
    let place = [-7.0..7.0_f64, -7.0..7.0, -7.0..7.0];
    prop_oneof![
        (place.clone(), [1.0..9.0_f64, 1.0..9.0, 1.0..9.0]).prop_map(|(min, size)| Stock::Block {
            min,
            max: [0, 1, 2].map(|k| min[k] + size[k])
        }),
        (place.clone(), 1.0..7.0_f64).prop_map(|(centre, radius)| Stock::Ball { centre, radius }),
        (place.clone(), place, 1.0..4.0_f64, 2.0..14.0_f64)
            .prop_map(|(base, axis, radius, height)| cylinder(base, axis, radius, height)),
    ]
}

/// A few parts, united, subtracted, intersected.
fn csg() -> impl Strategy<Value = Stock> {
    (part(), collection::vec((part(), 0..4), 0..5)).prop_map(|(first, more)| {
        more.into_iter().fold(first, |whole, (part, kind)| match kind {
            0 | 1 => Stock::Union(vec![whole, part]),
            2 => Stock::Difference(Box::new(whole), vec![part]),
            _ => Stock::Union(vec![
                Stock::Intersection(vec![whole.clone(), part.clone()]),
                Stock::Difference(Box::new(whole), vec![part]),
            ]),
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20_000, ..ProptestConfig::default() })]
    /// `cargo test --release -p sweepsim-dexel -- --ignored thousands`
    #[test]
    #[ignore = "takes minutes"]
    fn thousands_of_surfaces_are_manifold(stock in csg(), cells in 4..16usize) {
        let solid = solid(cells, &stock);
        check_manifold(&solid.surface().unwrap());
        check_solid(&solid.solid_surface().unwrap());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]
    #[test]
    fn volumes_converge(stock in csg()) {
        // The true volume, from many lines: for a slab 1 thick and 9 wide they are within 1.5 %, less than the
        // tolerance below.
        let grid = Grid::new([-10.0; 2], [10.0; 2], [1501, 1501]).unwrap();
        let whole = Stock::Block { min: [-10.0; 3], max: [10.0; 3] };
        let exact = Stock::Intersection(vec![whole, stock.clone()]).dexels(&grid).unwrap().volume();
        let mesh = solid(72, &stock).surface().unwrap();
        let found = volume(&mesh);
        prop_assert!((found - exact).abs() < 0.01 * exact + 0.5, "{} {} {:?}", found, exact, stock);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]
    #[test]
    fn surfaces_of_csg_are_manifold(stock in csg(), cells in 6..20usize) {
        let solid = solid(cells, &stock);
        check_solid(&solid.solid_surface().unwrap());
        let mesh = solid.surface().unwrap();
        check_manifold(&mesh);
        prop_assert!(mesh.vertices.iter().flatten().all(|c| c.is_finite()));
        prop_assert_eq!(mesh.normals.len(), mesh.vertices.len());
        prop_assert_eq!(mesh.cut.len(), mesh.vertices.len());
        let triangles: Vec<_> = mesh.triangles.iter().map(|t| t.map(|v| mesh.vertices[v as usize])).collect();
        let closed = triangles.is_empty() || TriangleSoup { triangles }.check_closed().is_ok();
        prop_assert!(closed);
    }

    /// Random points: every kind of cell beside every other.
    #[test]
    fn any_lattice_gives_a_manifold(seed in any::<u64>(), share in 1..8_u32) {
        const N: usize = 6;
        let filled = |p: [usize; 3]| {
            let hash = (p[0] * N * N + p[1] * N + p[2]) as u64;
            let mixed = (hash.wrapping_add(seed)).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            (mixed >> 40) % 8 < u64::from(share)
        };
        let set = |axis: usize| {
            let grid = Grid::new([0.0; 2], [N as f64; 2], [N; 2]).unwrap();
            let grid = grid.in_frame(Frame::cyclic(axis));
            Dexels::from_fn(grid, |index, line| {
                let (i, j) = grid.place(index);
                for n in 0..N {
                    let mut p = [0; 3];
                    (p[(axis + 1) % 3], p[(axis + 2) % 3], p[axis]) = (i, j, n);
                    if filled(p) {
                        line.push(Interval::between(n as f64, n as f64 + 1.0));
                    }
                }
            })
            .unwrap()
        };
        let solid = TriDexels::from_sets([set(0), set(1), set(2)]).unwrap();
        prop_assert_eq!(solid.disagreements(), 0);
        check_manifold(&solid.surface().unwrap());
    }
}

#[test]
fn more_vertices_than_numbers_are_an_error() {
    let ball = Stock::Ball {
        centre: [0.0; 3],
        radius: 4.0,
    };
    let solid = TriDexels::new([-5.0; 3], [5.0; 3], [9; 3], &ball).unwrap();
    let whole = solid.surface().unwrap();
    let count = whole.vertices.len();
    assert_eq!(contour(&solid, count), Ok(whole));
    for most in [0, 1, count / 2, count - 1] {
        assert!(contour(&solid, most).is_err(), "{most}");
    }
}
