//! Moves that are more than straight: arcs of the tip, and turns of the tool.

mod arcs;
mod turns;
