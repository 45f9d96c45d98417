//! Slots along an arc: a control says in its own words where it is, and the moves are made here, as in [`pockets`](super::pockets).

use std::f64::consts::TAU;

use super::holes::HolePlace;
use super::pockets::Pocket;
use crate::drive::circular_arc::Arc;
use crate::drive::track::Track;
use crate::text::error::NcProblem;

/// A slot whose middle line is an arc about a point.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ArcSlot {
    /// Its levels, feeds, tool and step; `half[1]` is half of its width, `aside` the middle of the arc from where the cycle is called.
    pub pocket: Pocket,
    /// The radius of the middle line.
    pub radius: f64,
    /// Where it begins and how long it is, in degrees.
    pub first: f64,
    pub long: f64,
}

impl Track {
    pub(super) fn arc_slot(&mut self, slot: &ArcSlot, here: HolePlace) -> Result<(), NcProblem> {
        let ArcSlot { pocket, radius, .. } = slot;
        let width = pocket.half[1];
        if !(*radius > width && slot.long > 0.0 && slot.long < 360.0) {
            return Err(NcProblem::value(
                "a circular slot",
                format!("{} degrees long at a radius of {radius} mm", slot.long),
                "less than a turn, at a radius of more than half of its width",
            ));
        }
        let rings = pocket.rings()?;
        let levels = pocket.levels()?;
        let place = HolePlace {
            origin: here.point(pocket.aside, 0.0),
            axes: here.axes,
        };
        let [first, long] = [slot.first, slot.long].map(f64::to_radians);
        let at = |angle: f64, out: f64| [(radius + out) * angle.cos(), (radius + out) * angle.sin()];
        let modal = self.feed;
        self.line(here.point([0.0; 2], pocket.start), self.abc, true)?;
        self.line(place.point(at(first, 0.0), pocket.start), self.abc, true)?;
        let mut back = false;
        for level in levels {
            self.feed = pocket.plunge.or(pocket.feed).or(modal);
            let (from, sweep) = if back { (first + long, -long) } else { (first, long) };
            self.line(place.point(at(from, 0.0), level), self.abc, false)?;
            self.feed = pocket.feed.or(modal);
            // Along the middle, then around it on each ring.
            let (end, turn) = (from + sweep, 0.5 * TAU * sweep.signum());
            self.bow(&place, level, ([0.0; 2], at(end, 0.0)), sweep)?;
            for ring in rings.iter().map(|ring| ring.radius).filter(|ring| *ring > 0.0) {
                self.line(place.point(at(end, ring), level), self.abc, false)?;
                self.bow(&place, level, (at(end, 0.0), at(end, -ring)), turn)?;
                self.bow(&place, level, ([0.0; 2], at(from, -ring)), -sweep)?;
                self.bow(&place, level, (at(from, 0.0), at(from, ring)), turn)?;
                self.bow(&place, level, ([0.0; 2], at(end, ring)), sweep)?;
            }
            back = !back;
            self.line(place.point(at(end, 0.0), level), self.abc, false)?;
        }
        let angle = if back { first + long } else { first };
        self.line(place.point(at(angle, 0.0), pocket.end), self.abc, true)?;
        self.feed = modal;
        self.line(here.point([0.0; 2], pocket.end), self.abc, true)
    }

    /// An arc from here about a centre of the place, to a point there.
    fn bow(
        &mut self,
        place: &HolePlace,
        level: f64,
        (centre, end): ([f64; 2], [f64; 2]),
        sweep: f64,
    ) -> Result<(), NcProblem> {
        let Some(start) = self.known() else { return Ok(()) };
        let arc = Arc {
            start,
            end: place.point(end, level),
            centre: place.point(centre, level),
            normal: place.axes[2],
            sweep,
        };
        self.arc(&arc, self.abc)
    }
}
