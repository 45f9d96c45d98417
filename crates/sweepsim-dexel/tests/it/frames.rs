//! Dexels in different frames see the same world.

use sweepsim_dexel::{Frame, Grid, Stock, TriangleSoup, compare_with_mesh};
use sweepsim_props::*;

type Inside = fn([f64; 3]) -> f64;

/// A block without a ball and with a cylinder, and how deep a point is in each, at least; a cylinder's or a block's
/// depth is that of its nearest face.
fn stock() -> (Stock, Inside) {
    let block = Stock::Block {
        min: [-3.0, -2.0, -1.0],
        max: [3.0, 2.0, 2.5],
    };
    let ball = Stock::Ball {
        centre: [1.0, 2.0, 2.0],
        radius: 1.5,
    };
    let cylinder = Stock::Cylinder {
        base: [-1.0, 0.0, -2.0],
        axis: [0.0, 0.6, 0.8],
        radius: 0.7,
        height: 6.0,
    };
    let depth: Inside = |p| {
        let faces = [p[0] + 3.0, 3.0 - p[0], p[1] + 2.0, 2.0 - p[1], p[2] + 1.0, 2.5 - p[2]];
        let block = faces.into_iter().fold(f64::INFINITY, f64::min);
        let d = [p[0] - 1.0, p[1] - 2.0, p[2] - 2.0];
        let ball = 1.5 - d.iter().map(|c| c * c).sum::<f64>().sqrt();
        let q = [p[0] + 1.0, p[1], p[2] + 2.0];
        let s = 0.6 * q[1] + 0.8 * q[2];
        let off = [q[0], q[1] - 0.6 * s, q[2] - 0.8 * s];
        let side = 0.7 - off.iter().map(|c| c * c).sum::<f64>().sqrt();
        block.min(-ball).max(side.min(s).min(6.0 - s))
    };
    let cut = Stock::Difference(Box::new(block), vec![ball]);
    (Stock::Union(vec![cut, cylinder]), depth)
}

/// An octahedron of this radius.
fn octahedron(r: f64) -> TriangleSoup {
    let corner = |axis: usize, sign: f64| [0, 1, 2].map(|k| if k == axis { sign * r } else { 0.0 });
    let mut triangles = Vec::new();
    for n in 0..8 {
        let sign = [0, 1, 2].map(|k| if n >> k & 1 == 0 { 1.0 } else { -1.0 });
        let [a, b, c] = [0, 1, 2].map(|k| corner(k, sign[k]));
        let outwards = sign.iter().product::<f64>() > 0.0;
        triangles.push(if outwards { [a, b, c] } else { [a, c, b] });
    }
    TriangleSoup { triangles }
}

fn frame() -> impl Strategy<Value = Frame> {
    let vector = || prop::array::uniform3(-1.0..1.0);
    let turned = (vector(), vector(), vector()).prop_filter_map("no frame", |(o, z, x)| Frame::new(o, z, x).ok());
    prop_oneof![4 => turned, 1 => (0..3usize).prop_map(Frame::cyclic)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn lines_are_in_the_material_where_the_world_is(frame in frame()) {
        let (stock, depth) = stock();
        let grid = Grid::new([-7.03, -7.01], [7.0, 7.02], [11, 13]).unwrap().in_frame(frame);
        let dexels = stock.dexels(&grid).unwrap();
        let (mut inside, mut tested) = (0, 0);
        for index in 0..grid.len() {
            let (i, j) = grid.place(index);
            let line = dexels.at(index).to_vec();
            for k in 0..200 {
                let z = -7.0 + 0.07 * f64::from(k) + 1e-3;
                let depth = depth(frame.to_world([grid.x(i), grid.y(j), z]));
                if depth.abs() < 1e-9 {
                    continue;
                }
                tested += 1;
                let found = line.iter().any(|piece| piece.lower.z < z && z < piece.upper.z);
                inside += u32::from(found);
                prop_assert_eq!(found, depth > 0.0, "dexel ({}, {}) at {}", i, j, z);
            }
            // Normals are those of the material: a step along them leads out of it.
            for piece in &line {
                for end in [piece.lower, piece.upper] {
                    let place = |step: f64| {
                        let at = [grid.x(i), grid.y(j), end.z];
                        let to = [0, 1, 2].map(|k| at[k] + step * f64::from(end.normal[k]));
                        depth(frame.to_world(to))
                    };
                    // Beside an edge the step may end on the other face's side.
                    let [out, within] = [place(1e-6), place(-1e-6)];
                    prop_assert!(out < within, "{out} {within}");
                }
            }
        }
        prop_assert!(inside > 300 && tested > 20_000);
    }

    #[test]
    fn surfaces_and_comparisons_are_in_the_world(frame in frame()) {
        let grid = Grid::new([-6.0; 2], [6.0; 2], [120, 120]).unwrap().in_frame(frame);
        let soup = octahedron(3.0);
        let dexels = Stock::Mesh(soup.clone()).dexels(&grid).unwrap();
        let exact = 4.0 / 3.0 * 27.0;
        // The rule of the midpoint on a grid of a tenth, with sharp edges.
        prop_assert!((dexels.volume() - exact).abs() < 0.02 * exact, "{}", dexels.volume());
        let found = compare_with_mesh(&dexels, &soup).unwrap();
        prop_assert_eq!(found.unmatched(), 0);
        // Lines for meshes are 1e-9 of their distance aside; normals are kept to 6.5e-5, and near edges another face is
        // nearest.
        prop_assert!(found.range().unwrap().iter().all(|d| d.abs() < 1e-8), "{:?}", found.range());
        let mesh = dexels.surface().unwrap();
        let volume = mesh.soup().unwrap().volume();
        prop_assert!((volume - exact).abs() < 0.02 * exact, "{volume}");
        // The same as of what is turned the other way, turned back.
        let turned = soup.triangles.iter().map(|corners| corners.map(|p| frame.from_world(p)));
        let turned = Stock::Mesh(TriangleSoup { triangles: turned.collect() });
        let flat = turned.dexels(&grid.in_frame(Frame::WORLD)).unwrap().surface().unwrap();
        prop_assert_eq!(&mesh.triangles, &flat.triangles);
        for (place, own) in mesh.vertices.iter().zip(&flat.vertices) {
            prop_assert_eq!(*place, frame.to_world(*own));
        }
        for (normal, own) in mesh.normals.iter().zip(&flat.normals) {
            let turned = frame.turn_to_world(own.map(f64::from));
            prop_assert!((0..3).all(|k| (f64::from(normal[k]) - turned[k]).abs() < 1e-6));
        }
    }
}
