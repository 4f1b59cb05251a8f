//! Degrees where radians are expected, and degrees that are declared.

use crate::fixture::{file, run};
use serde_json::{Value, json};

/// Two agents that cross at the origin if the second one drives north.
fn fleet(start: Value) -> String {
    let path = json!([{ "kind": "line", "length": 8 }]);
    let agent = |id: u64, start: Value| json!({ "id": id, "radius": 0.4, "v_max": 1, "a_max": 0.5, "start": start, "path": path });
    json!({ "agents": [agent(1, json!({ "x": -4, "y": 0, "heading": 0 })), agent(2, start)] }).to_string()
}

#[test]
fn degrees_are_read_as_degrees() {
    let degrees = file("units", "degrees.json", fleet(json!({ "x": 0, "y": -4, "heading_deg": 90 })));
    let found = run(&["check", &degrees]);
    assert_eq!((found.status, found.err.as_str()), (1, ""), "{}", found.out);
    // A plan has the paths in radians, and nothing to warn about.
    let plan = run(&["plan", &degrees, "-o", "-", "-q"]).ok();
    let again = file("units", "plan.json", plan);
    assert_eq!(run(&["check", &again]).status, 0);
}

#[test]
fn degrees_in_place_of_radians_are_doubted() {
    let radians = file("units", "radians.json", fleet(json!({ "x": 0, "y": -4, "heading": 90 })));
    let doubt = "agent 2, start.heading: 90 is more than one turn in radians; use heading_deg for degrees";
    for arguments in [&["check", &radians][..], &["regions", &radians], &["plan", &radians], &["certify", &radians]] {
        let run = run(arguments);
        assert!(run.err.contains(doubt), "{arguments:?}: {}", run.err);
    }
    let answer: Value = serde_json::from_str(&run(&["check", &radians, "--json", "-q"]).out).unwrap();
    let warnings = answer["warnings"].as_array().unwrap();
    assert!(warnings.len() == 1 && warnings[0].as_str().unwrap().starts_with(doubt), "{answer}");
    let line = run(&["check", &radians]).err;
    assert_eq!(line.matches("more than one turn").count(), 1, "{line}");
    let declared = std::fs::read_to_string(&radians).unwrap().replacen('{', r#"{"angles":"radians","#, 1);
    let declared = file("units", "declared.json", declared);
    assert_eq!(run(&["check", &declared]).err, "");
    let sweep = r#"{"agents":[{"id":1,"radius":0.4,"v_max":1,"a_max":0.5,"start":{"x":-4,"y":0,"heading":0},"path":[{"kind":"arc","radius":2,"sweep":90}]}]}"#;
    let sweep = run(&["check", &file("units", "sweep.json", sweep)]);
    assert!(
        sweep.err.contains("agent 1, segment 1, sweep: 90 is more than one turn in radians; use sweep_deg"),
        "{}",
        sweep.err
    );
}

#[test]
fn units_are_in_the_help() {
    for arguments in [&["--help"][..], &["check", "--help"], &["plan", "--help"], &["regions", "--help"]] {
        let help = run(arguments).ok();
        assert!(help.contains("metres, seconds, radians") && help.contains("heading_deg, sweep_deg"), "{help}");
    }
}
