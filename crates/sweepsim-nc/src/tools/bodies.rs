//! Shank and holder as outlines.

use sweepsim_motion::BodyKind;

use super::build::ToolProblem;
use crate::model::tool::{CutterKind, HolderSegment, ToolDescription};

/// A shank or holder as an outline.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Outline {
    pub kind: BodyKind,
    pub start: [f64; 2],
    pub to: Vec<[f64; 2]>,
}

impl ToolDescription {
    /// The height above the tip up to which the cutter reaches, if that is known.
    fn cutting_height(&self) -> Option<f64> {
        match (&self.kind, self.flute_length) {
            (Some(CutterKind::Dovetail), _) => self.shoulder_length,
            (_, Some(length)) => Some(length),
            (Some(CutterKind::Apt(apt)), None) => Some(apt.h),
            _ => None,
        }
    }

    /// Shank and holder, as far as they are described.
    pub(crate) fn outlines(&self) -> Result<Vec<Outline>, ToolProblem> {
        let mut outlines = Vec::new();
        let Some(mut from) = self.cutting_height() else {
            return Ok(outlines);
        };
        let end = self.stick_out.or(self.overall_length);
        let mut cylinder = |kind, radius: f64, from: f64, to: f64| {
            outlines.push(Outline {
                kind,
                start: [0.0, from],
                to: vec![[radius, from], [radius, to], [0.0, to]],
            });
        };
        if let (Some(to), Some(diameter)) = (self.shoulder_length, self.shoulder_diameter)
            && to > from
            && diameter > 0.0
        {
            cylinder(BodyKind::Shank, 0.5 * diameter, from, to);
            from = to;
        }
        if let (Some(to), Some(diameter)) = (end, self.shank_diameter)
            && to > from
            && diameter > 0.0
        {
            cylinder(BodyKind::Shank, 0.5 * diameter, from, to);
            from = to;
        }
        let mut at = self.stick_out.unwrap_or(from).max(from);
        for &HolderSegment {
            height,
            lower_diameter,
            upper_diameter,
        } in &self.holder
        {
            let (lower, upper) = (0.5 * lower_diameter, 0.5 * upper_diameter);
            if !(height.is_finite() && lower.is_finite() && upper.is_finite()) || height < 0.0 || lower.min(upper) < 0.0
            {
                let expected = "finite and not negative";
                return Err(ToolProblem::Measure {
                    what: "height of a holder's segment",
                    value: height,
                    expected,
                });
            }
            // A step of the outline has no height of its own.
            if height > 0.0 && lower.max(upper) > 0.0 {
                let corners = [[lower, at], [upper, at + height], [0.0, at + height]];
                outlines.push(Outline {
                    kind: BodyKind::Holder,
                    start: [0.0, at],
                    to: corners
                        .into_iter()
                        .enumerate()
                        .filter(|(k, corner)| *k == 2 || corner[0] > 0.0)
                        .map(|(_, corner)| corner)
                        .collect(),
                });
            }
            at += height;
        }
        Ok(outlines)
    }
}
