//! Calls, carried out.

use super::answers::{self, Answer};
use super::limit::Limit;
use super::parameters::{Compare, Inspect, Program, Section, Simulate, Verify};
use crate::arguments::{plane, stock};
use rmcp::schemars::{JsonSchema, schema_for};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::path::Path;
use sweepsim_job::{
    CompareRequest, DeviationLimits, DialectOptions, JobError, Judging, Output, ProgramOptions, Request, StockOption,
    Task, ViewOptions, describe,
};
use sweepsim_nc::{Machine, is_within};

/// Lines closer than this share of the default limits are drawn no better.
const CHORD: f64 = 0.01;

/// Pictures of this size are seen well enough, and are not long messages.
const PICTURE: [usize; 2] = [800, 600];

fn view() -> ViewOptions {
    let mut view = ViewOptions::default();
    view.size = PICTURE;
    view
}

/// Why a call has no answer: in words that help the agent.
#[derive(Debug)]
pub(super) enum Refusal {
    /// The parameters are not those of the tool.
    Parameters(String),
    /// What they ask for cannot be carried out.
    Work(JobError),
    /// The same, in other words.
    Said(String),
}

impl From<JobError> for Refusal {
    fn from(error: JobError) -> Self {
        Self::Work(error)
    }
}

/// Carries out a call.
pub(super) fn carry_out(tool: &str, given: Map<String, Value>, root: &Path, limit: &Limit) -> Result<Answer, Refusal> {
    match tool {
        "inspect_program" => inspect(&read(given)?, root),
        "verify_program" => {
            let Verify {
                program,
                target,
                gouge,
                excess,
                clearance,
                proof,
            } = read(given)?;
            let mut judging = Judging::default();
            (judging.clearance, judging.proof) = (clearance, proof.unwrap_or(true));
            let request = asked(&program, target.as_deref(), root)?.judging(judging);
            let request = match (gouge, excess) {
                (None, None) => request,
                (Some(gouge), Some(excess)) => request.limits(gouge, excess),
                _ => {
                    return Err(Refusal::Said(
                        "expected both `gouge` and `excess`, or neither".to_owned(),
                    ));
                }
            };
            run(request, &program, limit)
        }
        "simulate_program" => {
            let Simulate { program } = read(given)?;
            run(asked(&program, None, root)?.task(Task::Simulate), &program, limit)
        }
        "compare_parts" => compare(&read(given)?, root, limit),
        "section" => section(&read(given)?, root, limit),
        other => Err(Refusal::Parameters(format!("there is no tool {other:?}"))),
    }
}

/// The parameters of a tool. Those that it does not know would be asked for in vain.
fn read<T: DeserializeOwned + JsonSchema>(given: Map<String, Value>) -> Result<T, Refusal> {
    let schema = schema_for!(T);
    let known = schema.get("properties").and_then(Value::as_object);
    let known = known.map_or(Vec::new(), |known| known.keys().map(String::as_str).collect());
    if let Some(other) = given.keys().find(|name| !known.contains(&name.as_str())) {
        let known = known.join(", ");
        return Err(Refusal::Parameters(format!(
            "there is no parameter {other:?}: expected {known}"
        )));
    }
    serde_json::from_value(Value::Object(given)).map_err(|error| Refusal::Parameters(error.to_string()))
}

/// A file within the root.
fn confined<'a>(name: &'a str, root: &Path) -> Result<&'a Path, Refusal> {
    let file = Path::new(name);
    match is_within(file, Some(root)) {
        true => Ok(file),
        false => Err(Refusal::Said(format!("{name}: expected a file below the root"))),
    }
}

/// How a program is read: its machine may have a name instead of a file.
fn dialect(controller: Option<&str>, machine: Option<&str>, root: &Path) -> Result<DialectOptions, Refusal> {
    let mut dialect = DialectOptions::default();
    dialect.controller = controller.map(str::to_owned);
    if let Some(name) = machine {
        if Machine::named(name).is_none() {
            confined(name, root)?;
        }
        dialect.machine = Some(name.to_owned());
    }
    dialect.within = Some(root.to_owned());
    Ok(dialect)
}

/// A request about a program.
fn asked(program: &Program, target: Option<&str>, root: &Path) -> Result<Request, Refusal> {
    let mut options = ProgramOptions::default();
    options.dialect = dialect(program.controller.as_deref(), program.machine.as_deref(), root)?;
    if let Some(file) = &program.tools {
        options.tools = Some(confined(file, root)?.to_owned());
    }
    if let Some(text) = &program.stock {
        let stock = stock(text).map_err(|error| Refusal::Said(format!("stock: {error}")))?;
        if let StockOption::Mesh(_) = stock {
            confined(text, root)?;
        }
        options.stock = Some(stock);
    }
    if let Some(file) = target {
        options.target = Some(confined(file, root)?.to_owned());
    }
    Ok(Request::from_file(confined(&program.path, root)?)
        .program(options)
        .cell(program.cell)
        .view(view())
        .outputs([Output::Picture]))
}

fn run(request: Request, program: &Program, limit: &Limit) -> Result<Answer, Refusal> {
    let outcome = request.plan()?.run(limit)?;
    Ok(answers::of_run(&outcome, program.picture.unwrap_or(true), limit)?)
}

fn inspect(asked: &Inspect, root: &Path) -> Result<Answer, Refusal> {
    let dialect = dialect(asked.controller.as_deref(), asked.machine.as_deref(), root)?;
    Ok(answers::of_description(&describe(
        confined(&asked.path, root)?,
        &dialect,
    )?))
}

fn compare(asked: &Compare, root: &Path, limit: &Limit) -> Result<Answer, Refusal> {
    let mut request = CompareRequest::new(confined(&asked.part, root)?, confined(&asked.target, root)?);
    request.view = view();
    if asked.gouge.is_some() || asked.excess.is_some() {
        let both = [asked.gouge, asked.excess].map(|limit| limit.unwrap_or(0.1));
        if !both.iter().all(|limit| *limit >= 0.0 && limit.is_finite()) {
            return Err(Refusal::Said("expected limits of 0 or more".to_owned()));
        }
        request.limits = Some(DeviationLimits::Both(both));
    }
    Ok(answers::of_difference(request.read()?.compare(limit)?)?)
}

fn section(asked_for: &Section, root: &Path, limit: &Limit) -> Result<Answer, Refusal> {
    let plane = plane(&asked_for.plane).map_err(|error| Refusal::Said(format!("plane: {error}")))?;
    let chord = asked_for.chord.unwrap_or(CHORD);
    if !(chord > 0.0 && chord.is_finite()) {
        return Err(Refusal::Said(
            "chord: expected a positive number of millimetres".to_owned(),
        ));
    }
    let plan = asked(&asked_for.program, None, root)?.task(Task::Section).plan()?;
    Ok(answers::of_section(&plan.section(&plane, chord, limit)?))
}
