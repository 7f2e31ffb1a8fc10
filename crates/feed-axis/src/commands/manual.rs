//! `completions` and `man`: what a shell and its manual know of this program.

use std::io::Write;
use std::path::PathBuf;

use clap::{Args, Command};
use clap_complete::Shell;
use clap_mangen::Man;
use miette::{IntoDiagnostic, Result};

use crate::exit::not_out;
use crate::output::{note, write_whole};
use crate::program;

/// Options of `completions`.
#[derive(Args)]
pub struct Completions {
    /// The shell
    shell: Shell,
}

/// Options of `man`.
#[derive(Args)]
pub struct Pages {
    /// Folder for all pages, one for each command [default: the first page, to standard output]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Writes the completions of a shell to standard output.
pub fn completions(options: &Completions) -> Result<()> {
    let mut text = Vec::new();
    clap_complete::generate(
        options.shell,
        &mut program::command(),
        program::name(),
        &mut text,
    );
    out(&text)
}

/// Writes the manual's pages.
pub fn pages(options: &Pages) -> Result<()> {
    let mut command = program::command().disable_help_subcommand(true);
    command.build();
    let Some(folder) = &options.out else {
        return out(&page(command)?.1);
    };
    let mut commands = vec![command];
    let mut count = 0;
    while let Some(command) = commands.pop() {
        commands.extend(
            command
                .get_subcommands()
                .filter(|c| !c.is_hide_set())
                .cloned(),
        );
        let (name, text) = page(command)?;
        write_whole(&folder.join(name), &text)?;
        count += 1;
    }
    note(format!(
        "{count} pages in {}; to read one: man {0}/{}.1",
        folder.display(),
        program::name()
    ));
    Ok(())
}

/// The page of a command, and the name of its file.
fn page(command: Command) -> Result<(String, Vec<u8>)> {
    let man = Man::new(command);
    let mut text = Vec::new();
    man.render(&mut text).into_diagnostic()?;
    Ok((man.get_filename(), text))
}

/// A text that is no result, to standard output.
pub(super) fn out(text: &[u8]) -> Result<()> {
    let mut out = std::io::stdout().lock();
    out.write_all(text)
        .and_then(|()| out.flush())
        .map_err(|e| not_out(&e))
}
