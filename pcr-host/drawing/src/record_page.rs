//! A page about a record of what ran: where everybody was, how near any two were over time, and when a contact is proved, excluded or not
//! known. One HTML file that contains everything and sends no requests.

use crate::palette::colour;
use crate::template::PageTemplate;
use pcr_formats::import::{BetweenPoses, PoseLog, PoseTrack};
use pcr_planning::approaches::{ApproachEntry, ApproachReport, ContactVerdict, NearnessProfiles};
use serde_json::{Value, json};
use std::collections::BTreeSet;

const PAGE: PageTemplate = PageTemplate {
    kind: "record",
    connect: "",
    body: include_str!("record/record.html"),
    style: include_str!("record/record.css"),
    script: concat!(
        include_str!("crowd.js"),
        include_str!("outward.js"),
        include_str!("canvas.js"),
        include_str!("record/record.js"),
        include_str!("record/nearness.js"),
        include_str!("scale.js")
    ),
};

/// Positions are given in this unit \[m\], times in the next \[s\], headings in the last \[rad\].
const UNIT: f64 = 1e-4;
const TIME_UNIT: f64 = 1e-3;
const ANGLE_UNIT: f64 = 1e-4;

/// Times of a pair that are told apart.
const PARTS: usize = 400;

/// Pairs on a page: those of which a contact is proved, then those of which it cannot be known, then the nearest ones.
const PAIRS: usize = 100;

/// Poses on a page; of a record with more, those around the nearest approaches of its pairs.
const POSES: usize = 300_000;

/// Time that is shown before and after an approach of such a record \[s\].
const AROUND: f64 = 15.0;

/// A pair on the page.
struct ShownPair {
    /// Indices of the tracks.
    agents: [usize; 2],
    /// Time around which it is shown \[s\].
    around: [f64; 2],
}

/// The page about a record; the report has the nearest approach of every pair.
pub fn page(report: &ApproachReport, log: &PoseLog) -> String {
    let name = if report.name.is_empty() { "Record" } else { &report.name };
    PAGE.fill(name, &data(report, log))
}

fn rounded(value: f64, unit: f64) -> i64 {
    (value / unit).round() as i64
}

/// The pairs that are shown, and how many there are.
fn pairs(report: &ApproachReport, log: &PoseLog) -> (Vec<ShownPair>, usize) {
    let index = |id: u64| log.tracks.iter().position(|track| track.id == id).unwrap_or_default();
    let mut shown: Vec<ShownPair> = Vec::new();
    let mut known = BTreeSet::new();
    let is_contact = |it: &&ApproachEntry| it.verdict == ContactVerdict::Contact;
    let proved = report.approaches.iter().filter(is_contact);
    for approach in proved.chain(report.approaches.iter().filter(|it| !is_contact(it))) {
        if known.insert((approach.i, approach.j)) {
            shown.push(ShownPair { agents: [approach.i, approach.j].map(index), around: approach.t });
        }
    }
    let mut nearest: Vec<_> = report.closest.iter().flatten().collect();
    nearest.sort_by(|a, b| a.clearance[0].total_cmp(&b.clearance[0]));
    for pair in nearest {
        if known.insert((pair.i, pair.j)) {
            shown.push(ShownPair { agents: [pair.i, pair.j].map(index), around: [pair.t; 2] });
        }
    }
    let count = shown.len();
    shown.truncate(PAIRS);
    (shown, count)
}

fn data(report: &ApproachReport, log: &PoseLog) -> Value {
    let (pairs, count) = pairs(report, log);
    let poses: usize = log.tracks.iter().map(|track| track.poses.len()).sum();
    let is_whole = poses <= POSES;
    let windows: Vec<[f64; 2]> = pairs.iter().map(|pair| [pair.around[0] - AROUND, pair.around[1] + AROUND]).collect();
    let is_shown = |t: f64| is_whole || windows.iter().any(|window| window[0] <= t && t <= window[1]);
    let agents = log.tracks.iter().enumerate().map(|(place, track)| {
        json!({
            "id": track.id.to_string(),
            "name": log.labels.display_name(track.id),
            "radius": track.radius,
            "body": track.footprint.as_ref().map(|footprint| footprint.polygon()),
            "colour": colour(place).to_string(),
            "track": self::track(track, &is_shown),
        })
    });
    let contacts = report.approaches.iter().filter(|it| it.verdict == ContactVerdict::Contact).count();
    let profiles = NearnessProfiles::new(log);
    let shown = pairs.iter().map(|pair| {
        let [a, b] = pair.agents.map(|index| &log.tracks[index]);
        let time = common(a, b, log);
        let parts = profiles.of_pair(pair.agents, time, PARTS);
        let approaches = report.approaches.iter().filter(|it| it.i == a.id && it.j == b.id);
        let closest = report.closest.iter().flatten().find(|it| it.i == a.id && it.j == b.id);
        json!({
            "agents": pair.agents,
            "time": time,
            "parts": parts.iter().map(|part| [part.t[0], part.t[1], short(part.clearance[0], f64::floor), short(part.clearance[1], f64::ceil)]).collect::<Vec<_>>(),
            "approaches": approaches.collect::<Vec<_>>(),
            "closest": closest,
        })
    });
    json!({
        "name": report.name,
        "origin": report.origin,
        "unit": UNIT,
        "timeUnit": TIME_UNIT,
        "angleUnit": ANGLE_UNIT,
        "between": match log.between {
            BetweenPoses::Straight(deviation) => json!({ "deviation": deviation }),
            BetweenPoses::TopSpeed { speed, rotation } => json!({ "speed": speed, "rotation": rotation }),
        },
        "maps": log.maps,
        "stands": log.stands_at_ends,
        "isWhole": is_whole,
        "count": count,
        "contacts": contacts,
        "unknown": report.approaches.len() - contacts,
        "agents": agents.collect::<Vec<_>>(),
        "pairs": shown.collect::<Vec<_>>(),
        "warnings": report.warnings,
    })
}

/// A bound with four digits after the point, rounded to one side.
fn short(value: f64, rounded: fn(f64) -> f64) -> f64 {
    rounded(value * 1e4) / 1e4
}

/// The time in which two agents are on record, or the first of them stands.
fn common(a: &PoseTrack, b: &PoseTrack, log: &PoseLog) -> [f64; 2] {
    let ends =
        |track: &PoseTrack| [track.poses.first(), track.poses.last()].map(|pose| pose.map_or(0.0, |pose| pose.t));
    if log.stands_at_ends {
        let all = log.tracks.iter().map(ends);
        return all.fold([f64::INFINITY, f64::NEG_INFINITY], |sum, it| [sum[0].min(it[0]), sum[1].max(it[1])]);
    }
    let [a, b] = [ends(a), ends(b)];
    [a[0].max(b[0]), a[1].min(b[1])]
}

/// The poses of an agent: times, x and y in turn, headings where all are known, and the places at which something is not joined, or on
/// which map it goes on.
fn track(track: &PoseTrack, is_shown: &dyn Fn(f64) -> bool) -> Value {
    let (mut t, mut points, mut headings, mut errors) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut cuts, mut maps): (Vec<usize>, Vec<[usize; 2]>) = (Vec::new(), Vec::new());
    let mut was_shown = false;
    for pose in &track.poses {
        let shown = is_shown(pose.t);
        if shown {
            if !pose.is_joined || !was_shown {
                cuts.push(t.len());
            }
            if maps.last().is_none_or(|last| last[1] != pose.map) {
                maps.push([t.len(), pose.map]);
            }
            t.push(rounded(pose.t, TIME_UNIT));
            points.extend(pose.point.map(|value| rounded(value, UNIT)));
            headings.extend(pose.heading.map(|heading| rounded(heading, ANGLE_UNIT)));
            errors.push(rounded(pose.error, UNIT));
        }
        was_shown = shown;
    }
    if headings.len() < t.len() {
        headings.clear();
    }
    if errors.iter().all(|error| *error == 0) {
        errors.clear();
    }
    json!({ "t": t, "points": points, "headings": headings, "errors": errors, "cuts": cuts, "maps": maps })
}
