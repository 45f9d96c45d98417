//! Faults planted in the text of programs, judged by brute force.
//!
//! A program is a list of blocks, from which its text is written, word by word as far as they change, and from which
//! the judge places cylinders at dense times. The judge knows nothing of the reader, the job or the lines.

use crate::support::{Workdir, text};
use by_force::{Case, Cylinder, STEPS, box_mesh, pose};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use sweepsim::verify::{FindingKind, MoveState};
use sweepsim_formats::Report;

#[path = "../../../../sweepsim/tests/it/verify/by_force.rs"]
#[expect(dead_code, reason = "only the judge is used")]
mod by_force;

/// SplitMix64.
struct Random(u64);

impl Random {
    fn within(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        let share = ((z ^ z >> 31) >> 11) as f64 / (1_u64 << 53) as f64;
        // As a program writes it.
        ((low + (high - low) * share) * 100.0).round() / 100.0
    }
}

/// A block of a program: where the tip goes, and how.
#[derive(Clone, Copy)]
struct Block {
    rapid: bool,
    /// X, Y, Z, A.
    words: [f64; 4],
    inches: bool,
    spindle_stopped: bool,
}

/// All blocks of a tool, which is called by a number.
#[derive(Clone)]
struct Section {
    tool: usize,
    blocks: Vec<Block>,
    /// The number after H; none without G43.
    offset: Option<usize>,
}

struct Program {
    /// Of both tools.
    cutters: [Cylinder; 2],
    holders: [Cylinder; 2],
    /// What G43 adds.
    lengths: [f64; 2],
    sections: [Section; 2],
    stock: [[f64; 3]; 2],
    clamp: [[f64; 3]; 2],
    target: ([[f64; 3]; 2], f64),
}

const NAMES: [char; 4] = ['X', 'Y', 'Z', 'A'];

/// Clears the top of a block in rows, upright or tilted by A, then cuts a groove with a thinner tool: nothing is wrong
/// with it.
fn clean(seed: u64) -> Program {
    let random = &mut Random(seed.wrapping_mul(0x1234_5678_9ABC_DEF1));
    let tilt = if seed.is_multiple_of(2) {
        random.within(2.0, 9.0)
    } else {
        0.0
    };
    let radii = [random.within(2.2, 3.4), random.within(1.2, 1.8)];
    let cutters = radii.map(|radius| Cylinder { radius, z: [0.0, 14.0] });
    let holders = radii.map(|radius| Cylinder {
        radius: radius + 2.5,
        z: [15.0, 40.0],
    });
    let block = |rapid, x, y, z, a| Block {
        rapid,
        words: [x, y, z, a],
        inches: false,
        spindle_stopped: false,
    };
    let floor = -random.within(1.0, 2.5);
    // A tilted flat end digs below its tip.
    let height = floor + (radii[0] * tilt.to_radians().sin() * 100.0).ceil() / 100.0;
    let mut rows = Vec::new();
    let mut y = -7.0;
    while y < 7.6 {
        rows.extend([
            block(true, -15.5, y, 7.0, tilt),
            block(true, -15.5, y, height + 1.0, tilt),
            block(false, -15.5, y, height, tilt),
            block(false, 15.5, y, height, tilt),
            block(true, 15.5, y, 7.0, tilt),
        ]);
        y += random.within(1.5, 2.0 * radii[0] * 0.9);
    }
    let depth = floor - random.within(0.5, 1.5);
    let groove = vec![
        block(true, -14.5, 0.5, 7.0, 0.0),
        block(true, -14.5, 0.5, depth, 0.0),
        block(false, 14.5, 0.5, depth, 0.0),
        block(true, 14.5, 0.5, 7.0, 0.0),
        block(true, 0.0, 0.5, 7.0, 0.0),
        block(true, 0.0, 0.5, depth + 0.5, 0.0),
        block(false, 0.0, 0.5, depth - 0.4, 0.0),
        block(true, 0.0, 0.5, 7.0, 0.0),
    ];
    let section = |tool, blocks| Section {
        tool,
        blocks,
        offset: Some(tool),
    };
    Program {
        cutters,
        holders,
        lengths: [random.within(2.0, 4.0), random.within(3.0, 6.0)],
        sections: [section(0, rows), section(1, groove)],
        stock: [[-10.0, -8.0, -6.0], [10.0, 8.0, 0.0]],
        clamp: [[-21.5, -3.0, -6.0], [-20.2, 3.0, 3.0]],
        target: ([[-10.0, -8.0, -6.0], [10.0, 8.0, depth - 0.5]], 0.05),
    }
}

const FAULTS: u64 = 10;

fn plant(program: &mut Program, fault: u64, seed: u64) {
    let random = &mut Random(seed.wrapping_mul(0xA076_1D64_78BD_642F));
    let one = usize::from(random.within(0.0, 1.0) > 0.7);
    let blocks = &mut program.sections[one].blocks;
    let feeds: Vec<usize> = (1..blocks.len()).filter(|n| !blocks[*n].rapid).collect();
    let at = feeds[((random.within(0.0, 1.0) * feeds.len() as f64) as usize).min(feeds.len() - 1)];
    match fault {
        // A rapid one block too early.
        0 => blocks[at].rapid = true,
        // A longer holder, or a shorter tool.
        1 => program.holders[one].z[0] -= random.within(13.0, 14.5),
        // A clamp in the way.
        2 => program.clamp = [[-14.0, -4.0, -6.0], [-11.0, 4.0, 1.0]],
        // A digit of a coordinate.
        3 => blocks[at].words[2] -= [1.0, 3.0, 5.0][(random.within(0.0, 2.99)) as usize],
        // The sign of A, or an A where there should be none.
        4 => {
            let tilted = blocks[at].words[3] != 0.0 && random.within(0.0, 1.0) < 0.5;
            if tilted {
                blocks[at].words[3] *= -1.0;
            } else {
                program.sections[1].blocks[2].words[3] = random.within(32.0, 45.0);
            }
        }
        // The other tool, with the offset of this one.
        5 => program.sections[one].tool = 1 - one,
        6 => program.sections[one].offset = None,
        7 => blocks[at].inches = true,
        // M5 too early.
        8 => blocks[at].spindle_stopped = true,
        // A thicker blank.
        _ => program.stock[1][2] += random.within(2.0, 9.0),
    }
}

impl Program {
    /// The text, and the line of each move by tool and number.
    fn text(&self) -> (String, BTreeMap<usize, (usize, usize)>) {
        let mut out = "G21 G90 G17 G40 G49 G80\n".to_owned();
        for (n, length) in self.lengths.iter().enumerate() {
            let _ = writeln!(out, "G10 L1 P{} Z{length:.2}", n + 1);
        }
        let mut lines = BTreeMap::new();
        for (n, section) in self.sections.iter().enumerate() {
            let number = section.tool + 1;
            let _ = write!(out, "T{number} M6\nS5000 M3\nF400\n");
            if let Some(offset) = section.offset {
                let _ = writeln!(out, "G43 H{}", offset + 1);
            }
            out += "M428\n";
            let (mut last, mut stopped) = ([f64::NAN; 4], false);
            for (k, block) in section.blocks.iter().enumerate() {
                if block.spindle_stopped != stopped {
                    stopped = block.spindle_stopped;
                    out += if stopped { "M5\n" } else { "S5000 M3\n" };
                }
                if block.inches {
                    out += "G20\n";
                }
                out += if block.rapid { "G0" } else { "G1" };
                for (word, name) in NAMES.iter().enumerate() {
                    if block.words[word] != last[word] {
                        let _ = write!(out, " {name}{:.2}", block.words[word]);
                    }
                }
                out.push('\n');
                if k > 0 {
                    lines.insert(out.lines().count(), (n, k - 1));
                }
                if block.inches {
                    out += "G21\n";
                }
                last = block.words;
            }
            out += "G49\n";
        }
        (out + "M30\n", lines)
    }

    /// What the judge knows.
    fn cases(&self) -> Vec<Case> {
        let case = |section: &Section| {
            let (mut poses, mut states) = (Vec::new(), Vec::new());
            let (mut place, mut last) = ([0.0; 4], [f64::NAN; 4]);
            for block in &section.blocks {
                for k in 0..4 {
                    if block.words[k] != last[k] {
                        // Angles have no unit of length.
                        place[k] = block.words[k] * if block.inches && k < 3 { 25.4 } else { 1.0 };
                    }
                }
                last = block.words;
                let lower = self.lengths[section.tool] - section.offset.map_or(0.0, |offset| self.lengths[offset]);
                let (sin, cos) = place[3].to_radians().sin_cos();
                poses.push(pose([place[0], place[1], place[2] - lower], [0.0, sin, cos]));
                let state = if block.rapid { MoveState::RAPID } else { MoveState::FEED };
                states.push(state.with_spindle_stopped(block.spindle_stopped));
            }
            states.remove(0);
            Case {
                cutter: self.cutters[section.tool],
                holder: self.holders[section.tool],
                poses,
                moves: Vec::new(),
                states,
                stock: self.stock,
                clamp: Some(self.clamp),
                target: Some(self.target),
            }
        };
        self.sections.iter().map(case).collect()
    }

    fn job(&self) -> String {
        let block = |[min, max]: [[f64; 3]; 2]| format!("Block(min: {}, max: {})", triple(min), triple(max));
        let [min, max] = self.stock;
        let outline = |solid: &Cylinder| {
            let ([low, high], r) = (solid.z, solid.radius);
            format!(
                "Profile(start: (0, {low:?}), segments: [Line(({r:?}, {low:?})), Line(({r:?}, {high:?})), Line((0, {high:?}))])"
            )
        };
        let numbered = |make: &dyn Fn(usize) -> String| format!("{{1: {}, 2: {}}}", make(0), make(1));
        format!(
            "Job(
    grid: Grid(min: ({:?}, {:?}), max: ({:?}, {:?}), cells: (23, 19)),
    stock: {},
    tools: {},
    bodies: {},
    fixtures: [{}],
    paths: [Path(file: \"part.nc\")],
    target: Mesh(\"part.stl\"),
    limits: Limits(gouge: {:?}, excess: 100),
)",
            min[0],
            min[1],
            max[0],
            max[1],
            block(self.stock),
            numbered(&|n| outline(&self.cutters[n])),
            numbered(&|n| format!("[Holder({})]", outline(&self.holders[n]))),
            block(self.clamp),
            self.target.1,
        )
    }

    /// Runs `verify`, and judges what it finds; the number of findings that must be there. The judge's lines are along
    /// z: of other lines, too, nothing may be missed or late, but more may be found, and earlier.
    fn check(&self, name: &str) -> usize {
        self.check_on_lines(name, false);
        self.check_on_lines(name, true)
    }

    fn check_on_lines(&self, name: &str, along_z: bool) -> usize {
        let (program, lines) = self.text();
        let workdir = Workdir::new(&self.job());
        fs::write(workdir.path("part.nc"), &program).expect("a file");
        let mut mesh = "solid part\n".to_owned();
        for corners in box_mesh(self.target.0).triangles {
            mesh += "facet normal 0 0 0\nouter loop\n";
            for [x, y, z] in corners {
                let _ = writeln!(mesh, "vertex {x:?} {y:?} {z:?}");
            }
            mesh += "endloop\nendfacet\n";
        }
        fs::write(workdir.path("part.stl"), mesh + "endsolid part\n").expect("a file");
        let mut options = vec!["--only", "report", "--moments", "0"];
        if along_z {
            options.extend(["--directions", "z"]);
        }
        let output = workdir.run_job("verify", &options);
        let told = || format!("{name}: {}{}\n{program}", text(&output.stdout), text(&output.stderr));
        assert!(matches!(output.status.code(), Some(0 | 1)), "{}", told());
        let report = fs::read(workdir.path("out/report.json")).expect("a report");
        let report: Report = serde_json::from_slice(&report).expect("a report");
        assert!(report.dexels.unresolved.is_empty(), "{}", told());
        let mut found = BTreeMap::new();
        for finding in report.findings.expect("findings") {
            // The judge looks at lines, and knows nothing of what is between them: that it is in the target, or in the
            // stock, is certain.
            if finding.between {
                let ([min, max], limit) = match finding.kind.as_str() {
                    "gouge" => self.target,
                    _ => (self.stock, 0.0),
                };
                let depths = (0..3).flat_map(|k| [finding.place[k] - min[k], max[k] - finding.place[k]]);
                let depth = depths.fold(f64::INFINITY, f64::min);
                assert!(depth > limit && depth >= finding.depth, "{}", told());
                continue;
            }
            // The judge goes straight.
            if finding.courses.as_deref() == Some("dog-leg") {
                continue;
            }
            let kind = match finding.kind.as_str() {
                "collision" => FindingKind::Collision,
                "rapid" => FindingKind::Rapid,
                "fixture" => FindingKind::Fixture,
                "gouge" => FindingKind::Gouge,
                "spindle" => FindingKind::Spindle,
                other => panic!("{other}: {}", told()),
            };
            let line = finding.line.expect("a line");
            assert_eq!(finding.text.as_deref(), program.lines().nth(line - 1), "{name}");
            let (case, number) = *lines.get(&line).unwrap_or_else(|| panic!("line {line}: {}", told()));
            assert_eq!(finding.tool, Some(self.sections[case].tool as u32 + 1), "{name}");
            let body = finding.body.map(|_| 0);
            found.insert((case, (kind, number, body)), finding.time.expect("a time"));
        }
        let cases = self.cases();
        let (sure, possible) = (Case::by_force(&cases, true), Case::by_force(&cases, false));
        let step = 1.0 / STEPS as f64;
        for (key, time) in &sure {
            let own = found
                .get(key)
                .unwrap_or_else(|| panic!("{key:?} is missed: {}", told()));
            assert!(*own <= time + step, "{key:?} is late, {own} and not {time}: {}", told());
        }
        for (key, time) in found.iter().filter(|_| along_z) {
            let first = possible
                .get(key)
                .unwrap_or_else(|| panic!("{key:?} is invented: {}", told()));
            assert!(
                *time >= first - step,
                "{key:?} is early, {time} and not {first}: {}",
                told()
            );
        }
        sure.len()
    }
}

fn triple([x, y, z]: [f64; 3]) -> String {
    format!("({x:?}, {y:?}, {z:?})")
}

/// Programs without a fault, and with one of each kind in turn; at least `least` findings of each kind of fault must be
/// certain.
fn judged(seeds: std::ops::Range<u64>, least: usize) {
    let mut sure = [0; FAULTS as usize];
    for seed in seeds {
        let mut program = clean(seed / FAULTS);
        let fault = seed % FAULTS;
        if fault == 0 {
            assert_eq!(program.check(&format!("seed {seed}, no fault")), 0);
        }
        plant(&mut program, fault, seed);
        sure[fault as usize] += program.check(&format!("seed {seed}, fault {fault}"));
    }
    assert!(sure.iter().all(|sure| *sure >= least), "{sure:?}");
}

#[test]
fn faults_in_the_text_of_programs() {
    judged(6..7, 0);
}

#[test]
#[ignore = "takes minutes"]
fn many_faults_in_the_text_of_programs() {
    judged(0..220, 2);
}
