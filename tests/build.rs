//! Tells the tests whether the shared data lies beside the project, so that those which need it are listed as ignored
//! where it is absent.

use std::path::Path;

const DATA: &str = "../../shared/data";

fn main() {
    println!("cargo::rustc-check-cfg=cfg(shared_data)");
    println!("cargo::rerun-if-changed=build.rs");
    // Looked for again whenever the folder above the project changes.
    println!("cargo::rerun-if-changed=../..");
    if Path::new(DATA).is_dir() {
        println!("cargo::rustc-cfg=shared_data");
    }
}
