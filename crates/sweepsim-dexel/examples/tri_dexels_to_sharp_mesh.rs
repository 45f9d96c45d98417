//! Tri-dexels to a sharp mesh: a bored and slotted block, as an OBJ file.
//!
//! `cargo run --release --example tri_dexels_to_sharp_mesh -- OUT.obj`

use std::io::Write;
use sweepsim_dexel::{Stock, TriDexels};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let block = Stock::Block {
        min: [-10.0, -6.0, 0.0],
        max: [10.0, 6.0, 8.0],
    };
    let bore = Stock::Cylinder {
        base: [-5.0, 0.0, -1.0],
        axis: [0.0, 0.0, 1.0],
        radius: 3.0,
        height: 20.0,
    };
    let slot = Stock::Block {
        min: [2.0, -7.0, 5.0],
        max: [7.0, 7.0, 9.0],
    };
    let dimple = Stock::Ball {
        centre: [4.5, 0.0, 5.5],
        radius: 3.0,
    };
    let part = Stock::Difference(Box::new(block), vec![bore, slot, dimple]);
    let solid = TriDexels::new([-11.0, -7.0, -1.0], [11.0, 7.0, 9.0], [110, 70, 50], &part)?;
    println!(
        "volume {:.3}, lines disagree in {} points",
        solid.volume(),
        solid.disagreements()
    );

    let mesh = solid.surface()?;
    println!("{} vertices, {} triangles", mesh.vertices.len(), mesh.triangles.len());
    // How many of the vertices are on the upper rim of the bore?
    let on_rim = |v: &&[f64; 3]| ((v[0] + 5.0).hypot(v[1]) - 3.0).abs() < 1e-3 && (v[2] - 8.0).abs() < 1e-9;
    println!(
        "{} of them on the upper rim of the bore",
        mesh.vertices.iter().filter(on_rim).count()
    );

    let Some(path) = std::env::args().nth(1) else {
        return Ok(());
    };
    // For a picture every vertex gets the normal of its face: those on edges become several.
    let mesh = mesh.crisp(0.8)?;
    let mut file = std::io::BufWriter::new(std::fs::File::create(path)?);
    for v in &mesh.vertices {
        writeln!(file, "v {} {} {}", v[0], v[1], v[2])?;
    }
    for n in &mesh.normals {
        writeln!(file, "vn {} {} {}", n[0], n[1], n[2])?;
    }
    for t in mesh.triangles.iter().map(|t| t.map(|v| v + 1)) {
        writeln!(file, "f {0}//{0} {1}//{1} {2}//{2}", t[0], t[1], t[2])?;
    }
    Ok(())
}
