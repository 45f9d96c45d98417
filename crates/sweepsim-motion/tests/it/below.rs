//! Tools cut off at a height.

use sweepsim_motion::{Patch, Tool};
use sweepsim_spline::Bernstein;

fn face(corners: [[f64; 3]; 4]) -> Patch {
    let form = |k: usize| Bernstein::new(&[1, 1], corners.iter().map(|p| p[k]).collect()).expect("a form");
    let one = Bernstein::new(&[1, 1], vec![1.0; 4]).expect("a form");
    Patch::new([form(0), form(1), form(2)], one).expect("a patch")
}

/// A prism of a height over unit squares with these lower corners.
pub fn prism(squares: &[[i32; 2]], height: f64) -> Tool {
    let mut faces = Vec::new();
    for [i, j] in squares {
        let at = |x: i32, y: i32, z: f64| [f64::from(i + x), f64::from(j + y), z];
        faces.push(face([at(0, 0, 0.0), at(0, 1, 0.0), at(1, 0, 0.0), at(1, 1, 0.0)]));
        faces.push(face([
            at(0, 0, height),
            at(1, 0, height),
            at(0, 1, height),
            at(1, 1, height),
        ]));
        let corners = [[0, 0], [1, 0], [1, 1], [0, 1]];
        for (k, beside) in [[0, -1], [1, 0], [0, 1], [-1, 0]].into_iter().enumerate() {
            if !squares.contains(&[i + beside[0], j + beside[1]]) {
                let ([a, b], [c, d]) = (corners[k], corners[(k + 1) % 4]);
                faces.push(face([at(a, b, 0.0), at(c, d, 0.0), at(a, b, height), at(c, d, height)]));
            }
        }
    }
    Tool::from_patches(faces, 1e-9).expect("a tool")
}

#[test]
fn prisms_end_at_the_height() {
    let cross = [[0, 1], [1, 0], [1, 1], [1, 2], [2, 1]];
    for (squares, edges) in [(&cross[2..3], 12), (&cross[..], 36)] {
        let tool = prism(squares, 16.0);
        assert_eq!(tool.edges().len(), edges);
        // Walls are cut at sixteenths.
        for (height, end) in [(2.9, 3.0), (3.5, 4.0), (0.2, 1.0)] {
            let short = tool.below(height).expect("a shorter tool");
            let [low, high] = short.bounding_cylinder().z;
            assert!(low == 0.0 && (high - end).abs() < 1e-12, "{height}: {high}");
            assert_eq!(short.edges().len(), edges, "{height}");
        }
    }
}

/// Where there is nothing to leave out, where a top has more than one outline, or one that is not seen whole from its middle.
#[test]
fn others_are_left_as_they_are() {
    let square = prism(&[[0, 0]], 16.0);
    assert!(
        [-1.0, 15.5, 16.0, 20.0]
            .iter()
            .all(|height| square.below(*height).is_none())
    );
    let horseshoe = [[0, 0], [1, 0], [2, 0], [0, 1], [2, 1]];
    let ring = [[0, 0], [1, 0], [2, 0], [0, 1], [2, 1], [0, 2], [1, 2], [2, 2]];
    assert!(
        [&horseshoe[..], &ring[..]]
            .iter()
            .all(|squares| prism(squares, 16.0).below(3.0).is_none())
    );
}
