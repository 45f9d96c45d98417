//! From the values of a job's text to a [`Job`]: every one checked, with its place when it is wrong.

use std::collections::BTreeMap;
use std::path::Path as FilePath;
use std::sync::Arc;

use sweepsim_dexel::{Frame, Grid, Stock, TriangleSoup};
use sweepsim_motion::{AptWarning, Body, BodyKind, Law, Path, RotaryTable, Tool};

use crate::error::{FormatError, Problem};
use crate::files::{MeshFormat, read_dexels_file, read_mesh_file};
use crate::job::{Job, Limits, Target, Units};
use crate::locate::Node;
use crate::paths::{self, JobPath, PathOptions};
use crate::program::Note;
use crate::stl::read_stl;
use crate::surface_tool;
use crate::tools::{self, Step};
use crate::{gcode, motion, raw, text};

/// Where a job does not say how exact interval ends are, in its units.
const TOLERANCE: f64 = 1e-6;

/// Chords of arcs may be so many times the job's tolerance away from them, where a path does not say otherwise.
const ARC_TOLERANCE: f64 = 10.0;

/// Reads a job whose file is, or would be, `file`.
pub(crate) fn parse(text: &str, file: &FilePath) -> Result<Job, FormatError> {
    let raw: raw::Job = text::ron(text)?;
    let units = match raw.units {
        raw::Units::Mm => Units::Mm,
        raw::Units::Inch => Units::Inch,
    };
    let reader = Reader {
        text,
        file,
        places: Node::of(text),
        unit: units.in_mm(),
    };
    reader.job(raw, units)
}

struct Reader<'a> {
    text: &'a str,
    file: &'a FilePath,
    places: Node,
    unit: f64,
}

impl Reader<'_> {
    /// A problem with the value that the steps lead to.
    fn error(&self, problem: Problem, steps: &[Step]) -> FormatError {
        let span = self.node(steps).span.clone();
        FormatError::new(problem, Some(text::place(self.text, span)))
    }

    fn node(&self, steps: &[Step]) -> &Node {
        steps.iter().fold(&self.places, |node, step| step.of(node))
    }

    fn check(&self, what: &str, value: f64, good: bool, expected: &str, steps: &[Step]) -> Result<(), FormatError> {
        if good && (value * self.unit).is_finite() {
            Ok(())
        } else {
            Err(self.error(Problem::value(what, value, expected), steps))
        }
    }

    fn job(&self, raw: raw::Job, units: Units) -> Result<Job, FormatError> {
        let tolerance = raw.tolerance.unwrap_or(TOLERANCE);
        self.check(
            "tolerance",
            tolerance,
            tolerance > 0.0,
            "a positive number",
            &["tolerance".into()],
        )?;
        let tolerance = tolerance * self.unit;
        let grid = self.grid(&raw.grid)?;
        let stock = self.stock(&raw.stock, &["stock".into()], &grid)?;
        if let Some((number, place)) = self.places.key("tools").second_key() {
            let problem = Problem::syntax(format!("a second tool {number}: expected each number once"));
            return Err(FormatError::new(problem, Some(text::place(self.text, place))));
        }
        let (mut tools, mut notes) = (BTreeMap::new(), Vec::new());
        for (&number, tool) in &raw.tools {
            let steps = vec!["tools".into(), Step::Key(number.to_string())];
            let (made, odd) = self.tool(number, tool, &steps)?;
            tools.insert(number, made);
            notes.extend(odd);
        }
        let mut bodies = BTreeMap::new();
        for (&number, list) in &raw.bodies {
            let steps = |index: usize| vec!["bodies".into(), Step::Key(number.to_string()), Step::Item(index)];
            if !tools.contains_key(&number) {
                let known = tools.keys().copied().collect();
                return Err(self.error(Problem::NoSuchTool { number, known }, &steps(0)[..2]));
            }
            let mut made = Vec::with_capacity(list.len());
            for (index, body) in list.iter().enumerate() {
                let (kind, solid) = match body {
                    raw::Body::Shank(solid) => (BodyKind::Shank, solid),
                    raw::Body::Holder(solid) => (BodyKind::Holder, solid),
                };
                let (solid, odd) = self.tool(number, solid, &steps(index))?;
                notes.extend(odd);
                made.push(Body { kind, solid });
            }
            bodies.insert(number, made);
        }
        let mut paths = Vec::new();
        for (index, path) in raw.paths.iter().enumerate() {
            paths.extend(self.path(index, path, &tools, tolerance)?);
        }
        let target = match &raw.target {
            None => None,
            Some(raw::Target::Mesh(name)) => Some(Target {
                file: paths::beside(self.file, name),
                mesh: self.mesh(name, "target", &["target".into()])?,
            }),
        };
        let limits = match raw.limits {
            None => None,
            Some(limits) => {
                for (name, value) in [("gouge", limits.gouge), ("excess", limits.excess)] {
                    self.check(
                        name,
                        value,
                        value >= 0.0,
                        "0 or greater",
                        &["limits".into(), name.into()],
                    )?;
                }
                Some(Limits {
                    gouge: limits.gouge * self.unit,
                    excess: limits.excess * self.unit,
                })
            }
        };
        let stem = self.file.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        Ok(Job {
            name: raw.name.or(stem).unwrap_or_else(|| "job".into()),
            units,
            tolerance,
            grid,
            stock,
            tools,
            bodies,
            paths,
            target,
            limits,
            notes,
        })
    }

    /// The solid of tool `number`, or of a body that moves with it, and what is odd about it.
    fn tool(&self, number: u32, raw: &raw::Tool, steps: &[Step]) -> Result<(Tool, Vec<Note>), FormatError> {
        if let raw::Tool::Surface(name) = raw {
            let file = paths::beside(self.file, name);
            let tool = self.named(surface_tool::read(&file, self.unit), &file, "tool", steps)?;
            return Ok((tool, Vec::new()));
        }
        let made = tools::tool(number, raw, self.unit).map_err(|fault| {
            let steps: Vec<Step> = steps.iter().cloned().chain(fault.field).collect();
            self.error(fault.problem, &steps)
        })?;
        let line = text::place(self.text, self.node(steps).span.clone()).line;
        let note = |warning: AptWarning| Note {
            line,
            message: format!("tool {number}: {warning}"),
        };
        Ok((made.tool, made.warnings.into_iter().map(note).collect()))
    }

    fn grid(&self, raw: &raw::Grid) -> Result<Grid, FormatError> {
        let scale = |corner: [f64; 2]| corner.map(|c| c * self.unit);
        let mut cells = [0; 2];
        for (k, cell) in cells.iter_mut().enumerate() {
            *cell = usize::try_from(raw.cells[k]).ok().filter(|&n| n > 0).ok_or_else(|| {
                let problem = Problem::value("a number of cells", raw.cells[k], "a positive whole number");
                self.error(problem, &["grid".into(), "cells".into(), Step::Item(k)])
            })?;
        }
        for (name, corner) in [("min", raw.min), ("max", raw.max)] {
            for (k, value) in corner.into_iter().enumerate() {
                let steps = ["grid".into(), name.into(), Step::Item(k)];
                self.check("a corner of the grid", value, true, "finite", &steps)?;
            }
        }
        let grid = Grid::new(scale(raw.min), scale(raw.max), cells).map_err(|error| {
            let ordered = (0..2).all(|k| raw.min[k] < raw.max[k]);
            let field = if ordered { "cells" } else { "min" };
            self.error(Problem::Grid(error), &["grid".into(), field.into()])
        })?;
        let Some(frame) = &raw.frame else { return Ok(grid) };
        let origin = frame.origin.map(|c| c * self.unit);
        let frame = Frame::new(origin, frame.z, frame.x)
            .map_err(|error| self.error(Problem::Frame(error), &["grid".into(), "frame".into()]))?;
        Ok(grid.in_frame(frame))
    }

    /// A piece of stock, whose value the steps lead to.
    fn stock(&self, raw: &raw::Stock, at: &[Step], grid: &Grid) -> Result<Stock, FormatError> {
        let scale = |point: [f64; 3]| point.map(|c| c * self.unit);
        let steps = |name: &str, k: Option<usize>| -> Vec<Step> {
            let more = [Some(name.into()), k.map(Step::Item)].into_iter().flatten();
            at.iter().cloned().chain(more).collect()
        };
        let finite = |name: &str, point: [f64; 3]| {
            (0..3).try_for_each(|k| self.check(name, point[k], true, "finite", &steps(name, Some(k))))
        };
        // Those in the list that is the item number `place` of a wrapper.
        let list = |parts: &[raw::Stock], place: usize| -> Result<Vec<Stock>, FormatError> {
            let each = parts.iter().enumerate().map(|(k, part)| {
                let steps: Vec<Step> = at.iter().cloned().chain([Step::Item(place), Step::Item(k)]).collect();
                self.stock(part, &steps, grid)
            });
            each.collect()
        };
        match *raw {
            raw::Stock::Block { min, max } => {
                finite("min", min)?;
                finite("max", max)?;
                for k in 0..3 {
                    let expected = format!("greater than that of min, {}", min[k]);
                    let what = format!("the {} of max", ['x', 'y', 'z'][k]);
                    self.check(&what, max[k], min[k] < max[k], &expected, &steps("max", Some(k)))?;
                }
                Ok(Stock::Block {
                    min: scale(min),
                    max: scale(max),
                })
            }
            raw::Stock::Cylinder {
                base,
                axis,
                radius,
                height,
            } => {
                finite("base", base)?;
                finite("axis", axis)?;
                if axis == [0.0; 3] {
                    let problem = Problem::value("axis", "zero", "a direction, such as (0, 0, 1)");
                    return Err(self.error(problem, &steps("axis", None)));
                }
                self.check("radius", radius, radius > 0.0, "positive", &steps("radius", None))?;
                self.check("height", height, height > 0.0, "positive", &steps("height", None))?;
                Ok(Stock::Cylinder {
                    base: scale(base),
                    axis,
                    radius: radius * self.unit,
                    height: height * self.unit,
                })
            }
            raw::Stock::Ball { centre, radius } => {
                finite("centre", centre)?;
                self.check("radius", radius, radius > 0.0, "positive", &steps("radius", None))?;
                Ok(Stock::Ball {
                    centre: scale(centre),
                    radius: radius * self.unit,
                })
            }
            raw::Stock::Mesh(ref name) => Ok(Stock::Mesh(self.mesh(name, "stock", at)?)),
            raw::Stock::Dexels(ref name) => self.dexels(name, at, grid),
            raw::Stock::Union(ref parts) => Ok(Stock::Union(list(parts, 0)?)),
            raw::Stock::Intersection(ref parts) => Ok(Stock::Intersection(list(parts, 0)?)),
            raw::Stock::Difference(ref whole, ref parts) => {
                let steps: Vec<Step> = at.iter().cloned().chain([Step::Item(0)]).collect();
                let whole = self.stock(whole, &steps, grid)?;
                Ok(Stock::Difference(whole.into(), list(parts, 1)?))
            }
        }
    }

    /// What an earlier run left, in millimetres as all its outputs.
    fn dexels(&self, name: &str, steps: &[Step], grid: &Grid) -> Result<Stock, FormatError> {
        let file = paths::beside(self.file, name);
        let dexels = self.named(read_dexels_file(&file, Some(grid)), &file, "stock", steps)?;
        if dexels.grid() == grid {
            return Ok(Stock::Dexels(Arc::new(dexels)));
        }
        let words = |grid: &Grid| {
            let ([x0, y0], [x1, y1], [nx, ny]) = (grid.min(), grid.max(), grid.cells());
            let frame = if grid.frame().is_world() { "" } else { " in a frame" };
            format!("{nx} x {ny} dexels from ({x0}, {y0}) to ({x1}, {y1}) mm{frame}")
        };
        let what = format!("the grid of {name}");
        Err(self.error(
            Problem::value(what, words(dexels.grid()), format!("that of the job, {}", words(grid))),
            steps,
        ))
    }

    /// The triangles of a file that is named at the steps, in millimetres.
    fn mesh(&self, name: &str, what: &'static str, steps: &[Step]) -> Result<TriangleSoup, FormatError> {
        let file = paths::beside(self.file, name);
        let known = MeshFormat::of(&file).is_some_and(|format| format != MeshFormat::Stl);
        let mesh = if known {
            let mesh = self.named(read_mesh_file(&file), &file, what, steps)?;
            mesh.soup().unwrap_or_default()
        } else {
            self.named(read_stl(&file), &file, what, steps)?
        };
        Ok(if self.unit == 1.0 {
            mesh
        } else {
            let scaled = mesh.triangles.iter().map(|t| t.map(|p| p.map(|c| c * self.unit)));
            TriangleSoup {
                triangles: scaled.collect(),
            }
        })
    }

    /// A file that cannot be opened is an error of the job, at the place that names it.
    fn named<T>(
        &self,
        read: Result<T, FormatError>,
        file: &FilePath,
        what: &'static str,
        steps: &[Step],
    ) -> Result<T, FormatError> {
        read.map_err(|error| match error.into_read_error() {
            Ok(source) => {
                let file = file.to_owned();
                self.error(Problem::Named { what, file, source }, steps)
            }
            Err(error) => error,
        })
    }

    fn path(
        &self,
        index: usize,
        raw: &raw::Path,
        tools: &BTreeMap<u32, Tool>,
        tolerance: f64,
    ) -> Result<Vec<JobPath>, FormatError> {
        let steps = |rest: &[Step]| {
            let mut steps = vec!["paths".into(), Step::Item(index)];
            steps.extend_from_slice(rest);
            steps
        };
        let has_tool = |number: u32| {
            let known = || tools.keys().copied().collect();
            tools
                .contains_key(&number)
                .then_some(())
                .ok_or_else(|| Problem::NoSuchTool { number, known: known() })
        };
        if let Some(number) = raw.tool {
            has_tool(number).map_err(|problem| self.error(problem, &steps(&["tool".into()])))?;
        }
        let law = raw.law.unwrap_or(raw::Law::Slerp);
        let table = |table: raw::Table| match table {
            raw::Table::Ac => RotaryTable::Ac,
            raw::Table::Bc => RotaryTable::Bc,
        };
        let tool = || {
            raw.tool.ok_or_else(|| {
                let problem = Problem::syntax("this path has no tool: expected `tool:` with a number of `tools`");
                self.error(problem, &steps(&[]))
            })
        };
        let whole = |tool: u32, path: Path, source: String| {
            vec![JobPath {
                tool,
                rapid: vec![false; path.moves()],
                path,
                source,
                lines: Vec::new(),
                notes: Vec::new(),
            }]
        };
        let own = || format!("path {index} of the job");
        let inline = |made: Result<Path, paths::PoseFault>, field: &str| {
            let tool = tool()?;
            let path = made.map_err(|(problem, place)| {
                let mut path = steps(&[field.into()]);
                let rest = place
                    .iter()
                    .flat_map(|&(pose, part)| [Step::Item(pose), Step::Item(part)]);
                path.extend(rest);
                self.error(problem, &path)
            })?;
            Ok(whole(tool, path, own()))
        };
        if let Some(raw_motion) = &raw.motion {
            if raw.poses.is_some() || raw.moves.is_some() || raw.file.is_some() || raw.law.is_some() {
                let problem = Problem::syntax(
                    "`motion` with `poses`, `moves`, `file` or `law` in one path: a motion says all of it, expected it alone",
                );
                return Err(self.error(problem, &steps(&["motion".into()])));
            }
            let tool = tool()?;
            let path = motion::path(raw_motion, self.unit).map_err(|fault| {
                let place: Vec<Step> = std::iter::once("motion".into()).chain(fault.field).collect();
                self.error(fault.problem, &steps(&place))
            })?;
            return Ok(whole(tool, path, own()));
        }
        let own_law = match law {
            raw::Law::Slerp => Law::Slerp,
            raw::Law::ConstantSpeed => Law::ConstantSpeed,
            raw::Law::Rotary(axes) => Law::Rotary(table(axes)),
        };
        match (&raw.poses, &raw.file) {
            _ if raw.moves.is_some() && (raw.poses.is_some() || raw.file.is_some()) => {
                let problem = Problem::syntax("`moves` and `poses` or `file` in one path: expected one of them");
                Err(self.error(problem, &steps(&["moves".into()])))
            }
            (Some(poses), None) => inline(paths::of_poses(poses, own_law, self.unit), "poses"),
            (None, Some(name)) => {
                let arc_tolerance = match raw.arc_tolerance {
                    None => ARC_TOLERANCE * tolerance,
                    Some(value) => {
                        let place = steps(&["arc_tolerance".into()]);
                        self.check("arc_tolerance", value, value > 0.0, "a positive number", &place)?;
                        value * self.unit
                    }
                };
                let options = PathOptions {
                    unit: self.unit,
                    program: gcode::Options {
                        arc_tolerance,
                        table: match law {
                            raw::Law::Rotary(axes) => Some(table(axes)),
                            _ => raw.table.map(table),
                        },
                        law: match law {
                            raw::Law::Slerp => gcode::AxisLaw::Slerp,
                            raw::Law::ConstantSpeed => gcode::AxisLaw::ConstantSpeed,
                            raw::Law::Rotary(_) => gcode::AxisLaw::Rotary,
                        },
                        exact_arcs: matches!(raw.arcs, Some(raw::Arcs::Exact)),
                        tip_control: raw.tip_control.unwrap_or(false),
                        ..gcode::Options::default()
                    },
                };
                let file = paths::beside(self.file, name);
                if file
                    .extension()
                    .is_some_and(|extension| extension.eq_ignore_ascii_case("ron"))
                {
                    if raw.law.is_some() {
                        let problem =
                            Problem::syntax("`law` with the file of a motion: a motion says how the tool turns");
                        return Err(self.error(problem, &steps(&["law".into()])));
                    }
                    let tool = tool()?;
                    let path = self.named(motion::read(&file, self.unit), &file, "path", &steps(&["file".into()]))?;
                    return Ok(whole(tool, path, name.clone()));
                }
                let read = paths::read_path_file(&file, &options);
                let program = self.named(read, &file, "path", &steps(&["file".into()]))?;
                paths::of_program(program, &file, name, raw.tool, own_law, has_tool)
            }
            (Some(_), Some(_)) => {
                let problem = Problem::syntax("both `poses` and `file` in one path: expected one of them");
                Err(self.error(problem, &steps(&["file".into()])))
            }
            (None, None) => match &raw.moves {
                Some(moves) => inline(paths::of_moves(moves, own_law, self.unit), "moves"),
                None => {
                    let problem =
                        Problem::syntax("this path has no poses: expected `poses`, `moves`, `motion` or `file`");
                    Err(self.error(problem, &steps(&[])))
                }
            },
        }
    }
}
