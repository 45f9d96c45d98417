//! Pages of many triangles: waves with a scallop from each pass of a ball end.

use std::path::Path;
use sweepsim_dexel::Mesh;
use sweepsim_report::{Area, DexelLayer, Page, Scene, Surface};

/// The most triangles that a page shows, as `verify` makes it.
const MOST: usize = 300_000;
/// The side of the part, and the width of a pass.
const SIDE: f64 = 200.0;
const PASS: f64 = 4.0;

/// Writes a page of 300,000 triangles, and one of 700,000 that are shown by as many.
pub fn write(folder: &Path) -> Result<(), String> {
    for (name, squares) in [("300k.html", 387), ("700k.html", 592)] {
        let html = page(squares).html();
        let file = folder.join(name);
        std::fs::write(&file, html).map_err(|error| format!("{}: {error}", file.display()))?;
    }
    Ok(())
}

fn height(x: f64, y: f64) -> f64 {
    let off = y - ((y / PASS).floor() + 0.5) * PASS;
    35.0 + 8.0 * (x * 0.05).sin() * (y * 0.04).cos() - (25.0 - off * off).sqrt()
}

/// A page of two triangles a square.
fn page(squares: usize) -> Page {
    let at = |n: usize| SIDE * n as f64 / squares as f64;
    let mut mesh = Mesh::default();
    for i in 0..=squares {
        for j in 0..=squares {
            let (x, y) = (at(i), at(j));
            let slope = |dx: f64, dy: f64| (height(x + dx, y + dy) - height(x - dx, y - dy)) / 2e-3;
            let [a, b] = [slope(1e-3, 0.0), slope(0.0, 1e-3)];
            let size = (1.0 + a * a + b * b).sqrt();
            mesh.vertices.push([x, y, height(x, y)]);
            mesh.normals.push([-a / size, -b / size, 1.0 / size].map(|c| c as f32));
            mesh.cut.push(true);
        }
    }
    for i in 0..squares {
        for j in 0..squares {
            let [a, b] = [i, i + 1].map(|i| (i * (squares + 1) + j) as u32);
            mesh.triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
        }
    }
    let shown = mesh.clustered(MOST);
    let deviation = |p: &[f64; 3]| (0.06 * (p[0] * 0.1).sin()) as f32;
    let maker = |t: &[u32; 3]| 1 + (shown.mesh.vertices[t[0] as usize][1] / PASS) as u32;
    let surface = Surface {
        deviations: shown.mesh.vertices.iter().map(deviation).collect(),
        makers: shown.mesh.triangles.iter().map(maker).collect(),
        whole: mesh.triangles.len(),
        farthest: shown.farthest(&mesh).unwrap_or(shown.within),
        vertices: shown.mesh.vertices.clone(),
        normals: shown.mesh.normals.clone(),
        triangles: shown.mesh.triangles.clone(),
    };
    let area = Area {
        min: [0.0; 2],
        max: [SIDE; 2],
        cells: [1; 2],
    };
    let mut scene = Scene::new(DexelLayer::new(area, |_, _, _| {}));
    scene.surface = Some(surface);
    scene.limits = Some([0.02, 0.02]);
    scene.paths = vec![(51, 0)];
    let mut page = Page::new("waves");
    page.scene = Some(scene);
    page
}
