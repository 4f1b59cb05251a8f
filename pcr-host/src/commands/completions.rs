//! `pcr completions` and `pcr man`.

use super::{Stop, help};
use clap::Args;
use clap_complete::Shell;
use std::io::{self, Write};
use std::process::ExitCode;

const EXAMPLES: &str = "\
Examples:
  pcr completions bash > ~/.local/share/bash-completion/completions/pcr
  pcr completions zsh > ~/.zfunc/_pcr                   with ~/.zfunc in $fpath
  pcr completions fish > ~/.config/fish/completions/pcr.fish
  pcr completions powershell >> $PROFILE";

/// Print a completion script for a shell
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Shells {
    /// The shell
    shell: Shell,
}

/// Print the manual page, of pcr or of one command
#[derive(Args)]
#[command(after_help = "Examples:\n  pcr man > pcr.1 && man ./pcr.1\n  pcr man plan > pcr-plan.1")]
pub(super) struct Manual {
    /// Of this command
    command: Option<String>,
}

impl Shells {
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        let mut text = Vec::new();
        clap_complete::generate(self.shell, &mut help::command(true), "pcr", &mut text);
        print(&text)
    }
}

impl Manual {
    pub(super) fn run(self) -> Result<ExitCode, Stop> {
        let mut all = help::command(true);
        all.build();
        let command = match &self.command {
            None => all,
            Some(name) => {
                let found = all
                    .find_subcommand(name)
                    .ok_or_else(|| Stop::arguments(format!("there is no command {name}; pcr --help lists them")))?;
                found.clone().name(format!("pcr-{name}"))
            }
        };
        let mut text = Vec::new();
        clap_mangen::Man::new(command).render(&mut text)?;
        print(&text)
    }
}

fn print(text: &[u8]) -> Result<ExitCode, Stop> {
    let mut out = io::stdout().lock();
    out.write_all(text)?;
    out.flush()?;
    Ok(ExitCode::SUCCESS)
}
