//! The suites that take too long for the gate, and how they are run.

use crate::workspace;
use std::process::Command;

/// Tests whose name contains this need the shared data.
const DATA: &str = "shared_data";

/// The whole brute-force suite, with `times` as many random cases.
pub fn brute_force(filter: Option<&str>, times: u32) -> Result<bool, String> {
    let mut command = tests(&["-p", "sweepsim-tests", "--test", "it"]);
    command.env("SWEEPSIM_BRUTE_FORCE", times.max(1).to_string());
    command.args(["--", "--include-ignored", "--nocapture"]);
    match filter {
        Some(filter) => command.arg(filter),
        None => command.args(["brute_force", DATA]),
    };
    run(without_data(command))
}

/// Every test that is ignored in the gate, except for brute force: large models, many cases.
pub fn slow(filter: Option<&str>) -> Result<bool, String> {
    let mut command = tests(&["--workspace", "--lib", "--bins", "--tests"]);
    command.args(["--", "--ignored", "--skip", "brute_force"]);
    command.args(filter);
    run(without_data(command))
}

/// Release builds: these suites take much longer to run than to compile.
fn tests(packages: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO"));
    command.current_dir(workspace::root());
    // One failure hides no other.
    command
        .args(["test", "--release", "--all-features", "--no-fail-fast"])
        .args(packages);
    command
}

fn without_data(mut command: Command) -> Command {
    if !workspace::root().join("../shared/data").is_dir() {
        println!("skipped: {DATA}, for there is no folder ../shared/data");
        command.args(["--skip", DATA]);
    }
    command
}

fn run(mut command: Command) -> Result<bool, String> {
    let status = command.status().map_err(|error| format!("cargo test: {error}"))?;
    Ok(status.success())
}
