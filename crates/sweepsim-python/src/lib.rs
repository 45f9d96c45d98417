//! The native half of the Python package `sweepsim`: all that computes. The other half, in `python/sweepsim`, makes
//! requests of arguments, and objects of reports.

mod arrays;
mod compare;
mod dexels;
mod errors;
mod outcome;
mod program;
mod solids;
mod solve;
mod tools;
mod watch;

#[pyo3::pymodule]
mod _sweepsim {
    #[pymodule_export]
    use crate::compare::compare;
    #[pymodule_export]
    use crate::dexels::Dexels;
    #[pymodule_export]
    use crate::outcome::{Outcome, run};
    #[pymodule_export]
    use crate::program::read_program;
    #[pymodule_export]
    use crate::solve::solve_system;
    #[pymodule_export]
    use crate::tools::Tool;
}
