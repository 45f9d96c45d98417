//! The curves that bound the sweep of a tool without rotation, as graphs over `p`: grazing curves and edges, cut where `p` or `q` turns.

mod graph;
mod heading;
mod parabola;
pub(crate) mod ring;
mod ring_about;
pub(crate) mod slant;
pub(crate) mod torus;
mod torus_about;

pub(crate) use graph::{Graph, Turned, TurnedPoint};
pub(crate) use heading::{Heading, SHORTEST, slack, stands};
pub(crate) use parabola::Parabola;
pub(crate) use ring_about::Beside;

/// A vector in the coordinates `(q, p, z)` of a move.
pub(crate) type Local = [f64; 3];

/// The sum `a + s b`.
fn along(a: &Local, s: f64, b: &Local) -> Local {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

fn dot(a: &Local, b: &Local) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
