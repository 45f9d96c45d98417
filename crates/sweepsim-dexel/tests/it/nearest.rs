use sweepsim_dexel::*;

#[test]
fn the_nearest_end_is_that_of_all_ends() {
    let frame = Frame::new([1.0, -2.0, 0.5], [0.3, 0.2, 1.0], [1.0, 0.1, 0.0]).unwrap();
    for grid in [
        Grid::new([-3.0, -2.0], [3.0, 2.0], [11, 23]).unwrap(),
        Grid::new([-3.0, -2.0], [3.0, 2.0], [25, 9]).unwrap().in_frame(frame),
    ] {
        let ball = Stock::Ball {
            centre: [0.2, 0.1, 0.3],
            radius: 1.5,
        };
        let dexels = ball.dexels(&grid).unwrap();
        for k in 0..200 {
            let at = |a: f64| (f64::from(k) * a).sin() * 4.0;
            let point = [at(1.3), at(2.7), at(3.1)];
            let local = grid.frame().from_world(point);
            let least = dexels
                .iter()
                .flat_map(|(line, intervals)| {
                    let (i, j) = grid.place(line);
                    let flat = (grid.x(i) - local[0]).hypot(grid.y(j) - local[1]);
                    intervals
                        .heights()
                        .flatten()
                        .map(move |z| flat.hypot(z - local[2]))
                        .collect::<Vec<_>>()
                })
                .fold(f64::INFINITY, f64::min);
            assert_eq!(dexels.nearest_end(point).unwrap().distance, least, "{point:?}");
        }
    }
}

#[test]
fn the_cut_that_made_a_point_is_known() {
    let grid = Grid::new([0.0; 2], [10.0; 2], [10, 10]).unwrap();
    let block = Stock::Block {
        min: [0.0; 3],
        max: [10.0, 10.0, 5.0],
    };
    let mut dexels = block.dexels(&grid).unwrap();
    for j in 0..10 {
        let mut groove = Interval::between(3.0, 9.0);
        let source = |t| Source::Cut { path: 1, segment: j, t };
        (groove.lower.source, groove.upper.source) = (source(0.25), source(0.75));
        dexels.subtract(4 * 10 + j as usize, &[groove]).unwrap();
    }
    let found = |point: [f64; 3]| dexels.source_at(point, 0.5);
    assert_eq!(
        found([4.5, 6.4, 3.1]),
        Some(Source::Cut {
            path: 1,
            segment: 6,
            t: 0.25
        })
    );
    assert_eq!(found([7.5, 6.4, 5.1]), Some(Source::Stock));
    assert_eq!(found([7.5, 6.4, 2.5]), None);
    assert_eq!(found([f64::NAN; 3]), None);
    assert_eq!(Dexels::empty(grid).nearest_end([0.0; 3]), None);
}
