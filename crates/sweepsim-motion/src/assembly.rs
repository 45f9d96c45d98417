//! A cutter with its shank and holder.

use crate::tool::Tool;

/// The kind of a body in an assembly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BodyKind {
    /// The part of the tool above its cutting edges.
    Shank,
    /// The part that clamps the tool.
    Holder,
}

/// A body that moves with a cutter and removes no material.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its kind.
    pub kind: BodyKind,
    /// Its shape, in the frame of the cutter: the origin is the cutter's tip.
    pub solid: Tool,
}

/// A cutter with the shank and holder that move with it. Only the cutter removes material; the others must not touch
/// any.
///
/// ```
/// use sweepsim_motion::{Assembly, BodyKind, Profile, ProfileSegment, Tool};
///
/// // A holder of diameter 40 mm and length 60 mm that begins 35 mm above the tip.
/// let line = |rho, zeta| ProfileSegment::Line { to: [rho, zeta] };
/// let holder = Profile::new([0.0, 35.0], vec![line(20.0, 35.0), line(20.0, 95.0), line(0.0, 95.0)])?;
/// let assembly = Assembly::new(Tool::ball(5.0, 30.0)?)
///     .with(BodyKind::Shank, Tool::flat(5.0, 35.0)?)
///     .with(BodyKind::Holder, Tool::from_profile(holder));
/// assert_eq!(assembly.bodies().len(), 2);
/// # Ok::<(), sweepsim_motion::ProfileError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Assembly {
    cutter: Tool,
    bodies: Vec<Body>,
}

impl Assembly {
    /// Creates an assembly of a cutter alone.
    #[must_use]
    pub fn new(cutter: Tool) -> Self {
        Self {
            cutter,
            bodies: Vec::new(),
        }
    }

    /// Adds a body, in the frame of the cutter.
    #[must_use]
    pub fn with(mut self, kind: BodyKind, solid: Tool) -> Self {
        self.bodies.push(Body { kind, solid });
        self
    }

    /// The cutter.
    #[must_use]
    pub fn cutter(&self) -> &Tool {
        &self.cutter
    }

    /// The bodies that move with it.
    #[must_use]
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }
}
