//! Warnings: their codes, and what `--allow`, `--deny` and `--warnings` do with them.

use crate::fixture::{Run, crossing, file, run};
use pcr_formats::warning::WarningCode;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs;

const ONE_ID: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/cases/one-id-two-edges.geojson");
const WAREHOUSE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/nav2/warehouse_graph.geojson");

const SAMPLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/nav2/sample_graph.geojson");

/// The codes of the warnings that are printed.
fn printed(run: &Run) -> BTreeSet<WarningCode> {
    let lines = run.err.lines().filter(|line| line.starts_with("pcr: warning: "));
    lines.map(WarningCode::of).collect()
}

/// The codes of the warnings in an answer.
fn answered(answer: &Value) -> BTreeSet<WarningCode> {
    answer["warnings"]
        .as_array()
        .into_iter()
        .flatten()
        .map(|warning| WarningCode::of(warning.as_str().unwrap()))
        .collect()
}

fn parsed(run: &Run) -> Value {
    serde_json::from_str(&run.out).unwrap()
}

#[test]
fn the_documentation_lists_every_code() {
    let name = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/reference/warnings.md");
    let text = fs::read_to_string(name).unwrap();
    let rows: Vec<&str> = text.lines().filter(|line| line.starts_with("| `")).collect();
    let expected: Vec<String> =
        WarningCode::ALL.iter().map(|code| format!("| `{code}` | {} |", code.explanation())).collect();
    assert_eq!(rows, expected);
}

#[test]
fn a_warning_has_its_code_on_the_terminal_and_in_the_answer() {
    let routes = ["--route", "0:1", "--radius", "0.3", "--json"];
    for command in [&["regions"][..], &["check"], &["plan"], &["simulate", "--controller", "pcr"]] {
        let run = run(&[command, &[ONE_ID], &routes].concat());
        let codes = answered(&parsed(&run));
        assert_eq!(printed(&run), codes, "{}", run.err);
        assert!(codes.contains(&WarningCode::AssumedVehicle), "{codes:?}");
        assert!(codes.contains(&WarningCode::Renamed) && !codes.contains(&WarningCode::Uncoded), "{codes:?}");
    }
    let locks = run(&["locks", ONE_ID, "--radius", "0.3", "--json"]);
    assert!(answered(&parsed(&locks)).contains(&WarningCode::Renamed), "{}", locks.out);
    // A file of an earlier version.
    let mut old = crossing();
    old["warnings"] = json!(["edge 3: guessed"]);
    let old = run(&["regions", &file("warnings", "old.json", old.to_string()), "--json"]);
    assert_eq!(parsed(&old)["warnings"], json!(["edge 3: guessed [uncoded]"]));
}

#[test]
fn what_is_acknowledged_is_neither_printed_nor_in_what_is_written() {
    let command = ["import", "nav2", ONE_ID, "--route", "0:1", "--radius", "0.3"];
    let all = run(&command);
    let codes = printed(&all);
    assert!(codes.len() > 1 && answered(&parsed(&all)) == codes, "{}", all.err);
    for &code in &codes {
        let without = run(&[&command[..], &["--allow", code.name()]].concat());
        let rest: BTreeSet<WarningCode> = codes.iter().copied().filter(|other| *other != code).collect();
        assert_eq!((without.status, printed(&without)), (0, rest.clone()), "{}", without.err);
        assert_eq!(answered(&parsed(&without)), rest);
    }
    // With commas and several times.
    let names: Vec<&str> = codes.iter().map(|code| code.name()).collect();
    let (first, rest) = names.split_first().unwrap();
    let none = run(&[&command[..], &["--allow", first, "--allow", &rest.join(",")]].concat());
    assert_eq!((none.status, none.err.as_str(), &parsed(&none)["warnings"]), (0, "", &Value::Null));
    // Those of the answer itself, and of an audit behind those of the layout.
    let locks = ["locks", WAREHOUSE, "--radius", "0.4", "--audit", "--json"];
    let audit = run(&locks);
    let names: Vec<&str> = answered(&parsed(&audit)).iter().map(|code| code.name()).collect();
    let allowed = run(&[&locks[..], &["--allow", &names.join(",")]].concat());
    assert_eq!((parsed(&allowed)["warnings"].clone(), printed(&allowed)), (json!([]), BTreeSet::new()));
}

#[test]
fn an_unknown_code_is_refused_with_a_list_of_all() {
    for option in ["--allow", "--deny"] {
        let refused = run(&["check", ONE_ID, option, "renamed,no-such-code"]);
        assert_eq!(refused.status, 2);
        assert!(
            refused.err.contains("no-such-code") && refused.err.contains("no warning has this code"),
            "{}",
            refused.err
        );
        assert!(WarningCode::ALL.iter().all(|code| refused.err.contains(code.name())), "{}", refused.err);
    }
}

#[test]
fn a_warning_that_is_denied_is_an_error_after_the_answer() {
    let command = ["import", "nav2", ONE_ID, "--route", "0:1", "--radius", "0.3", "-q"];
    let plain = run(&command);
    assert_eq!((plain.status, plain.err.as_str()), (0, ""));
    for denied in ["renamed", "warnings", "closed-edge,renamed"] {
        let denied = run(&[&command[..], &["--deny", denied]].concat());
        assert_eq!((denied.status, &denied.out), (2, &plain.out));
        assert!(
            denied.err.starts_with("pcr: --deny: there are warnings of ") && denied.err.contains("renamed"),
            "{}",
            denied.err
        );
    }
    // What is acknowledged is no error, nor what does not occur.
    let names: Vec<&str> = answered(&parsed(&plain)).iter().map(|code| code.name()).collect();
    for options in [&["--deny", "warnings", "--allow", &names.join(",")][..], &["--deny", "closed-edge"]] {
        let run = run(&[&command[..], options].concat());
        assert_eq!((run.status, run.err.as_str()), (0, ""));
    }
}

#[test]
fn codes_before_and_after_the_command_count_together() {
    let command = ["import", "nav2", ONE_ID, "--route", "0:1", "--radius", "0.3"];
    let plain = run(&command);
    let names: Vec<&str> = answered(&parsed(&plain)).iter().map(|code| code.name()).collect();
    let [first, rest @ ..] = &names[..] else { panic!("{names:?}") };
    assert!(!rest.is_empty(), "{names:?}");
    let with = |before: &[&str], after: &[&str]| run(&[before, &command[..], after].concat());
    // Some are acknowledged before the command, the rest after it, or one code in both places.
    let rest = rest.join(",");
    for [before, after] in [[*first, &rest], [&rest, *first]] {
        let none = with(&["--allow", before], &["--allow", after]);
        assert_eq!((answered(&parsed(&none)), printed(&none)), (BTreeSet::new(), BTreeSet::new()), "{before} {after}");
    }
    let one = with(&["--allow", first], &["--allow", first]);
    assert_eq!(answered(&parsed(&one)).len(), names.len() - 1);
    // Denied before, something else denied after.
    for [before, after] in [[*first, "closed-edge"], ["closed-edge", *first]] {
        let denied = with(&["-q", "--deny", before], &["--deny", after]);
        assert_eq!(denied.status, 2, "{before} {after}: {}", denied.err);
        assert!(denied.err.contains(first), "{}", denied.err);
    }
    // Denied before the command and acknowledged after it: no error, as in one place.
    let all = names.join(",");
    assert_eq!(with(&["--deny", "warnings"], &["--allow", &all]).status, 0);
    assert_eq!(with(&["--allow", &all], &["--deny", "warnings"]).status, 0);
}

#[test]
fn no_more_warnings_are_printed_than_people_read() {
    let mut scenario = crossing();
    let warning =
        |code: WarningCode, count: usize| (0..count).map(move |k| code.text(format_args!("edge {k}: {code}")));
    let codes = &WarningCode::ALL[..6];
    let all: Vec<String> = codes.iter().flat_map(|&code| warning(code, 3)).collect();
    scenario["warnings"] = json!(all);
    let name = file("warnings", "many.json", scenario.to_string());
    let lines = |options: &[&str]| -> Vec<String> {
        let run = run(&[&["regions", &name], options].concat());
        assert!(run.status == 0 && !run.out.is_empty());
        run.err.lines().map(str::to_owned).collect()
    };
    let few = lines(&[]);
    assert_eq!(few.len(), 4, "{few:?}");
    assert!(few[0].ends_with("edge 0: left-out [left-out] and 2 more; --warnings all"), "{few:?}");
    let rest: Vec<&str> = codes[3..].iter().map(|code| code.name()).collect();
    assert!(few[3].ends_with(&format!(": 9 more, of {}; --warnings all", rest.join(", "))), "{few:?}");
    assert_eq!(lines(&["--warnings", "all"]).len(), all.len());
    assert!(lines(&["--allow", &codes.iter().map(|code| code.name()).collect::<Vec<_>>().join(",")]).is_empty());
    // The answer has them all.
    assert_eq!(parsed(&run(&["regions", &name, "--json"]))["warnings"], json!(all));
}

#[test]
fn agents_for_which_there_is_no_room_are_told_at_once_and_are_no_success() {
    let traffic = |agents: &[&str]| run(&[&["traffic", SAMPLE, "--radius", "0.3", "--json"], agents].concat());
    let many = traffic(&["--agents", "1000"]);
    let answer = parsed(&many);
    let (asked, placed) = (answer["asked"].as_u64().unwrap(), answer["placed"].as_u64().unwrap());
    assert_eq!((many.status, asked), (1, 1000), "{}", many.err);
    let told = many.err.split("--agents 1000: at most ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
    let room: u64 = told.parse().unwrap();
    assert!(
        placed <= room && room < 1000 && answered(&answer).contains(&WarningCode::AgentsLimited),
        "{room} {placed}"
    );
    // Who does what the message says is not warned again.
    let room = traffic(&["--agents", told]);
    assert!(!printed(&room).contains(&WarningCode::AgentsLimited), "{}", room.err);
    let few = traffic(&["--agents", "3"]);
    assert_eq!((few.status, &parsed(&few)["placed"]), (0, &json!(3)), "{}", few.err);
    // Without a number nobody was promised anything.
    let some = traffic(&[]);
    assert_eq!((some.status, &parsed(&some)["asked"]), (0, &json!(told.parse::<u64>().unwrap())), "{}", some.err);
}
