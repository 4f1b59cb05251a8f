//! `pcr compare`: its forms.

use crate::fixture::{column, crossing, directory, file, run};

#[test]
fn two_scenarios_in_every_form() {
    let names = ["one", "two"].map(|name| file("compare", &format!("{name}.json"), crossing().to_string()));
    let of = |format: &str| {
        run(&["compare", &names[0], &names[1], "--method", "polyline", "--rounds", "1", "--format", format]).ok()
    };
    let table = of("table");
    // Both have the same name.
    assert!(names.iter().all(|name| table.contains(&format!("{name}: 2 agents\n\n"))), "{table}");
    assert!(table.contains("\n  polyline 1 mm ") && !table.contains("sampled"), "{table}");
    let csv = of("csv");
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines.len(), 1 + 2 * 4, "{csv}");
    assert!(lines.iter().all(|line| line.split(',').count() == 15), "{csv}");
    let markdown = of("markdown");
    assert!(names.iter().all(|name| markdown.contains(&format!("{name}: 2 agents\n\n| "))), "{markdown}");
    assert!(markdown.contains("\n| polyline 1 mm | intervals, conservative | "));
    for line in of("json").lines() {
        let value: serde_json::Value = serde_json::from_str(line).unwrap();
        let rows = value["rows"].as_array().unwrap();
        assert_eq!((rows.len(), &rows[0]["method"]), (4, &serde_json::json!("pcr f64")));
        assert!(rows.iter().all(|row| row["ms"].as_f64().unwrap() > 0.0));
    }
}

#[test]
fn charts_show_every_method() {
    let name = file("compare-charts", "one.json", crossing().to_string());
    let output = directory("compare-charts").join("charts");
    run(&["compare", &name, "--method", "polyline", "--rounds", "1", "-o", output.to_str().unwrap()]).ok();
    for (chart, methods) in
        [("regions-1.svg", vec!["pcr f64"]), ("conflicts-1.svg", vec!["pcr f64", "polyline 1 mm", "polyline 10 mm"])]
    {
        let svg = std::fs::read_to_string(output.join(chart)).unwrap();
        assert!(roxmltree::Document::parse(&svg).is_ok() && !svg.contains("NaN"), "{chart}");
        assert!(svg.contains(">crossing, 2 agents: "), "{svg}");
        assert!(methods.iter().all(|method| svg.contains(&format!(">{method}<"))), "{chart}");
    }
}

#[test]
fn several_orders_are_compared_as_one_scenario() {
    let order = |id: &str, y: f64| {
        let node = |k: u32| {
            serde_json::json!({ "nodeId": format!("{id}{k}"), "sequenceId": 2 * k, "released": true, "actions": [],
                "nodePosition": { "x": 4 * k, "y": y, "mapId": "m" } })
        };
        let edge = serde_json::json!({ "edgeId": "e", "sequenceId": 1, "released": true, "actions": [] });
        let order = serde_json::json!({ "orderId": id, "nodes": [node(0), node(1)], "edges": [edge] });
        file("compare-orders", &format!("{id}.json"), order.to_string())
    };
    let (a, b) = (order("a", 0.0), order("b", 0.1));
    let compared =
        run(&["compare", &a, &b, "--radius", "0.3", "--method", "polyline", "--rounds", "1", "--json", "-q"]).json();
    assert_eq!(compared["agents"], 2);
}

#[test]
fn a_scenario_that_is_refused_is_named() {
    let mut scenario = crossing();
    scenario["agents"][0]["radius"] = serde_json::json!(0);
    let name = file("compare", "wrong.json", scenario.to_string());
    let column = column(&scenario, "/agents/0/radius");
    let expected =
        format!("pcr: {name}:1:{column}: agent 1, radius: 0 is out of range; allowed is above 0, up to 1e10\n");
    assert_eq!(run(&["compare", &name]).failed(2), expected);
}
