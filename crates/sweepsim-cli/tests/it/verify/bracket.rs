//! What is proven of the shipped bracket, and of the faulty one.

use crate::support::{Workdir, text};
use std::fs;
use sweepsim_formats::{Measure, Report, StatementState};

/// As the README says: arcs in round walls of triangles, and five faults.
#[test]
fn the_bracket_is_proven_and_the_faulty_one_refuted() {
    let fixtures = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/verify");
    let folder = Workdir::new("");
    for (job, code, state) in [
        ("bracket", 0, StatementState::Proven),
        ("bracket-faulty", 1, StatementState::Refuted),
    ] {
        let file = fixtures.join(job).with_extension("ron");
        let output = folder.run(&["verify", file.to_str().unwrap(), "--only", "report", "--out", job]);
        assert_eq!(output.status.code(), Some(code), "{}", text(&output.stdout));
        let report = fs::read(folder.path(&format!("{job}/report.json"))).unwrap();
        let report: Report = serde_json::from_slice(&report).unwrap();
        let [statement, excess, holder, fixture, rapid, collision] = report.statements.as_deref().unwrap() else {
            panic!("{:?}", report.statements)
        };
        assert_eq!((statement.state, statement.open_count), (state, 0));
        assert_eq!(excess.about, "excess");
        assert_eq!(excess.state, state, "{excess:?}");
        // Its holder goes into the step, the clamp and the stock; and a rapid goes through that.
        for (body, about) in [
            (holder, "holder"),
            (fixture, "fixture"),
            (rapid, "rapid"),
            (collision, "collision"),
        ] {
            assert_eq!((body.about.as_str(), body.state), (about, state), "{body:?}");
        }
        // Chords of the round walls are cut by less than the limit.
        let [least, most] = statement.enclosure;
        assert!(0.0 < least && least <= most, "{least} {most}");
    }
}

/// The holder of the ball end passes 2 mm above the clamp, and 4 mm above the part.
#[test]
fn clearances_are_proven_or_refuted() {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/verify/bracket.ron");
    let folder = Workdir::new("");
    for (clearance, code, state) in [("1", 0, StatementState::Proven), ("3", 1, StatementState::Refuted)] {
        let mut args = vec![
            "verify",
            file.to_str().unwrap(),
            "--only",
            "report",
            "--directions",
            "z",
        ];
        args.extend(["--clearance", clearance, "--out", clearance]);
        let output = folder.run(&args);
        assert_eq!(output.status.code(), Some(code), "{}", text(&output.stdout));
        let report = fs::read(folder.path(&format!("{clearance}/report.json"))).unwrap();
        let report: Report = serde_json::from_slice(&report).unwrap();
        let statements = report.statements.as_deref().unwrap().iter();
        let kept: Vec<_> = statements
            .filter(|statement| statement.measure == Measure::Distance)
            .collect();
        let [holder, fixture, collision] = kept[..] else {
            panic!("{kept:?}")
        };
        assert_eq!(
            (&collision.about[..], collision.limit),
            ("collision", clearance.parse().unwrap())
        );
        println!("{collision:?}");
        assert_eq!((holder.about.as_str(), fixture.about.as_str()), ("holder", "fixture"));
        for (statement, truth) in [(holder, 4.0), (fixture, 2.0)] {
            let [least, most] = statement.enclosure;
            assert!(least <= truth && truth <= most + 1e-6, "{truth}: {statement:?}");
        }
        assert_eq!((holder.state, fixture.state), (StatementState::Proven, state));
        let witness = fixture.witness.as_ref().unwrap();
        assert!(witness.text.as_deref().unwrap().starts_with("Y"), "{witness:?}");
        let near = report.findings.iter().flatten().all(|finding| finding.near);
        assert!(near, "{:?}", report.findings);
    }
}
