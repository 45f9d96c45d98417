//! Cycles.

mod contours;
mod define;
mod holes;
mod patterns;
mod shapes;
