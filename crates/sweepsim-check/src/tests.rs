//! Tests of what is not public.

use crate::surface::Surface;

#[test]
fn a_tetrahedron_has_an_inside() {
    let [o, x, y, z] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let triangles = [[o, y, x], [o, x, z], [o, z, y], [x, y, z]];
    let surface = Surface::new(&triangles).expect("closed");
    assert_eq!(surface.is_outside(&[0.1, 0.1, 0.1]), Some(false));
    assert_eq!(surface.is_outside(&[0.5, 0.5, 0.5]), Some(true));
    assert_eq!(surface.is_outside(&[-0.1, 0.1, 0.1]), Some(true));
    let (distance, near) = surface.nearest(&[0.1, 0.2, 0.3]);
    assert!(distance <= 0.1 && distance > 0.1 - 1e-14 && near == [0.0, 0.2, 0.3]);
    assert!(Surface::new(&triangles[1..]).is_err());
    // Inside out: nothing is inside.
    let surface = Surface::new(&triangles.map(|[a, b, c]| [a, c, b])).expect("closed");
    assert_eq!(surface.is_outside(&[0.1, 0.1, 0.1]), Some(true));
}
