//! How far the axes of the machine go, and where they turn far for little.

use crate::base::words;
use crate::session::Session;
use crate::verify::work;
use sweepsim_formats::{AxisTravel, JobPath, Report};
use sweepsim_machine::Course;
use sweepsim_nc::AxesCourse;

/// Curved courses of axes are looked at so many times in a move: what they go beyond that is left out here, though not
/// where limits are checked.
const SAMPLES: usize = 32;
/// A rotary axis that turns by more than this in a move, in degrees,
const FAR: f64 = 90.0;
/// while the tool turns by less than this part of it, does so near a direction in which any angle would do.
const LITTLE: f64 = 0.1;

/// The travel of each axis, and a note of turns that do little.
pub(in crate::verify) fn describe(report: &mut Report, session: Session) {
    let (axes, note) = travel(session);
    let judging = &session.request.judging;
    if !axes.is_empty() && (judging.length_range > 0.0 || judging.offset_range != [0.0; 3]) {
        let [x, y, z] = judging.offset_range.map(words::length);
        let length = words::length(judging.length_range);
        report.notes.push(format!(
            "the machine is judged for all places of the part within ±({x}, {y}, {z}) mm of its own, and for tools up to {length} mm longer or shorter"
        ));
    }
    report.notes.extend(note);
    report.axes = (!axes.is_empty()).then_some(axes);
}

/// How far each axis goes, by letter; and a note.
pub(in crate::verify) fn travel(session: Session) -> (Vec<AxisTravel>, Option<String>) {
    let folder = session.folder();
    let mut axes: Vec<(AxisTravel, f64)> = Vec::new();
    let (mut flips, mut first) = (0, None);
    for path in &session.job.paths {
        let Some(course) = path.on_machine.as_ref().map(|on| &on.course) else {
            continue;
        };
        for piece in 0..course.moves() {
            let (number, ..) = course.place(piece, 0.0);
            let place = || work::place(path, number, folder);
            let curved = course.bend(piece).iter().any(|bend| *bend > 0.0);
            let steps = if curved { SAMPLES } else { 1 };
            for step in 0..=steps {
                let values = course.at(piece, step as f64 / steps as f64);
                for (letter, value) in course.chain().letters().iter().zip(values) {
                    let [from, to] = course.fixed(piece, *letter);
                    // Homes may be at a limit, and the ways there end near it.
                    let is_fixed = match step {
                        0 => from,
                        _ if step == steps => to,
                        _ => from || to,
                    };
                    reach(&mut axes, course, (*letter, value), is_fixed, place);
                }
            }
            if let Some((letter, turn, tilt)) = flip(path, course, piece, number) {
                flips += 1;
                first.get_or_insert_with(|| {
                    let place = place().map_or_else(String::new, |(file, line)| format!("{file}:{line}: "));
                    let [turn, tilt] = [turn, tilt].map(words::length);
                    format!("{place}{letter} turns by {turn}° while the tool turns by {tilt}°")
                });
            }
        }
    }
    let note = first.map(|first| {
        let often = if flips > 1 {
            format!(" ({flips} times, first here)")
        } else {
            String::new()
        };
        format!("{first}: near a direction in which any angle of the axis would do{often}")
    });
    axes.sort_by_key(|(axis, _)| axis.letter);
    (axes.into_iter().map(|(axis, _)| axis).collect(), note)
}

/// Widens the travel of an axis to a value.
fn reach(
    axes: &mut Vec<(AxisTravel, f64)>,
    course: &AxesCourse,
    (letter, value): (char, f64),
    is_fixed: bool,
    place: impl Fn() -> Option<(String, usize)>,
) {
    let number = axes
        .iter()
        .position(|(axis, _)| axis.letter == letter)
        .unwrap_or_else(|| {
            let mut new = AxisTravel::default();
            (new.letter, new.range, new.limits) = (letter, [value; 2], course.limits(letter));
            axes.push((new, f64::INFINITY));
            axes.len() - 1
        });
    let (axis, least) = &mut axes[number];
    axis.range = [axis.range[0].min(value), axis.range[1].max(value)];
    let room = match axis.limits {
        Some([low, high]) => (value - low).min(high - value),
        None => -value.abs(),
    };
    if room < *least && !is_fixed {
        *least = room;
        axis.room = axis.limits.map(|_| room);
        (axis.file, axis.line) = place().unzip();
    }
}

/// A rotary axis that turns far while the tool hardly turns, under tip control: its letter, its turn and that of the
/// tool, in degrees.
fn flip(path: &JobPath, course: &AxesCourse, piece: usize, number: usize) -> Option<(char, f64, f64)> {
    let [from, to] = [0.0, 1.0].map(|time| course.at(piece, time));
    let turns = course.chain().letters().iter().zip(from).zip(to);
    let turns = turns.filter(|((letter, _), _)| ('A'..='C').contains(*letter));
    let turns = turns.map(|((letter, from), to)| (*letter, (to - from).abs()));
    let (letter, turn) = turns
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .filter(|(_, turn)| *turn > FAR)?;
    let moved = number < path.path.moves() && course.bend(piece).iter().any(|bend| *bend > 0.0);
    let [a, b] = [number, number + 1].map(|pose| path.path.pose(pose.min(path.path.moves())).axis());
    let cosine: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    let tilt = cosine.clamp(-1.0, 1.0).acos().to_degrees();
    (moved && tilt < LITTLE * turn).then_some((letter, turn, tilt))
}
