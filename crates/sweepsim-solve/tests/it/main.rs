//! Integration tests of `sweepsim-solve`, in one binary: it links once.

mod bad_input;
mod budgets;
mod bundles;
mod clusters;
mod counts;
mod cubics;
mod curves;
mod degenerate;
mod expressions;
mod extremes;
mod formulas;
mod fuzz;
mod invariance;
mod limits;
mod many;
mod many_domains;
mod many_surfaces;
mod misuse;
mod monitors;
mod pairs;
mod parallel;
mod pieces;
mod places;
mod planted;
mod support;
mod surfaces;
