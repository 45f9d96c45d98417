//! Each subcommand through the library: the same files as from the command, to the byte but for times.

use crate::shards::timeless;
use crate::support::{Workdir, text};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use sweepsim::systems::Plane;
use sweepsim_job::{
    CompareRequest, ConvertRequest, DialectOptions, Directions, Judging, Memory, Merge, Output, Request, ShardNumber,
    Sink, Task, ViewOptions, describe,
};

const ALL: [Output; 6] = [
    Output::Dexels,
    Output::Mesh,
    Output::Picture,
    Output::Report,
    Output::Binary,
    Output::Tridexels,
];
const NAMES: [&str; 6] = ["dexels", "mesh", "picture", "report", "binary", "tridexels"];

fn fixture(name: &str) -> PathBuf {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures").join(name);
    fs::canonicalize(file).unwrap()
}

/// The jobs in a folder of fixtures.
fn jobs(folder: &str) -> Vec<PathBuf> {
    let files = fs::read_dir(fixture(folder))
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let mut jobs: Vec<PathBuf> = files
        .filter(|file| file.extension().is_some_and(|extension| extension == "ron"))
        .collect();
    jobs.sort();
    jobs
}

fn small() -> ViewOptions {
    let mut view = ViewOptions::default();
    view.size = [64, 48];
    view
}

/// The content of a file without times.
fn compared(name: &str, bytes: &[u8]) -> Vec<u8> {
    match Path::new(name).extension().and_then(|e| e.to_str()) {
        Some("json") => {
            let mut report: serde_json::Value = serde_json::from_slice(bytes).unwrap();
            assert!(report.as_object_mut().unwrap().remove("seconds").is_some());
            report.to_string().into_bytes()
        }
        Some("html") => timeless(&text(bytes)).into_bytes(),
        _ => bytes.to_vec(),
    }
}

/// The files of a folder are those that the library made; so many of them.
fn assert_same(what: &str, folder: &Path, made: &Memory, count: usize) {
    let read = |entry: std::io::Result<fs::DirEntry>| {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        (name, fs::read(path).unwrap())
    };
    let files: BTreeMap<String, Vec<u8>> = fs::read_dir(folder).unwrap().map(read).collect();
    assert_eq!(files.len(), count, "{what}: {:?}", files.keys());
    assert!(files.keys().eq(made.0.keys()), "{what}: {:?}", made.0.keys());
    for (name, bytes) in &files {
        assert!(!bytes.is_empty(), "{what}: {name}");
        let [a, b] = [bytes, &made.0[name]].map(|bytes| compared(name, bytes));
        assert!(a == b, "{what}: {name} differs");
    }
}

/// Carries out a request in memory; the exit status that the command would have.
fn run(request: Request) -> (Memory, i32) {
    let outcome = request.plan().unwrap().run(&()).unwrap();
    let mut made = Memory::default();
    let wanted = outcome.plan().request().wanted().to_vec();
    let written = outcome.write_to(&mut made, &wanted, &()).unwrap();
    let status = match outcome.verdict() {
        Some(sweepsim_job::Verdict::Fail) => 1,
        Some(sweepsim_job::Verdict::Undecided) => 3,
        _ if written.certified => 0,
        _ => 3,
    };
    (made, status)
}

/// Runs a job by the command and by the library.
fn compare(job: &Path, task: Task, outputs: &[Output], frames: Option<u16>, files: usize) {
    let folder = Workdir::new("");
    let names: Vec<&str> = outputs.iter().map(|output| NAMES[*output as usize]).collect();
    let (names, file) = (names.join(","), job.to_str().unwrap());
    let mut arguments = vec![task.name(), file, "--out", "out", "--only", &names];
    arguments.extend(["--cells", "24x16", "--size", "64x48", "--moments", "2"]);
    // Proofs of long programs take long, and are the same as those of short ones.
    let proof = task != Task::Verify || outputs.contains(&Output::Picture);
    arguments.extend((!proof).then_some("--no-proof"));
    let count = frames.map(|count| count.to_string());
    arguments.extend(count.iter().flat_map(|count| ["--frames", count]));
    let output = folder.run(&arguments);
    let request = Request::from_file(job)
        .task(task)
        .cells([24, 16])
        .outputs(outputs.to_vec());
    let mut judging = Judging::default();
    judging.proof = proof;
    let request = request.judging(judging);
    let (made, status) = run(request.moments(2).view(small()).frames(frames, true));
    let what = format!("{} {file}", task.name());
    assert_eq!(output.status.code(), Some(status), "{what}: {}", text(&output.stderr));
    assert_same(&what, &folder.path("out"), &made, files);
}

#[test]
fn every_fixture_job_is_run_the_same() {
    let all = [jobs("jobs"), jobs("verify")].concat();
    assert!(all.len() >= 11);
    for job in all {
        let is_quick = job.ends_with("quickstart.ron");
        let is_bracket = job.ends_with("bracket.ron");
        let frames = is_quick.then_some(3);
        let few = [Output::Dexels, Output::Report];
        let (outputs, files) = if is_quick { (&ALL[..], 10) } else { (&few[..], 3) };
        compare(&job, Task::Simulate, outputs, frames, files);
        let (outputs, files) = if is_bracket { (&ALL[..], 7) } else { (&few[..], 3) };
        compare(&job, Task::Verify, outputs, None, files);
        let (outputs, files) = if is_quick { (&ALL[..], 7) } else { (&few[..1], 1) };
        compare(&job, Task::Sweep, outputs, None, files);
    }
}

#[test]
fn sections_are_the_same() {
    let job = fixture("jobs/quickstart.ron");
    let folder = Workdir::new("");
    folder.good(&["section", job.to_str().unwrap(), "--plane", "y=1", "--out", "out"]);
    let plan = Request::from_file(&job).task(Task::Section).plan().unwrap();
    let found = plan.section(&Plane::y(1.0).unwrap(), 0.01, &()).unwrap();
    assert!(!found.section.curves.is_empty());
    let mut made = Memory::default();
    found.write_to(&mut made).unwrap();
    assert_same("section", &folder.path("out"), &made, 2);
}

#[test]
fn shards_and_merges_are_the_same() {
    let job = fixture("verify/bracket-faulty.ron");
    let request = || {
        let request = Request::from_file(&job)
            .cells([25, 15])
            .outputs([Output::Dexels, Output::Report]);
        request.moments(0).directions(Directions::Xyz)
    };
    let (folder, mut pieces) = (Workdir::new(""), Memory::default());
    let mut arguments = vec![
        "verify",
        job.to_str().unwrap(),
        "--cells",
        "25x15",
        "--only",
        "dexels,report",
    ];
    arguments.extend(["--moments", "0", "--directions", "xyz", "--out"]);
    for number in 0..2 {
        let shard = format!("{number}/2");
        folder.good(&[&arguments[..], &["pieces", "--shard", &shard]].concat());
        let plan = request().plan().unwrap();
        let piece = plan.shard(ShardNumber::new(number, 2).unwrap(), &()).unwrap();
        piece.write_to(&mut pieces).unwrap();
    }
    // The pieces tell the folder where they were made, and so differ; they can be joined in any mixture.
    let own = folder.path("pieces/shard-1-of-2.piece");
    let before = fs::read(&own).unwrap();
    assert_ne!(before, pieces.0["shard-1-of-2.piece"]);
    fs::write(&own, &pieces.0["shard-1-of-2.piece"]).unwrap();
    let plan = Merge::read(&[folder.path("pieces")]).unwrap().plan().unwrap();
    let outcome = plan.run(&()).unwrap();
    let mut made = Memory::default();
    let wanted = outcome.plan().request().wanted().to_vec();
    outcome.write_to(&mut made, &wanted, &()).unwrap();
    assert!(outcome.findings().len() >= 5);
    let merged = folder.run(&["merge", "pieces", "--out", "merged"]);
    assert_eq!(merged.status.code(), Some(1));
    assert_same("merge", &folder.path("merged"), &made, 3);
    let (whole, _) = run(request());
    assert_same("merge and whole", &folder.path("merged"), &whole, 3);
}

#[test]
fn comparisons_and_conversions_are_the_same() {
    let folder = Workdir::new("");
    let [part, target] = ["meshes/railing.ply", "meshes/railing-blank.ply"].map(fixture);
    let names = [&part, &target].map(|file| file.to_str().unwrap());
    let more = ["--cells", "30x20", "--size", "64x48", "--out", "out"];
    folder.good(&[&["compare", names[0], names[1]][..], &more].concat());
    let mut request = CompareRequest::new(&part, &target);
    request.grid.cells = Some([30, 20]);
    request.view = small();
    let found = request.read().unwrap().compare(&()).unwrap();
    let mut made = Memory::default();
    found.write_to(&mut made).unwrap();
    assert!(found.report.gouge.max > 1.0);
    assert_same("compare", &folder.path("out"), &made, 2);

    let mut made = Memory::default();
    let program = fixture("verify/bracket.nc");
    let conversions = [
        (&part, "part.stl"),
        (&part, "part.vtp"),
        (&program, "program.cls"),
        (&program, "program.h"),
        (&program, "program.csv"),
        (&program, "program.txt"),
    ];
    for (input, output) in conversions {
        let written = folder.path("converted").join(output);
        fs::create_dir_all(folder.path("converted")).unwrap();
        folder.good(&["convert", input.to_str().unwrap(), written.to_str().unwrap()]);
        ConvertRequest::new(input, output).write_to(&mut made).unwrap();
    }
    assert_same("convert", &folder.path("converted"), &made, conversions.len());
}

#[test]
fn descriptions_and_plans_say_what_the_command_says() {
    let folder = Workdir::new("");
    for name in ["jobs/quickstart.ron", "verify/bracket.nc", "meshes/railing.ply"] {
        let file = fixture(name);
        let said = folder.good(&["inspect", file.to_str().unwrap()]);
        let described = describe(&file, &DialectOptions::default()).unwrap();
        let lines: Vec<String> = described
            .lines()
            .iter()
            .map(|(label, value)| format!("{label:>10}  {value}"))
            .collect();
        assert!(lines.len() > 3);
        assert_eq!(said.trim_end_matches('\n'), lines.join("\n"), "{name}");
    }
    // What `new` finds and guesses is what a plan of the program has.
    let program = "(T1 D=6 - flat end mill)\nG21 G90\nT1 M6\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX20\nG0 Z5\nM30\n";
    fs::write(folder.path("slot.nc"), program).unwrap();
    let said = folder.good(&["new", "slot.nc"]);
    let plan = Request::from_program("slot.nc", program).plan().unwrap();
    assert!(plan.guessed().iter().any(|guess| guess.about == "stock"), "{said}");
    for guess in plan.guessed() {
        assert!(said.contains(&format!("guessed  {guess}")), "{guess}: {said}");
    }
    for found in plan.found() {
        assert!(said.contains(found), "{found}: {said}");
    }
    assert!(plan.memory() > 0 && plan.work().unwrap() > 0.0);
}

/// A sink that refuses all but the first output.
struct OnlyOne(Vec<String>);

impl Sink for OnlyOne {
    fn write(&mut self, name: &str, _: sweepsim_job::Content) -> Result<(), sweepsim_job::JobError> {
        match self.0.is_empty() {
            true => {
                self.0.push(name.to_owned());
                Ok(())
            }
            false => Err(sweepsim_job::JobError::Cancelled),
        }
    }
}

#[test]
fn a_sink_ends_the_writing() {
    let request = Request::from_file(fixture("jobs/quickstart.ron")).task(Task::Simulate);
    let outcome = request.cells([10, 8]).plan().unwrap().run(&()).unwrap();
    let mut sink = OnlyOne(Vec::new());
    let done = outcome.write_to(&mut sink, &ALL, &());
    assert!(matches!(done, Err(sweepsim_job::JobError::Cancelled)));
    assert_eq!(sink.0, ["dexels.csv"]);
    // The outcome is as it was.
    let mut made = Memory::default();
    outcome.write_to(&mut made, &ALL, &()).unwrap();
    assert_eq!(made.0.len(), 7);
}

#[test]
fn requests_that_cannot_be_built_say_which_field() {
    let base = || Request::from_file(fixture("jobs/quickstart.ron")).task(Task::Simulate);
    let message = |request: Request| request.plan().unwrap_err().to_string();
    assert!(message(base().tolerance(-1.0)).starts_with("tolerance: expected a positive number"));
    assert!(message(base().decimate(f64::NAN)).starts_with("decimate: expected a positive"));
    assert!(message(base().limits(0.1, -0.1)).starts_with("limits: expected"));
    assert!(message(base().cells([0, 5])).starts_with("cells: "));
    assert!(message(base().task(Task::Sweep).frames(3, true)).starts_with("frames: expected"));
    let mut options = sweepsim_job::ProgramOptions::default();
    options.tools = Some("tools.json".into());
    assert!(message(base().program(options)).starts_with("tools is for programs"));
    let mut sweeping = sweepsim_job::SweepOptions::default();
    sweeping.tile = 3;
    assert!(message(base().sweeping(sweeping)).starts_with("tile: expected"));
    let z = base().directions(Directions::Z).outputs([Output::Tridexels]);
    assert!(message(z).starts_with("directions z: "));
    // Solids given in code have no notation: they are refused rather than lost.
    let solid = sweepsim_job::motion::Tool::flat(1.0, 9.0).unwrap();
    let refused = serde_json::to_string(&base().tool(1, solid)).unwrap_err();
    assert!(refused.to_string().contains("expected files"), "{refused}");
}
