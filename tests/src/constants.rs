//! The scenario of the firmware, as Rust source.

use pcr_core::TurnSide;
use pcr_formats::paper_example;
use pcr_formats::scenario::{Agent, MotionSpec, PathSegment, Scenario};
use std::fmt::{self, Write};

/// The paper's scenario as the firmware includes it, once for each number format: `number` and `angle` are functions of
/// the format.
///
/// # Panics
/// Where the embedded scenario has what the firmware has no constants for.
pub fn source() -> String {
    let scenario = Scenario::from_json(paper_example::SCENARIO).expect("the embedded scenario");
    let mut text = String::from("// Generated: `cargo run -p pcr-tests --example constants`.\n");
    let count = scenario.agents.len();
    text +=
        &format!("/// The agents of the scenario.\npub static AGENTS: [Agent<Number, &[Step<Number>]>; {count}] = [\n");
    for agent in &scenario.agents {
        write_agent(&mut text, agent).expect("strings take everything");
    }
    text + "];\n"
}

fn write_agent(text: &mut String, agent: &Agent) -> fmt::Result {
    let MotionSpec::RestToRest { v_max, a_max } = agent.motion else {
        panic!("agent {} has a profile", agent.id);
    };
    let [x, y, heading] = agent.start;
    writeln!(text, "    Agent {{")?;
    writeln!(text, "        radius: number({:?}),", agent.radius)?;
    writeln!(text, "        start_time: number({:?}),", agent.t_start)?;
    writeln!(text, "        limits: Limits {{ speed: number({v_max:?}), acceleration: number({a_max:?}) }},")?;
    let position = format!("Point::new(number({x:?}), number({y:?}))");
    writeln!(text, "        start: Pose {{ position: {position}, heading: angle({heading:?}) }},")?;
    writeln!(text, "        path: &[")?;
    for segment in &agent.path {
        let curve = match *segment {
            PathSegment::Line { .. } => "Curve::Line".to_owned(),
            PathSegment::Arc { radius, sweep, .. } => {
                let turn = if sweep > 0.0 { TurnSide::Left } else { TurnSide::Right };
                format!("Curve::Arc {{ radius: number({radius:?}), turn: TurnSide::{turn:?} }}")
            }
            _ => panic!("{segment:?}"),
        };
        writeln!(text, "            Step {{ curve: {curve}, length: number({:?}) }},", segment.length())?;
    }
    writeln!(text, "        ],\n    }},")
}
