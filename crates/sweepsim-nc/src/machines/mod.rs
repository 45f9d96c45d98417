//! Machines: chains of linear and rotary axes from the part to the tool, and the frames in which programs give coordinates.
//!
//! A control moves axes; a sweep needs poses. [`Kinematics::pose`] goes one way, [`Kinematics::positions`] and [`Kinematics::nearest`] the
//! other, with both solutions of a machine with two rotary axes.
//!
//! The tool's direction for angles `θ₁, θ₂` of the rotary axes, from the part to the tool, is `R(k₁, θ₁) R(k₂, θ₂) z`. Any directions of the
//! axes are allowed (a nutating head has `k₂` at 45°), so there is one formula for all: the spherical triangle of `k₁`, `k₂` and the tool.

mod bodies;
mod chain;
mod description;
mod error;
mod fcm;
mod frame;
mod inverse;
mod kinematics;
mod machine;
mod places;
mod ready;
mod rotaries;

pub use bodies::{BodyDescription, BodyShape, Carries};
pub use chain::Chain;
pub use description::{LinearAxis, MachineDescription, Position, Rapid, RotaryAxis};
pub use error::{MachineError, ReachError};
pub use frame::WorkFrame;
pub use inverse::Solutions;
pub use kinematics::Kinematics;
pub use machine::Machine;

pub(crate) use rotaries::Rotaries;

/// A vector of a program whose components are all smaller than this gives no direction: their squares would vanish.
pub(crate) const SHORTEST: f64 = 1e-9;
