//! The part, and the workpiece during the program.

use super::arrays::{Arrays, Scale, octahedron};
use crate::scene::{Area, Course, DexelLayer, KeyFrame, LayerEnd, Scene};
use serde::Serialize;
use std::collections::BTreeMap;
use std::ops::Range;

/// Steps of heights: 16 bits.
pub(crate) const HEIGHTS: u32 = 65_535;

/// The value of a deviation that is not known.
const UNKNOWN: i16 = i16::MIN;

#[derive(Clone, Debug, Serialize)]
pub(crate) struct LayerHead {
    min: [f64; 2],
    max: [f64; 2],
    cells: [usize; 2],
}

impl LayerHead {
    pub fn new(area: Area) -> Self {
        Self {
            min: area.min,
            max: area.max,
            cells: area.cells,
        }
    }
}

/// Heights of both ends, at least one step apart.
fn heights(scale: &Scale, [lower, upper]: [f64; 2]) -> [u16; 2] {
    let lower = scale.steps(lower, HEIGHTS - 1);
    let upper = scale.steps(upper, HEIGHTS).max(lower + 1);
    [lower as u16, upper as u16]
}

/// Counts and heights.
pub(crate) fn material(layer: &DexelLayer, scale: &Scale, names: [&'static str; 3]) -> Arrays {
    let mut arrays = Arrays::default();
    let ends = layer.intervals.iter().map(|ends| heights(scale, ends.map(|end| end.z)));
    let [lower, upper] = halves(ends);
    arrays.u16(names[0], &layer.counts);
    arrays.u16(names[1], &lower);
    arrays.u16(names[2], &upper);
    arrays
}

/// Lower ends and upper ends.
fn halves<T>(pairs: impl Iterator<Item = [T; 2]>) -> [Vec<T>; 2] {
    let (lower, upper) = pairs.map(|[lower, upper]| (lower, upper)).unzip();
    [lower, upper]
}

/// Normals, 16 bits each.
pub(crate) fn normals(layer: &DexelLayer) -> Arrays {
    let packed = |end: &LayerEnd| octahedron(end.normal.map(f64::from)).map(|c| (c * 127.0).round() as i8);
    let mut arrays = Arrays::default();
    let names = [["lower.u", "lower.v"], ["upper.u", "upper.v"]];
    for (names, ends) in names.iter().zip(halves(
        layer.intervals.iter().map(|ends| [packed(&ends[0]), packed(&ends[1])]),
    )) {
        for (k, name) in names.iter().enumerate() {
            let own: Vec<i8> = ends.iter().map(|end| end[k]).collect();
            arrays.i8(name, &own);
        }
    }
    arrays
}

/// The step of deviations: fine beside the limits, but the greatest of the part fits. `None` if none is known.
pub(crate) fn deviation_step(scene: &Scene) -> Option<f64> {
    let of_lines = scene.part.intervals.iter().flatten().map(|end| end.deviation);
    let of_surface = scene
        .surface
        .iter()
        .flat_map(|surface| surface.deviations.iter().copied());
    let known = of_lines
        .chain(of_surface)
        .map(f64::from)
        .filter(|deviation| deviation.is_finite());
    let greatest = known.fold(None, |most: Option<f64>, d| Some(most.unwrap_or(0.0).max(d.abs())))?;
    let limit = scene.limits.map_or(0.0, |[gouge, excess]| gouge.min(excess));
    let fine = if limit > 0.0 { (limit / 16.0).min(1e-3) } else { 1e-3 };
    Some(fine.max(greatest / 32_767.0))
}

/// A deviation in steps. What is beyond them counts as the last.
pub(crate) fn deviation(deviation: f32, step: f64) -> i16 {
    if deviation.is_finite() {
        ((f64::from(deviation) / step).round() as i16).max(UNKNOWN + 1)
    } else {
        UNKNOWN
    }
}

pub(crate) fn deviations(layer: &DexelLayer, step: f64, names: [&'static str; 2]) -> Arrays {
    let packed = |end: &LayerEnd| deviation(end.deviation, step);
    let [lower, upper] = halves(layer.intervals.iter().map(|[a, b]| [packed(a), packed(b)]));
    let mut arrays = Arrays::default();
    arrays.i16(names[0], &lower);
    arrays.i16(names[1], &upper);
    arrays
}

pub(crate) fn makers(layer: &DexelLayer) -> Arrays {
    let [lower, upper] = halves(layer.intervals.iter().map(|[a, b]| [a.maker, b.maker]));
    let mut arrays = Arrays::default();
    arrays.u32("lower.maker", &lower);
    arrays.u32("upper.maker", &upper);
    arrays
}

/// The moments of a course, as embedded.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct CourseHead {
    layer: LayerHead,
    /// The clock of each moment.
    clocks: Vec<f64>,
}

/// Pairs of moments joined: half as many.
pub(crate) fn thinned(frames: &[KeyFrame]) -> Vec<KeyFrame> {
    let joined = |pair: &[KeyFrame]| {
        let mut lines: BTreeMap<u32, (&KeyFrame, Range<usize>)> = BTreeMap::new();
        for frame in pair {
            let mut at = 0;
            for (line, count) in frame.lines.iter().zip(&frame.counts) {
                let own = at..at + usize::from(*count);
                at = own.end;
                lines.insert(*line, (frame, own));
            }
        }
        let mut joined = KeyFrame::new(pair[pair.len() - 1].clock);
        for (line, (frame, own)) in lines {
            joined.push_measured(line, own.map(|k| (frame.intervals[k], frame.deviations[k])));
        }
        joined
    };
    // Counted from the last, which is the state at the end.
    let odd = frames.len() % 2;
    let mut thin: Vec<KeyFrame> = frames[..odd].to_vec();
    thin.extend(frames[odd..].chunks(2).map(joined));
    thin
}

/// The stock and all changes; with deviations, if there is a step of them.
pub(crate) fn course(course: &Course, frames: &[KeyFrame], scale: &Scale, step: Option<f64>) -> (CourseHead, Arrays) {
    let mut arrays = material(&course.start, scale, ["start.counts", "start.lower", "start.upper"]);
    let sizes: Vec<u32> = frames.iter().map(|frame| frame.lines.len() as u32).collect();
    let lines: Vec<u32> = frames.iter().flat_map(|frame| frame.lines.iter().copied()).collect();
    let counts: Vec<u16> = frames.iter().flat_map(|frame| frame.counts.iter().copied()).collect();
    let ends = frames.iter().flat_map(|frame| &frame.intervals);
    let [lower, upper] = halves(ends.map(|ends| heights(scale, *ends)));
    arrays.u32("frames.size", &sizes);
    arrays.u32("frames.line", &lines);
    arrays.u16("frames.counts", &counts);
    arrays.u16("frames.lower", &lower);
    arrays.u16("frames.upper", &upper);
    if let Some(step) = step {
        arrays.append(deviations(
            &course.start,
            step,
            ["start.lower.deviation", "start.upper.deviation"],
        ));
        let all = frames.iter().flat_map(|frame| &frame.deviations);
        let [lower, upper] = halves(all.map(|ends| ends.map(|end| deviation(end, step))));
        arrays.i16("frames.lower.deviation", &lower);
        arrays.i16("frames.upper.deviation", &upper);
    }
    let head = CourseHead {
        layer: LayerHead::new(course.start.area),
        clocks: frames.iter().map(|frame| frame.clock).collect(),
    };
    (head, arrays)
}
