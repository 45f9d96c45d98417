//! Tools cut off above all material: see `docs/algorithms/near-material.md`.
//!
//! A long tool sweeps the same as a shorter one below all heights that the part between them never goes under. So the shorter one will do where
//! there is no material above.

use crate::cutter::Cutter;
use crate::sweep::spare::Spaces;
use crate::time::path_parts::PathPart;
use std::sync::OnceLock;
use sweepsim_motion::{BoundingCylinder, Tool};

/// How often the height of a tool is divided by the sixth root of two.
const RUNGS: i32 = 36;

/// A tool that was cut off, and what is prepared of it.
pub(crate) struct ShortTool {
    pub tool: Tool,
    cutter: OnceLock<Cutter>,
    pub spaces: Spaces,
}

impl ShortTool {
    pub fn cutter(&self) -> &Cutter {
        self.cutter.get_or_init(|| Cutter::new(&self.tool))
    }
}

/// Whether a shorter tool is likely to be solved faster. Along short moves, patches above all material are soon left out, too, and the rim of the cut may be a new sharp edge.
fn pays(short: &Tool, tool: &Tool) -> bool {
    /// An edge takes about as long as two patches.
    fn elements(tool: &Tool) -> f64 {
        tool.patches().len() as f64 + 2.0 * tool.edges().len() as f64
    }
    const LESS: f64 = 0.75;
    short.edges().len() <= tool.edges().len() || elements(short) <= LESS * elements(tool)
}

/// A tool in several lengths, the longest first. They are made when they are asked for.
pub(crate) struct ShortTools {
    cylinder: BoundingCylinder,
    /// What can be cut off in one straight section: heights and tools.
    rungs: Vec<(f64, OnceLock<Option<ShortTool>>)>,
}

impl ShortTools {
    pub fn new(tool: &Tool) -> Self {
        let cylinder = tool.bounding_cylinder();
        let [low, high] = cylinder.z;
        let height = |n: i32| low + (high - low) * (f64::from(-n) / 6.0).exp2();
        Self {
            cylinder,
            rungs: (1..=RUNGS).map(|n| (height(n), OnceLock::new())).collect(),
        }
    }

    fn rung(&self, tool: &Tool, number: usize) -> Option<&ShortTool> {
        let (height, made) = &self.rungs[number];
        made.get_or_init(|| {
            Some(ShortTool {
                tool: tool.below(*height).filter(|short| pays(short, tool))?,
                cutter: OnceLock::new(),
                spaces: Spaces::default(),
            })
        })
        .as_ref()
    }

    /// The shortest tool that sweeps the same as `tool` below `top` along these parts, if there is one, and its number.
    pub fn shortest(&self, tool: &Tool, parts: &[PathPart], top: f64) -> Option<(usize, &ShortTool)> {
        let poses = Poses::new(parts);
        let is_above = |height: f64, radius: f64| poses.lowest(height, radius) > top;
        if !tool.is_revolved() {
            // Parts of it above a height may be as wide as the tool.
            let is_low_enough = |(height, _): &&(f64, _)| is_above(*height, self.cylinder.radius);
            let count = self.rungs.iter().take_while(is_low_enough).count();
            let mut numbers = (0..count).rev();
            return numbers.find_map(|number| Some((number, self.rung(tool, number)?)));
        }
        let mut cylinder = self.cylinder;
        let mut best = None;
        for (number, (height, _)) in self.rungs.iter().enumerate() {
            // Of a tool that was shortened before, all above the next height is within its own radius.
            if !is_above(*height, cylinder.radius) {
                break;
            }
            if let Some(short) = self.rung(tool, number) {
                cylinder = short.tool.bounding_cylinder();
                best = Some((number, short));
            }
        }
        best
    }
}

/// Bounds of the poses along some parts: of control values, which hold all that lies between, since weights are positive.
struct Poses {
    /// For each part: the lowest tip, and the components along the dexels of the axis and across it, the least and the largest.
    each: Vec<[f64; 3]>,
}

impl Poses {
    fn new(parts: &[PathPart]) -> Self {
        let pose = |part: &PathPart| {
            let (points, weights) = part.segment.points();
            let tips = points.iter().zip(&weights).map(|(point, weight)| point.z / weight);
            let turns = part.segment.turns().iter().zip(part.segment.weights());
            let ([mut rise, mut lean], tip) = ([f64::INFINITY, 0.0_f64], tips.fold(f64::INFINITY, f64::min));
            for (turn, weight) in turns {
                rise = rise.min(turn[(2, 2)] / weight);
                lean = lean.max(turn[(2, 0)].hypot(turn[(2, 1)]) / weight);
            }
            [tip, rise, lean]
        };
        Self {
            each: parts.iter().map(pose).collect(),
        }
    }

    /// The least height of points of the tool farther than `height` along its axis, and no farther than `radius` from it. −∞ if the tool may be upside down.
    fn lowest(&self, height: f64, radius: f64) -> f64 {
        let lowest = |[tip, rise, lean]: &[f64; 3]| {
            if *rise > 0.0 && height > 0.0 {
                tip + height * rise - radius * lean
            } else {
                f64::NEG_INFINITY
            }
        };
        self.each.iter().map(lowest).fold(f64::INFINITY, f64::min)
    }
}
