//! What moves along a toolpath, prepared.

use crate::error::SweepError;
use crate::verify::driver::Work;
use crate::verify::scene::ToolPath;
use crate::verify::solid::MovingSolid;
use std::ops::Range;
use sweepsim_motion::{Assembly, Path, Tool};

/// A cutter and its bodies, prepared.
pub(in crate::verify) struct Solids<'a> {
    pub(in crate::verify) cutter: MovingSolid<'a>,
    pub(in crate::verify) bodies: Vec<MovingSolid<'a>>,
    /// The same taken larger, if they are.
    pub(in crate::verify) larger: Option<Box<Self>>,
}

impl<'a> Solids<'a> {
    /// Along some moves of a toolpath.
    pub(in crate::verify) fn new(
        toolpath: &ToolPath<'a>,
        moves: Range<usize>,
        work: &Work,
    ) -> Result<Self, SweepError> {
        // The run of a path of one pose counts a move that the path does not have.
        let moves = moves.start..moves.end.min(toolpath.path.moves());
        let mut grids = vec![work.remaining.grid().whole()];
        grids.extend(work.fixtures.iter().map(|(dexels, _)| dexels.grid().whole()));
        let solid = |tool: &'a Tool| MovingSolid::new(tool, (toolpath.path, moves.clone()), &grids, &work.options);
        let solids = |assembly: &'a Assembly| -> Result<Self, SweepError> {
            let bodies = assembly.bodies().iter();
            Ok(Self {
                cutter: solid(assembly.cutter())?,
                bodies: bodies.map(|body| solid(&body.solid)).collect::<Result<_, _>>()?,
                larger: None,
            })
        };
        let larger = toolpath.larger.map(solids).transpose()?;
        Ok(Self {
            larger: larger.map(Box::new),
            ..solids(toolpath.assembly)?
        })
    }

    /// The number of them.
    pub(super) fn count(toolpath: &ToolPath) -> usize {
        let assemblies = std::iter::once(toolpath.assembly).chain(toolpath.larger);
        assemblies.map(|assembly| 1 + assembly.bodies().len()).sum()
    }

    /// The same along another path.
    pub(in crate::verify) fn along(&self, path: &Path, work: &Work) -> Result<Self, SweepError> {
        let solid = |solid: &MovingSolid<'a>| solid.along(path, work.remaining.grid(), &work.options);
        let larger = self
            .larger
            .as_ref()
            .map(|larger| larger.along(path, work))
            .transpose()?;
        Ok(Self {
            cutter: solid(&self.cutter)?,
            bodies: self.bodies.iter().map(solid).collect::<Result<_, _>>()?,
            larger: larger.map(Box::new),
        })
    }

    /// The cutter, and the bodies by their numbers: each as it is looked for, and itself if that is a larger one.
    pub(in crate::verify) fn probes(
        &self,
    ) -> impl Iterator<Item = (Option<usize>, &MovingSolid<'a>, Option<&MovingSolid<'a>>)> {
        let bodies = self.bodies.iter().enumerate();
        let own = std::iter::once((None, &self.cutter)).chain(bodies.map(|(n, body)| (Some(n), body)));
        own.map(|(number, itself)| {
            let larger = self.larger.as_ref().and_then(|larger| match number {
                None => Some(&larger.cutter),
                Some(n) => larger.bodies.get(n),
            });
            match larger {
                Some(larger) => (number, larger, Some(itself)),
                None => (number, itself, None),
            }
        })
    }
}
