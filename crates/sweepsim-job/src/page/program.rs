//! The text of the programs, and the line of each move.

use crate::request::Input;
use crate::session::Session;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use sweepsim_formats::JobPath;
use sweepsim_report::{Excerpt, ProgramText};

/// Lines of a program before and after the one that matters.
const AROUND: usize = 3;
/// The most characters of a line that are shown.
const LONGEST: usize = 300;
/// Larger files are not shown as a whole.
const LARGEST: u64 = 20_000_000;

/// The files of a job's programs, in the order in which they are first used.
pub(super) struct Programs {
    names: Vec<String>,
    texts: Vec<Vec<String>>,
    /// Of each path: file (a number of `names`) and line of each move; line 0 if it has none.
    lines: Vec<Vec<(u16, u32)>>,
}

/// The name that a report shows for the file of a pose.
fn shown(path: &JobPath, file: usize, folder: &Path) -> String {
    match path.files.get(file).filter(|_| file > 0) {
        // A subprogram in a file of its own.
        Some(file) => file.strip_prefix(folder).unwrap_or(file).display().to_string(),
        None => path.source.clone(),
    }
}

impl Programs {
    pub fn new(session: Session) -> Self {
        let folder = session.folder();
        let mut numbers: BTreeMap<String, u16> = BTreeMap::new();
        let mut names = Vec::new();
        let mut lines = Vec::new();
        for path in &session.job.paths {
            let mut last = (usize::MAX, 0);
            // A move belongs to the line of the pose where it ends.
            let mut origins = path.origins.iter().skip(1);
            let line = |_: usize| {
                let Some(origin) = origins.next() else {
                    return (0, 0);
                };
                if origin.file != last.0 {
                    let name = shown(path, origin.file, folder);
                    let next = names.len() as u16;
                    let number = *numbers.entry(name.clone()).or_insert(next);
                    if number == next {
                        names.push(name);
                    }
                    last = (origin.file, number);
                }
                (last.1, origin.line as u32)
            };
            lines.push((0..path.path.moves()).map(line).collect());
        }
        let kept = match &session.request.input {
            Input::Program { text, .. } => Some(text.as_bytes()),
            _ => None,
        };
        let texts = names.iter().map(|name| match kept {
            Some(text) => lines_of(text.to_vec()),
            None => text(&folder.join(name)),
        });
        let texts = texts.collect();
        Self { names, texts, lines }
    }

    /// File and line of each move of all paths.
    pub fn lines(&self) -> Vec<(u16, u32)> {
        self.lines.iter().flatten().copied().collect()
    }

    /// A line with its neighbours.
    pub fn excerpt(&self, file: &str, line: usize) -> Option<Excerpt> {
        let number = self.names.iter().position(|name| name == file)?;
        let text = &self.texts[number];
        let first = line.saturating_sub(AROUND).max(1);
        let last = (line + AROUND).min(text.len());
        if line == 0 || line > text.len() {
            return None;
        }
        Some(Excerpt {
            file: file.to_owned(),
            first,
            lines: text[first - 1..last].iter().map(|line| shortened(line)).collect(),
            line,
        })
    }

    pub fn into_texts(self) -> Vec<ProgramText> {
        let joined = |(name, lines): (String, Vec<String>)| ProgramText {
            name,
            text: lines.join("\n"),
        };
        self.names.into_iter().zip(self.texts).map(joined).collect()
    }
}

fn shortened(line: &str) -> String {
    match line.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &line[..end]),
        None => line.to_owned(),
    }
}

/// The lines of a file; none if it cannot be read, or is too large to be shown.
fn text(file: &PathBuf) -> Vec<String> {
    if std::fs::metadata(file).is_ok_and(|data| data.len() > LARGEST) {
        return Vec::new();
    }
    lines_of(std::fs::read(file).unwrap_or_default())
}

fn lines_of(mut bytes: Vec<u8>) -> Vec<String> {
    sweepsim_nc::end_lines_at_returns(&mut bytes);
    let text = String::from_utf8_lossy(&bytes);
    text.lines().map(|line| line.trim_end().to_owned()).collect()
}
