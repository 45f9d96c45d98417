//! Pictures that are drawn here: the paper's Figures 8 to 10, tools and what they sweep.

use super::sheet;
use crate::bench::{Cutter, cutter};
use sweepsim::{Cut, Options, sweep_all};
use sweepsim_dexel::{Mesh, TriDexels};
use sweepsim_motion::{Path, Pose};
use sweepsim_picture::{Drawing, Image, View};

type Make = fn() -> Result<Image, String>;

/// The figures, by the names of their files.
pub const FIGURES: [(&str, Make); 4] = [
    ("figure-8", || figure("ball")),
    ("figure-9", || figure("flat")),
    ("figure-10", || figure("form")),
    ("figure-envelope", super::envelope::envelope),
];

/// Pixels of a panel.
const PANEL: [usize; 2] = [480, 450];
/// Dexels along the longest side of a panel's solid.
const CELLS: f64 = 260.0;
/// Cosine of 40°: sharper edges are drawn sharp.
const CRISP: f64 = 0.766;

pub fn said(error: impl std::fmt::Display) -> String {
    error.to_string()
}

fn view() -> View {
    let mut view = View::default();
    view.size = PANEL;
    view.axes = false;
    view
}

/// The tool, and what it sweeps along Sweep1 and Sweep2.
fn figure(name: &str) -> Result<Image, String> {
    let cutter = cutter(name)?;
    let tool = Path::new(vec![Pose::new([0.0; 3], [0.0, 0.0, 1.0]).map_err(said)?]).map_err(said)?;
    let at_rest = swept(&cutter, &tool)?;
    let mut panels = vec![view().draw(&Drawing::new(&Mesh::default()).tool(&at_rest))];
    for which in 0..2 {
        panels.push(view().render(&swept(&cutter, &cutter.path(which)?)?));
    }
    sheet(&panels, 3)
}

/// The surface of what a tool sweeps, from dexels along three axes.
fn swept(cutter: &Cutter, path: &Path) -> Result<Mesh, String> {
    let cuts = [Cut::new(cutter.tool(), path)];
    let (min, max) = cutter.bounds(path);
    let size = [0, 1, 2].map(|k| max[k] - min[k]);
    let step = size.into_iter().fold(0.0, f64::max) / CELLS;
    let cells = size.map(|s| (s / step).ceil() as usize);
    let mut sets = TriDexels::empty(min, max, cells).map_err(said)?.into_sets();
    for set in &mut sets {
        let done = sweep_all(&cuts, set.grid(), &Options::new(1e-6), &()).map_err(said)?;
        if !done.statistics.unresolved.is_empty() {
            return Err(format!("{} unresolved dexels", done.statistics.unresolved.len()));
        }
        *set = done.volume;
    }
    let solid = TriDexels::from_sets(sets).map_err(said)?;
    solid.surface().and_then(|mesh| mesh.crisp(CRISP)).map_err(said)
}
