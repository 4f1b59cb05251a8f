//! Texts in YAML, as large as files of buildings are.

use super::ImportError;
use serde::de::DeserializeOwned;

/// What a YAML text says.
///
/// # Errors
/// It is no YAML, not of this type, or too large or too deep for the parser.
pub fn yaml<T: DeserializeOwned>(text: &str) -> Result<T, ImportError> {
    // A text has no more nodes than bytes, unless it repeats some by their names, of which the parser has limits of its own.
    let most = text.len().saturating_add(1024);
    let options = serde_saphyr::options! {
        budget: serde_saphyr::budget! {
            max_nodes: most,
            max_events: most.saturating_mul(2),
            max_total_scalar_bytes: most,
        },
    };
    serde_saphyr::from_str_with_options(text, options).map_err(|error| {
        let what = if matches!(error.without_snippet(), serde_saphyr::Error::Budget { .. }) {
            "too large or too deep"
        } else {
            "not YAML"
        };
        let error = error.to_string();
        ImportError::new(format!("{what}: {}", error.lines().next().unwrap_or_default()))
    })
}
