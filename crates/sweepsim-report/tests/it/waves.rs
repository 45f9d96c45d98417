//! A page of any size.

use sweepsim_report::{Area, DexelLayer, LayerEnd, Page, Scene};

/// A milled surface of `side` by `side` dexels: waves with a scallop from each pass of a ball end.
pub fn page(side: usize) -> Page {
    let area = Area {
        min: [0.0; 2],
        max: [200.0; 2],
        cells: [side; 2],
    };
    let spacing = 200.0 / side as f64;
    let part = DexelLayer::new(area, |i, j, line| {
        let (x, y) = (i as f64 * spacing, j as f64 * spacing);
        let pass = (y / 0.7).floor();
        let off = y - (pass + 0.5) * 0.7;
        let z = 30.0 + 8.0 * (x * 0.05).sin() * (y * 0.04).cos() + 5.0 - (25.0 - off * off).sqrt();
        let (sx, sy) = (
            0.4 * (x * 0.05).cos() * (y * 0.04).cos(),
            -0.32 * (x * 0.05).sin() * (y * 0.04).sin() + off / 5.0,
        );
        let size = (1.0 + sx * sx + sy * sy).sqrt();
        let top = LayerEnd {
            z,
            normal: [-sx / size, -sy / size, 1.0 / size].map(|c| c as f32),
            deviation: (off * off / 10.0) as f32,
            maker: 1 + (pass as u32) * 200 + (x / spacing / 5.0) as u32,
        };
        line.push([LayerEnd::at(0.0, [0.0, 0.0, -1.0]), top]);
    });
    let mut page = Page::new("waves");
    let mut scene = Scene::new(part);
    scene.limits = Some([0.02, 0.02]);
    scene.paths = vec![(58_000, 0)];
    page.scene = Some(scene);
    page
}
