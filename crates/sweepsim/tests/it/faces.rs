//! Faces that a tool slides along without cutting.

use sweepsim::prelude::*;
use sweepsim::{Cut, Options, simulate};
use sweepsim_dexel::Source;

/// A flat end on the top of a block, then a groove: only the groove is the tool's.
#[test]
fn a_tool_that_slides_along_a_face_leaves_it_to_the_stock() {
    let grid = Grid::new([0.0, 0.0], [20.0, 12.0], [40, 24]).unwrap();
    let top = 7.3;
    let stock = Stock::Block {
        min: [0.0; 3],
        max: [20.0, 12.0, top],
    };
    let tool = Tool::flat(2.0, 30.0).unwrap();
    let up = [0.0, 0.0, 1.0];
    let pose = |x: f64, y: f64, z: f64| Pose::new([x, y, z], up).unwrap();
    let along = Path::new(vec![
        pose(-3.0, 3.1, top),
        pose(23.0, 3.1, top),
        pose(23.0, 9.2, top),
        pose(-3.0, 9.2, top),
    ]);
    let groove = Path::new(vec![pose(-3.0, 6.0, top - 0.01), pose(23.0, 6.0, top - 0.01)]);
    let (along, groove) = (along.unwrap(), groove.unwrap());
    let options = Options::default();
    let cut = |paths: &[&Path]| {
        let cuts: Vec<Cut> = paths.iter().map(|path| Cut::new(&tool, path)).collect();
        simulate(stock.dexels(&grid).unwrap(), &cuts, &options, &())
            .unwrap()
            .remaining
    };
    for (paths, grooved) in [
        (vec![&along], false),
        (vec![&along, &groove], true),
        (vec![&groove, &along], true),
    ] {
        let part = cut(&paths);
        for (index, line) in part.iter() {
            let (_, j) = grid.place(index);
            let inside = grooved && (grid.y(j) - 6.0).abs() < 2.0;
            for piece in line {
                assert_eq!(piece.upper.source != Source::Stock, inside, "{j}");
                let height = if inside { top - 0.01 } else { top };
                assert!((piece.upper.z - height).abs() <= options.tolerance);
            }
        }
    }
}
