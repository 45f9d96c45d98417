//! A digest of the sources of which results depend: what another build has found is not taken for its own.

use std::collections::hash_map::DefaultHasher;
use std::fs;
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};

/// The files of a folder, and of those in it, in order.
fn files(folder: &Path, all: &mut Vec<PathBuf>) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut own: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    own.sort();
    for path in own {
        if path.is_dir() {
            files(&path, all);
        } else {
            all.push(path);
        }
    }
}

fn main() {
    // Packages from a registry are told apart by their version.
    const CRATES: [&str; 12] = [
        "check", "dexel", "formats", "job", "machine", "motion", "nc", "picture", "proof", "report", "solve", "spline",
    ];
    let names = CRATES.map(|name| format!("../sweepsim-{name}/src"));
    let mut all = vec![PathBuf::from("../../Cargo.lock")];
    for folder in names.iter().map(String::as_str).chain(["../sweepsim/src"]) {
        println!("cargo::rerun-if-changed={folder}");
        files(Path::new(folder), &mut all);
    }
    println!("cargo::rerun-if-changed=../../Cargo.lock");
    let mut digest = DefaultHasher::new();
    for file in &all {
        file.hash(&mut digest);
        fs::read(file).unwrap_or_default().hash(&mut digest);
    }
    let target = std::env::var("TARGET").unwrap_or_default();
    println!("cargo::rustc-env=SWEEPSIM_SOURCES={:016x} {target}", digest.finish());
}
