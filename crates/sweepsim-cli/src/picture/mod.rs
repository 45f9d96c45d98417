//! Pictures of parts, computed without a graphics card.
//!
//! A [`Mesh`] is put on a plane under a soft sky with a large lamp to its left. What tools cut is warm, what they left of
//! the stock is cool; or each vertex has a value, and faces the colour that the [`legend`] has for it. [Sections](Section) take
//! away what is between them and the viewer, and lay open the inside. How it is made:
//!
//! 1. `scene`: the triangles, cut off at the sections, moved and scaled so that they fit into the unit ball; `camera`: where one
//!    looks from.
//! 2. `light`: depth maps from many directions. The sky is seen or not from each vertex, the lamp from each pixel, through
//!    sixteen maps spread over it: its shadows are sharp at their beginning and soft further on.
//! 3. `frame`: bands of pixel rows, each on its own: nine samples per pixel find the nearest triangle (exactly, in whole
//!    numbers, so that no gap is between neighbours); samples of a pixel that lie on one piece of the surface are
//!    shaded (`shade`) together; edges get a fine line.
//!
//! No step depends on the number of threads: the same mesh gives the same bytes.

mod camera;
mod frame;
pub mod legend;
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

/// A plane across an axis. What is between it and the viewer is not drawn; the inside of the part is seen where the plane cuts it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// 0 for `x`, 1 for `y`, 2 for `z`; others are no section.
    pub axis: usize,
    /// Where on the axis.
    pub at: f64,
}

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Drawing<'a> {
    /// The part: closed, its triangles counter-clockwise seen from outside.
    pub mesh: &'a Mesh,
    /// A value for each vertex, NaN for none, that faces are coloured by. Without any, they are by what made them.
    pub values: &'a [f32],
    /// Values from `-range` to `range` have colours of their own.
    pub range: f32,
    /// Where it is cut off.
    pub sections: &'a [Section],
}

impl<'a> Drawing<'a> {
    /// A mesh as it is.
    #[must_use]
    pub fn new(mesh: &'a Mesh) -> Self {
        Self {
            mesh,
            values: &[],
            range: 1.0,
            sections: &[],
        }
    }
}

/// Where one looks from, and how large the picture is. The distance is such that the mesh fills the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Pixels across and down.
    pub size: [usize; 2],
    /// Direction of the viewer seen from the part, in degrees around `z`: 0 is on its `+x` side, 90 on its `+y` side.
    pub azimuth: f64,
    /// Height of the viewer above the horizon, in degrees: kept between −90 and 90.
    pub elevation: f64,
    /// Whether parallel lines are parallel in the picture. If not, it is seen through a lens.
    pub orthographic: bool,
    /// Opening of the lens, of the picture's longer side, in degrees: kept between 5 and 90.
    pub opening: f64,
    /// Which share of the picture stays free on each side: kept between 0 and 0.4.
    pub margin: f64,
    /// Which share of the width stays free at the right, for a [`legend`]: kept between 0 and 0.5.
    pub aside: f64,
}

impl Default for View {
    fn default() -> Self {
        Self {
            size: [1600, 1200],
            azimuth: -58.0,
            elevation: 40.0,
            orthographic: false,
            opening: 26.0,
            margin: 0.07,
            aside: 0.0,
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
        self.draw(&Drawing::new(mesh))
    }

    /// As [`View::render`], with values and sections. Sections want a mesh that is closed.
    #[must_use]
    pub fn draw(&self, drawing: &Drawing<'_>) -> Image {
        let size = self.size.map(|n| n.clamp(1, Self::MOST));
        let (azimuth, elevation) = (self.azimuth.to_radians(), self.elevation.to_radians());
        let towards = [
            elevation.cos() * azimuth.cos(),
            elevation.cos() * azimuth.sin(),
            elevation.sin(),
        ];
        let scene = Scene::new(drawing, towards);
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
