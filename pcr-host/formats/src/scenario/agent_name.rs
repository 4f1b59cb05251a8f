//! What an agent is called in a file: a number with a label, or a text.

use super::json_fields::{ObjectFields, ScenarioError, parse_integer};
use super::labels::{self, display_name};
use crate::json::{JsonData, JsonNode};

/// Read before anything else, so that messages can name the agent.
pub(super) struct AgentName {
    id: Option<u64>,
    pub(super) label: String,
    /// Whether the id is a text, which is the label then.
    pub(super) is_text: bool,
}

impl AgentName {
    pub(super) fn of(json: &JsonNode<'_>, index: usize) -> Self {
        let given = |name: &str| match &json.data {
            JsonData::Object(members) => members.iter().find(|(key, _)| key == name).map(|(_, value)| value),
            _ => None,
        };
        let text = |value: Option<&JsonNode<'_>>| match value {
            Some(JsonNode { data: JsonData::Text(text), .. }) if labels::fault(text).is_none() => text.to_string(),
            _ => String::new(),
        };
        // A text of digits could be meant for a number.
        let named = Some(text(given("id"))).filter(|id| !id.is_empty() && id.parse::<u64>().is_err());
        let id = match (given("id"), &named) {
            (Some(JsonNode { data: JsonData::Number(text), .. }), _) => parse_integer(text),
            (_, Some(_)) => Some(index as u64 + 1),
            _ => None,
        };
        let is_text = named.is_some();
        Self { id, label: named.unwrap_or_else(|| text(given("label"))), is_text }
    }

    /// For messages.
    pub(super) fn called(&self, index: usize) -> String {
        match self.id {
            Some(id) => format!("agent {}", display_name(id, &self.label)),
            None => format!("agent at place {}", index + 1),
        }
    }

    /// The number, if id and label are allowed.
    pub(super) fn checked(&self, fields: &ObjectFields<'_>) -> Result<u64, ScenarioError> {
        let given = fields.required("id")?;
        let Some(id) = self.id else {
            return Err(match &given.data {
                JsonData::Text(text) => fields.error(given.position, "id", no_name(text)),
                _ => fields.unexpected("id", given, "a whole number from 0 or a name"),
            });
        };
        match fields.get("label").map(|label| (label, &label.data)) {
            None => {}
            Some((label, _)) if self.is_text => {
                return Err(fields.error(label.position, "label", "given, and the id is a text"));
            }
            Some((given, JsonData::Text(text))) => {
                if let Some(fault) = labels::fault(text) {
                    return Err(fields.error(given.position, "label", fault));
                }
            }
            Some((given, _)) => return Err(fields.unexpected("label", given, "a string")),
        }
        Ok(id)
    }
}

/// Why a text is no id.
fn no_name(text: &str) -> String {
    match labels::fault(text) {
        Some(fault) => fault,
        None if text.is_empty() => "\"\" where a whole number from 0 or a name is expected".into(),
        None => format!("\"{text}\" could be taken for the number; write it without quotation marks, or give a name"),
    }
}
