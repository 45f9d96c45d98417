//! CSG of intervals: a plate with a slot and two bores, seen through one line and then as dexels.
//!
//! `cargo run --example csg_of_intervals`

use sweepsim_dexel::{Dexels, Grid, IntervalSet, Stock};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Sets on one line, of plain heights. Ends cost eight bytes.
    let plate = IntervalSet::try_from([[0.0, 10.0]])?;
    let slot = IntervalSet::try_from([[7.0, 12.0]])?;
    let bores = IntervalSet::try_from([[2.0, 4.0], [4.0 + 1e-9, 5.0]])?;
    let rest = plate.difference(&slot).difference(&bores);
    println!("exactly: {:?}", rest.pieces());
    // A film of a nanometre is left between the bores. Merging takes it out, and no wall that is thicker.
    println!("merged:  {:?}", rest.merged(1e-6).pieces());

    // The same on a whole grid.
    let grid = Grid::new([0.0, 0.0], [24.0, 12.0], [48, 12])?;
    let block = |min, max| Stock::Block { min, max };
    let bore = |x| Stock::Cylinder {
        base: [x, -1.0, 3.5],
        axis: [0.0, 1.0, 0.0],
        radius: 1.5,
        height: 14.0,
    };
    let part = Stock::Difference(
        Box::new(block([0.0; 3], [24.0, 12.0, 10.0])),
        vec![block([9.0, -1.0, 7.0], [15.0, 13.0, 12.0]), bore(5.0), bore(19.0)],
    );
    let part = part.dexels(&grid)?;
    println!(
        "\nvolume {:.1}, {} intervals in {} bytes\n",
        part.volume(),
        part.count(),
        part.bytes()
    );
    print(&part, 6);
    Ok(())
}

/// A row of dexels, from the side.
fn print(part: &Dexels, row: usize) {
    for level in (0..10).rev() {
        let z = f64::from(level) + 0.5;
        let solid = |i: usize| {
            part.intervals(i, row)
                .heights()
                .any(|[lower, upper]| lower < z && z < upper)
        };
        let line: String = (0..part.grid().cells()[0])
            .map(|i| if solid(i) { '#' } else { '.' })
            .collect();
        println!("{line}");
    }
}
