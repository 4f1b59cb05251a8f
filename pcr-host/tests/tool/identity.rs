//! Agents and files by their names, in everything that is said about them.

use crate::fixture::{Run, crossing, directory, file, run, run_with, straight};
use serde_json::{Value, json};
use std::fs;

fn real(name: &str) -> String {
    format!("{}/../tests/data/real/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// The crossing of two agents with labels.
fn labelled() -> Value {
    let mut scenario = crossing();
    scenario["agents"][0]["label"] = json!("AGV-7, east");
    scenario["agents"][1]["label"] = json!("AGV-9");
    scenario
}

#[test]
fn labels_are_in_every_answer() {
    let name = file("identity", "labelled.json", labelled().to_string());
    let labels = json!({ "1": "AGV-7, east", "2": "AGV-9" });
    for command in ["regions", "check", "plan", "simulate"] {
        let json: Value = serde_json::from_str(&run(&[command, &name, "--json"]).out).unwrap();
        assert_eq!(json["labels"], labels, "{command}");
        let csv = run(&[command, &name, "--format", "csv"]).out;
        assert!(csv.contains("\"AGV-7, east\"") && csv.lines().next().unwrap().contains("label"), "{command}: {csv}");
    }
    for command in ["regions", "check", "plan"] {
        let table = run(&[command, &name]).out;
        assert!(table.contains("1 AGV-7, east") && table.contains("2 AGV-9"), "{command}: {table}");
    }
    let plain: Value =
        serde_json::from_str(&run_with(&["check", "--json"], crossing().to_string().as_bytes()).out).unwrap();
    assert_eq!(plain["labels"], Value::Null, "where nobody has one there is none");
    let maps = directory("identity").join("maps");
    run(&["map", &name, "-q", "-o", maps.to_str().unwrap()]).ok();
    for (picture, times) in [("ecm-1.svg", 2), ("overview.svg", 2), ("workspace.svg", 1), ("index.html", 1)] {
        let text = fs::read_to_string(maps.join(picture)).unwrap();
        assert!(text.matches("AGV-9").count() + text.matches("AGV-7").count() >= times, "{picture}");
    }
    let replay = run(&["simulate", &name, "--controller", "pcr", "-q", "-o", "-"]).ok();
    assert!(replay.contains("\"name\":\"1 AGV-7, east\""), "the robots of the page have their names");
    let plan = run(&["plan", &name, "-q", "-o", "-"]).out;
    assert!(plan.contains("\"label\": \"AGV-7, east\""), "{plan}");
}

#[test]
fn agents_are_asked_for_by_number_or_label() {
    let name = file("identity", "asked.json", labelled().to_string());
    let [by_number, by_label] = ["2", "AGV-9"].map(|agent| run(&["regions", &name, "--json", "--agent", agent]).json());
    assert_eq!(by_number, by_label);
    let order = |priority: &str| run(&["plan", &name, "--json", "--priority", priority]).json()["order"].clone();
    assert_eq!((order("AGV-9,1"), order("1,AGV-9")), (json!([2, 1]), json!([1, 2])));
    let message = run(&["regions", &name, "--agent", "AGV-8"]).failed(2);
    assert!(message.ends_with("asked.json: no agent AGV-8; there are 1 AGV-7, east, 2 AGV-9\n"), "{message}");
    let mut twins = labelled();
    twins["agents"][0]["label"] = json!("AGV-9");
    let twins = file("identity", "twins.json", twins.to_string());
    let message = run(&["regions", &twins, "--agent", "AGV-9"]).failed(2);
    assert!(message.ends_with("several agents are called AGV-9; say which by its number: 1, 2\n"), "{message}");
}

#[test]
fn texts_may_be_ids() {
    let mut scenario = crossing();
    scenario["agents"][0]["id"] = json!("tugger");
    scenario["agents"][1]["id"] = json!("forklift");
    let found = run_with(&["check"], scenario.to_string().as_bytes());
    assert!(found.out.contains("1 tugger  2 forklift"), "{}", found.out);
}

fn order(serial: Option<&str>, id: &str, y: f64) -> Value {
    let node = |x: f64| {
        json!({ "nodeId": format!("{id}{x}"), "sequenceId": (x / 2.0) as u32, "released": true, "actions": [],
            "nodePosition": { "x": x, "y": y, "mapId": "m" } })
    };
    let edge = json!({ "edgeId": "e", "sequenceId": 1, "released": true, "actions": [] });
    json!({ "serialNumber": serial, "orderId": id, "nodes": [node(0.0), node(4.0)], "edges": [edge] })
}

#[test]
fn importers_keep_names() {
    let orders = [order(Some("AGV-7"), "o-1", 0.0), order(Some("AGV-9"), "o-2", 0.1), order(None, "o-3", 9.0)];
    let check = |run: Run, labels: Value| {
        let answer: Value = serde_json::from_str(&run.out).unwrap_or_else(|_| panic!("{}", run.err));
        assert_eq!(answer["labels"], labels);
        answer
    };
    let labels = json!({ "1": "AGV-7 o-1", "2": "AGV-9 o-2", "3": "o-3" });
    let together = file("identity", "orders.json", json!(orders).to_string());
    let answer = check(run(&["check", &together, "--radius", "0.3", "--json", "-q"]), labels.clone());
    assert_eq!(answer["name"], "orders", "several orders have the name of their file");
    let each = [0, 1, 2].map(|k| file("identity", &format!("order-{k}.json"), orders[k].to_string()));
    check(run(&["check", &each[0], &each[1], &each[2], "--radius", "0.3", "--json", "-q"]), labels);
    let alone = run(&["check", &each[0], "--radius", "0.3", "--json", "-q"]);
    assert_eq!(check(alone, json!({ "1": "AGV-7 o-1" }))["name"], "o-1");

    let routes = |name: &str, routes: [&str; 2], labels: Value| {
        let arguments =
            ["check", &real(name), "--route", routes[0], "--route", routes[1], "--radius", "0.1", "--json", "-q"];
        check(run(&arguments), labels);
    };
    routes("nav2/aws_graph.geojson", ["0:1", "1:0"], json!({ "1": "0 > 1", "2": "1 > 0" }));
    routes("lif/example_07.lif.json", ["N3:N11", "N3:N1"], json!({ "1": "N3 > N11", "2": "N3 > N1" }));
    let names = json!({ "1": "presupplies > patrol_D2", "2": "patrol_D1 > L1/45" });
    routes("rmf/office.building.yaml", ["presupplies:patrol_D2", "L1/43:L1/45"], names);
    let first = "Vehicle-01-VDA5050-2.0 Point-0001 > Point-0002";
    let run = run(&["check", &real("opentcs/Demo-01.xml"), "--route", "Point-0001:Point-0002", "--json", "-q"]);
    check(run, json!({ "1": first }));
}

#[test]
fn files_without_a_name_answer_by_their_own() {
    let name = |arguments: &[&str], field: &str| -> Value {
        let run = run(&[arguments, &["--json", "-q"]].concat());
        serde_json::from_str::<Value>(&run.out).unwrap_or_else(|_| panic!("{}", run.err))[field].clone()
    };
    let plan = real("ccbs/example_grid_task_log.xml");
    assert_eq!(name(&["check", &plan, "--radius", "0.35"], "name"), "example_grid_task_log");
    let csv = run(&["check", &real("ccbs/example_roadmap_task_log.xml"), "--radius", "0.35", "--format", "csv"]).out;
    assert!(csv.contains("\nexample_roadmap_task_log,"), "{csv}");
    let collection = json!({ "type": "FeatureCollection", "features": [
        { "type": "Feature", "properties": { "id": 1 }, "geometry": { "type": "Point", "coordinates": [0, 0] } },
        { "type": "Feature", "properties": { "id": 2 }, "geometry": { "type": "Point", "coordinates": [5, 0] } },
        { "type": "Feature", "properties": { "id": 3, "startid": 1, "endid": 2 },
          "geometry": { "type": "LineString", "coordinates": [[0, 0], [5, 0]] } }] });
    let geojson = file("identity", "hall 5.geojson", collection.to_string());
    assert_eq!(name(&["locks", &geojson, "--radius", "0.4"], "layout"), "hall 5");
    let mut nameless = crossing();
    nameless.as_object_mut().unwrap().remove("name");
    let nameless = file("identity", "shift.2.json", nameless.to_string());
    assert_eq!(name(&["plan", &nameless], "name"), "shift.2");
    let maps = directory("identity").join("stem");
    run(&["map", &nameless, "-q", "-o", maps.to_str().unwrap()]).ok();
    assert!(fs::read_to_string(maps.join("index.html")).unwrap().contains("<title>shift.2"));
}

#[test]
fn no_plan_says_why_and_where() {
    let north = std::f64::consts::FRAC_PI_2;
    let unsolved = |agents: [Value; 2]| {
        let run = run_with(&["plan", "--json"], json!({ "agents": agents }).to_string().as_bytes());
        assert_eq!(run.status, 1);
        serde_json::from_str::<Value>(&run.out).unwrap()["unsolved"][0].clone()
    };
    let head_on = unsolved([straight(1, [0.0, 0.0, 0.0], 4.0), straight(2, [4.0, 0.0, 2.0 * north], 4.0)]);
    let why = head_on["why"].as_str().unwrap();
    assert!(
        why.starts_with("head-on without a passing place: the second stands at its start in the way of the first, and")
    );
    assert!(why.ends_with("around (2.000, 0.000)"), "{why}");
    let length = |agent: usize, end: usize| head_on["lengths"][agent][end].as_f64().unwrap();
    assert!([length(0, 0), length(1, 0)].iter().all(|lo| *lo == 0.0) && length(0, 1) > 3.99, "{head_on}");
    // The second stands on the path of the first, and for good.
    let mut parked = straight(2, [2.0, 0.2, 0.0], 0.0);
    parked["path"] = json!([]);
    let blocked = unsolved([straight(1, [0.0, 0.0, 0.0], 4.0), parked]);
    let why = blocked["why"].as_str().unwrap();
    let expected =
        "no order is possible: the first stays at its end in the way of the second, and the first stands at its start";
    assert!(why.starts_with(expected), "{why}");
    assert_eq!((&blocked["ids"], &blocked["at"]), (&json!([2, 1]), &json!([2.0, 0.2])), "{blocked}");
    let starts = unsolved([straight(1, [0.0, 0.0, 0.0], 4.0), straight(2, [0.2, 0.0, north], 4.0)]);
    assert!(starts["why"].as_str().unwrap().starts_with("they overlap at their starts, on lengths 0.000"), "{starts}");
    assert_eq!(starts["lengths"], json!([[0.0, 0.0], [0.0, 0.0]]));
}

#[test]
fn shallow_conflicts_are_not_zero() {
    // Beside one another, 2 micrometres nearer than their radii allow; and as near as they are allowed to be.
    let pair =
        |apart: f64| json!({ "agents": [straight(1, [0.0, 0.0, 0.0], 4.0), straight(2, [0.0, apart, 0.0], 4.0)] });
    let table = |apart: f64| run_with(&["check", "--closest"], pair(apart).to_string().as_bytes()).out;
    let shallow = table(0.499998);
    assert!(shallow.contains("  2e-6  ") && shallow.contains("  -2e-6\n") && !shallow.contains('*'), "{shallow}");
    let touching = table(0.5);
    assert!(
        touching.contains("  touching\n") && touching.contains("  *\n") && touching.contains("\n* touching (1): "),
        "{touching}"
    );
}

#[test]
fn numbers_and_words_that_are_labels_of_others_are_not_guessed() {
    let mut scenario = crossing();
    scenario["agents"][0]["label"] = json!("2");
    scenario["agents"][1]["label"] = json!("longest");
    let name = file("identity", "swapped.json", scenario.to_string());
    let expected =
        "swapped.json: 2 is the number of agent 2, and the label of another one, 1; give that another label\n";
    for arguments in [&["regions", &name, "--agent", "2"][..], &["plan", &name, "--priority", "2,1"]] {
        let message = run(arguments).failed(2);
        assert!(message.ends_with(expected), "{message}");
    }
    run(&["regions", &name, "--agent", "1", "-q"]).ok();
    let message = run(&["plan", &name, "--priority", "longest"]).failed(2);
    assert!(
        message.contains("--priority longest is an order, and the label of agent 2; name that by its"),
        "{message}"
    );
    // Nobody who asks for no order has to know.
    scenario["agents"][1]["label"] = json!("best");
    let name = file("identity", "best.json", scenario.to_string());
    run(&["plan", &name, "-q"]).ok();
    // An agent may have its own number as its label.
    scenario["agents"][0]["label"] = json!("1");
    let name = file("identity", "own.json", scenario.to_string());
    run(&["regions", &name, "--agent", "1", "-q"]).ok();
}

#[test]
fn files_of_one_name_are_told_apart() {
    let mut nameless = crossing();
    nameless.as_object_mut().unwrap().remove("name");
    let [a, b] = ["a", "b"].map(|folder| {
        let folder = directory("identity").join(folder);
        fs::create_dir_all(&folder).unwrap();
        let file = folder.join("f.json");
        fs::write(&file, nameless.to_string()).unwrap();
        file.to_str().unwrap().to_owned()
    });
    let names = |arguments: &[&str]| -> Vec<Value> {
        let run = run(&[arguments, &["--json"]].concat());
        run.out.lines().map(|line| serde_json::from_str::<Value>(line).unwrap()["name"].clone()).collect()
    };
    for command in ["check", "regions", "plan"] {
        assert_eq!(names(&[command, &a, &b]), [json!(a), json!(b)], "{command}");
    }
    assert_eq!(names(&["check", &a]), [json!("f")]);
    fs::write(&b, "{}").unwrap();
    assert_eq!(names(&["check", &a, &b]), [json!(a), json!(b)], "what is refused is named as well");
}

#[cfg(unix)]
#[test]
fn names_of_files_are_printed_as_one_line() {
    let message = run(&["check", "no\u{1b}[31m\nfile.json"]).failed(2);
    assert!(message.starts_with("pcr: no\\u{1b}[31m\\nfile.json: cannot be read: "), "{message}");
}
