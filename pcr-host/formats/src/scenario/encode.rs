//! Encodes a scenario as a file.

use super::angles::{RADIANS, UNIT};
use super::decode::FORMAT;
use super::facing::file_segments;
use super::file_version::{FACINGS, GEARS, STEADY, TURNS, VERSION};
use super::{Agent, LoadOutline, MotionPiece, MotionSpec, PathSegment, REVERSE, Scenario};
use crate::footprint::Footprint;
use serde_json::Value;
use std::fmt::{self, Display};

impl Scenario {
    /// The file of the scenario, an agent a line. Every number is written with all its digits, so that
    /// [`Scenario::from_json`] reads the same paths back.
    pub fn to_json(&self) -> String {
        let agents = self.agents.iter().map(|agent| format!("    {}", AsJson(agent))).collect::<Vec<_>>().join(",\n");
        let agents = if agents.is_empty() { "[]".to_owned() } else { format!("[\n{agents}\n  ]") };
        let warnings = match self.warnings.is_empty() {
            true => String::new(),
            false => format!("  \"warnings\": {},\n", Value::from(self.warnings.clone())),
        };
        let name = Value::from(self.name.as_str());
        let unit = if self.has_doubted_angles() { format!("  \"{UNIT}\": \"{RADIANS}\",\n") } else { String::new() };
        let version = self.agents.iter().map(Agent::version).max().unwrap_or(VERSION);
        format!(
            "{{ \"format\": \"{FORMAT}\", \"version\": {version}, \"name\": {name},\n{unit}{warnings}  \"agents\": {agents} }}\n"
        )
    }

    /// A line of a stream of scenarios in place of one that there is not, and why not. Whatever reads scenarios refuses it.
    pub fn missing(name: &str, why: &str) -> String {
        let [name, why] = [name, why].map(Value::from);
        format!("{{\"format\":\"{FORMAT}\",\"version\":{VERSION},\"name\":{name},\"error\":{why}}}\n")
    }
}

impl Agent {
    /// The version of files that can have it.
    fn version(&self) -> u64 {
        let has_kinks = self.path.iter().any(|segment| matches!(segment, PathSegment::Kink { .. }));
        let has_angles = file_segments(&self.path).any(|(_, facing)| facing != 0.0 && facing != REVERSE);
        if self.has_steady_arcs() {
            STEADY
        } else if has_angles {
            FACINGS
        } else if has_kinks || self.motion.turns_in_place() {
            TURNS
        } else if self.changes_facing() {
            GEARS
        } else {
            VERSION
        }
    }
}

/// Something as JSON writes it.
struct AsJson<T>(T);

impl Display for AsJson<&Agent> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Agent { id, label, radius, footprint, loads, margin, t_start, start: [x, y, heading], path, motion } =
            self.0;
        write!(f, "{{ \"id\": {id}, ")?;
        if !label.is_empty() {
            write!(f, "\"label\": {}, ", Value::from(label.as_str()))?;
        }
        write!(f, "{}, ", AsJson((*radius, footprint.as_ref())))?;
        if !loads.is_empty() {
            let loads = loads.iter().map(|LoadOutline { segments, radius, footprint }| {
                let [first, last] = segments.map(|segment| self.0.file_segment(segment));
                let outline = AsJson((*radius, footprint.as_ref()));
                format!("{{ \"segments\": [{}, {}], {outline} }}", first + 1, last + 1)
            });
            write!(f, "\"loads\": [ {} ], ", loads.collect::<Vec<_>>().join(", "))?;
        }
        if *margin > 0.0 {
            write!(f, "\"margin\": {margin:?}, ")?;
        }
        write!(f, "\"t_start\": {t_start:?}, ")?;
        write!(f, "\"start\": {{ \"x\": {x:?}, \"y\": {y:?}, \"heading\": {heading:?} }}, \"path\": [")?;
        for (k, (segment, facing)) in file_segments(path).enumerate() {
            let comma = if k > 0 { "," } else { "" };
            let gear = match facing {
                0.0 => String::new(),
                REVERSE => ", \"gear\": \"reverse\"".to_owned(),
                angle => format!(", \"facing\": {angle:?}"),
            };
            match segment {
                PathSegment::Facing { .. } => {}
                PathSegment::Line { length } => {
                    write!(f, "{comma} {{ \"kind\": \"line\", \"length\": {length:?}{gear} }}")?;
                }
                PathSegment::Turn { sweep } => write!(f, "{comma} {{ \"kind\": \"turn\", \"sweep\": {sweep:?} }}")?,
                PathSegment::Kink { sweep } => write!(f, "{comma} {{ \"kind\": \"kink\", \"sweep\": {sweep:?} }}")?,
                PathSegment::Arc { radius, sweep, steady } => {
                    // Behind another segment the angle that is not given goes on.
                    let gear = match steady {
                        false => gear,
                        true => format!(", \"facing\": {facing:?}, \"steady\": true"),
                    };
                    write!(f, "{comma} {{ \"kind\": \"arc\", \"radius\": {radius:?}, \"sweep\": {sweep:?}{gear} }}")?;
                }
            }
        }
        f.write_str(if path.is_empty() { "], " } else { " ], " })?;
        match motion {
            MotionSpec::RestToRest { v_max, a_max } => write!(f, "\"v_max\": {v_max:?}, \"a_max\": {a_max:?} }}"),
            MotionSpec::Profile { v0, pieces } => {
                write!(f, "\"profile\": {{ \"v0\": {v0:?}, \"pieces\": [")?;
                for (k, MotionPiece { duration, acceleration, in_place }) in pieces.iter().enumerate() {
                    let (comma, turn) = (if k > 0 { "," } else { "" }, if *in_place { "turn_" } else { "" });
                    write!(f, "{comma} {{ \"duration\": {duration:?}, \"{turn}accel\": {acceleration:?} }}")?;
                }
                f.write_str(if pieces.is_empty() { "] } }" } else { " ] } }" })
            }
        }
    }
}

/// An outline: the radius of a disc, or a footprint.
impl Display for AsJson<(f64, Option<&Footprint>)> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (radius, footprint) = self.0;
        let Some(footprint) = footprint else {
            return write!(f, "\"radius\": {radius:?}");
        };
        let corners = footprint.polygon().iter();
        let corners = corners.map(|[ahead, left]| format!("{{ \"ahead\": {ahead:?}, \"left\": {left:?} }}"));
        write!(f, "\"footprint\": {{ \"polygon\": [ {} ]", corners.collect::<Vec<_>>().join(", "))?;
        if footprint.growth() > 0.0 {
            write!(f, ", \"growth\": {:?}", footprint.growth())?;
        }
        f.write_str(" }")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again() {
        let agent = Agent {
            id: u64::MAX,
            label: "AGV \"7\" → é".into(),
            radius: 1.0 / 3.0,
            footprint: None,
            loads: vec![LoadOutline { segments: [0, 1], radius: 0.7, footprint: None }],
            margin: 0.1,
            t_start: -1e9,
            start: [1e-300, -7.0, 0.1 + 0.2],
            path: vec![PathSegment::Line { length: 0.5 }, PathSegment::arc(1e-8, -1e-8)],
            motion: MotionSpec::RestToRest { v_max: 1e10, a_max: 0.1 },
        };
        let length = agent.length();
        let stands =
            Agent { id: 0, label: String::new(), margin: 0.0, path: Vec::new(), loads: Vec::new(), ..agent.clone() };
        let moves = Agent { id: 1, motion: MotionSpec::profile(length / 2.0, [(2.0, 0.0)]), ..agent.clone() };
        let outline = Footprint::new(vec![[0.1 + 0.2, -1.0], [1.0, 1.0 / 3.0], [-1.0, 0.5]]).unwrap().inflated(0.01);
        let outlined =
            Agent { id: 2, radius: outline.circumscribed_radius(), footprint: Some(outline), ..stands.clone() };
        let scenario = Scenario {
            warnings: vec!["edge \"5\": left out [left-out]".into()],
            ..Scenario::new("a \"name\" \\", vec![agent, stands, moves, outlined])
        };
        assert_eq!(Scenario::from_json(&scenario.to_json()), Ok(scenario));
        let empty = Scenario::default();
        assert_eq!(Scenario::from_json(&empty.to_json()), Ok(empty));
    }
}
