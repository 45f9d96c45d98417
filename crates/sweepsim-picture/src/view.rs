//! What is drawn, and from where.

use crate::base::image::Image;
use crate::base::steps::Steps;
use crate::camera::Camera;
use crate::frame;
use crate::light::Lights;
use crate::marks;
use crate::scene::Scene;
use std::ops::ControlFlow;
use sweepsim_dexel::Mesh;

/// A coordinate axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axis {
    /// The first axis.
    X,
    /// The second axis.
    Y,
    /// The third axis.
    Z,
}

impl Axis {
    /// 0 for x, 1 for y, 2 for z: the axis's place in a point.
    #[must_use]
    pub fn index(self) -> usize {
        self as usize
    }
}

/// A plane across an axis. Everything in front of it, as seen by the viewer, is removed; where it cuts the part, the
/// inside shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CuttingPlane {
    /// The axis that the plane is perpendicular to.
    pub axis: Axis,
    /// Where the plane crosses the axis. A section that is not finite removes nothing.
    pub at: f64,
}

/// What is drawn: a mesh, with values to colour it by and sections to cut it open, if any.
#[derive(Clone, Copy, Debug)]
pub struct Drawing<'a> {
    pub(crate) mesh: &'a Mesh,
    pub(crate) values: &'a [f32],
    pub(crate) range: f32,
    pub(crate) sections: &'a [CuttingPlane],
    pub(crate) tool: Option<&'a Mesh>,
    pub(crate) within: Option<[[f64; 3]; 2]>,
}

impl<'a> Drawing<'a> {
    /// A mesh as it is: closed, its triangles counter-clockwise seen from outside.
    #[must_use]
    pub fn new(mesh: &'a Mesh) -> Self {
        Self {
            mesh,
            values: &[],
            range: 1.0,
            sections: &[],
            tool: None,
            within: None,
        }
    }

    /// Colours the mesh by a value per vertex, on a scale from `-range` to `range` (see [`legend`](crate::legend)).
    ///
    /// A vertex whose value is NaN or missing is dark grey. An empty slice leaves the mesh coloured by what made its
    /// faces.
    #[must_use]
    pub fn values(self, values: &'a [f32], range: f32) -> Self {
        Self { values, range, ..self }
    }

    /// Cuts the mesh open.
    #[must_use]
    pub fn sections(self, sections: &'a [CuttingPlane]) -> Self {
        Self { sections, ..self }
    }

    /// Draws a tool as well, in a colour of its own: closed, like the part. Sections do not cut it, and the camera does
    /// not move back for it.
    #[must_use]
    pub fn tool(self, tool: &'a Mesh) -> Self {
        Self {
            tool: Some(tool),
            ..self
        }
    }

    /// Places the camera and the ground as for a part that fills a box, given by its lowest and highest corner. So
    /// pictures of a part that changes have the same point of view.
    ///
    /// A box that is not finite, or whose corners are not in order, is ignored.
    #[must_use]
    pub fn within(self, corners: [[f64; 3]; 2]) -> Self {
        Self {
            within: Some(corners),
            ..self
        }
    }
}

/// The point of view, and the size of the image. The camera moves back until the mesh fills the image.
///
/// Values outside their range are clamped.
///
/// ```
/// use sweepsim_picture::View;
///
/// let mut view = View::default();
/// view.size = [400, 300];
/// view.azimuth = 30.0;
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct View {
    /// Pixels across and down, from 1 to [`Image::MAX_SIDE`] each way.
    pub size: [usize; 2],
    /// Where the viewer stands around `z`, in degrees: 0 on the part's `+x` side, 90 on its `+y` side.
    pub azimuth: f64,
    /// How high the viewer stands above the horizon, in degrees, from −90 to 90.
    pub elevation: f64,
    /// Parallel projection instead of perspective.
    pub orthographic: bool,
    /// The field of view along the image's longer side, in degrees, from 5 to 90.
    pub field_of_view: f64,
    /// The share of the image left free on each side, from 0 to 0.4.
    pub margin: f64,
    /// The share of the width left free at the right for a [`legend`](crate::legend), from 0 to 0.5.
    pub legend: f64,
    /// Whether the axes and a length are drawn in the lower left corner of images of at least 240 × 180 pixels. The
    /// length is true in the middle of the part.
    pub axes: bool,
}

impl Default for View {
    fn default() -> Self {
        Self {
            size: [1600, 1200],
            azimuth: -58.0,
            elevation: 40.0,
            orthographic: false,
            field_of_view: 26.0,
            margin: 0.07,
            legend: 0.0,
            axes: true,
        }
    }
}

impl View {
    /// Renders a mesh: closed, its triangles counter-clockwise seen from outside.
    ///
    /// Triangles with missing or non-finite corners are left out. An empty mesh gives the background.
    #[must_use]
    pub fn render(&self, mesh: &Mesh) -> Image {
        self.draw(&Drawing::new(mesh))
    }

    /// Renders a mesh with values and sections. Sections need a closed mesh.
    #[must_use]
    pub fn draw(&self, drawing: &Drawing<'_>) -> Image {
        let size = self.size.map(|side| side.clamp(1, Image::MAX_SIDE));
        self.draw_while(drawing, &|_| ControlFlow::Continue(()))
            .unwrap_or_else(|| Image::black(size))
    }

    /// Renders like [`draw`](Self::draw), for as long as the picture is wanted.
    ///
    /// Before each of some hundreds of steps, `go_on` is told the share of the work that is done, from 0 to 1, by any
    /// thread; if it breaks, the picture is given up and there is none.
    #[must_use]
    pub fn draw_while(&self, drawing: &Drawing<'_>, go_on: &(dyn Fn(f64) -> ControlFlow<()> + Sync)) -> Option<Image> {
        let size = self.size.map(|side| side.clamp(1, Image::MAX_SIDE));
        let (azimuth, elevation) = (self.azimuth.to_radians(), self.elevation.to_radians());
        let towards = [
            elevation.cos() * azimuth.cos(),
            elevation.cos() * azimuth.sin(),
            elevation.sin(),
        ];
        let scene = Scene::new(drawing, towards);
        let camera = Camera::new(&Self { size, ..*self }, &scene);
        let steps = Steps::new(go_on, Lights::steps(&scene) + frame::steps(size));
        let lights = Lights::new(&scene, &camera, size, &steps)?;
        let mut image = frame::render(&scene, &camera, &lights, size, &steps)?;
        if self.axes {
            marks::draw(&mut image, &scene, &camera);
        }
        Some(image)
    }
}

/// Renders a mesh from the default [`View`].
#[must_use]
pub fn render(mesh: &Mesh, size: [usize; 2]) -> Image {
    let view = View {
        size,
        ..View::default()
    };
    view.render(mesh)
}
