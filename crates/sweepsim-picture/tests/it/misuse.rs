//! No mesh, view or section makes the renderer panic, and no image has the wrong number of bytes.

use sweepsim_dexel::Mesh;
use sweepsim_picture::{Axis, CuttingPlane, Drawing, Image, ImageError, View, legend};
use sweepsim_props::*;

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -100.0..100.0,
        1 => prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(-1e300), Just(0.0), Just(1e-300)],
    ]
}

fn point() -> impl Strategy<Value = [f64; 3]> {
    [number(), number(), number()]
}

prop_compose! {
    fn mesh()(
        vertices in collection::vec(point(), 0..8),
        normals in collection::vec(point(), 0..9),
        cut in collection::vec(any::<bool>(), 0..9),
        triangles in collection::vec([0_u32..9, 0_u32..9, 0_u32..9], 0..8),
    ) -> Mesh {
        Mesh { vertices, normals: normals.iter().map(|n| n.map(|c| c as f32)).collect(), cut, triangles }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn anything_can_be_drawn(
        mesh in mesh(),
        values in collection::vec(number(), 0..9),
        range in number(),
        at in number(),
        angles in [number(), number(), number()],
        size in [0_usize..40, 0_usize..40],
        orthographic in any::<bool>(),
    ) {
        let values: Vec<f32> = values.iter().map(|value| *value as f32).collect();
        let mut view = View::default();
        view.size = size;
        [view.azimuth, view.elevation, view.margin] = angles;
        view.legend = angles[0];
        view.field_of_view = angles[1];
        view.orthographic = orthographic;
        let sections = [CuttingPlane { axis: Axis::Z, at }, CuttingPlane { axis: Axis::X, at: 0.5 * at }];
        let mut image = view.draw(&Drawing::new(&mesh).values(&values, range as f32).sections(&sections));
        legend::draw(&mut image, range as f32);
        prop_assert_eq!(image.size(), size.map(|side| side.max(1)));
        prop_assert_eq!(image.rgb().len(), 3 * image.size()[0] * image.size()[1]);
        prop_assert!(image.png().is_ok());
    }

    #[test]
    fn images_have_three_bytes_per_pixel(size in [0_usize..5, 0_usize..5], bytes in 0_usize..80) {
        let made = Image::new(size, vec![7; bytes]);
        prop_assert_eq!(made.is_ok(), bytes > 0 && bytes == 3 * size[0] * size[1]);
    }
}

#[test]
fn huge_sizes_are_errors() {
    let size = [usize::MAX, 2];
    assert!(matches!(Image::new(size, Vec::new()), Err(ImageError::Size { .. })));
}
