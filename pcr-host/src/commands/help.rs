//! The command line: the meaning of its words, and the help texts.
//!
//! `-h` shows the common options of a command, one line each; `--help` adds those about layouts and other formats,
//! examples and exit statuses. Options without effect in a command are not shown.

use super::argument_rules::{ruled, unmet};
use super::error_hints::with_tip;
use super::printed::SharedOptions;
use super::{Cli, CliError, UNITS};
use clap::{Arg, ArgAction, Command, CommandFactory, FromArgMatches};
use std::ffi::OsString;
use std::io::{self, IsTerminal, Write};

/// Heading of the options for files that are not scenarios.
pub(super) const LAYOUTS: &str = pcr_formats::import::HEADING;

/// What is asked for; nothing where it was help or the version, which are printed.
pub(super) fn parse(mut words: Vec<OsString>) -> Result<Option<Cli>, CliError> {
    if words.get(1).is_some_and(|word| word == "help") {
        words.remove(1);
        // There is no more about it than what it shows.
        if words.get(1).is_some_and(|word| word == "help") {
            words.remove(1);
        }
        let mut named = words.iter().skip(1).filter(|word| !word.to_string_lossy().starts_with('-'));
        if let (Some(command), Some(more)) = (named.next(), named.next()) {
            let (command, more) = (command.to_string_lossy(), more.to_string_lossy());
            return Err(CliError::arguments(format!(
                "{more}: help is of one command at a time, such as pcr help {command}"
            )));
        }
        words.push("--help".into());
    }
    let end = words.iter().position(|word| word == "--").unwrap_or(words.len());
    let mut long = false;
    for word in words.iter_mut().take(end).filter(|word| *word == "--help") {
        // Both in the form of a line an option.
        (*word, long) = ("-h".into(), true);
    }
    let mut commands = command(long);
    let parsed = commands.try_get_matches_from_mut(&words);
    match parsed.and_then(|matches| unmet(&commands, &matches).map_or(Ok(matches), Err)) {
        Ok(matches) => {
            let mut cli = Cli::from_arg_matches(&matches).map_err(|error| CliError::Usage(Box::new(error)))?;
            if let Some((_, after)) = matches.subcommand() {
                cli.shared.extend(after);
            }
            Ok(Some(cli))
        }
        Err(error) if error.use_stderr() => Err(CliError::Usage(Box::new(with_tip(error, &words)))),
        Err(asked) => {
            let (text, mut out) = (asked.render(), io::stdout().lock());
            if out.is_terminal() {
                write!(out, "{}", text.ansi())?;
            } else {
                write!(out, "{text}")?;
            }
            out.flush()?;
            Ok(None)
        }
    }
}

/// All commands, with what their help shows.
pub(super) fn command(long: bool) -> Command {
    let command = Cli::command();
    let names: Vec<String> = command.get_subcommands().map(|command| command.get_name().to_owned()).collect();
    let is_shared = |argument: &&Arg| SharedOptions::NAMES.contains(&argument.get_id().as_str());
    let shared: Vec<Arg> = command.get_arguments().filter(is_shared).cloned().collect();
    let tailored = names
        .iter()
        .fold(command, |command, name| command.mut_subcommand(name, |own| tailored(own, long).args(shared.clone())));
    // Both texts are in the short form.
    let tailored = tailored.mut_args(|argument| {
        let is_of_long = argument.is_hide_short_help_set() && !long;
        argument.hide_short_help(is_of_long)
    });
    let tailored = with_help(tailored, if long { "Print help" } else { MORE });
    match tailored.get_long_about().cloned() {
        Some(about) if long => tailored.about(about),
        // That there is more is said at `--help` already, and all commands need their lines.
        _ => tailored.after_help(clap::builder::Resettable::Reset),
    }
}

fn tailored(command: Command, long: bool) -> Command {
    let name = command.get_name().to_owned();
    let command = ruled(command);
    let useless = options_without_effect(&name);
    let layouts = command.get_arguments().any(|argument| argument.get_help_heading() == Some(LAYOUTS));
    let command = command.mut_args(|argument| {
        // Of use with every file.
        let argument = if argument.get_id() == "margin" { argument.help_heading(None) } else { argument };
        let hidden = argument.get_help_heading() == Some(LAYOUTS) && !long;
        let hidden = hidden || useless.contains(&argument.get_id().as_str());
        // Both texts are in the short form.
        let of_long = argument.is_hide_short_help_set() && !long;
        let argument = argument.hide(hidden).hide_short_help(of_long);
        // What is out of range is said to be so, and no unknown option.
        let is_value = !argument.is_positional() && argument.get_action().takes_values();
        argument.allow_negative_numbers(is_value)
    });
    let command = with_help(
        command,
        match name.as_str() {
            _ if !long => MORE,
            "completions" | "man" => "Print help",
            _ => "Print help (--allow, --deny, --progress: pcr --help)",
        },
    );
    match (long, layouts) {
        (true, _) if READ_SCENARIOS.contains(&name.as_str()) => {
            let after = command.get_after_help().map(ToString::to_string).unwrap_or_default();
            command.after_help(format!("{UNITS}\n\n{after}"))
        }
        (true, _) => command,
        (false, true) => command
            .after_help(format!("Options for layouts and other formats, examples, exit statuses: pcr {name} --help")),
        (false, false) => command.after_help(format!("Examples and exit statuses: pcr {name} --help")),
    }
}

/// Commands that read scenarios, whose units their help has.
const READ_SCENARIOS: [&str; 7] = ["regions", "certify", "check", "plan", "map", "simulate", "compare"];

/// The help of the option for help where there is more.
const MORE: &str = "Print help (see more with '--help')";

/// With the option for help, which says of itself where there is more.
fn with_help(command: Command, text: &'static str) -> Command {
    let help =
        Arg::new("help").short('h').long("help").action(ArgAction::HelpShort).help(text).help_heading(None::<&str>);
    command.disable_help_flag(true).arg(help)
}

/// Locks of vehicles at any speed.
pub(super) const STANDING: &str = "locks without --delays";
/// Delays, which are of a speed.
pub(super) const DRIVING: &str = "locks --delays";

/// Options for layouts and other formats that do nothing in a command, by the names of their fields.
pub(super) fn options_without_effect(command: &str) -> &'static [&'static str] {
    match command {
        "import" => &["from"],
        // Rotation is of use for arcs with --acceleration only.
        "locks" => &["routes", "horizon"],
        DRIVING => &["routes", "corner_radius", "horizon"],
        STANDING => &["routes", "speed", "acceleration", "rotation", "rotation_acceleration", "horizon"],
        "traffic" => &["routes", "horizon"],
        "check" | "compare" | "map" => &["margin"],
        "nodes" => &[
            "routes",
            "radius",
            "margin",
            "speed",
            "acceleration",
            "rotation",
            "rotation_acceleration",
            "fleet",
            "corner_radius",
            "horizon",
        ],
        _ => &[],
    }
}
