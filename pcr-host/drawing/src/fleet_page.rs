//! The page that shows a running fleet. It sends requests only to the server that it comes from.

use crate::template::PageTemplate;
use crate::{map, with_scene};
use pcr_formats::scenario::Scenario;
use serde_json::json;
use std::io;

const PAGE: PageTemplate = PageTemplate {
    kind: "live",
    connect: "; connect-src 'self'; img-src 'self'",
    body: include_str!("live/live.html"),
    style: include_str!("live/live.css"),
    script: concat!(include_str!("outward.js"), include_str!("live/live.js"), include_str!("scale.js")),
};

/// The page, without data: it gets them from `/layout`, `/state` and `/map` of its server.
pub fn page() -> String {
    PAGE.fill("Fleet", &json!({}))
}

/// The collision map of an agent, as SVG.
///
/// # Errors
/// As [`write()`](crate::write()), without the files.
pub fn map(scenario: &Scenario, ego: usize) -> io::Result<String> {
    with_scene(scenario, None, None, |scene| Ok(map::picture(scene, ego)))
}
