//! Solids of a job, and the grid over the stock.

mod area;
mod stock;
