//! Records of what ran: bags of ROS 2, outlines, and the page about them.

use crate::fixture::{Run, directory, run};
use serde_json::Value;

/// The path of a file of the tests.
fn data(name: &str) -> String {
    format!("{}/../tests/data/{name}", env!("CARGO_MANIFEST_DIR"))
}

fn bag(name: &str) -> String {
    data(&format!("bags/{name}.mcap"))
}

fn json(run: Run) -> Value {
    serde_json::from_str(&run.out).unwrap()
}

#[test]
fn a_contact_in_a_bag_is_proved_at_poses_and_not_known_far_from_them() {
    let near = run(&["check", &bag("fleet"), "--radius", "0.4", "--deviation", "0.01"]);
    assert_eq!(near.status, 1, "{}", near.err);
    assert!(
        near.out.starts_with("fleet: 1 contact, 2 agents, 1 pair\n") && near.out.contains("0 carts/left"),
        "{}",
        near.out
    );
    let fast = run(&["check", &bag("frames"), "--radius", "0.4", "--top-speed", "3"]);
    assert_eq!(fast.status, 1, "{}", fast.err);
    assert!(fast.out.starts_with("frames: 1 contact, 2 times unknown, 2 agents, 1 pair\n"), "{}", fast.out);
    let names = run(&["check", &bag("frames"), "--radius", "0.4", "--deviation", "0.01", "--anonymous"]);
    assert!(!names.out.contains("left") && !names.err.contains("left"), "{}", names.err);
}

#[test]
fn what_is_wrong_with_a_bag_is_said_with_what_to_do() {
    let options = ["--radius", "0.4", "--top-speed", "2"];
    let of = |file: &str, more: &[&str]| {
        let run = run(&[&["check", file], options.as_slice(), more].concat());
        assert_eq!(run.status, 2, "{}", run.err);
        run.err
    };
    let several = of(&bag("localized"), &[]);
    assert!(several.contains("poses in /left/amcl_pose and in /left/goal_pose; say by --topic"), "{several}");
    let folder = directory("records");
    let whole = std::fs::read(bag("frames")).unwrap();
    let cut = folder.join("cut.mcap");
    std::fs::write(&cut, &whole[..4000]).unwrap();
    let said = of(cut.to_str().unwrap(), &[]);
    assert!(said.contains("cut.mcap: the bag ends before its footer") && said.contains("mcap recover"), "{said}");
    for (name, magic, expected) in
        [("a.db3", "SQLite format 3\0", "--dst-storage mcap"), ("a.bag", "#ROSBAG V2.0\n", "--dst-typestore")]
    {
        let file = folder.join(name);
        std::fs::write(&file, magic).unwrap();
        let said = of(file.to_str().unwrap(), &[]);
        assert!(said.contains(expected), "{said}");
    }
    let other = run(&["plan", &bag("frames")]);
    assert!(other.status == 2 && other.err.contains("only pcr check FILE reads it"), "{}", other.err);
    let useless = run(&["check", &data("small/messages.log"), "--radius", "0.4", "--top-speed", "2", "--topic", "tf"]);
    assert!(useless.status == 2 && useless.err.contains("--topic has no effect"), "{}", useless.err);
}

#[test]
fn outlines_are_checked_by_the_headings_of_the_poses() {
    let (bag, fleet) = (bag("localized"), data("small/factsheet.json"));
    let base = ["check", &bag, "--topic", "amcl_pose", "--topic", "ground_truth", "--closest", "--format", "json"];
    let of = |more: &[&str]| run(&[base.as_slice(), more].concat());
    let outlines = json(of(&["--fleet", &fleet, "--top-speed", "2", "--top-rotation", "0.5"]));
    assert_eq!(outlines["between"], serde_json::json!({ "top_speed_and_rotation": [2.0, 0.5] }));
    let agent = &outlines["agents"][0];
    assert!(agent["outline"].as_array().is_some_and(|corners| corners.len() > 2), "{agent}");
    let radius = agent["radius"].to_string();
    let discs = json(of(&["--radius", &radius, "--top-speed", "2"]));
    let least = |report: &Value| report["approaches"][0]["t"][0].as_f64().unwrap();
    // Vehicles that are longer than wide come together later than discs around them.
    assert!(least(&outlines) > least(&discs), "{outlines} {discs}");
    let open = of(&["--fleet", &fleet, "--top-speed", "2"]);
    assert!(open.status == 2 && open.err.contains("give --top-rotation"), "{}", open.err);
    let table = run(&["check", &data("small/solution.txt"), "--fleet", &fleet]);
    assert!(table.status == 2 && table.err.contains("no heading, on which its outline depends"), "{}", table.err);
}

#[test]
fn the_page_has_the_poses_and_what_is_known_of_each_pair() {
    let page = directory("records").join("record.html");
    let written =
        run(&["check", &bag("frames"), "--radius", "0.4", "--top-speed", "1.2", "-o", page.to_str().unwrap()]);
    assert!(written.status == 1 && !written.out.contains("Nearest"), "{}", written.err);
    let page = std::fs::read_to_string(page).unwrap();
    let data = page.split("id=\"data\">").nth(1).and_then(|rest| rest.split("</script>").next()).unwrap();
    let data: Value = serde_json::from_str(data).unwrap();
    assert_eq!(data["agents"][0]["track"]["t"].as_array().map(Vec::len), Some(13));
    let pair = &data["pairs"][0];
    let parts = pair["parts"].as_array().unwrap();
    assert_eq!(parts.len(), 400);
    let lowest = parts.iter().map(|part| part[2].as_f64().unwrap()).fold(f64::INFINITY, f64::min);
    let closest = pair["closest"]["clearance"][0].as_f64().unwrap();
    assert!(lowest <= closest + 1e-4 && lowest > closest - 0.05, "{lowest} {closest}");
    assert_eq!(pair["approaches"].as_array().map(Vec::len), Some(1));
    let none = run(&["check", &self::data("paper12.json"), "-o", "x.html"]);
    assert!(none.status == 2 && none.err.contains("--output has no effect"), "{}", none.err);
}

#[test]
fn who_waited_for_whom_is_told_by_the_states_of_vehicles() {
    let log = data("small/held.log");
    let report = json(run(&["check", &log, "--radius", "0.4", "--top-speed", "1.1", "--format", "json"]));
    let [wait] = report["waits"].as_array().unwrap().as_slice() else { panic!("{}", report["waits"]) };
    let name = |id: &Value| report["labels"][id.to_string()].as_str().unwrap().to_owned();
    assert_eq!(
        (name(&wait["id"]), wait["t"][0].as_f64(), wait["t"][1].as_f64()),
        ("ACME/r1".into(), Some(2.0), Some(6.0))
    );
    let [passed] = wait["passed"].as_array().unwrap().as_slice() else { panic!("{wait}") };
    assert_eq!(name(&passed["id"]), "ACME/r2");
    // Centres are 1 m apart when r2 is beside it; it is seen to go 3.5 m.
    assert!((passed["way"].as_f64().unwrap() - 3.5).abs() < 1e-9, "{passed}");
    let [lower, upper] = [0, 1].map(|k| passed["clearance"][k].as_f64().unwrap());
    assert!(lower < 0.2 && 0.2 < upper && upper < 0.4, "{passed}");
    let table = run(&["check", &log, "--radius", "0.4", "--top-speed", "1.1"]).out;
    assert!(table.contains("Stood because the rest of the order was not released:"), "{table}");
}
