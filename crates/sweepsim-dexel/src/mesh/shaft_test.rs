use super::*;

/// A shaft of so many sides, 25 times as long as it is thick, in any direction: two triangles a side along it, and
/// two fans.
fn shaft(sides: usize, [u, v, w]: [[f64; 3]; 3]) -> TriangleSoup {
    let place = |x: f64, y: f64, z: f64| [0, 1, 2].map(|k| x * u[k] + y * v[k] + z * w[k]);
    let corner = |side: usize, x: f64| {
        let (sin, cos) = (std::f64::consts::TAU * (side % sides) as f64 / sides as f64).sin_cos();
        place(x, 10.0 * cos, 10.0 * sin)
    };
    let strip = |k: usize| {
        let [a, b, c, d] = [(k, 0.0), (k + 1, 0.0), (k + 1, 500.0), (k, 500.0)].map(|(side, x)| corner(side, x));
        let [from, to] = [0.0, 500.0].map(|x| place(x, 0.0, 0.0));
        [[a, b, c], [a, c, d], [from, b, a], [to, d, c]]
    };
    TriangleSoup {
        triangles: (0..sides).flat_map(strip).collect(),
    }
}

/// The boxes of long and narrow triangles that lie aslant all hold each other, and those along an axis have all one
/// place there.
#[test]
fn a_shaft_takes_few_triangles_a_point() {
    let third = 1.0 / 3.0;
    let aslant = [
        [2.0 * third, 2.0 * third, third],
        [-2.0 * third, third, 2.0 * third],
        [third, -2.0 * third, 2.0 * third],
    ];
    let along_x = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let looks = |axes: [[f64; 3]; 3]| {
        let soup = shaft(500, axes);
        let tree = DistanceTo::new(&soup).unwrap();
        let looked = std::cell::Cell::new(0);
        for n in 0..400 {
            let (x, angle, r) = (
                1.25 * f64::from(n),
                2.4 * f64::from(n),
                [7.0, 9.9, 10.1, 12.0][n as usize % 4],
            );
            let q = [x, r * angle.cos(), r * angle.sin()];
            let p = [0, 1, 2].map(|k| (0..3).map(|i| q[i] * axes[i][k]).sum());
            let count = |_: &Face| {
                looked.set(looked.get() + 1);
                true
            };
            let (_, place, _) = tree.closest(p, (f64::INFINITY, count), &mut SmallVec::new()).unwrap();
            let square = |t: &[[f64; 3]; 3]| {
                let off = sub(p, nearest_on(p, *t).0);
                dot(off, off)
            };
            let slow = soup.triangles.iter().map(square).fold(f64::INFINITY, f64::min).sqrt();
            let off = sub(p, place);
            assert!((dot(off, off).sqrt() - slow).abs() < 1e-12, "{p:?}");
        }
        looked.get()
    };
    let most = [aslant, along_x].map(looks);
    assert!(most.iter().all(|looked| *looked < 400 * 100), "{most:?}");
}
