//! `cargo xtask generate`: writes the jobs and paths under `fixtures/` that are computed rather than written by hand.

mod blade;
mod bracket;
mod cavity;
mod impeller;
mod railing;
pub mod router;
mod teapot;
mod toolpath;

use crate::workspace;
use std::{fs, io};

/// Every generated file: its place under `fixtures/` and its text.
fn files() -> Vec<(&'static str, String)> {
    let mut files = teapot::files();
    files.extend(cavity::files());
    files.extend(impeller::files());
    files.extend(blade::files());
    files.extend(router::files());
    files.extend(railing::files());
    files.extend(bracket::files());
    files
}

/// Writes the files that differ, or with `check` only names them. `true` when nothing differs.
pub fn generate(check: bool) -> io::Result<bool> {
    let mut fresh = true;
    for (place, text) in files() {
        let path = workspace::fixtures().join(place);
        let old = match fs::read_to_string(&path) {
            Ok(old) => Some(old),
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            Err(error) => return Err(error),
        };
        let state = match old {
            Some(old) if old == text => "up to date",
            Some(_) if check => "STALE",
            None if check => "MISSING",
            _ => "written",
        };
        if state != "up to date" {
            fresh = false;
            if !check {
                if let Some(folder) = path.parent() {
                    fs::create_dir_all(folder)?;
                }
                fs::write(&path, &text)?;
            }
        }
        println!("{state:<12} fixtures/{place} ({} lines)", text.lines().count());
    }
    Ok(fresh)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_files_are_up_to_date() {
        assert!(
            generate(true).expect("fixtures can be read"),
            "run `cargo xtask generate`"
        );
    }
}
