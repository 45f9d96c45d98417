//! Random programs on ready machines with bodies, judged by positions that are close in time.
//!
//! The judge has its own chain of turns and shifts, its own points of the stock, and its own distance of convex hulls:
//! their closest points by the steps of M. Frank and P. Wolfe (1956), which bound it from both sides.

use super::judge::Judge;
use super::{SIZES, run};
use std::fmt::Write;
use sweepsim_job::StatementState;
use sweepsim_nc::Machine;

const MACHINES: [&str; 6] = [
    "3-axis",
    "rotary-a",
    "trunnion-ac",
    "trunnion-bc",
    "head-bc",
    "head-b-table-c",
];
/// Steps of the judge in each move.
const STEPS: usize = 60;

/// Numbers of no pattern.
struct Random(u64);

impl Random {
    fn within(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((self.0 >> 11) as f64 / (1_u64 << 53) as f64)
    }
}

/// Compares the first contact of each pair with what the judge sees. Returns how many programs had one, and how many
/// had none.
fn compare(programs: u64) -> [usize; 2] {
    let stock = [[-40.0, -30.0, -50.0], [40.0, 30.0, 0.0]];
    let mut counts = [0; 2];
    for number in 0..programs {
        let mut random = Random(number + 1);
        let name = MACHINES[number as usize % MACHINES.len()];
        let full = format!("{name}{SIZES}");
        let machine = Machine::named(&full).expect("a machine").kinematics.expect("axes");
        let machine = machine.description();
        let judge = Judge::new(machine, stock, 5.0, 60.0);
        let letters: Vec<char> = machine
            .table
            .iter()
            .chain(&machine.head)
            .map(|axis| axis.letter)
            .collect();
        // Moves in a room that is safe, or not quite.
        let deep = if number % 2 == 0 { 60.0 } else { -140.0 };
        let mut at = [[0.0, 0.0, 300.0], [0.0; 3]];
        let mut program = "G21 G90\nT1 M6\nS1000 M3\nG1 X0 Y0 Z300 F5000\n".to_owned();
        let mut moves = Vec::new();
        for _ in 0..12 {
            let mut to = at;
            match random.within(0.0, 3.0) as usize {
                0 if !letters.is_empty() => {
                    let letter = letters[random.within(0.0, letters.len() as f64) as usize];
                    let most = if letter == 'C' { 360.0 } else { 110.0 };
                    to[1][letter as usize - 'A' as usize] = random.within(-most, most).round();
                }
                1 => to[0][2] = random.within(deep, 300.0).round(),
                _ => {
                    to[0] = [
                        random.within(-250.0, 250.0).round(),
                        random.within(-200.0, 200.0).round(),
                        to[0][2],
                    ]
                }
            }
            write!(program, "G1 X{} Y{} Z{}", to[0][0], to[0][1], to[0][2]).unwrap();
            for letter in &letters {
                write!(program, " {letter}{}", to[1][*letter as usize - 'A' as usize]).unwrap();
            }
            program.push('\n');
            moves.push((5 + moves.len(), at, to));
            at = to;
        }
        program += "M30\n";
        let outcome = run(&full, &program, stock);
        let statements = outcome.report().statements.as_ref().expect("proofs").iter();
        let statement = { statements }
            .find(|statement| statement.about == "machine")
            .expect("bodies");
        let found: Vec<(String, usize)> = outcome
            .findings()
            .iter()
            .filter(|finding| finding.kind == "machine")
            .map(|finding| (finding.detail.clone().expect("names"), finding.line.expect("a line")))
            .collect();
        let at = |from: [[f64; 3]; 2], to: [[f64; 3]; 2], s: f64| {
            [0, 1].map(|n| [0, 1, 2].map(|k| from[n][k] + s * (to[n][k] - from[n][k])))
        };
        // What is left of the stock before each move, and in the end.
        let mut left = vec![judge.points_of_stock(stock)];
        for (_, from, to) in &moves {
            let mut points = left.last().expect("points").clone();
            judge.cut(
                &mut points,
                (0..=STEPS).map(|k| at(*from, *to, k as f64 / STEPS as f64)),
                5.0,
                60.0,
            );
            left.push(points);
        }
        let mut touched = 0;
        for pair in judge.pairs() {
            let is_stock = judge.is_stock(pair);
            let other = if is_stock { "stock" } else { &judge.hulls[pair.1].name };
            let names = format!("{} meets {other}", judge.hulls[pair.0].name);
            let first = moves.iter().enumerate().find_map(|(number, (line, from, to))| {
                (0..=STEPS).find_map(|k| {
                    let at = at(*from, *to, k as f64 / STEPS as f64);
                    let is_met = judge.apart(pair, at)[1] < 0.05;
                    // Of the stock, what is left when the move has ended.
                    let is_met = is_met && (!is_stock || judge.nearest(pair.0, &left[number + 1], at) < 0.05);
                    is_met.then_some(*line)
                })
            });
            let own = found.iter().find(|(detail, _)| detail.starts_with(&names));
            match (first, own) {
                (Some(line), Some((_, said))) => {
                    // A contact between its times may be earlier.
                    assert!(
                        *said <= line,
                        "{name} {number}: {names} in line {said}, not {line}\n{program}"
                    );
                    touched += 1;
                }
                (Some(line), None) => panic!("{name} {number}: {names} in line {line} is not found\n{program}"),
                (None, Some((_, said))) => {
                    // Nearer than a few millimetres at a time of the judge, if not in contact.
                    let (number_of, (_, from, to)) = moves
                        .iter()
                        .enumerate()
                        .find(|(_, (line, ..))| line == said)
                        .expect("a move");
                    let times = (0..=2000).map(|k| at(*from, *to, f64::from(k) / 2000.0));
                    let least = times
                        .clone()
                        .map(|at| judge.apart(pair, at)[0])
                        .fold(f64::INFINITY, f64::min);
                    assert!(
                        least < 0.5,
                        "{name} {number}: {names} in line {said}, {least} mm apart\n{program}"
                    );
                    // And, of the stock, nearer to one of its points than these are to each other.
                    let near = || {
                        times
                            .step_by(20)
                            .map(|at| judge.nearest(pair.0, &left[number_of], at))
                            .fold(f64::INFINITY, f64::min)
                    };
                    assert!(
                        !is_stock || near() < 5.0,
                        "{name} {number}: {names} in line {said}: nothing is left\n{program}"
                    );
                }
                (None, None) => {}
            }
        }
        match statement.state {
            StatementState::Refuted => assert!(!found.is_empty()),
            StatementState::Proven => assert_eq!((touched, found.len()), (0, 0)),
            _ => panic!("{name} {number}: {:?}\n{program}", statement.reason),
        }
        counts[usize::from(found.is_empty())] += 1;
    }
    counts
}

#[test]
fn crashes_are_found_at_their_lines() {
    let [crashed, right] = compare(14);
    assert!(crashed > 3 && right > 3, "{crashed} {right}");
}

#[test]
#[ignore = "takes minutes"]
fn crashes_of_many_programs_are_found_at_their_lines() {
    let [crashed, right] = compare(400);
    println!("{crashed} programs with a collision, {right} without");
    assert!(crashed > 100 && right > 100, "{crashed} {right}");
}
