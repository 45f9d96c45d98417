//! The moves that come near material, in runs that are swept as one motion each, and the lines that they meet there.
//!
//! What a tool that stands along the lines does with its lowest point above all material is left out, also of moves that dive into it.

use super::heights::{Box3, HeightMap, window};
use crate::methods::lattice::LineMask;
use crate::methods::search::Ceiling;
use crate::methods::translation::{GAP, stands};
use crate::sweep::plan::Plan;
use crate::sweep::short_tools::ShortTool;
use crate::time::joined::push_joined;
use crate::time::path_parts::{PartKind, PathPart};
use crate::time::swept_box::swept_box;
use rayon::prelude::*;
use std::borrow::Cow;
use sweepsim_dexel::Grid;
use sweepsim_motion::Tool;

/// Parts of a path that are consecutive over a tile, and where they meet material.
///
/// Parts between them meet no line of the tile. Nor does the tool at either end of a gap, where it is at rest: so the run needs no
/// caps there, and its parts count as one motion.
pub(crate) struct Run<'a> {
    pub parts: Vec<PathPart>,
    /// How many parts over the tile lie before its end.
    pub done: usize,
    /// `None` if all lines near have some.
    pub mask: Option<Cow<'static, LineMask>>,
    /// A height above all material.
    pub ceiling: Option<Ceiling>,
    /// The tool cut off above all material, where there is no ceiling.
    pub short: Option<(usize, &'a ShortTool)>,
}

/// Boxes around all that a tool sweeps in each part of a path.
pub(crate) fn boxes(tool: &Tool, plan: &Plan) -> Vec<Box3> {
    let cylinder = tool.bounding_cylinder();
    let margin = plan.margin();
    let parts = plan.parts.par_iter();
    parts.map(|part| swept_box(&part.segment, cylinder, margin)).collect()
}

/// Divides the path into runs of at most `length` parts near material.
pub(crate) struct Runs<'a> {
    tool: &'a Tool,
    plan: &'a Plan,
    grid: &'a Grid,
    material: &'a HeightMap,
    boxes: &'a [Box3],
    /// The numbers of the parts over the grid.
    members: &'a [u32],
    length: usize,
    /// Whether ceilings are wanted.
    closed: bool,
    top: f64,
    /// How far above all material is far enough.
    gap: f64,
    /// A little above the highest material, less the height of the lowest point of the tool above its tip.
    over: f64,
    at: usize,
}

impl<'a> Runs<'a> {
    pub fn new(
        (tool, plan): (&'a Tool, &'a Plan),
        (boxes, members): (&'a [Box3], &'a [u32]),
        (grid, material): (&'a Grid, &'a HeightMap),
        (length, closed): (usize, bool),
    ) -> Self {
        let (cylinder, top) = (tool.bounding_cylinder(), material.top());
        let gap = plan.gap();
        Self {
            boxes,
            members,
            tool,
            plan,
            grid,
            material,
            length,
            closed,
            top,
            gap,
            over: top - cylinder.z[0] + gap,
            at: 0,
        }
    }

    /// Whether any material is near a part.
    fn is_near(&self, number: usize) -> bool {
        let own = &self.boxes[number];
        window(self.grid, own).is_some_and(|window| !self.material.visit(window, own[2], &mut |_| false))
    }

    /// A part without the beginning or the end during which the tool is above all material; `None` if that is all of it.
    fn trimmed(&self, at: usize) -> Option<(PathPart, [bool; 2])> {
        let part = &self.plan.parts[at];
        let ends = || part.segment.tips().map(|tip| tip[2]);
        let [from, to] = part
            .vertical_arc()
            .map_or_else(ends, |vertical_arc| vertical_arc.heights());
        let whole = Some((part.clone(), [false; 2]));
        if !stands(part) || (from <= self.over && to <= self.over) {
            return whole;
        }
        if from > self.over && to > self.over {
            return None;
        }
        if matches!(part.kind, PartKind::LevelArc(_) | PartKind::VerticalArc(_)) {
            return whole;
        }
        let t = (self.over - from) / (to - from);
        let range = if from > self.over { [t, 1.0] } else { [0.0, t] };
        // A move that barely rises is taken whole: its direction would not survive.
        if !(range[1] - range[0] > 1e-3 && (to - from).abs() > GAP * self.plan.cutter.reach) {
            return whole;
        }
        let span = [range[0] as f32, (range[1] - range[0]) as f32];
        let segment = part.segment.part(range[0], range[1]);
        let times = [part.start + part.share * span[0], part.share * span[1]];
        let short = PathPart::new(segment, part.number, times);
        Some((short, [range[0] > 0.0, range[1] < 1.0]))
    }

    /// The lines with material near parts with these boxes.
    fn run(&self, parts: Vec<PathPart>, members: &[u32]) -> Option<Run<'a>> {
        let hull = |a: Box3, b: Box3| std::array::from_fn(|k| [a[k][0].min(b[k][0]), a[k][1].max(b[k][1])]);
        let boxes = members.iter().map(|number| self.boxes[*number as usize]);
        let whole: Box3 = boxes.reduce(hull)?;
        let [is, js] = window(self.grid, &whole)?;
        let mut lines = Vec::new();
        self.material.visit([is, js], whole[2], &mut |line| {
            lines.push(line);
            true
        });
        let outline = self.plan.cutter.outline.as_ref().filter(|_| self.closed);
        let ceiling = outline.and_then(|outline| Ceiling::new(outline, self.plan.cutter.reach, &parts, self.top));
        let short = match ceiling {
            None if self.closed => self.plan.short.shortest(self.tool, &parts, self.top + self.gap),
            _ => None,
        };
        let all = (is.1 + 1 - is.0) * (js.1 + 1 - js.0);
        let mask = if lines.len() == all {
            None
        } else {
            Some(Cow::Owned(LineMask::new(self.grid, lines)?))
        };
        Some(Run {
            parts,
            done: self.at,
            mask,
            ceiling,
            short,
        })
    }
}

impl<'a> Iterator for Runs<'a> {
    type Item = Run<'a>;

    fn next(&mut self) -> Option<Run<'a>> {
        loop {
            let mut parts = Vec::new();
            let mut first = self.at;
            while let Some(number) = self.members.get(self.at).map(|number| *number as usize)
                && parts.len() < self.length
            {
                let near = if self.is_near(number) {
                    self.trimmed(number)
                } else {
                    None
                };
                // Where the path has a gap, the run ends.
                let Some((part, [late, early])) = near else {
                    if parts.is_empty() {
                        self.at += 1;
                        first = self.at;
                        continue;
                    }
                    break;
                };
                if late && !parts.is_empty() {
                    break;
                }
                if self.closed {
                    push_joined(&mut parts, part, self.plan.tolerances.joint_deviation());
                } else {
                    parts.push(part);
                }
                self.at += 1;
                if early {
                    break;
                }
            }
            if parts.is_empty() {
                return None;
            }
            if let Some(run) = self.run(parts, &self.members[first..self.at]) {
                return Some(run);
            }
        }
    }
}
