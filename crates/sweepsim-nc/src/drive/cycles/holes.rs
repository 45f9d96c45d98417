//! Hole cycles: a control says in its own words what a hole is, and the moves are made here.
//!
//! Levels are measured along the tool, upwards from the hole's origin, in millimetres.

use std::f64::consts::TAU;

use crate::drive::circular_arc::Arc;
use crate::drive::contour::ArcPlane;
use crate::drive::track::Track;
use crate::model::event::EventKind;
use crate::text::error::NcProblem;

/// The most pecks of one hole, or turns of a helix.
const MOST_PECKS: f64 = 1e5;

/// How far beside a stud the tool goes down, in mm.
pub(super) const BESIDE: f64 = 2.0;

/// What a control does at each hole.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct HoleCycle {
    /// Where the feed begins: the tool goes there first.
    pub start: f64,
    /// Of a back boring: how deep the tool goes beside the axis of the hole.
    pub bottom: f64,
    /// Where the tool is at last.
    pub end: f64,
    pub work: HoleWork,
    /// The feed downwards; without it, the one in effect.
    pub feed: Option<f64>,
    /// By how much the tool leaves the wall at the bottom, or goes down beside the axis.
    pub aside: [f64; 2],
    /// What happens at the bottom, or at the upper end of a back boring.
    pub at_bottom: Vec<EventKind>,
    /// What happens at the start after a feed out of the hole, or at the bottom of a back boring.
    pub at_return: Vec<EventKind>,
    pub out: WayOut,
}

impl HoleCycle {
    /// A hole at once, with a dwell at the bottom unless that is 0, out of which the tool comes in rapid or at its feed.
    pub fn new(start: f64, bottom: f64, dwell: Option<f64>, feeds_out: bool) -> Self {
        let dwell = dwell.filter(|seconds| *seconds > 0.0);
        Self {
            start,
            bottom,
            at_bottom: dwell.map(|seconds| EventKind::Dwell { seconds }).into_iter().collect(),
            out: match feeds_out {
                true => WayOut::FeedToStart(None),
                false => WayOut::Rapid,
            },
            ..Self::default()
        }
    }
}

/// How a hole is made.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum HoleWork {
    /// At once.
    #[default]
    Plunge,
    Pecks(Pecks),
    /// Around in so many turns, counter-clockwise or negative, and once more around at the bottom; outside of a stud, or within a hole.
    Helix {
        radius: f64,
        turns: f64,
        outside: bool,
    },
    /// From below: down beside the axis, across to it, and up. In rapid along the hole (Fanuc), or at the feed, and back down
    /// before the tool leaves the axis (Heidenhain).
    Back {
        up: f64,
        feed: Option<f64>,
        rapid: bool,
    },
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Pecks {
    /// The level where the first one ends, and how deep it is.
    pub first: f64,
    pub infeed: f64,
    /// By how much each is shorter than the one before, and the shortest.
    pub decrease: f64,
    pub least: f64,
    /// Shorter ones at the end are due to rounding.
    pub rounding: f64,
    /// Whether each ends as the hole does, with a dwell.
    pub dwells: bool,
    /// Whether the tool goes back to the start after each, rather than only breaking the chip.
    pub clears: bool,
    /// How far above the last depth the tool is then, in rapid.
    pub above: f64,
}

/// How the tool leaves a hole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum WayOut {
    #[default]
    Rapid,
    /// In rapid, but not past the start.
    RapidToStart,
    /// At this feed, or the one downwards, to the start.
    FeedToStart(Option<f64>),
    Feed,
}

/// Where a hole is, in the frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HolePlace {
    pub origin: [f64; 3],
    /// The directions across the tool, in the plane, and along it.
    pub axes: [[f64; 3]; 3],
}

impl HolePlace {
    /// A hole across a plane, whose levels are coordinates.
    pub fn in_plane(plane: ArcPlane, mut at: [f64; 3]) -> Self {
        at[plane[2]] = 0.0;
        Self {
            origin: at,
            axes: plane.map(|axis| std::array::from_fn(|k| if k == axis { 1.0 } else { 0.0 })),
        }
    }

    pub(super) fn point(&self, aside: [f64; 2], level: f64) -> [f64; 3] {
        let [u, v, w] = &self.axes;
        std::array::from_fn(|k| self.origin[k] + level * w[k] + aside[0] * u[k] + aside[1] * v[k])
    }
}

/// The point at a radius after so many turns from the first direction.
fn turned(radius: f64, turns: f64) -> [f64; 2] {
    let (sin, cos) = (turns * TAU).sin_cos();
    [radius * cos, radius * sin]
}

/// On the axis of the hole.
const CENTRE: [f64; 2] = [0.0; 2];

/// A hole that is made.
struct Hole<'a> {
    track: &'a mut Track,
    cycle: &'a HoleCycle,
    place: HolePlace,
    /// The feed in effect.
    modal: Option<f64>,
}

impl Track {
    pub fn hole(&mut self, cycle: &HoleCycle, place: HolePlace) -> Result<(), NcProblem> {
        let (modal, track) = (self.feed, &mut *self);
        let mut hole = Hole {
            track,
            cycle,
            place,
            modal,
        };
        let made = hole.make();
        self.feed = modal;
        made
    }
}

impl Hole<'_> {
    fn make(&mut self) -> Result<(), NcProblem> {
        let cycle = self.cycle;
        if self.track.known() != Some(self.place.point(CENTRE, cycle.start)) {
            self.rapid(CENTRE, cycle.start)?;
        }
        match cycle.work {
            HoleWork::Plunge => {}
            HoleWork::Pecks(pecks) => self.pecks(&pecks)?,
            HoleWork::Helix { radius, turns, outside } => {
                self.helix(radius, turns, outside)?;
                if outside {
                    let out = turned(radius + BESIDE, turns);
                    self.feed(out, cycle.bottom, cycle.feed)?;
                    self.rapid(out, cycle.end)?;
                    return self.rapid(CENTRE, cycle.end);
                }
            }
            HoleWork::Back { up, feed, rapid } => return self.back(up, feed, rapid),
        }
        self.feed(CENTRE, cycle.bottom, cycle.feed)?;
        self.events(&cycle.at_bottom)?;
        if cycle.aside != CENTRE {
            self.feed(cycle.aside, cycle.bottom, cycle.feed)?;
        }
        let level = match cycle.out {
            WayOut::Rapid | WayOut::Feed => cycle.end,
            WayOut::RapidToStart | WayOut::FeedToStart(_) => cycle.start,
        };
        match cycle.out {
            WayOut::Rapid | WayOut::RapidToStart => self.rapid(cycle.aside, level)?,
            WayOut::FeedToStart(out) => self.feed(cycle.aside, level, out.or(cycle.feed))?,
            WayOut::Feed => self.feed(cycle.aside, level, cycle.feed)?,
        }
        if cycle.aside != CENTRE {
            self.rapid(CENTRE, level)?;
        }
        self.events(&cycle.at_return)?;
        if level == cycle.end {
            return Ok(());
        }
        self.rapid(CENTRE, cycle.end)
    }

    fn pecks(&mut self, pecks: &Pecks) -> Result<(), NcProblem> {
        let cycle = self.cycle;
        let (mut level, mut infeed) = (pecks.first, pecks.infeed);
        let mut levels = Vec::new();
        while level > cycle.bottom + pecks.rounding {
            levels.push(level);
            infeed = (infeed - pecks.decrease).max(pecks.least);
            level -= infeed;
            check_count("pecks", levels.len() as f64)?;
        }
        for level in levels {
            self.feed(CENTRE, level, cycle.feed)?;
            if pecks.dwells {
                self.events(&cycle.at_bottom)?;
            }
            if pecks.clears {
                self.rapid(CENTRE, cycle.start)?;
            }
            self.rapid(CENTRE, (level + pecks.above).min(cycle.start.max(level)))?;
        }
        Ok(())
    }

    /// To the wall at the start, down in whole turns and a part of one, and once more around.
    fn helix(&mut self, radius: f64, turns: f64, outside: bool) -> Result<(), NcProblem> {
        let cycle = self.cycle;
        check_count("turns", turns.abs())?;
        if outside {
            self.rapid([radius + BESIDE, 0.0], cycle.start)?;
        }
        self.feed([radius, 0.0], cycle.start, cycle.feed)?;
        let end = turns;
        for (turns, level) in [(turns, cycle.start), (turns.signum(), cycle.bottom)] {
            let from = if level == cycle.start { 0.0 } else { end };
            let arc = Arc {
                start: self.place.point(turned(radius, from), level),
                end: self.place.point(turned(radius, end), cycle.bottom),
                centre: self.place.point(CENTRE, level),
                normal: self.place.axes[2],
                sweep: turns * TAU,
            };
            self.track.arc(&arc, self.track.abc)?;
        }
        Ok(())
    }

    fn back(&mut self, up: f64, feed_up: Option<f64>, rapid: bool) -> Result<(), NcProblem> {
        let HoleCycle {
            start,
            bottom,
            feed,
            aside,
            ..
        } = *self.cycle;
        let along = |hole: &mut Self, level: f64| match rapid {
            true => hole.rapid(aside, level),
            false => hole.feed(aside, level, feed),
        };
        self.feed(aside, start, feed)?;
        along(self, bottom)?;
        self.feed(CENTRE, bottom, feed)?;
        self.events(&self.cycle.at_return)?;
        self.feed(CENTRE, up, feed_up)?;
        self.events(&self.cycle.at_bottom)?;
        if rapid {
            self.feed(aside, up, feed)?;
            along(self, start)?;
            return self.feed(CENTRE, start, feed);
        }
        self.feed(CENTRE, bottom, feed)?;
        self.feed(aside, bottom, feed)?;
        along(self, start)?;
        self.rapid(CENTRE, start)?;
        self.rapid(CENTRE, self.cycle.end)
    }

    fn rapid(&mut self, aside: [f64; 2], level: f64) -> Result<(), NcProblem> {
        let end = self.place.point(aside, level);
        self.track.line(end, self.track.abc, true)
    }

    fn feed(&mut self, aside: [f64; 2], level: f64, feed: Option<f64>) -> Result<(), NcProblem> {
        self.track.feed = feed.or(self.modal);
        let end = self.place.point(aside, level);
        self.track.line(end, self.track.abc, false)
    }

    fn events(&mut self, events: &[EventKind]) -> Result<(), NcProblem> {
        events.iter().try_for_each(|event| match *event {
            EventKind::Dwell { seconds } => self.track.rest(seconds),
            ref event => self.track.event(event.clone()),
        })
    }
}

fn check_count(what: &str, count: f64) -> Result<(), NcProblem> {
    if count <= MOST_PECKS {
        return Ok(());
    }
    let name = format!("the number of {what} of one hole");
    Err(NcProblem::value(name, count, format!("at most {MOST_PECKS}")))
}
