//! Programs written as G-code of each control, and read again.

use sweepsim_motion::{Move, Pose, TipArc, TipCourse};
use sweepsim_nc::{
    Controller, Coolant, CutterKind, Event, EventKind, FeedMode, Machine, Program, ProgramPose, Spindle,
    StockDescription, apt, gcode, heidenhain, siemens, write,
};
use sweepsim_props::*;

use crate::round_trips::{Step, options, steps, text};

const ALL: [Controller; 6] = [
    Controller::LinuxCnc,
    Controller::Fanuc,
    Controller::Haas,
    Controller::Grbl,
    Controller::Siemens,
    Controller::Heidenhain,
];

fn dialect(controller: Controller) -> write::GcodeOptions {
    let mut options = write::GcodeOptions::default();
    options.dialect = controller;
    options
}

fn read(text: &str, controller: Controller) -> Program {
    let mut options = options();
    options.controller = Some(controller);
    let read = match controller {
        Controller::Siemens => siemens::read(text, &options),
        Controller::Heidenhain => heidenhain::read(text, &options),
        _ => gcode::read(text, &options),
    };
    read.unwrap_or_else(|error| panic!("{controller:?}: {error}\n{text}"))
}

fn near(a: [f64; 3], b: [f64; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9)
}

/// Compares moves and events, apart from their lines. Feeds are in millimetres.
fn same(a: &Program, b: &Program, text: &str) {
    assert_eq!(a.poses.len(), b.poses.len(), "{text}");
    for (x, y) in a.poses.iter().zip(&b.poses) {
        let place = format!("{x:?}\n{y:?}\n{text}");
        assert_eq!((x.joined, x.tool), (y.joined, y.tool), "{place}");
        assert!(
            near(x.pose.tip(), y.pose.tip()) && near(x.pose.axis(), y.pose.axis()),
            "{place}"
        );
        if !x.joined {
            continue;
        }
        assert_eq!(x.rapid, y.rapid, "{place}");
        let feed = |pose: &ProgramPose, program: &Program| match pose.feed_mode {
            FeedMode::InverseTime => pose.feed,
            _ => pose.feed.map(|feed| feed * program.units.in_mm()),
        };
        match (feed(x, a), feed(y, b)) {
            (Some(f), Some(g)) => assert!((f - g).abs() < 1e-9 && x.feed_mode == y.feed_mode, "{place}"),
            (f, g) => assert_eq!(f, g, "{place}"),
        }
        match (x.way().course, y.way().course) {
            (TipCourse::Straight, TipCourse::Straight) => {}
            (TipCourse::Arc(p), TipCourse::Arc(q)) => {
                let sense = p
                    .normal()
                    .iter()
                    .zip(q.normal())
                    .map(|(a, b)| a * b)
                    .sum::<f64>()
                    .signum();
                assert!((p.angle() - sense * q.angle()).abs() < 1e-9, "{place}");
                assert!(near(p.normal(), q.normal().map(|c| sense * c)), "{place}");
                // The height of a centre is arbitrary.
                let apart: [f64; 3] = std::array::from_fn(|k| p.centre()[k] - q.centre()[k]);
                let along: f64 = apart.iter().zip(p.normal()).map(|(a, n)| a * n).sum();
                assert!(near(apart, p.normal().map(|n| along * n)), "{place}");
            }
            other => panic!("{other:?}: {place}"),
        }
    }
    let events = |program: &Program| -> Vec<(usize, EventKind)> {
        program
            .events
            .iter()
            .map(|event| (event.pose, event.kind.clone()))
            .collect()
    };
    assert_eq!(events(a), events(b), "{text}");
}

fn round_trip(program: &Program, controller: Controller) -> String {
    let written = write::gcode(program, &dialect(controller)).unwrap();
    assert!(written.lost.is_empty(), "{:?}", written.lost);
    same(program, &read(&written.text, controller), &written.text);
    written.text
}

/// Whether a control has words for a step.
fn can_say(step: &Step, controller: Controller) -> bool {
    match step {
        Step::Tilted(..) => matches!(
            controller,
            Controller::Fanuc | Controller::Siemens | Controller::Heidenhain
        ),
        _ => true,
    }
}

proptest! {
    #[test]
    fn every_control_reads_its_words(steps in steps(), index in 0..ALL.len()) {
        let controller = ALL[index];
        let steps: Vec<Step> = steps.into_iter().filter(|step| can_say(step, controller)).collect();
        let program = apt::read(&text(&steps), &options()).unwrap();
        round_trip(&program, controller);
    }

    /// Arcs and helices in all planes, of several turns, from G-code in inches or millimetres.
    #[test]
    fn arcs_come_back(
        blocks in collection::vec((0..3_usize, 0.5..20.0_f64, -3.1..3.1_f64, 0.01..6.27_f64, -2.0..2.0_f64, 1..4_u32, any::<bool>()), 1..8),
        inch in any::<bool>(),
        index in 0..2_usize,
    ) {
        let mut text = String::from(if inch { "G20\n" } else { "G21\n" });
        text += "S900 M3\nG0 X0 Y0 Z0\nF250\n";
        let mut at = [0.0; 3];
        for (w, radius, from, by, rise, turns, ccw) in blocks {
            let (u, v) = ((w + 1) % 3, (w + 2) % 3);
            let centre = [-radius * from.cos(), -radius * from.sin()];
            let to = from + if ccw { by } else { -by };
            let mut end = at;
            end[u] += centre[0] + radius * to.cos();
            end[v] += centre[1] + radius * to.sin();
            end[w] += rise;
            let mut offset = [0.0; 3];
            (offset[u], offset[v]) = (centre[0], centre[1]);
            let words = ["J K", "I K", "I J"][w].split(' ').map(|letter| {
                let k = "IJK".find(letter).unwrap();
                format!(" {letter}{}", offset[k])
            });
            text += ["G19\n", "G18\n", "G17\n"][w];
            text += &format!("{} X{} Y{} Z{}", if ccw { "G3" } else { "G2" }, end[0], end[1], end[2]);
            text.extend(words);
            text += &if turns > 1 { format!(" P{turns}\n") } else { "\n".to_owned() };
            at = end;
        }
        let program = gcode::read(&text, &options()).unwrap();
        round_trip(&program, [Controller::LinuxCnc, Controller::Siemens][index]);
    }
}

/// All events, between moves.
fn eventful(through: bool) -> Program {
    let mut program = Program::default();
    let kinds = [
        EventKind::ToolChange(4),
        EventKind::Spindle(Spindle::Clockwise { rpm: Some(8000.0) }),
        EventKind::Coolant(Coolant::Flood),
        EventKind::Spindle(Spindle::Clockwise { rpm: Some(1234.5) }),
        EventKind::Coolant(Coolant::Mist),
        EventKind::Dwell { seconds: 2.5 },
        EventKind::OptionalStop,
        EventKind::Spindle(Spindle::CounterClockwise { rpm: Some(500.0) }),
        EventKind::Stop,
        EventKind::Coolant(Coolant::Off),
        EventKind::Spindle(Spindle::Stopped),
    ];
    let through = through.then_some([Coolant::Through, Coolant::ThroughOff].map(EventKind::Coolant));
    for (index, kind) in kinds.into_iter().chain(through.into_iter().flatten()).enumerate() {
        program.events.push(Event::new(index, 1, kind));
        let pose = Pose::new([index as f64, 0.0, 0.25], [0.0, 0.0, 1.0]).unwrap();
        let mut pose = ProgramPose::new(pose, 1);
        pose.joined = index > 0;
        pose.feed = Some(100.0 + index as f64);
        pose.tool = Some(4);
        program.poses.push(pose);
    }
    program
}

#[test]
fn events_come_back() {
    for controller in ALL {
        round_trip(&eventful(controller == Controller::Haas), controller);
    }
    let mut program = eventful(false);
    let text = "part 7 is done";
    program
        .events
        .push(Event::new(3, 1, EventKind::Message(text.to_owned())));
    program.events.sort_by_key(|event| event.pose);
    for controller in &ALL[..5] {
        round_trip(&program, *controller);
    }
    let written = write::gcode(&program, &dialect(Controller::Heidenhain)).unwrap();
    assert_eq!(written.lost, ["texts for the operator: they become comments"]);
}

/// Inverse time, feeds per revolution and inches.
#[test]
fn feeds_come_back() {
    let text = "G20\nT1 M6\nS500 M3\nG0 X0 Y0 Z1\nG1 X1 F10\nG93\nX2 F4\nX3 F4\nG95\nX4 F0.01\nG94\nX5 F10\n";
    let program = gcode::read(text, &options()).unwrap();
    for controller in [
        Controller::LinuxCnc,
        Controller::Fanuc,
        Controller::Haas,
        Controller::Siemens,
    ] {
        let text = round_trip(&program, controller);
        assert!(text.contains("F254"), "{text}");
    }
    let klartext = write::gcode(&program, &dialect(Controller::Heidenhain)).unwrap();
    assert_eq!(
        klartext.lost,
        [
            "feeds in inverse time: they become feeds per minute",
            "feeds per revolution"
        ]
    );
    // An inch with F4 takes a quarter of a minute.
    assert!(klartext.text.contains("L X+50.8 R0 F101.6\n"), "{}", klartext.text);
}

/// What each control is given, to the letter.
#[test]
fn words_of_the_controls() {
    let text = "(T2 D=6. CR=3. - ball end mill)\nG21\nT2 M6\nS8000 M3\nG0 X1 Y2 Z5\nM8\nG1 Z-1.5 F300\nG3 X1 Y2 Z-2 I4 J0\nG53 G0 Z0\nG0 X0 Y0 Z9\nG4 P1\n";
    let program = gcode::read(text, &options()).unwrap();
    let expected = [
        (
            Controller::LinuxCnc,
            "%\n(T2 D=6. CR=3. - ball end mill)\nG21 G17 G90 G94 G40 G49 G80\nT2 M6\nS8000 M3\nG0 X1 Y2\nG43 H2 Z5\nM8\nG1 Z-1.5 F300\n\
             G3 X1 Y2 Z-2 I4 J0\nG53 G0 Z0\nG0 X0 Y0\nZ9\nG4 P1\nM30\n%\n",
        ),
        (
            Controller::Fanuc,
            "%\nO0001\n(T2 D=6. CR=3. - ball end mill)\nG21 G17 G90 G94 G40 G49 G80\nT2 M6\nS8000 M3\nG0 X1. Y2.\nG43 H2 Z5.\nM8\n\
             G1 Z-1.5 F300.\nG3 X1. Y2. Z-2. I4. J0.\nG53 G0 Z0\nG0 X0. Y0.\nZ9.\nG4 X1.\nM30\n%\n",
        ),
        (
            Controller::Siemens,
            "; T2 D=6. CR=3. - ball end mill\nG17 G71 G90 G94 G40\nT2 M6\nD1\nS8000 M3\nG0 X1 Y2\nZ5\nM8\nG1 Z-1.5 F300\n\
             G3 X1 Y2 Z-2 I4 J0\nSUPA G0 Z0 D0\nD1\nG0 X0 Y0\nZ9\nG4 F1\nM30\n",
        ),
        (
            Controller::Heidenhain,
            "BEGIN PGM PROGRAM MM\n; T2 D=6. CR=3. - ball end mill\nTOOL CALL 2 Z\nTOOL CALL Z S8000\nL M3\nL X+1 Y+2 R0 FMAX\n\
             L Z+5 R0 FMAX\nL M8\nL Z-1.5 R0 F300\nCC X+5 Y+2\nCP IPA+360 Z-2 DR+\nL Z+0 R0 FMAX M91\nL X+0 Y+0 R0 FMAX\nL Z+9 R0 FMAX\n\
             CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 1\nL M30\nEND PGM PROGRAM MM\n",
        ),
    ];
    for (controller, expected) in expected {
        let written = write::gcode(&program, &dialect(controller)).unwrap();
        assert_eq!(written.text, expected);
        same(&program, &read(&written.text, controller), expected);
    }
}

#[test]
fn tools_and_stock_come_back() {
    let text = "(T1 D=6. CR=3. - ball end mill)\n(T2 D=10. CR=0. TAPER=118deg - drill)\n(T3 D=12. CR=0. TAPER=45deg - chamfer mill)\n\
                (T4 D=8. CR=1.5 - bullnose end mill)\n(T5 D=4. CR=0. - flat end mill)\n(stockMin:-1mm, -2mm, -3mm)\n(stockMax:1mm, 2mm, 3mm)\nG21\nG0 X0 Y0 Z0\n";
    let program = gcode::read(text, &options()).unwrap();
    assert_eq!(program.tools.len(), 5);
    for controller in [Controller::LinuxCnc, Controller::Fanuc] {
        let again = read(&write::gcode(&program, &dialect(controller)).unwrap().text, controller);
        assert_eq!(again.stock, program.stock);
        for (number, tool) in &program.tools {
            let found = &again.tools[number];
            assert_eq!(found.kind, tool.kind);
            assert_eq!(
                (
                    found.diameter,
                    found.corner_radius,
                    found.point_angle,
                    found.taper_angle
                ),
                (tool.diameter, tool.corner_radius, tool.point_angle, tool.taper_angle)
            );
        }
    }
    assert_eq!(program.tools[&1].kind, Some(CutterKind::Ball));
    let block = Some(StockDescription::Block {
        min: [-1.0, -2.0, -3.0],
        max: [1.0, 2.0, 3.0],
    });
    assert_eq!(program.stock, block);
}

#[test]
fn what_a_control_cannot_say() {
    let cl = "UNITS/MM\nFEDRAT/100,MMPM\nGOTO/0,0,0,0,0,1\nGOTO/9,0,0,0.6,0,0.8\n";
    let program = apt::read(cl, &options()).unwrap();
    for (controller, name) in [
        (Controller::LinuxCnc, "linuxcnc"),
        (Controller::Haas, "haas"),
        (Controller::Grbl, "grbl"),
    ] {
        let error = write::gcode(&program, &dialect(controller)).unwrap_err().to_string();
        assert_eq!(
            error,
            format!(
                "line 4: the tool is tilted, and {name} has no tool vectors: expected a machine, or the control fanuc, siemens or heidenhain"
            )
        );
    }
    let machine = Machine::named("trunnion-ac").unwrap();
    let mut posted = write::GcodeOptions::for_machine(machine, true);
    posted.dialect = Controller::Grbl;
    let error = write::gcode(&program, &posted).unwrap_err().to_string();
    assert_eq!(
        error,
        "grbl has no tip control: expected the coordinates of the machine's axes"
    );
    posted.machine = Some(Machine::default());
    assert_eq!(write::gcode(&program, &posted).unwrap_err(), write::GcodeError::NoAxes);

    // An arc in no plane of the axes: chords.
    let mut tilted = Program::default();
    let half = 0.5_f64.sqrt();
    let arc = TipArc::new([0.0; 3], [half, 0.0, half], 1.5).unwrap();
    let across = |angle: f64| [-5.0 * half * angle.sin(), 5.0 * angle.cos(), 5.0 * half * angle.sin()];
    for (tip, joined) in [(across(0.0), false), (across(1.5), true)] {
        let mut pose = ProgramPose::new(Pose::new(tip, [0.0, 0.0, 1.0]).unwrap(), 1);
        pose.joined = joined;
        if joined {
            pose.set_way(Move::arc(arc));
            (pose.feed, pose.feed_mode) = (Some(2.0), FeedMode::InverseTime);
        }
        tilted.poses.push(pose);
    }
    let written = write::gcode(&tilted, &dialect(Controller::LinuxCnc)).unwrap();
    assert_eq!(
        written.lost,
        ["arcs across no axis of the plane, or along which the tool turns: chords within 0.001 mm"]
    );
    let again = read(&written.text, Controller::LinuxCnc);
    let minutes: f64 = again.poses[1..].iter().map(|pose| 1.0 / pose.feed.unwrap()).sum();
    assert!((minutes - 0.5).abs() < 1e-9);
    let tips: Vec<[f64; 3]> = again.poses.iter().map(|pose| pose.pose.tip()).collect();
    assert!(near(*tips.last().unwrap(), across(1.5)));
    for pair in tips.windows(2) {
        for s in [0.0, 0.25, 0.5, 0.75] {
            let [x, y, z]: [f64; 3] = std::array::from_fn(|k| pair[0][k] + s * (pair[1][k] - pair[0][k]));
            assert!((x.hypot(y).hypot(z) - 5.0).abs() < 1.001e-3 && (x + z).abs() < 1e-9);
        }
    }
}

/// Numbers are rounded as asked, and arcs whose ends become the same number are no full turns.
#[test]
fn rounded_numbers() {
    let text = "G21\nG0 X10 Y0 Z0\nG3 X9.9999999 Y0.0000123 I-10 J0 F100\nG3 X9.9999999 Y0.0000123 I-9.9999999 J-0.0000123\nG1 X0.123456789 F50\n";
    let program = gcode::read(text, &options()).unwrap();
    for controller in ALL {
        let mut rounded = dialect(controller);
        rounded.decimals = 3;
        let text = write::gcode(&program, &rounded).unwrap().text;
        assert!(!text.contains("456"), "{text}");
        let again = read(&text, controller);
        let arcs: Vec<f64> = again
            .poses
            .iter()
            .filter_map(|pose| match pose.way().course {
                TipCourse::Arc(arc) => Some(arc.angle()),
                _ => None,
            })
            .collect();
        assert_eq!(arcs.len(), 1, "{text}");
        assert!((arcs[0] - std::f64::consts::TAU).abs() < 1e-9);
    }
}

#[test]
fn more_decimals_than_a_number_has_are_all_of_them() {
    let program = read("G21 G90\nG0 X0.1 Y0 Z5\nG1 X-2.5 F200\n", Controller::LinuxCnc);
    for controller in ALL {
        let mut options = dialect(controller);
        options.decimals = 1_074;
        let all = write::gcode(&program, &options).unwrap();
        options.decimals = usize::MAX;
        assert_eq!(write::gcode(&program, &options).unwrap(), all);
        assert_eq!(
            read(&all.text, controller).poses.iter().next().unwrap().pose.tip(),
            [0.1, 0.0, 5.0]
        );
    }
}
