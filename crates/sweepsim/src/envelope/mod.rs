//! The paper's equations: as exact systems in [`systems`], and as the maps through which the default method solves them.
//!
//! | the paper | system | map | jump of the coverage number, going up |
//! | --- | --- | --- | --- |
//! | Eq. 6: patch, line | [`systems::PatchMotion::line`] | [`PatchMap`] | `sign det ∂(X, Y, g)` |
//! | Eq. 7: edge, line | [`systems::EdgeMotion::line`] | [`EdgeMap`] | `−sign(g_B − g_A) · sign det ∂(X, Y)` where exactly one of `g_A, g_B` is negative |
//! | caps and kinks, line | [`systems::PlacedPatch::line`] | [`PlacedMap`] | `−sign N_z · ([g₊ < 0] − [g₋ < 0])` |
//!
//! `X = ⟨row of A(t), F(u, v)⟩ + b(t)` is bounded by the dot products of control rows and control points, which are its control values (coefficient
//! over weight), and so are its derivatives. `g = ⟨Ω, M⟩ + ⟨Aᵀb′, N⟩`, times a positive factor, is a polynomial in `t` (of degree 2 for an arc:
//! `⟨κ A₀ᵀk, M⟩ + ⟨Âᵀb′, N⟩`) and has the degree of `N` in `(u, v)`. Everywhere, `g = 0` counts as `g ≥ 0`.

mod about_a_line;
mod absent;
mod any_box;
mod clipped;
mod edge_map;
mod enclosures;
mod in_part;
mod patch_map;
mod placed_map;
mod plane;
mod poles;
pub mod systems;

pub(crate) use any_box::AnyBox;
pub(crate) use edge_map::{EdgeMap, OnEdge};
pub(crate) use enclosures::{Brick, Near, ROOT, ROUNDING, Size};
pub(crate) use in_part::{InPart, OfPart};
pub(crate) use patch_map::{OnPatch, PatchMap};
pub(crate) use placed_map::{JointSide, OnPlaced, PlacedMap, Twist};
pub(crate) use poles::{Apart, at_pole, pole};

#[cfg(test)]
mod tests;
