//! Pockets, slots and studs: a control says in its own words what the shape is, and the moves are made here.
//!
//! Controls go from the middle outwards, or from the raw stud inwards, each on a way of its own, and into the material on a helix, to and fro, or straight. Here the tool goes straight down, and
//! around on rings from which the shape is left out by the tool's radius: the material that is taken is that of the shape, the way within it is an assumption.

use std::f64::consts::TAU;

use super::holes::{BESIDE, HolePlace};
use crate::drive::UNKNOWN_TOOL;
use crate::drive::circular_arc::Arc;
use crate::drive::contour::Bend;
use crate::drive::track::Track;
use crate::text::error::NcProblem;

/// The most rings and levels of a pocket.
const MOST: f64 = 1e5;
/// The largest step between rings, in radii of the tool: farther apart, something would stand between their corners.
pub(super) const WIDEST_STEP: f64 = 1.4;

/// A rectangle with round corners, or a circle, that is milled away or left standing, about a point. Lengths in mm; levels are coordinates along the tool.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Pocket {
    /// Half of its sides, and the radius of its corners.
    pub half: [f64; 2],
    pub corner: f64,
    /// Half of the sides of a stud before; none of a pocket.
    pub raw: Option<[f64; 2]>,
    /// From where it is called to its middle, before it is turned.
    pub aside: [f64; 2],
    /// The turn of its first side, in degrees.
    pub turn: f64,
    /// Where the tool begins, the surface, the bottom, and where it is at last.
    pub start: f64,
    pub surface: f64,
    pub bottom: f64,
    pub end: f64,
    /// How deep each level is; 0: all at once.
    pub infeed: f64,
    /// What is left on the sides and on the floor.
    pub left: [f64; 2],
    /// Only the last ring, for finishing.
    pub rim_alone: bool,
    /// The radius of the tool, and the step between rings.
    pub tool: f64,
    pub step: f64,
    pub feed: Option<f64>,
    pub plunge: Option<f64>,
    pub clockwise: bool,
}

/// A ring: half of the sides of the rectangle of its corners' centres, and their radius.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ring {
    core: [f64; 2],
    pub(super) radius: f64,
}

impl Pocket {
    /// A point at its place, milled all at once between levels: where the tool is at last, where it begins, the surface and the bottom.
    pub fn new([end, start, surface, bottom]: [f64; 4], tool: f64) -> Self {
        Self {
            half: [0.0; 2],
            corner: 0.0,
            raw: None,
            aside: [0.0; 2],
            turn: 0.0,
            start,
            surface,
            bottom,
            end,
            infeed: 0.0,
            left: [0.0; 2],
            rim_alone: false,
            tool,
            step: tool,
            feed: None,
            plunge: None,
            clockwise: false,
        }
    }

    /// The diameter of a tool of unknown size that mills this shape.
    pub fn widest_unknown_tool(&self) -> f64 {
        let width = 2.0 * self.half[0].min(self.half[1]);
        match self.raw {
            None if width > 0.0 => UNKNOWN_TOOL.min(width),
            _ => UNKNOWN_TOOL,
        }
    }

    /// The rings, the last one along the shape.
    pub(super) fn rings(&self) -> Result<Vec<Ring>, NcProblem> {
        let Self { half, corner, tool, .. } = *self;
        let corner = corner.min(half[0]).min(half[1]);
        let rim = self.left[0];
        let inside = self.raw.is_none();
        // How far the first ring is from the last one.
        let width = match self.raw {
            None => half[0].min(half[1]) - tool - rim,
            // The corners of the raw stud are the farthest; a round one has none.
            Some(raw) if half.iter().all(|half| *half <= corner) => raw[0].max(raw[1]) - corner - 2.0 * tool - rim,
            Some(raw) => (raw[0] - half[0] + corner).hypot(raw[1] - half[1] + corner) - corner - 2.0 * tool - rim,
        };
        if inside && width < -1e-9 {
            return Err(NcProblem::value(
                "the narrower side of a pocket",
                2.0 * half[0].min(half[1]),
                format!(
                    "at least as wide as the tool, {}, with what is left on the sides",
                    2.0 * tool
                ),
            ));
        }
        let step = self.step.min(WIDEST_STEP * tool);
        if !(step > 0.0 && tool > 0.0) {
            return Err(NcProblem::value(
                "the step between the rings of a pocket",
                self.step,
                "a positive number",
            ));
        }
        let count = if self.rim_alone {
            0.0
        } else {
            (width.max(0.0) / step - 1e-9).ceil().max(0.0)
        };
        check_count("rings", count)?;
        let ring = |k: usize| {
            let off = width.max(0.0) * (count - k as f64) / count.max(1.0) + rim;
            if inside {
                let off = off + tool;
                let radius = (corner - off).max(0.0);
                let core = half.map(|half| (half - off.max(corner)).max(0.0));
                Ring { core, radius }
            } else {
                let core = half.map(|half| half - corner);
                Ring {
                    core,
                    radius: corner + tool + off,
                }
            }
        };
        Ok((0..=count as usize).map(ring).collect())
    }

    /// The levels, the last one the bottom.
    pub(super) fn levels(&self) -> Result<Vec<f64>, NcProblem> {
        let floor = self.bottom + self.left[1];
        if !(floor < self.surface) {
            return Err(NcProblem::value(
                "the bottom of a pocket",
                floor,
                format!("below its surface, {}", self.surface),
            ));
        }
        let deep = self.surface - floor;
        let infeed = if self.infeed > 0.0 { self.infeed } else { deep };
        let count = (deep / infeed - 1e-9).ceil().max(1.0);
        check_count("levels", count)?;
        let levels = (1..count as usize).map(|k| self.surface - k as f64 * infeed);
        Ok(levels.chain([floor]).collect())
    }
}

fn check_count(what: &str, count: f64) -> Result<(), NcProblem> {
    if count <= MOST {
        return Ok(());
    }
    Err(NcProblem::value(
        format!("the number of {what} of a pocket"),
        count,
        format!("at most {MOST}"),
    ))
}

impl Track {
    pub(super) fn pocket(&mut self, pocket: &Pocket, here: HolePlace) -> Result<(), NcProblem> {
        let (rings, levels) = (pocket.rings()?, pocket.levels()?);
        let (sin, cos) = pocket.turn.to_radians().sin_cos();
        let [u, v, w] = here.axes;
        let turned = |a: f64, b: f64| std::array::from_fn(|k| a * u[k] + b * v[k]);
        let mut place = HolePlace {
            origin: here.origin,
            axes: [turned(cos, sin), turned(-sin, cos), w],
        };
        place.origin = place.point(pocket.aside, 0.0);
        let Some(first) = rings.first() else { return Ok(()) };
        // In the middle of the first ring, or beside the stud.
        let entry = match pocket.raw {
            None => [first.core[0].max(0.0), 0.0],
            Some(raw) => [(first.core[0] + first.radius).max(raw[0] + pocket.tool) + BESIDE, 0.0],
        };
        let modal = self.feed;
        self.line(here.point([0.0; 2], pocket.start), self.abc, true)?;
        self.line(place.point(entry, pocket.start), self.abc, true)?;
        for level in levels {
            self.feed = pocket.plunge.or(pocket.feed).or(modal);
            self.line(place.point(entry, level), self.abc, false)?;
            self.feed = pocket.feed.or(modal);
            for ring in &rings {
                self.ring(ring, &place, level, pocket.clockwise)?;
            }
            self.line(place.point(entry, level), self.abc, false)?;
        }
        self.feed = modal;
        self.line(place.point(entry, pocket.end), self.abc, true)?;
        self.line(here.point([0.0; 2], pocket.end), self.abc, true)
    }

    /// Once around, from the middle of the side towards the first axis.
    fn ring(&mut self, ring: &Ring, place: &HolePlace, level: f64, clockwise: bool) -> Result<(), NcProblem> {
        let sense = if clockwise { -1.0 } else { 1.0 };
        let Ring { core: [x, y], radius } = *ring;
        let point = |[a, b]: [f64; 2]| place.point([a, sense * b], level);
        self.line(point([x + radius, 0.0]), self.abc, false)?;
        // The four corners, as the ring comes to them.
        for (centre, [a, b]) in [
            ([x, y], [1.0, 0.0]),
            ([-x, y], [0.0, 1.0]),
            ([-x, -y], [-1.0, 0.0]),
            ([x, -y], [0.0, -1.0]),
        ] {
            let on = |[a, b]: [f64; 2]| point([centre[0] + radius * a, centre[1] + radius * b]);
            let (start, end) = (on([a, b]), on([-b, a]));
            if self.known() != Some(start) {
                self.line(start, self.abc, false)?;
            }
            if radius > 0.0 {
                let arc = Arc {
                    start,
                    end,
                    centre: point(centre),
                    normal: place.axes[2],
                    sweep: sense * TAU / 4.0,
                };
                self.arc(&arc, self.abc)?;
            }
        }
        self.line(point([x + radius, 0.0]), self.abc, false)
    }

    /// Goes around circles about the position in the plane XY, each smaller by the tool's radius: to each and back on semicircles towards +X.
    pub fn circles(&mut self, circles: &[f64], tool: f64, counter_clockwise: bool) -> Result<(), NcProblem> {
        let Some(centre) = self.known() else { return Ok(()) };
        let turn = if counter_clockwise { TAU } else { -TAU };
        let [x, y, z] = centre;
        let mut bow = |end: f64, centre: f64, sweep: f64| {
            let mut stroke = self.stroke([x + end, y, z], self.abc, false, None, [0, 1, 2]);
            let centre = [x + centre, y];
            stroke.bend = Some(Bend { centre, sweep });
            self.go(stroke)
        };
        let mut at = 0.0;
        for circle in circles.iter().map(|circle| circle - tool).chain([0.0]) {
            bow(circle, 0.5 * (at + circle), 0.5 * turn)?;
            if circle > 0.0 {
                bow(circle, 0.0, turn)?;
            }
            at = circle;
        }
        Ok(())
    }
}
