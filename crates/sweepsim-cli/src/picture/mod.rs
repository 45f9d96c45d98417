//! Pictures of parts, computed without a graphics card.
//!
//! A [`Mesh`] is put on a plane under a soft sky with a large lamp to its left. What tools cut is warm, what they left of
//! the stock is cool. How it is made:
//!
//! 1. `scene`: the triangles, moved and scaled so that they fit into the unit ball; `camera`: where one looks from.
//! 2. `light`: depth maps from many directions. The sky is seen or not from each vertex, the lamp from each pixel, through
//!    sixteen maps spread over it: its shadows are sharp at their beginning and soft further on.
//! 3. `frame`: bands of pixel rows, each on its own: nine samples per pixel find the nearest triangle (exactly, in whole
//!    numbers, so that no gap is between neighbours); samples of a pixel that lie on one piece of the surface are
//!    shaded (`shade`) together; edges get a fine line.
//!
//! No step depends on the number of threads: the same mesh gives the same bytes.

mod camera;
mod frame;
mod light;
mod scene;
mod shade;
mod vector;

use camera::Camera;
use light::Lights;
use scene::Scene;
use sweepsim_dexel::Mesh;

/// An RGB picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Pixels across and down.
    pub size: [usize; 2],
    /// Red, green and blue (sRGB) of all pixels, row by row from the top left.
    pub rgb: Vec<u8>,
}

/// Where one looks from, and how large the picture is. The distance is such that the mesh fills the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Pixels across and down.
    pub size: [usize; 2],
    /// Direction of the viewer seen from the part, in degrees around `z`: 0 is on its `+x` side, 90 on its `+y` side.
    pub azimuth: f64,
    /// Height of the viewer above the horizon, in degrees: kept between 5 and 85.
    pub elevation: f64,
    /// Opening of the lens, of the picture's longer side, in degrees: kept between 5 and 90.
    pub opening: f64,
    /// Which share of the picture stays free on each side: kept between 0 and 0.4.
    pub margin: f64,
}

impl Default for View {
    fn default() -> Self {
        Self {
            size: [1600, 1200],
            azimuth: -58.0,
            elevation: 40.0,
            opening: 26.0,
            margin: 0.07,
        }
    }
}

impl View {
    /// Most pixels each way.
    pub const MOST: usize = 16_384;

    /// The picture of a mesh: closed, its triangles counter-clockwise seen from outside.
    ///
    /// Triangles that are not finite, or whose corners are not there, are left out. Without any there is a background.
    /// The size is kept between 1 and [`View::MOST`] each way.
    #[must_use]
    pub fn render(&self, mesh: &Mesh) -> Image {
        let size = self.size.map(|n| n.clamp(1, Self::MOST));
        let scene = Scene::new(mesh);
        let camera = Camera::new(&Self { size, ..*self }, &scene);
        let lights = Lights::new(&scene, &camera);
        frame::render(&scene, &camera, &lights, size)
    }
}

/// The picture of a mesh from the default [`View`].
#[must_use]
pub fn render(mesh: &Mesh, size: [usize; 2]) -> Image {
    View {
        size,
        ..View::default()
    }
    .render(mesh)
}

/// The bytes of a PNG file.
///
/// # Errors
/// What the encoder says: the picture has no pixels, or other than three bytes for each.
pub fn png(image: &Image) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let [width, height] = image.size.map(|n| u32::try_from(n).unwrap_or(u32::MAX));
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_compression(png::Compression::Balanced);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&image.rgb)?;
    writer.finish()?;
    Ok(bytes)
}
