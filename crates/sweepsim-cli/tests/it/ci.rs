//! `verify` of several programs, and what continuous integration gets of it; completions and manual pages.

use crate::support::{Workdir, text};
use serde_json::Value;
use std::fs;

const GOOD: &str = "G21 G90\nT1 M6\nS8000 M3\nG0 X-20 Y0 Z10\nG1 Z5 F400\nX20\nG0 Z20\nM30\n";
const STOCK: &str = "block:-15,-15,0,15,15,8";

/// Three programs in `nc`: one that is good, one with a rapid through the block in line 7, and one that is broken in
/// line 6.
fn workdir() -> Workdir {
    let folder = Workdir::new("");
    fs::create_dir(folder.path("nc")).unwrap();
    let bad = GOOD.replace("G0 Z20\n", "G0 X0 Y5\nG1 Z20\n");
    for (name, text) in [
        ("good", GOOD),
        ("bad", &bad),
        ("broken", &GOOD.replace("X20\n", "X2=0\n")),
    ] {
        fs::write(folder.path(&format!("nc/{name}.nc")), text).unwrap();
    }
    fs::write(folder.path("tools.tbl"), "T1 D6\n").unwrap();
    folder
}

const COMMON: [&str; 10] = [
    "--tools",
    "tools.tbl",
    "--stock",
    STOCK,
    "--only",
    "report",
    "--sarif",
    "found.sarif",
    "--junit",
    "found.xml",
];

/// Rule, level, file and line of each result.
fn results(folder: &Workdir) -> Vec<(String, String, String, Option<u64>)> {
    let log: Value = serde_json::from_slice(&fs::read(folder.path("found.sarif")).unwrap()).unwrap();
    assert_eq!(log["version"], "2.1.0");
    let word = |value: &Value| value.as_str().unwrap().to_owned();
    let result = |result: &Value| {
        let place = &result["locations"][0]["physicalLocation"];
        let line = place["region"]["startLine"].as_u64();
        let file = word(&place["artifactLocation"]["uri"]);
        (word(&result["ruleId"]), word(&result["level"]), file, line)
    };
    log["runs"][0]["results"]
        .as_array()
        .unwrap()
        .iter()
        .map(result)
        .collect()
}

fn at(rule: &str, file: &str, line: u64) -> (String, String, String, Option<u64>) {
    (rule.to_owned(), "error".to_owned(), file.to_owned(), Some(line))
}

/// The table at the end: status and program.
fn table(said: &str) -> Vec<(&str, &str)> {
    let rows = said
        .lines()
        .skip_while(|line| !line.trim_start().starts_with("status  program"));
    let rows = rows.skip(1).take_while(|line| !line.trim_start().starts_with("time"));
    let mut words = rows.map(str::split_whitespace);
    std::iter::from_fn(|| words.next().map(|mut own| (own.next().unwrap(), own.next().unwrap()))).collect()
}

#[test]
fn each_program_is_judged_whatever_the_others_are() {
    let folder = workdir();
    let programs = ["verify", "nc/broken.nc", "nc/bad.nc", "nc/good.nc", "--out", "all"];
    let output = folder.run(&[&programs[..], &COMMON].concat());
    assert_eq!(output.status.code(), Some(2));
    let said = text(&output.stdout);
    assert_eq!(
        table(&said),
        [("2", "nc/broken.nc"), ("1", "nc/bad.nc"), ("0", "nc/good.nc")],
        "{said}"
    );
    assert!(
        text(&output.stderr).contains("nc/broken.nc:6:3"),
        "{}",
        text(&output.stderr)
    );
    for (name, written) in [("good", true), ("bad", true), ("broken", false)] {
        assert_eq!(
            folder.path(&format!("all/{name}/report.json")).exists(),
            written,
            "{name}"
        );
    }
    // On the lines, and by the statement.
    let expected = [
        at("input", "nc/broken.nc", 6),
        at("rapid", "nc/bad.nc", 7),
        at("rapid", "nc/bad.nc", 7),
    ];
    assert_eq!(results(&folder), expected);
    let xml = fs::read_to_string(folder.path("found.xml")).unwrap();
    assert!(
        xml.contains("<testsuites name=\"sweepsim verify\" tests=\"19\" failures=\"1\" errors=\"1\" skipped=\"12\""),
        "{xml}"
    );
    assert!(
        xml.contains("<testcase classname=\"nc/good.nc\" name=\"rapid\"/>"),
        "{xml}"
    );
    assert!(
        xml.contains("nc/bad.nc:7: Rapid move through material: cutter of tool 1, 3.0000 mm deep"),
        "{xml}"
    );
}

#[test]
fn a_table_says_what_differs() {
    let folder = workdir();
    fs::create_dir(folder.path("lists")).unwrap();
    // Without a stock of its own, the second has the one of the command line; the third is far below all moves.
    let list = "program,stock\n../nc/good.nc,auto\n../nc/bad.nc,\n../nc/bad.nc,\"block:-15,-15,-9,15,15,-8\"\n";
    fs::write(folder.path("lists/all.csv"), list).unwrap();
    let output = folder.run(&[&["verify", "--batch", "lists/all.csv", "--out", "all"], &COMMON[..]].concat());
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    let said = text(&output.stdout);
    let states: Vec<_> = table(&said).into_iter().map(|(status, _)| status).collect();
    assert_eq!(states, ["0", "1", "0"], "{said}");
    assert!(folder.path("all/good/report.json").exists() && folder.path("all/bad-2/report.json").exists());
    assert_eq!(
        results(&folder),
        [at("rapid", "nc/bad.nc", 7), at("rapid", "nc/bad.nc", 7)]
    );
}

#[test]
fn of_one_program_nothing_changes() {
    let folder = workdir();
    let output = folder.run(&[&["verify", "nc/bad.nc", "--out", "one"], &COMMON[..]].concat());
    assert_eq!(output.status.code(), Some(1));
    assert!(folder.path("one/report.json").exists());
    assert!(!text(&output.stdout).contains("status  program"));
    assert_eq!(results(&folder).len(), 2);
    // What cannot be read is a result, too.
    let said = folder.bad(&[&["verify", "nc/broken.nc"], &COMMON[..]].concat());
    assert_eq!(said.matches("error").count(), 1, "{said}");
    assert_eq!(results(&folder), [at("input", "nc/broken.nc", 6)]);
    // All is well: no results, and nothing half-written.
    folder.good(&[&["verify", "nc/good.nc"], &COMMON[..]].concat());
    assert_eq!(results(&folder), []);
    let names = fs::read_dir(folder.path("")).unwrap();
    let names = names.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned());
    assert!(!names.into_iter().any(|name| name.ends_with(".part")));
}

#[test]
fn limits_are_given_to_programs() {
    let folder = workdir();
    folder.good(&[
        "simulate",
        "nc/good.nc",
        "--tools",
        "tools.tbl",
        "--stock",
        STOCK,
        "--only",
        "mesh",
        "--out",
        ".",
    ]);
    // 0.2 mm deeper than the target.
    fs::write(folder.path("nc/deep.nc"), GOOD.replace("Z5", "Z4.8")).unwrap();
    let verified = |limits: &str, code: i32| {
        let asked = [
            "verify",
            "nc/deep.nc",
            "--target",
            "part.ply",
            "--directions",
            "z",
            "--no-proof",
            "--limits",
            limits,
        ];
        let output = folder.run(&[&asked[..], &COMMON].concat());
        assert_eq!(output.status.code(), Some(code), "{}", text(&output.stdout));
        results(&folder).iter().filter(|found| found.0 == "gouge").count()
    };
    assert_eq!(verified("0.3,0.3", 0), 0);
    assert_eq!(verified("0.1,0.1", 1), 1);
}

#[test]
fn what_cannot_be_done_is_said_before() {
    let folder = workdir();
    let bad = |more: &[&str]| folder.bad(&[&["verify", "nc/good.nc"], more, &["--tools", "tools.tbl"]].concat());
    assert!(bad(&["--sarif", "none/found.sarif"]).contains("none/found.sarif"));
    assert!(bad(&["nc/bad.nc", "--json"]).contains("--json is for one program"));
    assert!(bad(&["nc/bad.nc", "--certificate", "c.json"]).contains("--certificate is for one program"));
    assert!(bad(&["nc/bad.nc", "--shard", "0/2"]).contains("--shard is for one program"));
    assert!(bad(&["--batch", "list.csv"]).contains("cannot be used with"));
    assert!(!folder.path("out").exists());
    assert!(
        folder
            .bad(&["verify", "--batch", "none.csv"])
            .contains("none.csv: there is no such file")
    );
    fs::write(folder.path("list.csv"), "program,limits\nnc/good.nc,1\n").unwrap();
    let said = folder.bad(&["verify", "--batch", "list.csv"]);
    assert!(said.contains("list.csv:2: limits: expected two lengths"), "{said}");
}

#[test]
fn shells_and_man_know_the_options() {
    let folder = Workdir::new("");
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let made = folder.good(&["completions", shell]);
        assert!(made.contains("sarif"), "{shell}");
    }
    assert!(folder.bad(&["completions", "cmd"]).contains("possible values"));
    let page = folder.good(&["man"]);
    assert!(
        page.contains(".TH sweepsim 1") && page.contains("sweepsim\\-verify(1)"),
        "{page}"
    );
    folder.good(&["man", "--out", "man"]);
    let verify = fs::read_to_string(folder.path("man/sweepsim-verify.1")).unwrap();
    assert!(
        verify.contains("\\fB\\-\\-sarif\\fR") && verify.contains("SARIF 2.1.0"),
        "{verify}"
    );
    // Each page that the first refers to is there.
    let pages = page.lines().filter_map(|line| line.strip_suffix("(1)"));
    let pages: Vec<_> = pages.map(|name| name.replace('\\', "")).collect();
    assert!(pages.len() >= 12, "{pages:?}");
    for name in pages {
        assert!(folder.path(&format!("man/{name}.1")).exists(), "{name}");
    }
}

/// The page says what there is: its options, its columns and its table.
#[test]
fn the_page_on_continuous_integration_is_true() {
    let docs = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let page = fs::read_to_string(docs.join("ci.md")).unwrap();
    let action = fs::read_to_string(docs.join("action/action.yml")).unwrap();
    let folder = Workdir::new("");
    let help = folder.good(&["verify", "--help"]) + "--locked --path ";
    let is_named = |c: char| c.is_ascii_lowercase() || c == '-';
    let words = [&page, &action]
        .into_iter()
        .flat_map(|text| text.split(|c| !is_named(c)));
    let options: Vec<_> = words
        .filter(|word| word.len() > 3 && word.starts_with("--") && !word[2..].starts_with('-'))
        .collect();
    assert!(options.len() > 15, "{options:?}");
    for option in options {
        assert!(
            help.contains(&format!("{option} ")) || help.contains(&format!("{option}\n")),
            "{option}"
        );
    }
    let table = page
        .split("```csv\n")
        .nth(1)
        .and_then(|rest| rest.split("```").next())
        .unwrap();
    fs::write(folder.path("programs.csv"), table).unwrap();
    let output = folder.run(&["verify", "--batch", "programs.csv"]);
    let said = text(&output.stdout);
    // None of its files is there: each row was understood.
    assert_eq!(
        self::table(&said),
        [("2", "pocket.nc"), ("2", "cover.nc"), ("2", "bracket.ron")],
        "{said}"
    );
    let rules = [
        "gouge",
        "excess",
        "rapid",
        "collision",
        "fixture",
        "spindle",
        "feed",
        "machine",
        "limit",
        "unresolved",
        "input",
    ];
    for rule in rules {
        assert!(page.contains(&format!("`{rule}`")), "{rule}");
    }
}

/// Programs share the folder of a cache, and none is judged twice.
#[test]
fn what_was_judged_before_is_not_judged_again() {
    let folder = workdir();
    let run = |more: &[&str]| {
        let programs = ["verify", "nc/good.nc", "nc/bad.nc", "nc/broken.nc"];
        let output = folder.run(&[&programs, &COMMON[..], more].concat());
        assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
        let said = text(&output.stdout);
        let lines = said
            .lines()
            .map(str::trim_start)
            .filter(|line| line.starts_with("cache"));
        let lines = lines.map(|line| line.split(" (").next().unwrap().to_owned());
        (
            lines.collect::<Vec<String>>(),
            fs::read(folder.path("found.sarif")).unwrap(),
        )
    };
    let (said, expected) = run(&[]);
    assert_eq!(said, [""; 0]);
    let cache = ["--cache", "known"];
    let again =
        |good: u8, bad: u8| [(good, 3), (bad, 4)].map(|(own, all)| format!("cache  {own} of {all} moves judged again"));
    assert_eq!(run(&cache), (again(3, 4).to_vec(), expected.clone()));
    assert_eq!(run(&cache), (again(0, 0).to_vec(), expected.clone()));
    // Another program, of which only the end is new.
    let bad = fs::read_to_string(folder.path("nc/bad.nc")).unwrap();
    fs::write(folder.path("nc/bad.nc"), bad.replace("M30", "G0 Z30\nM30")).unwrap();
    let (said, found) = run(&cache);
    assert_eq!(said[0], again(0, 0)[0]);
    assert_eq!(found, expected);
    assert_eq!(fs::read_dir(folder.path("known")).unwrap().count(), 2);
    for other in [&["--first"][..], &["--shard", "0/2"]] {
        let refused = folder.bad(&[&["verify", "nc/good.nc"], &COMMON[..6], &cache, other].concat());
        assert!(refused.contains("cannot be used with"), "{refused}");
    }
}
