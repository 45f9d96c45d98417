//! Cycles.

mod contours;
mod define;
mod holes;
mod shapes;
