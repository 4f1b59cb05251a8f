//! What to do instead, after a word of the command line that was refused.

use super::argument_rules;
use clap::error::{ContextKind, ContextValue, Error, ErrorKind};
use std::ffi::OsString;
use std::path::Path;

/// The error with a tip, where there is a better one than that of the parser.
pub(super) fn with_tip(mut error: Error, words: &[OsString]) -> Error {
    let words: Vec<_> = words.iter().skip(1).map(|word| word.to_string_lossy()).collect();
    let command = words.iter().find(|word| !word.starts_with('-')).map_or("", |word| word);
    let wrong = match error.get(ContextKind::InvalidArg).or(error.get(ContextKind::InvalidSubcommand)) {
        Some(ContextValue::String(wrong)) => wrong.as_str(),
        _ => "",
    };
    let is_output = matches!(wrong, "-o" | "--output");
    let is_version = matches!(wrong, "--version" | "-V");
    let check = format!("pcr check {wrong}");
    let begins = |word: &str| word.len() > 2 && !wrong.is_empty() && word.starts_with(wrong);
    let value = words.windows(2).find(|pair| matches!(&*pair[0], "-o" | "--output") && begins(&pair[1]));
    let value = value.map(|pair| format!("what begins with - is given with an equals sign: {}={}", pair[0], pair[1]));
    let tip = match (error.kind(), command) {
        (ErrorKind::InvalidSubcommand, _) if Path::new(wrong).is_file() => &*check,
        (ErrorKind::UnknownArgument, _) if is_version => "pcr --version",
        (ErrorKind::UnknownArgument, _) if value.is_some() => value.as_deref().unwrap_or_default(),
        (ErrorKind::InvalidSubcommand, "version") => "pcr --version",
        (ErrorKind::UnknownArgument, "locks")
            if !wrong.starts_with('-') && words.iter().any(|word| word == "--audit") =>
        {
            "a file of exclusions is given to --audit with an equals sign: --audit=FILE"
        }
        (ErrorKind::UnknownArgument, "check" | "regions" | "certify" | "nodes" | "compare") if is_output => {
            "this command writes no file; its answer goes to standard output: > FILE"
        }
        (ErrorKind::UnknownArgument, "fleet") if wrong == "--json" || wrong == "--format" => {
            "--certify prints JSON, and nothing else does"
        }
        _ => match argument_rules::why(&error, command) {
            Some(why) => why,
            None => return error,
        },
    };
    for other in [ContextKind::SuggestedSubcommand, ContextKind::SuggestedArg] {
        error.remove(other);
    }
    let tip = tip.to_owned();
    argument_rules::advise(&mut error, &tip);
    error
}
