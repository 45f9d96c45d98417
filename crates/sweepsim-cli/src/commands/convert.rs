//! `convert`: from one format to another.

use super::tri_surface::lattice;
use crate::arguments::ConvertOptions;
use crate::session::interruption::writing;
use crate::session::{Failure, Kind, Lines, Solid, bounds, decimated, picture, save, soup, words};
use std::borrow::Cow;
use std::io::Write as _;
use std::ops::ControlFlow;
use sweepsim_dexel::{Dexels, Grid, Stock, TriDexels};
use sweepsim_formats::{DexelFormat, MeshFormat, write_dexels_file, write_mesh_file, write_tri_dexels};
use sweepsim_nc::tools::{read_library, to_ron};
use sweepsim_nc::{Program, read_file, table, write};

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
            let extension = output
                .extension()
                .map(|e| e.to_string_lossy().to_ascii_lowercase())
                .unwrap_or_default();
            let program = read_program(options, &extension)?;
            let lost = path(&program, options, &extension)?;
            line("path", &words::counted(program.poses.len() as u64, "pose"));
            lost.iter()
                .for_each(|what| line("note", &format!("not written: {what}")));
            program.notes.iter().for_each(|note| line("note", &note.to_string()));
        }
        Kind::Tools => tools(options, &mut line)?,
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
        let (png, missed) = picture(&options.view, &solid.surface()?, None, &|_| ControlFlow::Continue(()))?;
        if let Some(first) = missed.into_iter().next() {
            return Err(Failure::message(first));
        }
        return save(output, |file| file.write_all(&png));
    }
    if let Some(format) = MeshFormat::of(output) {
        let surface = match solid {
            Solid::Mesh(mesh) => mesh.clone(),
            Solid::Dexels(_) | Solid::TriDexels(_) => solid.surface()?,
        };
        let (mut mesh, note) = decimated(&surface, options.decimate)?;
        if let Some(note) = note {
            line("note", &note);
        }
        // 3D printers need triangles that share vertices.
        if format == MeshFormat::ThreeMf && !matches!(solid, Solid::Mesh(_)) {
            mesh = Cow::Owned(soup(&mesh).indexed()?);
        }
        line("triangles", &words::count(mesh.triangles.len() as u64));
        if format == MeshFormat::Stl || format == MeshFormat::Glb {
            line(
                "note",
                &format!("{format} stores coordinates as 32-bit floats: they are rounded"),
            );
        }
        return writing(Some(&output.to_string_lossy()), || Ok(write_mesh_file(&mesh, output)?));
    }
    if DexelFormat::of(output).is_none() {
        return Err(Failure::message(format!(
            "{}: unknown extension: expected .stl, .ply, .glb, .3mf, .vtp, .csv, .dexels, .tridexels, .npz, .vtu or .png",
            output.display()
        )));
    }
    let grid = match solid {
        Solid::Dexels(dexels) => *dexels.grid(),
        Solid::TriDexels(solid) => *solid.sets()[2].grid(),
        Solid::Mesh(mesh) => options
            .grid
            .grid(bounds(mesh))?
            .ok_or_else(|| Failure::message(format!("{}: this mesh has no triangles", input.display())))?,
    };
    if DexelFormat::of(output) == Some(DexelFormat::Tri) {
        return write_tri(solid, &grid, options, line);
    }
    let dexels = solid.dexels(input, &grid)?;
    let [nx, ny] = grid.cells().map(|n| words::count(n as u64));
    let intervals = words::counted(dexels.count() as u64, "interval");
    line("dexels", &format!("{nx} × {ny}, {intervals}"));
    if DexelFormat::of(output) == Some(DexelFormat::Csv) {
        line("note", "a table contains neither the grid nor normals and sources");
    }
    writing(Some(&output.to_string_lossy()), || {
        Ok(write_dexels_file(&dexels, output)?)
    })
}

/// Writes dexels along three axes.
fn write_tri(
    solid: &Solid,
    grid: &Grid,
    options: &ConvertOptions,
    line: &mut impl FnMut(&str, &str),
) -> Result<(), Failure> {
    let file = options.input.display();
    let failed = |error: &dyn std::error::Error| Failure::message(format!("{file}: {error}"));
    let made = match solid {
        Solid::TriDexels(solid) => TriDexels::clone(solid),
        Solid::Mesh(mesh) => {
            let heights = bounds(mesh).map_or([0.0; 2], |[low, high]| [low[2], high[2]]);
            let (min, max, cells) = lattice(grid, heights);
            TriDexels::new(min, max, cells, &Stock::Mesh(soup(mesh))).map_err(|error| failed(&error))?
        }
        Solid::Dexels(_) => {
            return Err(Failure::message(format!(
                "{file}: these dexels are along z only: expected .tridexels (--only tridexels) or a mesh"
            )));
        }
    };
    let intervals: usize = made.sets().iter().map(Dexels::count).sum();
    let [nx, ny, nz] = made.cells().map(|n| words::count(n as u64));
    let intervals = words::counted(intervals as u64, "interval");
    line("dexels", &format!("{nx} × {ny} × {nz}, {intervals}"));
    save(&options.output, |out| write_tri_dexels(&made, out))
}

/// Reads a program as its output needs it: tables have no arcs.
fn read_program(options: &ConvertOptions, extension: &str) -> Result<Program, Failure> {
    let mut reading = options.dialect.reading().map_err(Failure::message)?;
    reading.exact_arcs = extension != "csv";
    Ok(read_file(&options.input, &reading)?)
}

/// Writes a program, and returns what the format cannot say.
fn path(program: &Program, options: &ConvertOptions, extension: &str) -> Result<Vec<String>, Failure> {
    let output = &*options.output;
    let mut lost = Vec::new();
    match extension {
        "csv" => save(output, |file| table::write(&program.poses, file))?,
        "cls" | "clsf" | "apt" | "ncl" => save(output, |file| {
            lost = write::clsf(program, file)?;
            Ok(())
        })?,
        "txt" => save(output, |file| write::canonical(program, file))?,
        "nc" | "ngc" | "tap" | "gcode" | "mpf" | "spf" | "h" => {
            let writing = options.writing.options(extension).map_err(Failure::message)?;
            let written = write::gcode(program, &writing).map_err(|error| Failure::message(error.to_string()))?;
            save(output, |file| file.write_all(written.text.as_bytes()))?;
            lost = written.lost;
        }
        _ => {
            return Err(Failure::message(format!(
                "{}: programs can be written as G-code (.nc, .ngc, .tap, .mpf, .h), CLSF (.cls, .apt), tables (.csv) and text (.txt): expected one of them",
                output.display()
            )));
        }
    }
    Ok(lost)
}

/// Writes tools as fields of a job.
fn tools(options: &ConvertOptions, line: &mut impl FnMut(&str, &str)) -> Result<(), Failure> {
    let (input, output) = (&options.input, &options.output);
    if output
        .extension()
        .is_none_or(|extension| !extension.eq_ignore_ascii_case("ron"))
    {
        let message = format!(
            "{}: tools can be written as those of a job: expected .ron",
            output.display()
        );
        return Err(Failure::message(message));
    }
    let library = read_library(input, false)?;
    let (text, problems) = to_ron(&library.tools);
    if problems.len() == library.tools.len() {
        let first = problems
            .first()
            .map(|(number, problem)| format!("tool {number}: {problem}"));
        let reason = first.unwrap_or_else(|| "it has no tool".to_owned());
        return Err(Failure::message(format!(
            "{}: no tool of it can be written: {reason}",
            input.display()
        )));
    }
    save(output, |file| file.write_all(text.as_bytes()))?;
    line("tools", &words::count((library.tools.len() - problems.len()) as u64));
    for (number, problem) in problems {
        line("note", &format!("tool {number} is left out: {problem}"));
    }
    library.notes.iter().for_each(|note| line("note", &note.message));
    Ok(())
}
