//! The `console` blocks of the documents are what the tool prints: every command in them is run, in order, by a shell in a copy
//! of the repository's top folder. Below a command stands its output, standard error behind standard output; a line `...`
//! stands for any number of lines. `UPDATE=1 cargo test -p pcr-host --test tool console` writes what is printed now where no
//! line `...` is.

use crate::fixture::directory;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A command of a block, and what the document says that it prints.
struct Step<'a> {
    command: &'a str,
    says: Vec<&'a str>,
}

/// The commands of one block, with their outputs.
fn steps(block: &str) -> Vec<Step<'_>> {
    let mut steps: Vec<Step> = Vec::new();
    for line in block.lines() {
        match (line.strip_prefix("$ "), steps.last_mut()) {
            (Some(command), _) => steps.push(Step { command, says: Vec::new() }),
            (None, Some(step)) => step.says.push(line),
            (None, None) => panic!("output before the first command: {line}"),
        }
    }
    steps
}

pub(crate) fn top() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().canonicalize().unwrap()
}

/// A folder that looks like the repository's top and may be written to.
pub(crate) fn sandbox(document: &str) -> PathBuf {
    let folder = directory("console").join(document.replace(['/', '.'], "-"));
    if folder.exists() {
        fs::remove_dir_all(&folder).unwrap();
    }
    fs::create_dir_all(&folder).unwrap();
    for entry in fs::read_dir(top()).unwrap() {
        let entry = entry.unwrap();
        if !["target", ".git"].iter().any(|name| entry.file_name() == *name) {
            symlink(entry.path(), folder.join(entry.file_name())).unwrap();
        }
    }
    folder
}

/// What a command prints, and whether it ends well.
pub(crate) fn prints(command: &str, folder: &Path) -> (String, bool) {
    let tool = Path::new(env!("CARGO_BIN_EXE_pcr")).parent().unwrap();
    let path = format!("{}:{}", tool.display(), std::env::var("PATH").unwrap());
    let shell = Command::new("sh").args(["-c", command]).current_dir(folder).env("PATH", path).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (text(shell.stdout) + &text(shell.stderr), shell.status.success())
}

/// Whether the lines are those of a pattern in which `...` stands for any number of lines.
fn matches(pattern: &[&str], lines: &[&str]) -> bool {
    match pattern {
        [] => lines.is_empty(),
        [first, rest @ ..] if first.trim() == "..." => (0..=lines.len()).any(|skip| matches(rest, &lines[skip..])),
        [first, rest @ ..] => {
            lines.split_first().is_some_and(|(line, lines)| line.trim_end() == *first && matches(rest, lines))
        }
    }
}

/// Runs the blocks of a document; returns how many commands there were.
fn follow(document: &str) -> usize {
    let path = top().join(document);
    let text = fs::read_to_string(&path).unwrap();
    let folder = sandbox(document);
    let (mut written, mut commands, mut wrong) = (text.clone(), 0, String::new());
    for block in text.split("```console\n").skip(1) {
        let block = block.split("```").next().unwrap();
        let mut now = String::new();
        for Step { command, says } in steps(block) {
            let (printed, well) = prints(command, &folder);
            let lines: Vec<&str> = printed.lines().collect();
            // Where nothing of the output is shown, it may be no message of an error.
            assert!(well || says != ["..."], "{document}: {command}\n{printed}");
            commands += 1;
            now += &format!("$ {command}\n");
            if matches(&says, &lines) {
                now.extend(says.iter().map(|line| format!("{line}\n")));
            } else {
                now.extend(lines.iter().map(|line| format!("{}\n", line.trim_end())));
                wrong += &format!("$ {command}\n{printed}\n");
            }
        }
        written = written.replacen(block, &now, 1);
    }
    if std::env::var_os("UPDATE").is_some() {
        fs::write(path, written).unwrap();
    } else {
        assert!(wrong.is_empty(), "{document} says something else than the tool prints:\n{wrong}");
    }
    commands
}

#[test]
fn the_readme_shows_what_the_tool_prints() {
    assert!(follow("README.md") >= 5);
}

#[test]
fn the_other_documents_show_what_the_tool_prints() {
    let mut commands = 0;
    for folder in ["docs/guide", "docs/reference"] {
        for entry in fs::read_dir(top().join(folder)).unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            if name.ends_with(".md") {
                commands += follow(&format!("{folder}/{name}"));
            }
        }
    }
    assert!(commands >= 22, "{commands}");
}

#[test]
fn any_number_of_lines_may_be_left_out() {
    assert!(matches(&["a", "...", "c"], &["a", "b", "b", "c"]));
    assert!(matches(&["a", "..."], &["a"]));
    assert!(!matches(&["a", "...", "c"], &["a", "b"]));
    assert!(!matches(&["a"], &["a", "b"]));
}
