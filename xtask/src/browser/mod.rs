//! `cargo xtask browser`: the report of a faulty program in headless Chromium. Everything a person does with the page
//! is done here by its buttons, keys and sliders, and must show; the screenshots of the docs are taken on the way.

mod devtools;
mod walk;

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
    println!("report       {:.1} s", begin.elapsed().as_secs_f64());
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

/// The report of the faulty bracket, made by the command as users run it.
fn report(folder: &Path) -> Result<PathBuf, String> {
    // Beside this program, if it was built with the workspace; otherwise cargo builds it.
    let beside = std::env::current_exe().ok().map(|own| own.with_file_name("sweepsim"));
    let mut command = match beside.filter(|file| file.is_file()) {
        Some(file) => Command::new(file),
        None => {
            let mut cargo = Command::new(env!("CARGO"));
            cargo.args(["run", "--quiet", "--package", "sweepsim-cli", "--"]);
            cargo
        }
    };
    let job = workspace::fixtures().join("verify/bracket-faulty.ron");
    let status = command
        .arg("verify")
        .arg(job)
        .args(["--quiet", "--only", "report,picture", "--size", "900x600", "--out"])
        .arg(folder)
        .status()
        .map_err(|error| format!("sweepsim: {error}"))?;
    if status.code() != Some(1) {
        return Err(format!(
            "the faulty bracket must fail with 1, but sweepsim ended with {status}"
        ));
    }
    Ok(folder.join("report.html"))
}
