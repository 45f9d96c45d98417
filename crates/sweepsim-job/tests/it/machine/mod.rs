//! Bodies of machines, in jobs.

mod crashes;
mod judge;
mod offsets;
mod places;
mod stock;

use std::fmt::Write;
use sweepsim_job::dexel::{Stock, TriangleSoup};
use sweepsim_job::motion::Tool;
use sweepsim_job::{
    DialectOptions, JobError, Judging, Memory, Outcome, Output, ProgramOptions, Request, StatementState,
};
use sweepsim_nc::Machine;

const SIZES: &str = ",table=300,travel=600x500x500,zero=50,length=100";
fn run(machine: &str, program: &str, stock: [[f64; 3]; 2]) -> Outcome {
    judged(machine, program, stock, Judging::default())
}

fn planned(machine: &str, program: &str, stock: [[f64; 3]; 2]) -> Result<(), JobError> {
    request(machine, program, stock, Judging::default()).plan().map(|_| ())
}

fn judged(machine: &str, program: &str, stock: [[f64; 3]; 2], judging: Judging) -> Outcome {
    request(machine, program, stock, judging)
        .plan()
        .unwrap()
        .run(&())
        .unwrap()
}

fn request(machine: &str, program: &str, stock: [[f64; 3]; 2], judging: Judging) -> Request {
    let mut dialect = DialectOptions::default();
    dialect.machine = Some(machine.to_owned());
    let mut options = ProgramOptions::default();
    options.dialect = dialect;
    Request::from_program("crash.nc", program)
        .program(options)
        .tool(1, Tool::flat(5.0, 60.0).unwrap())
        .stock(Stock::Block {
            min: stock[0],
            max: stock[1],
        })
        .cells([8, 8])
        .judging(judging)
}

/// The page has the machine with what its axes do, and when its bodies meet.
#[test]
fn the_page_shows_the_machine() {
    let stock = [[-40.0, -30.0, -50.0], [40.0, 30.0, 0.0]];
    let program = "G21 G90\nT1 M6\nS1000 M3\nG1 X0 Y0 Z300 F5000\nG1 X100 Z200 A90\nG1 Z-120\nG1 Z200\nM30\n";
    let outcome = run(&format!("trunnion-ac{SIZES}"), program, stock);
    let mut memory = Memory::default();
    outcome.write_to(&mut memory, &[Output::Report], &()).unwrap();
    let page = String::from_utf8_lossy(memory.0.get("report.html").expect("a page")).into_owned();
    // A plot of each axis, with both limits of all but C.
    let counted = |what: &str| page.matches(what).count();
    assert_eq!((counted("class=\"way\""), counted("class=\"reach\"")), (5, 8));
    let head = page
        .split("id=\"head\">")
        .nth(1)
        .and_then(|rest| rest.split("</script>").next())
        .expect("a head");
    let head: serde_json::Value = serde_json::from_str(head).unwrap();
    let machine = &head["machine"];
    assert_eq!(machine["joints"].as_array().unwrap().len(), 5);
    assert_eq!(
        (&machine["base"], &machine["joints"][0]["axis"]),
        (&2.into(), &serde_json::json!([0.0, 0.0, 1.0]))
    );
    // The spindle goes down beside the part, through the table that stands upright.
    let findings: Vec<_> = outcome
        .findings()
        .iter()
        .filter(|finding| finding.kind == "machine")
        .collect();
    assert!(
        !findings.is_empty() && findings.iter().all(|finding| finding.line == Some(6)),
        "{findings:?}"
    );
    assert_eq!(machine["contacts"].as_array().unwrap().len(), findings.len());
    let bodies = head["meshes"]["solids"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|solid| solid["kind"] == "body");
    assert_eq!(bodies.count(), 7);
}

/// A cutter that comes to 5 mm above the table, and an axis that comes to 50 mm of its limit.
#[test]
fn a_verdict_holds_for_other_places_and_lengths() {
    let stock = [[-40.0, -30.0, -50.0], [40.0, 30.0, 0.0]];
    let program = "G21 G90\nT1 M6\nS1000 M3\nG1 X0 Y0 Z200 F5000\nG1 X120\nG1 Z-45\nG1 Z200\nG1 X250\nM30\n";
    let state = |offset_range: [f64; 3], length_range: f64| {
        let mut judging = Judging::default();
        (judging.offset_range, judging.length_range) = (offset_range, length_range);
        let outcome = judged(&format!("3-axis{SIZES}"), program, stock, judging);
        let statements = outcome.report().statements.as_ref().expect("proofs");
        let own = statements
            .iter()
            .find(|statement| statement.about == "machine")
            .expect("bodies");
        (own.state, own.reason.clone().unwrap_or_default())
    };
    assert_eq!(state([0.0; 3], 0.0).0, StatementState::Proven);
    assert_eq!(state([0.0, 0.0, 4.9], 0.0).0, StatementState::Proven);
    assert_eq!(state([0.0, 0.0, 2.0], 1.4).0, StatementState::Proven);
    for (offset, length, why) in [
        ([0.0, 0.0, 5.1], 0.0, "not known of table and cutter of tool 1"),
        ([0.0; 3], 5.1, "not known of table and cutter of tool 1"),
        (
            [50.5, 0.0, 0.0],
            0.0,
            "X has 50 mm to its limit at crash.nc:8, and may need 50.5 mm",
        ),
    ] {
        let (state, reason) = state(offset, length);
        assert!(
            state == StatementState::Open && reason.contains(why),
            "{offset:?} {length}: {reason}"
        );
    }
}

/// Ready machines of other sizes move about their home without a collision.
#[test]
fn ready_machines_are_free_at_home() {
    for name in Machine::names() {
        let machine = Machine::named(name)
            .and_then(|machine| machine.kinematics)
            .expect("axes");
        let turns: String = machine.rotary().map(|axis| format!(" {}30", axis.letter)).collect();
        let program = format!("G21 G90\nT1 M6\nS1000 M3\nG1 X0 Y0 Z300 F5000\nG1 X20{turns}\nM30\n");
        for sizes in [SIZES, ",table=500,travel=800x700x600,zero=120,length=180"] {
            let outcome = run(
                &format!("{name}{sizes}"),
                &program,
                [[-40.0, -30.0, -50.0], [40.0, 30.0, 0.0]],
            );
            let statements = outcome.report().statements.as_ref().expect("proofs");
            let own = statements
                .iter()
                .find(|statement| statement.about == "machine")
                .expect("bodies");
            assert_eq!(
                own.state,
                StatementState::Proven,
                "{name}{sizes}: {:?}",
                outcome.findings()
            );
        }
    }
}

/// A guard from a file is passed or met by the spindle; one that is open, or missing, is an error that names it.
#[test]
fn bodies_from_files_are_closed() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    let stl = |triangles: &[[[f64; 3]; 3]]| {
        let mut text = "solid guard\n".to_owned();
        for triangle in triangles {
            text += "facet normal 0 0 0\nouter loop\n";
            for [x, y, z] in triangle {
                writeln!(text, "vertex {x} {y} {z}").unwrap();
            }
            text += "endloop\nendfacet\n";
        }
        text + "endsolid guard\n"
    };
    let guard = TriangleSoup::block([100.0, -50.0, -50.0], [150.0, 50.0, 40.0]).triangles;
    std::fs::write(file("guard.stl"), stl(&guard)).unwrap();
    std::fs::write(file("open.stl"), stl(&guard[1..])).unwrap();
    let request = |guard: &str| {
        let spindle = r#"(name: "spindle", on: "Z", shape: Cylinder(from: (0, 0, 0), to: (0, 0, 100), radius: 40))"#;
        let body = format!(r#"(name: "guard", on: "base", shape: File("{guard}"))"#);
        let table = "(name: \"table\", on: \"X\", shape: Block(min: (-1, -1, -9), max: (1, 1, -8)))";
        let linear = "(letter: 'X', carries: Part), (letter: 'Y'), (letter: 'Z', home: 200)";
        let machine = format!(
            "Machine(name: \"mill\", tool_length: 20, linear: [{linear}], bodies: [{body}, {spindle}, {table}], may_touch: [(\"guard\", \"table\")])"
        );
        std::fs::write(file("mill.ron"), machine).unwrap();
        let mut options = ProgramOptions::default();
        options.dialect.machine = Some(file("mill.ron").display().to_string());
        Request::from_program(
            "guard.nc",
            "G21 G90\nT1 M6\nS900 M3\nG1 X0 Y0 Z90 F900\nG1 Y30\nG1 Z15\nM30\n",
        )
        .program(options)
        .tool(1, Tool::flat(5.0, 15.0).unwrap())
        .stock(Stock::Block {
            min: [-20.0; 3],
            max: [20.0, 20.0, 0.0],
        })
        .cells([8, 8])
    };
    let error = |guard: &str| match request(guard).plan() {
        Ok(_) => panic!("{guard} is taken"),
        Err(error) => error.to_string(),
    };
    assert!(
        error("open.stl").contains("what its surface encloses"),
        "{}",
        error("open.stl")
    );
    assert!(error("open.stl").contains("open.stl") && error("none.stl").contains("none.stl"));
    let state = |guard: &str| {
        let outcome = request(guard).plan().unwrap().run(&()).unwrap();
        let statements = outcome.report().statements.as_ref().expect("proofs");
        let own = statements
            .iter()
            .find(|statement| statement.about == "machine")
            .expect("bodies");
        let found = outcome.findings().iter().filter(|finding| finding.kind == "machine");
        (
            own.state,
            found
                .map(|finding| (finding.line, finding.bodies.clone()))
                .collect::<Vec<_>>(),
        )
    };
    assert_eq!(state("guard.stl"), (StatementState::Proven, Vec::new()));
    // The nose goes down to 35, beside a guard that is 40 high.
    let near = TriangleSoup::block([30.0, -50.0, -50.0], [150.0, 50.0, 40.0]).triangles;
    std::fs::write(file("near.stl"), stl(&near)).unwrap();
    let bodies = ["guard", "spindle"].map(str::to_owned).to_vec();
    assert_eq!(state("near.stl"), (StatementState::Refuted, vec![(Some(6), bodies)]));
}
