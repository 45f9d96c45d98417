//! What a draft guesses: details of tools, the stock, the grid.

use std::collections::BTreeMap;

use sweepsim_nc::{CutterKind, ProgramPose, StockDescription, ToolDescription, shortest};

use super::words::{corner, rounded};
use super::{DraftStock, Drafter, Guess, refuse};
use crate::error::FormatError;
use crate::meshes::{MeshFormat, read_mesh_file, read_stl};

/// The length of flutes that nobody gives, in diameters.
const FLUTES: f64 = 4.0;
/// The angle of the point of drills that nobody gives, in degrees: the commonest.
const POINT_ANGLE: f64 = 118.0;
/// The diameter of tools of which nothing is known, in millimetres.
const DIAMETER: f64 = 6.0;
/// The number of dexels across the radius of the smallest tool,
const ACROSS_RADIUS: f64 = 5.0;
/// and the least and the largest number along the longer side of the stock: more take long, and much memory.
const CELLS: [f64; 2] = [100.0, 650.0];

impl Drafter<'_> {
    /// The numbers of the tools in use, in the order of the program; tool 1 if it names none.
    fn used(&self) -> Vec<u32> {
        let mut used = Vec::new();
        for pose in self.program.poses.in_order() {
            let number = pose.tool.unwrap_or(1);
            if !used.contains(&number) {
                used.push(number);
            }
        }
        used
    }

    /// What a library or the program says about a tool.
    pub(super) fn described(&self, number: u32) -> Option<ToolDescription> {
        match (self.library.tools.get(&number), self.program.tools.get(&number)) {
            (Some(library), Some(program)) => Some(library.clone().or(program)),
            (Some(tool), None) | (None, Some(tool)) => Some(tool.clone()),
            (None, None) => None,
        }
    }

    /// The tools in use: what is known of them, with guesses where only details are missing.
    pub(super) fn tools(&mut self, top: Option<f64>) -> Result<BTreeMap<u32, ToolDescription>, FormatError> {
        let mut tools = BTreeMap::new();
        let mut missing = Vec::new();
        for number in self.used() {
            if self.provided.tools.contains_key(&number) {
                continue;
            }
            let mut tool = match self.described(number) {
                Some(tool) => tool,
                None if self.options.invent => {
                    let mut tool = ToolDescription::new(CutterKind::Flat);
                    tool.diameter = Some(DIAMETER);
                    let choice = format!("nothing is known of it; a flat end mill of {DIAMETER} mm: correct it");
                    self.guessed.push(Guess::new(format!("tool {number}"), choice));
                    tool
                }
                None => {
                    missing.push(format!("tool {number}: nothing is known of it"));
                    continue;
                }
            };
            self.complete(number, &mut tool, top);
            match tool.build() {
                Ok(_) => {
                    let notes = tool.notes.iter();
                    let notes = notes.map(|note| Guess::new(format!("tool {number}"), note.to_string()));
                    self.guessed.extend(notes);
                    tools.insert(number, tool);
                }
                Err(problem) => missing.push(format!("tool {number}: {problem}")),
            }
        }
        if missing.is_empty() {
            return Ok(tools);
        }
        let message = format!(
            "{}: expected a tool library (`--tools`) or comments in the program that say it; `sweepsim new` writes a job to edit",
            missing.join("; ")
        );
        Err(refuse(&self.file, message))
    }

    /// Guesses what is missing of a tool whose diameter is known.
    fn complete(&mut self, number: u32, tool: &mut ToolDescription, top: Option<f64>) {
        let Some(diameter) = tool.diameter else { return };
        let mut guess = |what: String| self.guessed.push(Guess::new(format!("tool {number}"), what));
        if tool.kind.is_none() {
            tool.kind = Some(CutterKind::Flat);
            let known = rounded(diameter);
            guess(format!(
                "a flat end mill, since only its diameter is known ({known} mm)"
            ));
        }
        if tool.kind == Some(CutterKind::Drill) && tool.point_angle.is_none() {
            tool.point_angle = Some(POINT_ANGLE);
            guess(format!("a point of {POINT_ANGLE} degrees"));
        }
        if tool.flute_length.is_none() && !matches!(tool.kind, Some(CutterKind::Apt(_))) {
            let own = |pose: &ProgramPose| pose.tool.unwrap_or(1) == number && !pose.rapid;
            let heights = self.program.poses.in_order().filter(own).map(|pose| pose.pose.tip()[2]);
            let lowest = heights.fold(f64::INFINITY, f64::min);
            let deep = top.map_or(0.0, |top| (top - lowest).max(0.0));
            let length = (FLUTES * diameter).max(if deep.is_finite() { deep + diameter } else { 0.0 });
            tool.flute_length = Some(length);
            guess(format!("flutes of {} mm", rounded(length)));
        }
    }

    /// The corners of the stock, if it is a block; `None` for a mesh.
    pub(super) fn stock(&mut self) -> Result<Option<[[f64; 3]; 2]>, FormatError> {
        let described = match &self.options.stock {
            DraftStock::Block { min, max } => return Ok(Some([*min, *max])),
            DraftStock::Mesh(file) => {
                // What cannot be read is reported now, not with the job.
                if MeshFormat::of(file).is_some_and(|format| format != MeshFormat::Stl) {
                    read_mesh_file(file)?;
                } else {
                    read_stl(file)?;
                }
                return Ok(None);
            }
            DraftStock::Auto => self.library.stock.or(self.program.stock),
        };
        match described {
            Some(StockDescription::Block { min, max }) => {
                let found = format!("stock: a block from {} to {} mm", corner(min), corner(max));
                self.found.push(found);
                Ok(Some([min, max]))
            }
            Some(StockDescription::Size([x, y, z])) => {
                let [dx, dy, dz] = [x, y, z].map(rounded);
                self.found.push(format!("stock: a block of {dx} x {dy} x {dz} mm"));
                let choice = "the zero of the program is at the lower left corner of its top";
                self.guessed.push(Guess::new("stock", choice));
                Ok(Some([[0.0, 0.0, -z], [x, y, 0.0]]))
            }
            _ => self.around_the_path().map(Some),
        }
    }

    /// A block around the feed moves.
    fn around_the_path(&mut self) -> Result<[[f64; 3]; 2], FormatError> {
        let radius = |number: u32| {
            if let Some(tool) = self.provided.tools.get(&number) {
                return tool.bounding_cylinder().radius;
            }
            let diameter = self.described(number).and_then(|tool| tool.diameter);
            diameter.map_or(0.0, |diameter| 0.5 * diameter)
        };
        let widest = self.used().into_iter().map(radius).fold(0.0, f64::max);
        let mut range: Option<[[f64; 3]; 2]> = None;
        let mut upright = true;
        let program = self.chords.as_ref().unwrap_or(&self.program);
        for pose in program.poses.in_order().filter(|pose| !pose.rapid) {
            let tip = pose.pose.tip();
            let [low, high] = range.unwrap_or([tip; 2]);
            range = Some([
                [0, 1, 2].map(|k| low[k].min(tip[k])),
                [0, 1, 2].map(|k| high[k].max(tip[k])),
            ]);
            upright &= pose.pose.axis()[2] > 0.9998;
        }
        let Some([mut low, mut high]) = range else {
            let message = "this program has no feed moves around which stock could be guessed: expected `--stock`";
            return Err(refuse(&self.file, message.to_owned()));
        };
        let longest = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
        let margin = if widest > 0.0 {
            widest
        } else {
            (0.05 * longest).max(1.0)
        };
        for k in 0..2 {
            low[k] -= margin;
            high[k] += margin;
        }
        // Programs of three axes usually have their zero on the stock.
        let highest = program
            .poses
            .in_order()
            .map(|pose| pose.pose.tip()[2])
            .fold(high[2], f64::max);
        let at_zero = upright && low[2] < 0.0 && highest >= 0.0;
        let faced = faced_from(program.poses.in_order()).filter(|_| at_zero);
        if at_zero {
            high[2] = faced.unwrap_or(0.0);
        }
        low[2] -= 0.1 * margin;
        if high[2] - low[2] < 0.2 * margin {
            high[2] = low[2] + margin;
        }
        let top = match faced {
            Some(top) => format!(
                "its top at z = {}, a level above the highest cut to the side",
                rounded(top)
            ),
            None if at_zero => "its top at z = 0".to_owned(),
            None => "its top at the highest of them".to_owned(),
        };
        let wider = rounded(margin);
        let choice = format!("a block around the feed moves, {wider} mm wider on each side, {top}");
        self.guessed.push(Guess::new("stock", choice));
        Ok([low, high])
    }

    /// The size of the cells: from the smallest tool and the size of the stock.
    pub(super) fn cell(&mut self, stock: Option<[[f64; 3]; 2]>, tools: &BTreeMap<u32, ToolDescription>) -> Option<f64> {
        let [low, high] = stock?;
        if self.options.cells.is_some() {
            return None;
        }
        let longer = (high[0] - low[0]).max(high[1] - low[1]);
        // A stock without a size is refused later.
        if !(longer > 0.0 && longer.is_finite()) {
            return None;
        }
        let own = self.provided.tools.values();
        let own = own.map(|tool| 2.0 * tool.bounding_cylinder().radius);
        let diameters = tools.values().filter_map(|tool| tool.diameter).chain(own);
        let smallest = diameters.fold(f64::INFINITY, f64::min);
        let cell = (0.5 * smallest / ACROSS_RADIUS).clamp(longer / CELLS[1], longer / CELLS[0]);
        // Two digits are enough for a guess.
        let digit = 10_f64.powf(cell.log10().floor() - 1.0);
        let cell = ((cell / digit).ceil() * digit * 1e9).round() / 1e9;
        if !(cell > 0.0 && cell.is_finite()) {
            return None;
        }
        let size = shortest(cell);
        let choice = format!("cells of {size} mm, from the smallest tool and the size of the stock");
        self.guessed.push(Guess::new("grid", choice));
        Some(cell)
    }
}

/// The top of a stock that is cut above z = 0: a level above the highest cut to the side, as far apart as the next
/// one below it, but no higher than where the tool begins to feed down to it. A feed move to the side cuts where the
/// tool has come down at feed; after a way up or a rapid it only leads from one cut to the next.
fn faced_from(poses: impl Iterator<Item = ProgramPose>) -> Option<f64> {
    const SAME: f64 = 1e-6;
    // The highest level with where the tool has begun to come down to it, and the next one.
    let (mut highest, mut next) = ([f64::NEG_INFINITY; 2], f64::NEG_INFINITY);
    let mut last: Option<[f64; 3]> = None;
    let mut above: Option<f64> = None;
    for pose in poses {
        let tip = pose.pose.tip();
        let Some(from) = last.replace(tip).filter(|_| pose.joined) else {
            above = None;
            continue;
        };
        let down = from[2] - tip[2];
        if pose.rapid || down < -SAME {
            above = None;
        } else if down > SAME {
            above = above.or(Some(from[2]));
        } else if let Some(start) = above.filter(|_| from[..2] != tip[..2]) {
            let level = tip[2];
            if level > highest[0] + SAME {
                (next, highest) = (highest[0], [level, start]);
            } else if level < highest[0] - SAME {
                next = next.max(level);
            }
        }
    }
    let [level, start] = highest;
    let top = if next.is_finite() {
        (2.0 * level - next).min(start)
    } else {
        level
    };
    (level > SAME).then_some(top)
}
