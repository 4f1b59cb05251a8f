//! Every format by its file, through the commands.

use crate::fixture::{file, run};
use serde_json::Value;

fn real(name: &str) -> String {
    format!("{}/../tests/data/real/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// The table of locks of a layout.
#[track_caller]
fn locks(name: &str) -> Value {
    let run = run(&["locks", &real(name), "--radius", "0.4", "--format", "json"]);
    assert_eq!(run.status, 0, "{}", run.err);
    serde_json::from_str(&run.out).unwrap()
}

#[test]
fn layouts_are_known_by_name_and_content() {
    for name in [
        "nav2/aws_graph.geojson",
        "lif/example_07.lif.json",
        "rmf/office.building.yaml",
        "opendrive/Town02.planview.xodr",
        "ccbs/sparse_map.xml",
        "opentcs/Demo-01.xml",
    ] {
        assert!(!locks(name)["locks"].as_array().unwrap().is_empty(), "{name}");
    }
}

#[test]
fn plans_are_checked_as_they_are() {
    let check = |name: &str, radius: &str| run(&["check", &real(name), "--radius", radius, "--format", "json"]);
    let free = check("ccbs/example_grid_task_log.xml", "0.353553");
    assert_eq!((free.status, free.err.as_str()), (0, ""));
    let collides = check("ccbs/example_roadmap_task_log.xml", "0.353553");
    assert_eq!(collides.status, 1, "{}", collides.err);
    let verdict: Value = serde_json::from_str(&collides.out).unwrap();
    let deep =
        verdict["conflicts"].as_array().unwrap().iter().filter(|conflict| conflict["depth"].as_f64() > Some(1e-5));
    assert_eq!(
        deep.map(|conflict| (conflict["i"].as_u64(), conflict["j"].as_u64())).collect::<Vec<_>>(),
        [(Some(0), Some(3))]
    );
}

#[test]
fn points_of_paths_are_agents() {
    let circle: String = (0..=60).map(|k| (f64::from(k) * 0.05).sin_cos()).map(|(y, x)| format!("{x} {y}\n")).collect();
    let name = file("formats", "two.path", format!("{circle}\n-2 0.5\n2 0.5\n"));
    let out = run(&["import", "path", &name, "--radius", "0.3"]).out;
    let scenario: Value = serde_json::from_str(&out).unwrap();
    let kinds = |agent: usize| -> Vec<&str> {
        scenario["agents"][agent]["path"]
            .as_array()
            .unwrap()
            .iter()
            .map(|segment| segment["kind"].as_str().unwrap())
            .collect()
    };
    assert!(kinds(0).len() < 12 && kinds(0).iter().all(|kind| *kind == "arc"), "{scenario}");
    assert_eq!(kinds(1), ["line"]);
    let radius = scenario["agents"][0]["radius"].as_f64().unwrap();
    assert!(radius > 0.3003 && radius < 0.301, "the sagitta of the steps is margin: {radius}");
}

#[test]
fn what_is_something_else_is_said_to_be() {
    let message = |command: &str, name: &str| run(&[command, &real(name), "--radius", "0.4"]).failed(2);
    for (command, name, expected) in [
        ("regions", "opentcs/Demo-01.xml", "a layout has no agents; ask for routes with --route FROM:TO"),
        ("regions", "ccbs/example_grid_map.xml", "root: there is no log in it, hence no plan (read as ccbs)"),
        (
            "locks",
            "ccbs/example_grid_task_log.xml",
            "a plan of Continuous-CBS, with paths of its own; a layout is expected (read as ccbs)",
        ),
        ("locks", "vda5050/order_v2_flywei.json", "an order or a state is not a layout (read as vda5050)"),
        (
            "regions",
            "vda5050/order_v2_nulls_opentcs.json",
            "version: \"version\"; 2.0, 2.1 and 3.0 are read (read as vda5050)",
        ),
        ("locks", "rmf/config/office_tinyRobot_config.yaml", "it is the configuration of a fleet"),
    ] {
        // Warnings about the vehicle come first.
        let run = run(&[command, &real(name), "--radius", "0.4"]);
        assert_eq!(run.status, 2, "{name}");
        assert!(run.err.lines().last().unwrap().contains(expected), "{}", run.err);
    }
    assert!(message("regions", "README.md").contains("README.md: no scenario, which is a JSON object, nor "));
}

/// All files in a directory and those below it.
fn files(directory: &std::path::Path) -> Vec<std::path::PathBuf> {
    let mut entries: Vec<_> = std::fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    entries.into_iter().flat_map(|entry| if entry.is_dir() { files(&entry) } else { vec![entry] }).collect()
}

#[test]
fn every_real_file_is_read_or_refused_by_name() {
    let mut read = 0;
    for path in files(std::path::Path::new(&real(""))) {
        let name = path.to_str().unwrap();
        let pictures = file("formats", "pictures", "");
        // All regions of 240 robots that share most of their way take a minute here, and show no more than those of 190.
        let long = |arguments: &[&str]| name.contains("Paris") && matches!(arguments[0], "regions" | "plan");
        for arguments in [
            &["locks", name, "--radius", "0.3"][..],
            &["regions", name],
            &["check", name],
            &["plan", name],
            &["traffic", name, "--agents", "3", "--radius", "0.3"],
            // A file where a directory has to be: what can be drawn is refused for that, status 3.
            &["map", name, "-o", &pictures],
        ]
        .into_iter()
        .filter(|arguments| !long(arguments))
        {
            let run = run(arguments);
            assert!((0..=3).contains(&run.status), "{arguments:?}: {}", run.err);
            assert!(!run.err.contains("panicked"), "{arguments:?}: {}", run.err);
            if run.status >= 2 && arguments[0] != "map" {
                let last = run.err.lines().last().unwrap();
                let why = last.strip_prefix(&format!("pcr: {name}:")).unwrap_or_else(|| panic!("{last}"));
                assert!(why.len() > 10, "{arguments:?}: {last}");
            }
            read += usize::from(run.status <= 1);
        }
    }
    // Locks and traffic of 22 layouts; regions, conflicts and a plan of 9 logs, an order and 4 plans on grids; conflicts of a fifth one.
    assert_eq!(read, 2 * 22 + 3 * 14 + 1);
}

#[test]
fn damaged_files_are_refused_by_name() {
    let part = |name: &str, bytes: usize| std::fs::read_to_string(real(name)).unwrap()[..bytes].to_owned();
    let cases = [
        ("a.geojson", part("nav2/warehouse_graph.geojson", 3000), "not JSON: the text ends w"),
        ("a.lif.json", part("lif/example_07.lif.json", 2000), "not JSON: the text ends w"),
        ("a.building.yaml", part("rmf/office.building.yaml", 3000), "a.building.yaml:44:"),
        ("a.xodr", part("opendrive/Town01.planview.xodr", 4000), "not XML: unexpected end of stream"),
        ("a.xml", part("opentcs/Demo-01.xml", 5000), "not XML: unexpected end of stream"),
        ("b.geojson", part("opentcs/Demo-01.xml", 5000), "where a value is expected"),
        ("b.xodr", part("nav2/warehouse_graph.geojson", 3000), "not XML"),
        ("b.building.yaml", "levels: 7".to_owned(), "building, levels: a number where an object is expected"),
        (
            "c.geojson",
            "{\"features\": [{\"properties\": {\"id\": 1e400}}]}".to_owned(),
            "not JSON: 1e400 is not a finite number",
        ),
        ("empty.geojson", String::new(), "empty (read as nav2)"),
        ("empty.building.yaml", " \n".to_owned(), "empty (read as rmf)"),
        ("empty.json", "\u{feff}".to_owned(), "empty; a layout is expected"),
        ("list.json", "[1, 2".to_owned(), "not known as a layout by its name or content"),
    ];
    for (name, content, expected) in cases {
        let name = file("damaged", name, content);
        let failed = run(&["locks", &name, "--radius", "0.4"]).failed(2);
        // The line and the column of what is wrong in the text are where editors and terminals look for them.
        let place = failed.strip_prefix(&format!("pcr: {name}:")).unwrap_or_else(|| panic!("{failed}"));
        let is_placed = place.split(':').take(2).all(|number| number.parse::<usize>().is_ok());
        let is_text = !expected.starts_with("empty") && !expected.starts_with("not known");
        assert!(failed.contains(expected) && is_placed == is_text, "{failed}");
    }
    let huge = file("damaged", "huge.path", "0 0\n1e308 0\n");
    assert!(
        run(&["regions", &huge, "--radius", "0.4"])
            .err
            .contains("huge.path:2:1: two numbers x y up to 1e10 are expected")
    );
    // A graph is known by its content, too.
    let graph = file("damaged", "graph.json", std::fs::read(real("nav2/aws_graph.geojson")).unwrap());
    assert_eq!(run(&["locks", &graph, "--radius", "0.4"]).status, 0);
}
