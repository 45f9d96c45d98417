//! `new`: writes a job for a program.

use crate::arguments::NewOptions;
use crate::session::{Failure, Lines, save};
use std::io::Write as _;
use std::path::Path;
use sweepsim_formats::{Job, draft};

/// Writes the job, and says what was found and what was guessed.
pub(crate) fn new(options: &NewOptions) -> Result<(), Failure> {
    let beside = options.program.parent().unwrap_or(Path::new(""));
    let folder = options.out.as_deref().unwrap_or(beside);
    let mut draft_options = options.options.draft(folder);
    draft_options.cells = options.cells;
    draft_options.invent = true;
    let draft = draft(&options.program, &draft_options)?;
    let name = draft
        .program
        .file_stem()
        .map(|stem| stem.to_string_lossy().into_owned());
    let file = folder.join(format!("{}.ron", name.unwrap_or_else(|| "job".to_owned())));
    if file.exists() && !options.force {
        let message = format!(
            "{}: there is such a file already; expected --force to overwrite it",
            file.display()
        );
        return Err(Failure::message(message));
    }
    // Nobody should get a job that cannot be read.
    let job = Job::parse(&draft.text, &file)?;
    if !folder.as_os_str().is_empty() {
        std::fs::create_dir_all(folder)
            .map_err(|error| Failure::message(format!("cannot make the folder {}: {error}", folder.display())))?;
    }
    save(&file, |writer| writer.write_all(draft.text.as_bytes()))?;
    if options.quiet {
        return Ok(());
    }
    let mut lines = Lines::default();
    for found in &draft.found {
        lines.line("found", found);
    }
    for guess in &draft.guessed {
        lines.line("guessed", guess);
    }
    for note in job.paths.iter().flat_map(|path| &path.notes) {
        lines.line("note", &note.to_string());
    }
    lines.line("out", &file.display().to_string());
    lines.print()
}
