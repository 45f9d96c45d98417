//! The section of a sweep by a plane, as an SVG drawing: `cargo run -p sweepsim --example section_by_a_plane >
//! section.svg`.

use sweepsim::prelude::*;
use sweepsim::section;
use sweepsim::systems::Plane;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let tool = Tool::bull(5.0, 1.5, 30.0)?;
    let path = Path::new(vec![
        Pose::new([-20.0, -8.0, 4.0], [0.5, 0.1, 1.0])?,
        Pose::new([0.0, 6.0, 0.0], [0.0, -0.4, 1.0])?,
        Pose::new([20.0, -4.0, 3.0], [-0.4, 0.0, 1.0])?,
    ])?;
    let cut = Cut::new(&tool, &path);
    // Any direction will do: this plane leans.
    let plane = Plane::new([0.2, 1.0, 0.0], 1.0)?;
    let section = section(&[cut], &plane, 0.01, &Options::new(1e-6), &())?;
    print!("{}", section.svg());
    let loops = section.loops();
    eprintln!("{} curves, {} closed loops", section.curves.len(), loops.closed.len());
    Ok(())
}
