//! Draws a relief of waves and writes it as a PNG file:
//! `cargo run --release -p sweepsim-picture --example relief -- relief.png`.

use std::time::Instant;
use sweepsim_picture::{Mesh, View};

/// Points across the relief.
const POINTS: usize = 400;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "relief.png".to_owned());
    let mesh = relief();
    let start = Instant::now();
    let png = View::default().render(&mesh).png()?;
    println!(
        "{} triangles: {:.2} s, {} bytes",
        mesh.triangles.len(),
        start.elapsed().as_secs_f64(),
        png.len()
    );
    std::fs::write(path, png)?;
    Ok(())
}

/// Waves above a flat base, closed at the sides.
fn relief() -> Mesh {
    let mut mesh = Mesh::default();
    let place = |i: usize| 100.0 * i as f64 / (POINTS - 1) as f64;
    for top in [true, false] {
        for k in 0..POINTS * POINTS {
            let (x, y) = (place(k % POINTS), place(k / POINTS));
            let wave = 6.0 * (0.2 * x).sin() * (0.15 * y + 0.03 * x).cos();
            mesh.vertices.push([x, y, if top { 20.0 + wave } else { 0.0 }]);
            mesh.cut.push(top);
        }
    }
    let number = |i: usize, j: usize, top: bool| ((usize::from(!top) * POINTS + j) * POINTS + i) as u32;
    let last = POINTS - 1;
    for i in 1..POINTS {
        for j in 1..POINTS {
            let corners = |top| [(i - 1, j - 1), (i, j - 1), (i, j), (i - 1, j)].map(|(i, j)| number(i, j, top));
            let ([a, b, c, d], [e, f, g, h]) = (corners(true), corners(false));
            mesh.triangles.extend([[a, b, c], [a, c, d], [e, h, g], [e, g, f]]);
        }
        // The four sides, counter-clockwise seen from outside, with vertices of their own.
        let back = last - i;
        for [(i, j), (k, l)] in [
            [(i - 1, 0), (i, 0)],
            [(last, i - 1), (last, i)],
            [(back + 1, last), (back, last)],
            [(0, back + 1), (0, back)],
        ] {
            let corners = [(i, j, false), (k, l, false), (k, l, true), (i, j, true)];
            let first = mesh.vertices.len() as u32;
            for (i, j, top) in corners {
                let place = mesh.vertices[number(i, j, top) as usize];
                mesh.vertices.push(place);
                mesh.cut.push(false);
            }
            mesh.triangles
                .extend([[0, 1, 2], [0, 2, 3]].map(|t| t.map(|k| first + k)));
        }
    }
    mesh
}
