//! Meshes of real parts and their dexels, at rising resolution.

use super::folder;
use sweepsim_dexel::{Grid, Stock, TriangleSoup, compare_with_mesh};
use sweepsim_formats::read_stl;

const FILES: [&str; 4] = [
    "Sacrifice-Board.STL",
    "shimemcunha.STL",
    "Dem-target2.STL",
    "SupPetriLED.STL",
];

fn area(soup: &TriangleSoup) -> f64 {
    let of = |[a, b, c]: &[[f64; 3]; 3]| {
        let (u, v) = ([0, 1, 2].map(|k| b[k] - a[k]), [0, 1, 2].map(|k| c[k] - a[k]));
        let n = [0, 1, 2].map(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
        0.5 * n.iter().map(|c| c * c).sum::<f64>().sqrt()
    };
    soup.triangles.iter().map(of).sum()
}

/// The lines of a grid are the midpoint rule. It errs in cells that a wall crosses, each by at most its area times the
/// wall's height there: in all by the area of the surface times the diagonal of a cell.
#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn volumes_of_dexels_become_those_of_the_mesh() {
    let folder = folder().join("3axis/solidworks_apt");
    for name in FILES {
        let soup = read_stl(&folder.join(name)).unwrap_or_else(|error| panic!("{}", error.render(false)));
        if let Err(error) = soup.check_closed() {
            // Said, and refused as stock.
            let grid = Grid::new([0.0; 2], [1.0; 2], [2, 2]).unwrap();
            assert!(Stock::Mesh(soup).dexels(&grid).is_err());
            println!("{name}: {error}");
            continue;
        }
        let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in soup.triangles.iter().flatten() {
            for k in 0..3 {
                (min[k], max[k]) = (min[k].min(p[k]), max[k].max(p[k]));
            }
        }
        let (exact, area) = (soup.volume(), area(&soup));
        let mut errors = Vec::new();
        for cells in [50, 100, 200, 400, 800] {
            let step = (max[0] - min[0]).max(max[1] - min[1]) / f64::from(cells);
            // A fraction of a cell beside the part, so that no wall of it is on a line or between two.
            let corner = [min[0] - 0.37 * step, min[1] - 0.61 * step];
            let count = [0, 1].map(|k| ((max[k] - corner[k]) / step).ceil() as usize + 1);
            let far = [0, 1].map(|k| corner[k] + count[k] as f64 * step);
            let grid = Grid::new(corner, far, count).unwrap();
            let dexels = Stock::Mesh(soup.clone()).dexels(&grid).unwrap();
            let error = (dexels.volume() - exact).abs();
            assert!(error < area * step * 2.0_f64.sqrt(), "{name} {cells}: {error}");
            errors.push(error / exact);
            if cells == 100 {
                // Its ends are on the mesh, as exactly as numbers are.
                let found = compare_with_mesh(&dexels, &soup).unwrap();
                let size = max.iter().chain(&min).fold(0.0_f64, |a, c| a.max(c.abs()));
                let [low, high] = found.range().unwrap();
                assert!(low > -1e-9 * size && high < 1e-9 * size, "{name}: {low} {high}");
                assert_eq!(found.unmatched(), 0);
            }
        }
        let words: Vec<String> = errors.iter().map(|error| format!("{error:.1e}")).collect();
        println!("{name}: volume {exact:.1}, relative errors {}", words.join(" "));
        assert!(errors[4] < 2e-3 && errors[4] < 0.5 * errors[0], "{name}: {errors:?}");
    }
}
