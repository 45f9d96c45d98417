//! The file format of jobs: its names and fields, before any value is checked.

use std::collections::BTreeMap;

use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Job {
    #[serde(default)]
    pub name: Option<String>,
    #[serde(default)]
    pub units: Units,
    #[serde(default)]
    pub tolerance: Option<f64>,
    #[serde(default)]
    pub grid: Option<Grid>,
    pub stock: Stock,
    #[serde(default)]
    pub tools: BTreeMap<u32, Tool>,
    #[serde(default)]
    pub library: Option<String>,
    #[serde(default)]
    pub bodies: BTreeMap<u32, Vec<Body>>,
    #[serde(default)]
    pub paths: Option<Vec<Path>>,
    #[serde(default)]
    pub setups: Option<Vec<Setup>>,
    #[serde(default)]
    pub fixtures: Vec<Stock>,
    #[serde(default)]
    pub target: Option<Target>,
    #[serde(default)]
    pub limits: Option<Limits>,
    #[serde(default)]
    pub clearance: Option<f64>,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
pub(crate) enum Units {
    #[default]
    Mm,
    Inch,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Grid {
    #[serde(default)]
    pub min: Option<[f64; 2]>,
    #[serde(default)]
    pub max: Option<[f64; 2]>,
    #[serde(default)]
    pub cells: Option<[i64; 2]>,
    #[serde(default)]
    pub cell: Option<f64>,
    #[serde(default)]
    pub frame: Option<Frame>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Frame {
    #[serde(default)]
    pub origin: [f64; 3],
    #[serde(default = "z_axis")]
    pub z: [f64; 3],
    #[serde(default = "x_axis")]
    pub x: [f64; 3],
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Setup {
    #[serde(default)]
    pub name: Option<String>,
    #[serde(default)]
    pub frame: Option<Frame>,
    pub paths: Vec<Path>,
    #[serde(default)]
    pub fixtures: Vec<Stock>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) enum Stock {
    Block {
        min: [f64; 3],
        max: [f64; 3],
    },
    Cylinder {
        #[serde(default)]
        base: [f64; 3],
        #[serde(default = "z_axis")]
        axis: [f64; 3],
        radius: f64,
        height: f64,
    },
    Ball {
        centre: [f64; 3],
        radius: f64,
    },
    Mesh(String),
    Dexels(String),
    Union(Vec<Stock>),
    Intersection(Vec<Stock>),
    Difference(Box<Stock>, Vec<Stock>),
}

fn x_axis() -> [f64; 3] {
    [1.0, 0.0, 0.0]
}

fn z_axis() -> [f64; 3] {
    [0.0, 0.0, 1.0]
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) enum Tool {
    Ball {
        radius: f64,
        length: f64,
    },
    Flat {
        radius: f64,
        length: f64,
    },
    Bull {
        radius: f64,
        corner: f64,
        length: f64,
    },
    Apt {
        d: f64,
        r: f64,
        e: f64,
        f: f64,
        a: f64,
        b: f64,
        h: f64,
    },
    Lollipop {
        radius: f64,
        neck: f64,
        length: f64,
    },
    Dovetail {
        radius: f64,
        angle: f64,
        height: f64,
        neck: f64,
        length: f64,
    },
    Barrel {
        radius: f64,
        flank: f64,
        height: f64,
        #[serde(default)]
        corner: f64,
        length: f64,
    },
    Lens {
        radius: f64,
        bottom: f64,
        #[serde(default)]
        corner: f64,
        length: f64,
    },
    Oval {
        radius: f64,
        tip: f64,
        flank: f64,
        length: f64,
    },
    Taper {
        radius: f64,
        tip: f64,
        flank: f64,
        angle: f64,
        length: f64,
    },
    Profile {
        start: [f64; 2],
        segments: Vec<Segment>,
    },
    Surface(String),
}

#[derive(Debug, Deserialize)]
pub(crate) enum Body {
    Shank(Tool),
    Holder(Tool),
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) enum Segment {
    Line([f64; 2]),
    Arc {
        to: [f64; 2],
        centre: [f64; 2],
        turn: Turn,
    },
    Spline {
        degree: usize,
        points: Vec<[f64; 2]>,
        #[serde(default)]
        knots: Option<Vec<f64>>,
        #[serde(default)]
        weights: Option<Vec<f64>>,
    },
}

#[derive(Clone, Copy, Debug, Deserialize)]
pub(crate) enum Turn {
    Cw,
    Ccw,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Path {
    pub tool: Option<u32>,
    pub frame: Option<Frame>,
    pub feed: Option<f64>,
    pub poses: Option<Vec<Pose>>,
    pub moves: Option<Vec<Move>>,
    pub motion: Option<Motion>,
    pub law: Option<Law>,
    pub arcs: Option<Arcs>,
    pub file: Option<String>,
    pub arc_tolerance: Option<f64>,
    pub table: Option<Table>,
    pub tip_control: Option<bool>,
    pub format: Option<String>,
    pub controller: Option<String>,
    pub machine: Option<String>,
    pub lenient: Option<bool>,
    pub strict: Option<bool>,
    #[serde(default)]
    pub diameters: BTreeMap<u32, f64>,
    #[serde(default)]
    pub offsets: BTreeMap<String, (f64, f64, f64)>,
}

/// The tip, the axis, and optionally the direction of the tool's x axis: two or three triples in parentheses.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pose(pub [f64; 3], pub [f64; 3], pub Option<[f64; 3]>);

impl<'de> Deserialize<'de> for Pose {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Triples;
        impl<'de> Visitor<'de> for Triples {
            type Value = Pose;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a pose ((tip), (axis)) or ((tip), (axis), (side)), each of three numbers")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Pose, A::Error> {
                let mut next = |at: usize| -> Result<[f64; 3], A::Error> {
                    list.next_element()?.ok_or_else(|| A::Error::invalid_length(at, &Self))
                };
                let (tip, axis) = (next(0)?, next(1)?);
                Ok(Pose(tip, axis, list.next_element()?))
            }
        }
        deserializer.deserialize_tuple(3, Triples)
    }
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) enum Move {
    Start(Pose),
    Line(Pose),
    Rapid(Pose),
    Arc {
        to: Pose,
        centre: [f64; 3],
        #[serde(default = "z_axis")]
        normal: [f64; 3],
        turn: Turn,
        #[serde(default = "one")]
        turns: u16,
    },
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Motion {
    pub tip: Curve,
    #[serde(default)]
    pub orientation: Option<Orientation>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Curve {
    pub degree: usize,
    pub points: Vec<[f64; 3]>,
    #[serde(default)]
    pub knots: Option<Vec<f64>>,
    #[serde(default)]
    pub weights: Option<Vec<f64>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) enum Orientation {
    Quaternions {
        degree: usize,
        points: Vec<[f64; 4]>,
        #[serde(default)]
        knots: Option<Vec<f64>>,
    },
    Matrices {
        degree: usize,
        points: Vec<[[f64; 3]; 3]>,
        #[serde(default)]
        knots: Option<Vec<f64>>,
        #[serde(default)]
        weights: Option<Vec<f64>>,
        #[serde(default)]
        tolerance: Option<f64>,
    },
}

fn one() -> u16 {
    1
}

#[derive(Clone, Copy, Debug, Deserialize)]
pub(crate) enum Law {
    Slerp,
    ConstantSpeed,
    Rotary(Table),
}

#[derive(Clone, Copy, Debug, Deserialize)]
pub(crate) enum Arcs {
    Chords,
    Level,
    Upright,
    Exact,
}

#[derive(Clone, Copy, Debug, Deserialize)]
pub(crate) enum Table {
    #[serde(rename = "AC")]
    Ac,
    #[serde(rename = "BC")]
    Bc,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) enum Target {
    Mesh(String),
    Dexels(String),
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Limits {
    pub gouge: f64,
    pub excess: f64,
    #[serde(default)]
    pub regions: Vec<LimitRegion>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Region")]
pub(crate) struct LimitRegion {
    #[serde(default)]
    pub name: Option<String>,
    #[serde(default)]
    pub within: Option<RegionBox>,
    #[serde(default)]
    pub colour: Option<String>,
    #[serde(default)]
    pub face: Option<String>,
    pub gouge: f64,
    pub excess: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) enum RegionBox {
    Block { min: [f64; 3], max: [f64; 3] },
}
