//! Rows of six numbers without a header: the tip and the direction of the axis.

use sweepsim_motion::Pose;

use crate::model::names::Format;
use crate::model::program::{Note, Program, ProgramPose};
use crate::text::error::{NcError, NcProblem, TextPosition};

/// Reads rows `x y z i j k`, separated by white space, commas or semicolons. `None` if the first one does not have six numbers.
pub(crate) fn read(text: &str, unit: f64) -> Option<Result<Program, NcError>> {
    let rows = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let mut program = Program {
        format: Some(Format::Rows),
        ..Program::default()
    };
    for (index, line) in rows {
        let words: Vec<&str> = line
            .split(|c: char| c.is_whitespace() || matches!(c, ',' | ';'))
            .filter(|word| !word.is_empty())
            .collect();
        if program.poses.is_empty() && words.len() != 6 {
            return None;
        }
        let fail = |problem| {
            let position = TextPosition::in_line(index + 1, line, 1, line.chars().count());
            Some(Err(NcError::new(problem, Some(position))))
        };
        let numbers: Vec<f64> = words.iter().filter_map(|word| word.parse().ok()).collect();
        let (Ok([x, y, z, i, j, k]), 6) = (<[f64; 6]>::try_from(numbers), words.len()) else {
            let found = format!("{:?}", line.trim().chars().take(60).collect::<String>());
            return fail(NcProblem::value("a row", found, "six numbers, as in the first row"));
        };
        let pose = match Pose::new([x, y, z].map(|c| c * unit), [i, j, k]) {
            Ok(pose) => pose,
            Err(error) => return fail(NcProblem::Pose(error)),
        };
        if program.poses.last().is_some_and(|last| last.pose == pose) {
            continue;
        }
        let mut made = ProgramPose::new(pose, index + 1);
        made.joined = !program.poses.is_empty();
        program.poses.push(made);
    }
    let note = "rows of six numbers without a header: taken as the tip and the direction of the axis";
    program.notes.push(Note::new(program.poses.first()?.line, note));
    Some(Ok(program))
}
