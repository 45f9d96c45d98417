//! What the project predicts against what a shop logged and measured: docs/validation.md.

mod log;
mod model;
mod qif;
mod size;
mod time;

use crate::{Prediction, workspace};

/// Compares predictions with the shop's data, prints tables and draws the plots of docs/validation.md. Says so where
/// the data are absent.
pub fn run(what: Prediction) -> Result<(), String> {
    let shop = workspace::root().join("../shared/data/shop/nist_smstestbed");
    if !shop.is_dir() {
        println!("skipped: there is no folder ../shared/data/shop/nist_smstestbed");
        return Ok(());
    }
    match what {
        Prediction::Size => size::run(&shop).map(|text| println!("{text}")),
        Prediction::Fit => time::fit(&shop).map(|text| println!("{text}")),
        Prediction::Time => {
            let (text, plot) = time::run(&shop)?;
            println!("{text}");
            let file = workspace::root().join("docs/pictures/validation-time.svg");
            std::fs::write(&file, plot).map_err(|error| format!("{}: {error}", file.display()))
        }
    }
}
