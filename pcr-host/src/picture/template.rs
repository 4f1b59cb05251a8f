//! Pages that are one HTML file with everything in it.

use super::svg::Escaped;
use serde_json::Value;

/// The page of a template, its style and its script: `{{title}}`, `{{style}}`, `{{script}}` and `{{data}}` take their places.
pub(crate) fn fill([template, style, script]: [&str; 3], title: &str, data: &Value) -> String {
    // A text in the data cannot end the element that holds it.
    let data = data.to_string().replace('<', "\\u003c");
    let mut page = String::with_capacity(template.len() + style.len() + script.len() + data.len());
    for part in template.split("{{") {
        let (key, text) = part.split_once("}}").unwrap_or(("", part));
        match key {
            "title" => page.push_str(&Escaped(title).to_string()),
            "style" => page.push_str(style),
            "script" => page.push_str(script),
            "data" => page.push_str(&data),
            _ => {}
        }
        page.push_str(text);
    }
    page
}
