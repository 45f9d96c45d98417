use sweepsim_dexel::*;
use sweepsim_props::*;

fn solid(stock: &Stock) -> TriDexels {
    TriDexels::new([-10.0; 3], [10.0; 3], [24, 25, 26], stock).unwrap()
}

/// The places of the corners of triangles, in an order of their own.
fn sorted(vertices: &[[f64; 3]], triangles: impl Iterator<Item = [u32; 3]>) -> Vec<[[u64; 3]; 3]> {
    let corners = triangles.map(|own| own.map(|v| vertices[v as usize].map(f64::to_bits)));
    let mut all: Vec<_> = corners.collect();
    all.sort_unstable();
    all
}

fn tools() -> impl Strategy<Value = Vec<(Operation, Stock)>> {
    let at = || [-11.0..11.0_f64, -11.0..11.0_f64, -11.0..11.0_f64];
    let ball = (at(), 0.5..7.0_f64).prop_map(|(centre, radius)| Stock::Ball { centre, radius });
    let block = (at(), [0.5..9.0_f64, 0.5..9.0_f64, 0.5..9.0_f64]).prop_map(|(min, size)| Stock::Block {
        min,
        max: [0, 1, 2].map(|k| min[k] + size[k]),
    });
    let bar = (at(), at(), 0.5..4.0_f64, 1.0..12.0_f64).prop_map(|(base, axis, radius, height)| Stock::Cylinder {
        base,
        axis,
        radius,
        height,
    });
    let operation = prop_oneof![4 => Just(Operation::Difference), 1 => Just(Operation::Union)];
    collection::vec((operation, prop_oneof![ball, block, bar]), 1..8)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// At every moment, the triangles that are there are those of the surface of its state.
    #[test]
    fn at_every_moment_the_surface_is_that_of_the_state(tools in tools()) {
        let block = solid(&Stock::Block { min: [-9.0; 3], max: [9.0, 8.0, 7.0] });
        let mut states = vec![block.clone()];
        let mut changing = ChangingSurface::new(block, 0.8, 0.0).unwrap();
        for (operation, tool) in &tools {
            let mut next = changing.solid().clone();
            next.combine(*operation, &solid(tool)).unwrap();
            if changing.advance(next.clone()).unwrap() {
                states.push(next);
            }
        }
        let mesh = changing.finish();
        prop_assert!(mesh.spans.iter().all(|[from, to]| from < to && *to as usize <= states.len()));
        for (moment, state) in states.iter().enumerate() {
            let surface = state.surface().unwrap();
            let whole = sorted(&surface.vertices, surface.triangles.iter().copied());
            prop_assert!(whole == sorted(&mesh.vertices, mesh.at(moment as u32)), "moment {}", moment);
        }
    }
}

/// A slot cut step by step: its walls are where they belong at every moment, its end as far as it has come, what is
/// made of it is told, and only what is near its end changes.
#[test]
fn walls_of_a_slot_are_straight_half_way() {
    let block = |min: [f64; 3], max: [f64; 3]| solid(&Stock::Block { min, max });
    let mut changing = ChangingSurface::new(block([-9.0, -8.0, -7.0], [9.0, 8.0, 7.0]), 0.8, 1e-6).unwrap();
    let end = |moment: u32| -7.3 + 1.7 * f64::from(moment);
    for moment in 1..=8 {
        let mut next = changing.solid().clone();
        let slot = block([-9.9, -1.234, 2.345], [end(moment), 1.321, 9.9]);
        next.combine(Operation::Difference, &slot).unwrap();
        assert!(changing.advance(next.clone()).unwrap());
        // The tool passes once more.
        let again = block(
            [-9.9, -1.234 - 1e-9, 2.345 - 1e-9],
            [end(moment) + 1e-9, 1.321 + 1e-9, 9.9],
        );
        next.combine(Operation::Difference, &again).unwrap();
        assert!(next != *changing.solid() && !changing.advance(next).unwrap());
    }
    let mesh = changing.finish();
    for moment in 0..=8 {
        let mut walls = 0;
        for corners in mesh.at(moment) {
            let places = corners.map(|v| mesh.vertices[v as usize]);
            let normals = corners.map(|v| mesh.normals[v as usize]);
            // Inside of the block: walls, floor, or the slot's end.
            let middle = [0, 1, 2].map(|k| places.iter().map(|p| p[k]).sum::<f64>() / 3.0);
            if normals[0][1].abs() < 0.9 || middle[1].abs() > 7.0 {
                continue;
            }
            walls += 1;
            assert!(middle[0] < end(moment));
            let wall = if middle[1] < 0.0 { -1.234 } else { 1.321 };
            assert!(places.iter().all(|p| (p[1] - wall).abs() < 1e-8), "{places:?}");
        }
        assert_eq!(walls > 0, moment > 0, "{walls} triangles of walls at {moment}");
    }
    for (moment, volume) in mesh.volumes().into_iter().enumerate() {
        let long = (end(moment as u32) + 9.0).max(0.0) * f64::from(u8::from(moment > 0));
        let exact = 18.0 * 16.0 * 14.0 - long * (1.321 + 1.234) * (7.0 - 2.345);
        assert!((volume - exact).abs() < 1e-6, "{volume} and not {exact} at {moment}");
    }
    // Each step makes about as many.
    let whole = mesh.at(8).count();
    assert!(
        mesh.triangles.len() < whole + whole / 2,
        "{} of {whole}",
        mesh.triangles.len()
    );
    let made = |moment: u32| mesh.made.iter().filter(|own| **own == moment).count();
    assert!(made(0) > 1000 && (1..=8).all(|moment| made(moment) > 20));
}

/// Where all material goes, so does the surface; in another box, all of it is another.
#[test]
fn all_of_a_surface_may_go() {
    let block = solid(&Stock::Block {
        min: [-9.0; 3],
        max: [9.0; 3],
    });
    let empty = TriDexels::empty(block.min(), block.max(), block.cells()).unwrap();
    let other = TriDexels::new(
        [-3.0; 3],
        [3.0; 3],
        [5; 3],
        &Stock::Ball {
            centre: [0.0; 3],
            radius: 2.0,
        },
    )
    .unwrap();
    let surface = other.surface().unwrap();
    let mut changing = ChangingSurface::new(block, 0.8, 0.0).unwrap();
    for next in [empty.clone(), other, empty] {
        assert!(changing.advance(next).unwrap());
    }
    let mesh = changing.finish();
    let counts = [0, 1, 2, 3].map(|moment| mesh.at(moment).count());
    assert!(counts[0] > 1000 && counts[1] == 0 && counts[3] == 0, "{counts:?}");
    let whole = sorted(&surface.vertices, surface.triangles.iter().copied());
    assert!(whole == sorted(&mesh.vertices, mesh.at(2)));
    assert_eq!(mesh.volumes().len(), 3);
}
