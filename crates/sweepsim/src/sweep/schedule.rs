//! Distributes the work of a sweep among threads: which lines meet which parts of the path.

use crate::cutter::Cutter;
use crate::cutter::outline::Outline;
use crate::envelope::Size;
use crate::error::SweepError;
use crate::methods::charts::Charts;
use crate::methods::harvest::Collector;
use crate::methods::harvest::{Gathered, Harvest, Numbered};
use crate::methods::lattice::Lattice;
use crate::methods::lattice::LineMask;
use crate::methods::lines::Lines;
use crate::methods::method::CrossingMethod;
use crate::methods::planes::Planes;
use crate::methods::search::{Ceiling, Search};
use crate::methods::surface::Surfaces;
use crate::methods::workspace::Workspace;
use crate::repair_budget::RepairBudget;
use crate::sweep::boundary_operator::BoundaryOperator;
use crate::sweep::options::{Method, Options};
use crate::sweep::plan::Plan;
use crate::sweep::short_tools::ShortTool;
use crate::sweep::spare::{Spaces, SpareLists};
use crate::time::bent::bent;
use crate::time::over::Over;
use crate::time::path_parts::PathPart;
use crate::tolerances::Tolerances;
use rayon::prelude::*;
use std::borrow::Cow;
use std::sync::Arc;
use sweepsim_dexel::Grid;
use sweepsim_motion::Tool;
use sweepsim_solve::Monitor;

/// The number of segments whose crossings are counted together. Longer chunks save caps, shorter ones save memory.
pub(crate) const CHUNK: usize = 256;

/// Lines are displaced for closed forms, too, up to this attempt: mostly, one was too close to an end of a curve. In the last of them, charts have to do for the parts in which closed forms leave a line open, since what these
/// cannot tell may be wider than lines are displaced. After that, they have to do for all.
const IN_CLOSED_FORM: usize = 3;

impl Plan {
    /// `parts`: the number of parts of which repairs may become necessary.
    pub(crate) fn job<'a>(
        &'a self,
        (tool, parts): (&'a Tool, usize),
        grid: &'a Grid,
        options: &Options,
        monitor: &'a dyn Monitor,
    ) -> SweepJob<'a> {
        SweepJob {
            tool,
            cutter: &self.cutter,
            grid,
            tolerances: self.tolerances,
            method: options.method,
            boundary: options.boundary,
            path: options.path_number,
            mask: None,
            ceiling: None,
            size: Size {
                spacing: grid.spacing(),
                system_rounding: self.tolerances.rounding(),
            },
            spaces: Arc::clone(&self.spaces),
            lists: Arc::clone(&self.lists),
            repairs: Arc::new(RepairBudget::new(parts)),
            monitor,
        }
    }
}

/// What all chunks of a sweep share.
pub(crate) struct SweepJob<'a> {
    pub tool: &'a Tool,
    pub cutter: &'a Cutter,
    pub grid: &'a Grid,
    pub tolerances: Tolerances,
    pub method: Method,
    pub boundary: BoundaryOperator,
    pub path: u32,
    /// The lines that are asked for; `None` if all are.
    pub mask: Option<Cow<'a, LineMask>>,
    /// A height above which crossings are not wanted.
    pub ceiling: Option<Ceiling>,
    pub size: Size,
    /// What repairs may cost.
    pub repairs: Arc<RepairBudget>,
    pub spaces: Spaces,
    pub lists: SpareLists,
    pub monitor: &'a dyn Monitor,
}

impl<'a> SweepJob<'a> {
    /// The same work with the tool cut off.
    pub fn with_tool(&self, short: &'a ShortTool) -> Self {
        Self {
            tool: &short.tool,
            cutter: short.cutter(),
            mask: None,
            ceiling: None,
            spaces: Arc::clone(&short.spaces),
            lists: Arc::clone(&self.lists),
            repairs: Arc::clone(&self.repairs),
            ..*self
        }
    }
}

impl SweepJob<'_> {
    /// The meridian of the tool, if closed forms are wanted.
    fn outline(&self) -> Option<&Outline> {
        self.cutter.outline.as_ref().filter(|_| self.method == Method::Mixed)
    }

    /// Runs `work` with a workspace.
    pub fn with_space<T>(&self, work: impl FnOnce(&mut Workspace) -> T) -> T {
        let kept = self.spaces.lock().ok().and_then(|mut spaces| {
            let like = spaces.iter().rposition(|space| space.tolerances == self.tolerances)?;
            Some(spaces.swap_remove(like))
        });
        let mut space = kept.unwrap_or_else(|| Workspace::new(self.cutter, self.tolerances));
        let result = work(&mut space);
        if let Ok(mut spaces) = self.spaces.lock() {
            spaces.push(space);
        }
        result
    }

    /// A list of crossings: empty, perhaps with memory.
    fn list(&self) -> Vec<Numbered> {
        let kept = self.lists.lock().map(|mut lists| lists.pop()).unwrap_or_default();
        kept.unwrap_or_default()
    }

    /// Keeps the memory of lists of crossings.
    pub fn reuse(&self, lists: Vec<Vec<Numbered>>) {
        if let Ok(mut kept) = self.lists.lock() {
            kept.extend(lists.into_iter().map(|mut list| {
                list.clear();
                list
            }));
        }
    }

    /// All crossings of a chunk, in an order that does not depend on the number of threads.
    pub fn harvest(&self, chunk: &[PathPart]) -> Result<Gathered, SweepError> {
        match self.method {
            Method::Mixed | Method::General => self.by::<Charts>(chunk),
            Method::Lines => self.by::<Lines>(chunk),
            Method::Planes => self.by::<Planes>(chunk),
            Method::Surface => self.by::<Surfaces>(chunk),
        }
    }

    /// The tool, and the window of some lines.
    fn over(&self, lines: &Lattice) -> Over {
        Over {
            cylinder: self.tool.bounding_cylinder(),
            window: lines.window(),
            margin: self.size.system_rounding + 1e-6 * self.cutter.reach,
        }
    }

    fn search<'b>(&'b self, (parts, over): (&'b [PathPart], Over), lines: &'b Lattice<'b>) -> Search<'b> {
        Search {
            cutter: self.cutter,
            parts,
            over,
            lines,
            size: self.size,
            closed: false,
            outline: None,
            ceiling: None,
            height_tolerance: self.tolerances.same_height(),
            path: self.path,
            monitor: self.monitor,
        }
    }

    fn by<'c, M: CrossingMethod<'c>>(&'c self, chunk: &'c [PathPart]) -> Result<Gathered, SweepError> {
        let shift = self.tolerances.line_displacement(0);
        let all = Lattice::all(self.grid, shift).masked(self.mask.as_deref());
        if all.is_empty() {
            return Ok(Gathered::default());
        }
        let over = self.over(&all);
        let method = M::prepare(self.tool, chunk, &over);
        let found: Vec<Harvest> = M::shares(chunk.len(), self.grid.cells()[0])
            .into_par_iter()
            // One by one: left to itself, rayon hands out a few large pieces, and a thread that is done first waits.
            .with_max_len(1)
            .map(|share| {
                let lines = Lattice::columns(self.grid, share.columns, shift).masked(self.mask.as_deref());
                if lines.is_empty() {
                    return Harvest::default();
                }
                let search = Search {
                    closed: self.method == Method::Mixed,
                    outline: self.outline(),
                    ceiling: self.ceiling.as_ref(),
                    ..self.search((chunk, over), &lines)
                };
                let mut harvest = Harvest {
                    crossings: self.list(),
                    ..Harvest::default()
                };
                self.with_space(|space| {
                    for at in share.parts {
                        if self.monitor.cancelled() {
                            break;
                        }
                        search.part(&method, at, space, &mut harvest);
                    }
                });
                harvest
            })
            .collect();
        if self.monitor.cancelled() {
            return Err(SweepError::Cancelled);
        }
        let mut all = Gathered::default();
        for part in found {
            all.add(part);
        }
        if let Some(ceiling) = &self.ceiling {
            let lines = Lattice::all(self.grid, shift).masked(self.mask.as_deref());
            let mut harvest = Harvest::default();
            let mut collector = Collector {
                lines: &lines,
                harvest: &mut harvest,
            };
            ceiling.close(chunk, self.size.system_rounding, &mut collector);
            all.add(harvest);
        }
        Ok(all)
    }

    /// The crossings of some lines, displaced as in the given attempt. Ends when the search has examined `most` boxes, and returns whether it did not.
    pub fn again(
        &self,
        chunk: &[PathPart],
        lines: &[u32],
        (attempt, most): (usize, u64),
        space: &mut Workspace,
        harvest: &mut Harvest,
    ) -> bool {
        let shift = self.tolerances.line_displacement(attempt);
        let mask = LineMask::new(self.grid, lines.iter().copied());
        let lines = match lines {
            [line] => Lattice::one(self.grid, *line as usize, shift),
            _ => Lattice::all(self.grid, shift).masked(mask.as_ref()),
        };
        let over = self.over(&lines);
        let parts = bent(chunk, &self.tolerances, attempt);
        let by_charts = Search {
            closed: false,
            outline: None,
            ..self.search((&parts, over), &lines)
        };
        let search = Search {
            closed: self.method == Method::Mixed && attempt <= IN_CLOSED_FORM,
            outline: self.outline().filter(|_| attempt <= IN_CLOSED_FORM),
            ..by_charts.clone()
        };
        for at in 0..parts.len() {
            if self.monitor.cancelled() {
                break;
            }
            let (crossings, open) = (harvest.crossings.len(), harvest.open.len());
            search.part(&Charts, at, space, harvest);
            let in_both = attempt == IN_CLOSED_FORM && (search.closed || search.outline.is_some());
            if in_both && harvest.open.len() > open {
                harvest.crossings.truncate(crossings);
                harvest.open.truncate(open);
                by_charts.part(&Charts, at, space, harvest);
            }
            if harvest.statistics.boxes > most {
                return false;
            }
        }
        true
    }
}
