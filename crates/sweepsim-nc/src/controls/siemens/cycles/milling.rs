//! Milling cycles.
//!
//! Sources: the order of the parameters is that of *SINUMERIK 840D sl/828D, Programming Guide Cycles*, as other readers of these programs have it too: POCKET3 was
//! compared with two of them, SLOT2 with the list of calls of an editor (*cnc-sinumerik* for VS Code), which has the
//! names of all its parameters in this order.

use super::arguments::Arguments;
use crate::controls::siemens::interpreter::Reader;
use crate::controls::siemens::language::expression::Value;
use crate::drive::{ArcSlot, Cycle, Pocket, Shape};
use crate::model::stock::StockDescription;
use crate::text::error::NcProblem;

/// The most places of a pattern.
pub(in crate::controls::siemens) const MOST_PLACES: u32 = 10_000;

/// The milling cycles.
pub(in crate::controls::siemens) const MILLING: [&str; 8] = [
    "CYCLE61", "POCKET3", "POCKET4", "CYCLE76", "CYCLE77", "SLOT1", "SLOT2", "LONGHOLE",
];
/// A milling cycle, and where its shapes are: middles in the plane, and turns; of slots on a circle, the radius of their middle lines and how long they are, in degrees.
pub(in crate::controls::siemens) struct Milled {
    pub pocket: Pocket,
    pub places: Vec<([f64; 2], f64)>,
    pub bent: Option<[f64; 2]>,
}

/// One of the [milling cycles](MILLING), with a tool of this radius; `None` for others.
pub(in crate::controls::siemens) fn milled(arguments: &Arguments, tool: f64) -> Option<Result<Milled, NcProblem>> {
    Some(match arguments.name {
        "POCKET3" | "CYCLE76" => rectangle(arguments, tool),
        "POCKET4" | "CYCLE77" => circle(arguments, tool),
        "SLOT1" | "LONGHOLE" => slots(arguments, tool),
        "SLOT2" => bent_slots(arguments, tool),
        "CYCLE61" => facing(arguments, tool),
        _ => return None,
    })
}

/// The sense of `CDIR`: 0 climbs, 1 does not, 2 is G2, 3 is G3.
fn clockwise(direction: Option<f64>, stud: bool) -> bool {
    match direction.map(|direction| direction % 10.0) {
        Some(2.0) => true,
        Some(3.0) => false,
        Some(1.0) => !stud,
        _ => stud,
    }
}

/// `POCKET3(RTP, RFP, SDIS, DP, LENG, WID, CRAD, PA, PO, STA, MID, FAL, FALD, FFP1, FFD, CDIR, VARI, MIDA, …)`;
/// `CYCLE76(RTP, RFP, SDIS, DP, DPR, LENG, WID, CRAD, PA, PO, STA, MID, FAL, FALD, FFP1, FFD, CDIR, VARI, AP1, AP2)`.
fn rectangle(arguments: &Arguments, tool: f64) -> Result<Milled, NcProblem> {
    let stud = arguments.name == "CYCLE76";
    let at = usize::from(stud);
    let levels = arguments.levels(stud.then_some(4))?;
    let half = [
        0.5 * arguments.need(4 + at, "LENG")?.abs(),
        0.5 * arguments.need(5 + at, "WID")?.abs(),
    ];
    let vari = 16 + at;
    let finishes = arguments.finishes(vari);
    let floor = arguments.finishes_floor(vari, 12 + at);
    let raw = [18, 19].map(|index| 0.5 * arguments.length(index).abs());
    let turn = arguments.get(9 + at).unwrap_or(0.0);
    let width = arguments.length(17);
    Ok(Milled {
        pocket: Pocket {
            half,
            corner: arguments.length(6 + at),
            raw: stud.then_some([0, 1].map(|k| raw[k].max(half[k]))),
            turn,
            infeed: if floor { 0.0 } else { arguments.length(10 + at) },
            left: if finishes {
                [0.0; 2]
            } else {
                [arguments.length(11 + at), arguments.length(12 + at)]
            },
            rim_alone: finishes && !floor,
            step: if width > 0.0 && !stud { width } else { 0.8 * 2.0 * tool },
            feed: arguments.feed(13 + at),
            plunge: arguments.feed(14 + at),
            clockwise: clockwise(arguments.get(15 + at), stud),
            ..Pocket::new(levels, tool)
        },
        places: vec![([arguments.length(7 + at), arguments.length(8 + at)], 0.0)],
        bent: None,
    })
}

/// `POCKET4(RTP, RFP, SDIS, DP, PRAD, PA, PO, MID, FAL, FALD, FFP1, FFD, CDIR, VARI, MIDA, …)`;
/// `CYCLE77(RTP, RFP, SDIS, DP, DPR, PRAD, PA, PO, MID, FAL, FALD, FFP1, FFD, CDIR, VARI, AP1)`, whose PRAD and AP1 are diameters.
fn circle(arguments: &Arguments, tool: f64) -> Result<Milled, NcProblem> {
    let stud = arguments.name == "CYCLE77";
    let at = usize::from(stud);
    let levels = arguments.levels(stud.then_some(4))?;
    let radius = arguments.need(4 + at, "PRAD")?.abs() * if stud { 0.5 } else { 1.0 };
    let finishes = arguments.finishes(13 + at);
    let floor = arguments.finishes_floor(13 + at, 9 + at);
    let width = arguments.length(14);
    Ok(Milled {
        pocket: Pocket {
            half: [radius; 2],
            corner: radius,
            raw: stud.then_some([(0.5 * arguments.length(15)).max(radius); 2]),
            infeed: if floor { 0.0 } else { arguments.length(7 + at) },
            left: if finishes {
                [0.0; 2]
            } else {
                [arguments.length(8 + at), arguments.length(9 + at)]
            },
            rim_alone: finishes && !floor,
            step: if width > 0.0 && !stud { width } else { 0.8 * 2.0 * tool },
            feed: arguments.feed(10 + at),
            plunge: arguments.feed(11 + at),
            clockwise: clockwise(arguments.get(12 + at), stud),
            ..Pocket::new(levels, tool)
        },
        places: vec![([arguments.length(5 + at), arguments.length(6 + at)], 0.0)],
        bent: None,
    })
}

/// `CYCLE61(RTP, RFP, SDIS, DP, PA, PO, LENG, WID, MID, MIDA, FALD, FFP1, …)`: all of a surface, over its edges.
fn facing(arguments: &Arguments, tool: f64) -> Result<Milled, NcProblem> {
    let (length, width) = (arguments.need(6, "LENG")?, arguments.need(7, "WID")?);
    let step = arguments.length(9);
    Ok(Milled {
        pocket: Pocket {
            half: [length, width].map(|side| 0.5 * side.abs() + tool),
            corner: tool,
            infeed: arguments.length(8),
            left: [0.0, arguments.length(10)],
            step: if step > 0.0 { step } else { 0.8 * 2.0 * tool },
            feed: arguments.feed(11),
            ..Pocket::new(arguments.levels(None)?, tool)
        },
        places: vec![(
            [arguments.length(4) + 0.5 * length, arguments.length(5) + 0.5 * width],
            0.0,
        )],
        bent: None,
    })
}

/// `SLOT1(RTP, RFP, SDIS, DP, DPR, NUM, LENG, WID, CPA, CPO, RAD, STA1, INDA, FFD, FFP1, MID, CDIR, FAL, …)`;
/// `LONGHOLE(RTP, RFP, SDIS, DP, DPR, NUM, LENG, CPA, CPO, RAD, STA1, INDA, FFD, FFP1, MID)`, as wide as the tool. They point away from the middle of a circle, whose radius
/// is that to their near ends.
fn slots(arguments: &Arguments, tool: f64) -> Result<Milled, NcProblem> {
    let wide = arguments.name == "SLOT1";
    let at = usize::from(wide);
    let levels = arguments.levels(Some(4))?;
    let count = arguments.get(5).unwrap_or(1.0);
    let count = NcProblem::whole(
        format!("NUM of {}", arguments.name),
        count,
        1..=MOST_PLACES,
        "a whole number from 1 on",
    )?;
    let length = arguments.need(6, "LENG")?.abs();
    let width = if wide {
        arguments.need(7, "WID")?.abs()
    } else {
        2.0 * tool
    };
    let [x, y, radius] = [7, 8, 9].map(|index| arguments.length(index + at));
    let first = arguments.get(10 + at).unwrap_or(0.0);
    let step = arguments
        .get(11 + at)
        .filter(|step| *step != 0.0)
        .unwrap_or(360.0 / f64::from(count));
    let place = |k: u32| {
        let angle = first + f64::from(k) * step;
        let (sin, cos) = angle.to_radians().sin_cos();
        let out = radius + 0.5 * length;
        ([x + out * cos, y + out * sin], angle)
    };
    Ok(Milled {
        pocket: Pocket {
            half: [0.5 * length, 0.5 * width],
            corner: 0.5 * width,
            infeed: arguments.length(14 + at),
            left: [if wide { arguments.length(17) } else { 0.0 }, 0.0],
            feed: arguments.feed(13 + at),
            plunge: arguments.feed(12 + at),
            clockwise: wide && clockwise(arguments.get(16), false),
            ..Pocket::new(levels, tool)
        },
        places: (0..count).map(place).collect(),
        bent: None,
    })
}

/// `SLOT2(RTP, RFP, SDIS, DP, DPR, NUM, AFSL, WID, CPA, CPO, RAD, STA1, INDA, FFD, FFP1, MID, CDIR, FAL, VARI, …)`: slots along a circle, each `AFSL` degrees long.
fn bent_slots(arguments: &Arguments, tool: f64) -> Result<Milled, NcProblem> {
    let levels = arguments.levels(Some(4))?;
    let count = arguments.get(5).unwrap_or(1.0);
    let count = NcProblem::whole("NUM of SLOT2", count, 1..=MOST_PLACES, "a whole number from 1 on")?;
    let long = arguments.get(6).unwrap_or(0.0);
    let width = arguments.need(7, "WID")?.abs();
    let [x, y, radius] = [8, 9, 10].map(|index| arguments.length(index));
    let step = arguments.get(12).filter(|step| *step != 0.0);
    let step = step.unwrap_or(360.0 / f64::from(count));
    let first = arguments.get(11).unwrap_or(0.0);
    let finishes = arguments.finishes(18);
    Ok(Milled {
        pocket: Pocket {
            half: [radius.max(0.5 * width), 0.5 * width],
            corner: 0.5 * width,
            infeed: arguments.length(15),
            left: [if finishes { 0.0 } else { arguments.length(17) }, 0.0],
            rim_alone: finishes,
            feed: arguments.feed(14),
            plunge: arguments.feed(13),
            ..Pocket::new(levels, tool)
        },
        places: (0..count).map(|k| ([x, y], first + f64::from(k) * step)).collect(),
        bent: Some([radius, long]),
    })
}

impl Reader<'_> {
    /// A milling cycle: at once, each of its shapes.
    pub(in crate::controls::siemens) fn mill(&mut self, arguments: &Arguments) -> Result<bool, NcProblem> {
        let name = arguments.name;
        let Some(shape) = milled(arguments, 0.0) else {
            return Ok(false);
        };
        if arguments.is_unknown_kind() {
            self.track.leave_out_cycle(name)?;
            return Ok(true);
        }
        let unknown = shape?.pocket.widest_unknown_tool();
        let tool = self.cutter_radius(unknown)?;
        let Some(milled) = milled(arguments, tool) else {
            return Ok(false);
        };
        let Milled {
            mut pocket,
            places,
            bent,
        } = milled?;
        if self.track.known().is_none() && self.uncertain {
            return Ok(true);
        }
        let turn = pocket.turn;
        for (middle, further) in places {
            self.go_to_place(middle, pocket.start)?;
            pocket.turn = turn + further;
            let shape = match bent {
                None => Shape::Pocket(pocket.clone()),
                Some([radius, long]) => Shape::ArcSlot(ArcSlot {
                    pocket: pocket.clone(),
                    radius,
                    first: if long < 0.0 { further + long } else { further },
                    long: long.abs(),
                }),
            };
            let cycle = Cycle::Shape(name.to_owned(), Box::new(shape));
            self.track.cycle_here(&cycle, self.modes.plane, self.uncertain)?;
        }
        Ok(true)
    }
}

/// The block of `WORKPIECE(…, "BOX", 112, ZA, ZI, ZB, XA, YA, XI, YI)`, whose coordinates are absolute, in mm.
pub(in crate::controls::siemens) fn workpiece(values: &[Option<Value>], unit: f64) -> Option<StockDescription> {
    let kind = values
        .iter()
        .position(|value| matches!(value, Some(Value::Text(kind)) if kind.eq_ignore_ascii_case("BOX")))?;
    let number = |index: usize| match values.get(kind + index) {
        Some(Some(Value::Number(number))) => Some(*number),
        _ => None,
    };
    let [z0, z1, x0, y0, x1, y1] = [2, 3, 5, 6, 7, 8].map(|index| number(index).map(|value| value * unit));
    let (min, max) = (
        [x0?.min(x1?), y0?.min(y1?), z0?.min(z1?)],
        [x0?.max(x1?), y0?.max(y1?), z0?.max(z1?)],
    );
    let solid = (0..3).all(|k| min[k] < max[k]);
    (number(1) == Some(112.0) && solid).then_some(StockDescription::Block { min, max })
}
