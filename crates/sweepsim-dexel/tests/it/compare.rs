use sweepsim_dexel::*;

fn grid(cells: usize) -> Grid {
    Grid::new([-10.0, -10.0], [10.0, 10.0], [cells, cells]).unwrap()
}

fn cylinder(radius: f64) -> Stock {
    let (base, axis) = ([-8.0, -2.0, 0.0], [8.0, 3.0, 1.0]);
    let height = 15.0;
    Stock::Cylinder {
        base,
        axis,
        radius,
        height,
    }
}

#[test]
fn grown_cylinders_are_off_by_what_they_grew() {
    let [small, large] = [5.0, 5.1].map(|r| cylinder(r).dexels(&grid(200)).unwrap());
    let found = compare(&large, &small, 1.0).unwrap();
    let sides: Vec<&Deviation> = found.deviations.iter().filter(|d| d.area < 0.02).collect();
    assert!(sides.len() > 10_000);
    for d in sides {
        // Ends are at most half a cell's diagonal apart, on a radius of 5, or on the rim, where it is a disk that
        // is nearest.
        let distance = d.distance.unwrap();
        assert!((0.09..0.11).contains(&distance) || distance.abs() < 1e-4, "{d:?}");
    }
    let area = std::f64::consts::TAU * 5.1 * 15.0 + std::f64::consts::TAU * 5.1 * 5.1;
    assert!((found.area() - area).abs() < 0.05 * area, "{} {area}", found.area());
    assert!(found.missing < 1e-9 && (found.excess - (found.volume - found.target)).abs() < 1e-6);
    let sum: f64 = found.histogram(&[0.0, 0.05, 0.2]).iter().sum();
    assert!((sum - found.area()).abs() < 1e-6 * sum);
    // Seen from the other side.
    let back = compare(&small, &large, 1.0).unwrap();
    assert!((back.missing - found.excess).abs() < 1e-9 && (back.mean() + found.mean()).abs() < 0.01);
    assert!(back.rms() >= back.mean().abs());
}

#[test]
fn what_is_far_away_is_not_compared() {
    let block = |lower, upper| {
        Stock::Block {
            min: [-5.0, -5.0, lower],
            max: [5.0, 5.0, upper],
        }
        .dexels(&grid(20))
        .unwrap()
    };
    let found = compare(&block(0.0, 1.0), &block(0.5, 8.0), 2.0).unwrap();
    assert_eq!((found.unmatched(), found.range()), (100, Some([0.5, 0.5])));
    assert_eq!((found.excess, found.missing), (50.0, 700.0));
    let nothing = compare(&Dexels::empty(grid(20)), &block(0.0, 1.0), 2.0).unwrap();
    assert_eq!((nothing.range(), nothing.mean(), nothing.missing), (None, 0.0, 100.0));
    assert_eq!(
        compare(&Dexels::empty(grid(2)), &Dexels::empty(grid(3)), 1.0),
        Err(GridMismatch)
    );
}
