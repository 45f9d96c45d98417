//! What the result of a job is compared with, and what may differ.

use sweepsim_dexel::Grid;

use super::job::{Limits, Target};
use super::read::JobReader;
use super::schema;
use crate::dexels::read_dexels_file;
use crate::error::{FormatError, Problem};

impl JobReader<'_> {
    pub(super) fn target(&self, raw: &schema::Job, grid: &Grid) -> Result<Option<Target>, FormatError> {
        Ok(match &raw.target {
            None => None,
            Some(schema::Target::Mesh(name)) => Some(Target {
                file: self.beside(name),
                mesh: self.mesh(name, "target", &["target".into()])?,
            }),
            Some(schema::Target::Dexels(name)) => Some(self.target_of_dexels(name, grid)?),
        })
    }

    /// The surface of the result of an earlier run, in millimetres like all its outputs.
    fn target_of_dexels(&self, name: &str, grid: &Grid) -> Result<Target, FormatError> {
        let (file, steps) = (self.beside(name), ["target".into()]);
        let dexels = self.named(read_dexels_file(&file, Some(grid)), &file, "target", &steps)?;
        let surface = dexels.surface();
        let surface = surface.map_err(|error| self.error(Problem::syntax(format!("{name}: {error}")), &steps))?;
        Ok(Target {
            file,
            mesh: surface.soup().unwrap_or_default(),
        })
    }

    pub(super) fn limits(&self, raw: &schema::Job) -> Result<Option<Limits>, FormatError> {
        let Some(limits) = &raw.limits else { return Ok(None) };
        for (name, value) in [("gouge", limits.gouge), ("excess", limits.excess)] {
            let steps = ["limits".into(), name.into()];
            self.check(name, value, value >= 0.0, "0 or greater", &steps)?;
        }
        Ok(Some(Limits {
            gouge: limits.gouge * self.unit,
            excess: limits.excess * self.unit,
        }))
    }
}
