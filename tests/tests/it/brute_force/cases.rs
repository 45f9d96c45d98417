//! Tools, moves and grids for random cases.

use nalgebra::{Rotation3, Unit, Vector3};
use std::f64::consts::TAU;
use std::fmt;
use sweepsim_dexel::Grid;
use sweepsim_motion::{Pose, Tool};
use sweepsim_props::*;
use sweepsim_tests::tools;

/// A tool with its largest radius.
#[derive(Clone, Debug)]
pub struct Cutter {
    pub name: String,
    pub tool: Tool,
    pub radius: f64,
}

/// A sweep, and the lines along which it is checked.
#[derive(Clone)]
pub struct Case {
    pub cutter: Cutter,
    pub poses: Vec<Pose>,
    pub window: Window,
}

/// How a grid lies about the tip of the first pose.
#[derive(Clone, Copy, Debug)]
pub enum Window {
    /// Anywhere: `shift` of its middle and half its size, both in radii of the tool; lines a side.
    Free { shift: [f64; 2], half: f64, lines: usize },
    /// Lines through the tip's axis and tangent to the tool's wall: a spacing of `1/parts` radii, `reach` lines to each
    /// side.
    Aligned { parts: usize, reach: usize },
}

impl Case {
    pub fn grid(&self) -> Grid {
        let tip = Vector3::from(self.poses[0].tip());
        let radius = self.cutter.radius;
        let (middle, half, lines) = match self.window {
            Window::Free { shift, half, lines } => {
                let middle = [tip.x + shift[0] * radius, tip.y + shift[1] * radius];
                (middle, half * radius, lines)
            }
            Window::Aligned { parts, reach } => {
                let lines = 2 * reach + 1;
                let spacing = radius / parts as f64;
                ([tip.x, tip.y], 0.5 * spacing * lines as f64, lines)
            }
        };
        let corner = |sign: f64| [middle[0] + sign * half, middle[1] + sign * half];
        Grid::new(corner(-1.0), corner(1.0), [lines, lines]).expect("a grid")
    }
}

/// A case as code: what reproduces a failure.
impl fmt::Debug for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}, poses (tip, axis) [", self.cutter.name)?;
        for pose in &self.poses {
            let (tip, axis): ([f64; 3], [f64; 3]) = (pose.tip(), pose.axis());
            writeln!(f, "    ({tip:?}, {axis:?}),")?;
        }
        let grid = self.grid();
        write!(
            f,
            "], Grid::new({:?}, {:?}, {:?})",
            grid.min(),
            grid.max(),
            grid.cells()
        )
    }
}

pub fn free_window() -> impl Strategy<Value = Window> {
    let shift = prop::array::uniform2(-1.0..1.0);
    (shift, 0.8..2.2, 10_usize..14).prop_map(|(shift, half, lines)| Window::Free { shift, half, lines })
}

pub fn any_window() -> impl Strategy<Value = Window> {
    let aligned = (3_usize..6, 5_usize..8).prop_map(|(parts, reach)| Window::Aligned { parts, reach });
    prop_oneof![free_window(), aligned]
}

pub fn flat() -> BoxedStrategy<Cutter> {
    (1.0..5.0, 1.5..6.0)
        .prop_map(|(radius, slender): (f64, f64)| {
            let length = radius * slender;
            let tool = Tool::flat(radius, length).expect("a flat end");
            let name = format!("Tool::flat({radius:?}, {length:?})");
            Cutter { name, tool, radius }
        })
        .boxed()
}

pub fn ball() -> BoxedStrategy<Cutter> {
    (1.0..5.0, 1.5..6.0)
        .prop_map(|(radius, slender): (f64, f64)| {
            let length = radius * slender;
            let tool = Tool::ball(radius, length).expect("a ball end");
            let name = format!("Tool::ball({radius:?}, {length:?})");
            Cutter { name, tool, radius }
        })
        .boxed()
}

pub fn bull() -> BoxedStrategy<Cutter> {
    (1.0..5.0, 1.5..6.0, 0.1..0.9)
        .prop_map(|(radius, slender, part): (f64, f64, f64)| {
            let (length, corner) = (radius * slender, radius * part);
            let tool = Tool::bull(radius, corner, length).expect("a bull nose");
            let name = format!("Tool::bull({radius:?}, {corner:?}, {length:?})");
            Cutter { name, tool, radius }
        })
        .boxed()
}

pub fn concave() -> BoxedStrategy<Cutter> {
    (0.3..1.0)
        .prop_map(|k: f64| {
            let name = format!("tools::scaled_concave({k:?})");
            Cutter {
                name,
                tool: tools::scaled_concave(k),
                radius: 8.0 * k,
            }
        })
        .boxed()
}

pub fn drill() -> BoxedStrategy<Cutter> {
    (1.0..5.0, 0.15..1.2, 2.0..5.0)
        .prop_map(|(radius, steep, slender): (f64, f64, f64)| {
            let (point, length) = (radius * steep, radius * slender);
            let name = format!("tools::drill({radius:?}, {point:?}, {length:?})");
            Cutter {
                name,
                tool: tools::drill(radius, point, length),
                radius,
            }
        })
        .boxed()
}

pub fn lollipop() -> BoxedStrategy<Cutter> {
    (1.0..5.0, 0.2..0.9, 2.5..6.0)
        .prop_map(|(radius, thin, slender): (f64, f64, f64)| {
            let (neck, length) = (radius * thin, radius * slender);
            let name = format!("tools::lollipop({radius:?}, {neck:?}, {length:?})");
            Cutter {
                name,
                tool: tools::lollipop(radius, neck, length),
                radius,
            }
        })
        .boxed()
}

pub fn any_tool() -> BoxedStrategy<Cutter> {
    prop_oneof![ball(), flat(), bull(), concave(), drill(), lollipop()].boxed()
}

pub fn tip() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-6.0..6.0)
}

/// A unit axis tilted from the vertical by an angle of this range, in degrees.
pub fn axis(tilt: std::ops::Range<f64>) -> impl Strategy<Value = [f64; 3]> {
    (tilt, 0.0..TAU).prop_map(|(tilt, round)| {
        let (s, c) = tilt.to_radians().sin_cos();
        [s * round.cos(), s * round.sin(), c]
    })
}

pub fn pose(tip: [f64; 3], axis: [f64; 3]) -> Pose {
    Pose::new(tip, axis).expect("a pose")
}

/// `axis` turned by `angle` about an axis perpendicular to it, chosen by `round`.
pub fn turned(axis: [f64; 3], angle: f64, round: f64) -> [f64; 3] {
    let axis = Vector3::from(axis);
    let helper = if axis.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
    let about = Unit::new_normalize(axis.cross(&helper));
    let about = Rotation3::from_axis_angle(&Unit::new_normalize(axis), round) * about;
    let turned = Rotation3::from_axis_angle(&about, angle) * axis;
    turned.into()
}
