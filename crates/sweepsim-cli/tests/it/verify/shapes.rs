//! Tools that are not round.

use super::verified;
use crate::support::Workdir;
use std::fs;
use sweepsim_formats::{Statement, StatementState};

/// A square cutter, 12 mm high, with corners 2 mm from its axis, along x and y: the six faces of a block.
fn cutter() -> String {
    let at = |[a, b, c]: [i32; 3]| format!("({}, {}, {})", 2 * (a - b), 2 * (a + b - 1), 12 * c);
    let face = |[p, q, r, s]: [[i32; 3]; 4]| {
        let [p, q, r, s] = [p, q, r, s].map(at);
        format!("Surface(degrees: (1, 1), knots: ([0, 0, 1, 1], [0, 0, 1, 1]), points: [[{p}, {q}], [{r}, {s}]])")
    };
    let faces = [
        [[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0]],
        [[0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]],
        [[0, 0, 0], [1, 0, 0], [0, 0, 1], [1, 0, 1]],
        [[1, 0, 0], [1, 1, 0], [1, 0, 1], [1, 1, 1]],
        [[1, 1, 0], [0, 1, 0], [1, 1, 1], [0, 1, 1]],
        [[0, 1, 0], [0, 0, 0], [0, 1, 1], [0, 0, 1]],
    ];
    format!("Surfaces(surfaces: [{}])", faces.map(face).join(", "))
}

fn job(more: &str) -> String {
    format!(
        "Job(
    grid: Grid(min: (-5, -5), max: (5, 5), cells: (40, 40)),
    stock: Block(min: (-5, -5, 0), max: (5, 5, 4)),
    tools: {{ 1: Surface(\"cutter.ron\") }},
    paths: [Path(tool: 1, poses: [((-9, 0, 2), (0, 0, 1)), ((9, 0, 2), (0, 0, 1))])],
    {more}
)"
    )
}

/// On both sides of a slot, only the corners of the cutter have cut, and a round tool with them goes no deeper.
#[test]
fn what_corners_alone_have_cut_is_not_known() {
    let folder = Workdir::new(&job(""));
    fs::write(folder.path("cutter.ron"), cutter()).expect("a file");
    folder.good(&["simulate", "job.ron", "--only", "mesh", "--out", "."]);
    let limits = "target: Mesh(\"part.ply\"), limits: Limits(gouge: 0.05, excess: 0.05),";
    fs::write(folder.path("job.ron"), job(limits)).expect("a file");
    let (report, findings) = verified(&folder, 3, &[]);
    assert_eq!(findings, []);
    let statements = report.statements.expect("statements");
    let of = |about: &str| -> &Statement {
        let own = statements.iter().find(|own| own.about == about);
        own.expect("a statement")
    };
    assert_eq!(
        (of("gouge").state, &of("gouge").reason),
        (StatementState::Proven, &None)
    );
    let reason = "of tools that are not round, only what a round tool within them removes is known to be removed: 1";
    assert_eq!(
        (of("excess").state, of("excess").reason.as_deref()),
        (StatementState::Open, Some(reason))
    );
    assert!(
        of("excess")
            .open
            .iter()
            .all(|place| place.r#box[1].abs() > 1.4 && place.r#box[4].abs() > 1.4)
    );
}
