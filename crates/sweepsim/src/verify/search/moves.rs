//! The moves of a run that touch material.

use super::{Arena, Swept, Touch, Touching};
use crate::error::SweepError;
use crate::verify::lines::Lines;
use rayon::prelude::*;
use std::borrow::Cow;
use std::ops::Range;

/// So many moves are judged at a time: enough for any number of threads, few enough to hold the material before each.
const BLOCK: usize = 32;

/// A move that comes near material which was there before it.
pub(super) struct Suspect<'a> {
    pub number: usize,
    /// What there is on the lines that it comes near.
    pub material: Lines,
    /// What the move removes of these lines and others.
    pub eaten: Cow<'a, Swept>,
}

impl Arena<'_> {
    /// The moves of a run that touch `material`, so that nothing is missing that the run cuts by more than contact.
    ///
    /// Where a line is in the wall of a cutter between two moves, the first only touches it, but takes the material with it, and the second finds none. It is
    /// then put back for the second.
    pub fn all_touches(
        &mut self,
        touching: Touching,
        moves: Range<usize>,
        material: Lines,
        each: Option<&[Swept]>,
    ) -> Result<Vec<Touch>, SweepError> {
        let mut found = self.touches(touching, moves.clone(), material.clone(), each)?;
        if !(touching.own && touching.strict) {
            return Ok(found);
        }
        let run = touching.probe.slice(touching.probe.parts(moves.clone()));
        let cut = material.common(&self.swept(touching.probe, run, &material)?, self.options.tolerance);
        let left = found.iter().fold(cut, |left, touch| left.minus(&touch.all));
        let mut left = self.withstood(touching.probe, run, left.longer_than(self.options.tolerance))?;
        // Moves that are shorter than the tolerance do no more than touch.
        for strict in [true, false] {
            let touching = Touching {
                strict,
                eater: None,
                ..touching
            };
            for number in moves.clone() {
                let suspect = Suspect {
                    number,
                    material: left.near(self.grid, touching.probe.reaches(number)),
                    eaten: Cow::Owned(Swept::new()),
                };
                let more = if suspect.material.is_empty() {
                    None
                } else {
                    self.told_apart(touching, &suspect)?
                };
                let Some(more) = more else { continue };
                left = left.minus(&more.all);
                match found.iter_mut().find(|touch| touch.number == number) {
                    Some(touch) => touch.join(more),
                    None => found.push(more),
                }
            }
        }
        found.sort_by_key(|touch| touch.number);
        Ok(found)
    }

    /// The moves of a run that touch `material`, all that there is on some lines before the run, in their order.
    ///
    /// `each`: what the eater sweeps in each move of the run, if it is known for all lines.
    pub fn touches(
        &mut self,
        touching: Touching,
        moves: Range<usize>,
        mut material: Lines,
        each: Option<&[Swept]>,
    ) -> Result<Vec<Touch>, SweepError> {
        let mut found = Vec::new();
        let numbers: Vec<usize> = moves.clone().collect();
        for block in numbers.chunks(BLOCK) {
            if material.is_empty() {
                break;
            }
            let eaten = match (touching.eater, each) {
                (None, _) => vec![Cow::Owned(Swept::new()); block.len()],
                (Some(_), Some(each)) => block.iter().map(|n| Cow::Borrowed(&each[n - moves.start])).collect(),
                (Some(eater), None) => self.each(block, |arena, &number| {
                    let near = material.near(arena.grid, eater.reaches(number));
                    let parts = eater.slice(eater.parts(number..number + 1));
                    arena.swept(eater, parts, &near).map(Cow::Owned)
                })?,
            };
            let mut suspects = Vec::with_capacity(block.len());
            for (number, eaten) in block.iter().zip(eaten) {
                let near = material.near(self.grid, touching.probe.reaches(*number));
                material.remove(&eaten);
                if !near.is_empty() {
                    suspects.push(Suspect {
                        number: *number,
                        material: near,
                        eaten,
                    });
                }
            }
            let judged = self.each(&suspects, |arena, suspect| arena.told_apart(touching, suspect))?;
            found.extend(judged.into_iter().flatten());
        }
        Ok(found)
    }

    /// Judges a move, and whether the solid itself touches or only a larger one about it.
    fn told_apart(&mut self, touching: Touching, suspect: &Suspect) -> Result<Option<Touch>, SweepError> {
        let found = self.judged(touching, suspect)?;
        let (Some(found), Some(itself)) = (&found, touching.itself) else {
            return Ok(found);
        };
        let own = Touching {
            probe: itself,
            itself: None,
            ..touching
        };
        let touch = self.judged(own, suspect)?;
        let near = Touch {
            near: true,
            ..found.clone()
        };
        Ok(touch.or(Some(near)))
    }

    /// The same for each item, on all threads, with the results in order.
    fn each<I: Sync, T: Send>(
        &mut self,
        items: &[I],
        work: impl Fn(&mut Arena, &I) -> Result<T, SweepError> + Sync,
    ) -> Result<Vec<T>, SweepError> {
        let (place, options, monitor) = ((self.grid, self.top), self.options, self.monitor);
        let done: Vec<_> = items
            .par_iter()
            .with_max_len(1)
            .map(|item| {
                let mut arena = Arena::new(place, options, monitor);
                let result = work(&mut arena, item)?;
                Ok((result, arena.unresolved, arena.undecided))
            })
            .collect::<Result<_, SweepError>>()?;
        let mut results = Vec::with_capacity(done.len());
        for (result, unresolved, undecided) in done {
            results.push(result);
            self.unresolved.extend(unresolved);
            self.undecided.extend(undecided);
        }
        Ok(results)
    }
}
