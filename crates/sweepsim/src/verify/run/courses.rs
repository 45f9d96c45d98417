//! Rapids that only come near material, and rapids on other courses.

use super::Question;
use crate::error::SweepError;
use crate::sweep::UnresolvedDexel;
use crate::sweep::heights::HeightMap;
use crate::verify::driver::{Solids, Work};
use crate::verify::finding::{Finding, FindingKind, RapidCourses};
use crate::verify::lines::Lines;
use crate::verify::record::TileFinding;
use crate::verify::scene::ToolPath;
use crate::verify::search::{Arena, Touch, Touching};
use crate::verify::solid::MovingSolid;
use std::ops::Range;
use sweepsim_dexel::Dexels;
use sweepsim_motion::{Assembly, OtherCourse, Path, Pose};

impl Work<'_> {
    /// Rapids in which a cutter taken larger meets material, beside those in `seen..` in which the cutter itself does.
    pub(super) fn near_rapids(
        &mut self,
        question: Question,
        toolpath: &ToolPath,
        solids: &Solids,
        moves: Range<usize>,
        seen: usize,
    ) -> Result<(), SweepError> {
        let (Some(larger), Some(assembly)) = (&solids.larger, toolpath.larger) else {
            return Ok(());
        };
        if assembly.cutter().bounding_cylinder() == toolpath.assembly.cutter().bounding_cylinder() {
            return Ok(());
        }
        let grid = *self.remaining.grid();
        let mut material = self.near_stock(&larger.cutter, moves.clone());
        // Out of what it has cut, along its axis.
        let start = toolpath.path.pose(moves.start);
        material = self.without_withdrawal(&larger.cutter, assembly, &start, material)?;
        let question = Question {
            touching: Touching {
                probe: &larger.cutter,
                ..question.touching
            },
            ..question
        };
        let mut arena = Arena::new((&grid, self.top()), &self.options, self.monitor);
        let parts = larger.cutter.slice(larger.cutter.parts(moves.clone()));
        let swept = arena.swept(&larger.cutter, parts, &material)?;
        self.unresolved.extend(arena.unresolved);
        let met = material.common(&swept, self.options.tolerance);
        let met = self.more_than_contact(&grid, question, moves.clone(), met)?;
        let before = self.done.findings.len();
        self.locate(&grid, question, moves, material.on_lines_of(&met), None)?;
        let near = self.done.findings.split_off(before);
        let own: Vec<usize> = self.done.findings[seen..]
            .iter()
            .filter(|own| own.finding.kind == FindingKind::Rapid)
            .map(|own| own.finding.number)
            .collect();
        for mut own_near in near {
            if !own.contains(&own_near.finding.number) {
                own_near.finding.near = true;
                self.done.findings.push(own_near);
            }
        }
        Ok(())
    }

    /// The material that a cutter does not meet on its way out of the stock along its axis.
    fn without_withdrawal(
        &self,
        cutter: &MovingSolid,
        larger: &Assembly,
        start: &Pose,
        material: Lines,
    ) -> Result<Lines, SweepError> {
        let grid = self.remaining.grid();
        let whole = grid.whole();
        let ends = material.0.iter().flat_map(|(_, heights)| heights.iter().flatten());
        let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| {
            (low.min(*z), high.max(*z))
        });
        let bound = larger.cutter().bounding_cylinder();
        let (tip, axis) = (start.tip(), start.axis());
        // Beyond all material, wherever it starts: also from beside this tile.
        let from = grid.frame().from_world(tip);
        let size = [0, 1].map(|k| whole.max()[k] - whole.min()[k]);
        let far = [0, 1].map(|k| {
            size[k]
                .max((from[k] - whole.min()[k]).abs())
                .max((whole.max()[k] - from[k]).abs())
        });
        let up = (high - low).max((from[2] - low).abs()).max((high - from[2]).abs());
        let length = far[0].hypot(far[1]).hypot(up) + bound.radius + bound.z[1] - bound.z[0];
        let out = std::array::from_fn(|k| tip[k] + length * axis[k]);
        let (Ok(end), true) = (Pose::new(out, axis), length.is_finite()) else {
            return Ok(material);
        };
        let Ok(path) = Path::new(vec![*start, end]) else {
            return Ok(material);
        };
        let solid = cutter.along(&path, grid, &self.options)?;
        let mut arena = Arena::new((grid, self.top()), &self.options, self.monitor);
        let swept = arena.swept(&solid, solid.slice(solid.parts(0..1)), &material)?;
        Ok(material.without(&swept).longer_than(self.options.tolerance))
    }

    /// Judges moves of a run on their other courses, and tells which of the courses do harm in the findings `seen..`.
    pub(super) fn judge_other_courses(
        &mut self,
        path: usize,
        toolpath: &ToolPath,
        solids: &Solids,
        moves: Range<usize>,
        seen: usize,
    ) -> Result<(), SweepError> {
        let Some(courses) = toolpath.other_courses else {
            return Ok(());
        };
        for own in &mut self.done.findings[seen..] {
            // Gouges are not looked for on other courses.
            let own = &mut own.finding;
            if own.kind != FindingKind::Gouge && courses.has(own.number) {
                own.courses = Some(RapidCourses::Own);
            }
        }
        for course in courses.of(moves.clone()) {
            let (mut found, mut unresolved) = (Vec::new(), Vec::new());
            let solids = solids.along(&course.path, self)?;
            for (body, probe, itself) in solids.probes() {
                let kind = if body.is_some() {
                    FindingKind::Collision
                } else {
                    FindingKind::Rapid
                };
                // A cutter that is taken larger leaves what it has cut.
                let (probe, itself) = match (body, itself) {
                    (None, Some(itself)) => (itself, None),
                    _ => (probe, itself),
                };
                let question = Question {
                    path,
                    kind,
                    body,
                    touching: Touching::still(probe, itself),
                };
                let place = (&self.remaining, &self.heights);
                found.extend(self.on_course(question, &course, place, &mut unresolved)?);
            }
            if let Some((fixtures, heights)) = &self.fixtures {
                for (body, probe, itself) in solids.probes() {
                    let question = Question {
                        path,
                        kind: FindingKind::Fixture,
                        body,
                        touching: Touching::still(probe, itself),
                    };
                    found.extend(self.on_course(question, &course, (fixtures, heights), &mut unresolved)?);
                }
            }
            self.unresolved.extend(unresolved);
            self.merge(course.number, seen, found);
        }
        Ok(())
    }

    fn on_course(
        &self,
        question: Question,
        course: &OtherCourse,
        (material, heights): (&Dexels, &HeightMap),
        unresolved: &mut Vec<UnresolvedDexel>,
    ) -> Result<Option<TileFinding>, SweepError> {
        let (grid, probe) = (*material.grid(), question.touching.probe);
        let moves = 0..course.path.moves();
        let swept = probe.swept_near(moves.clone(), (&grid, self.top()), heights, &self.options, self.monitor)?;
        if swept.lines.is_empty() {
            unresolved.extend(swept.unresolved);
            return Ok(None);
        }
        let material = Lines::of(material, swept.lines.iter().map(|(line, _)| *line));
        let mut arena = Arena::new((&grid, self.top()), &self.options, self.monitor);
        let met = material.common(&swept.lines, self.options.tolerance);
        let met = arena.certified(probe, probe.slice(probe.parts(moves.clone())), met)?;
        let touches = arena.touches(question.touching, moves, material.on_lines_of(&met), None)?;
        unresolved.extend(swept.unresolved.into_iter().chain(arena.unresolved));
        // What only comes near is not what is touched later.
        let first = touches.iter().find(|touch| !touch.near).or(touches.first());
        Ok(first.map(|first| {
            let share = |k: usize| course.times.get(k).copied().unwrap_or(1.0);
            let begin = first.number.checked_sub(1).map_or(0.0, share);
            let touch = Touch {
                number: course.number,
                time: begin + first.time * (share(first.number) - begin),
                ..first.clone()
            };
            self.finding(&grid, question, &touch)
        }))
    }

    /// Adds what is found on the other course of a move.
    fn merge(&mut self, number: usize, seen: usize, found: Vec<TileFinding>) {
        for mut other in found {
            other.finding.courses = Some(RapidCourses::Other);
            let harm = |of: &Finding| (of.number, of.kind, of.body);
            let own = self.done.findings[seen..]
                .iter_mut()
                .find(|own| harm(&own.finding) == (number, other.finding.kind, other.finding.body));
            match own {
                Some(own) if own.finding.near == other.finding.near => own.finding.courses = Some(RapidCourses::Both),
                Some(own) if own.finding.near => *own = other,
                Some(_) => {}
                None => self.done.findings.push(other),
            }
        }
    }
}
