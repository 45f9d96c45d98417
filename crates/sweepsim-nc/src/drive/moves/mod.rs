//! Moves that are more than straight: arcs of the tip, turns of the tool, and ways to places of the machine.

mod arcs;
mod places;
mod turns;
