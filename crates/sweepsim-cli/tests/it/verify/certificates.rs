//! `check`: certificates of the shipped bracket, and of other files.

use crate::support::{Workdir, text};
use std::fs;
use std::path::Path;

/// A folder with the fixtures of the bracket.
fn bracket() -> Workdir {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/verify");
    let folder = Workdir::new("");
    for file in fs::read_dir(fixtures).expect("a folder") {
        let file = file.expect("a file").path();
        if file.is_file() {
            fs::copy(&file, folder.path(file.file_name().unwrap().to_str().unwrap())).expect("a copy");
        }
    }
    folder
}

/// The exit status of a check, and what is said.
fn check(folder: &Workdir, certificate: &str) -> (Option<i32>, String) {
    let output = folder.run(&["check", certificate, "--threads", "1"]);
    (output.status.code(), text(&output.stdout) + &text(&output.stderr))
}

#[test]
fn a_certificate_belongs_to_its_files() {
    let folder = bracket();
    // Whatever is said of other statements.
    folder.run(&["verify", "bracket.ron", "--only", "certificate", "--out", "out/a"]);
    let file = "out/a/certificate.json";
    let (code, said) = check(&folder, file);
    assert_eq!(code, Some(0), "{said}");
    let first = said.lines().next().unwrap();
    assert!(
        first.contains("proven: no cutter goes deeper into the target than 0.020000 mm"),
        "{said}"
    );
    for statement in [
        "proven: no cutter goes deeper into the stock than 0.0010000 mm where it must not cut",
        "proven: no shank or holder goes deeper into the stock as it is at that time than 0.0010000 mm",
    ] {
        assert!(said.contains(statement), "{said}");
    }
    // From elsewhere, the files are found around the certificate.
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_sweepsim"))
        .args(["check", "--quiet"])
        .arg(folder.path(file))
        .current_dir(std::env::temp_dir())
        .output()
        .expect("the command starts");
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert_eq!(output.stdout, b"");

    // One number of the program, of the target, of the job, is another.
    for (name, from, to) in [
        ("bracket.nc", "X", "X 0"),
        ("bracket.ron", "Ball(radius: 5,", "Ball(radius: 5.01,"),
        ("bracket.ron", "gouge: 0.02", "gouge: 0.03"),
    ] {
        let before = fs::read_to_string(folder.path(name)).unwrap();
        assert!(before.contains(from));
        fs::write(folder.path(name), before.replacen(from, to, 1)).unwrap();
        let (code, said) = check(&folder, file);
        assert_eq!(code, Some(2), "{name}: {said}");
        assert!(
            said.contains("does not belong to these files") && said.contains(name),
            "{said}"
        );
        fs::write(folder.path(name), before).unwrap();
    }
    let mut target = fs::read(folder.path("bracket.stl")).unwrap();
    let last = target.len() - 4;
    target[last] ^= 1;
    fs::write(folder.path("bracket.stl"), &target).unwrap();
    assert_eq!(check(&folder, file).0, Some(2));
    target[last] ^= 1;
    fs::write(folder.path("bracket.stl"), &target).unwrap();
    assert_eq!(check(&folder, file).0, Some(0));

    // Cut short, changed, something else, nothing.
    let whole = fs::read(folder.path(file)).unwrap();
    let half = whole.len() / 2;
    let mut changed = whole.clone();
    changed[half] ^= 1;
    for (content, said) in [
        (&whole[..half], "not a certificate, or cut short"),
        (&whole[..whole.len() - 1], "not a certificate, or cut short"),
        (&changed[..], "was changed"),
        (b"{\"statement\":[]}", "not a certificate"),
        (b"", "not a certificate"),
    ] {
        fs::write(folder.path("other.json"), content).unwrap();
        let error = folder.bad(&["check", "other.json"]);
        assert!(error.contains(said), "{error}");
    }
    assert!(folder.bad(&["check", "nowhere.json"]).contains("nowhere.json"));
    fs::remove_file(folder.path("bracket.nc")).unwrap();
    assert!(folder.bad(&["check", file]).contains("bracket.nc"));
}

#[test]
fn what_is_refuted_is_not_proven() {
    let folder = bracket();
    let run = |more: &[&str]| {
        let all = [
            "verify",
            "bracket-faulty.ron",
            "--cells",
            "50x30",
            "--only",
            "report",
            "--out",
            "out",
        ];
        folder.run(&[&all[..], more].concat())
    };
    let output = run(&["--certificate", "faulty.json"]);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    let (code, said) = check(&folder, "faulty.json");
    assert_eq!(code, Some(1), "{said}");
    assert!(
        said.contains("not proven: a cutter goes deeper into the target"),
        "{said}"
    );
    assert!(!folder.written().contains(&"certificate.json".to_owned()));
    // The same again is the same to the byte, whatever the threads.
    run(&["--certificate", "again.json", "--threads", "1"]);
    let [one, two] = ["faulty.json", "again.json"].map(|name| fs::read(folder.path(name)).unwrap());
    assert!(one == two);
    // Nothing is left without a proof, not even from before.
    fs::write(folder.path("out/certificate.json"), &one).unwrap();
    let all = [
        "verify",
        "bracket-faulty.ron",
        "--cells",
        "50x30",
        "--no-proof",
        "--out",
        "out",
    ];
    folder.run(&all);
    assert!(!folder.written().contains(&"certificate.json".to_owned()));
    let message = folder.bad(&[&all[..], &["--only", "report,certificate"]].concat());
    assert!(
        message.contains("--only certificate: there is none without a proof"),
        "{message}"
    );
    folder.bad(&["verify", "bracket.ron", "--no-proof", "--certificate", "none.json"]);
}

#[test]
fn nothing_to_certify_is_said() {
    let folder = Workdir::new(
        "Job(stock: Block(min: (0, 0, 0), max: (9, 9, 5)), grid: Grid(cells: (9, 9)), tools: { 1: Flat(radius: 1, length: 9) }, paths: [Path(tool: 1, poses: [((-2, 5, 3), (0, 0, 1)), ((11, 5, 3), (0, 0, 1))])])",
    );
    let words = folder.good(&["verify", "job.ron", "--only", "certificate", "--out", "out"]);
    assert!(
        words.contains("there is no certificate.json: nothing was decided"),
        "{words}"
    );
}

/// A tool of one free-form patch, and a blank that is a mesh: proven all the same, and its depths accepted.
#[test]
#[ignore = "takes a minute"]
fn the_hand_railing_is_proven() {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures");
    let job = fixtures.join("jobs/railing-eased.ron");
    let folder = Workdir::new("");
    let arguments = [
        "verify",
        job.to_str().expect("a path"),
        "--only",
        "certificate,report",
        "--out",
        "out",
    ];
    let said = folder.good(&arguments);
    assert!(said.contains("PASS, proven everywhere: gouges and excess"), "{said}");
    let (code, said) = check(&folder, "out/certificate.json");
    // A checker knows no stock between triangles.
    assert!(
        code != Some(0) && said.contains("proven: no cutter goes deeper into the target than 0.050000 mm"),
        "{said}"
    );
    assert!(!said.contains("not proven: no cutter"), "{said}");
}
