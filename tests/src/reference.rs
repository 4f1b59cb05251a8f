//! The reference regions of `data/golden-public.json`, decoded. Where they come from: `data/README.md`.

use pcr_formats::scenario::Scenario;
use serde_json::{Value, json};

/// A region of the reference.
#[derive(Clone, Debug)]
pub struct Component {
    /// Time range \[s\].
    pub time: [f64; 2],
    /// Length range \[m\].
    pub length: [f64; 2],
    /// Times, and the slices of this component there.
    pub sections: Vec<(f64, Vec<[f64; 2]>)>,
}

/// All regions of an ordered pair.
#[derive(Clone, Debug)]
pub struct Regions {
    /// In the order of their times.
    pub components: Vec<Component>,
    /// Whether a contact is so close to critical that the number of components is not decidable.
    pub uncertain: bool,
}

/// A pair of agents: the ego first.
#[derive(Clone, Debug)]
pub struct Case {
    /// What it is about.
    pub name: String,
    /// Ego and other.
    pub scenario: Scenario,
    /// Regions of the ego.
    pub regions: Regions,
}

/// A fleet.
#[derive(Clone, Debug)]
pub struct Fleet {
    /// The agents.
    pub scenario: Scenario,
    /// Ids of ego and other, and their regions. Pairs that are not listed have none.
    pub pairs: Vec<(u64, u64, Regions)>,
}

/// The pairs.
pub fn cases() -> Vec<Case> {
    array(&golden()["cases"]).iter().map(case).collect()
}

/// The fleets.
pub fn fleets() -> Vec<Fleet> {
    array(&golden()["scenarios"]).iter().map(fleet).collect()
}

fn golden() -> Value {
    serde_json::from_str(include_str!("../data/golden-public.json")).expect("valid JSON")
}

fn case(value: &Value) -> Case {
    let numbered = |key: &str, id: u64| {
        let mut agent = value[key].clone();
        agent["id"] = json!(id);
        agent
    };
    let scenario = scenario(&json!({ "agents": [numbered("i", 1), numbered("j", 2)] }));
    Case { name: value["name"].as_str().unwrap_or_default().into(), scenario, regions: regions(value) }
}

fn fleet(value: &Value) -> Fleet {
    let pair = |pair: &Value| (pair["i"].as_u64().expect("an id"), pair["j"].as_u64().expect("an id"), regions(pair));
    Fleet { scenario: scenario(&value["scenario"]), pairs: array(&value["pairs"]).iter().map(pair).collect() }
}

fn scenario(value: &Value) -> Scenario {
    Scenario::from_value(value).expect("a valid scenario")
}

fn regions(value: &Value) -> Regions {
    let component = |value: &Value| Component {
        time: interval(&value["t"]),
        length: interval(&value["l"]),
        sections: array(&value["sections"])
            .iter()
            .map(|section| {
                let time = section["t"].as_f64().expect("a time");
                (time, array(&section["l"]).iter().map(interval).collect())
            })
            .collect(),
    };
    let components = array(&value["components"]).iter().map(component).collect();
    Regions { components, uncertain: value["uncertain"] == json!(true) }
}

fn interval(value: &Value) -> [f64; 2] {
    [0, 1].map(|end| value[end].as_f64().expect("an end of an interval"))
}

fn array(value: &Value) -> &[Value] {
    value.as_array().expect("an array")
}
