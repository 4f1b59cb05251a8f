//! Arguments that exclude or need one another are refused with a reason.

use crate::fixture::run;
use clap::{Arg, ArgAction, Command};
use std::fs;
use std::path::Path;

#[allow(dead_code)]
#[path = "../../src/commands/argument_rules.rs"]
mod declared;
use declared::{ArgumentRelation, RULES};

/// An argument with some value that it takes.
fn given(command: &str, name: &str) -> Vec<String> {
    let value = match name {
        "certify" if command == "locks" => return vec!["--certify".to_owned()],
        "file" | "layout" => return vec!["some-file".to_owned()],
        "audit" | "check" | "compare" | "delays" | "finish" | "foraging" | "json" | "lines" | "manager" | "nodes"
        | "scenario" | "standby" | "stay" => {
            return vec![format!("--{name}")];
        }
        "topics" => return ["--topics", "a", "b"].map(str::to_owned).to_vec(),
        "format" => "csv",
        "scalar" => "q16",
        "write" => "nav2",
        "stopped" | "slip" => "0.5",
        _ => "1",
    };
    vec![format!("--{name}={value}")]
}

/// The arguments of a command that exclude some of it.
fn excluders(command: &str, of: &[&str]) -> Vec<&'static str> {
    let rules = RULES.iter().filter(|(name, _, rule, ..)| *name == command && *rule == ArgumentRelation::Excludes);
    let sides = rules.flat_map(|(_, arguments, _, others, _)| [(arguments, others), (others, arguments)]);
    let hit = sides.filter(|(_, others)| others.iter().any(|other| of.contains(other)));
    hit.flat_map(|(arguments, _)| arguments.iter().copied()).collect()
}

/// Whether an argument of a command needs others.
fn needs(command: &str, argument: &str) -> bool {
    RULES
        .iter()
        .any(|(name, of, rule, ..)| *name == command && *rule == ArgumentRelation::Needs && of.contains(&argument))
}

#[test]
fn arguments_that_exclude_or_need_one_another_are_refused_with_a_reason() {
    let refused = |command: &str, arguments: &[&str], reason: &str| {
        let words = arguments.iter().flat_map(|argument| given(command, argument)).collect::<Vec<_>>();
        let words = [command].into_iter().chain(words.iter().map(String::as_str)).collect::<Vec<_>>();
        let run = run(&words);
        assert_eq!((run.status, run.out.as_str()), (2, ""), "{words:?}: {}", run.err);
        assert!(
            run.err.starts_with("error: the ") && run.err.contains(&format!("\n  tip: {reason}\n")),
            "{words:?}: {}",
            run.err
        );
    };
    for (command, arguments, rule, others, reason) in RULES {
        assert!(!reason.contains('\n') && reason.len() < 130, "{reason}");
        let commands = if command.is_empty() { &["regions", "compare", "traffic"][..] } else { &[command][..] };
        for (command, argument) in commands.iter().flat_map(|command| arguments.iter().map(move |one| (command, one))) {
            match rule {
                ArgumentRelation::Needs => {
                    refused(command, &[argument], reason);
                    // Also beside what excludes the needed one.
                    let own = excluders(command, &[argument]);
                    let allowed = |one: &&str| !others.contains(one) && !own.contains(one) && !needs(command, one);
                    let beside = excluders(command, others).into_iter().filter(allowed);
                    beside.for_each(|other| refused(command, &[argument, other], reason));
                }
                ArgumentRelation::Excludes => others.iter().for_each(|other| {
                    refused(command, &[argument, other], reason);
                    refused(command, &[other, argument], reason);
                }),
            }
        }
    }
}

/// A rule of all commands would be one about an argument that is not there.
#[test]
fn a_rule_of_all_commands_is_of_those_that_have_its_arguments() {
    let command = Command::new("other").arg(Arg::new("json").long("json").action(ArgAction::SetTrue));
    declared::ruled(command).debug_assert();
}

/// What is declared elsewhere would be refused without a reason.
#[test]
fn no_other_arguments_exclude_or_need_one_another() {
    fn sources(folder: &Path, into: &mut Vec<(String, String)>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            match path.is_dir() {
                true => sources(&path, into),
                false => into.push((path.display().to_string(), fs::read_to_string(&path).unwrap())),
            }
        }
    }
    let (host, mut files) = (Path::new(env!("CARGO_MANIFEST_DIR")), Vec::new());
    sources(&host.join("src"), &mut files);
    sources(&host.join("formats/src/import"), &mut files);
    files.retain(|(name, _)| !name.ends_with("rules.rs"));
    assert!(files.len() > 40);
    for (name, text) in files {
        for word in ["conflicts_with", "requires", "exclusive", "required_unless", "required_if", "ArgGroup"] {
            let declares = |line: &&str| {
                line.contains(&format!("{word} ="))
                    || line.contains(&format!("{word}_all ="))
                    || line.contains(&format!("{word}("))
                    || word == "ArgGroup" && line.contains(word)
            };
            assert_eq!(text.lines().find(declares), None, "{name}");
        }
    }
}
