//! Dexels along x and y that a program was judged on are those of the solid: nothing is simulated a second time.

use crate::walls::{request, slotted};
use std::path::PathBuf;
use std::sync::Mutex;
use sweepsim_job::dexel::{Interval, Source, TriDexels};
use sweepsim_job::{Directions, Judging, Memory, Monitor, Outcome, Output, Request, ShardNumber, Task};

/// Which phases there were.
#[derive(Default)]
struct Phases(Mutex<Vec<&'static str>>);

impl Monitor for Phases {
    fn phase(&self, name: &'static str) {
        self.0.lock().unwrap().push(name);
    }

    fn advance(&self, _: usize, _: usize) {}

    fn cancelled(&self) -> bool {
        false
    }
}

impl Phases {
    /// How often dexels were cut or judged along x, or along y.
    fn aside(self) -> usize {
        let names = self.0.into_inner().unwrap();
        let [x, y] = ["along x", "along y"].map(|name| names.iter().filter(|own| **own == name).count());
        assert_eq!(x, y);
        x
    }
}

fn run(request: Request) -> (Outcome, usize) {
    let phases = Phases::default();
    let outcome = request.plan().unwrap().run(&phases).unwrap();
    (outcome, phases.aside())
}

/// Some outputs, and how often dexels along x and y were made for them.
pub fn made(outcome: &Outcome, outputs: &[Output]) -> (Memory, usize) {
    let (mut memory, phases) = (Memory::default(), Phases::default());
    outcome.write_to(&mut memory, outputs, &phases).unwrap();
    (memory, phases.aside())
}

/// The solid of a run, and how often dexels along x and y were made on the way: by judging, and after it.
fn solid(request: Request) -> (TriDexels, [usize; 2]) {
    let (outcome, judged) = run(request);
    let (memory, cut) = made(&outcome, &[Output::Tridexels]);
    let solid = sweepsim_formats::read_tri_dexels(&mut &memory.0["part.tridexels"][..]).unwrap();
    (solid, [judged, cut])
}

fn fixture(name: &str) -> PathBuf {
    PathBuf::from(format!("{}/../../fixtures/{name}", env!("CARGO_MANIFEST_DIR")))
}

fn without_proof() -> Judging {
    let mut judging = Judging::default();
    judging.proof = false;
    judging
}

/// Two pockets from opposite sides, with the table below the first and a clamp on the second.
const SETUPS: &str = "Job(
    grid: Grid(min: (-20, -15), max: (20, 15), cells: (40, 30)),
    stock: Block(min: (-20, -15, -12), max: (20, 15, 0)),
    tools: { 1: Flat(radius: 3, length: 20) },
    setups: [
        Setup(
            paths: [Path(tool: 1, poses: [((-10, 0, 2), (0, 0, 1)), ((-10, 0, -3), (0, 0, 1)), ((10, 1, -3), (0, 0, 1))])],
            fixtures: [Block(min: (-30, -30, -20), max: (30, 30, -12))],
        ),
        Setup(
            frame: Frame(origin: (0, 0, -12), z: (0, 0, -1), x: (1, 0, 0)),
            paths: [Path(tool: 1, poses: [((-9, 2, 2), (0, 0, 1)), ((-9, 2, -4), (0, 0, 1)), ((9, 0, -4), (0.2, 0, 1))])],
            fixtures: [Block(min: (-4, -15, -17), max: (4, 15, -12))],
        ),
    ],
)";

/// The oracle is `simulate`, which cuts all moves of a path at once, and no dexels but those of the solid.
#[test]
fn what_was_judged_is_what_would_be_cut() {
    let jobs = [
        // Slots that meet in a plane, within a thousandth of the tolerance.
        (Request::from_file(fixture("jobs/quickstart.ron")), 1e-6),
        (
            Request::from_file(fixture("verify/bracket-faulty.ron")).cells([100, 60]),
            1e-6,
        ),
        (Request::from_file(fixture("jobs/motions.ron")).cells([60, 60]), 1e-6),
        (Request::from_file(fixture("jobs/impeller.ron")).cells([40, 40]), 1e-6),
        (Request::from_job("setups.ron", SETUPS), 1e-6),
    ];
    for (request, tolerance) in jobs {
        let request = request.directions(Directions::Xyz).judging(without_proof());
        let (judged, times) = solid(request.clone().task(Task::Verify));
        assert_eq!(times, [1, 0], "judged, and used");
        let (cut, times) = solid(request.task(Task::Simulate));
        assert_eq!(times, [0, 1], "cut");
        let mut by_tools = [0; 3];
        for ((judged, cut), by_tools) in judged.sets().iter().zip(cut.sets()).zip(&mut by_tools) {
            assert_eq!(judged.grid(), cut.grid());
            for ((number, judged), (_, cut)) in judged.iter().zip(cut.iter()) {
                let intervals = [judged, cut].map(|line| line.iter().collect::<Vec<Interval>>());
                let [a, b] = &intervals;
                assert_eq!(a.len(), b.len(), "line {number}: {intervals:?}");
                for (a, b) in a
                    .iter()
                    .zip(b)
                    .flat_map(|(a, b)| [(a.lower, b.lower), (a.upper, b.upper)])
                {
                    assert!((a.z - b.z).abs() <= tolerance, "line {number}: {a:?} {b:?}");
                    assert!((0..3).all(|k| (a.normal[k] - b.normal[k]).abs() < 0.01), "{a:?} {b:?}");
                    // Of several moves that leave the same surface, either may be named.
                    let [is_cut, other] = [a, b].map(|end| end.source != Source::Stock);
                    assert_eq!(is_cut, other, "line {number}: {a:?} {b:?}");
                    *by_tools += usize::from(is_cut);
                }
            }
        }
        assert!(by_tools.iter().all(|count| *count > 100), "{by_tools:?}");
    }
}

/// Whether a page has the surface of the part, and how often dexels along x and y were made for it.
fn drawn(request: Request) -> (bool, [usize; 2]) {
    let (outcome, judged) = run(request);
    let (memory, cut) = made(&outcome, &[Output::Report]);
    let page = String::from_utf8(memory.0["report.html"].clone()).unwrap();
    let [sharp, ragged] = ["\"surface\":{", "\"surface\":null"].map(|words| page.contains(words));
    assert_ne!(sharp, ragged);
    (sharp, [judged, cut])
}

#[test]
fn the_page_alone_has_the_walls_that_were_judged() {
    let right = || request(slotted([15.0, 25.0], -4.0)).judging(without_proof());
    assert_eq!(drawn(right()), (true, [1, 0]));
    // Not known: the page is not worth a simulation.
    assert_eq!(drawn(right().directions(Directions::Z)), (false, [0, 0]));
    assert_eq!(drawn(right().task(Task::Simulate)), (false, [0, 0]));
    // A finding at which the judging ends: what is left is not the part.
    let mut first = without_proof();
    first.first = true;
    let faulty = || request(slotted([15.1, 25.0], -4.0)).directions(Directions::Xyz);
    assert_eq!(drawn(faulty().judging(first)), (false, [1, 0]));
    assert_eq!(drawn(faulty().judging(without_proof())), (true, [1, 0]));
    // A tall part is looked at on fewer lines along x and y than the solid has.
    let mut tall = slotted([15.0, 25.0], -4.0);
    for corner in tall.triangles.iter_mut().flatten() {
        corner[2] = if corner[2] < -9.0 { -60.0 } else { corner[2] };
    }
    let stock = sweepsim_job::dexel::Stock::Block {
        min: [0.0, 0.0, -60.0],
        max: [60.0, 40.0, 0.0],
    };
    let tall = request(tall).stock(stock).judging(without_proof());
    assert_eq!(drawn(tall.clone()), (false, [1, 0]));
    let (outcome, _) = run(tall);
    assert_eq!(made(&outcome, &[Output::Mesh]).1, 1, "those of the mesh are cut");
}

/// Shards do not cut what they have judged.
#[test]
fn a_shard_makes_each_dexel_once() {
    let dexels = |directions: Directions, outputs: &[Output]| {
        let request = Request::from_file(fixture("verify/bracket.ron")).cells([40, 24]);
        let request = request.directions(directions).judging(without_proof());
        let plan = request.outputs(outputs.iter().copied()).plan().unwrap();
        plan.shard(ShardNumber::new(0, 1).unwrap(), &()).unwrap().dexels()
    };
    let all = [Output::Report, Output::Mesh, Output::Tridexels];
    let aside = dexels(Directions::Xyz, &all[..1]) - dexels(Directions::Z, &all[..1]);
    assert!(aside > 500, "{aside}");
    assert_eq!(dexels(Directions::Xyz, &all), dexels(Directions::Xyz, &all[..1]));
}

/// The dexels along x and y would be those of the whole program.
#[test]
fn what_was_followed_to_its_first_finding_has_no_solid() {
    let request = |first: bool| {
        let mut judging = without_proof();
        judging.first = first;
        let request = Request::from_file(fixture("verify/bracket-faulty.ron")).cells([100, 60]);
        request.directions(Directions::Xyz).judging(judging)
    };
    let outputs = [Output::Tridexels, Output::Mesh, Output::Step];
    for (first, names) in [
        (true, &["part.ply"][..]),
        (false, &["part.ply", "part.step", "part.tridexels"]),
    ] {
        let (outcome, _) = run(request(first));
        let (memory, cut) = made(&outcome, &outputs);
        assert!(memory.0.keys().eq(names), "{:?}", memory.0.keys());
        assert_eq!(cut, 0);
        let written = outcome.write_to(&mut Memory::default(), &outputs, &()).unwrap();
        let is_said = |note: &String| note.contains("its first finding");
        assert_eq!(written.report.notes.iter().any(is_said), first);
        // The surface is that of the dexels: a grid of 1 mm is off by some hundredth at walls.
        let [own, dexels] = [
            outcome.mesh(&()).unwrap().soup().unwrap().volume(),
            outcome.part().volume(),
        ];
        assert!((own - dexels).abs() < 0.03 * dexels, "{own} beside {dexels}");
    }
}
