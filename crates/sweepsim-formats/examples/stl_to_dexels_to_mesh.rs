//! Converts an STL, or the small one below, to dexels and back to a mesh.
//!
//! `cargo run --release -p sweepsim-formats --example stl_to_dexels_to_mesh [-- IN.stl OUT.ply [DISTANCE]]`

use std::path::Path;
use sweepsim_dexel::{Grid, Stock, compare};
use sweepsim_formats::{parse_stl, read_stl, write_atomically, write_ply};

/// A tetrahedron.
const STL: &str = "solid
facet normal 0 0 -1
outer loop
vertex 0 0 0
vertex 0 30 0
vertex 30 0 0
endloop
endfacet
facet normal 0 -1 0
outer loop
vertex 0 0 0
vertex 30 0 0
vertex 0 0 30
endloop
endfacet
facet normal -1 0 0
outer loop
vertex 0 0 0
vertex 0 0 30
vertex 0 30 0
endloop
endfacet
facet normal 1 1 1
outer loop
vertex 30 0 0
vertex 0 30 0
vertex 0 0 30
endloop
endfacet
endsolid";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (soup, output, rest) = match arguments.as_slice() {
        [] => (parse_stl(STL.as_bytes())?, "tetrahedron.ply", &[][..]),
        [input, output, rest @ ..] => (read_stl(Path::new(input))?, output.as_str(), rest),
        _ => return Err("expected IN.stl OUT.ply [DISTANCE]".into()),
    };
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
    // Whole cells, with a margin of one.
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
    // How far is it from the original? Compare their dexels.
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
