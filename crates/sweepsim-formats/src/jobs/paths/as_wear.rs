//! The other reading of a program whose registers of diameters are not known: as the wear of their tools.

use sweepsim_nc::{Assumption, ReadOptions};

use super::JobPath;

/// How a path is if registers of diameters that were taken for the sizes of their tools hold wear, 0.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct AsWear {
    /// The registers that are assumed to hold the size of the path's tool, each with the line where that is assumed
    /// first.
    pub registers: Vec<(String, usize)>,
    /// The path; `None` if the program cannot be read like that.
    pub path: Option<JobPath>,
}

/// The registers of a program that were taken for the sizes of their tools: each with its tool and its first line.
pub(super) struct AssumedSizes(Vec<(u32, String, usize)>);

impl AssumedSizes {
    /// `None` if there are none.
    pub fn of(assumptions: &[Assumption]) -> Option<Self> {
        let own = assumptions
            .iter()
            .filter_map(|one| Some((one.size_of?, one.what.clone(), one.line)));
        let own: Vec<_> = own.collect();
        (!own.is_empty()).then_some(Self(own))
    }

    /// Gives each path of the program its other reading, where it differs. `tool`: the job's tool for the whole
    /// program. `read` reads the program again.
    pub fn compare<E>(
        &self,
        paths: &mut [JobPath],
        tool: Option<u32>,
        options: &ReadOptions,
        read: impl FnOnce(&ReadOptions) -> Result<Vec<JobPath>, E>,
    ) {
        let mut options = options.clone();
        options.wear_registers = true;
        // The same blocks give the same paths, or these are not comparable.
        let others = read(&options).ok().filter(|others| others.len() == paths.len());
        let mut others = others.map(Vec::into_iter);
        for path in paths {
            let mut other = others.as_mut().and_then(Iterator::next);
            let own = self.0.iter();
            let own = own.filter(|(number, ..)| tool.is_some() || *number == path.tool);
            let registers: Vec<_> = own.map(|(_, register, line)| (register.clone(), *line)).collect();
            if registers.is_empty() || other.as_ref().is_some_and(|other| other.path == path.path) {
                continue;
            }
            if let Some(other) = &mut other {
                other.notes.clear();
            }
            path.as_wear = Some(Box::new(AsWear { registers, path: other }));
        }
    }
}
