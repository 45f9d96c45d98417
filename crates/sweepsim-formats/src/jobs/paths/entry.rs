//! The entries of a job's list of paths: poses, moves, a motion, or a file.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};
use sweepsim_dexel::Frame;
use sweepsim_motion::{Law, OtherCourses, Path, RotaryTable};
use sweepsim_nc::{AxisLaw, Controller, Format, Machine, ReadOptions};

use super::as_wear::AssumedSizes;
use super::{Flags, JobPath, Origins, PathPlace, inline, program, spline_motion};
use crate::error::{FormatError, Problem};
use crate::jobs::place::Step;
use crate::jobs::read::JobReader;
use crate::jobs::schema;
use crate::jobs::tools::ToolBox;

/// The default arc tolerance, in tolerances of the job.
const ARC_TOLERANCE: f64 = 10.0;

impl JobReader<'_> {
    /// The paths of entry `index` in a list of paths, in the coordinates of the part.
    pub(crate) fn path(
        &self,
        index: usize,
        raw: &schema::Path,
        place: &PathPlace,
        tools: &mut ToolBox,
        tolerance: f64,
    ) -> Result<Vec<JobPath>, FormatError> {
        let at: Vec<Step> = place
            .at
            .iter()
            .cloned()
            .chain(["paths".into(), Step::Item(index)])
            .collect();
        let frame = self.frame(raw.frame.as_ref(), &at)?.within(&place.frame);
        let own = match place.at {
            [] => format!("path {index} of the job"),
            _ => format!("path {index} of set-up {}", place.setup),
        };
        let mut paths = self.own_paths(own, raw, &at, tools, tolerance)?;
        let turn = Matrix3::from_columns(&frame.axes().map(Vector3::from));
        for path in &mut paths {
            let place = |path: &mut JobPath| {
                (path.setup, path.frame) = (place.setup, frame);
                if !frame.is_world() {
                    path.path = path.path.moved(&turn, frame.origin())?;
                    path.other_courses = path.other_courses.moved(&turn, frame.origin())?;
                }
                Ok(())
            };
            let as_wear = path.as_wear.as_mut().and_then(|other| other.path.as_mut());
            let placed = as_wear.map_or(Ok(()), place).and_then(|()| place(path));
            placed.map_err(|error| self.error(Problem::Path(error), &at))?;
        }
        Ok(paths)
    }

    /// The paths of the entry at `at`, in its own coordinates. `own` says where it is.
    fn own_paths(
        &self,
        own: String,
        raw: &schema::Path,
        at: &[Step],
        tools: &mut ToolBox,
        tolerance: f64,
    ) -> Result<Vec<JobPath>, FormatError> {
        let steps = |rest: &[Step]| {
            let mut steps = at.to_vec();
            steps.extend_from_slice(rest);
            steps
        };
        // A program's own tools are known only when it has been read.
        if let (Some(number), None) = (raw.tool, &raw.file) {
            tools
                .need(number, None)
                .map_err(|problem| self.error(problem, &steps(&["tool".into()])))?;
        }
        let law = raw.law.unwrap_or(schema::Law::Slerp);
        let table = |table: schema::Table| match table {
            schema::Table::Ac => RotaryTable::Ac,
            schema::Table::Bc => RotaryTable::Bc,
        };
        let tool = || {
            raw.tool.ok_or_else(|| {
                let problem = Problem::syntax("this path has no tool: expected `tool:` with a number of `tools`");
                self.error(problem, &steps(&[]))
            })
        };
        if let Some(feed) = raw.feed {
            let at = steps(&["feed".into()]);
            self.check("feed", feed, feed > 0.0, "a positive number", &at)?;
            if raw.file.is_some() {
                let problem =
                    Problem::syntax("`feed` with `file`: a program says its feeds itself, expected one of them");
                return Err(self.error(problem, &at));
            }
        }
        if !reads_a_program(raw)
            && let Some(field) = of_programs(raw)
        {
            let problem = Problem::syntax(format!(
                "`{field}` without a program: it says how a program is read, expected it beside its `file`"
            ));
            return Err(self.error(problem, &steps(&[field.into()])));
        }
        let whole = |tool: u32, path: Path, source: String| {
            let rapid: Flags = match &raw.moves {
                Some(moves) => inline::rapids(moves).collect(),
                None => std::iter::repeat_n(false, path.moves()).collect(),
            };
            let seconds = inline::seconds(&path, &rapid, raw.feed.map(|feed| feed * self.unit));
            vec![JobPath {
                tool,
                setup: 0,
                frame: Frame::WORLD,
                assumed_rapids: rapid.count() > 0,
                rapid,
                seconds,
                other_courses: OtherCourses::default(),
                spindle_stopped: Flags::default(),
                no_feed: Flags::default(),
                beyond: Vec::new(),
                has_limits: false,
                on_machine: None,
                dwell_seconds: 0.0,
                path,
                source,
                origins: Origins::default(),
                files: Arc::new([]),
                calls: Arc::new([]),
                notes: Vec::new(),
                as_wear: None,
            }]
        };
        let inline = |made: Result<Path, inline::PoseFault>, field: &str| {
            let tool = tool()?;
            let path = made.map_err(|(problem, place)| {
                let mut path = steps(&[field.into()]);
                let rest = place
                    .iter()
                    .flat_map(|&(pose, part)| [Step::Item(pose), Step::Item(part)]);
                path.extend(rest);
                self.error(problem, &path)
            })?;
            Ok(whole(tool, path, own.clone()))
        };
        if let Some(raw_motion) = &raw.motion {
            if raw.poses.is_some() || raw.moves.is_some() || raw.file.is_some() || raw.law.is_some() {
                let problem = Problem::syntax(
                    "`motion` with `poses`, `moves`, `file` or `law` in one path: a motion says all of it, expected it alone",
                );
                return Err(self.error(problem, &steps(&["motion".into()])));
            }
            let tool = tool()?;
            let path = spline_motion::path(raw_motion, self.unit).map_err(|fault| {
                let place: Vec<Step> = std::iter::once("motion".into()).chain(fault.field).collect();
                self.error(fault.problem, &steps(&place))
            })?;
            return Ok(whole(tool, path, own.clone()));
        }
        let own_law = match law {
            schema::Law::Slerp => Law::Slerp,
            schema::Law::ConstantSpeed => Law::ConstantSpeed,
            schema::Law::Rotary(axes) => Law::Rotary(table(axes)),
        };
        match (&raw.poses, &raw.file) {
            _ if raw.moves.is_some() && (raw.poses.is_some() || raw.file.is_some()) => {
                let problem = Problem::syntax("`moves` and `poses` or `file` in one path: expected one of them");
                Err(self.error(problem, &steps(&["moves".into()])))
            }
            (Some(poses), None) => inline(inline::of_poses(poses, own_law, self.unit), "poses"),
            (None, Some(name)) => {
                let arc_tolerance = match raw.arc_tolerance {
                    None => ARC_TOLERANCE * tolerance,
                    Some(value) => {
                        let place = steps(&["arc_tolerance".into()]);
                        self.check("arc_tolerance", value, value > 0.0, "a positive number", &place)?;
                        value * self.unit
                    }
                };
                let mut options = ReadOptions::default();
                options.arc_tolerance = arc_tolerance;
                options.inch = self.unit != 1.0;
                self.dialect(raw, &mut options, &steps)?;
                options.cutters = tools.diameters();
                if let Some(on) = raw.tip_control {
                    options.machine.tip_control = on;
                }
                let given = match law {
                    schema::Law::Rotary(axes) => Some(table(axes)),
                    _ => raw.table.map(table),
                };
                options.machine.table = given.or(options.machine.table);
                options.law = match law {
                    schema::Law::Slerp => AxisLaw::Slerp,
                    schema::Law::ConstantSpeed => AxisLaw::ConstantSpeed,
                    schema::Law::Rotary(_) => AxisLaw::Rotary,
                };
                options.exact_arcs = matches!(raw.arcs, Some(schema::Arcs::Exact));
                options.upright_arcs = matches!(raw.arcs, None | Some(schema::Arcs::Upright));
                options.tilted_arcs = options.upright_arcs;
                options.level_arcs = options.upright_arcs || matches!(raw.arcs, Some(schema::Arcs::Level));
                let file = self.beside(name, &steps(&["file".into()]))?;
                options.within.clone_from(&self.provided.within);
                if is_motion(&file) {
                    if raw.law.is_some() {
                        let problem =
                            Problem::syntax("`law` with the file of a motion: a motion says how the tool turns");
                        return Err(self.error(problem, &steps(&["law".into()])));
                    }
                    let tool = tool()?;
                    tools
                        .need(tool, None)
                        .map_err(|problem| self.error(problem, &steps(&["tool".into()])))?;
                    let path = self.named(
                        spline_motion::read(&file, self.unit),
                        &file,
                        "path",
                        &steps(&["file".into()]),
                    )?;
                    return Ok(whole(tool, path, name.clone()));
                }
                let read = self.provided.program(&file, &options).map_err(FormatError::from);
                let program = self.named(read, &file, "path", &steps(&["file".into()]))?;
                if let Some(number) = raw.tool {
                    tools
                        .need(number, Some((&program.tools, name)))
                        .map_err(|problem| self.error(problem, &steps(&["tool".into()])))?;
                }
                let origin = program::ProgramOrigin {
                    file: &file,
                    shown: name,
                    provided: self.provided,
                };
                let sizes = AssumedSizes::of(&program.assumptions);
                let mut paths = program::of_program(program, origin, raw.tool, own_law, tools)?;
                if let Some(sizes) = sizes {
                    sizes.compare(&mut paths, raw.tool, &options, |options| {
                        let program = self.provided.program(&file, options).map_err(FormatError::from)?;
                        program::of_program(program, origin, raw.tool, own_law, tools)
                    });
                }
                Ok(paths)
            }
            (Some(_), Some(_)) => {
                let problem = Problem::syntax("both `poses` and `file` in one path: expected one of them");
                Err(self.error(problem, &steps(&["file".into()])))
            }
            (None, None) => match &raw.moves {
                Some(moves) => inline(inline::of_moves(moves, own_law, self.unit), "moves"),
                None => {
                    let problem =
                        Problem::syntax("this path has no poses: expected `poses`, `moves`, `motion` or `file`");
                    Err(self.error(problem, &steps(&[])))
                }
            },
        }
    }

    /// The format, the control and the machine of a program.
    fn dialect(
        &self,
        raw: &schema::Path,
        options: &mut ReadOptions,
        steps: &impl Fn(&[Step]) -> Vec<Step>,
    ) -> Result<(), FormatError> {
        options.lenient = raw.lenient.unwrap_or(false);
        options.strict = raw.strict.unwrap_or(false);
        self.each_once("diameter", &steps(&["diameters".into()]))?;
        self.each_once("work offset", &steps(&["offsets".into()]))?;
        for (name, &(x, y, z)) in &raw.offsets {
            let place = steps(&["offsets".into(), name.as_str().into()]);
            let finite = [x, y, z].iter().all(|c| c.is_finite());
            self.check("a work offset", x + y + z, finite, "three numbers", &place)?;
            options
                .offsets
                .insert(name.replace(' ', ""), [x, y, z].map(|c| c * self.unit));
        }
        for (number, diameter) in &raw.diameters {
            let place = steps(&["diameters".into(), number.to_string().as_str().into()]);
            self.check(
                "a diameter",
                *diameter,
                *diameter >= 0.0,
                "a positive number, or 0",
                &place,
            )?;
            options.diameters.insert(*number, diameter * self.unit);
        }
        if let Some(name) = &raw.format {
            let format = Format::named(name).ok_or_else(|| {
                let expected = format!("one of {}", Format::NAMES.join(", "));
                let problem = Problem::value("the format of this program", format!("{name:?}"), expected);
                self.error(problem, &steps(&["format".into()]))
            })?;
            options.format = Some(format);
        }
        if let Some(name) = &raw.controller {
            let controller = Controller::named(name).ok_or_else(|| {
                let expected = format!("one of {}", Controller::NAMES.join(", "));
                let problem = Problem::value("the controller of this program", format!("{name:?}"), expected);
                self.error(problem, &steps(&["controller".into()]))
            })?;
            options.controller = Some(controller);
        }
        if let Some(name) = &raw.machine {
            let read = match Machine::named(name) {
                Some(machine) => Ok(machine),
                None => Machine::read_file(&self.beside(name, &steps(&["machine".into()]))?),
            };
            options.machine = read.map_err(|error| {
                let problem = Problem::syntax(format!("machine {name}: {error}"));
                self.error(problem, &steps(&["machine".into()]))
            })?;
        }
        Ok(())
    }
}

/// Whether a file is one of a motion.
fn is_motion(file: &std::path::Path) -> bool {
    let extension = file.extension();
    extension.is_some_and(|extension| extension.eq_ignore_ascii_case("ron"))
}

/// Whether a path is that of a program or of a table.
fn reads_a_program(raw: &schema::Path) -> bool {
    raw.file.as_ref().is_some_and(|file| !is_motion(file.as_ref()))
}

/// The first field that says how a program is read.
fn of_programs(raw: &schema::Path) -> Option<&'static str> {
    let given = [
        ("machine", raw.machine.is_some()),
        ("controller", raw.controller.is_some()),
        ("format", raw.format.is_some()),
        ("table", raw.table.is_some()),
        ("tip_control", raw.tip_control.is_some()),
        ("arcs", raw.arcs.is_some()),
        ("arc_tolerance", raw.arc_tolerance.is_some()),
        ("diameters", !raw.diameters.is_empty()),
        ("offsets", !raw.offsets.is_empty()),
        ("strict", raw.strict.is_some()),
        ("lenient", raw.lenient.is_some()),
    ];
    given.iter().find(|(_, is)| *is).map(|(field, _)| *field)
}
