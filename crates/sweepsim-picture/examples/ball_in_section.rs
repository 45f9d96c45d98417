//! A ball with a slot, cut open, as `ball.png`.
//!
//! `cargo run --release -p sweepsim-picture --example ball_in_section [FILE.png]`

use std::fs::File;
use std::io::BufWriter;
use sweepsim_dexel::{Grid, Stock};
use sweepsim_picture::{Axis, CuttingPlane, Drawing, View};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).unwrap_or_else(|| "ball.png".to_owned());
    let ball = Stock::Ball {
        centre: [0.0; 3],
        radius: 20.0,
    };
    let slot = Stock::Block {
        min: [-6.0, -30.0, 5.0],
        max: [6.0, 30.0, 30.0],
    };
    let part = Stock::Difference(ball.into(), vec![slot]);
    let grid = Grid::new([-21.0, -21.0], [21.0, 21.0], [210, 210])?;
    let mesh = part.dexels(&grid)?.surface()?;

    let mut view = View::default();
    view.size = [800, 600];
    let sections = [CuttingPlane {
        axis: Axis::Y,
        at: -4.0,
    }];
    let image = view.draw(&Drawing::new(&mesh).sections(&sections));
    image.write_png(BufWriter::new(File::create(&file)?))?;
    println!("{file}: {} triangles", mesh.triangles.len());
    Ok(())
}
