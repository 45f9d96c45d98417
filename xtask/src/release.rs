//! `cargo xtask release --dry-run`: what must hold of a release beyond the gate, step by step; nothing is published.

use crate::{bom, standalone, workspace};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// What became of a step.
enum Outcome {
    Holds,
    Fails(String),
    /// What it would have needed.
    Skipped(String),
}

type Step = fn() -> Result<Outcome, String>;

/// What must hold, and how it is found out.
const STEPS: [(&str, Step); 6] = [
    ("change logs name what is new", change_logs),
    ("the least versions that Cargo.toml allows compile", least_versions),
    ("the interfaces are compatible with the last release", compatible),
    ("examples run outside the workspace", examples),
    ("the packages can be published", publishable),
    ("the bill of materials can be written", bill),
];

/// Goes through all steps, whichever fail; `true` if none does.
pub fn dry_run() -> Result<bool, String> {
    let mut good = true;
    let mut lines = Vec::new();
    for (what, step) in STEPS {
        println!("=== {what}");
        let outcome = step().unwrap_or_else(Outcome::Fails);
        good &= !matches!(outcome, Outcome::Fails(_));
        lines.push(match outcome {
            Outcome::Holds => format!("holds    {what}"),
            Outcome::Fails(why) => format!("FAILS    {what}: {why}"),
            Outcome::Skipped(why) => format!("skipped  {what}: {why}"),
        });
    }
    println!("\n{}", lines.join("\n"));
    Ok(good)
}

fn change_logs() -> Result<Outcome, String> {
    let crates = workspace::root().join("crates");
    let mut silent = Vec::new();
    for entry in fs::read_dir(&crates).map_err(|error| format!("crates: {error}"))? {
        let folder = entry.map_err(|error| format!("crates: {error}"))?.path();
        let log = fs::read_to_string(folder.join("CHANGELOG.md")).unwrap_or_default();
        if unreleased(&log).is_empty() {
            silent.push(workspace::name_of(&folder));
        }
    }
    Ok(if silent.is_empty() {
        Outcome::Holds
    } else {
        silent.sort();
        Outcome::Fails(format!(
            "nothing under Unreleased in CHANGELOG.md of {}",
            silent.join(", ")
        ))
    })
}

/// The lines under the heading *Unreleased* that say something.
fn unreleased(log: &str) -> Vec<&str> {
    log.lines()
        .skip_while(|line| !(line.starts_with("## ") && line.contains("Unreleased")))
        .skip(1)
        .take_while(|line| !line.starts_with("## "))
        .filter(|line| !line.trim().is_empty() && !line.starts_with('#'))
        .collect()
}

/// Checked in a clone, since it renews `Cargo.lock`. That a dependency's own dependencies are at their least is not
/// asked.
fn least_versions() -> Result<Outcome, String> {
    let clone = target()?.join("least");
    if clone.exists() {
        fs::remove_dir_all(&clone).map_err(|error| format!("{}: {error}", clone.display()))?;
    }
    let root = workspace::root();
    let mut clones = Command::new("git");
    clones.args(["clone", "--quiet", "--shared"]).arg(&root).arg(&clone);
    if !succeeds(&mut clones)? {
        return Ok(Outcome::Skipped("this is no git repository".into()));
    }
    let mut update = cargo(&["update", "--quiet", "-Z", "direct-minimal-versions"], &clone);
    // An option that is not stable; it says what to write in `Cargo.toml` if two requirements cannot both be at their
    // least.
    if !succeeds(update.env("RUSTC_BOOTSTRAP", "1"))? {
        return Ok(Outcome::Fails(
            "Cargo.toml asks for less than a dependency of ours does".into(),
        ));
    }
    let mut check = cargo(
        &["check", "--quiet", "--workspace", "--all-features", "--lib", "--bins"],
        &clone,
    );
    check.env("CARGO_TARGET_DIR", target()?.join("least-target"));
    holds(&mut check, "the committed code does not compile with them")
}

fn compatible() -> Result<Outcome, String> {
    if !succeeds(&mut cargo(&["semver-checks", "--version"], &workspace::root()))? {
        return Ok(Outcome::Skipped("cargo-semver-checks is not installed".into()));
    }
    let described = Command::new("git")
        .args(["describe", "--tags", "--abbrev=0", "--match", "v[0-9]*"])
        .current_dir(workspace::root())
        .output()
        .map_err(|error| format!("git: {error}"))?;
    let tag = String::from_utf8_lossy(&described.stdout).trim().to_owned();
    if tag.is_empty() {
        return Ok(Outcome::Skipped("there is no tag of a release to compare with".into()));
    }
    let mut check = cargo(
        &["semver-checks", "--workspace", "--baseline-rev", &tag],
        &workspace::root(),
    );
    holds(&mut check, "see above")
}

fn examples() -> Result<Outcome, String> {
    Ok(if standalone::run(&[])? {
        Outcome::Holds
    } else {
        Outcome::Fails("see above".into())
    })
}

fn publishable() -> Result<Outcome, String> {
    let mut publish = cargo(
        &["publish", "--workspace", "--dry-run", "--locked", "--quiet"],
        &workspace::root(),
    );
    holds(&mut publish, "see above")
}

fn bill() -> Result<Outcome, String> {
    bom::bom().map(|_| Outcome::Holds)
}

fn holds(command: &mut Command, otherwise: &str) -> Result<Outcome, String> {
    Ok(if succeeds(command)? {
        Outcome::Holds
    } else {
        Outcome::Fails(otherwise.into())
    })
}

fn succeeds(command: &mut Command) -> Result<bool, String> {
    let status = command
        .status()
        .map_err(|error| format!("{}: {error}", command.get_program().display()))?;
    Ok(status.success())
}

fn cargo(arguments: &[&str], folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO"));
    command.args(arguments).current_dir(folder);
    command
}

/// Where this command keeps what it compiles.
fn target() -> Result<PathBuf, String> {
    let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| workspace::root().join("target"), Into::into);
    std::path::absolute(target)
        .map(|target| target.join("dry-run"))
        .map_err(|error| format!("target: {error}"))
}

#[cfg(test)]
mod tests {
    use super::unreleased;

    #[test]
    fn what_is_unreleased_is_what_stands_under_the_heading() {
        let log = "# Changes\n\n## Unreleased\n\n### Added\n\n- A reader.\n\n## 0.1.0\n\n- The first.\n";
        assert_eq!(unreleased(log), ["- A reader."]);
        assert!(unreleased("## [Unreleased]\n\n## 0.1.0\n\n- The first.\n").is_empty());
        assert!(unreleased("## 0.1.0\n\n- The first.\n").is_empty());
    }
}
