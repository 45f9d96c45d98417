//! A raster over a wavy surface, as programs of any length and with any lean of the tool.

use sweepsim_dexel::Grid;
use sweepsim_motion::{Path, Pose};

/// Side of the square, in millimetres.
pub const SIDE: f64 = 100.0;

/// The poses of so many passes of so many moves, joined by short ones, none along the grid: over a surface from −4 to
/// 4, on a square of `side`, with the axis up to `lean` radians from upright.
pub fn poses([passes, moves]: [usize; 2], side: f64, lean: f64) -> Result<Vec<Pose>, String> {
    let (sine, cosine) = 0.1_f64.sin_cos();
    let mut poses = Vec::with_capacity(passes * (moves + 1));
    for pass in 0..passes {
        for n in 0..=moves {
            let along = if pass % 2 == 0 { n } else { moves - n } as f64 / moves as f64 - 0.5;
            let across = pass as f64 / (passes - 1) as f64 - 0.5;
            let [u, v] = [0.85 * side * along, 0.85 * side * across];
            let [su, sv] = [u, v].map(|c| c * SIDE / side);
            let height = 2.0 * (0.17 * su + 0.4).sin() * (0.13 * sv).cos() - 0.02 * su;
            let tip = [cosine * u - sine * v, sine * u + cosine * v, height];
            let aside = [lean * (0.11 * su + 0.3).sin(), lean * (0.09 * sv + 0.07 * su).cos()];
            let axis = if lean == 0.0 {
                [0.0, 0.0, 1.0]
            } else {
                [0.7 * aside[0], 0.7 * aside[1], 1.0]
            };
            poses.push(Pose::new(tip, axis).map_err(|error| error.to_string())?);
        }
    }
    Ok(poses)
}

/// The program of about so many moves, on the square of the usual side: neighbouring passes are as far apart as a tenth
/// to a quarter of its moves is long.
pub fn program(moves: usize, lean: f64) -> Result<Path, String> {
    let passes = ((moves as f64).sqrt().round() as usize).max(2);
    let each = (moves / passes).max(1);
    Path::new(poses([passes, each], SIDE, lean)?).map_err(|error| error.to_string())
}

/// A grid over the square.
pub fn grid(cells: usize) -> Result<Grid, String> {
    let half = 0.5 * SIDE;
    Grid::new([-half; 2], [half; 2], [cells; 2]).map_err(|error| error.to_string())
}
