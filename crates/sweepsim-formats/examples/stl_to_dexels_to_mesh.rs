//! An STL to dexels to a mesh.
//!
//! `cargo run --release --example stl_to_dexels_to_mesh -- IN.stl OUT.ply [DISTANCE]`

use std::path::Path;
use sweepsim_dexel::{Grid, Stock, compare};
use sweepsim_formats::{read_stl, write_atomically, write_ply};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [input, output, rest @ ..] = arguments.as_slice() else {
        return Err("expected IN.stl OUT.ply [DISTANCE]".into());
    };
    let soup = read_stl(Path::new(input))?;
    let [mut min, mut max] = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for corner in soup.triangles.iter().flatten() {
        for k in 0..3 {
            min[k] = min[k].min(corner[k]);
            max[k] = max[k].max(corner[k]);
        }
    }
    let size = (max[0] - min[0]).max(max[1] - min[1]);
    let distance = match rest.first() {
        Some(text) => text.parse::<f64>()?,
        None => size / 200.0,
    };
    // Whole cells, with one more around.
    let cells = [0, 1].map(|k| ((max[k] - min[k]) / distance).ceil() as usize + 2);
    let corner = [0, 1].map(|k| min[k] - distance);
    let grid = Grid::new(corner, [0, 1].map(|k| corner[k] + cells[k] as f64 * distance), cells)?;

    let dexels = Stock::Mesh(soup).dexels(&grid)?;
    println!(
        "{} intervals on {} x {} dexels, {} bytes",
        dexels.count(),
        cells[0],
        cells[1],
        dexels.bytes()
    );
    println!("volume {:.6}", dexels.volume());
    let mesh = dexels.surface()?;
    println!("{} triangles", mesh.triangles.len());
    // How good is it? Its dexels tell.
    let triangles = mesh
        .triangles
        .iter()
        .map(|t| t.map(|v| mesh.vertices[v as usize]))
        .collect();
    let again = Stock::Mesh(sweepsim_dexel::TriangleSoup { triangles }).dexels(&grid)?;
    let found = compare(&again, &dexels, 2.0 * distance)?;
    println!(
        "off by {:.2e} (RMS), {:.2e} mm³ too much, {:.2e} too little",
        found.rms(),
        found.excess,
        found.missing
    );
    write_atomically(Path::new(output), |file| write_ply(&mesh, file))?;
    Ok(())
}
