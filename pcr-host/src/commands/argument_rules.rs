//! Which arguments exclude one another and which need one another, each with the reason. They are declared here and nowhere else, so that
//! nothing is refused without it.

use ArgumentRelation::{Excludes, Needs};
use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, Error, ErrorKind};
use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Command};

/// What arguments are to others.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum ArgumentRelation {
    /// Neither stands beside any of the others.
    Excludes,
    /// Each stands beside one of the others.
    Needs,
}

/// A command, arguments of it by their names, what they are to others, and why. Without a name it is of all commands that have all of
/// these arguments.
pub(crate) type ArgumentRule =
    (&'static str, &'static [&'static str], ArgumentRelation, &'static [&'static str], &'static str);

/// All of them.
pub(crate) const RULES: [ArgumentRule; 38] = [
    ("", &["json"], Excludes, &["format"], "--json is --format json; give one of them"),
    ("demo", &["scenario"], Excludes, &["output"], "--scenario prints the scenario and draws no pictures"),
    (
        "certify",
        &["table"],
        Excludes,
        &["file"],
        "a table already contains all values; it is certified without a scenario",
    ),
    ("certify", &["table"], Excludes, &["scalar"], "a table says itself in which numbers it was computed"),
    (
        "simulate",
        &["foraging"],
        Excludes,
        &["file"],
        "--foraging has robots and paths of its own and reads no scenario",
    ),
    (
        "traffic",
        &["hours"],
        Excludes,
        &["output"],
        "files and pictures are of missions that all set off at once; of hours there is a table, JSON or CSV on standard output",
    ),
    (
        "traffic",
        &["missions"],
        Excludes,
        &["agents", "active", "hours", "seed", "compare", "stopped", "slip"],
        "vehicles and missions are those of the file, which run once and without random delays",
    ),
    ("traffic", &["vehicles"], Needs, &["missions"], "random missions have vehicles of their own; add --missions FILE"),
    (
        "traffic",
        &["closures", "breakdowns"],
        Needs,
        &["missions", "hours"],
        "a plan is of a site that does not change; add --hours H or --missions FILE",
    ),
    (
        "traffic",
        &["closures", "breakdowns"],
        Excludes,
        &["compare"],
        "methods are compared on a site that does not change",
    ),
    (
        "traffic",
        &["active", "compare", "stopped", "slip"],
        Needs,
        &["hours"],
        "without --hours each robot has one mission, which is planned and not run; add --hours H",
    ),
    (
        "locks",
        &["write"],
        Needs,
        &["output"],
        "the output is the file to be written, such as -o guarded.geojson; - is standard output",
    ),
    (
        "locks",
        &["split", "envelopes"],
        Needs,
        &["write"],
        "edges are cut and envelopes are written only in a file that is written; add --write FORMAT -o FILE",
    ),
    (
        "locks",
        &["write"],
        Excludes,
        &["lines", "edge", "index", "nodes", "delays"],
        "--write writes exclusions into the layout and lists no locks; list them in a second run",
    ),
    (
        "locks",
        &["audit"],
        Excludes,
        &["write", "lines", "index", "nodes", "delays"],
        "--audit looks at the exclusions in a file and does nothing else; give it in a run of its own",
    ),
    (
        "locks",
        &["node"],
        Needs,
        &["audit"],
        "an audit is of some nodes; the locks of one, as of an edge, are listed with --edge",
    ),
    (
        "locks",
        &["delays"],
        Excludes,
        &["edge", "index", "output"],
        "--delays prints start delays instead of locks; --edge, --index and --output are for locks",
    ),
    ("locks", &["certify"], Needs, &["delays"], "start delays are proved here; pcr certify proves locks; add --delays"),
    (
        "locks",
        &["certify"],
        Excludes,
        &["lines", "nodes"],
        "--certify proves the delays of pairs of edges; --lines and --nodes print other tables, in a run of their own",
    ),
    ("locks", &["lines"], Excludes, &["format", "json"], "--lines is a format of its own, JSON Lines"),
    (
        "locks",
        &["lines"],
        Excludes,
        &["output"],
        "--lines keeps no lock after it is printed; pictures need all of them",
    ),
    (
        "locks",
        &["edge"],
        Excludes,
        &["lines", "output"],
        "--edge prints the locks of one edge; --lines and pictures are of all edges",
    ),
    (
        "locks",
        &["index"],
        Excludes,
        &["lines", "output"],
        "--index writes the locks to a file; print or draw them in a second run",
    ),
    (
        "serve",
        &["broker"],
        Needs,
        &["fleet"],
        "the vehicles are described in a file; add --fleet FILE (docs/guide/serve.md)",
    ),
    (
        "serve",
        &["authority", "fleet"],
        Needs,
        &["broker"],
        "--authority and --fleet are of use at a broker only; add --broker HOST:PORT",
    ),
    (
        "serve",
        &["topics"],
        Needs,
        &["broker", "demo"],
        "topics are of use at a broker only; add --broker HOST:PORT, or --demo LAYOUT",
    ),
    (
        "serve",
        &["vehicles"],
        Needs,
        &["demo"],
        "only --demo simulates vehicles; those at a broker are described in --fleet FILE",
    ),
    (
        "serve",
        &["standby"],
        Needs,
        &["journal"],
        "a standby waits for the journal of another supervisor; add --journal DIR",
    ),
    ("serve", &["standby"], Excludes, &["check"], "--check waits for nobody: it only says what would be wrong"),
    ("serve", &["demo"], Excludes, &["stay"], "--demo always goes on when standard input ends"),
    (
        "serve",
        &["check"],
        Excludes,
        &["demo"],
        "--demo has a broker and a file of vehicles of its own: there is nothing to check",
    ),
    ("serve", &["demo"], Excludes, &["broker", "fleet"], "--demo starts a broker and vehicles of its own"),
    ("fleet", &["streets"], Excludes, &["layout"], "--streets makes a layout; give one of them"),
    ("fleet", &["alone"], Excludes, &["broker", "topics"], "--alone has no broker"),
    ("fleet", &["alone"], Excludes, &["manager"], "--alone always simulates the manager"),
    ("fleet", &["alone"], Excludes, &["pace"], "--alone is not tied to real time; it runs as fast as it can"),
    ("fleet", &["finish", "alone"], Needs, &["time"], "say how long it runs; add --time S"),
    (
        "fleet",
        &["certify"],
        Excludes,
        &[
            "layout", "streets", "broker", "vehicles", "manager", "topics", "pace", "time", "finish", "alone", "drops",
            "weather", "seed", "record", "profiles",
        ],
        "--certify looks at a record that is there and simulates nothing",
    ),
];

/// Those of a command.
fn of(command: &str) -> impl Iterator<Item = &'static ArgumentRule> {
    RULES.iter().filter(move |(name, ..)| name.is_empty() || *name == command)
}

/// A command whose arguments exclude one another. What they need is not declared: where it is excluded, the parser would not ask for it.
pub(super) fn ruled(command: Command) -> Command {
    let name = command.get_name().to_owned();
    let has = |id: &&str| command.get_arguments().any(|argument| argument.get_id() == *id);
    let applies = |(of, .., others, _): &&ArgumentRule| !of.is_empty() || others.iter().all(&has);
    let rules: Vec<&ArgumentRule> = of(&name).filter(|(.., rule, _, _)| *rule == Excludes).filter(applies).collect();
    command.mut_args(|argument| {
        let id = argument.get_id().to_string();
        let own = rules.iter().filter(|(_, arguments, ..)| arguments.contains(&id.as_str()));
        own.fold(argument, |argument: Arg, (.., others, _)| argument.conflicts_with_all(*others))
    })
}

/// The error of an argument without any of those that it needs.
pub(super) fn unmet(commands: &Command, given: &ArgMatches) -> Option<Error> {
    let (name, given) = given.subcommand()?;
    let command = commands.find_subcommand(name)?;
    let is_given =
        |id: &&str| given.ids().any(|one| one == id) && given.value_source(id) == Some(ValueSource::CommandLine);
    let is_broken = |(_, arguments, rule, others, _): &&ArgumentRule| {
        *rule == Needs && arguments.iter().any(is_given) && !others.iter().any(is_given)
    };
    let (.., others, why) = of(name).find(is_broken)?;
    let needed = command.get_arguments().filter(|argument| others.contains(&argument.get_id().as_str()));
    let needed: Vec<String> = needed.map(Arg::to_string).collect();
    let mut error = Error::new(ErrorKind::MissingRequiredArgument).with_cmd(command);
    error.insert(ContextKind::InvalidArg, ContextValue::Strings(vec![needed.join(" or ")]));
    advise(&mut error, why);
    Some(error)
}

/// Adds to an error what to do instead, or why.
pub(super) fn advise(error: &mut Error, tip: &str) {
    error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(tip.to_owned())]));
}

/// Why arguments are refused beside one another.
pub(super) fn why(error: &Error, command: &str) -> Option<&'static str> {
    if error.kind() != ErrorKind::ArgumentConflict {
        return None;
    }
    let ids = |kind| match error.get(kind) {
        Some(ContextValue::String(one)) => vec![id(one)],
        Some(ContextValue::Strings(several)) => several.iter().map(|one| id(one)).collect(),
        _ => Vec::new(),
    };
    let (wrong, prior) = (ids(ContextKind::InvalidArg), ids(ContextKind::PriorArg));
    let is = |of: &[String], one: &str| of.iter().any(|id| id == one);
    let meet = |one: &str, other: &str| is(&wrong, one) && is(&prior, other) || is(&wrong, other) && is(&prior, one);
    let breaks = |(_, arguments, rule, others, _): &&ArgumentRule| {
        *rule == Excludes && arguments.iter().any(|one| others.iter().any(|other| meet(one, other)))
    };
    of(command).find(breaks).map(|(.., why)| *why)
}

/// The name of an argument, which the parser shows as `--name <VALUE>` or `[NAME]`.
fn id(shown: &str) -> String {
    let shown = shown.trim_start_matches(['<', '[']).trim_start_matches("--");
    let end = shown.find(|letter: char| !letter.is_alphanumeric() && letter != '-').unwrap_or(shown.len());
    shown[..end].to_lowercase().replace('-', "_")
}
