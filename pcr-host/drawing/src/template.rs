//! Pages as single HTML files that contain everything and send no requests.

use super::svg::XmlEscaped;
use serde_json::Value;

/// What all pages have in common.
const FRAME: &str = include_str!("template.html");
const STYLE: &str = include_str!("template.css");

/// A kind of page.
pub(crate) struct PageTemplate {
    /// What the page shows, after the title of the window.
    pub(crate) kind: &'static str,
    /// What it may ask its server for, as a continuation of its Content-Security-Policy; nothing for a page that is a file.
    pub(crate) connect: &'static str,
    /// Its elements below the heading and `#summary`, which the script fills.
    pub(crate) body: &'static str,
    /// CSS that other kinds do not need.
    pub(crate) style: &'static str,
    /// JavaScript, which reads the element `data`.
    pub(crate) script: &'static str,
}

impl PageTemplate {
    /// The page with a title and data.
    pub(crate) fn fill(&self, title: &str, data: &Value) -> String {
        let title = XmlEscaped(title).to_string();
        // A text in the data cannot end the element that holds it.
        let data = data.to_string().replace('<', "\\u003c");
        replaced(FRAME, &|key| match key {
            "title" => Some(title.as_str()),
            "kind" => Some(self.kind),
            "connect" => Some(self.connect),
            "common" => Some(STYLE),
            "style" => Some(self.style),
            "body" => Some(self.body),
            "data" => Some(data.as_str()),
            "script" => Some(self.script),
            _ => None,
        })
    }
}

/// The template with what its `{{keys}}` stand for; what is put in is not looked at again.
fn replaced<'a>(template: &str, value: &dyn Fn(&str) -> Option<&'a str>) -> String {
    let mut page = String::with_capacity(template.len());
    for part in template.split("{{") {
        let (key, text) = part.split_once("}}").unwrap_or(("", part));
        page.push_str(value(key).unwrap_or_default());
        page.push_str(text);
    }
    page
}
