//! Pictures of parts, drawn without a graphics card: exact normals, a key light with soft shadows, ambient occlusion.
//!
//! The mesh is rasterised four times with its pixels shifted (`raster`), each time shaded (`shade`) with shadows from a
//! depth map of the light and with how open each place is to the sky (`occlusion`); the mean of the four is the picture.
//! The same bytes come out at any number of threads.

mod camera;
mod occlusion;
mod raster;
mod shade;
mod vector;

use camera::{Camera, Light};
use raster::Visible;
use rayon::prelude::*;
use shade::Scene;
use sweepsim_dexel::Mesh;

/// A picture: rows from the top, three bytes a pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width and height.
    pub size: [usize; 2],
    /// Red, green and blue (sRGB) of each pixel.
    pub rgb: Vec<u8>,
}

/// Where the four samples of a pixel lie, from its centre: a rotated square, so that edges of any direction look smooth.
const SAMPLES: [[f32; 2]; 4] = [[-0.125, -0.375], [0.375, -0.125], [0.125, 0.375], [-0.375, 0.125]];

/// Pixels of the light's depth map, to a side.
const SHADOWS: usize = 2048;

/// Draws a mesh as seen from above at an angle, with `+z` up, filling the picture.
///
/// Triangles that name no vertex or have no finite place are left out. `size` is limited to 1 … 16384 each way.
#[must_use]
pub fn render(mesh: &Mesh, size: [usize; 2]) -> Image {
    let size = size.map(|pixels| pixels.clamp(1, 16384));
    let mesh = shade::Surface::new(mesh);
    let camera = Camera::new(&mesh, size);
    let light = Light::key(&mesh, &camera, SHADOWS);
    let shadows = {
        let places: Vec<_> = mesh.places.par_iter().map(|place| light.project(*place)).collect();
        Visible::new(&places, &mesh.triangles, [SHADOWS; 2])
    };
    let seen = |[dx, dy]: [f32; 2]| {
        let places: Vec<_> = mesh
            .places
            .par_iter()
            .map(|place| camera.project(*place).moved(-dx, -dy))
            .collect();
        (Visible::new(&places, &mesh.triangles, size), places)
    };
    let (visible, places) = seen([0.0; 2]);
    let openness = occlusion::openness(&mesh, &camera, &visible, &places);
    let contact = shade::Contact::new(&mesh);
    let scene = Scene {
        mesh: &mesh,
        camera: &camera,
        light: &light,
        shadows: &shadows,
        openness: &openness,
        contact: &contact,
        size,
    };
    let mut sums = vec![[0.0_f32; 3]; size[0] * size[1]];
    for sample in SAMPLES {
        let (visible, places) = seen(sample);
        sums.par_iter_mut().enumerate().for_each(|(pixel, sum)| {
            let colour = scene.colour(&visible, &places, pixel, sample);
            *sum = vector::add(*sum, colour);
        });
    }
    let rgb = sums
        .par_iter()
        .enumerate()
        .flat_map_iter(|(pixel, sum)| {
            // Only the room behind the part changes so slowly that bytes show steps.
            let behind = visible.triangle[pixel] == raster::NONE;
            let grain = if behind {
                shade::grain(pixel % size[0], pixel / size[0])
            } else {
                0.5
            };
            sum.map(|channel| shade::encode(channel / SAMPLES.len() as f32, grain))
        })
        .collect();
    Image { size, rgb }
}

/// The picture as the bytes of a PNG file.
///
/// # Errors
/// What the encoder says: the image has not as many bytes as its size asks for.
pub fn png(image: &Image) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let [width, height] = image.size.map(|pixels| u32::try_from(pixels).unwrap_or(u32::MAX));
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&image.rgb)?;
    writer.finish()?;
    Ok(bytes)
}
