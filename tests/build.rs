//! Tells the tests whether the shared data lies beside the project, so that those which need it are listed as ignored
//! where it is absent. After it was put there, this file has to be touched.

use std::path::Path;

const DATA: &str = "../../shared/data";

fn main() {
    println!("cargo::rustc-check-cfg=cfg(shared_data)");
    println!("cargo::rerun-if-changed=build.rs");
    if Path::new(DATA).is_dir() {
        println!("cargo::rustc-cfg=shared_data");
        // Only what is there: cargo looks again in each run for what is missing, and compiles all tests anew.
        println!("cargo::rerun-if-changed={DATA}/MANIFEST.tsv");
    }
}
