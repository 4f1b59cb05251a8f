//! Answers of the tool itself, which people give where a scenario or a layout is expected.

use serde::Deserialize;
use serde_json::Value;

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
    #[derive(Deserialize)]
    struct Said {
        format: Option<Value>,
    }
    let text = text.trim_start_matches('\u{feff}');
    let said = serde_json::Deserializer::from_str(text).into_iter::<Said>().next()?.ok()?;
    described(said.format?.as_str()?)
}
