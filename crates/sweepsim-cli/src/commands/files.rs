//! `inspect`, `convert` and `new`: what is in a file, the same in another format, and a job for a program.

use crate::arguments::{ConvertOptions, InspectOptions, NewOptions};
use crate::session::{Failure, Lines, Outputs};
use std::path::Path;
use sweepsim_formats::{Provided, draft};
use sweepsim_job::{JobError, Sink as _, describe};

/// Prints a description of a file.
pub(crate) fn inspect(options: &InspectOptions) -> Result<(), Failure> {
    Lines::described(&describe(&options.file, &options.dialect.given())?).print()
}

/// Reads one file, writes the other, and prints a summary.
pub(crate) fn convert(options: &ConvertOptions) -> Result<(), Failure> {
    let mut outputs = Outputs::anywhere();
    let mut text = Lines::described(&options.request().write_to(&mut outputs)?);
    text.line("out", &outputs.listed());
    if options.quiet { Ok(()) } else { text.print() }
}

/// Writes a job for a program, and says what was found and what was guessed.
pub(crate) fn new(options: &NewOptions) -> Result<(), Failure> {
    let beside = options.program.parent().unwrap_or(Path::new(""));
    let folder = options.out.as_deref().unwrap_or(beside);
    let mut draft_options = options.options.given().draft(folder);
    draft_options.cells = options.cells;
    draft_options.invent = true;
    let draft = draft(&options.program, &draft_options)?;
    let stem = draft.program.file_stem();
    let name = stem.map_or("job".to_owned(), |stem| stem.to_string_lossy().into_owned());
    let file = folder.join(format!("{name}.ron"));
    if file.exists() && !options.force {
        let message = format!(
            "{}: there is such a file already; expected --force to overwrite it",
            file.display()
        );
        return Err(Failure::message(message));
    }
    // Nobody should get a job that cannot be read.
    let job = draft.job(&file, &Provided::default()).map_err(JobError::from)?;
    if !folder.as_os_str().is_empty() {
        std::fs::create_dir_all(folder)
            .map_err(|error| Failure::message(format!("cannot make the folder {}: {error}", folder.display())))?;
    }
    Outputs::anywhere().write(&file.to_string_lossy(), &mut |writer| {
        writer.write_all(draft.text.as_bytes())
    })?;
    if options.quiet {
        return Ok(());
    }
    let mut lines = Lines::default();
    for found in &draft.found {
        lines.line("found", found);
    }
    for guess in &draft.guessed {
        lines.line("guessed", &guess.to_string());
    }
    for note in job.paths.iter().flat_map(|path| &path.notes) {
        lines.line("note", &note.to_string());
    }
    lines.line("out", &file.display().to_string());
    lines.print()
}
