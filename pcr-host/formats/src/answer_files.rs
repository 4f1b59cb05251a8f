//! Answers of the tool itself, which people give where a scenario or a layout is expected.

use crate::byte_order_mark::unmarked;
use serde::de::{DeserializeSeed, Deserializer, IgnoredAny, MapAccess, Visitor};
use serde_json::Value;
use std::fmt;

/// What a format is, if the tool writes it and it is no scenario.
pub(crate) fn described(format: &str) -> Option<String> {
    let more = match format {
        "pcr-scenario" => return None,
        "pcr-regions" => ", which pcr certify --table reads",
        "pcr-plan" => " (pcr plan -o writes the scenario with the plan)",
        _ => "",
    };
    format.starts_with("pcr-").then(|| format!("this is {format}, an answer of pcr{more}"))
}

/// What a JSON text is, if it begins with such an answer.
pub(crate) fn answer(text: &str) -> Option<String> {
    #[derive(serde::Deserialize)]
    struct AnswerHeader {
        format: Option<Value>,
    }
    let said = serde_json::Deserializer::from_str(unmarked(text)).into_iter::<AnswerHeader>().next()?.ok()?;
    described(said.format?.as_str()?)
}

/// Whether a text begins with an object that has agents, as scenarios have, whatever is wrong with it behind that key.
pub(crate) fn has_agents(text: &str) -> bool {
    let mut found = false;
    // What cannot be read to its end may have them all the same.
    let _ = AgentsProbe(&mut found).deserialize(&mut serde_json::Deserializer::from_str(unmarked(text)));
    found
}

/// Looks for the key among those of an object.
struct AgentsProbe<'f>(&'f mut bool);

impl<'de> DeserializeSeed<'de> for AgentsProbe<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for AgentsProbe<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        while let Some(key) = map.next_key::<String>()? {
            if key == "agents" {
                *self.0 = true;
                return Ok(());
            }
            map.next_value::<IgnoredAny>()?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agents_are_told_by_their_key() {
        for text in [r#"{"agents": []}"#, "\u{feff} {\"name\": \"x\", \"agents\": [", r#"{"agents" 1}"#] {
            assert!(has_agents(text), "{text}");
        }
        for text in [r#"{"name": "agents"}"#, r#"{"a": {"agents": []}}"#, r#"[{"agents": []}]"#, "", "\"agents\""] {
            assert!(!has_agents(text), "{text}");
        }
    }
}
