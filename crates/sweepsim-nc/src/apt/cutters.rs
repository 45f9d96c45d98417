//! Tools from `CUTTER` and `TLDATA`.

use sweepsim_motion::Apt;

use super::statement::Statement;
use crate::model::tool::{CutterKind, ToolDescription};
use crate::text::error::NcProblem;

/// `CUTTER/d, r, e, f, a, b, h`: the seven parameters, or the first ones of them.
pub(super) fn cutter(statement: &Statement, unit: f64) -> Result<Option<ToolDescription>, NcProblem> {
    let numbers = statement.numbers();
    let length = |index: usize| numbers.get(index).map_or(0.0, |value| value * unit);
    let angle = |index: usize| numbers.get(index).copied().unwrap_or(0.0);
    let Some(&d) = numbers.first() else {
        return Err(NcProblem::syntax(
            "CUTTER without numbers: expected d, r, e, f, a, b, h",
        ));
    };
    if d == 0.0 && length(1) == 0.0 {
        // A point, with which contours are drawn.
        return Ok(None);
    }
    if !(d >= 0.0 && length(1) >= 0.0) {
        let least = d.min(numbers.get(1).copied().unwrap_or(0.0));
        return Err(NcProblem::value("a length of CUTTER", least, "0 or greater"));
    }
    let (diameter, corner) = (d * unit, length(1));
    if numbers.len() >= 7 && length(6) > 0.0 {
        let apt = Apt {
            d: diameter,
            r: corner,
            e: length(2),
            f: length(3),
            a: angle(4),
            b: angle(5),
            h: length(6),
        };
        return Ok(Some(seven(apt)));
    }
    if angle(4) != 0.0 || angle(5) != 0.0 {
        return Err(NcProblem::syntax(
            "CUTTER with an angle but without a height: expected d, r, e, f, a, b, h",
        ));
    }
    let mut tool = ToolDescription::new(round(diameter, corner));
    tool.diameter = Some(diameter);
    tool.corner_radius = (corner > 0.0).then_some(corner);
    Ok(Some(tool))
}

/// The kind of a cylindrical mill.
fn round(diameter: f64, corner: f64) -> CutterKind {
    if corner <= 0.0 {
        CutterKind::Flat
    } else if corner < 0.5 * diameter * (1.0 - 1e-6) {
        CutterKind::Bull
    } else {
        CutterKind::Ball
    }
}

/// The tool with seven parameters. It is as wide as these say up to its height; where the flutes end, the shank begins.
fn seven(apt: Apt) -> ToolDescription {
    let mut tool = ToolDescription::new(CutterKind::Apt(apt));
    tool.diameter = Some(apt.d);
    tool.overall_length = Some(apt.h);
    if apt.b == 0.0 {
        tool.shank_diameter = Some(apt.d);
    }
    tool
}

/// `TLDATA/MILL, diameter, lower radius, length, taper, tip`; `TLDATA/DRILL, MILL, diameter, radius, length, point angle, flute length`.
pub(super) fn tool_data(statement: &Statement, unit: f64) -> Result<ToolDescription, NcProblem> {
    let kind = statement.items.first().map_or("", |item| item.text);
    let numbers = statement.numbers();
    let length = |index: usize| numbers.get(index).map(|value| value * unit);
    let angle = |index: usize| numbers.get(index).copied().unwrap_or(0.0);
    let positive = |index: usize| length(index).filter(|value| *value > 0.0);
    if kind.eq_ignore_ascii_case("DRILL") {
        let mut tool = ToolDescription::new(CutterKind::Drill);
        tool.diameter = positive(0);
        tool.overall_length = positive(2);
        tool.point_angle = numbers.get(3).copied();
        tool.flute_length = positive(4).or(positive(2));
        tool.shank_diameter = positive(0);
        return Ok(tool);
    }
    if !kind.eq_ignore_ascii_case("MILL") {
        let mut tool = ToolDescription::new(CutterKind::Other(format!("TLDATA/{kind}")));
        tool.diameter = positive(0);
        return Ok(tool);
    }
    let (Some(diameter), Some(corner)) = (positive(0), length(1)) else {
        return Err(NcProblem::syntax(
            "TLDATA/MILL without its measures: expected diameter, lower radius, length, taper and tip angle",
        ));
    };
    let (taper, tip) = (angle(3), angle(4));
    let height = positive(2);
    if taper == 0.0 && tip == 0.0 {
        let mut tool = ToolDescription::new(round(diameter, corner));
        tool.diameter = Some(diameter);
        tool.corner_radius = (corner > 0.0).then_some(corner);
        tool.flute_length = height;
        return Ok(tool);
    }
    let Some(h) = height else {
        return Err(NcProblem::syntax(
            "TLDATA/MILL with an angle but without a length: expected both",
        ));
    };
    if taper.abs() >= 89.0 || tip.abs() >= 89.0 {
        let found = format!("{taper} and {tip} degrees");
        return Err(NcProblem::value(
            "the taper and the tip angle of TLDATA",
            found,
            "less than 89 degrees",
        ));
    }
    // The corner touches the bottom line, at angle a, and the flank, at angle b from the axis, which meet at radius d/2.
    let ((sin_a, cos_a), (sin_b, cos_b)) = (tip.to_radians().sin_cos(), taper.to_radians().sin_cos());
    let meet = [0.5 * diameter, 0.5 * diameter * sin_a / cos_a];
    let (above, inside) = ([-sin_a, cos_a], [-cos_b, sin_b]);
    let along = corner + meet[0] * inside[0] + meet[1] * inside[1];
    let determinant = above[0] * inside[1] - above[1] * inside[0];
    let e = (corner * inside[1] - along * above[1]) / determinant;
    let f = (along * above[0] - corner * inside[0]) / determinant;
    Ok(seven(Apt {
        d: diameter,
        r: corner,
        e,
        f,
        a: tip,
        b: taper,
        h,
    }))
}
