//! Pockets, slots, studs and faces.
//!
//! Sources: *TNC 620, Cycle Programming* (340 56x-02), 5.2 to 5.7 and 8.1 to 8.5; *TNC 640* (34059x) for cycle 233.

use crate::controls::heidenhain::interpreter::Reader;
use crate::controls::heidenhain::language::line::Line;
use crate::controls::heidenhain::state::Defined;
use crate::drive::{ArcSlot, Cycle, Pocket, Shape};
use crate::text::error::{Located, NcProblem};

impl Reader<'_> {
    /// Faces (230, 232, 233), pockets (251, 252), slots (253, 254) and studs (256, 257).
    pub(in crate::controls::heidenhain) fn shape(&mut self, number: u32, line: &Line) -> Result<Cycle, Located> {
        let shape_of = |reader: &Self, tool: f64| {
            let defined = reader.defined(number, line);
            match number {
                230..=233 => face(&defined, tool, reader.plane_position()).map(Shape::Pocket),
                254 => arc_slot(&defined, tool, reader.plane_position()).map(Shape::ArcSlot),
                _ => pocket(&defined, tool).map(Shape::Pocket),
            }
        };
        let unknown = match shape_of(self, 0.0)? {
            Shape::ArcSlot(slot) => slot.pocket.widest_unknown_tool(),
            Shape::Pocket(pocket) => pocket.widest_unknown_tool(),
            Shape::Contours(_) => 0.0,
        };
        let tool = self.cutter_radius(unknown).ok_or_else(|| {
            let problem = format!(
                "the radius of the tool of cycle {number} is not known: expected --diameters (in a job: `diameters`), or TOOL DEF … R"
            );
            (NcProblem::syntax(problem), line.all())
        })?;
        let shape = shape_of(self, tool)?;
        Ok(Cycle::Shape(format!("cycle {number}"), Box::new(shape)))
    }

    /// Where the tool is in the plane, as far as that is known.
    fn plane_position(&self) -> [f64; 2] {
        let [u, v, _] = self.modes.plane;
        [u, v].map(|k| self.track.xyz[k].unwrap_or(0.0))
    }
}

/// The levels, feeds and allowances of all shapes; `floor` and `side` are the parameters of the allowances.
fn levels(defined: &Defined, tool: f64) -> Result<Pocket, Located> {
    let surface = defined.span(203)?;
    let start = surface + defined.need(200)?.abs();
    // Roughing alone leaves what is left for finishing.
    let kind = defined.number(215)?;
    let left = match kind == 1.0 {
        true => [defined.span(368)?, defined.span(369)?],
        false => [0.0; 2],
    };
    // Finishing takes the floor too, at once, if something was left there.
    let floor = kind == 2.0 && defined.span(369)? != 0.0;
    let infeed = match kind {
        _ if floor => None,
        2.0 => defined.length(338)?,
        _ => defined.length(202)?,
    };
    let end = start.max(surface + defined.span(204)?);
    Ok(Pocket {
        infeed: infeed.unwrap_or(0.0),
        left,
        rim_alone: kind == 2.0 && !floor,
        step: tool * defined.find(370)?.filter(|overlap| *overlap > 0.0).unwrap_or(1.0),
        feed: defined.feed(207)?,
        plunge: defined.feed(206)?,
        ..Pocket::new([end, start, surface, surface], tool)
    })
}

/// Pockets (251, 252), slots (253) and studs (256, 257).
fn pocket(defined: &Defined, tool: f64) -> Result<Pocket, Located> {
    let number = defined.number;
    let half = |parameter: u32| Ok::<f64, Located>(0.5 * defined.need(parameter)?.abs());
    let (sides, corner, raw) = match number {
        251 => ([half(218)?, half(219)?], defined.span(220)?, None),
        252 => ([half(223)?; 2], half(223)?, None),
        253 => ([half(218)?, half(219)?], half(219)?, None),
        256 => {
            let raw = [half(424)?, half(425)?];
            ([half(218)?, half(219)?], defined.span(220)?, Some(raw))
        }
        _ => ([half(223)?; 2], half(223)?, Some([half(222)?; 2])),
    };
    let [x, y] = sides;
    let aside = match (number, defined.number(367)?) {
        (253, 1.0) => [x, 0.0],
        (253, 2.0) => [x - corner, 0.0],
        (253, 3.0) => [corner - x, 0.0],
        (253, 4.0) => [-x, 0.0],
        (251 | 256, 1.0) => [x, y],
        (251 | 256, 2.0) => [-x, y],
        (251 | 256, 3.0) => [-x, -y],
        (251 | 256, 4.0) => [x, -y],
        _ => [0.0; 2],
    };
    let shape = levels(defined, tool)?;
    let climbs = defined.find(351)? != Some(-1.0);
    Ok(Pocket {
        half: sides,
        corner,
        raw,
        aside,
        turn: defined.number(if number == 253 { 374 } else { 224 })?,
        bottom: shape.surface + defined.depth(201)?,
        clockwise: climbs == raw.is_some(),
        ..shape
    })
}

/// Cycle 254: about a point of the frame, or with the tool in the middle or at an end of it.
fn arc_slot(defined: &Defined, tool: f64, [x, y]: [f64; 2]) -> Result<ArcSlot, Located> {
    let (radius, width) = (0.5 * defined.need(375)?.abs(), 0.5 * defined.need(219)?.abs());
    let (first, long) = (defined.number(376)?, defined.number(248)?);
    let repeats = defined.find(377)?.unwrap_or(1.0);
    if repeats > 1.0 {
        let problem = NcProblem::unsupported("more than one slot (Q377) of cycle 254 is", "expected a call for each");
        return Err(defined.fail(problem));
    }
    let to_middle = |angle: f64| {
        let (sin, cos) = angle.to_radians().sin_cos();
        [-radius * cos, -radius * sin]
    };
    let aside = match defined.number(367)? {
        1.0 => to_middle(first),
        2.0 => to_middle(first + 0.5 * long),
        3.0 => to_middle(first + long),
        _ => [defined.need(216)? - x, defined.need(217)? - y],
    };
    let shape = levels(defined, tool)?;
    Ok(ArcSlot {
        pocket: Pocket {
            half: [width.max(radius), width],
            corner: width,
            aside,
            bottom: shape.surface + defined.depth(201)?,
            ..shape
        },
        radius,
        first: if long < 0.0 { first + long } else { first },
        long: long.abs(),
    })
}

/// Faces: 230 and 232 from a corner of the frame, 233 from where it is called; over the edges, but for the sides of 233 that have a limit.
fn face(defined: &Defined, tool: f64, [x, y]: [f64; 2]) -> Result<Pocket, Located> {
    let sides = [defined.need(218)?, defined.need(219)?];
    let corner = match defined.number {
        233 => [0.0; 2],
        _ => [defined.need(225)? - x, defined.need(226)? - y],
    };
    let top = defined.need(227)?;
    let bottom = match defined.number {
        230 => top,
        _ => defined.need(386)?,
    };
    let mut bounds: [[f64; 2]; 2] =
        std::array::from_fn(|k| [corner[k].min(corner[k] + sides[k]), corner[k].max(corner[k] + sides[k])]);
    let mut limits = [[false; 2]; 2];
    for parameter in [347, 348, 349] {
        match defined.number(parameter)? {
            -1.0 => limits[0][0] = true,
            1.0 => limits[0][1] = true,
            -2.0 => limits[1][0] = true,
            2.0 => limits[1][1] = true,
            _ => {}
        }
    }
    for k in 0..2 {
        if !limits[k][0] {
            bounds[k][0] -= tool;
        }
        if !limits[k][1] {
            bounds[k][1] += tool;
        }
    }
    let clearance = defined.need(200)?.abs();
    // At once where there is nothing to take between both levels.
    let surface = if top > bottom {
        top
    } else {
        bottom + clearance.max(1e-3)
    };
    let shape = levels(defined, tool)?;
    Ok(Pocket {
        half: bounds.map(|[low, high]| 0.5 * (high - low)),
        corner: tool,
        aside: bounds.map(|[low, high]| 0.5 * (low + high)),
        start: surface + clearance,
        surface,
        bottom,
        end: surface + clearance.max(defined.span(204)?),
        infeed: if top > bottom { shape.infeed } else { 0.0 },
        left: [0.0, defined.span(369)?],
        rim_alone: false,
        ..shape
    })
}
