//! Fig. 13 and 14 of the paper.

use super::{DocumentSection, EvaluationError, PaperFleets, Thoroughness, picture};
use pcr_comparing::compare::{ComparisonInput, sampled};
use pcr_core::Interval;
use pcr_drawing::{self as picture, Overlay};
use pcr_formats::scenario::{Agent, MotionSpec, PathSegment, Scenario};
use std::f64::consts::{FRAC_PI_2, PI};
use std::io;
use std::path::PathBuf;

/// Steps of the sampled maps \[s\], whether all of the map is shown, and names and titles of the pictures.
const MAPS: [(f64, bool, &str, &str); 3] = [
    (0.01, true, "fig13", "Regions of agent 3 over a map sampled every 0.01 s"),
    (0.01, false, "fig13-fine", "A part of it, every 0.01 s"),
    (0.1, false, "fig13-coarse", "The same part, every 0.1 s"),
];

/// Times \[s\] and lengths \[m\] of that part: three regions, two of which overlap.
const PART: [Interval<f64>; 2] = [Interval::new(5.0, 9.0), Interval::new(8.3, 10.8)];

pub(super) fn section(fleets: &PaperFleets, extent: Thoroughness) -> Result<DocumentSection, EvaluationError> {
    let drawn = |svg: io::Result<String>| {
        svg.map_err(|error| EvaluationError::File(PathBuf::from("picture"), error.to_string()))
    };
    let mut text = String::from(
        "## Fig. 13: agent 3\n\nOutlines in closed form, drawn over the sampled maps. Every sample is drawn as the stretch of path and time that it \
        represents.\n\n",
    );
    let mut pictures = Vec::new();
    if let Some(fleet) = fleets.paper12() {
        let input = ComparisonInput::new(&fleet.scenario)?;
        let field = input.field();
        /// Place of agent 3.
        const EGO: usize = 2;
        for (step, whole, name, title) in MAPS {
            if extent == Thoroughness::Quick && step < 0.1 {
                continue;
            }
            let bars = sampled::bars(&field, step, EGO);
            let overlay = Overlay { bars: &bars, step, part: (!whole).then_some(PART), title };
            pictures.push((name, drawn(picture::over(&fleet.scenario, EGO, &overlay))?));
            text.push_str(&picture(name, title));
        }
    }
    text.push_str(
        "\n## Fig. 14: three special cases\n\nThe cases are paths that do not cross but come near, two regions that overlap and form one, and a \
        region across a joint of a path. The library needs no special treatment for them.\n\n",
    );
    for (name, title, scenario) in cases() {
        pictures.push((name, drawn(picture::overview(&scenario, None))?));
        text.push_str(&picture(name, title));
    }
    Ok(DocumentSection { text, pictures })
}

fn agent(id: u64, start: [f64; 3], path: Vec<PathSegment>) -> Agent {
    let motion = MotionSpec::RestToRest { v_max: 0.5, a_max: 0.5 };
    Agent::disc(id, 0.2, start, path, motion)
}

fn cases() -> [(&'static str, &'static str, Scenario); 3] {
    let line = |length| PathSegment::Line { length };
    let arc = |radius, sweep| PathSegment::arc(radius, sweep);
    let straight = || agent(1, [-2.0, 0.0, 0.0], vec![line(4.0)]);
    let of = |name: &str, agents: Vec<Agent>| Scenario::new(name, agents);
    [
        (
            "fig14a",
            "Two paths without an intersection: an arc that comes near a line",
            of("near each other", vec![straight(), agent(2, [-1.5, 1.75, -FRAC_PI_2], vec![arc(1.5, PI)])]),
        ),
        (
            "fig14b",
            "Two crossings so near each other that their regions overlap",
            of("overlapping regions", vec![straight(), agent(2, [-1.5, 1.15, -FRAC_PI_2], vec![arc(1.5, PI)])]),
        ),
        (
            "fig14c",
            "A path that changes from a line to an arc in the middle of a region",
            of("across a joint", vec![straight(), agent(2, [0.3, -1.5, FRAC_PI_2], vec![line(1.45), arc(0.6, 2.2)])]),
        ),
    ]
}
