//! `convert`: from one format to another.

use crate::arguments::ConvertOptions;
use crate::failure::Failure;
use crate::solid::{Kind, Solid, bounds, picture, soup};
use crate::words;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;
use sweepsim_formats::{DexelFormat, MeshFormat, write_atomically, write_dexels_file, write_mesh_file};
use sweepsim_nc::{Options, Program, read_file, table};

/// Reads, writes, and says what came of it.
pub(crate) fn convert(options: &ConvertOptions) -> Result<(), Failure> {
    let (input, output) = (&options.input, &options.output);
    let mut text = String::new();
    let mut line = |label: &str, value: &str| {
        // A String takes all that is written to it.
        let _ = writeln!(text, "{label:>10}  {value}");
    };
    match Kind::of(input)? {
        Kind::Job => {
            return Err(Failure::message(format!(
                "{}: a job is not converted: `simulate` and `sweep` make dexels and meshes of it",
                input.display()
            )));
        }
        Kind::Path => {
            let program = read_file(input, &Options::default())?;
            path(&program, input, output)?;
            line("path", &words::counted(program.poses.len() as u64, "pose"));
            program.notes.iter().for_each(|note| line("note", &note.to_string()));
        }
        Kind::Mesh | Kind::Dexels => {
            let grid = options.grid.grid(None);
            // A mesh may bring the area, so that the number of cells alone is enough.
            let known = if Kind::of(input)? == Kind::Dexels { grid? } else { None };
            let solid = Solid::read(input, known.as_ref())?;
            write_solid(&solid, options, &mut line)?;
        }
    }
    let size = std::fs::metadata(output).map_or(0, |data| data.len());
    line("out", &format!("{} ({})", output.display(), words::bytes(size)));
    if options.quiet { Ok(()) } else { crate::print(&text) }
}

fn write_solid(solid: &Solid, options: &ConvertOptions, line: &mut impl FnMut(&str, &str)) -> Result<(), Failure> {
    let (input, output) = (&options.input, &options.output);
    let extension = output.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    if extension.as_deref() == Some("png") {
        let png = picture(&options.view, &solid.surface(), None)?;
        return Ok(write_atomically(output, |file| file.write_all(&png))?);
    }
    if let Some(format) = MeshFormat::of(output) {
        let mesh = match solid {
            Solid::Mesh(mesh) => mesh.clone(),
            // Printers want neighbours to share their vertices.
            Solid::Dexels(_) if format == MeshFormat::ThreeMf => soup(&solid.surface()).indexed(),
            Solid::Dexels(_) => solid.surface(),
        };
        line("triangles", &words::count(mesh.triangles.len() as u64));
        if format == MeshFormat::Stl || format == MeshFormat::Glb {
            line(
                "note",
                &format!("{format} has places as 32-bit numbers: they are rounded"),
            );
        }
        return Ok(write_mesh_file(&mesh, output)?);
    }
    if DexelFormat::of(output).is_none() {
        return Err(Failure::message(format!(
            "{}: the extension is not known: expected .stl, .ply, .glb, .3mf, .vtp, .csv, .dexels, .npz, .vtu or .png",
            output.display()
        )));
    }
    let grid = match solid {
        Solid::Dexels(dexels) => *dexels.grid(),
        Solid::Mesh(mesh) => options
            .grid
            .grid(bounds(mesh))?
            .ok_or_else(|| Failure::message(format!("{}: there is no triangle in this mesh", input.display())))?,
    };
    let dexels = solid.dexels(input, &grid)?;
    let [nx, ny] = grid.cells().map(|n| words::count(n as u64));
    let intervals = words::counted(dexels.count() as u64, "interval");
    line("dexels", &format!("{nx} × {ny}, {intervals}"));
    if DexelFormat::of(output) == Some(DexelFormat::Csv) {
        line("note", "a table has neither the grid nor normals and sources");
    }
    Ok(write_dexels_file(&dexels, output)?)
}

/// Writes a table of poses. Where the path breaks without a change of tool a table would join its pieces.
fn path(program: &Program, input: &Path, output: &Path) -> Result<(), Failure> {
    if output.extension().is_none_or(|e| !e.eq_ignore_ascii_case("csv")) {
        return Err(Failure::message(format!(
            "{}: paths are written as tables only: expected .csv",
            output.display()
        )));
    }
    let broken = program
        .poses
        .windows(2)
        .find(|w| !w[1].joined && w[0].tool == w[1].tool);
    if let Some([_, after]) = broken {
        return Err(Failure::message(format!(
            "{}:{}: the path breaks here without a change of tool, which a table cannot say",
            input.display(),
            after.line
        )));
    }
    Ok(write_atomically(output, |file| table::write(&program.poses, file))?)
}
