//! Programs written and read again.

use sweepsim_motion::TipCourse;
use sweepsim_nc::{Program, ReadOptions, apt, gcode, table, write};
use sweepsim_props::*;

pub(crate) fn options() -> ReadOptions {
    let mut options = ReadOptions::default();
    options.exact_arcs = true;
    options
}

fn clsf(program: &Program) -> Program {
    let mut text = Vec::new();
    write::clsf(program, &mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    apt::read(&text, &options()).unwrap_or_else(|error| panic!("{text}\n{error}"))
}

/// Compares the moves of two programs, apart from their lines.
fn same(a: &Program, b: &Program) {
    assert_eq!(a.poses.len(), b.poses.len());
    for (x, y) in a.poses.iter().zip(&b.poses) {
        assert_eq!(
            (x.rapid, x.joined, x.tool, x.feed),
            (y.rapid, y.joined, y.tool, y.feed),
            "{x:?} {y:?}"
        );
        assert_eq!(x.feed_mode, y.feed_mode);
        assert_eq!(x.pose.tip(), y.pose.tip());
        let axes = (x.pose.axis(), y.pose.axis());
        assert!(axes.0.iter().zip(axes.1).all(|(a, b)| (a - b).abs() < 1e-15));
        match (x.way().course, y.way().course) {
            (TipCourse::Straight, TipCourse::Straight) => {}
            (TipCourse::Arc(a), TipCourse::Arc(b)) => {
                let sense = a.angle().signum() * b.angle().signum();
                assert!(
                    (a.angle() - sense * b.angle()).abs() < 1e-9 * a.angle().abs().max(1.0),
                    "{a:?} {b:?}"
                );
                let pairs = a.normal().into_iter().zip(b.normal());
                assert!(pairs.into_iter().all(|(a, b)| (a - sense * b).abs() < 1e-12));
            }
            other => panic!("{other:?}"),
        }
    }
}

#[derive(Clone, Debug)]
pub(crate) enum Step {
    Line([f64; 3], bool),
    Tilted([f64; 3], [f64; 2]),
    Arc(f64, f64, f64),
    Tool(u8),
    Feed(f64),
    Home,
    Drill(f64),
}

pub(crate) fn steps() -> impl Strategy<Value = Vec<Step>> {
    let place = prop::array::uniform3(-100.0..100.0_f64);
    collection::vec(
        prop_oneof![
            (place.clone(), any::<bool>()).prop_map(|(place, rapid)| Step::Line(place, rapid)),
            (place, prop::array::uniform2(-0.5..0.5_f64)).prop_map(|(place, tilt)| Step::Tilted(place, tilt)),
            (0.5..50.0_f64, 0.001..6.2_f64, -3.0..3.0_f64).prop_map(|(r, turn, rise)| Step::Arc(r, turn, rise)),
            any::<u8>().prop_map(Step::Tool),
            (1.0..5000.0_f64).prop_map(Step::Feed),
            Just(Step::Home),
            (0.5..20.0_f64).prop_map(Step::Drill),
        ],
        1..25,
    )
}

/// A CL file of these steps.
pub(crate) fn text(steps: &[Step]) -> String {
    let mut text = String::from("UNITS/MM\nFEDRAT/100,MMPM\nGOTO/0,0,0,0,0,1\n");
    let mut at = Some([0.0; 3]);
    let mut tool = None;
    for step in steps {
        match step {
            Step::Line([x, y, z], rapid) => {
                text += if *rapid { "RAPID\n" } else { "" };
                text += &format!("GOTO/{x},{y},{z},0,0,1\n");
                at = Some([*x, *y, *z]);
            }
            Step::Tilted([x, y, z], [i, j]) => {
                let k = (1.0 - i * i - j * j).sqrt();
                text += &format!("GOTO/{x},{y},{z},{i},{j},{k}\n");
                at = Some([*x, *y, *z]);
            }
            Step::Arc(r, turn, rise) => {
                let Some([x, y, z]) = at else { continue };
                let (ex, ey) = (x + r * (turn.cos() - 1.0), y + r * turn.sin());
                text += &format!(
                    "MOVARC/{},{y},{z},0,0,1,{r},ANGLE,{}\nGOTO/{ex},{ey},{}\n",
                    x - r,
                    turn.to_degrees(),
                    z + rise
                );
                at = Some([ex, ey, z + rise]);
            }
            Step::Tool(number) => {
                let number = 1 + number % 3;
                if tool != Some(number) {
                    text += &format!("CUTTER/{},0,{number},0,0,0,30\nLOAD/TOOL,{number}\n", 2 * number);
                }
                tool = Some(number);
            }
            Step::Feed(feed) => text += &format!("FEDRAT/{feed},MMPM\n"),
            Step::Home => {
                text += "GOHOME\n";
                at = None;
            }
            Step::Drill(depth) => {
                let Some([x, y, z]) = at else { continue };
                text += &format!("CYCLE/DRILL,DEPTH,{depth},MMPM,50,CLEAR,2\nGOTO/{x},{y},{z}\nCYCLE/OFF\n");
                at = None;
            }
        }
    }
    text
}

proptest! {
    #[test]
    fn clsf_is_read_back(steps in steps()) {
        let text = text(&steps);
        let program = apt::read(&text, &options()).unwrap_or_else(|error| panic!("{text}\n{error}"));
        let again = clsf(&program);
        same(&program, &again);
        let used: std::collections::BTreeSet<u32> = program.poses.iter().filter_map(|pose| pose.tool).collect();
        prop_assert!(again.tools.keys().eq(used.iter()));
        same(&again, &clsf(&again));
    }

    /// Tables hold straight moves only.
    #[test]
    fn tables_hold_the_same_poses(steps in steps()) {
        let mut options = ReadOptions::default();
        options.arc_tolerance = 0.1;
        let program = apt::read(&text(&steps), &options).unwrap();
        let mut csv = Vec::new();
        table::write(&program.poses, &mut csv).unwrap();
        let again = table::read(std::str::from_utf8(&csv).unwrap(), 1.0).unwrap();
        let tips = |program: &Program| program.poses.iter().map(|pose| pose.pose.tip()).collect::<Vec<_>>();
        prop_assert_eq!(tips(&program), tips(&again));
        let joined = |program: &Program| program.poses.iter().map(|pose| (pose.joined, pose.rapid)).collect::<Vec<_>>();
        prop_assert_eq!(joined(&program), joined(&again));
    }
}

#[test]
fn gcode_as_clsf() {
    let text = "G21 G90\n(T1 D=6. CR=3. - ball end mill)\nT1 M6\nS8000 M3\nG0 X0 Y0 Z5\nG1 Z-2 F300\nG2 X10 Y10 I10 J0\nG3 X10 Y10 I5\n\
                T2 M6\nM8\nG0 X0 Y0 Z5\nG1 Z0\nM30\n";
    let program = gcode::read(text, &options()).unwrap();
    assert_eq!(program.tools[&1].diameter, Some(6.0));
    same(&program, &clsf(&program));
}

#[test]
fn seven_parameters() {
    use sweepsim_nc::{CutterKind, ToolDescription};
    let tool = |kind, corner, angle| {
        let mut tool = ToolDescription::new(kind);
        (tool.diameter, tool.flute_length) = (Some(10.0), Some(30.0));
        (tool.corner_radius, tool.point_angle, tool.taper_angle) = (corner, angle, angle);
        tool
    };
    for tool in [
        tool(CutterKind::Flat, None, None),
        tool(CutterKind::Ball, None, None),
        tool(CutterKind::Bull, Some(1.0), None),
        tool(CutterKind::Drill, None, Some(118.0)),
    ] {
        let [d, r, e, f, a, b, h] = tool.seven_parameters().unwrap();
        let (seven, warnings) = sweepsim_motion::Tool::apt(&sweepsim_motion::Apt { d, r, e, f, a, b, h }).unwrap();
        assert!(warnings.is_empty());
        let own = tool.build().unwrap().cutter;
        // The same outline.
        let points = |tool: &sweepsim_motion::Tool| {
            let patches = tool.patches().iter();
            patches
                .flat_map(|patch| (0..=8).map(|k| patch.point(0.0, f64::from(k) / 8.0)))
                .collect::<Vec<_>>()
        };
        for (a, b) in points(&own).iter().zip(points(&seven)) {
            assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9), "{a:?} {b:?}");
        }
    }
    assert_eq!(tool(CutterKind::Tapered, None, Some(5.0)).seven_parameters(), None);
}
