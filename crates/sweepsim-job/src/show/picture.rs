//! Pictures of parts.

use crate::base::JobError;
use crate::base::words::length;
use crate::request::ViewOptions;
use std::borrow::Cow;
use std::ops::ControlFlow;
use sweepsim::Monitor;
use sweepsim_dexel::{Mesh, MeshError, TriangleSoup};
use sweepsim_picture::{CuttingPlane, Drawing, Image, legend};

/// Cosine of 40°: sharper edges of meshes from files, or of tri-dexels, are drawn sharp.
pub(crate) const CRISP: f64 = 0.766;

/// The steps of a phase that tells only its share.
const WHOLE: usize = 1000;

/// Tells a monitor the share of a phase that is done, and goes on unless it cancels.
pub(crate) fn share(
    monitor: &dyn Monitor,
    of_phase: impl Fn(f64) -> f64 + Sync,
) -> impl Fn(f64) -> ControlFlow<()> + Sync {
    move |part| {
        monitor.advance((of_phase(part) * WHOLE as f64) as usize, WHOLE);
        if monitor.cancelled() {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }
}

/// A mesh of fewer triangles, nowhere further than `deviation` from this one; the same mesh without one. A note says if
/// none was found.
pub(crate) fn decimated(mesh: &Mesh, deviation: Option<f64>) -> Result<(Cow<'_, Mesh>, Option<String>), MeshError> {
    let Some(deviation) = deviation else {
        return Ok((Cow::Borrowed(mesh), None));
    };
    let small = mesh.decimated(deviation)?;
    let note = (small.triangles.len() >= mesh.triangles.len()).then(|| {
        format!("--decimate: no smaller mesh within {deviation} mm of the surface was found: all triangles are kept")
    });
    Ok((Cow::Owned(small.crisp(CRISP)?), note))
}

/// The triangles of a mesh; readers have checked that their vertices exist.
pub(crate) fn soup(mesh: &Mesh) -> TriangleSoup {
    mesh.soup().unwrap_or_default()
}

/// The lower and upper corners of a mesh's bounding box, unless it is empty.
pub(crate) fn bounds(mesh: &Mesh) -> Option<[[f64; 3]; 2]> {
    let corners = mesh
        .triangles
        .iter()
        .flatten()
        .filter_map(|v| mesh.vertices.get(*v as usize));
    corners.fold(None, |range, p| {
        let [low, high] = range.unwrap_or([*p; 2]);
        Some([
            [0, 1, 2].map(|k| low[k].min(p[k])),
            [0, 1, 2].map(|k| high[k].max(p[k])),
        ])
    })
}

/// The picture of a part as PNG: coloured by what made its faces, or by a value per vertex on a scale of plus and minus
/// a range.
///
/// A section that does not meet the part is left out, and said in the list. The picture is given up, as an
/// interruption, if `go_on` breaks.
pub(crate) fn picture(
    options: &ViewOptions,
    mesh: &Mesh,
    values: Option<(&[f32], f64)>,
    go_on: &(dyn Fn(f64) -> ControlFlow<()> + Sync),
) -> Result<(Vec<u8>, Vec<String>), JobError> {
    let (sections, missed) = meeting(&options.planes(), bounds(mesh));
    let mut view = options.view();
    let mut drawing = Drawing::new(mesh).sections(&sections);
    if let Some((values, range)) = values {
        view.legend = legend::WIDTH;
        drawing = drawing.values(values, range as f32);
    }
    let mut image = view.draw_while(&drawing, go_on).ok_or(JobError::Cancelled)?;
    if let Some((_, range)) = values {
        legend::draw(&mut image, range as f32);
    }
    Ok((png(&image)?, missed))
}

/// The picture of a part and perhaps a tool as PNG, from where the box `whole` fills the image.
pub(crate) fn frame_picture(
    options: &ViewOptions,
    mesh: &Mesh,
    tool: Option<&Mesh>,
    whole: [[f64; 3]; 2],
    go_on: &(dyn Fn(f64) -> ControlFlow<()> + Sync),
) -> Result<Vec<u8>, JobError> {
    let (sections, _) = meeting(&options.planes(), Some(whole));
    let drawing = Drawing::new(mesh).sections(&sections).within(whole);
    let drawing = match tool {
        Some(tool) => drawing.tool(tool),
        None => drawing,
    };
    let image = options.view().draw_while(&drawing, go_on);
    png(&image.ok_or(JobError::Cancelled)?)
}

fn png(image: &Image) -> Result<Vec<u8>, JobError> {
    let png = image.png();
    png.map_err(|error| JobError::run(format!("cannot make the picture: {error}")))
}

/// The sections that meet a part with these corners, and what is to be said of the others.
fn meeting(sections: &[CuttingPlane], part: Option<[[f64; 3]; 2]>) -> (Vec<CuttingPlane>, Vec<String>) {
    let Some([low, high]) = part else {
        return (sections.to_vec(), Vec::new());
    };
    let (mut all, mut missed) = (Vec::new(), Vec::new());
    for section in sections {
        let (from, to) = (low[section.axis.index()], high[section.axis.index()]);
        if from < section.at && section.at < to {
            all.push(*section);
        } else {
            let axis = ["x", "y", "z"][section.axis.index()];
            let [at, from, to] = [section.at, from, to].map(length);
            missed.push(format!(
                "--section {axis}={at} does not meet the part, which is from {from} to {to}: the picture is without it"
            ));
        }
    }
    (all, missed)
}
