use crate::common::{dot, normal_of, unit};
use sweepsim_dexel::internals::surface_within;
use sweepsim_dexel::*;
use sweepsim_props::*;

/// Cosine of 40°: a triangle does not share a vertex whose normal is farther than this from its own.
const CRISP: f64 = 0.766;

fn soup(mesh: &Mesh) -> TriangleSoup {
    TriangleSoup {
        triangles: mesh
            .triangles
            .iter()
            .map(|t| t.map(|v| mesh.vertices[v as usize]))
            .collect(),
    }
}

/// Closed, with suitable normals; its volume by the divergence theorem.
fn volume(mesh: &Mesh) -> f64 {
    assert_eq!(mesh.normals.len(), mesh.vertices.len());
    assert_eq!(mesh.cut.len(), mesh.vertices.len());
    let soup = soup(mesh);
    soup.check_closed().unwrap();
    for (triangle, corners) in mesh.triangles.iter().zip(&soup.triangles) {
        let across = unit(normal_of(*corners));
        let area = dot(normal_of(*corners), normal_of(*corners)).sqrt();
        for v in triangle {
            let n = mesh.normals[*v as usize].map(f64::from);
            assert!((dot(n, n) - 1.0).abs() < 1e-5);
            let limit = if across[2].abs() < 0.5 && n[2].abs() < 0.5 {
                0.0
            } else {
                CRISP - 1e-3
            };
            assert!(area < 1e-9 || dot(n, across) > limit, "{n:?} at {corners:?}");
        }
    }
    let origin = soup.triangles[0][0];
    soup.triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|p| [0, 1, 2].map(|k| p[k] - origin[k]));
            let n = [
                b[1] * c[2] - b[2] * c[1],
                b[2] * c[0] - b[0] * c[2],
                b[0] * c[1] - b[1] * c[0],
            ];
            dot(a, n) / 6.0
        })
        .sum()
}

fn grid(n: usize) -> Grid {
    Grid::new([0.0, -1.0], [n as f64, n as f64 - 1.0], [n, n]).unwrap()
}

fn filled(n: usize, mut line: impl FnMut(usize, usize) -> Vec<(f64, f64)>) -> Dexels {
    let mut dexels = Dexels::empty(grid(n));
    for i in 0..n {
        for j in 0..n {
            let intervals: Vec<Interval> = line(i, j).iter().map(|(a, b)| Interval::between(*a, *b)).collect();
            dexels.set(i * n + j, &intervals).unwrap();
        }
    }
    dexels
}

#[test]
fn nothing_has_no_surface() {
    assert_eq!(Dexels::empty(grid(3)).surface(), Ok(Mesh::default()));
}

#[test]
fn blocks_steps_holes_and_cavities_have_their_volume() {
    let in_middle = |i: usize, j: usize| (4..12).contains(&i) && (5..12).contains(&j);
    // Up to the grid's rim.
    let block = filled(16, |_, _| vec![(0.0, 4.0)]);
    // Inside of it.
    let island = filled(16, |i, j| if in_middle(i, j) { vec![(0.0, 4.0)] } else { vec![] });
    let step = filled(16, |i, _| vec![(0.0, if i < 7 { 4.0 } else { 9.0 })]);
    let hole = filled(16, |i, j| if in_middle(i, j) { vec![] } else { vec![(0.0, 4.0)] });
    let cavity = filled(16, |i, j| {
        if in_middle(i, j) {
            vec![(0.0, 4.0), (7.0, 9.0)]
        } else {
            vec![(0.0, 9.0)]
        }
    });
    let pocket = filled(16, |i, j| vec![(0.0, if in_middle(i, j) { 4.0 } else { 9.0 })]);
    let stairs = filled(16, |i, j| {
        vec![(
            0.0,
            if in_middle(i, j) {
                4.0
            } else if i < 8 {
                9.0
            } else {
                6.5
            },
        )]
    });
    for (k, dexels) in [block, island, step, hole, cavity, pocket, stairs].iter().enumerate() {
        let mesh = dexels.surface().unwrap();
        let (found, expected) = (volume(&mesh), dexels.volume());
        // Where three levels meet, an outline bends inside of its cells.
        let tolerance = if k == 6 { 1e-3 * expected } else { 1e-9 };
        assert!((found - expected).abs() < tolerance, "case {k}: {found} {expected}");
        let level = mesh
            .normals
            .iter()
            .all(|n| n.iter().filter(|c| c.abs() < 1e-6).count() == 2);
        assert!(level || k == 6, "case {k}");
        assert!(mesh.cut.iter().all(|cut| !*cut) || [3, 6].contains(&k));
    }
}

#[test]
fn a_hole_is_cut_and_a_rim_is_not() {
    let ring = filled(16, |i, j| {
        let r = (i as f64 - 7.5).hypot(j as f64 - 7.5);
        if (3.0..7.0).contains(&r) {
            vec![(0.0, 3.0)]
        } else {
            vec![]
        }
    });
    let mesh = ring.surface().unwrap();
    for (v, cut) in mesh.vertices.iter().zip(&mesh.cut) {
        let r = (v[0] - 8.0).hypot(v[1] - 7.0);
        assert!(!*cut || r < 4.0, "{v:?}");
    }
    assert!(mesh.cut.iter().any(|cut| *cut));
}

#[test]
fn round_bodies_look_round() {
    let grid = Grid::new([-10.0, -10.0], [10.0, 10.0], [50, 50]).unwrap();
    let upright = Stock::Cylinder {
        base: [0.0, 0.0, -3.0],
        axis: [0.0, 0.0, 1.0],
        radius: 8.0,
        height: 6.0,
    };
    let mesh = upright.dexels(&grid).unwrap().surface().unwrap();
    let exact = std::f64::consts::PI * 64.0 * 6.0;
    assert!(
        (volume(&mesh) - exact).abs() < 0.015 * exact,
        "{} {exact}",
        volume(&mesh)
    );
    for (v, n) in mesh.vertices.iter().zip(&mesh.normals) {
        if n[2] == 0.0 {
            let r = v[0].hypot(v[1]);
            // Cells are 0.4 wide.
            assert!((r - 8.0).abs() < 0.25, "{r}");
            let out = (v[0] * f64::from(n[0]) + v[1] * f64::from(n[1])) / r;
            assert!(out > 0.97, "{out} at {v:?}");
        }
    }
    let lying = Stock::Cylinder {
        base: [-7.0, 0.0, 0.0],
        axis: [1.0, 0.0, 0.0],
        radius: 5.0,
        height: 14.0,
    };
    let mesh = lying.dexels(&grid).unwrap().surface().unwrap();
    let exact = std::f64::consts::PI * 25.0 * 14.0;
    assert!(
        (volume(&mesh) - exact).abs() < 0.02 * exact,
        "{} {exact}",
        volume(&mesh)
    );
}

#[test]
fn tangents_meet_in_a_crease() {
    // A ridge between columns 7 and 8, nearer to the latter, with faces of 45° and 60°.
    let (top, at) = (10.0, 8.2);
    let mut dexels = Dexels::empty(grid(16));
    for index in 0..dexels.grid().len() {
        let (i, _) = dexels.grid().place(index);
        let x = dexels.grid().x(i);
        let (slope, n) = if x < at {
            (1.0, [-1.0, 0.0, 1.0])
        } else {
            (-1.7, [1.7, 0.0, 1.0])
        };
        let mut interval = Interval::between(-5.0, top + slope * (x - at));
        interval.upper.normal = unit(n).map(|c| c as f32);
        dexels.set(index, &[interval]).unwrap();
    }
    let mesh = dexels.surface().unwrap();
    assert!(volume(&mesh) > 0.0);
    // Normals are kept to 6.5e-5 radians, so slopes s to 6.5e-5 (1 + s²). Ends are 0.7 and 0.3 before and behind the
    // ridge, where slopes 1 and −1.7 meet: at x to (0.7 · 2 + 0.3 · 3.89) · 6.5e-5 / 2.7, at z to (0.7 · 2 · 1.7 + 0.3
    // · 3.89 · 1) · 6.5e-5 / 2.7.
    let (off_x, off_z) = (6.2e-5, 8.6e-5);
    let ridge: Vec<_> = mesh.vertices.iter().filter(|v| (v[2] - top).abs() < off_z).collect();
    assert!(
        ridge.len() >= 32 && ridge.iter().all(|v| (v[0] - at).abs() < off_x),
        "{}",
        ridge.len()
    );
}

#[test]
fn the_same_at_any_thread_count() {
    let dexels = filled(20, |i, j| {
        vec![
            (0.0, 1.0 + ((i * 7 + j * 5) % 11) as f64),
            (15.0, 16.0 + (i * j % 3) as f64),
        ]
    });
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| dexels.surface().unwrap())
    };
    assert_eq!(run(1), run(3));
}

fn normal() -> impl Strategy<Value = [f32; 3]> {
    [-1.0..1.0_f64, -1.0..1.0, 0.0..1.0].prop_map(|n| unit(n).map(|c| c as f32))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]
    /// Whatever the lines contain, the surface is closed and has about the volume of the dexels.
    #[test]
    fn any_dexels_have_a_closed_surface(
        lines in collection::vec(
            (collection::btree_set(0..200u32, 0..8), collection::vec(normal(), 8)), 25),
        scale in prop_oneof![Just(0.01), Just(0.1)],
    ) {
        let mut dexels = Dexels::empty(grid(5));
        for (index, (heights, normals)) in lines.iter().enumerate() {
            let z: Vec<f64> = heights.iter().map(|h| f64::from(*h) * scale).collect();
            let intervals: Vec<Interval> = z.chunks_exact(2).zip(normals.chunks_exact(2)).map(|(z, n)| {
                let mut interval = Interval::between(z[0], z[1]);
                interval.lower.normal = n[0].map(|c| -c);
                interval.upper.normal = n[1];
                interval
            }).collect();
            dexels.set(index, &intervals).unwrap();
        }
        let mesh = dexels.surface().unwrap();
        prop_assert!(mesh.vertices.iter().flatten().all(|c| c.is_finite()));
        match soup(&mesh).check_closed() {
            Ok(()) => prop_assert!(dexels.covered() > 0),
            Err(error) => prop_assert!(error == MeshError::Empty && dexels.covered() == 0, "{}", error),
        }
    }
}

#[test]
fn more_vertices_than_numbers_are_an_error() {
    let ball = Stock::Ball {
        centre: [0.0; 3],
        radius: 4.0,
    };
    let dexels = ball.dexels(&Grid::new([-5.0; 2], [5.0; 2], [9, 9]).unwrap()).unwrap();
    let whole = dexels.surface().unwrap();
    let count = whole.vertices.len();
    assert_eq!(surface_within(&dexels, count), Ok(whole));
    for most in [0, 1, 50, 2 * dexels.count(), count - 1] {
        let found = surface_within(&dexels, most);
        assert!(
            matches!(found, Err(MeshError::TooManyVertices { vertices }) if vertices > most),
            "{most}"
        );
    }
}

#[test]
fn each_vertex_knows_its_cut() {
    let grid = Grid::new([0.0; 2], [8.0; 2], [8, 8]).unwrap();
    let block = Stock::Block {
        min: [0.0; 3],
        max: [8.0, 8.0, 5.0],
    };
    let mut dexels = block.dexels(&grid).unwrap();
    let source = |segment| Source::Cut {
        path: 70_000,
        segment,
        t: 0.5,
    };
    for index in 0..grid.len() {
        let (i, _) = grid.place(index);
        if i < 3 {
            let mut cut = Interval::between(if i == 0 { 2.0 } else { 3.0 }, 9.0);
            cut.lower.source = source(u32::from(i == 0));
            dexels.subtract(index, &[cut]).unwrap();
        }
    }
    let mesh = dexels.surface().unwrap();
    let sources = dexels.sources(&mesh);
    assert_eq!(sources.len(), mesh.vertices.len());
    for ((v, cut), found) in mesh.vertices.iter().zip(&mesh.cut).zip(&sources) {
        assert_eq!(found.is_cut(), *cut, "{v:?}");
        if v[2] == 2.0 && v[0] < 0.9 && *cut {
            assert_eq!(*found, source(1), "{v:?}");
        }
        if v[2] == 3.0 && v[0] > 1.1 && *cut {
            assert_eq!(*found, source(0), "{v:?}");
        }
    }
    for segment in [0, 1] {
        assert!(sources.contains(&source(segment)));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// The nearest end of all sets, wherever a place is: near an end of one set, of another one, or of none.
    #[test]
    fn sources_are_those_of_the_nearest_ends(
        spans in collection::vec(collection::vec((0.0..6.0_f64, 0.1..4.0_f64, any::<bool>()), 36), 3),
        places in collection::vec(prop::array::uniform3(-3.0..9.0_f64), 40),
    ) {
        let set = |axis: usize| {
            let grid = Grid::new([0.0; 2], [6.0; 2], [6; 2]).unwrap().in_frame(Frame::cyclic(axis));
            Dexels::from_fn(grid, |index, line| {
                let (from, length, is_cut) = spans[axis][index];
                let mut interval = Interval::between(from, from + length);
                for (end, number) in [(&mut interval.lower, 0), (&mut interval.upper, 1)] {
                    if is_cut {
                        end.source = Source::Cut { path: axis as u32, segment: 2 * index as u32 + number, t: 0.0 };
                    }
                }
                // A few lines have material.
                line.extend((index % 5 == 0).then_some(interval));
            })
            .unwrap()
        };
        let sets = [set(0), set(1), set(2)];
        let mut ends: Vec<([f64; 3], Source)> = Vec::new();
        for set in &sets {
            let grid = set.grid();
            for (index, intervals) in set.iter() {
                let (i, j) = grid.place(index);
                let own = intervals.iter().flat_map(|interval| [interval.lower, interval.upper]);
                let cut = own.filter(|end| end.source.is_cut());
                ends.extend(cut.map(|end| (grid.frame().to_world([grid.x(i), grid.y(j), end.z]), end.source)));
            }
        }
        let mesh = Mesh { cut: vec![true; places.len()], vertices: places, ..Mesh::default() };
        let sources = TriDexels::from_sets(sets).unwrap().sources(&mesh);
        let far = |end: &([f64; 3], Source), p: &[f64; 3]| (0..3).map(|k| (end.0[k] - p[k]).powi(2)).sum::<f64>().sqrt();
        for (place, found) in mesh.vertices.iter().zip(sources) {
            let least = ends.iter().map(|end| far(end, place)).fold(f64::INFINITY, f64::min);
            match ends.iter().find(|end| end.1 == found) {
                Some(end) => prop_assert!(far(end, place) <= least + 1e-9, "{place:?}"),
                None => prop_assert!(found == Source::Stock && ends.is_empty(), "{place:?}"),
            }
        }
    }
}
