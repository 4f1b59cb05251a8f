//! `pcr completions` and `pcr man`.

use super::{CliError, help, statuses};
use clap::builder::PossibleValuesParser;
use clap::{Arg, Args, Command, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;
use std::collections::BTreeSet;
use std::io::{self, Write};
use std::process::ExitCode;

const EXAMPLES: &str = "\
Examples:
  pcr completions bash > ~/.local/share/bash-completion/completions/pcr
  pcr completions zsh > ~/.zfunc/_pcr                   with ~/.zfunc in $fpath
  pcr completions fish > ~/.config/fish/completions/pcr.fish
  pcr completions powershell >> $PROFILE";

const PAGES: &str = "\
Examples:
  pcr man > pcr.1 && man ./pcr.1
  pcr man plan > pcr-plan.1";

/// Print a completion script for a shell
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{}", statuses("wrong arguments")))]
pub(super) struct CompletionsArgs {
    /// The shell
    shell: Shell,
}

/// Print the manual page, of pcr or of one command
#[derive(Args)]
#[command(after_help = format!("{PAGES}\n\n{}", statuses("wrong arguments")))]
pub(super) struct ManArgs {
    /// Command to describe; pcr itself if left out
    command: Option<String>,
}

impl CompletionsArgs {
    pub(super) fn run(self) -> Result<ExitCode, CliError> {
        let (mut text, command) = (Vec::new(), help::command(true));
        let names: Vec<String> = command.get_subcommands().map(|command| command.get_name().to_owned()).collect();
        // Only here: what is no command is refused by a reason of its own.
        let of_man = move |argument: Arg| argument.value_parser(PossibleValuesParser::new(names.clone()));
        let mut command = command.mut_subcommand("man", |man| man.mut_arg("command", of_man));
        clap_complete::generate(self.shell, &mut command, "pcr", &mut text);
        if self.shell == Shell::Zsh {
            text = for_zsh(String::from_utf8_lossy(&text).into_owned(), &command).into_bytes();
        }
        print(&text)
    }
}

impl ManArgs {
    pub(super) fn run(self) -> Result<ExitCode, CliError> {
        let mut all = help::command(true);
        all.build();
        let command = match &self.command {
            // What it is in one line; the rest is the description.
            None => all.about(super::Cli::command().get_about().cloned().unwrap_or_default()),
            Some(name) => {
                let found = all
                    .find_subcommand(name)
                    .ok_or_else(|| CliError::arguments(format!("there is no command {name}; pcr --help lists them")))?;
                found.clone().name(format!("pcr-{name}"))
            }
        };
        print(&page(command)?)
    }
}

/// A script for zsh, in which a colon ends what a value is called, so that one in it is escaped; the generator does not.
fn for_zsh(text: String, command: &Command) -> String {
    let arguments = command.get_subcommands().chain([command]).flat_map(Command::get_arguments);
    let names: BTreeSet<&str> =
        arguments.flat_map(|argument| argument.get_value_names().unwrap_or_default()).map(|name| &**name).collect();
    let names = names.into_iter().filter(|name| name.contains(':'));
    names.fold(text, |text, name| text.replace(&format!(":{name}:"), &format!(":{}:", name.replace(':', "\\:"))))
}

/// The manual page of a command, with examples and exit statuses as they are, line by line.
fn page(mut command: Command) -> io::Result<Vec<u8>> {
    let after = command.get_after_help().map(ToString::to_string).unwrap_or_default();
    let has_commands = command.has_subcommands();
    // As in the help: the options have their values, and stand below.
    let usage = command.render_usage().to_string().replacen("Usage: ", "", 1);
    let command = command.override_usage(usage).version(env!("CARGO_PKG_VERSION"));
    let (page, mut text) = (Man::new(command), Vec::new());
    page.render_title(&mut text)?;
    page.render_name_section(&mut text)?;
    page.render_synopsis_section(&mut text)?;
    page.render_description_section(&mut text)?;
    page.render_options_section(&mut text)?;
    if has_commands {
        page.render_subcommands_section(&mut text)?;
    }
    for part in after.split("\n\n") {
        let (title, lines) = match part.split_once(":\n") {
            Some((title, lines)) if !title.contains('\n') => (title.to_uppercase(), lines),
            _ => ("NOTES".to_owned(), part),
        };
        writeln!(text, ".SH \"{title}\"\n.nf")?;
        // No line is a request, whatever it begins with.
        lines.lines().try_for_each(|line| writeln!(text, "\\&{}", line.replace('\\', "\\e").replace('-', "\\-")))?;
        writeln!(text, ".fi")?;
    }
    page.render_version_section(&mut text)?;
    Ok(text)
}

fn print(text: &[u8]) -> Result<ExitCode, CliError> {
    let mut out = io::stdout().lock();
    out.write_all(text)?;
    out.flush()?;
    Ok(ExitCode::SUCCESS)
}
