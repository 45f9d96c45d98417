//! A cutter with what holds it.

use crate::tool::Tool;

/// What a body of an assembly is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BodyKind {
    /// The part of the tool above its cutting edges.
    Shank,
    /// What the tool is clamped in.
    Holder,
}

/// A body that moves with a cutter and removes nothing.
#[derive(Clone, Debug)]
pub struct Body {
    /// What it is.
    pub kind: BodyKind,
    /// Its solid, in the frame of the cutter: the origin is the cutter's tip.
    pub solid: Tool,
}

/// A cutter, and the shank and holder that move with it. Only the cutter removes material; the others must not touch any.
///
/// ```
/// use sweepsim_motion::{Assembly, BodyKind, Profile, ProfileSegment, Tool};
///
/// // A holder 40 mm thick, 60 mm long, that begins 35 mm above the tip.
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
    /// A cutter alone.
    #[must_use]
    pub fn new(cutter: Tool) -> Self {
        Self {
            cutter,
            bodies: Vec::new(),
        }
    }

    /// The same with a further body, in the frame of the cutter.
    #[must_use]
    pub fn with(mut self, kind: BodyKind, solid: Tool) -> Self {
        self.bodies.push(Body { kind, solid });
        self
    }

    /// What cuts.
    #[must_use]
    pub fn cutter(&self) -> &Tool {
        &self.cutter
    }

    /// What moves with it.
    #[must_use]
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }
}
