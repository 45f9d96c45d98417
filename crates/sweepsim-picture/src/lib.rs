//! Still pictures of triangle meshes, computed without a GPU.
//!
//! A [`Mesh`] stands on a plane under a soft sky, with a large lamp to the viewer's left. Faces that tools cut are
//! bronze, faces of the stock steel; or each vertex has a value, and a colour map and a [`legend`] show it.
//! [Sections](CuttingPlane) cut the part open. The same mesh gives the same bytes for any number of threads.
//!
//! ```
//! use sweepsim_picture::{Axis, Drawing, Mesh, CuttingPlane, View};
//!
//! // A tetrahedron, its triangles counter-clockwise seen from outside.
//! let mesh = Mesh {
//!     vertices: vec![[0.0; 3], [30.0, 0.0, 0.0], [0.0, 30.0, 0.0], [0.0, 0.0, 30.0]],
//!     triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
//!     ..Mesh::default()
//! };
//! let mut view = View::default();
//! view.size = [200, 150];
//! view.azimuth = 30.0;
//! let sections = [CuttingPlane { axis: Axis::Z, at: 10.0 }];
//! let image = view.draw(&Drawing::new(&mesh).sections(&sections));
//! let png: Vec<u8> = image.png()?;
//! assert!(png.starts_with(b"\x89PNG"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # How it works
//!
//! 1. `scene` clips the triangles at the sections and scales them into the unit ball; `camera` finds the distance at
//!    which they fill the image.
//! 2. `light` draws depth maps from many directions: each vertex then knows how much of the sky it sees, and each pixel
//!    how much of the lamp. Sixteen maps spread over the lamp make its shadows sharp where they begin and soft further
//!    away; where eight of them agree, the others aren't asked.
//! 3. `frame` divides the image into bands of rows that are rendered independently (`band`). Nine samples per pixel
//!    find the nearest triangle in integer arithmetic, so that no gap opens between neighbours; samples of a pixel on
//!    the same piece of surface are shaded (`shade`) together; edges get a fine line.
//! 4. `marks` draws the axes and a scale.

mod band;
mod base;
mod camera;
mod depth_maps;
mod frame;
pub mod legend;
mod light;
mod marks;
mod scene;
mod shade;
mod view;

pub use base::image::{Image, ImageError};
pub use sweepsim_dexel::Mesh;
pub use view::{Axis, CuttingPlane, Drawing, View, render};
