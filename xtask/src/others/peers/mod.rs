//! `cargo xtask peers`: other programs on the same work, in one run. They come from their registries into cargo's
//! target folder; the workspace's lock file does not know them, and whoever cannot be had is skipped.

mod work;

use crate::bench::{on, shortest};
use crate::workspace;
use std::fs;
use std::path::{Path as FilePath, PathBuf};
use std::process::Command;
pub use work::Work;
use work::{Answer, errors};

const MANIFOLD3D: [&str; 2] = ["manifold3d==3.5.4", "numpy"];

/// A peer that is ready to run.
struct Peer {
    name: &'static str,
    /// The program, and the arguments before all others.
    program: PathBuf,
    first: Vec<PathBuf>,
    answer: Answer,
}

/// One way to run a peer: the step or tolerance in mm, and further arguments.
struct Setting {
    what: &'static str,
    value: f64,
    last: &'static [&'static str],
}

/// Where the peers are built, and where works and answers go.
fn folder() -> Result<PathBuf, String> {
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let target = own.parent().and_then(FilePath::parent).ok_or("cargo's target folder")?;
    let folder = target.join("peers");
    fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    Ok(folder)
}

/// Runs a command quietly; the last line of what it complained about if it fails.
fn done(command: &mut Command) -> Result<String, String> {
    let output = command.output().map_err(|error| error.to_string())?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
    Err(complaint
        .lines()
        .rfind(|line| !line.trim().is_empty())
        .unwrap_or("failed")
        .to_owned())
}

/// A separate package under `xtask/peers`.
fn package(folder: &FilePath, name: &'static str, package: &str, answer: Answer) -> Result<Peer, String> {
    let manifest = workspace::root().join("xtask/peers").join(name).join("Cargo.toml");
    let mut build = Command::new(env!("CARGO"));
    build
        .args(["build", "--quiet", "--release", "--locked", "--manifest-path"])
        .arg(manifest)
        .arg("--target-dir")
        .arg(folder);
    done(&mut build)?;
    let program = folder.join("release").join(package);
    Ok(Peer {
        name,
        program,
        first: Vec::new(),
        answer,
    })
}

/// A virtual environment with the Python package.
fn manifold3d(folder: &FilePath) -> Result<Peer, String> {
    let environment = folder.join("venv");
    let python = environment.join("bin/python");
    if !python.exists() {
        done(Command::new("python3").args(["-m", "venv"]).arg(&environment))?;
    }
    done(
        Command::new(&python)
            .args(["-m", "pip", "install", "--quiet"])
            .args(MANIFOLD3D),
    )?;
    let script = workspace::root().join("xtask/peers/manifold3d_mill.py");
    Ok(Peer {
        name: "manifold3d",
        program: python,
        first: vec![script],
        answer: Answer::Triangles,
    })
}

/// Runs the peers beside the exact simulation. `fine`: also with steps that take minutes.
pub fn run(fine: bool) -> Result<(), String> {
    let folder = folder()?;
    let wanted = [
        (
            "BREP_cam",
            package(&folder, "brep_cam", "brep-cam-mill", Answer::Columns),
        ),
        (
            "cutrail",
            package(&folder, "cutrail", "cutrail-mill", Answer::Triangles),
        ),
        ("manifold3d", manifold3d(&folder)),
        (
            "CAMotics",
            Err("neither Debian nor another registry that this command uses has it".to_owned()),
        ),
    ];
    let mut peers = Vec::new();
    for (name, found) in wanted {
        match found {
            Ok(peer) => peers.push(peer),
            Err(reason) => println!("{name} is skipped: {reason}"),
        }
    }
    let header = ["work", "who", "s", "/ sweepsim", "max, mm", "p99, mm"];
    println!(
        "One thread, processor time, one run. Errors: distances from the exact surface, away from the raster's border."
    );
    println!(
        "{:<24} {:<34} {:>9} {:>10} {:>9} {:>9}",
        header[0], header[1], header[2], header[3], header[4], header[5]
    );
    let step = |value| Setting {
        what: "tri-dexels, step",
        value,
        last: &[],
    };
    let tolerance = |value| Setting {
        what: "tolerance",
        value,
        last: &[],
    };
    for ball in [false, true] {
        let z = Setting {
            what: "Z-dexels",
            value: 0.1,
            last: &["z"],
        };
        compare(&folder, &Work::three_axis(ball)?, "3 axes", &peers, |peer| {
            if peer == "brep_cam" { vec![&z] } else { vec![] }
        })?;
    }
    let (steps, tolerances) = ([step(0.5), step(0.1), step(0.02)], [tolerance(0.1), tolerance(0.01)]);
    let (steps, tolerances) = if fine {
        (&steps[..], &tolerances[..])
    } else {
        (&steps[..2], &tolerances[..1])
    };
    for ball in [false, true] {
        let settings = |peer: &str| {
            if peer == "brep_cam" {
                steps.iter().collect()
            } else {
                tolerances.iter().collect()
            }
        };
        compare(&folder, &Work::five_axis(ball)?, "5 axes", &peers, settings)?;
    }
    Ok(())
}

/// One work by all.
fn compare<'a>(
    folder: &FilePath,
    work: &Work,
    axes: &str,
    peers: &[Peer],
    settings: impl Fn(&str) -> Vec<&'a Setting>,
) -> Result<(), String> {
    let title = format!(
        "{axes}, {} moves, {}",
        work.moves(),
        if work.ball { "ball" } else { "flat" }
    );
    let stock = work.stock()?;
    let exact = work.simulate(stock.clone())?;
    let own = on(1, || shortest(|| work.simulate(stock.clone()).map(drop)))??;
    println!(
        "{title:<24} {:<34} {own:>9.3} {:>10.2} {:>9} {:>9}",
        "sweepsim, tolerance 1e-6", 1.0, "", ""
    );
    let (file, answer) = (folder.join("work.csv"), folder.join("answer"));
    fs::write(&file, work.file()).map_err(|error| format!("{}: {error}", file.display()))?;
    for peer in peers {
        for setting in settings(peer.name) {
            let value = setting.value.to_string();
            let mut command = Command::new(&peer.program);
            command
                .args(&peer.first)
                .arg(&file)
                .arg(&value)
                .arg(&answer)
                .args(setting.last);
            let shown = if setting.last.is_empty() {
                format!(" {value}")
            } else {
                String::new()
            };
            let name = format!("{}, {}{shown}", peer.name, setting.what);
            let outcome = done(&mut command).and_then(|printed| {
                let seconds: f64 = printed.trim().parse().map_err(|_| format!("printed {printed:?}"))?;
                let bytes = fs::read(&answer).map_err(|error| error.to_string())?;
                let number = |eight: &[u8]| eight.try_into().map(f64::from_le_bytes).unwrap_or(f64::NAN);
                let numbers: Vec<f64> = bytes.chunks_exact(8).map(number).collect();
                Ok((seconds, errors(&exact, peer.answer, &numbers)?))
            });
            match outcome {
                Ok((seconds, off)) => {
                    let ratio = seconds / own;
                    println!(
                        "{title:<24} {name:<34} {seconds:>9.3} {ratio:>10.2} {:>9.1e} {:>9.1e}",
                        off.max, off.p99
                    );
                }
                Err(reason) => println!("{title:<24} {name:<34} failed: {reason}"),
            }
        }
    }
    Ok(())
}
