//! A small certificate of all statements, and whatever may be done to it.

use crate::walls::{PROGRAM, slotted};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use sweepsim_check::{Certificate, digest_of};
use sweepsim_dexel::TriangleSoup;
use sweepsim_job::{Measure, Output, Request, check};
use tempfile::TempDir;

const JOB: &str = r#"Job(
    grid: Grid(min: (0, 0), max: (60, 40), cells: (30, 20)),
    stock: Block(min: (0, 0, -10), max: (60, 40, 0)),
    tools: {1: Flat(radius: 5, length: 30)},
    bodies: {1: [Holder(Profile(start: (0, 30), segments: [Line((12, 30)), Line((12, 50)), Line((0, 50))]))]},
    fixtures: [Block(min: (-20, 30, -10), max: (-5, 40, 5))],
    paths: [Path(tool: 1, file: "slot.nc")],
    clearance: 1.0,
    target: Mesh("target.stl"),
    limits: Limits(gouge: 0.02, excess: 0.02),
)"#;

/// A folder with a job.
fn with_job(job: &str) -> (TempDir, PathBuf) {
    with_target(job, &slotted([15.0, 25.0], -4.0))
}

/// The same, with another target.
fn with_target(job: &str, target: &TriangleSoup) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let corner = |p: &[f64; 3]| format!("vertex {} {} {}\n", p[0], p[1], p[2]);
    let facet = |corners: &[[f64; 3]; 3]| {
        let corners: String = corners.iter().map(corner).collect();
        format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
    };
    let facets: String = target.triangles.iter().map(facet).collect();
    fs::write(
        folder.path().join("target.stl"),
        format!("solid t\n{facets}endsolid t\n"),
    )
    .expect("written");
    fs::write(folder.path().join("slot.nc"), PROGRAM).expect("written");
    let file = folder.path().join("job.ron");
    fs::write(&file, job).expect("written");
    (folder, file)
}

/// The same, with the certificate of the job there.
fn certified() -> (TempDir, PathBuf, Vec<u8>) {
    let (folder, job) = with_job(JOB);
    let (file, text) = certificate(&folder, &job);
    (folder, file, text)
}

/// The certificate of a job, in its folder.
fn certificate(folder: &TempDir, job: &Path) -> (PathBuf, Vec<u8>) {
    let outcome = Request::from_file(job)
        .plan()
        .expect("a plan")
        .run(&())
        .expect("a result");
    let text = outcome.certificate().expect("a notation").expect("something is proven");
    let file = folder.path().join("certificate.json");
    fs::write(&file, &text).expect("written");
    (file, text.into_bytes())
}

/// Nothing is proven of how high something stands above a target that is no solid, whatever is claimed of it; the rest
/// is.
#[test]
fn a_certificate_of_a_target_that_crosses_itself_can_be_checked() {
    let mut target = slotted([15.0, 25.0], -4.0);
    let peg = TriangleSoup::block([30.2, 30.2, -5.0], [30.3, 30.3, 1.0]);
    target.triangles.extend(peg.triangles);
    let (folder, job) = with_target(JOB, &target);
    let (file, text) = certificate(&folder, &job);
    let honest = check(&file, 1).expect("it belongs to its files");
    let [fixture, excess] = ["fixture", "excess"].map(|about| {
        let number = honest.statements.iter().position(|statement| statement.about == about);
        number.expect("a statement")
    });
    assert!(honest.statements[fixture].holds() && !honest.holds());
    assert!(honest.statements[excess].claimed.is_none());
    // The claim of a target without the peg.
    let mut forged = Certificate::read(&text).expect("a certificate");
    let (_folder, _, other) = certified();
    let other = Certificate::read(&other).expect("a certificate");
    forged.claims[excess].clone_from(&other.claims[excess]);
    fs::write(&file, forged.written().expect("a notation")).expect("written");
    let checked = check(&file, 1).expect("it belongs to its files");
    let wrong = checked.statements[excess].checked.wrong.as_deref();
    assert!(checked.statements[excess].claimed.is_some() && !checked.statements[excess].holds());
    assert!(
        wrong.is_some_and(|why| why.starts_with("the target intersects itself")),
        "{wrong:?}"
    );
}

#[test]
fn every_changed_byte_of_all_statements_is_refused() {
    let (folder, file, text) = certified();
    let found = check(&file, 1).expect("a certificate");
    let all: Vec<_> = found
        .statements
        .iter()
        .map(|own| (own.about.as_str(), own.measure, own.limit < 0.0))
        .collect();
    let expected = [
        ("gouge", Measure::Depth, false),
        ("excess", Measure::Height, false),
        ("holder", Measure::Depth, true),
        ("fixture", Measure::Depth, false),
        ("fixture", Measure::Depth, true),
        ("rapid", Measure::MaterialInRapids, false),
        ("collision", Measure::Material, true),
    ];
    assert_eq!(all, expected);
    assert!(found.holds(), "{found:?}");
    assert!(text.len() < 40_000, "{}", text.len());

    for number in 0..text.len() {
        let mut changed = text.clone();
        changed[number] ^= 1 + (number % 255) as u8;
        assert!(Certificate::read(&changed).is_err(), "byte {number}");
    }
    // With a digest that fits, what is accepted is still true: the holder stays 26 mm above the target, and 5 mm
    // and more beside the clamp.
    let end = text.len() - ",\"digest\":\"\"}\n".len() - 64;
    let changed_file = folder.path().join("changed.json");
    let (mut refused, mut accepted) = (0, 0);
    for number in (0..end).step_by(29) {
        let mut changed = text[..end].to_vec();
        changed[number] ^= 1 + (number % 7) as u8;
        let digest = digest_of(&changed);
        changed.extend(format!(",\"digest\":\"{digest}\"}}\n").into_bytes());
        fs::write(&changed_file, &changed).expect("written");
        match check(&changed_file, 1) {
            Ok(found) if found.holds() => {
                accepted += 1;
                for own in &found.statements {
                    let (bound, _) = own.claimed.expect("a claim");
                    let truth = match (own.about.as_str(), own.limit < 0.0) {
                        ("holder" | "collision", _) => -26.0,
                        (_, true) => -21.0,
                        _ => 0.0,
                    };
                    assert!(bound >= truth, "byte {number}: {own:?}");
                }
            }
            _ => refused += 1,
        }
    }
    assert!(refused > 10 * accepted && refused > 100, "{refused} {accepted}");
}

/// Without a target, what is proven of the stock can be checked.
#[test]
fn the_stock_is_enough() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("slot.nc"), PROGRAM).expect("written");
    let said = |job: &str| {
        let file = folder.path().join("job.ron");
        fs::write(&file, job).expect("written");
        let outcome = Request::from_file(&file)
            .plan()
            .expect("a plan")
            .run(&())
            .expect("a result");
        let text = outcome.certificate().expect("a notation")?;
        let file = folder.path().join("certificate.json");
        fs::write(&file, &text).expect("written");
        let found = check(&file, 1).expect("a certificate");
        Some(
            found
                .statements
                .iter()
                .map(|own| (own.about.clone(), own.holds()))
                .collect::<Vec<_>>(),
        )
    };
    let all = |holds: bool| Some(vec![("rapid".to_owned(), true), ("collision".to_owned(), holds)]);
    let job = r#"Job(
        grid: Grid(min: (0, 0), max: (60, 40), cells: (30, 20)),
        stock: Block(min: (0, 0, -10), max: (60, 40, 0)),
        tools: {1: Flat(radius: 5, length: 4)},
        bodies: {1: [Shank(Profile(start: (0, 4), segments: [Line((5, 4)), Line((5, 50)), Line((0, 50))]))]},
        paths: [Path(tool: 1, file: "slot.nc")],
    )"#;
    // The shank ends where the stock does; a millimetre longer, it is in what the flutes have not cut.
    assert_eq!(said(job), all(true));
    let deep = { job.replace("length: 4)", "length: 3)") }
        .replace("(0, 4)", "(0, 3)")
        .replace("(5, 4)", "(5, 3)");
    assert_eq!(said(&deep), all(false));
}

/// What a certificate holds is only recorded where one is wanted.
#[test]
fn without_a_certificate_the_same_is_said() {
    let mut states = BTreeSet::new();
    for (from, to) in [("max: (-5, 40, 5)", "max: (20, 40, 5)"), ("(12, 30)", "(12, 3)")] {
        let (_folder, file) = with_job(&JOB.replacen(from, to, 1));
        let said = |outputs: &[Output]| {
            let plan = Request::from_file(&file).outputs(outputs.iter().copied()).plan();
            let outcome = plan.expect("a plan").run(&()).expect("a result");
            let report = serde_json::to_value(outcome.report()).expect("plain data");
            let is_certified = outcome.certificate().expect("a notation").is_some();
            let all = ["statements", "findings", "verdict"].map(|name| report[name].clone());
            (all, is_certified)
        };
        let (with, is_certified) = said(&[Output::Report, Output::Certificate]);
        assert!(is_certified);
        assert_eq!(said(&[Output::Report]), (with.clone(), false), "{to}");
        states.extend(
            with[0]
                .as_array()
                .expect("statements")
                .iter()
                .map(|own| own["state"].to_string()),
        );
    }
    assert!(states.len() > 1, "{states:?}");
}

#[test]
fn other_files_and_options_are_refused() {
    let (folder, file, text) = certified();
    for (from, to) in [
        ("clearance: 1.0", "clearance: 1.5"),
        ("gouge: 0.02", "gouge: 0.03"),
        ("excess: 0.02", "excess: 0.03"),
        ("max: (-5, 40, 5)", "max: (-5, 40, 5.001)"),
        ("Line((12, 50))", "Line((12, 50.5))"),
        ("max: (60, 40, 0))", "max: (60, 40, 0.001))"),
        ("Flat(radius: 5,", "Flat(radius: 5.001,"),
    ] {
        assert!(JOB.contains(from), "{from}");
        fs::write(folder.path().join("job.ron"), JOB.replacen(from, to, 1)).expect("written");
        let said = check(&file, 1).expect_err("another job").to_string();
        assert!(said.contains("does not belong to these files"), "{from}: {said}");
    }
    // Whatever is said of its files: what the statements are about is another.
    let certificate = Certificate::read(&text).expect("a certificate");
    let other = Certificate::new(
        certificate.made_by,
        certificate.request,
        Vec::new(),
        certificate.scene,
        certificate.claims,
    );
    fs::write(&file, other.written().expect("a notation")).expect("written");
    let said = check(&file, 1).expect_err("another job").to_string();
    assert!(said.contains("does not belong to these files"), "{said}");
    fs::write(folder.path().join("job.ron"), JOB).expect("written");
    assert!(check(&file, 1).expect("the same job").holds());
}
