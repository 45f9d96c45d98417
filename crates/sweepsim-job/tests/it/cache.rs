//! What earlier runs have found is taken only where it would be found again.

use crate::aside::made;
use std::fs;
use std::path::Path;
use sweepsim_job::{
    Directions, JobError, Judging, Memory, Outcome, Output, Request, ShardNumber, Task, dexel::TriangleSoup,
};

/// SplitMix64.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ z >> 31) % end as u64) as usize
    }
}

const JOB: &str = r#"Job(
    tolerance: 1e-5,
    grid: Grid(min: (0, 0), max: (40, 24), cells: (40, 24)),
    stock: Block(min: (0, 0, -8), max: (40, 24, 1)),
    tools: {1: Ball(radius: 2, length: 12), 2: Flat(radius: 1.5, length: 12), 3: Flat(radius: 2.5, length: 12)},
    bodies: {1: [Holder(Profile(start: (0, 4), segments: [Line((3, 4)), Line((3, 20)), Line((0, 20))]))]},
    paths: [Path(tool: 0, file: "part.nc")],
    fixtures: [Block(min: (-12, 8, -8), max: (-9, 16, 3))],
    target: Mesh("part.stl"),
    limits: Limits(gouge: 0.1, excess: 3.5),
)
"#;

/// A raster by a ball, with rapids between its passes, then slots by two flat ends.
fn program(random: &mut Random) -> Vec<String> {
    let mut lines = ["G21 G90", "S9000 M3", "T1 M6"].map(String::from).to_vec();
    for pass in 0..12 {
        lines.push(format!("G0 X1 Y{} Z3", 2 * pass + 1));
        for k in 0..14 {
            let z = -1.0 - 0.05 * random.below(10) as f64;
            lines.push(format!("G1 X{:.3} Z{z:.3} F600", 1.0 + 2.6 * k as f64));
        }
        lines.push("G0 Z5".to_owned());
    }
    for tool in [2, 3] {
        lines.push(format!("T{tool} M6"));
        for slot in 0..5 {
            lines.push(format!("G0 X-5 Y{} Z3", 4 * slot + 3));
            lines.push("G0 Z-1".to_owned());
            lines.push("G1 X20 Z-1.5 F500".to_owned());
            lines.extend(["G91", "G3 X4 Y0 I2 J0", "G90"].map(String::from));
            lines.push("G1 X46".to_owned());
            lines.push("G0 Z5".to_owned());
        }
    }
    lines.push("M30".to_owned());
    lines
}

/// Changes a line, adds one, or takes one away; at least so far into the program.
fn edit(lines: &mut Vec<String>, random: &mut Random, from: usize) -> usize {
    let at = from + random.below(lines.len() - 1 - from);
    let moves = |line: &str| line.starts_with("G1") || line.starts_with("G0");
    let at = (at..lines.len() - 1)
        .find(|at| moves(&lines[*at]))
        .unwrap_or(lines.len() - 2);
    match random.below(4) {
        0 => lines.insert(at, format!("G1 X{} Z-1.2 F400", random.below(40))),
        1 => drop(lines.remove(at)),
        2 => lines[at] = lines[at].replacen("G1", "G0", 1),
        _ => lines[at] = format!("G1 X{}.25 Z-{}.5 F300", random.below(40), random.below(3)),
    }
    at
}

fn written(folder: &Path, lines: &[String]) {
    fs::write(folder.join("part.nc"), lines.join("\n")).unwrap();
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let soup = TriangleSoup::block([0.0, 0.0, -8.0], [40.0, 24.0, -2.0]);
    let mut file = fs::File::create(folder.path().join("part.stl")).unwrap();
    sweepsim_formats::write_stl(&soup.triangles, &mut file).unwrap();
    fs::write(folder.path().join("part.ron"), JOB.replace("tool: 0, ", "")).unwrap();
    folder
}

const OUTPUTS: [Output; 6] = [
    Output::Dexels,
    Output::Binary,
    Output::Tridexels,
    Output::Mesh,
    Output::Certificate,
    Output::Report,
];

fn request(folder: &Path) -> Request {
    let mut judging = Judging::default();
    judging.moves = true;
    Request::from_file(folder.join("part.ron"))
        .directions(Directions::Xyz)
        .outputs(OUTPUTS)
        .judging(judging)
}

/// All outputs but for times: of the page, which shows them, what is drawn.
fn judged(request: Request, threads: usize) -> (Outcome, Memory) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let outcome = request.plan().unwrap().run(&()).unwrap();
        let (mut memory, cut) = made(&outcome, &OUTPUTS);
        assert_eq!(cut, 0, "the solid is made of what was judged");
        let page = String::from_utf8(memory.0.remove("report.html").unwrap()).unwrap();
        let (_, drawn) = page.split_once(r#"id="arrays">"#).unwrap();
        let (drawn, _) = drawn.split_once("</script>").unwrap();
        memory.0.insert("report.html: arrays".into(), drawn.into());
        let report = memory.0.remove("report.json").unwrap();
        let mut report: serde_json::Value = serde_json::from_slice(&report).unwrap();
        report.as_object_mut().unwrap().remove("seconds").unwrap();
        memory.0.insert("report.json".into(), report.to_string().into_bytes());
        (outcome, memory)
    })
}

/// What a run with the cache leaves, after it has been compared with a run without it; and moves judged again.
fn same(folder: &Path, what: &str) -> ([usize; 2], Vec<String>, Outcome) {
    let (_, expected) = judged(request(folder), 2);
    same_as(&expected, folder, what)
}

fn same_as(expected: &Memory, folder: &Path, what: &str) -> ([usize; 2], Vec<String>, Outcome) {
    let (outcome, found) = judged(request(folder).cache(folder.join("cache")), 3);
    assert_eq!(found.0.len(), 8, "{:?}", found.0.keys());
    for (name, bytes) in &expected.0 {
        assert!(found.0[name] == *bytes, "{what}: {name} differs");
    }
    let reused = outcome.reused().unwrap();
    ([reused.again, reused.moves], reused.notes.clone(), outcome)
}

/// Programs that are changed again and again, anywhere: the same bytes, and as a rule less is judged.
#[test]
fn changed_programs_are_judged_as_without_a_cache() {
    let (mut less, mut verdicts) = (0, Vec::new());
    for seed in 0..2 {
        let (folder, random) = (folder(), &mut Random(seed));
        let mut lines = program(random);
        written(folder.path(), &lines);
        let ([again, moves], notes, _) = same(folder.path(), "at first");
        assert_eq!((again, notes), (moves, Vec::new()));
        let ([again, _], ..) = same(folder.path(), "unchanged");
        assert_eq!(again, 0);
        for change in 0..4 {
            let from = if change % 2 == 0 { 4 } else { lines.len() * 3 / 4 };
            let at = edit(&mut lines, random, from);
            written(folder.path(), &lines);
            let what = format!("seed {seed}, change {change} at line {at} of {}", lines.len());
            let ([again, moves], notes, outcome) = same(folder.path(), &what);
            assert_eq!(notes, Vec::<String>::new(), "{what}");
            verdicts.push(outcome.verdict());
            // A quarter of what follows, a run, and what a line is in moves.
            let after = lines.len() - at;
            assert!(again <= after * 5 / 4 + 40, "{what}: {again} of {moves}");
            less += usize::from(2 * again < moves);
        }
    }
    assert!(less >= 3, "{less}");
    assert!(verdicts.iter().any(|verdict| *verdict != verdicts[0]), "{verdicts:?}");
}

/// Whatever is wrong with the cache, the program is judged without it, and that is said.
#[test]
fn caches_that_cannot_be_used_are_ignored() {
    let folder = folder();
    let cache = folder.path().join("cache");
    written(folder.path(), &program(&mut Random(7)));
    let (_, expected) = judged(request(folder.path()), 2);
    let same = |what| same_as(&expected, folder.path(), what);
    same("at first");
    let files: Vec<_> = fs::read_dir(&cache)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    let [file] = &files[..] else { panic!("{files:?}") };
    let bytes = fs::read(file).unwrap();
    let other = |at: usize| {
        let mut other = bytes.clone();
        other[at] ^= 16;
        other
    };
    for (content, expected) in [
        (other(12), "was made by another version of sweepsim"),
        (other(bytes.len() / 2), "is damaged"),
        (other(bytes.len() - 1), "is damaged"),
        (bytes[..bytes.len() - 7].to_vec(), "is damaged"),
        (bytes[..30].to_vec(), "is damaged"),
        (Vec::new(), "is damaged"),
        (b"G0 X1".to_vec(), "is no cache"),
    ] {
        fs::write(file, content).unwrap();
        let ([again, moves], notes, _) = same(expected);
        assert_eq!((again, notes.len()), (moves, 1), "{notes:?}");
        assert!(notes[0].contains(expected), "{notes:?}");
        // It was written anew.
        assert_eq!(same("anew").0[0], 0);
    }
    fs::remove_dir_all(&cache).unwrap();
    fs::write(&cache, "no folder").unwrap();
    let ([again, moves], notes, _) = same("no folder");
    assert_eq!(again, moves);
    assert!(
        notes
            .iter()
            .any(|note| note.starts_with("the cache could not be written")),
        "{notes:?}"
    );
}

/// A tool that is used only late, and another stock.
#[test]
fn what_is_not_the_program_counts_from_where_it_is_used() {
    let folder = folder();
    written(folder.path(), &program(&mut Random(5)));
    same(folder.path(), "at first");
    let job = fs::read_to_string(folder.path().join("part.ron")).unwrap();
    let change = |from: &str, to: &str| {
        assert!(job.contains(from));
        fs::write(folder.path().join("part.ron"), job.replace(from, to)).unwrap();
        same(folder.path(), to).0
    };
    let [again, moves] = change("3: Flat(radius: 2.5,", "3: Flat(radius: 2.4,");
    assert!(again > 20 && 3 * again < moves, "{again} of {moves}");
    let [again, moves] = change("max: (40, 24, 1)", "max: (40, 24, 1.1)");
    assert_eq!(again, moves);
    let [again, moves] = change("gouge: 0.1", "gouge: 0.2");
    assert_eq!(again, moves);
    let [again, moves] = change("tolerance: 1e-5", "tolerance: 2e-5");
    assert_eq!(again, moves);
}

#[test]
fn a_cache_is_for_whole_verifications() {
    let folder = folder();
    written(folder.path(), &program(&mut Random(1)));
    let with = || request(folder.path()).cache(folder.path().join("cache"));
    let refused = |error: JobError| matches!(error, JobError::Request { field, .. } if field.starts_with("cache"));
    assert!(refused(with().task(Task::Simulate).plan().unwrap_err()));
    let mut first = Judging::default();
    first.first = true;
    assert!(refused(with().judging(first).plan().unwrap_err()));
    let shard = ShardNumber::new(0, 2).unwrap();
    assert!(refused(with().plan().unwrap().shard(shard, &()).unwrap_err()));
}

/// Is cancelled after so many questions.
struct Patience(std::sync::atomic::AtomicUsize);

impl sweepsim_job::Monitor for Patience {
    fn cancelled(&self) -> bool {
        use std::sync::atomic::Ordering::Relaxed;
        self.0
            .fetch_update(Relaxed, Relaxed, |left| Some(left.saturating_sub(1)))
            .unwrap()
            == 0
    }
}

/// A run that is interrupted leaves the cache as it was, and two at a time do each other no harm.
#[test]
fn the_file_is_replaced_as_a_whole() {
    let folder = folder();
    let mut lines = program(&mut Random(3));
    written(folder.path(), &lines);
    let with = || request(folder.path()).cache(folder.path().join("cache"));
    let listed = || -> Vec<(std::path::PathBuf, Vec<u8>)> {
        let entries = fs::read_dir(folder.path().join("cache")).into_iter().flatten();
        entries
            .map(|entry| entry.unwrap().path())
            .map(|file| (file.clone(), fs::read(file).unwrap()))
            .collect()
    };
    for questions in [1, 20, 100] {
        let found = with().plan().unwrap().run(&Patience(questions.into()));
        assert!(matches!(found, Err(JobError::Cancelled)), "{questions}");
        assert_eq!(listed(), []);
    }
    same(folder.path(), "at first");
    let before = listed();
    assert_eq!(before.len(), 1);
    edit(&mut lines, &mut Random(4), 4);
    written(folder.path(), &lines);
    assert!(with().plan().unwrap().run(&Patience(20.into())).is_err());
    assert!(listed() == before);
    std::thread::scope(|scope| {
        let [a, b] = [0, 1]
            .map(|_| scope.spawn(|| judged(with(), 1).1))
            .map(|run| run.join().unwrap());
        assert!(a.0 == b.0);
    });
    assert_eq!(listed().len(), 1);
    assert_eq!(same(folder.path(), "after both").0[0], 0);
}
