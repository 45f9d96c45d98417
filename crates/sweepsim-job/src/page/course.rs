//! The program's course: where the tools are.

use super::PageSource;
use super::moments::{Moments, moments};
use super::program::Programs;
use crate::base::JobError;
use crate::request::Task;
use crate::show::{Placement, distance, placements};
use sweepsim_formats::JobPath;
use sweepsim_report::{Track, TrackPoint};

/// The most points of the track.
const POINTS: usize = 200_000;
/// Programs with more moves have no moments unless they are asked for: it takes about as long as the simulation.
const MOVES: usize = 50_000;
/// So many moves are unpacked at a time.
const STRETCH: usize = 4096;
/// The default number of moments.
const MOMENTS: u16 = 120;

/// The course of all paths.
pub(super) struct Courses {
    pub track: Track,
    pub moments: Moments,
    /// Of each path, the number of moves before it.
    pub first_moves: Vec<u32>,
    pub moves: u32,
    /// Of each path, the length of feed moves and of rapids.
    pub lengths: Vec<[f64; 2]>,
    pub notes: Vec<String>,
    /// The time at the end of each move, and at the start of the first.
    clocks: Vec<f64>,
}

impl Courses {
    /// The clock at a time (0 to 1) of a move.
    pub fn clock(&self, path: usize, number: usize, time: f64) -> Option<f64> {
        let place = *self.first_moves.get(path)? as usize + number;
        let [from, to] = [*self.clocks.get(place)?, *self.clocks.get(place + 1)?];
        Some(from + (to - from) * time.clamp(0.0, 1.0))
    }
}

/// The track, and the course if it is wanted.
pub(super) fn made(source: &PageSource, programs: &Programs) -> Result<Courses, JobError> {
    let job = source.session.job;
    let room = 0.1 * job.grid.spacing()[0].min(job.grid.spacing()[1]);
    // The clock is that of the machine if all moves have a duration, otherwise the way of the tip.
    let is_timed = |path: &JobPath| {
        path.seconds.len() == path.path.moves() && path.seconds.iter().all(|s| s.is_some_and(f64::is_finite))
    };
    let timed = job.paths.iter().all(is_timed);
    let mut made = Courses {
        track: Track {
            lines: programs.lines(),
            unit: if timed { "s" } else { "mm" }.to_owned(),
            ..Track::default()
        },
        moments: Moments::default(),
        first_moves: Vec::new(),
        moves: 0,
        lengths: Vec::new(),
        notes: Vec::new(),
        clocks: vec![0.0],
    };
    let every = job.moves().div_ceil(POINTS).max(1);
    let (mut clock, mut tool_numbers) = (0.0, job.tools.keys().copied().collect::<Vec<u32>>());
    tool_numbers.sort_unstable();
    for path in &job.paths {
        made.first_moves.push(made.moves);
        let tool = tool_numbers.binary_search(&path.tool).unwrap_or_default() as u16;
        let reach = job.tools[&path.tool].reach();
        let mut lengths = [0.0; 2];
        let mut before = Placement::first(&path.path);
        let mut point = |clock: f64, place: &Placement, number: u32, rapid: bool, begins: bool| {
            made.track.points.push(TrackPoint {
                clock,
                tip: place.tip,
                axis: place.axis,
                number,
                rapid,
                begins,
                tool,
            });
        };
        if let Some(place) = &before {
            point(clock, place, made.moves, false, true);
        }
        let mut times = path.seconds.iter();
        for (first, part) in path.path.stretches(STRETCH) {
            for own in 0..part.moves() {
                let number = first + own;
                let rapid = path.rapid.get(number);
                // What is left out of long programs is straight, as far as people can see.
                let room = if every > 1 { f64::INFINITY } else { room };
                let places = placements(&part, own, 1.0, reach, room);
                let steps: Vec<[f64; 2]> = std::iter::once(before)
                    .chain(places.iter().copied().map(Some))
                    .zip(&places)
                    .map(|(before, place)| {
                        let Some(before) = before else { return [0.0; 2] };
                        let step = distance(before.tip, place.tip);
                        // A turn on the spot takes time, too.
                        [step, step.max(0.25 * before.far(place, reach))]
                    })
                    .collect();
                let whole: f64 = steps.iter().map(|[_, way]| way).sum();
                let known = times.next().flatten();
                let seconds = if timed { known.unwrap_or_default() } else { whole };
                let pace = if whole > 0.0 { seconds / whole } else { 0.0 };
                let end = clock + seconds;
                for (place, [step, way]) in places.iter().zip(&steps) {
                    clock += pace * way;
                    lengths[usize::from(rapid)] += step;
                    if number % every == 0 || number + 1 == path.path.moves() {
                        point(clock, place, made.moves + number as u32, rapid, false);
                    }
                }
                before = places.last().copied().or(before);
                // A move without a way may take its time.
                clock = end.max(clock);
                made.clocks.push(clock);
            }
        }
        made.moves += path.path.moves() as u32;
        made.lengths.push(lengths);
    }
    let asked = source.session.request.moments;
    let count = asked.unwrap_or(MOMENTS);
    if source.session.request.task == Task::Sweep || count == 0 || clock <= 0.0 {
        return Ok(made);
    }
    if job.moves() > MOVES && asked.is_none() {
        made.notes.push(format!(
            "the workpiece during the program is not shown: more than {MOVES} moves; --moments asks for it"
        ));
        return Ok(made);
    }
    made.moments = moments(source, count, &made.track, &mut made.notes)?;
    Ok(made)
}
