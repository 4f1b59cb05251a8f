//! What is asked again, in vain, or with too much.

use pcr_serve::journal_entry::NullStore;
use pcr_serve::lines::handle;
use pcr_serve::supervisor::{Supervisor, SupervisorConfig};
use serde_json::{Value, json};

struct Asks {
    supervisor: Supervisor,
    now: f64,
}

impl Asks {
    fn new() -> Self {
        Self { supervisor: Supervisor::new(SupervisorConfig::default(), Box::new(NullStore)), now: 0.0 }
    }

    fn ask(&mut self, line: &Value) -> Value {
        handle(&mut self.supervisor, line.to_string().as_bytes(), self.now, self.now).answer
    }

    /// Asks; with the events that follow within some seconds.
    fn events(&mut self, line: &Value) -> Vec<(String, String)> {
        let answer = self.ask(line);
        assert!(answer["ok"].is_object(), "{answer}");
        let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let mut all = Vec::new();
        for _ in 0..10 {
            self.now += 0.5;
            all.extend(self.supervisor.settle(self.now).unwrap().iter().map(|event| json!(event)));
        }
        all.iter().map(|event| (text(&event["event"]), text(&event["robot"]))).collect()
    }
}

fn add(robot: &str, x: f64, heading: f64) -> Value {
    json!({ "verb": "add", "robot": robot, "start": { "x": x, "y": 0, "heading": heading },
        "abilities": { "radius": 0.25, "speed": 1, "acceleration": 0.5 } })
}

fn mission(robot: &str, length: f64) -> Value {
    json!({ "verb": "mission", "robot": robot, "mission": robot, "path": [{ "kind": "line", "length": length }] })
}

#[test]
fn a_robot_is_added_again_until_it_has_a_mission() {
    let mut asks = Asks::new();
    for _ in 0..2 {
        assert_eq!(asks.ask(&add("a", 0.0, 0.0))["ok"]["path"], 1);
    }
    assert_eq!(asks.ask(&add("a", 0.1, 0.0))["error"]["code"], "robot_exists");
    asks.events(&mission("a", 3.0));
    let error = &asks.ask(&add("a", 0.0, 0.0))["error"];
    assert_eq!(error["code"], "robot_exists");
    assert!(error["message"].as_str().unwrap().contains("has had a mission"), "{error}");
    asks.ask(&json!({ "verb": "remove", "robot": "a" }));
    assert!(asks.ask(&add("a", 0.0, 0.0))["ok"]["path"].as_u64() > Some(2));
}

/// Both ways out of the document.
#[test]
fn who_is_added_on_a_way_that_was_given_away_goes_or_the_other_one_does() {
    let is = |event: &str, robot: &str| (event.to_owned(), robot.to_owned());
    for removed in ["b", "a"] {
        let mut asks = Asks::new();
        asks.events(&add("a", 0.0, 0.0));
        asks.events(&mission("a", 10.0));
        assert!(asks.events(&add("b", 2.0, 1.5)).contains(&is("stop", "a")));
        let events = asks.events(&mission("b", 3.0));
        assert!(!events.contains(&is("admitted", "b")) && !events.contains(&is("go", "a")), "{events:?}");
        let events = asks.events(&json!({ "verb": "remove", "robot": removed }));
        let expected = if removed == "b" { is("go", "a") } else { is("admitted", "b") };
        assert!(events.contains(&expected), "{removed}: {events:?}");
        if removed == "a" {
            asks.events(&add("a", 0.0, 0.0));
            assert!(asks.events(&mission("a", 10.0)).contains(&is("admitted", "a")));
        }
    }
}

#[test]
fn a_question_has_no_other_fields_than_its_own() {
    let mut asks = Asks::new();
    asks.events(&add("a", 0.0, 0.0));
    let all = ["robots", "holds", "regions", "conflicts", "safe", "counts"];
    for (what, takes) in
        all.into_iter().zip([&["robot"][..], &[], &["robot"], &["robot"], &["robot", "length", "until"], &[]])
    {
        let fields = [("robot", json!("a")), ("length", json!([0, 0])), ("until", json!(1)), ("age", json!(0))];
        let ask = |names: &[&str]| {
            let mut line = json!({ "verb": "query", "what": what });
            for (name, value) in fields.iter().filter(|(name, _)| names.contains(name)) {
                line[name] = value.clone();
            }
            line
        };
        let answer = asks.ask(&ask(takes));
        assert!(answer["ok"].is_object(), "{what}: {answer}");
        for (name, _) in fields.iter().filter(|(name, _)| !takes.contains(name)) {
            let answer = asks.ask(&ask(&[takes, &[*name][..]].concat()));
            assert_eq!(answer["error"]["code"], "malformed", "{what} with {name}: {answer}");
        }
    }
}

#[test]
fn a_place_is_free_at_an_instant_or_blocked() {
    let mut asks = Asks::new();
    asks.events(&add("a", 0.0, 0.0));
    asks.events(&add("b", 2.0, 0.0));
    asks.events(&mission("a", 1.0));
    let mut safe = |robot: &str, length: [f64; 2], until: f64| {
        let answer =
            asks.ask(&json!({ "verb": "query", "what": "safe", "robot": robot, "length": length, "until": until }));
        answer["ok"]["safe"].clone()
    };
    assert_eq!(safe("a", [0.0, 1.0], 0.0), json!([[0.0, 0.0]]));
    // A robot without a path.
    assert_eq!(safe("b", [0.0, 0.0], 0.0), json!([[0.0, 0.0]]));
    assert_eq!(safe("b", [0.0, 0.0], 9.0), json!([[0.0, 9.0]]));
}

/// A part of the path that is behind, or beyond its end, is neither free nor blocked.
#[test]
fn a_part_that_is_asked_about_is_ahead() {
    let mut asks = Asks::new();
    asks.events(&add("a", 0.0, 0.0));
    asks.events(&mission("a", 3.0));
    assert!(asks.ask(&json!({ "verb": "position", "robot": "a", "path": 2, "at": [1, 1] }))["ok"].is_object());
    asks.now += 0.5;
    asks.supervisor.settle(asks.now).unwrap();
    let robots = asks.ask(&json!({ "verb": "query", "what": "robots" }));
    let at = robots["ok"]["robots"][0]["at"][0].as_f64().unwrap();
    assert_eq!(at, 1.0);
    let mut answer = |[lo, hi]: [f64; 2], until: f64| {
        let line = json!({ "verb": "query", "what": "safe", "robot": "a", "length": [lo, hi], "until": until });
        let answer = asks.ask(&line);
        (answer["ok"]["safe"].clone(), answer["error"]["code"].clone())
    };
    for length in [[1.0, 3.0], [1.0, 1.0], [3.0, 3.0], [1.5, 2.0], [3.0, 3.0 + 1e-9]] {
        assert_eq!(answer(length, 9.0), (json!([[0.0, 9.0]]), Value::Null), "{length:?}");
    }
    for length in [[0.9, 2.0], [0.0, 3.0], [-1.0, -0.5], [2.0, 1.5], [2.0, 3.1], [3.1, 3.1], [3.1, 2.0], [0.5, 0.7]] {
        assert_eq!(answer(length, 9.0), (Value::Null, json!("invalid")), "{length:?}");
    }
    for until in [-1e-9, 1.1e6, -5.0] {
        assert_eq!(answer([1.0, 3.0], until), (Value::Null, json!("invalid")), "{until}");
    }
    assert_eq!(answer([1.0, 3.0], 1e6), (json!([[0.0, 1e6]]), Value::Null));
}
