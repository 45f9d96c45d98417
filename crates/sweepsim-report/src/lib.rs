//! Reports of milling simulations as one HTML file that needs no network: the verdict, findings, tables and plots as
//! plain HTML, and a viewer of the part and of the program's course in WebGL.
//!
//! This crate knows no sweep. A [`Page`] is filled with plain data (words, tables, [plots](Plot), [findings](Finding));
//! its [`Scene`] holds the part as [intervals on lines](DexelLayer), [tools](ToolShape), [solids](Solid) and the course
//! of the program, on [lines](Course) or as a [surface](SurfaceCourse). [`Page::html`] returns the file.
//!
//! ```
//! use sweepsim_report::{Area, DexelLayer, LayerEnd, Page, Scene, Verdict};
//!
//! let area = Area { min: [0.0, 0.0], max: [40.0, 30.0], cells: [40, 30] };
//! let part = DexelLayer::new(area, |i, _, line| {
//!     line.push([LayerEnd::at(0.0, [0.0, 0.0, -1.0]), LayerEnd::at(if i < 20 { 8.0 } else { 5.0 }, [0.0, 0.0, 1.0])]);
//! });
//! let mut page = Page::new("bracket");
//! page.verdict = Some(Verdict::good("Nothing was found that does harm."));
//! page.scene = Some(Scene::new(part));
//! let html = page.html();
//! assert!(html.starts_with("<!doctype html>") && html.len() < 200_000);
//! ```
//!
//! # Size
//!
//! Heights are quantised to 16 bits within the extent of the scene (the page states the step), predicted by their
//! neighbours, and compressed. A page never exceeds [`Page::most_bytes`]: if it would, normals are left out first, then
//! every second line, the surface, the programs' texts, and every second moment of the course, and the page says so.
//!
//! # Layout
//!
//! `assets/` holds the page's style sheets and scripts as they are read by people; nothing is generated or minified.

mod axes;
mod encode;
mod findings;
mod html;
mod page;
mod plots;
mod scene;
mod tables;
mod viewer;

pub use axes::AxisPlot;
pub use findings::{Excerpt, Finding};
pub use html::{grouped, measure};
pub use page::{Page, Picture, Verdict, VerdictState};
pub use plots::{Bar, Histogram, Plot};
pub use scene::{
    Area, Course, DexelLayer, JOINTS, KeyFrame, LayerEnd, Machine, MachineJoint, MachinePoint, ProgramText, Scene,
    Solid, SolidKind, Surface, SurfaceCourse, ToolPart, ToolShape, Track, TrackPoint,
};
pub use tables::{Fact, Table};

/// The README's example is tested.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
