use sweepsim_dexel::internals::{Step, steps};
use sweepsim_dexel::*;

fn of(stock: &Stock) -> Vec<Step> {
    let grid = Grid::new([-10.0; 2], [10.0; 2], [40, 40]).unwrap();
    steps(&stock.dexels(&grid).unwrap())
}

#[test]
fn walls_are_steps_and_floors_are_not() {
    let block = |min: [f64; 3], max: [f64; 3]| Stock::Block { min, max };
    let found = of(&block([-5.1, -5.1, 0.0], [5.1, 5.1, 4.0]));
    // Around 20 × 20 lines.
    assert_eq!(found.len(), 80);
    assert!(
        found
            .iter()
            .all(|step| step.heights == [0.0, 4.0] && step.beyond == 0.0)
    );
    // A step that is lower than what would pass for a bend.
    let low = Stock::Union(vec![
        block([-5.1, -5.1, 0.0], [5.1, 5.1, 4.0]),
        block([-5.1, -5.1, 0.0], [0.0, 5.1, 4.04]),
    ]);
    let found = of(&low);
    let within = found.iter().filter(|step| step.heights == [4.0, 4.04]).count();
    assert_eq!(within, 20);
}

#[test]
fn a_ball_is_known_where_it_is_flat() {
    let ball = Stock::Ball {
        centre: [0.0; 3],
        radius: 8.0,
    };
    let found = of(&ball);
    assert!(!found.is_empty());
    for step in found {
        let out = |p: [f64; 2]| p[0].hypot(p[1]);
        assert!(out(step.lines[0]).max(out(step.lines[1])) > 7.0, "{step:?}");
    }
}
