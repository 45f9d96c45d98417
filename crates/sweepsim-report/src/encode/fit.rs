//! All data of the viewer within a number of bytes.

use super::arrays::{Entry, Packed, Scale};
use super::layers::{self, CourseHead, HEIGHTS, LayerHead};
use super::machine::{self, MachineHead};
use super::others::{self, MeshHead, TrackHead};
use super::surface::{self, SurfaceCourseHead, SurfaceHead};
use crate::scene::{DexelLayer, KeyFrame, Scene, SurfaceCourse};
use serde::Serialize;

/// The description of the embedded arrays.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Head {
    /// Of heights.
    height: Scale,
    /// Of deviations.
    deviation: Option<f64>,
    limits: Option<[f64; 2]>,
    frame: [[f64; 3]; 4],
    part: LayerHead,
    surface: Option<SurfaceHead>,
    course: Option<CourseHead>,
    surface_course: Option<SurfaceCourseHead>,
    track: Option<TrackHead>,
    meshes: MeshHead,
    machine: Option<MachineHead>,
    paths: Vec<(u32, u16)>,
    setups: Vec<(u32, String)>,
    programs: Vec<String>,
    arrays: Vec<Entry>,
}

/// The embedded data.
#[derive(Clone, Debug)]
pub(crate) struct Embedded {
    pub head: Head,
    pub bytes: Vec<u8>,
    /// The step of heights, in millimetres.
    pub step: f64,
    /// Whether the surface of the part is there.
    pub has_surface: bool,
    /// What was left out for want of space.
    pub left_out: Vec<String>,
}

/// Base64 of so many bytes.
fn encoded(bytes: usize) -> usize {
    bytes.div_ceil(3) * 4
}

/// The scene, in at most `most` bytes of base64 if that is possible at all; leaves out what matters least.
pub(crate) fn embed(scene: &Scene, most: usize) -> Embedded {
    let heights = scene.part.intervals.iter().flatten().map(|end| end.z);
    let course = scene.course.as_ref();
    let of_start = course
        .into_iter()
        .flat_map(|course| course.start.intervals.iter().flatten().map(|end| end.z));
    let frames = course.into_iter().flat_map(|course| &course.frames);
    let of_frames = frames.flat_map(|frame| frame.intervals.iter().flatten().copied());
    let height = Scale::over(heights.chain(of_start).chain(of_frames), HEIGHTS);
    // All deviations have one step.
    let deviation = layers::deviation_step(scene);
    let others = || {
        let (meshes, mut fixed) = others::meshes(&scene.tools, &scene.solids);
        let track = scene.track.as_ref().map(|own| {
            let (head, arrays) = others::track(own);
            fixed.append(arrays);
            head
        });
        let machine = scene.machine.as_ref().map(|own| {
            let (head, arrays) = machine::machine(own);
            fixed.append(arrays);
            head
        });
        let (programs, texts) = others::programs(&scene.programs);
        let (fixed, texts) = rayon::join(|| fixed.packed(), || texts.packed());
        (meshes, track, machine, programs, fixed, texts)
    };
    let of_part = || {
        rayon::join(
            || Part::new(&scene.part, deviation, &height),
            || layers::normals(&scene.part).packed(),
        )
    };
    let ((meshes, track, machine, programs, mut fixed, texts), (mut part, mut normals)) = rayon::join(others, of_part);
    let mut left_out = Vec::new();
    let fits = |parts: &[&Packed]| encoded(parts.iter().map(|part| part.bytes.len()).sum()) <= most;

    // The part as fine as it is, with normals if they fit.
    let mut coarser = None::<DexelLayer>;
    if !fits(&[&fixed, &part.arrays, &normals]) {
        left_out.push("normals of the surface".to_owned());
        normals = Packed::default();
    }
    let mut nth = 1;
    while !fits(&[&fixed, &part.arrays, &normals]) {
        let before = coarser.as_ref().unwrap_or(&scene.part);
        if before.area.cells == [1, 1] {
            break;
        }
        let half = before.halved();
        part = Part::new(&half, deviation, &height);
        coarser = Some(half);
        nth *= 2;
    }
    if nth > 1 {
        left_out.push(format!("all but every {nth}th line along x and y"));
    }
    let mut sharp = None;
    if let Some(own) = &scene.surface {
        let (head, arrays) = surface::surface(own, deviation);
        let arrays = arrays.packed();
        if fits(&[&fixed, &part.arrays, &normals, &arrays]) {
            fixed.append(&arrays);
            sharp = Some(head);
        } else {
            left_out.push("the surface between the lines".to_owned());
        }
    }
    let (mut kept, mut names) = (texts, programs);
    if !fits(&[&fixed, &part.arrays, &normals, &kept]) {
        left_out.push("the text of the program, but for the lines of findings".to_owned());
        (kept, names) = (Packed::default(), Vec::new());
    }
    // As many moments of the course as fit.
    let moments_fit = |own: &Packed| fits(&[&fixed, &part.arrays, &normals, &kept, own]);
    let mut of_moments = Packed::default();
    let mut shown = None;
    if let Some(course) = course.filter(|_| scene.surface_course.is_none()) {
        let packed = |frames: &Vec<KeyFrame>| {
            let (head, arrays) = layers::course(course, frames, &height, deviation);
            (head, arrays.packed(), frames.len())
        };
        let thinned = |frames: &Vec<KeyFrame>| layers::thinned(frames);
        (shown, of_moments) = moments(course.frames.clone(), packed, thinned, moments_fit, &mut left_out);
    }
    let mut sharp_moments = None;
    // One of a surface takes the place of one on lines.
    if let Some(course) = &scene.surface_course {
        let packed = |course: &SurfaceCourse| {
            let (head, arrays) = surface::course(course, deviation);
            (head, arrays.packed(), course.clocks.len())
        };
        (sharp_moments, of_moments) = moments(course.clone(), packed, surface::thinned, moments_fit, &mut left_out);
    }
    let mut all = part.arrays;
    all.append(&normals);
    all.append(&fixed);
    all.append(&kept);
    all.append(&of_moments);
    let head = Head {
        height,
        deviation,
        limits: scene.limits,
        frame: scene.frame,
        part: part.head,
        surface: sharp,
        course: shown,
        surface_course: sharp_moments,
        track,
        meshes,
        machine,
        paths: scene.paths.clone(),
        setups: scene.setups.clone(),
        programs: names,
        arrays: all.entries,
    };
    Embedded {
        has_surface: head.surface.is_some(),
        head,
        bytes: all.bytes,
        step: height.step,
        left_out,
    }
}

/// As many moments of a course as fit, each time every second one; and what is said of those that are left out.
fn moments<C, H>(
    all: C,
    packed: impl Fn(&C) -> (H, Packed, usize),
    thinned: impl Fn(&C) -> C,
    fits: impl Fn(&Packed) -> bool,
    left_out: &mut Vec<String>,
) -> (Option<H>, Packed) {
    let (mut head, mut arrays, whole) = packed(&all);
    let (mut thin, mut count) = (all, whole);
    while !fits(&arrays) {
        if count <= 1 {
            left_out.push("the workpiece during the program".to_owned());
            return (None, Packed::default());
        }
        thin = thinned(&thin);
        (head, arrays, count) = packed(&thin);
    }
    if count < whole {
        left_out.push(format!("all but {count} of {whole} moments"));
    }
    (Some(head), arrays)
}

/// The part without its normals.
struct Part {
    head: LayerHead,
    arrays: Packed,
}

impl Part {
    fn new(layer: &DexelLayer, deviation: Option<f64>, height: &Scale) -> Self {
        let mut arrays = layers::material(layer, height, ["part.counts", "lower", "upper"]);
        arrays.append(layers::makers(layer));
        if let Some(step) = deviation {
            arrays.append(layers::deviations(layer, step, ["lower.deviation", "upper.deviation"]));
        }
        Self {
            head: LayerHead::new(layer.area),
            arrays: arrays.packed(),
        }
    }
}
