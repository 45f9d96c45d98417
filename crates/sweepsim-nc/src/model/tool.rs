//! Tools as libraries and programs describe them.

use sweepsim_motion::Apt;

/// A tool as far as a library or a program describes it. Lengths are in millimetres, angles in degrees.
///
/// [`build`](Self::build) makes the solids of a simulation from it, or says by name what is missing.
///
/// ```
/// use sweepsim_nc::{CutterKind, ToolDescription};
///
/// let mut tool = ToolDescription::new(CutterKind::Ball);
/// tool.diameter = Some(6.0);
/// let error = tool.build().unwrap_err();
/// assert_eq!(error.to_string(), "the flute length is missing");
///
/// tool.flute_length = Some(20.0);
/// tool.shank_diameter = Some(6.0);
/// tool.stick_out = Some(35.0);
/// let built = tool.build()?;
/// assert_eq!(built.bodies.len(), 1);
/// # Ok::<(), sweepsim_nc::ToolProblem>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct ToolDescription {
    /// Its name or description.
    pub name: Option<String>,
    /// What kind of cutter it is.
    pub kind: Option<CutterKind>,
    /// The diameter of the cutting part, at its widest.
    pub diameter: Option<f64>,
    /// The radius of the corner of a bull-nose or tapered mill.
    pub corner_radius: Option<f64>,
    /// The diameter of the flat at the tip of a chamfer or tapered mill.
    pub tip_diameter: Option<f64>,
    /// The angle between the axis and the flank of a chamfer, tapered or dovetail mill.
    pub taper_angle: Option<f64>,
    /// The included angle of the point of a drill.
    pub point_angle: Option<f64>,
    /// The height of the cutting edges above the tip.
    pub flute_length: Option<f64>,
    /// The diameter of the neck between the cutting edges and the shank of an undercutting mill.
    pub neck_diameter: Option<f64>,
    /// The height above the tip at which the shank begins, if not at the end of the flutes.
    pub shoulder_length: Option<f64>,
    /// The diameter between the flutes and [`shoulder_length`](Self::shoulder_length).
    pub shoulder_diameter: Option<f64>,
    /// The diameter of the shank.
    pub shank_diameter: Option<f64>,
    /// The height above the tip at which the holder begins.
    pub stick_out: Option<f64>,
    /// The length of the tool without its holder.
    pub overall_length: Option<f64>,
    /// The holder, from the tool towards the spindle.
    pub holder: Vec<HolderSegment>,
    /// The name of the holder.
    pub holder_name: Option<String>,
    /// The line of the file where it is described, from 1; 0 if it has none.
    pub line: usize,
    /// What was ignored or assumed when its description was read.
    pub notes: Vec<String>,
}

/// What kind of cutter a tool is.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum CutterKind {
    /// A cylinder with a flat end: end mills, face mills, slot mills, reamers.
    Flat,
    /// A cylinder with a hemispherical end.
    Ball,
    /// A cylinder with a rounded corner.
    Bull,
    /// A cone that widens from the tip, which is flat, rounded at the corner, or a ball.
    Tapered,
    /// A cone up to the diameter, and a cylinder above: chamfer mills, V-bits, engravers.
    Chamfer,
    /// A cylinder with a conical point: drills, spot drills.
    Drill,
    /// A ball on a neck.
    Lollipop,
    /// A cone that narrows from the tip, on a neck.
    Dovetail,
    /// The seven parameters of APT.
    Apt(Apt),
    /// A kind whose shape is not known here, by its name: thread mills, taps, probes.
    Other(String),
}

impl CutterKind {
    /// The usual name.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Flat => "flat end mill",
            Self::Ball => "ball end mill",
            Self::Bull => "bull-nose end mill",
            Self::Tapered => "tapered mill",
            Self::Chamfer => "chamfer mill",
            Self::Drill => "drill",
            Self::Lollipop => "lollipop mill",
            Self::Dovetail => "dovetail mill",
            Self::Apt(_) => "APT cutter",
            Self::Other(name) => name,
        }
    }
}

/// A truncated cone of a holder. Lengths are in millimetres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HolderSegment {
    /// Its height along the axis.
    pub height: f64,
    /// The diameter at the end towards the tip.
    pub lower_diameter: f64,
    /// The diameter at the end towards the spindle.
    pub upper_diameter: f64,
}

impl ToolDescription {
    /// A cutter of which only the kind is known.
    #[must_use]
    pub fn new(kind: CutterKind) -> Self {
        Self {
            kind: Some(kind),
            ..Self::default()
        }
    }

    /// Fills in what this description leaves open from another one of the same tool. Shapes are not mixed: where the kinds are both
    /// known and differ, this one's measures of the cutter stay alone.
    #[must_use]
    pub fn or(mut self, other: &Self) -> Self {
        let other = other.clone();
        let same = match (&self.kind, &other.kind) {
            (Some(own), Some(others)) => own == others,
            _ => true,
        };
        if same {
            self.kind = self.kind.or(other.kind);
            self.diameter = self.diameter.or(other.diameter);
            self.corner_radius = self.corner_radius.or(other.corner_radius);
            self.tip_diameter = self.tip_diameter.or(other.tip_diameter);
            self.taper_angle = self.taper_angle.or(other.taper_angle);
            self.point_angle = self.point_angle.or(other.point_angle);
            self.neck_diameter = self.neck_diameter.or(other.neck_diameter);
        }
        self.name = self.name.or(other.name);
        self.flute_length = self.flute_length.or(other.flute_length);
        self.shoulder_length = self.shoulder_length.or(other.shoulder_length);
        self.shoulder_diameter = self.shoulder_diameter.or(other.shoulder_diameter);
        self.shank_diameter = self.shank_diameter.or(other.shank_diameter);
        self.stick_out = self.stick_out.or(other.stick_out);
        self.overall_length = self.overall_length.or(other.overall_length);
        if self.holder.is_empty() {
            self.holder = other.holder;
            self.holder_name = self.holder_name.or(other.holder_name);
        }
        self
    }
}
