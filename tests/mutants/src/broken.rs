//! Which mutants do not compile: those whose switch is around the place of an error.

use std::collections::{BTreeSet, HashMap};
use std::{fs, io};

const SWITCH: &str = "mutant_switch::on(";

fn indentation(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

fn number(line: &str) -> Option<u32> {
    let (_, rest) = line.rsplit_once(SWITCH)?;
    rest.split_once("u32)")?.0.parse().ok()
}

/// The switch of the line, or of the innermost block around it that has one.
fn around(lines: &[String], at: usize) -> Option<u32> {
    let mut depth = usize::MAX;
    for line in lines[..=at].iter().rev().filter(|line| !line.trim().is_empty()) {
        if depth == usize::MAX || indentation(line) < depth {
            // The other branch begins where this one does.
            depth = indentation(line) + usize::from(line.trim_start().starts_with("} else"));
            if let Some(number) = number(line) {
                return Some(number);
            }
        }
    }
    None
}

/// Of what is borrowed twice, as the statement that gives it another value is left out: where that one is.
fn next_value(lines: &[String], at: usize, text: &str) -> Option<usize> {
    let name = text.split("cannot borrow `*").nth(1)?.split('`').next()?;
    let starts = [format!("{name} = "), format!("({name}, ")];
    let gives = |line: &String| starts.iter().any(|start| line.trim_start().starts_with(start));
    lines[at..].iter().position(gives).map(|after| at + after)
}

pub fn print() {
    let mut files = HashMap::new();
    let mut numbers = BTreeSet::new();
    for message in io::stdin().lines().map(|line| line.expect("text")) {
        let mut parts = message.splitn(4, ':');
        let (Some(file), Some(line), Some(_), Some(text)) = (parts.next(), parts.next(), parts.next(), parts.next())
        else {
            continue;
        };
        let (Ok(line), true) = (line.parse::<usize>(), text.trim_start().starts_with("error")) else { continue };
        let lines = files.entry(file.to_owned()).or_insert_with(|| {
            fs::read_to_string(file).expect("a file").lines().map(str::to_owned).collect::<Vec<_>>()
        });
        let found = around(lines, line - 1);
        let found = found.or_else(|| around(lines, next_value(lines, line - 1, text)?));
        match found {
            Some(number) => drop(numbers.insert(number)),
            // Another error of the same mutant may be in a block that has one.
            None => eprintln!("no switch is around {message}"),
        }
    }
    for number in numbers {
        println!("{number}");
    }
}
