//! The measures of cutters, by name. Lengths in one unit, angles in degrees; the constructors of [`Tool`](crate::Tool)
//! check them.

/// Measures of [`Tool::lollipop`](crate::Tool::lollipop).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lollipop {
    /// Radius of the ball.
    pub radius: f64,
    /// Radius of the neck.
    pub neck: f64,
    /// From the tip to the top.
    pub length: f64,
}

/// Measures of [`Tool::dovetail`](crate::Tool::dovetail).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dovetail {
    /// Radius of the bottom.
    pub radius: f64,
    /// Angle of the flanks above the horizontal, in degrees.
    pub angle: f64,
    /// Height of the flanks.
    pub height: f64,
    /// Radius of the neck: at most that of the flanks at their top.
    pub neck: f64,
    /// From the tip to the top.
    pub length: f64,
}

/// Measures of [`Tool::barrel`](crate::Tool::barrel).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Barrel {
    /// Radius in the middle of the flank, where it is widest.
    pub radius: f64,
    /// Radius of the flank's arc.
    pub flank: f64,
    /// Height of the flank.
    pub height: f64,
    /// Radius of the arc between the bottom and the flank; 0 for a sharp rim.
    pub corner: f64,
    /// From the tip to the top.
    pub length: f64,
}

/// Measures of [`Tool::lens`](crate::Tool::lens).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Radius of the shank.
    pub radius: f64,
    /// Radius of the ball that the bottom is part of.
    pub bottom: f64,
    /// Radius of the arc between the bottom and the shank; 0 for a sharp rim.
    pub corner: f64,
    /// From the tip to the top.
    pub length: f64,
}

/// Measures of [`Tool::oval`](crate::Tool::oval).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oval {
    /// Radius of the shank.
    pub radius: f64,
    /// Radius of the ball.
    pub tip: f64,
    /// Radius of the flank's arc.
    pub flank: f64,
    /// From the tip to the top.
    pub length: f64,
}

/// Measures of [`Tool::taper`](crate::Tool::taper).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taper {
    /// Radius of the shank.
    pub radius: f64,
    /// Radius of the ball.
    pub tip: f64,
    /// Radius of the flank's arc.
    pub flank: f64,
    /// By how much the flank leans outwards where it reaches the shank, in degrees.
    pub angle: f64,
    /// From the tip to the top.
    pub length: f64,
}
