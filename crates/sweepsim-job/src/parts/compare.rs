//! How a part differs from its target.

use super::align::{self, Alignment};
use super::deviation;
use super::faces::face_at;
use super::solid::{GridOptions, Solid};
use crate::base::{JobError, Sink, words};
use crate::request::ViewOptions;
use crate::show::{bounds, picture, share, soup};
use crate::verify::targets;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::time::Instant;
use sweepsim::Monitor;
use sweepsim::verify::deviations;
use sweepsim_dexel::{Dexels, Grid, Mesh, Operation, Stock, StockError, Surface, TriangleSoup};
use sweepsim_formats::{
    ComparisonReport, Job, LimitRegion, Limits, MeshFormat, RegionPlace, ReportedAlignment, STEP_CHORD, Target as Goal,
    TargetFaces, read_coloured_mesh_file, read_step,
};

/// The limits of deviations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DeviationLimits {
    /// For gouges and for excess, in millimetres.
    Both([f64; 2]),
    /// Those of a job, by region if it has regions.
    Job(PathBuf),
}

/// A part in memory.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Part {
    /// A closed surface.
    Mesh(Mesh),
    /// Material on lines.
    Dexels(Dexels),
}

/// A request to compare two parts.
///
/// As notation it has files: one with parts in memory works in this process only.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct CompareRequest {
    /// The part: a mesh or dexels.
    pub part: PathBuf,
    /// The target: a mesh or dexels.
    pub target: PathBuf,
    /// Distances up to this count as 0, in millimetres.
    pub tolerance: f64,
    /// The limits. Without them, 0.1 mm each.
    pub limits: Option<DeviationLimits>,
    /// The distance at the ends of the picture's colour scale, in millimetres. Without it, the largest.
    pub range: Option<f64>,
    /// How the part is laid onto the target first. Without it, both stay where they are.
    #[serde(default)]
    pub align: Option<Alignment>,
    /// The grid, where the files do not tell it.
    pub grid: GridOptions,
    /// How the picture is drawn.
    pub view: ViewOptions,
    /// Parts in memory, instead of these files.
    #[serde(skip)]
    given: [Option<Part>; 2],
}

/// Two parts that were read, to be compared.
pub struct Pair<'a> {
    request: &'a CompareRequest,
    part: Solid,
    target: Solid,
    mesh: Mesh,
    goal: Mesh,
    /// The faces of STEP files.
    faces: [Option<TargetFaces>; 2],
    grid: Grid,
    report: ComparisonReport,
}

/// How two parts differ.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Difference {
    /// Volumes, distances, and regions beyond the limits.
    pub report: ComparisonReport,
    /// The part coloured by distance, as PNG.
    pub picture: Vec<u8>,
}

impl CompareRequest {
    /// To compare the parts in two files.
    #[must_use]
    pub fn new(part: impl Into<PathBuf>, target: impl Into<PathBuf>) -> Self {
        Self {
            part: part.into(),
            target: target.into(),
            tolerance: 1e-6,
            limits: None,
            range: None,
            align: None,
            grid: GridOptions::default(),
            view: ViewOptions::default(),
            given: [None, None],
        }
    }

    /// To compare this part, which the report calls by the name of the file, instead of the one in it.
    #[must_use]
    pub fn with_part(mut self, part: Part) -> Self {
        self.given[0] = Some(part);
        self
    }

    /// The same of the target.
    #[must_use]
    pub fn with_target(mut self, target: Part) -> Self {
        self.given[1] = Some(target);
        self
    }

    /// Reads both parts.
    ///
    /// # Errors
    /// [`JobError`]: a file cannot be read, a part is empty, or there is no grid.
    pub fn read(&self) -> Result<Pair<'_>, JobError> {
        let mut report = ComparisonReport::default();
        report.part = self.part.display().to_string();
        report.target = self.target.display().to_string();
        report.tolerance = self.tolerance;
        let start = Instant::now();
        let [(part, of_part), (target, of_target)] = self.solids()?;
        let (mut both, mut faces) = ([part, target], [of_part, of_target]);
        if let Some(alignment) = &self.align {
            report.alignment = Some(lay(alignment, &mut both, &mut faces)?);
        }
        let [part, target] = both;
        let (mesh, goal) = (part.surface()?, target.surface()?);
        let own = bounds(&mesh).ok_or_else(|| JobError::file(&self.part, "this part is empty"))?;
        let of_goal = bounds(&goal).ok_or_else(|| JobError::file(&self.target, "this target is empty"))?;
        let around = [
            [0, 1, 2].map(|k| own[0][k].min(of_goal[0][k])),
            [0, 1, 2].map(|k| own[1][k].max(of_goal[1][k])),
        ];
        let grid = match (part.grid(), target.grid(), self.grid.grid(Some(around))?) {
            (Some(grid), ..) | (None, Some(grid), _) | (None, None, Some(grid)) => grid,
            (None, None, None) => return Err(JobError::run("no grid to compare on")),
        };
        report.seconds.insert("read".to_owned(), start.elapsed().as_secs_f64());
        Ok(Pair {
            request: self,
            part,
            target,
            mesh,
            goal,
            faces,
            grid,
            report,
        })
    }

    /// Both parts. A table of dexels takes the grid of the other part, unless the options name one.
    fn solids(&self) -> Result<[(Solid, Option<TargetFaces>); 2], JobError> {
        let grid = &self.grid;
        // Without a number of cells, an area says nothing about a table.
        let given = if grid.grid.is_some() || (grid.area.is_some() && grid.cells.is_some()) {
            self.grid.grid(None)?
        } else {
            None
        };
        let is_table = |number: usize| {
            let file = [&self.part, &self.target][number];
            self.given[number].is_none() && file.extension().is_some_and(|e| e.eq_ignore_ascii_case("csv"))
        };
        if is_table(0) && !is_table(1) {
            let target = self.solid(1, given.as_ref())?;
            let grid = given.or(target.0.grid());
            return Ok([self.solid(0, grid.as_ref())?, target]);
        }
        let part = self.solid(0, given.as_ref())?;
        let grid = given.or(part.0.grid());
        let target = self.solid(1, grid.as_ref())?;
        Ok([part, target])
    }

    /// The part (0) or the target (1).
    fn solid(&self, number: usize, grid: Option<&Grid>) -> Result<(Solid, Option<TargetFaces>), JobError> {
        let file = [&self.part, &self.target][number];
        match &self.given[number] {
            Some(Part::Mesh(mesh)) => Ok((Solid::Mesh(mesh.clone()), None)),
            Some(Part::Dexels(dexels)) => Ok((Solid::Dexels(dexels.clone()), None)),
            None if MeshFormat::of(file) == Some(MeshFormat::Step) => {
                let part = read_step(file, STEP_CHORD)?;
                let faces = TargetFaces::of(&part);
                Ok((Solid::Mesh(part.mesh), Some(faces)))
            }
            None => Ok((Solid::read(file, grid)?, None)),
        }
    }
}

impl Pair<'_> {
    /// Compares them.
    ///
    /// # Errors
    /// [`JobError`]: a part cannot be compared, or [`JobError::Cancelled`].
    pub fn compare(self, monitor: &dyn Monitor) -> Result<Difference, JobError> {
        let Self {
            request,
            part,
            target,
            mesh,
            goal,
            faces,
            grid,
            mut report,
        } = self;
        let start = Instant::now();
        let dexels = part.dexels(&request.part, &grid)?;
        let surface = match &target {
            Solid::Dexels(_) | Solid::TriDexels(_) => soup(&goal),
            Solid::Mesh(target) => soup(target),
        };
        let failed = |error| JobError::file(&request.target, error);
        volumes(&mut report, &dexels, &surface).map_err(failed)?;
        regions(&mut report, request, &dexels, surface, faces[1].as_ref())?;
        report.cells = grid.cells();
        let soups = [&mesh, &goal].map(soup);
        let part = part.to_compare(&soups[0], faces[0].as_ref())?;
        let target = target.to_compare(&soups[1], faces[1].as_ref())?;
        let [dx, dy] = grid.spacing();
        deviation::describe(&mut report, [&part, &target], faces[1].as_ref(), dx.min(dy));
        let seconds = start.elapsed().as_secs_f64();
        report.seconds.insert("compare".to_owned(), seconds);
        let start = Instant::now();
        let values = values(&mesh, &target);
        let finite = values.iter().copied().filter(|v| v.is_finite());
        let largest = finite.fold(0.0, |a: f32, v| a.max(v.abs()));
        let range = request
            .range
            .unwrap_or(round(f64::from(largest).max(request.tolerance)));
        let go_on = share(monitor, |part| part);
        let (picture, missed) = picture(&request.view, &mesh, Some((&values, range)), &go_on)?;
        for (what, mesh) in [("part", &mesh), ("target", &goal)] {
            if let Some(far) = targets::beyond(mesh.vertices.iter().copied(), &grid, report.limits[0]) {
                report.warnings.push(format!(
                    "the {what} reaches {} mm beyond the grid: volumes and regions leave out what is there",
                    words::length(far)
                ));
            }
        }
        report.warnings.extend(missed);
        let seconds = start.elapsed().as_secs_f64();
        report.seconds.insert("picture".to_owned(), seconds);
        Ok(Difference { report, picture })
    }
}

impl Difference {
    /// The report as JSON.
    ///
    /// # Errors
    /// [`JobError`] if it has no notation.
    pub fn json(&self) -> Result<String, JobError> {
        let text = self.report.to_json();
        text.map_err(|error| JobError::run(format!("cannot make the report: {error}")))
    }

    /// Passes `comparison.png` and `comparison.json` to a sink.
    ///
    /// # Errors
    /// [`JobError`] of the sink.
    pub fn write_to(&self, sink: &mut dyn Sink) -> Result<(), JobError> {
        let json = self.json()?;
        sink.write("comparison.png", &mut |file| file.write_all(&self.picture))?;
        sink.write("comparison.json", &mut |file| file.write_all(json.as_bytes()))
    }
}

/// Lays a part onto its target. Dexels stay where their lines are: then the target is laid onto the part.
fn lay(
    alignment: &Alignment,
    [part, target]: &mut [Solid; 2],
    faces: &mut [Option<TargetFaces>; 2],
) -> Result<ReportedAlignment, JobError> {
    let (mesh, goal) = (part.surface()?, target.surface()?);
    let walls = !matches!(part, Solid::Dexels(_));
    let found = align::register(alignment, [&mesh, &goal], walls, faces[1].as_ref())?;
    let mut report = found.report.clone();
    let frame = found.frame()?;
    let back = found.inverse().frame()?;
    let (moved, place) = match (part.placed(&frame), target.placed(&back)) {
        (Some(placed), _) => {
            *part = placed;
            (&mut faces[0], frame)
        }
        (None, Some(placed)) => {
            *target = placed;
            report.inverse = true;
            (&mut faces[1], back)
        }
        (None, None) => {
            return Err(JobError::request(
                "align",
                "both parts are dexels, which cannot be moved: expected a mesh or a STEP file",
            ));
        }
    };
    if let Some(faces) = moved {
        faces.surfaces = faces.surfaces.moved(|p| place.to_world(p), |v| place.turn_to_world(v));
    }
    Ok(report)
}

/// The connected regions beyond the limits: those of `--limits`.
fn regions(
    report: &mut ComparisonReport,
    options: &CompareRequest,
    dexels: &Dexels,
    surface: TriangleSoup,
    faces: Option<&TargetFaces>,
) -> Result<(), JobError> {
    let limits = match &options.limits {
        None => Limits::new(targets::LIMIT, targets::LIMIT),
        Some(DeviationLimits::Both([gouge, excess])) => Limits::new(*gouge, *excess),
        Some(DeviationLimits::Job(file)) => Job::read(file)?
            .limits
            .ok_or_else(|| JobError::file(file, "this job has no limits"))?,
    };
    let by_colour = |region: &LimitRegion| matches!(region.place, RegionPlace::Colour(_));
    let is_file = options.given[1].is_none() && MeshFormat::of(&options.target).is_some();
    let colours = match faces {
        Some(faces) => faces
            .surfaces
            .face_of
            .iter()
            .map(|face| faces.faces[*face as usize].colour)
            .collect(),
        None if is_file && limits.regions.iter().any(by_colour) => read_coloured_mesh_file(&options.target)?.1,
        None => Vec::new(),
    };
    let failed = |error: &dyn std::fmt::Display| JobError::file(&options.target, error);
    let goal = Goal::new(options.target.clone(), surface.clone(), colours).with_faces(faces.cloned());
    let parts = goal.by_region(&limits);
    let target = targets::with_limits(&surface, Some(parts), Some(&limits), dexels.grid(), options.tolerance);
    let target = target.map_err(|error| failed(&error))?;
    // What is missing is missing, whatever the stock was.
    let mut stock = dexels.clone();
    stock
        .combine(Operation::Union, target.solid())
        .map_err(|error| failed(&error))?;
    let found = deviations(&stock, dexels, &target);
    report.limits = [limits.gouge, limits.excess];
    report.regions = targets::regions(&found, Some(&limits));
    for region in &mut report.regions {
        region.face = face_at(&goal, &target, region.place);
    }
    Ok(())
}

/// Volumes on the lines of the part's dexels: of three sets on those along z, as in all other figures.
fn volumes(report: &mut ComparisonReport, dexels: &Dexels, target: &TriangleSoup) -> Result<(), StockError> {
    let goal = Stock::Mesh(target.clone()).dexels(dexels.grid())?;
    let mut common = dexels.clone();
    common.combine(Operation::Intersection, &goal)?;
    report.volume = dexels.volume();
    report.target_volume = goal.volume();
    report.excess_volume = (dexels.volume() - common.volume()).max(0.0);
    report.missing_volume = (goal.volume() - common.volume()).max(0.0);
    Ok(())
}

/// Rounds up to a number of one or two digits, for a readable scale.
fn round(value: f64) -> f64 {
    let whole = 10_f64.powf(value.log10().floor());
    let steps = [1.0, 1.2, 1.6, 2.0, 2.4, 3.0, 4.0, 5.0, 6.0, 8.0];
    // For values beyond the last step, or if the logarithm was rounded down.
    steps
        .into_iter()
        .map(|step| step * whole)
        .find(|step| *step >= value)
        .unwrap_or(10.0 * whole)
}

/// The distance of each vertex from the target, positive outside: as near to 0 as it may be.
fn values(mesh: &Mesh, target: &Surface<'_>) -> Vec<f32> {
    use rayon::prelude::*;
    let value = |p: &[f64; 3]| {
        target
            .distance(*p)
            .map_or(f32::NAN, |range| range.nearest_to_0() as f32)
    };
    mesh.vertices.par_iter().map(value).collect()
}
