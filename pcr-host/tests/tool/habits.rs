//! What users of other command line tools expect: help, completions, manual pages, quiet, and no option in vain.

use crate::fixture::{PAPER, crossing, directory, file, pcr, run};
use serde_json::Value;

const COMMANDS: [&str; 16] = [
    "regions",
    "certify",
    "check",
    "plan",
    "map",
    "simulate",
    "locks",
    "traffic",
    "nodes",
    "import",
    "serve",
    "compare",
    "demo",
    "fleet",
    "completions",
    "man",
];

fn real(name: &str) -> String {
    format!("{}/../tests/data/real/{name}", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn help_is_short() {
    for command in [&[][..]].into_iter().chain(COMMANDS.iter().map(std::slice::from_ref)) {
        let [short, long] = ["-h", "--help"].map(|option| run(&[command, &[option]].concat()).ok());
        assert!(short.lines().count() < 30, "{command:?}\n{short}");
        assert!(long.lines().count() < 60, "{command:?}\n{long}");
        assert!(long.lines().all(|line| line.chars().count() <= 100), "{command:?}\n{long}");
        // On a terminal of the usual width, lines are broken.
        let [narrow_short, narrow] = ["-h", "--help"].map(|option| {
            let output = pcr().args(command).arg(option).env("COLUMNS", "80").output().unwrap();
            String::from_utf8(output.stdout).unwrap()
        });
        assert!(narrow_short.lines().count() < 30, "{command:?}\n{narrow_short}");
        assert!(narrow.lines().count() < 60, "{command:?}\n{narrow}");
        assert!(narrow.lines().all(|line| line.chars().count() <= 80), "{command:?}\n{narrow}");
        assert!(!long.contains("see more"), "{command:?}\n{long}");
        assert!(short.contains("--help") && long.contains("Usage: pcr"), "{command:?}");
        assert_eq!(run(&[&["help"], command].concat()).ok(), long, "{command:?}");
    }
}

#[test]
fn help_is_of_one_command() {
    assert_eq!(run(&["help", "help"]).ok(), run(&["help"]).ok());
    let message = run(&["help", "plan", "extra"]).failed(2);
    assert_eq!(message, "pcr: extra: help is of one command at a time, such as pcr help plan\n");
}

#[test]
fn methods_have_one_name_for_programs() {
    let layout = real("nav2/warehouse_graph.geojson");
    let hours = ["traffic", &layout, "--radius", "0.3", "--agents", "3", "--hours", "0.01", "--compare"];
    let answer: Value = serde_json::from_str(&run(&[&hours[..], &["--json", "-q"]].concat()).out).unwrap();
    let csv = run(&[&hours[..], &["--format", "csv", "-q"]].concat()).out;
    let named = csv.lines().skip(1).map(|line| line.split(',').next().unwrap());
    let runs = answer["runs"].as_array().unwrap();
    assert!(named.eq(runs.iter().map(|run| run["method"].as_str().unwrap())), "{csv}");
    assert!(csv.contains("\nroute-locks,"), "{csv}");
}

#[test]
fn options_are_listed_where_they_do_something() {
    let help = |command: &str| run(&[command, "--help"]).ok();
    assert!(help("regions").contains("Layouts and other formats:\n") && help("plan").contains("--route <"));
    assert!(!run(&["regions", "-h"]).ok().contains("--route"));
    assert!(
        !help("locks").contains("--route") && help("locks").contains("--speed") && help("locks").contains("--radius")
    );
    for hidden in ["--index <", "--lines ", "--split <", "--envelopes <"] {
        assert!(help("locks").contains(hidden) && !run(&["locks", "-h"]).ok().contains(hidden), "{hidden}");
    }
    assert!(!help("traffic").contains("--horizon") && !help("import").contains("--from"));
    assert!(
        !help("check").contains("--margin") && !help("map").contains("--margin") && help("plan").contains("--margin")
    );
    assert!(!help("demo").contains("--radius"));
    // What all commands take is explained once, and named where it does something.
    let [short, all] = ["-h", "--help"].map(|option| run(&[option]).ok());
    for option in ["--allow <CODE>", "--deny <CODE>", "--progress", "--warnings <MANY>"] {
        assert!(all.contains(&format!("      {option} ")) && !short.contains(option), "{option}\n{all}");
    }
    for command in COMMANDS {
        let is_named = help(command).contains("(--allow, --deny, --progress: pcr --help)");
        assert_eq!(is_named, !["completions", "man"].contains(&command), "{command}");
    }
}

#[test]
fn options_that_do_nothing_are_refused() {
    let scenario = file("habits", "scenario.json", crossing().to_string());
    let mut wide = crossing();
    (0..2).for_each(|agent| wide["agents"][agent]["margin"] = serde_json::json!(0.05));
    let wide = file("habits", "wide.json", wide.to_string());
    let (nav2, plan) = (real("nav2/aws_graph.geojson"), real("ccbs/example_grid_task_log.xml"));
    let index = file("habits", "aws.locks", "");
    run(&["locks", &nav2, "--radius", "0.3", "--index", &index, "-q"]).ok();
    let maps = directory("habits").join("no-maps");
    let (maps, discs) =
        (maps.to_str().unwrap(), "--margin has no effect: this is about contacts of the discs themselves");
    let (delays, held) = ("has no effect: only start delays are searched for that long", "has no effect: ");
    let [straight, curved] = ["02", "17"].map(|number| real(&format!("lif/example_{number}.lif.json")));
    let order = real("vda5050/order_v2_flywei.json");
    let [square, bend] = [("square", "0 0\n4 0\n4 3\n"), ("bend", "0 0\n4 0\n8 1\n")]
        .map(|(name, points)| file("habits", &format!("{name}.path"), points));
    let (curve, corner) = (
        "--tolerance has no effect: there is no curve in",
        "--corner-radius has no effect: no corner of a route is rounded with it",
    );
    // Where they do something, they are taken; permission to leave parts out is one whatever the file is.
    run(&["nodes", &curved, "--tolerance", "0.01", "-q"]).ok();
    run(&["check", &bend, "--radius", "0.3", "--tolerance", "0.01", "-q"]).ok();
    run(&["nodes", &straight, "--partial", "-q"]).ok();
    // A radius of 0 says what is done anyway.
    for radius in ["0", "0.5", "2"] {
        run(&["check", &nav2, "--route", "11:13", "--corner-radius", radius, "-q"]).ok();
    }
    run(&["check", &nav2, "--route", "0:1", "--corner-radius", "0", "-q"]).ok();
    run(&["locks", &nav2, "--radius", "0.3", "--corner-radius", "0", "-q"]).ok();
    // Missions are random, and so is whether they have corners.
    run(&["traffic", &straight, "--radius", "0.3", "--agents", "1", "--corner-radius", "1", "-q"]).ok();
    // Of several files it is enough if one has something for it.
    let on = |files: &[&str]| {
        let options = ["--route", "A:B", "--radius", "0.3", "--tolerance", "0.01", "--json"];
        run(&[&["check"], files, &options].concat())
    };
    let plant = include_str!("../../../tests/data/small/plant.xml");
    let direct = plant.replace("y=\"-40\"", "y=\"0\"");
    let [bezier, direct, same] = [("bezier", plant), ("direct", &direct), ("same", &direct)]
        .map(|(name, text)| file("habits", &format!("{name}.xml"), text));
    let both = on(&[&direct, &bezier]);
    assert_eq!((both.status, both.out.lines().count(), both.err.contains("refused")), (0, 2, false), "{}", both.err);
    let none = "--tolerance has no effect on any of these files: there is no curve in what is read but lines and arcs";
    assert_eq!(on(&[&direct, &same]).failed(2), format!("pcr: {none}\n"));
    let margin = |files: &[&str]| run(&[&["regions"], files, &["--margin", "0.1", "--json"]].concat());
    let both = margin(&[&wide, &scenario]);
    assert_eq!((both.status, both.out.lines().count(), both.err.as_str()), (0, 2, ""));
    let none = "--margin has no effect on any of these files: every agent has a margin of its own";
    assert_eq!(margin(&[&wide, &wide]).failed(2), format!("pcr: {none}\n"));
    // A fleet counts as far as other options leave something of it.
    let [limits, named] = [("limits", ""), ("named", "  name: small\n")].map(|(name, more)| {
        file("habits", &format!("{name}.yaml"), format!("rmf_fleet:\n  limits: {{linear: [1.0, 0.5]}}\n{more}"))
    });
    let driven = ["regions", &nav2, "--route", "0:1", "--acceleration", "1", "--fleet"];
    run(&[&driven[..], &[&limits, "-q"]].concat()).ok();
    run(&[&driven[..], &[&named, "--speed", "1", "-q"]].concat()).ok();
    let fleet = [&driven[..], &[&limits, "--speed", "1"]].concat();
    for (arguments, reason) in [
        (&fleet[..], "--fleet has no effect: other options say all that is in it, or it says nothing"),
        (&["nodes", &straight, "--tolerance", "0.01"], curve),
        (&["locks", &straight, "--radius", "0.3", "--tolerance", "0.01"], curve),
        (&["regions", &straight, "--route", "N1:N2", "--tolerance", "0.01"], curve),
        (&["check", &order, "--tolerance", "0.01"], curve),
        (&["check", &square, "--tolerance", "0.01"], curve),
        (
            &["check", &order, "--horizon"],
            "--horizon has no effect: it is for orders that end in edges that are not released, and there is none",
        ),
        (&["check", &nav2, "--route", "0:1", "--corner-radius", "1"], corner),
        (&["check", &nav2, "--route", "11:13", "--corner-radius", "100"], corner),
        (&["check", &straight, "--route", "N1:N2", "--corner-radius", "1"], corner),
        (&["check", &scenario, "--horizon"][..], "--horizon has no effect: only orders of VDA 5050 have a horizon"),
        (&["check", &scenario, "--route", "1:2"], "--route has no effect: a scenario has its own vehicles and paths"),
        (&["import", "nav2", &nav2, "--from", "lif"], "--from: the format is named already, as the first argument"),
        (&["check", &plan, "--speed", "1"], "--speed has no effect: a plan has its own times"),
        (&["regions", &nav2, "--route", "0:1", "--graph", "1"], "--graph has no effect: only buildings of Open-RMF"),
        (&["locks", &nav2, "--route", "0:1"], "--route has no effect: locks are of all ways of a vehicle"),
        (&["traffic", &nav2, "--route", "0:1"], "--route has no effect: traffic has random routes"),
        (&["nodes", &nav2, "--radius", "1"], "--radius has no effect: this command lists what is in the file"),
        (&["simulate", &scenario, "--trips", "2"], "--trips has no effect: only foraging robots go to and fro"),
        (&["simulate", "--foraging", "--radius", "1"], "--radius has no effect: the foraging robots are as they are"),
        (&["simulate", &scenario, "--controller", "orca", "--replan", "1"], "--replan has no effect: only pcr plans"),
        (
            &["simulate", &scenario, "--controller", "potential", "--margin", "1"],
            "--margin has no effect: only pcr plans",
        ),
        (&["plan", &wide, "--margin", "0.1"], "--margin has no effect: every agent has a margin of its own"),
        (&["regions", &wide, "--margin", "0.1"], "--margin has no effect: every agent has a margin of its own"),
        (&["check", &scenario, "--margin", "0.1"], discs),
        (&["compare", &scenario, "--margin", "0.1"], discs),
        (&["map", &scenario, "--margin", "0.1", "-o", maps], discs),
        (&["check", &plan, "--partial"], "--partial has no effect: it is read whole or refused"),
        (&["plan", &scenario, "--method", "speed", "--prove"], delays),
        (&["plan", &scenario, "--method", "speed", "--time-limit", "5"], delays),
        (&["plan", &scenario, "--priority", "longest", "--prove"], "--prove has no effect: --priority gives the order"),
        (&["plan", &scenario, "--priority", "2", "--time-limit", "5"], "--time-limit has no effect: --priority gives"),
        (&["certify", &scenario, "--format", "csv", "--limit"], "--limit is for --format json and table"),
        (
            &["compare", &scenario, "--method", "nonsense"],
            "--method nonsense: no method has a name with that; there are ",
        ),
        (&["locks", &index, "--edge", "100", "--radius", "0.9"], held),
        (&["locks", &index, "--edge", "100", "--nodes"], held),
    ] {
        let message = run(arguments).failed(2);
        assert!(message.contains(reason), "{arguments:?}: {message}");
    }
    let run = run(&["check", PAPER, "--json", "--format", "csv"]);
    assert!(run.status == 2 && run.err.starts_with("error: "), "{}", run.err);
}

#[test]
fn refused_words_come_with_a_tip() {
    let layout = real("nav2/aws_graph.geojson");
    for (arguments, tip) in [
        (&["version"][..], "tip: pcr --version\n"),
        (&["plan", "--version"], "tip: pcr --version\n"),
        (&[PAPER], "tip: pcr check /"),
        (&["plan", PAPER, "-o", "-x.json"], "tip: what begins with - is given with an equals sign: -o=-x.json\n"),
        (
            &["check", PAPER, "-o", "x"],
            "pcr: --output has no effect: it is for poses with times, and the file holds none\n",
        ),
        (
            &["certify", PAPER, "-o", "x"],
            "tip: this command writes no file; its answer goes to standard output: > FILE\n",
        ),
        (&["regions", PAPER, "--output=x"], "tip: this command writes no file"),
        (&["locks", &layout, "--audit", "zones.json"], "with an equals sign: --audit=FILE\n"),
        (&["locks", &layout, "--write", "nav2"], "tip: the output is the file to be written, such as -o guarded"),
        (&["traffic", &layout, "--hours", "1", "-o", "x"], "tip: files and pictures are of missions that all set off"),
        (
            &["traffic", &layout, "--hours", "1", "--corner-radius", "1"],
            "with --hours robots turn in place at corners\n",
        ),
        (&["fleet", "--certify", "x", "--json"], "tip: --certify prints JSON, and nothing else does\n"),
        (&["traffic", &layout, "--seed", "-1"], "a whole number from 0 is expected\n"),
        (&["simulate", "--foraging", "--seed", "-1"], "a whole number from 0 is expected\n"),
        (&["serve", "--page", "x"], "a port (0 to 65535) or ADDRESS:PORT is expected\n"),
    ] {
        let run = run(arguments);
        assert_eq!((run.status, run.out.as_str()), (2, ""), "{arguments:?}");
        assert!(run.err.contains(tip) && run.err.matches("tip:").count() <= 1, "{arguments:?}: {}", run.err);
    }
    let message = run(&["locks", &layout, "--radius", "0.3", "-q", "--edge", "1", "--index", "none.locks"]).failed(2);
    assert!(message.starts_with("pcr: none.locks: there is no such table of locks"), "{message}");
}

#[test]
fn wrong_kinds_of_files_are_named() {
    let scenario = file("habits", "kind.json", crossing().to_string());
    let message = run(&["locks", &scenario]).failed(2);
    assert!(
        message.ends_with("kind.json: this is a scenario, with paths of its own; a layout is expected\n"),
        "{message}"
    );
    // What the tool itself writes is known by its format, whatever its keys are.
    let answer = |name: &str, arguments: &[&str]| file("habits", name, run(arguments).out);
    let graph = real("nav2/warehouse_graph.geojson");
    let regions = answer("regions.json", &["regions", &scenario, "--json"]);
    let plan = answer("plan.json", &["plan", &scenario, "--json"]);
    let locks = answer("locks.json", &["locks", &graph, "--radius", "0.4", "--json", "-q"]);
    let nodes = answer("nodes.json", &["nodes", &graph, "--json"]);
    let index = directory("habits").join("graph.locks");
    let index = index.to_str().unwrap();
    run(&["locks", &graph, "--radius", "0.4", "-q", "--index", index]).ok();
    let [table, binary] = ["certify --table reads; a scenario is expected\n", "with --edge\n"];
    for (arguments, expected) in [
        (
            &["check", &*regions][..],
            "1: this is pcr-regions, an answer of pcr, which pcr certify --table reads; a scenario",
        ),
        (&["certify", &regions], table),
        (
            &["check", &plan],
            "1: this is pcr-plan, an answer of pcr (pcr plan -o writes the scenario with the plan); a sc",
        ),
        (
            &["locks", &plan, "--radius", "0.4"],
            "this is pcr-plan, an answer of pcr (pcr plan -o writes the scenario with the",
        ),
        (&["locks", &locks, "--radius", "0.4"], "json: this is pcr-locks, an answer of pcr; a layout is expected\n"),
        (&["check", &nodes], "1: this is pcr-nodes, an answer of pcr; a scenario is expected\n"),
        (&["traffic", &nodes], "this is pcr-nodes, an answer of pcr; a layout is expected\n"),
        (&["certify", "--table", &regions], "no certificate in it; pcr regions --json --certificate prints one\n"),
        (&["certify", "--table", &scenario], "this is a scenario; without --table, the table that is computed for it"),
        (&["nodes", index], binary),
        (&["check", index], binary),
        (&["locks", index], binary),
    ] {
        let message = run(arguments).failed(2);
        assert!(message.contains(expected), "{arguments:?}: {message}");
    }
    let task = "<?xml version=\"1.0\" ?><root><agent start_id=\"1\" goal_id=\"2\"/></root>";
    let task = file("habits", "task.xml", task);
    for command in ["check", "plan", "locks"] {
        let message = run(&[command, &task]).failed(2);
        assert!(message.contains("a task of Continuous-CBS without its plan"), "{command}: {message}");
    }
}

#[test]
fn quiet_is_quiet() {
    let scenario = file("habits", "quiet.json", crossing().to_string());
    let layout = real("nav2/warehouse_graph.geojson");
    let silent = |arguments: &[&str], status: i32| {
        let run = run(arguments);
        assert_eq!((run.status, run.out.as_str(), run.err.as_str()), (status, "", ""), "{arguments:?}");
    };
    silent(&["check", "-q", &scenario], 1);
    silent(&["-q", "check", "-q", "--quiet", &scenario], 1);
    silent(&["regions", "--quiet", &layout, "--route", "0:50"], 0);
    let pictures = directory("habits").join("quiet");
    silent(&["-q", "plan", &scenario, "--pictures", pictures.to_str().unwrap()], 0);
    silent(&["-q", "map", &scenario, "-o", pictures.to_str().unwrap()], 0);
    // What only people look at is not written unasked.
    let empty = directory("habits-quiet");
    let demo = pcr().arg("-q").current_dir(&empty).output().unwrap();
    assert!(demo.status.success() && demo.stdout.is_empty() && demo.stderr.is_empty());
    assert_eq!(std::fs::read_dir(&empty).unwrap().count(), 0);
    silent(&["-q", "fleet", &layout, "--vehicles", "2", "--alone", "supervisor", "--time", "5"], 0);
    // What a program asked for is there all the same, and so are errors.
    assert_eq!(run(&["check", "-q", "--json", &scenario]).out.lines().count(), 1);
    assert!(run(&["check", "-q", "missing.json"]).failed(2).contains("missing.json"));
}

#[test]
fn json_is_short_for_its_format() {
    let scenario = file("habits", "short.json", crossing().to_string());
    for command in ["regions", "check", "plan"] {
        let [short, long] =
            [&["--json"][..], &["--format", "json"]].map(|form| run(&[&[command, &*scenario], form].concat()).out);
        assert_eq!(short, long, "{command}");
        assert!(serde_json::from_str::<Value>(&short).is_ok());
    }
}

#[test]
fn completions_and_manual_pages_name_every_command() {
    for (shell, mark) in [
        ("bash", "complete -F _pcr"),
        ("zsh", "#compdef pcr"),
        ("fish", "complete -c pcr"),
        ("powershell", "Register-ArgumentCompleter"),
    ] {
        let text = run(&["completions", shell]).ok();
        assert!(text.contains(mark) && COMMANDS.iter().all(|command| text.contains(command)), "{shell}");
        assert!(text.contains("closest") && text.contains("corner-radius"), "{shell}");
    }
    let page = run(&["man"]).ok();
    assert!(page.contains(".TH pcr 1") && COMMANDS.iter().all(|command| page.contains(command)), "{page}");
    assert!(page.contains(".SH SUBCOMMANDS"), "{page}");
    let page = run(&["man", "plan"]).ok();
    assert!(!page.contains("SUBCOMMANDS") && page.contains(".SH \"LAYOUTS AND OTHER FORMATS\"\n"), "{page}");
    assert!(page.contains(".SH SYNOPSIS\n\\fBpcr plan\\fR [OPTIONS] [FILE]...\n"), "{page}");
    assert!(page.contains(&format!(".TH pcr-plan 1  \"pcr-plan {}\"", env!("CARGO_PKG_VERSION"))), "{page}");
    assert!(page.contains("\\-\\-priority") && page.contains("\n.SH \"EXIT STATUS\"\n.nf\n\\&  0  a plan"), "{page}");
    // What it is, in one line, and not again in the description.
    let page = run(&["man"]).ok();
    let (name, rest) = page.split_once(".SH NAME\n").unwrap().1.split_once(".SH SYNOPSIS").unwrap();
    assert!(name.starts_with("pcr \\- Exact collision regions of discs on paths of lines and arcs\n"), "{name}");
    assert!(!name.contains(".PP"), "{name}");
    assert!(rest.contains(".SH \"EXAMPLES\"\n.nf\n\\&  pcr   ") && !rest.contains("EXTRA"), "{rest}");
    let fleet = run(&["man", "fleet"]).ok();
    assert!(fleet.contains(".SH \"NOTES\"\n.nf\n\\&User and password"), "{fleet}");
    // A colon would end the name of a value.
    let zsh = run(&["completions", "zsh"]).ok();
    assert!(zsh.contains(":FROM\\:TO[@TIME]:") && !zsh.contains(":FROM:"), "{zsh}");
    assert!(!zsh.contains(":HOST:PORT"), "{zsh}");
    // Commands are offered for what they are expected for.
    let bash = run(&["completions", "bash"]).ok();
    assert!(
        bash.contains(
            "opts=\"-q -h -V --quiet --progress --allow --deny --warnings --help --version regions certify check plan map"
        ),
        "{bash}"
    );
}

#[test]
fn names_that_editors_give_to_every_layout_are_none() {
    for (layout, name) in [
        ("ccbs/sparse_map.xml", "sparse_map"),
        ("rmf/office.building.yaml", "office"),
        ("rmf/hotel.building.yaml", "hotel"),
        ("nav2/aws_graph.geojson", "aws_graph"),
        ("lif/example_07.lif.json", "LIF Example 07"),
    ] {
        assert_eq!(run(&["nodes", &real(layout), "--json", "-q"]).json()["layout"], name);
    }
}

#[test]
fn layouts_are_listed() {
    let table = run(&["nodes", &real("lif/example_07.lif.json")]).ok();
    assert!(table.contains("vehicle types: "), "{table}");
    let listing = run(&["nodes", &real("nav2/aws_graph.geojson"), "--json", "-q"]).json();
    let (nodes, edges) = (listing["nodes"].as_array().unwrap(), listing["edges"].as_array().unwrap());
    assert!(!nodes.is_empty() && edges.iter().all(|edge| edge["length"].as_f64().unwrap() >= 0.0));
    assert!(nodes.iter().any(|node| node["id"] == edges[0]["from"]), "{listing}");
    let csv = run(&["nodes", &real("nav2/aws_graph.geojson"), "--format", "csv", "-q"]).ok();
    assert_eq!(csv.lines().count(), 1 + nodes.len() + edges.len());
    assert!(csv.lines().all(|line| line.split(',').count() == 14), "{csv}");
}
