//! The content of a file in words.

use super::program::{library, program};
use super::step::step;
use super::{Description, tool_in_words};
use crate::base::JobError;
use crate::base::kind::Kind;
use crate::base::words::{self, count, counted, measure, point};
use crate::request::DialectOptions;
use crate::show::soup;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;
use sweepsim_dexel::{Dexels, Grid, Mesh, Stock, TriDexels};
use sweepsim_formats::{
    DexelFormat, Job, MeshFormat, Provided, STEP_CHORD, read_dexels_csv, read_dexels_file, read_mesh_file, read_step,
    read_tri_dexels_file,
};
use sweepsim_nc::tools::read_library;
use sweepsim_nc::{Note, read_file};

/// Describes what is in a job, program, tool library, mesh or dexel file, and what was ignored in it. `dialect` says
/// how a program is read.
///
/// # Errors
/// [`JobError`] if the file cannot be read.
pub fn describe(file: &Path, dialect: &DialectOptions) -> Result<Description, JobError> {
    let mut text = Description::default();
    let mut reading = dialect.reading().map_err(JobError::Run)?;
    // An arc is one move, as in the program.
    reading.exact_arcs = true;
    match Kind::of(file)? {
        Kind::Job => {
            let provided = Provided {
                within: dialect.within.clone(),
                ..Provided::default()
            };
            job(&mut text, &Job::read_with(file, &provided)?);
        }
        Kind::Mesh if MeshFormat::of(file) == Some(MeshFormat::Step) => step(&mut text, &read_step(file, STEP_CHORD)?),
        Kind::Mesh => mesh(&mut text, &read_mesh_file(file)?),
        Kind::Dexels if DexelFormat::of(file) == Some(DexelFormat::Csv) => {
            let unreadable = |error: std::io::Error| JobError::run(format!("cannot read {}: {error}", file.display()));
            let reader = BufReader::new(File::open(file).map_err(unreadable)?);
            let rows = read_dexels_csv(reader).map_err(|error| JobError::run(format!("{}:{error}", file.display())))?;
            table(&mut text, &rows);
        }
        Kind::Dexels if DexelFormat::of(file) == Some(DexelFormat::Tri) => {
            tri_dexels(&mut text, &read_tri_dexels_file(file)?);
        }
        Kind::Dexels => dexels(&mut text, &read_dexels_file(file, None)?),
        Kind::Tools => library(&mut text, &read_library(file, false)?),
        Kind::Path => program(&mut text, &read_file(file, &reading)?),
    }
    Ok(text)
}

impl Description {
    pub(crate) fn bounds(&mut self, points: impl Iterator<Item = [f64; 3]>) {
        self.labelled_bounds("bounds", points);
    }

    pub(crate) fn labelled_bounds(&mut self, label: &str, points: impl Iterator<Item = [f64; 3]>) {
        let mut range = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for place in points {
            for k in 0..3 {
                range[0][k] = range[0][k].min(place[k]);
                range[1][k] = range[1][k].max(place[k]);
            }
        }
        if range[0][0] <= range[1][0] {
            self.line(label, &format!("{} … {} mm", point(range[0]), point(range[1])));
        }
    }

    fn grid(&mut self, grid: &Grid) {
        let ([nx, ny], [dx, dy]) = (grid.cells(), grid.spacing());
        let (min, max) = (grid.min(), grid.max());
        self.line(
            "grid",
            &format!(
                "{} × {} dexels, {} × {} mm apart, x {} … {}, y {} … {} mm",
                count(nx as u64),
                count(ny as u64),
                measure(dx),
                measure(dy),
                measure(min[0]),
                measure(max[0]),
                measure(min[1]),
                measure(max[1])
            ),
        );
        let frame = grid.frame();
        if !frame.is_world() {
            let [x, _, z] = frame.axes().map(point);
            self.line(
                "frame",
                &format!("origin {}, dexels along {z}, x along {x}", point(frame.origin())),
            );
        }
    }

    fn notes<'a>(&mut self, notes: impl Iterator<Item = &'a Note>) {
        for note in notes {
            self.line("note", &note.to_string());
        }
    }
}

fn job(text: &mut Description, job: &Job) {
    text.line("job", &job.name);
    text.line("tolerance", &format!("{} mm", job.tolerance));
    text.grid(&job.grid);
    let stock = match &job.stock {
        Stock::Block { min, max } => format!("block {} … {} mm", point(*min), point(*max)),
        Stock::Cylinder {
            base,
            axis,
            radius,
            height,
        } => format!(
            "cylinder at {} along {}, radius {}, height {} mm",
            point(*base),
            point(*axis),
            measure(*radius),
            measure(*height)
        ),
        Stock::Mesh(soup) => counted(soup.triangles.len() as u64, "triangle"),
        Stock::Ball { centre, radius } => format!("ball around {}, radius {radius} mm", point(*centre)),
        Stock::Dexels(dexels) => counted(dexels.count() as u64, "interval"),
        Stock::TriDexels(sets) => {
            let all: usize = sets.iter().map(Dexels::count).sum();
            format!("{} along x, y and z", counted(all as u64, "interval"))
        }
        Stock::Union(parts) => format!("union of {}", counted(parts.len() as u64, "piece")),
        Stock::Intersection(parts) => format!("intersection of {}", counted(parts.len() as u64, "piece")),
        Stock::Difference(_, parts) => format!("difference from {}", counted(parts.len() as u64, "piece")),
        _ => "of another kind".to_owned(),
    };
    text.line("stock", &stock);
    for (number, cutter) in &job.tools {
        text.line("tool", &format!("{number}: {}", tool_in_words(cutter)));
    }
    text.notes(job.notes.iter());
    let mut shown = None;
    for path in &job.paths {
        if shown != Some(path.setup) {
            shown = Some(path.setup);
            setup(text, job, path.setup);
        }
        let moves = counted(path.path.moves() as u64, "move");
        let rapids = match path.rapid_moves() as u64 {
            0 => String::new(),
            rapids => format!(" ({} rapid)", count(rapids)),
        };
        text.line(
            "path",
            &format!("{moves}{rapids} of tool {}, from {}", path.tool, path.source),
        );
        // In the coordinates of its program.
        text.bounds(
            path.path
                .poses_in_order(0)
                .map(|pose| path.frame.from_world(pose.tip())),
        );
        text.notes(path.notes.iter());
    }
    if let Some(target) = &job.target {
        let triangles = counted(target.mesh.triangles.len() as u64, "triangle");
        text.line("target", &format!("{}: {triangles}", target.file.display()));
    }
}

/// A set-up: how the part lies, and its fixtures.
fn setup(text: &mut Description, job: &Job, number: usize) {
    let setup = &job.setups[number];
    if let Some(name) = job.setup_name(number) {
        let place = match setup.frame.is_world() {
            true => "as the part".to_owned(),
            false => {
                let [x, _, z] = setup.frame.axes().map(words::direction);
                let zero = point(setup.frame.origin());
                format!("zero at {zero} of the part, whose {z} is up and {x} to the right")
            }
        };
        text.line("set-up", &format!("{name}: {place}"));
    }
    if !setup.fixtures.is_empty() {
        text.line("fixtures", &count(setup.fixtures.len() as u64));
    }
}

fn mesh(text: &mut Description, mesh: &Mesh) {
    text.line("vertices", &count(mesh.vertices.len() as u64));
    text.line("triangles", &count(mesh.triangles.len() as u64));
    text.bounds(mesh.vertices.iter().copied());
    let triangles = soup(mesh);
    match triangles.check_closed() {
        Ok(()) => {
            text.line("closed", "yes");
            text.line("volume", &format!("{} mm³", measure(triangles.volume())));
        }
        Err(error) => text.line("closed", &format!("no: {error}")),
    }
}

fn dexels(text: &mut Description, dexels: &Dexels) {
    text.grid(dexels.grid());
    text.line("intervals", &count(dexels.count() as u64));
    text.line("dexels", &format!("{} with material", count(dexels.covered() as u64)));
    let ends = || dexels.iter().flat_map(|(_, line)| line.heights());
    let lowest = ends().map(|[z, _]| z).fold(f64::INFINITY, f64::min);
    let highest = ends().map(|[_, z]| z).fold(f64::NEG_INFINITY, f64::max);
    if lowest <= highest {
        text.line("z", &format!("{} … {} mm", measure(lowest), measure(highest)));
    }
    text.line("volume", &format!("{} mm³", measure(dexels.volume())));
    let cut = dexels
        .iter()
        .flat_map(|(_, line)| line.iter().flat_map(|i| [i.lower, i.upper]));
    let cut = cut.filter(|end| end.source.is_cut()).count();
    text.line(
        "cut",
        &format!("{} of {}", count(cut as u64), counted(2 * dexels.count() as u64, "end")),
    );
    text.line("memory", &words::bytes(dexels.bytes() as u64));
}

fn tri_dexels(text: &mut Description, solid: &TriDexels) {
    let [nx, ny, nz] = solid.cells().map(|n| count(n as u64));
    let (min, max) = (point(solid.min()), point(solid.max()));
    text.line("lattice", &format!("{nx} × {ny} × {nz}, {min} … {max} mm"));
    for (set, axis) in solid.sets().iter().zip(["x", "y", "z"]) {
        let intervals = counted(set.count() as u64, "interval");
        let volume = measure(set.volume());
        text.line(&format!("along {axis}"), &format!("{intervals}, {volume} mm³"));
    }
    text.line("volume", &format!("{} mm³", measure(solid.volume())));
    let all: usize = solid.sets().iter().map(Dexels::bytes).sum();
    text.line("memory", &words::bytes(all as u64));
}

fn table(text: &mut Description, rows: &[sweepsim_formats::DexelRow]) {
    text.line("intervals", &count(rows.len() as u64));
    let lines = rows.chunk_by(|a, b| (a.i, a.j) == (b.i, b.j)).count();
    text.line("dexels", &format!("{} with material", count(lines as u64)));
    let (i, j) = rows.iter().fold((0, 0), |(i, j), row| (row.i.max(i), row.j.max(j)));
    text.line("numbers", &format!("i up to {i}, j up to {j}"));
    let lowest = rows.iter().map(|row| row.z0).fold(f64::INFINITY, f64::min);
    let highest = rows.iter().map(|row| row.z1).fold(f64::NEG_INFINITY, f64::max);
    if !rows.is_empty() {
        text.line("z", &format!("{} … {} mm", measure(lowest), measure(highest)));
    }
}
