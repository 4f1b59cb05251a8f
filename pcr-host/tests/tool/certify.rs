//! `pcr certify`: what is told beside the verdict, and tables that are refused.

use crate::fixture::{crossing, file, run, straight};
use serde_json::{Value, json};

/// The answer of `pcr regions` with its table.
fn table(name: &str, scenario: &Value, more: &[&str]) -> Value {
    let scenario = file("certify", name, scenario.to_string());
    run(&[&["regions", &scenario, "--json", "--certificate"], more].concat()).json()
}

/// What `pcr certify` says about a changed table.
#[track_caller]
fn refused(name: &str, table: &Value) -> String {
    let name = file("certify", name, table.to_string());
    let message = run(&["certify", "--table", &name]).failed(2);
    message.trim_end().strip_prefix(&format!("pcr: {name}: ")).unwrap().to_owned()
}

#[test]
fn labels_and_warnings_are_told() {
    let mut scenario = crossing();
    scenario["agents"][0]["label"] = json!("AGV-7");
    scenario["warnings"] = json!(["edge 3: guessed"]);
    let told = table("labelled.json", &scenario, &["-q"]);
    let (labels, warnings) = (json!({ "1": "AGV-7" }), json!(["edge 3: guessed [uncoded]"]));
    let name = file("certify", "labelled-table.json", told.to_string());
    let scenario = file("certify", "labelled.json", scenario.to_string());
    for arguments in
        [["certify", "--table", &name, "--json", "-q"], ["certify", &scenario, "--json", "-q", "--scalar=q16"]]
    {
        let proved = run(&arguments).json();
        assert_eq!((&proved["verdict"], &proved["pairs"]), (&json!("proved"), &json!(1)), "{arguments:?}");
        assert_eq!((&proved["labels"], &proved["warnings"]), (&labels, &warnings), "{arguments:?}");
    }
    // A length that the regions tell as well: only the table is wrong, and its points name the agents.
    let mut wrong = told;
    wrong.as_object_mut().unwrap().remove("regions");
    let pair = &mut wrong["certificate"][0]["pairs"][0];
    for range in ["/regions/0/lengths/0/1", "/pieces/0/lengths/0/1"] {
        let length = pair.pointer_mut(range).unwrap();
        *length = json!(length.as_f64().unwrap() - 0.1);
    }
    let name = file("certify", "short.json", wrong.to_string());
    let found = run(&["certify", "--table", &name]);
    assert!(found.status == 1 && found.out.contains("1 AGV-7"), "{}", found.out);
    let found = run(&["certify", "--table", &name, "--format", "csv"]);
    assert!(found.status == 1 && found.out.lines().nth(1).unwrap().ends_with(",AGV-7,"), "{}", found.out);
}

#[test]
fn tables_of_other_formats_and_of_nothing_are_refused() {
    let told = table("crossing.json", &crossing(), &[]);
    let changed = |key: &str, value: Value| {
        let mut other = told.clone();
        other[key] = value;
        refused("other.json", &other)
    };
    assert_eq!(changed("format", json!("pcr-plan")), "format: \"pcr-plan\" where \"pcr-regions\" is expected");
    assert_eq!(changed("version", json!(99)), "version: 99 where 2 or an earlier one is expected");
    // Whoever makes a table of its own need not say what it is.
    let bare = json!({ "name": told["name"], "certificate": told["certificate"] });
    let bare = file("certify", "bare.json", bare.to_string());
    assert_eq!(run(&["certify", "--table", &bare, "--json"]).json()["verdict"], "proved");
    // Discs of one number would be discs of one body.
    let mut same = told.clone();
    same["certificate"][0]["agents"][1]["id"] = json!(1);
    same["certificate"][0]["pairs"] = json!([]);
    let message = "2 bodies have the number 1, and bodies tell of no agent of this number";
    assert_eq!(refused("same.json", &same), message);
    same["bodies"] = json!([{ "id": 1, "parts": [{}, {}, {}] }]);
    assert_eq!(refused("same.json", &same), "2 bodies have the number 1, and bodies tell of 3");
    // As version 1 had it.
    same["version"] = json!(1);
    let covers = same.as_object_mut().unwrap().remove("bodies");
    same["footprints"] = json!([{ "id": 1, "discs": covers.unwrap()[0]["parts"] }]);
    assert_eq!(refused("same.json", &same), "2 bodies have the number 1, and bodies tell of 3");
    // Two parts of one agent are no pair.
    let outline = json!({ "polygon": [{ "ahead": 1, "left": 0.2 }, { "ahead": -1, "left": 0.2 }, { "ahead": -1, "left": -0.2 },
        { "ahead": 1, "left": -0.2 }, { "ahead": 0, "left": -0.1 }] });
    let mut alone = straight(1, [0.0, 0.0, 0.0], 4.0);
    alone.as_object_mut().unwrap().remove("radius");
    alone["footprint"] = outline;
    let name = file("certify", "alone.json", json!({ "agents": [alone] }).to_string());
    let nothing = |name: &str| format!("pcr: {name}: there are no two agents of which contacts could be certified\n");
    assert_eq!(run(&["certify", &name]).failed(2), nothing(&name));
    let told = table("alone.json", &json!({ "agents": [alone] }), &[]);
    let name = file("certify", "alone-table.json", told.to_string());
    assert_eq!(run(&["certify", "--table", &name]).failed(2), nothing(&name));
    // Loads are other discs of one body, on other stretches.
    let mut loaded = straight(1, [-2.0, 0.0, 0.0], 2.0);
    loaded["path"] = json!([{ "kind": "line", "length": 2 }, { "kind": "line", "length": 2 }]);
    loaded["loads"] = json!([{ "segments": [2, 2], "radius": 0.4 }]);
    let mut both = crossing();
    both["agents"][0] = loaded;
    let name = file("certify", "loaded.json", table("both.json", &both, &[]).to_string());
    assert_eq!(run(&["certify", "--table", &name, "--json"]).json()["pairs"], 2);
}

/// Regions beside a table are those of the table.
#[test]
fn regions_that_are_none_of_the_table_are_refused() {
    let told = table("told.json", &crossing(), &["--margin", "0.1"]);
    let name = file("certify", "told-table.json", told.to_string());
    assert!(run(&["certify", "--table", &name]).ok().contains("proved"));
    let changed = |pointer: &str, change: &dyn Fn(&mut Value)| {
        let mut other = told.clone();
        change(other.pointer_mut(pointer).unwrap());
        refused("changed.json", &other)
    };
    let later = |number: &mut Value| *number = json!(number.as_f64().unwrap() + 1e-9);
    let of_both = ", of agents 1 and 2: ";
    for (pointer, place) in [
        ("/regions/0/t/0", "regions[0], of agents 1 and 2: t is ["),
        ("/regions/1/l/1", "regions[1], of agents 2 and 1: l is ["),
        ("/regions/0/pieces/0/i_length/0", "regions[0], of agents 1 and 2: a piece is SS with the lengths ["),
        ("/margin_regions/0/pieces/0/j_length/1", "margin_regions[0], of agents 1 and 2: a piece is SS "),
    ] {
        let message = changed(pointer, &later);
        assert!(message.starts_with(place) && message.ends_with(" in the certificate"), "{message}");
    }
    let open = changed("/regions/0/open_end", &|it| *it = json!(true));
    assert_eq!(open, format!("regions[0]{of_both}open_end is true, and false in the certificate"));
    let pieces = changed("/regions/0/pieces", &|it| *it = json!([]));
    assert_eq!(pieces, format!("regions[0]{of_both}it has 0 pieces, and 1 in the certificate"));
    let none = changed("/regions", &|it| *it = json!([]));
    assert_eq!(none, "regions: 0 of agents 1 and 2, and 1 in the certificate");
    let other = changed("/regions/0/j", &|it| *it = json!(3));
    assert_eq!(other, "regions: 0 of agents 1 and 2, and 1 in the certificate");
    let margins = changed("", &|it| drop(it.as_object_mut().unwrap().remove("margin_regions")));
    assert_eq!(margins, "margin_regions: missing, and the certificate has a table of them");
    let margins = changed("/certificate", &|it| drop(it.as_array_mut().unwrap().pop()));
    assert_eq!(margins, "margin_regions: the certificate has no table of them");
    // Of one agent there are only its own.
    let mut one = table("one.json", &crossing(), &["--agent", "2"]);
    let name = file("certify", "one-table.json", one.to_string());
    assert!(run(&["certify", "--table", &name]).ok().contains("proved"));
    one.as_object_mut().unwrap().remove("agent");
    assert_eq!(refused("one.json", &one), "regions: 0 of agents 1 and 2, and 1 in the certificate");
}

/// The table with margins is of the same discs, enlarged; without the regions of the discs its own would not be compared.
#[test]
fn tables_of_margins_are_those_of_the_discs() {
    let told = table("margins.json", &crossing(), &["--margin", "0.1"]);
    let changed = |change: &dyn Fn(&mut Value)| {
        let mut other = told.clone();
        change(&mut other);
        refused("other-margins.json", &other)
    };
    let missing = changed(&|it| drop(it.as_object_mut().unwrap().remove("regions")));
    assert_eq!(missing, "regions: missing, and the certificate has a table of them");
    let elsewhere = changed(&|it| {
        it["certificate"][1]["agents"][1]["path"]["start"] = json!([100, 100]);
        (it["certificate"][1]["pairs"], it["margin_regions"]) = (json!([]), json!([]));
    });
    assert_eq!(elsewhere, "certificate: agents[1] of the two tables differ: path");
    let smaller = changed(&|it| it["certificate"][1]["agents"][0]["radius"] = json!(0.01));
    assert_eq!(smaller, "certificate: agents[0] of the two tables differ: radius, which is smaller with the margin");
    let later = changed(&|it| it["certificate"][1]["agents"][0]["travel"]["start"] = json!(7));
    assert_eq!(later, "certificate: agents[0] of the two tables differ: travel");
    let fewer = changed(&|it| drop(it["certificate"][0]["agents"].as_array_mut().unwrap().pop()));
    assert_eq!(fewer, "certificate: 1 discs in the first table, and 2 in the second");
    let more = changed(&|it| {
        let table = it["certificate"][0].clone();
        it["certificate"].as_array_mut().unwrap().push(table);
    });
    assert_eq!(more, "certificate: 3 tables; there are at most two, the second with margins");
    let covers = changed(&|it| it["bodies"] = json!([{ "id": 77, "parts": [1] }]));
    assert_eq!(covers, "bodies: the certificate has no agent 77");
}

/// Of outlines the times are compared.
#[test]
fn regions_of_outlines_that_are_none_of_the_table_are_refused() {
    let outlines = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/small/outlines.json");
    let told = run(&["regions", outlines, "--json", "--certificate"]).json();
    let name = file("certify", "outlines-table.json", told.to_string());
    assert!(run(&["certify", "--table", &name]).ok().contains("proved"));
    for (end, by, why) in [(0, 0.01, "holds the times"), (1, 0.01, "which no times in the certificate make")] {
        let mut other = told.clone();
        let time = &mut other["regions"][0]["t"][end];
        *time = json!(time.as_f64().unwrap() + by);
        let message = refused("outlines.json", &other);
        assert!(message.starts_with("regions") && message.contains(why), "{message}");
    }
    let mut other = told.clone();
    let again = other["regions"][0].clone();
    other["regions"].as_array_mut().unwrap().push(again);
    assert!(refused("outlines.json", &other).ends_with("it is there twice"));
    other["regions"] = json!([]);
    assert!(refused("outlines.json", &other).starts_with("regions: none of agents "));
}

#[test]
fn a_table_comes_in_by_a_pipe() {
    let table = run(&["regions", crate::fixture::PAPER, "--json", "--certificate"]).ok();
    let proved = crate::fixture::run_with(&["certify", "--table", "-", "--json"], table.as_bytes()).json();
    assert_eq!(proved["verdict"], "proved");
    let message = run(&["certify", "--table", "nowhere.json"]).failed(2);
    assert!(message.starts_with("pcr: nowhere.json: cannot be read: "), "{message}");
}
