//! Milling cycles, and patterns of places where a cycle is called.
//!
//! Sources: the order of the parameters is that of *SINUMERIK 840D sl/828D, Programming Guide Cycles*, as other readers of these programs have it too: POCKET3 and CYCLE801 were
//! compared with two of them.

use super::interpreter::Reader;
use super::language::expression::Value;
use super::state::Modal;
use crate::drive::{ArcSlot, Cycle, Pocket, Shape};
use crate::model::stock::StockDescription;
use crate::text::assumption::Assumption;
use crate::text::error::NcProblem;

/// The most places of a pattern.
const MOST_PLACES: u32 = 10_000;

/// The milling cycles.
pub(super) const MILLING: [&str; 8] = [
    "CYCLE61", "POCKET3", "POCKET4", "CYCLE76", "CYCLE77", "SLOT1", "SLOT2", "LONGHOLE",
];
/// Where the modal cycle is called.
pub(super) const PATTERNS: [&str; 3] = ["HOLES1", "HOLES2", "CYCLE801"];

/// A milling cycle, and where its shapes are: middles in the plane, and turns; of slots on a circle, the radius of their middle lines and how long they are, in degrees.
pub(super) struct Milled {
    pub pocket: Pocket,
    pub places: Vec<([f64; 2], f64)>,
    pub bent: Option<[f64; 2]>,
}

/// The arguments of a cycle.
struct Arguments<'a> {
    name: &'a str,
    values: &'a [Option<f64>],
    unit: f64,
}

impl Arguments<'_> {
    fn get(&self, index: usize) -> Option<f64> {
        self.values.get(index).copied().flatten()
    }

    fn length(&self, index: usize) -> f64 {
        self.get(index).unwrap_or(0.0) * self.unit
    }

    fn need(&self, index: usize, parameter: &str) -> Result<f64, NcProblem> {
        let name = self.name;
        let problem = || NcProblem::syntax(format!("{name} without {parameter}: expected a number"));
        self.get(index).map(|value| value * self.unit).ok_or_else(problem)
    }

    /// Where the tool is at last, where it begins, the surface and the bottom: RTP, RFP, SDIS, DP and, with `relative`, DPR.
    fn levels(&self, relative: Option<usize>) -> Result<[f64; 4], NcProblem> {
        let (retract, surface) = (self.need(0, "RTP")?, self.need(1, "RFP")?);
        let bottom = match relative.and_then(|index| self.get(index)) {
            Some(depth) if depth != 0.0 => surface - depth.abs() * self.unit,
            _ => self.need(3, "DP")?,
        };
        Ok([retract, surface + self.length(2).abs(), surface, bottom])
    }

    /// A feed, if it is above 0.
    fn feed(&self, index: usize) -> Option<f64> {
        self.get(index).filter(|feed| *feed > 0.0)
    }

    /// Whether the last digit of a way of machining asks for finishing alone.
    fn finishes(&self, index: usize) -> bool {
        self.get(index).is_some_and(|kind| kind % 10.0 >= 2.0)
    }
}

/// One of the [milling cycles](MILLING), with a tool of this radius; `None` for others.
pub(super) fn milled(name: &str, values: &[Option<f64>], unit: f64, tool: f64) -> Option<Result<Milled, NcProblem>> {
    let arguments = Arguments { name, values, unit };
    Some(match name {
        "POCKET3" | "CYCLE76" => rectangle(&arguments, tool),
        "POCKET4" | "CYCLE77" => circle(&arguments, tool),
        "SLOT1" | "LONGHOLE" => slots(&arguments, tool),
        "SLOT2" => bent_slots(&arguments, tool),
        "CYCLE61" => facing(&arguments, tool),
        _ => return None,
    })
}

fn pocket([end, start, surface, bottom]: [f64; 4], tool: f64) -> Pocket {
    Pocket {
        half: [0.0; 2],
        corner: 0.0,
        raw: None,
        aside: [0.0; 2],
        turn: 0.0,
        start,
        surface,
        bottom,
        end,
        infeed: 0.0,
        left: [0.0; 2],
        rim_alone: false,
        tool,
        step: tool,
        feed: None,
        plunge: None,
        clockwise: false,
    }
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
    let raw = [18, 19].map(|index| 0.5 * arguments.length(index).abs());
    let turn = arguments.get(9 + at).unwrap_or(0.0);
    let width = arguments.length(17);
    Ok(Milled {
        pocket: Pocket {
            half,
            corner: arguments.length(6 + at),
            raw: stud.then_some([0, 1].map(|k| raw[k].max(half[k]))),
            turn,
            infeed: arguments.length(10 + at),
            left: if finishes {
                [0.0; 2]
            } else {
                [arguments.length(11 + at), arguments.length(12 + at)]
            },
            rim_alone: finishes,
            step: if width > 0.0 && !stud { width } else { 0.8 * 2.0 * tool },
            feed: arguments.feed(13 + at),
            plunge: arguments.feed(14 + at),
            clockwise: clockwise(arguments.get(15 + at), stud),
            ..pocket(levels, tool)
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
    let width = arguments.length(14);
    Ok(Milled {
        pocket: Pocket {
            half: [radius; 2],
            corner: radius,
            raw: stud.then_some([(0.5 * arguments.length(15)).max(radius); 2]),
            infeed: arguments.length(7 + at),
            left: if finishes {
                [0.0; 2]
            } else {
                [arguments.length(8 + at), arguments.length(9 + at)]
            },
            rim_alone: finishes,
            step: if width > 0.0 && !stud { width } else { 0.8 * 2.0 * tool },
            feed: arguments.feed(10 + at),
            plunge: arguments.feed(11 + at),
            clockwise: clockwise(arguments.get(12 + at), stud),
            ..pocket(levels, tool)
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
            ..pocket(arguments.levels(None)?, tool)
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
            ..pocket(levels, tool)
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
            ..pocket(levels, tool)
        },
        places: (0..count).map(|k| ([x, y], first + f64::from(k) * step)).collect(),
        bent: Some([radius, long]),
    })
}

/// `HOLES1(SPCA, SPCO, STA1, FDIS, DBH, NUM)`, `HOLES2(CPA, CPO, RAD, STA1, INDA, NUM)`, `CYCLE801(SPCA, SPCO, STA, DIS1, DIS2, NUM1, NUM2)`: places in the plane; `None` for others.
pub(super) fn pattern(name: &str, values: &[Option<f64>], unit: f64) -> Option<Result<Vec<[f64; 2]>, NcProblem>> {
    let arguments = Arguments { name, values, unit };
    let count = |index: usize| {
        let count = arguments.get(index).unwrap_or(1.0);
        NcProblem::whole(
            format!("the number of places of {name}"),
            count,
            1..=MOST_PLACES,
            "a whole number from 1 on",
        )
    };
    let (x, y) = (arguments.length(0), arguments.length(1));
    let turned = |angle: f64, a: f64, b: f64| {
        let (sin, cos) = angle.to_radians().sin_cos();
        [x + a * cos - b * sin, y + a * sin + b * cos]
    };
    let angle = |index: usize| arguments.get(index).unwrap_or(0.0);
    Some(match name {
        "HOLES1" => count(5).map(|count| {
            let (first, step) = (arguments.length(3), arguments.length(4));
            (0..count)
                .map(|k| turned(angle(2), first + f64::from(k) * step, 0.0))
                .collect()
        }),
        "HOLES2" => count(5).map(|count| {
            let step = arguments
                .get(4)
                .filter(|step| *step != 0.0)
                .unwrap_or(360.0 / f64::from(count));
            let radius = arguments.length(2);
            (0..count)
                .map(|k| turned(angle(3) + f64::from(k) * step, radius, 0.0))
                .collect()
        }),
        "CYCLE801" => count(5).and_then(|columns| {
            let rows = count(6)?;
            if columns.saturating_mul(rows) > MOST_PLACES {
                return Err(NcProblem::value(
                    "the number of places of CYCLE801",
                    columns * rows,
                    "at most 10000",
                ));
            }
            let (across, along) = (arguments.length(3), arguments.length(4));
            let place = |k: u32| {
                let (row, column) = (k / columns, k % columns);
                // To and fro.
                let column = if row % 2 == 0 { column } else { columns - 1 - column };
                turned(angle(2), f64::from(column) * across, f64::from(row) * along)
            };
            Ok((0..columns * rows).map(place).collect())
        }),
        _ => return None,
    })
}

impl Reader<'_> {
    /// A milling cycle: at once, each of its shapes.
    pub(super) fn mill(&mut self, name: &str, values: &[Option<f64>]) -> Result<bool, NcProblem> {
        if !MILLING.contains(&name) {
            return Ok(false);
        }
        let unit = self.modes.unit();
        let Some(shape) = milled(name, values, unit, 0.0) else {
            return Ok(false);
        };
        let unknown = shape?.pocket.widest_unknown_tool();
        let tool = self.cutter_radius(unknown)?;
        let Some(milled) = milled(name, values, unit, tool) else {
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

    /// A pattern: the modal cycle at each of its places.
    pub(super) fn places(&mut self, name: &str, values: &[Option<f64>]) -> Result<bool, NcProblem> {
        let Some(places) = pattern(name, values, self.modes.unit()) else {
            return Ok(false);
        };
        let places = places?;
        let Some((_, Modal::Cycle(cycle))) = self.modes.modal_call.clone() else {
            let taken = "no cycle is modal: it moves nothing";
            self.track
                .assume(Assumption::new(format!("what {name} calls"), taken, "MCALL before it"));
            return Ok(true);
        };
        for place in places {
            self.go_to_place(place, f64::NEG_INFINITY)?;
            self.track.cycle_here(&cycle, self.modes.plane, self.uncertain)?;
        }
        Ok(true)
    }

    /// In rapid over a place, not below a level.
    pub(super) fn go_to_place(&mut self, [a, b]: [f64; 2], level: f64) -> Result<(), NcProblem> {
        let [u, v, w] = self.modes.plane;
        let Some(mut at) = self.track.known() else {
            // The cycle says from where it begins.
            (self.track.xyz[u], self.track.xyz[v]) = (Some(a), Some(b));
            return Ok(());
        };
        if at[w] < level {
            at[w] = level;
            self.track.line(at, self.track.abc, true)?;
        }
        (at[u], at[v]) = (a, b);
        self.track.line(at, self.track.abc, true)
    }
}

/// The block of `WORKPIECE(…, "BOX", 112, ZA, ZI, ZB, XA, YA, XI, YI)`, whose coordinates are absolute, in mm.
pub(super) fn workpiece(values: &[Option<Value>], unit: f64) -> Option<StockDescription> {
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
