//! `convert`: from one format to another.

use crate::arguments::ConvertOptions;
use crate::session::{Failure, Kind, Lines, Solid, bounds, picture, soup, words};
use std::io::Write as _;
use std::path::Path;
use sweepsim_formats::{DexelFormat, MeshFormat, write_atomically, write_dexels_file, write_mesh_file};
use sweepsim_nc::{Program, ReadOptions, read_file, table};

/// Reads one file, writes the other, and prints a summary.
pub(crate) fn convert(options: &ConvertOptions) -> Result<(), Failure> {
    let (input, output) = (&options.input, &options.output);
    let mut lines = Lines::default();
    let mut line = |label: &str, value: &str| lines.line(label, value);
    match Kind::of(input)? {
        Kind::Job => {
            return Err(Failure::message(format!(
                "{}: jobs cannot be converted: use `simulate` or `sweep` to get dexels and meshes",
                input.display()
            )));
        }
        Kind::Path => {
            let program = read_file(input, &ReadOptions::default())?;
            path(&program, input, output)?;
            line("path", &words::counted(program.poses.len() as u64, "pose"));
            program.notes.iter().for_each(|note| line("note", &note.to_string()));
        }
        Kind::Mesh | Kind::Dexels => {
            let grid = options.grid.grid(None);
            // The mesh provides the area, so the number of cells is enough.
            let known = if Kind::of(input)? == Kind::Dexels { grid? } else { None };
            let solid = Solid::read(input, known.as_ref())?;
            write_solid(&solid, options, &mut line)?;
        }
    }
    let size = std::fs::metadata(output).map_or(0, |data| data.len());
    line("out", &format!("{} ({})", output.display(), words::bytes(size)));
    if options.quiet { Ok(()) } else { lines.print() }
}

fn write_solid(solid: &Solid, options: &ConvertOptions, line: &mut impl FnMut(&str, &str)) -> Result<(), Failure> {
    let (input, output) = (&options.input, &options.output);
    let extension = output.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    if extension.as_deref() == Some("png") {
        let png = picture(&options.view, &solid.surface()?, None)?;
        return Ok(write_atomically(output, |file| file.write_all(&png))?);
    }
    if let Some(format) = MeshFormat::of(output) {
        let mesh = match solid {
            Solid::Mesh(mesh) => mesh.clone(),
            // 3D printers need triangles that share vertices.
            Solid::Dexels(_) if format == MeshFormat::ThreeMf => soup(&solid.surface()?).indexed()?,
            Solid::Dexels(_) => solid.surface()?,
        };
        line("triangles", &words::count(mesh.triangles.len() as u64));
        if format == MeshFormat::Stl || format == MeshFormat::Glb {
            line(
                "note",
                &format!("{format} stores coordinates as 32-bit floats: they are rounded"),
            );
        }
        return Ok(write_mesh_file(&mesh, output)?);
    }
    if DexelFormat::of(output).is_none() {
        return Err(Failure::message(format!(
            "{}: unknown extension: expected .stl, .ply, .glb, .3mf, .vtp, .csv, .dexels, .npz, .vtu or .png",
            output.display()
        )));
    }
    let grid = match solid {
        Solid::Dexels(dexels) => *dexels.grid(),
        Solid::Mesh(mesh) => options
            .grid
            .grid(bounds(mesh))?
            .ok_or_else(|| Failure::message(format!("{}: this mesh has no triangles", input.display())))?,
    };
    let dexels = solid.dexels(input, &grid)?;
    let [nx, ny] = grid.cells().map(|n| words::count(n as u64));
    let intervals = words::counted(dexels.count() as u64, "interval");
    line("dexels", &format!("{nx} × {ny}, {intervals}"));
    if DexelFormat::of(output) == Some(DexelFormat::Csv) {
        line("note", "a table contains neither the grid nor normals and sources");
    }
    Ok(write_dexels_file(&dexels, output)?)
}

/// Writes a table of poses. A table cannot express a break in the path without a tool change.
fn path(program: &Program, input: &Path, output: &Path) -> Result<(), Failure> {
    if output.extension().is_none_or(|e| !e.eq_ignore_ascii_case("csv")) {
        return Err(Failure::message(format!(
            "{}: paths can only be written as tables: expected .csv",
            output.display()
        )));
    }
    let broken = program
        .poses
        .windows(2)
        .find(|w| !w[1].joined && w[0].tool == w[1].tool);
    if let Some([_, after]) = broken {
        return Err(Failure::message(format!(
            "{}:{}: the path breaks here without a tool change, which a table cannot express",
            input.display(),
            after.line
        )));
    }
    Ok(write_atomically(output, |file| table::write(&program.poses, file))?)
}
