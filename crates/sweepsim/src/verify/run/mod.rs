//! One run of moves: what it touches, and what it removes.

mod courses;
mod removal;

use crate::error::SweepError;
use crate::verify::depth::{SurfaceSide, greatest};
use crate::verify::driver::{Solids, Work};
use crate::verify::finding::{Finding, FindingKind};
use crate::verify::lines::Lines;
use crate::verify::record::TileFinding;
use crate::verify::scene::ToolPath;
use crate::verify::search::{Arena, Swept, Touch, Touching};
use crate::verify::solid::MovingSolid;
use rayon::prelude::*;
use std::ops::Range;
use sweepsim_dexel::Grid;

/// So many lines tell whether a body runs through material at large.
const SAMPLE: usize = 24;

/// What is looked for in a run.
#[derive(Clone, Copy)]
struct Question<'a> {
    path: usize,
    kind: FindingKind,
    body: Option<usize>,
    touching: Touching<'a>,
}

impl Work<'_> {
    /// Judges a run of moves, then removes what it cuts.
    pub(super) fn run(
        &mut self,
        path: usize,
        toolpath: &ToolPath,
        solids: &Solids,
        moves: Range<usize>,
    ) -> Result<(), SweepError> {
        let seen = self.done.findings.len();
        self.judge_fixtures(path, solids, moves.clone())?;
        // What each move sweeps, if anything needs it.
        let mut each = None;
        if self.each_move {
            each = Some(self.swept_by_each(solids, moves.clone())?);
        }
        for (body, probe, itself) in solids.probes().filter(|(body, ..)| body.is_some()) {
            let touching = Touching {
                probe,
                eater: Some(&solids.cutter),
                own: false,
                strict: true,
                itself,
            };
            let kind = FindingKind::Collision;
            let question = Question {
                path,
                kind,
                body,
                touching,
            };
            self.judge_near_stock(question, solids, moves.clone(), &mut each)?;
        }
        let cut = self.sweep_near_stock(&solids.cutter, moves.clone())?;
        let cutting = |kind, strict| Question {
            path,
            kind,
            body: None,
            touching: Touching {
                probe: &solids.cutter,
                eater: Some(&solids.cutter),
                own: true,
                strict,
                itself: None,
            },
        };
        let grid = *self.remaining.grid();
        if let Some(kind) = toolpath.state(moves.start).forbids_cutting() {
            let question = cutting(kind, true);
            let stock = Lines::of(&self.remaining, cut.iter().map(|(line, _)| *line));
            let common = stock.common(&cut, self.options.tolerance);
            let met = self.more_than_contact(&grid, question, moves.clone(), common)?;
            self.locate(&grid, question, moves.clone(), stock.on_lines_of(&met), each.as_deref())?;
            if kind == FindingKind::Rapid {
                self.near_rapids(question, toolpath, solids, moves.clone(), seen)?;
            }
        }
        if let Some(target) = self.target {
            // Only where the target's core is, and where there still is material.
            let stock = Lines::of(&self.remaining, cut.iter().map(|(line, _)| *line));
            let core = Lines::of(target.core(), stock.numbers());
            let material = stock.intersection(&core, self.options.tolerance);
            let met = material.common(&cut, self.options.tolerance);
            let question = cutting(FindingKind::Gouge, false);
            self.locate(
                &grid,
                question,
                moves.clone(),
                material.on_lines_of(&met),
                each.as_deref(),
            )?;
        }
        self.judge_other_courses(path, toolpath, solids, moves.clone(), seen)?;
        if let Some(each) = &each
            && self.each_move
        {
            self.each_move(path, solids, moves, &cut, each);
        }
        self.remove(path, &cut);
        Ok(())
    }

    /// All material of the stock on the lines that a solid comes near.
    fn near_stock(&self, solid: &MovingSolid, moves: Range<usize>) -> Lines {
        let near = solid.near(moves, self.remaining.grid(), &self.heights);
        let mut lines: Vec<u32> = near.into_iter().flat_map(|(_, lines)| lines).collect();
        lines.sort_unstable();
        lines.dedup();
        Lines::of(&self.remaining, lines.into_iter())
    }

    /// Looks for collisions of a body with the stock.
    fn judge_near_stock(
        &mut self,
        question: Question,
        solids: &Solids,
        moves: Range<usize>,
        each: &mut Option<Vec<Swept>>,
    ) -> Result<(), SweepError> {
        let grid = *self.remaining.grid();
        let body = question.touching.probe;
        let material = self.near_stock(body, moves.clone());
        // Where a few lines show that the body runs through material at large, a sweep of the whole run would only tell so once more.
        let sample = material.sample(SAMPLE);
        let mut arena = Arena::new((&grid, self.top()), &self.options, self.monitor);
        let met = arena.overlap(body, body.slice(body.parts(moves.clone())), &sample, true)?;
        let material = if met.is_empty() {
            let swept = self.sweep_near_stock(body, moves.clone())?;
            let met = material.common(&swept, self.options.tolerance);
            let met = self.more_than_contact(&grid, question, moves.clone(), met)?;
            material.on_lines_of(&met)
        } else {
            if each.is_none() {
                *each = Some(self.swept_by_each(solids, moves.clone())?);
            }
            material
        };
        self.locate(&grid, question, moves, material, each.as_deref())
    }

    /// What a solid sweeps of the lines whose material it comes near.
    fn sweep_near_stock(&mut self, solid: &MovingSolid, moves: Range<usize>) -> Result<Swept, SweepError> {
        let grid = *self.remaining.grid();
        let swept = solid.swept_near(moves, (&grid, self.top()), &self.heights, &self.options, self.monitor)?;
        self.unresolved.extend(swept.unresolved);
        self.crossings += swept.crossings;
        Ok(swept.lines)
    }

    fn judge_fixtures(&mut self, path: usize, solids: &Solids, moves: Range<usize>) -> Result<(), SweepError> {
        let Some((fixtures, heights)) = &self.fixtures else {
            return Ok(());
        };
        let fixtures = *fixtures;
        let grid = *fixtures.grid();
        let mut met = Vec::new();
        for (body, probe, itself) in solids.probes() {
            let swept = probe.swept_near(moves.clone(), (&grid, self.top()), heights, &self.options, self.monitor)?;
            met.push((body, probe, itself, swept));
        }
        for (body, probe, itself, swept) in met {
            self.unresolved.extend(swept.unresolved);
            let material = Lines::of(fixtures, swept.lines.iter().map(|(line, _)| *line));
            let touched = material.common(&swept.lines, self.options.tolerance);
            let question = Question {
                path,
                kind: FindingKind::Fixture,
                body,
                touching: Touching::still(probe, itself),
            };
            let touched = self.more_than_contact(&grid, question, moves.clone(), touched)?;
            self.locate(&grid, question, moves.clone(), material.on_lines_of(&touched), None)?;
        }
        Ok(())
    }

    /// What a run meets, unless all of it is contact.
    fn more_than_contact(
        &mut self,
        grid: &Grid,
        question: Question,
        moves: Range<usize>,
        met: Lines,
    ) -> Result<Lines, SweepError> {
        let probe = question.touching.probe;
        let mut arena = Arena::new((grid, self.top()), &self.options, self.monitor);
        let met = arena.certified(probe, probe.slice(probe.parts(moves)), met)?;
        self.unresolved.extend(arena.unresolved);
        Ok(met)
    }

    /// Finds the moves that touch `material`, all there is on some lines.
    fn locate(
        &mut self,
        grid: &Grid,
        question: Question,
        moves: Range<usize>,
        material: Lines,
        each: Option<&[Swept]>,
    ) -> Result<(), SweepError> {
        let mut arena = Arena::new((grid, self.top()), &self.options, self.monitor);
        let touches = arena.all_touches(question.touching, moves, material, each)?;
        self.unresolved.extend(arena.unresolved);
        let undecided = arena.undecided.into_iter();
        let undecided = undecided.map(|number| (question.path, number, question.body));
        self.done.undecided.extend(undecided);
        let found: Vec<TileFinding> = touches
            .par_iter()
            .map(|touch| self.finding(grid, question, touch))
            .collect();
        self.done.findings.extend(found);
        Ok(())
    }

    fn finding(&self, grid: &Grid, question: Question, touch: &Touch) -> TileFinding {
        let Question { path, kind, body, .. } = question;
        let [dx, dy] = grid.spacing();
        let (line, heights) = touch.first.longest().unwrap_or((0, [0.0; 2]));
        let (i, j) = grid.place(line as usize);
        let middle = 0.5 * (heights[0] + heights[1]);
        let depth = match (kind, self.target) {
            (FindingKind::Gouge, Some(target)) => greatest(&touch.all, grid, target.distance(), SurfaceSide::Inside).0,
            _ => touch.all.longest().map_or(0.0, |(_, [lower, upper])| upper - lower),
        };
        let finding = Finding {
            kind,
            path,
            number: touch.number,
            body,
            time: touch.time,
            place: grid.frame().to_world([grid.x(i), grid.y(j), middle]),
            depth,
            volume: touch.all.length() * dx * dy,
            near: touch.near,
            courses: None,
        };
        TileFinding {
            finding,
            stays: touch.stays,
        }
    }
}
