//! The search for the time at which a move first touches material.
//!
//! Lines are independent of each other, so the first time of all is the least of theirs. The time of one line is found by halving, with sweeps over that
//! line alone, until no point of the solid moves farther than the tolerance. One sweep of the move's part before that time then tells which lines are
//! touched earlier, if any: one of them is next. Since each such line drops about half of the others, few are needed.
//!
//! A body may touch material that its own move removes later. What the whole move leaves is treated as above; it bounds the time within which the rest,
//! material that shrinks meanwhile, has to be looked at.

use super::moves::Suspect;
use super::{Arena, Swept, Touch, Touching};
use crate::error::SweepError;
use crate::verify::lines::Lines;

/// The largest number of halves that the search in one move examines.
const MOST_WINDOWS: usize = 4096;
/// So many lines tell whether a collision goes on from the move before.
const FEW: usize = 4;
/// The most lines whose own times are found, before all that are left are looked at together.
const MOST_LINES: usize = 12;

impl Arena<'_> {
    /// Whether, when and where a move touches material.
    pub(super) fn judged(&mut self, touching: Touching, suspect: &Suspect) -> Result<Option<Touch>, SweepError> {
        let Suspect {
            number,
            material,
            eaten,
        } = suspect;
        let number = *number;
        let parts = touching.probe.slice(touching.probe.parts(number..number + 1));
        let removes = touching.eater.is_some_and(|eater| std::ptr::eq(eater, touching.probe));
        let met = if touching.own && removes {
            let common = material.common(eaten, self.options.tolerance);
            if touching.strict {
                self.confirmed(touching.probe, parts, common)?
            } else {
                common
            }
        } else {
            self.overlap(touching.probe, parts, material, touching.strict)?
        };
        if met.is_empty() {
            return Ok(None);
        }
        let material = material.on_lines_of(&met);
        if touching.own || touching.eater.is_none() {
            let (time, first) = match self.met_at_once(touching, number, &material, &met)? {
                Some(first) => (0.0, first),
                None => self.first_of_static(touching, number, &material, met.clone(), 1.0)?,
            };
            let all = met;
            return Ok(Some(Touch {
                number,
                time,
                first,
                near: false,
                stays: true,
                all,
            }));
        }
        self.judged_shrinking(touching, number, (&material, eaten), &met)
    }

    fn judged_shrinking(
        &mut self,
        touching: Touching,
        number: usize,
        (material, eaten): (&Lines, &Swept),
        met: &Lines,
    ) -> Result<Option<Touch>, SweepError> {
        let mut left = met.without(eaten).longer_than(self.options.tolerance);
        let stays = material.without(eaten);
        let mut found = None;
        if !left.is_empty() {
            let at_once = self.met_at_once(touching, number, &stays.on_lines_of(&left), &left)?;
            found = at_once.map(|first| (0.0, first));
        }
        if found.is_none() && !left.is_empty() {
            let parts = touching.probe.slice(touching.probe.parts(number..number + 1));
            left = self.certified(touching.probe, parts, left)?;
            if !left.is_empty() {
                found = Some(self.first_of_static(touching, number, &stays.on_lines_of(&left), left.clone(), 1.0)?);
            }
        }
        // Until then only what the move removes itself can be in the way.
        let end = found.as_ref().map_or(1.0, |(time, _)| *time);
        let shrinks = material.minus(&stays);
        if let Some(earlier) = self.first_of_shrinking(touching, number, &shrinks, end, found.is_some())? {
            found = Some(earlier);
        }
        let Some((time, first)) = found else { return Ok(None) };
        let stays = !left.is_empty();
        let all = if stays { left } else { first.clone() };
        Ok(Some(Touch {
            number,
            time,
            first,
            near: false,
            stays,
            all,
        }))
    }

    /// The first time before `end` at which a move meets material that nothing removes, given what it meets.
    fn first_of_static(
        &mut self,
        touching: Touching,
        number: usize,
        material: &Lines,
        mut met: Lines,
        mut end: f64,
    ) -> Result<(f64, Lines), SweepError> {
        for _ in 0..MOST_LINES {
            // The deepest overlap is likely to be an early one.
            let Some((line, _)) = met.longest() else { break };
            let own = met.of_line(line);
            let (time, first) = self.halved(touching, number, &material.of_line(line), own, end)?;
            let parts = touching.probe.within(number, [0.0, time]);
            let others = material.on_lines_of(&met).without_line(line);
            if parts.is_empty() || others.is_empty() {
                return Ok((time, first));
            }
            met = self.overlap(touching.probe, &parts, &others, touching.strict)?;
            if met.is_empty() {
                return Ok((time, first));
            }
            end = time;
        }
        let material = material.on_lines_of(&met);
        self.halved(touching, number, &material, met, end)
    }

    /// What is met before any point of the solid moves farther than the tolerance: where a collision goes on from the move before, some of the deepest
    /// lines.
    fn met_at_once(
        &mut self,
        touching: Touching,
        number: usize,
        material: &Lines,
        met: &Lines,
    ) -> Result<Option<Lines>, SweepError> {
        let tolerance = self.options.tolerance;
        let travel = touching.probe.travel(&touching.probe.within(number, [0.0, 1.0]));
        let mut end = f64::min(1.0, 0.5 * tolerance / travel);
        let mut parts = touching.probe.within(number, [0.0, end]);
        while touching.probe.travel(&parts) > tolerance {
            end *= 0.5;
            parts = touching.probe.within(number, [0.0, end]);
        }
        if parts.is_empty() {
            return Ok(None);
        }
        let deepest = material.on_lines_of(&met.deepest(FEW));
        let first = self.overlap(touching.probe, &parts, &deepest, touching.strict)?;
        Ok(Some(first).filter(|first| !first.is_empty()))
    }

    /// The same by halving the time, for all lines together.
    fn halved(
        &mut self,
        touching: Touching,
        number: usize,
        material: &Lines,
        met: Lines,
        end: f64,
    ) -> Result<(f64, Lines), SweepError> {
        let (mut window, mut first) = ([0.0, end], met);
        let mut material = material.clone();
        loop {
            let middle = 0.5 * (window[0] + window[1]);
            let parts = touching.probe.within(number, [window[0], middle]);
            if touching.probe.travel(&touching.probe.within(number, window)) <= self.options.tolerance
                || parts.is_empty()
                || middle <= window[0]
            {
                return Ok((window[0], first));
            }
            let met = self.overlap(touching.probe, &parts, &material, touching.strict)?;
            if met.is_empty() {
                window[0] = middle;
            } else {
                material = material.on_lines_of(&met);
                (window[1], first) = (middle, met);
            }
        }
    }

    /// The first time before `end` at which a move meets material that is removed while it goes. `found`: whether it is known to touch other
    /// material at `end`, so that it is not undecided if the budget ends.
    fn first_of_shrinking(
        &mut self,
        touching: Touching,
        number: usize,
        material: &Lines,
        end: f64,
        found: bool,
    ) -> Result<Option<(f64, Lines)>, SweepError> {
        // Windows still to look at, the earliest on top; `before` is what is left at the beginning of the one on top.
        let mut open: Vec<[f64; 2]> = vec![[0.0, end]];
        let mut before = material.clone();
        let mut seen = 0;
        while let Some(window) = open.pop() {
            seen += 1;
            if before.is_empty() {
                break;
            }
            if seen > MOST_WINDOWS {
                if !found {
                    self.undecided.push(number);
                }
                return Ok(None);
            }
            let parts = touching.probe.within(number, window);
            if parts.is_empty() {
                continue;
            }
            let met = self.overlap(touching.probe, &parts, &before, touching.strict)?;
            let middle = 0.5 * (window[0] + window[1]);
            let short = touching.probe.travel(&parts) <= self.options.tolerance || middle <= window[0];
            if !met.is_empty() && !short {
                open.extend([[middle, window[1]], [window[0], middle]]);
                continue;
            }
            if let Some(eater) = touching.eater {
                let eaten = self.swept(eater, &eater.within(number, window), &before)?;
                let left = met.without(&eaten).longer_than(self.options.tolerance);
                if !left.is_empty() {
                    return Ok(Some((window[0], left)));
                }
                before = before.without(&eaten);
            }
        }
        Ok(None)
    }
}
