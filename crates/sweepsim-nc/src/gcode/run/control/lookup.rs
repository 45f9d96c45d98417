//! Where subprograms are: in the texts that have been read, or in files.

use std::collections::{BTreeMap, BTreeSet};
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::super::interpreter::{Input, Reader, Step};
use super::calls::SourceLine;
use crate::gcode::flow::keywords::{Keyword, Label};
use crate::gcode::flow::source::{LONGEST, Source};
use crate::gcode::syntax::block::Block;
use crate::model::read_options::{Controller, ReadOptions};
use crate::text::assumption::Assumption;
use crate::text::confined::is_within;
use crate::text::error::NcProblem;
use crate::text::lines;

/// Files of subprograms, at most.
const MOST_FILES: usize = 500;

/// The texts that have been read, and where to look for others.
pub(crate) struct Texts {
    pub sources: Vec<Rc<Source>>,
    pub files: Vec<PathBuf>,
    folders: Vec<PathBuf>,
    within: Option<PathBuf>,
    looked_for: BTreeSet<Label>,
    /// Where the loop that begins in a line ends.
    pub loop_ends: BTreeMap<SourceLine, Option<usize>>,
}

impl Texts {
    pub(crate) fn new(input: &Input, options: &ReadOptions) -> Self {
        Self {
            sources: vec![Rc::new(Source::new(0, Rc::clone(input.text)))],
            files: input.file.map(Path::to_owned).into_iter().collect(),
            folders: folders(input.file, &options.subprograms),
            within: options.within.clone(),
            looked_for: BTreeSet::new(),
            loop_ends: BTreeMap::new(),
        }
    }
}

impl Reader {
    /// Where a label is, in the texts that have been read.
    pub(crate) fn find_in_texts(&self, label: &Label, source: usize) -> Option<(SourceLine, Option<Keyword>)> {
        let order = std::iter::once(source).chain(0..self.texts.sources.len());
        for source in order {
            let lines = self.texts.sources[source].labels().lines(label);
            let found = lines
                .iter()
                .find(|found| matches!(found.keyword, None | Some(Keyword::Sub)));
            if let Some(found) = found {
                let spot = SourceLine {
                    source,
                    line: found.line,
                };
                return Some((spot, found.keyword));
            }
        }
        None
    }

    /// A call of a program that is missing, which LinuxCNC does not have: those from O9000 on are of the machine's builder, or of its probe.
    pub(super) fn without_macro(&mut self, number: u32, block: &Block, problem: NcProblem) -> Result<Step, NcProblem> {
        if self.track.strict() || self.rules.controller == Some(Controller::LinuxCnc) {
            return Err(problem);
        }
        if !(9000..=9999).contains(&number) {
            self.track
                .leave_out_program(&format!("O{number}"), &format!("O{number}"))?;
            return Ok(Step::Next);
        }
        // Renishaw's begin with 98: O9810 is a positioning move, the others end where they began.
        let probes = (9800..=9899).contains(&number);
        let words = self.lengths(block, ['X', 'Y', 'Z']);
        let what = format!("O{number}, a program of the machine");
        let settle = format!("the file O{number} beside the program");
        let taken = match (number, probes) {
            (9810, _) => "a positioning move of the probe",
            (_, true) => "a cycle of the probe, which cuts nothing and ends where it began: left out",
            _ => "left out; where the tool is then is known again from the next moves",
        };
        let assumption = Assumption::new(what, taken, settle);
        self.track
            .assume(if probes { assumption.harmless() } else { assumption });
        if !probes {
            self.track.leave([true; 3]);
        } else if number == 9810 {
            for k in 0..3 {
                self.track.xyz[k] = words[k].filter(|_| self.modes.absolute).or(self.track.xyz[k]);
            }
            self.track.joined = false;
        }
        Ok(Step::Next)
    }

    /// Where a subroutine or a program begins: in these texts, or in a file.
    pub(crate) fn find(
        &mut self,
        label: &Label,
        source: usize,
        keyword: Option<Keyword>,
    ) -> Result<SourceLine, NcProblem> {
        if self.find_in_texts(label, source).is_none() {
            self.load(label)?;
        }
        match (self.find_in_texts(label, source), keyword) {
            (Some((spot, found)), keyword) if found == keyword => Ok(spot),
            (Some(_), None) => Err(NcProblem::syntax(format!(
                "`{label} sub` begins a subroutine of LinuxCNC: expected `{label} call`"
            ))),
            (Some(_), Some(_)) => Err(NcProblem::syntax(format!(
                "{label} is a subprogram without `sub`: expected M98 P to call it"
            ))),
            (None, _) => Err(NcProblem::syntax(format!(
                "the subprogram {label} is missing: expected it in this program, or in a file of its name beside it"
            ))),
        }
    }

    /// Reads the file of a subprogram, if there is one.
    fn load(&mut self, label: &Label) -> Result<(), NcProblem> {
        if !self.texts.looked_for.insert(label.clone()) || self.texts.sources.len() > MOST_FILES {
            return Ok(());
        }
        let names = match label {
            // No way out of the folder.
            Label::Name(name) if name.contains(['/', '\\', '\0']) || name.starts_with('.') => return Ok(()),
            Label::Name(name) => vec![name.clone(), format!("O{name}")],
            Label::Number(number) => vec![
                format!("{number}"),
                format!("O{number:04}"),
                format!("o{number:04}"),
                format!("O{number}"),
                format!("o{number}"),
                format!("{number:04}"),
            ],
        };
        let extensions = [
            ".ngc", ".nc", ".NC", ".NGC", ".tap", ".cnc", ".txt", ".SUB", ".SSB", ".MIN", ".LIB", "",
        ];
        for folder in &self.texts.folders {
            for (name, extension) in names.iter().flat_map(|name| extensions.iter().map(move |e| (name, e))) {
                let path = folder.join(format!("{name}{extension}"));
                if path.is_file() && is_within(&path, self.texts.within.as_deref()) {
                    let source = read(&path, self.texts.files.len())?;
                    self.texts.files.push(path);
                    self.texts.sources.push(Rc::new(source));
                    return Ok(());
                }
            }
        }
        Ok(())
    }
}

fn read(path: &Path, file: usize) -> Result<Source, NcProblem> {
    let size = std::fs::metadata(path).map_err(NcProblem::Read)?.len();
    if size > LONGEST as u64 {
        return Err(NcProblem::value(
            "the size of a file of subprograms",
            size,
            "less than 2 GB",
        ));
    }
    let open = std::fs::File::open(path).map_err(NcProblem::Read)?;
    let bytes = lines::all(BufReader::new(open)).map_err(|error| error.into_parts().2)?;
    Ok(Source::new(file, Rc::new(String::from_utf8_lossy(&bytes).into_owned())))
}

/// The folders in which to look for subprograms.
fn folders(file: Option<&Path>, further: &[PathBuf]) -> Vec<PathBuf> {
    let own = file.map(|file| match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    });
    own.into_iter().chain(further.iter().cloned()).collect()
}
