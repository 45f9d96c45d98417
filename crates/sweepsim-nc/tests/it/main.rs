//! Integration tests of `sweepsim-nc`, in one binary: it links once.

mod accelerations;
mod apt;
mod assumptions;
mod contents;
mod contours;
mod fuzz;
mod gcode;
mod harmless;
mod heidenhain;
mod holes;
mod kinematics;
mod klartext_cycles;
mod level_arcs;
mod limits;
mod machines;
mod packed;
mod pieces;
mod posted;
mod programs;
mod round_trips;
mod siemens;
mod tables;
mod tilted_turns;
mod tools;
mod turning_arcs;
mod written;
