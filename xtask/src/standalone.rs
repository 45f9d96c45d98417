//! `cargo xtask standalone`: compiles and runs the first example of every library's README, as a newcomer would: in a
//! separate package outside the workspace that depends on that one crate.

use crate::workspace;
use std::path::Path;
use std::process::Command;
use std::{fs, io};

/// The first example of every README, or of the named crates.
pub fn run(only: &[String]) -> Result<bool, String> {
    let crates = workspace::root()
        .join("crates")
        .canonicalize()
        .map_err(about("crates"))?;
    let mut names: Vec<String> = fs::read_dir(&crates)
        .map_err(about("crates"))?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| only.is_empty() || only.contains(name))
        .collect();
    names.sort();
    if let Some(unknown) = only.iter().find(|name| !names.contains(name)) {
        return Err(format!("there is no crate crates/{unknown}"));
    }
    // Outside the workspace, but built where its dependencies are already compiled.
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| workspace::root().join("target"), Into::into);
    let target = std::path::absolute(target).map_err(about("target"))?.join("standalone");
    let lock = workspace::root().join("Cargo.lock");
    let mut good = true;
    for name in names {
        let folder = crates.join(&name);
        if !folder.join("src/lib.rs").is_file() || !published_library(&folder)? {
            continue;
        }
        let readme = fs::read_to_string(folder.join("README.md")).map_err(about(&name))?;
        let Some(example) = first_example(&readme) else {
            println!("{name}: no example in its README");
            good = false;
            continue;
        };
        let package = target.join("packages").join(&name);
        fs::create_dir_all(package.join("src")).map_err(about(&name))?;
        fs::write(package.join("Cargo.toml"), manifest(&name, &folder)).map_err(about(&name))?;
        fs::write(package.join("src/main.rs"), program(&example)).map_err(about(&name))?;
        // The workspace's versions: cargo drops what is not needed.
        fs::copy(&lock, package.join("Cargo.lock")).map_err(about(&name))?;
        let status = Command::new(env!("CARGO"))
            .args(["run", "--quiet"])
            .current_dir(&package)
            .env("CARGO_TARGET_DIR", &target)
            .status()
            .map_err(about(&name))?;
        println!("{name}: {}", if status.success() { "runs" } else { "FAILS" });
        good &= status.success();
    }
    Ok(good)
}

fn about<E: std::fmt::Display>(what: &str) -> impl Fn(E) -> String + '_ {
    move |error| format!("{what}: {error}")
}

/// Whether others may depend on it: the command's library is for its own tests, that of the Python package for Python.
fn published_library(folder: &Path) -> Result<bool, String> {
    let manifest: io::Result<String> = fs::read_to_string(folder.join("Cargo.toml"));
    let manifest = manifest.map_err(about("Cargo.toml"))?;
    Ok(!manifest.contains("[[bin]]") && !manifest.contains("publish = false"))
}

fn manifest(name: &str, folder: &Path) -> String {
    format!(
        "[package]\nname = \"first-{name}\"\nversion = \"0.0.0\"\nedition = \"2024\"\npublish = false\n\n\
         [dependencies]\n{name} = {{ path = {:?} }}\n\n[workspace]\n",
        folder.display().to_string()
    )
}

/// The first block of Rust, without the marks of lines that documentation hides.
fn first_example(readme: &str) -> Option<String> {
    let mut lines = readme.lines().skip_while(|line| !line.starts_with("```rust")).skip(1);
    let block = lines.by_ref().take_while(|line| !line.starts_with("```"));
    let shown = |line: &str| line.strip_prefix("# ").unwrap_or(line).to_owned();
    let block: Vec<String> = block.map(shown).collect();
    (!block.is_empty()).then(|| block.join("\n"))
}

/// The program of an example, which may consist of only the body of `main`.
fn program(example: &str) -> String {
    if example.contains("fn main") {
        return example.to_owned() + "\n";
    }
    let closed = example.contains("Ok::<(");
    let body: Vec<&str> = example.lines().filter(|line| !line.starts_with("Ok::<(")).collect();
    let body = body.join("\n");
    if closed {
        format!("fn main() -> Result<(), Box<dyn std::error::Error>> {{\n{body}\nOk(())\n}}\n")
    } else {
        format!("fn main() {{\n{body}\n}}\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn examples_become_programs() {
        let readme =
            "text\n```sh\nno\n```\n```rust\nlet x = 1;\n# let y = x;\nOk::<(), E>(())\n```\n```rust\nlater\n```\n";
        let example = first_example(readme).expect("an example");
        assert_eq!(example, "let x = 1;\nlet y = x;\nOk::<(), E>(())");
        let program = program(&example);
        assert!(program.starts_with("fn main() -> Result") && program.contains("let y = x;\nOk(())\n}"));
        assert_eq!(first_example("```sh\nno\n```\n"), None);
    }
}
