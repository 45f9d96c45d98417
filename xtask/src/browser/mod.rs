//! `cargo xtask browser`: the report of a faulty program in headless Chromium. Everything a person does with the page
//! is done here by its buttons, keys and sliders, and must show; the screenshots of the docs are taken on the way.

mod controls;
mod devtools;
mod large;
mod walk;
mod walls;

use crate::workspace;
use devtools::Browser;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// Where Chromium may be.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

fn chromium() -> Option<PathBuf> {
    let folders = std::env::var_os("PATH")?;
    std::env::split_paths(&folders)
        .flat_map(|folder| NAMES.map(|name| folder.join(name)))
        .find(|file| file.is_file())
}

/// Makes the report, opens it, and uses it. With `screenshots`, those of the docs are taken anew.
pub fn run(screenshots: bool) -> Result<bool, String> {
    let Some(program) = chromium() else {
        return Err(
            "Chromium is missing: install the package `chromium` (apt-get install -y --no-install-recommends chromium)"
                .to_owned(),
        );
    };
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| workspace::root().join("target"), PathBuf::from);
    let folder = std::path::absolute(target.join("browser")).map_err(|error| error.to_string())?;
    let begin = Instant::now();
    let report = report(&folder)?;
    planted(&folder)?;
    large::write(&folder)?;
    println!("reports      {:.1} s", begin.elapsed().as_secs_f64());
    let docs = screenshots.then(|| workspace::root().join("docs/pictures"));
    let mut good = true;
    for (name, size, flags, walk) in walk::all() {
        let begin = Instant::now();
        let profile = folder.join("profile");
        let done = Browser::start(&program, &profile, flags).and_then(|mut browser| {
            browser.resize(size)?;
            walk(&mut browser, &report, docs.as_deref())
        });
        let seconds = begin.elapsed().as_secs_f64();
        match done {
            Ok(words) => println!("{name:<12} {seconds:.1} s  {words}"),
            Err(error) => {
                println!("{name:<12} {seconds:.1} s  FAILED: {error}");
                good = false;
            }
        }
    }
    Ok(good)
}

/// A command of sweepsim as users run it.
fn sweepsim() -> Command {
    // Beside this program, if it was built with the workspace; otherwise cargo builds it.
    let beside = std::env::current_exe().ok().map(|own| own.with_file_name("sweepsim"));
    match beside.filter(|file| file.is_file()) {
        Some(file) => Command::new(file),
        None => {
            let mut cargo = Command::new(env!("CARGO"));
            cargo.args(["run", "--quiet", "--package", "sweepsim-cli", "--"]);
            cargo
        }
    }
}

/// The report of a faulty job, in a folder.
fn verified(job: &Path, folder: &Path, options: &[&str]) -> Result<PathBuf, String> {
    let status = sweepsim()
        .arg("verify")
        .arg(job)
        .args(["--quiet", "--only", "report,picture", "--size", "900x600", "--out"])
        .arg(folder)
        .args(options)
        .status()
        .map_err(|error| format!("sweepsim: {error}"))?;
    if status.code() != Some(1) {
        return Err(format!(
            "{} must fail with 1, but sweepsim ended with {status}",
            job.display()
        ));
    }
    Ok(folder.join("report.html"))
}

/// The report of the faulty bracket.
fn report(folder: &Path) -> Result<PathBuf, String> {
    verified(&workspace::fixtures().join("verify/bracket-faulty.ron"), folder, &[])
}

/// The report of a part with known faults; and another on lines along z alone.
fn planted(folder: &Path) -> Result<PathBuf, String> {
    let folder = folder.join("walls");
    let write = |name: &str, text: &str| {
        let file = folder.join(name);
        std::fs::write(&file, text).map_err(|error| format!("{}: {error}", file.display()))
    };
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    write("walls.nc", walls::PROGRAM)?;
    write("walls.stl", &walls::target())?;
    write("walls.ron", walls::JOB)?;
    let job = folder.join("walls.ron");
    verified(&job, &folder.join("lines"), &["--directions", "z"])?;
    verified(&job, &folder, &[])
}
