//! `completions` and `man`: what shells and `man` know of the command, made of its arguments.

use crate::arguments::{Arguments, CompletionsOptions, ManOptions};
use crate::session::{Failure, Outputs, print};
use clap::{Command, CommandFactory};
use clap_mangen::Man;
use std::io;
use sweepsim_job::Sink as _;

/// Prints the completions of a shell.
pub(crate) fn completions(options: &CompletionsOptions) -> Result<(), Failure> {
    let mut text = Vec::new();
    clap_complete::generate(options.shell, &mut Arguments::command(), "sweepsim", &mut text);
    print(&String::from_utf8_lossy(&text))
}

/// Prints the manual page of the command, or writes one for each of its commands.
pub(crate) fn man(options: &ManOptions) -> Result<(), Failure> {
    let mut command = Arguments::command().disable_help_subcommand(true);
    command.build();
    let cannot = |error: io::Error| Failure::message(format!("cannot make the manual: {error}"));
    let Some(folder) = &options.out else {
        return print(&page(&command).map_err(cannot)?);
    };
    let mut outputs = Outputs::new(folder.clone())?;
    for command in std::iter::once(&command).chain(command.get_subcommands()) {
        let text = page(command).map_err(cannot)?;
        let name = command.get_display_name().unwrap_or(command.get_name());
        outputs.write(&format!("{name}.1"), &mut |file| file.write_all(text.as_bytes()))?;
    }
    print(&format!("{}\n", outputs.listed()))
}

/// The page of a command, in the language of `man`.
fn page(command: &Command) -> io::Result<String> {
    let mut text = Vec::new();
    Man::new(command.clone()).render(&mut text)?;
    Ok(String::from_utf8_lossy(&text).into_owned())
}
