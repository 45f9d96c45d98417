//! Running a program block by block, problems and endless loops included.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::PathBuf;

use crate::drive::Track;
use crate::model::read_options::ReadOptions;
use crate::text::error::{Located, NcError, NcProblem};

/// Finds the text of a subprogram by its name in capitals, with the file it came from.
pub type Library<'a> = &'a dyn Fn(&str) -> Option<(PathBuf, String)>;

/// The most calls within each other. Siemens's control has 11 or 15 levels.
pub(super) const DEEPEST_CALL: usize = 32;
/// The most problems after the first one.
const MOST_FURTHER: usize = 100;
/// The most blocks that a program runs, repeats included, and more for each of its lines: programs that run for ever end here.
const MOST_BLOCKS: usize = 1_000_000;
const BLOCKS_PER_LINE: usize = 10;

/// A block of a program: the program among those read, and its line there.
pub(super) type BlockIndex = (usize, usize);

/// A program that runs.
pub(super) trait Running {
    fn track(&mut self) -> &mut Track;

    /// The block to run next, unless the program has ended.
    fn advance(&mut self) -> Option<BlockIndex>;

    fn run(&mut self, at: BlockIndex) -> Result<(), Located>;

    /// After a problem: what the program has said so far is not fully known.
    fn doubt(&mut self);

    /// The file, the number and the text of a block's line.
    fn line_of(&self, at: BlockIndex) -> (usize, usize, &str);

    /// The bytes of a block in its line.
    fn whole(&self, at: BlockIndex) -> Range<usize>;
}

/// Runs the main program, whose text this is, to its end.
pub(super) fn run(running: &mut impl Running, text: &str, options: &ReadOptions) -> Result<(), NcError> {
    let most_blocks = usize::try_from(options.most_blocks)
        .unwrap_or(usize::MAX)
        .min(MOST_BLOCKS + BLOCKS_PER_LINE * text.lines().count());
    let mut errors: Vec<NcError> = Vec::new();
    let mut messages = BTreeSet::new();
    let mut blocks = 0;
    while errors.len() <= MOST_FURTHER
        && blocks <= most_blocks
        && let Some(at) = running.advance()
    {
        blocks += 1;
        let result = if blocks > most_blocks {
            let problem = NcProblem::value(
                "the number of blocks that this program runs",
                format!("over {most_blocks}"),
                "smaller: it may never end",
            );
            Err((problem, running.whole(at)))
        } else {
            running.track().begin_block();
            running.run(at)
        };
        let Err((problem, span)) = result else { continue };
        running.doubt();
        running.track().leave([true; 3]);
        if messages.insert(problem.to_string()) {
            if options.lenient {
                running.track().note(format!("left out: {problem}"));
            } else {
                let files = running.track().program.files.clone();
                let (file, line, whole) = running.line_of(at);
                errors.push(NcError::on_line(problem, (line, whole), span, (&files, file)));
            }
        }
    }
    running.track().close(text, options.lenient, errors)
}

impl Track {
    /// Takes the file of a subprogram among those of the program; its index.
    pub(super) fn add_file(&mut self, file: PathBuf) -> usize {
        let files = &mut self.program.files;
        // Text without a file is the main program's own, at index 0.
        if files.is_empty() {
            files.push(PathBuf::new());
        }
        files.push(file);
        files.len() - 1
    }
}
