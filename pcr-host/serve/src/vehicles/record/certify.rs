//! The proof that the vehicles of a record never touched: window by window, by the independent checker.

use super::RecordVehicle;
use super::outline_body::{bodies, unwound};
use super::read::{RecordContents, read};
use pcr_certify::error::CertifyError;
use pcr_certify::motion::{MotionFindings, Mover, meetings};
use pcr_certify::outline::{self, Body, RawBody, motion::Driven};
use pcr_certify::raw::{RawAgent, RawAngle, RawMotion, RawPath, RawPhase, RawSegment};
use serde::Serialize;
use std::io::{self, BufRead};

/// The result of the check of a record.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct RecordCertificate {
    /// `pcr-contacts`
    pub format: &'static str,
    /// 1
    pub version: u32,
    /// `proved`: no contact at any time. `contact`: there is one. `undecided`: so near that rounding does not tell, or not checked.
    pub verdict: &'static str,
    /// Number of vehicles.
    pub vehicles: usize,
    /// Time from the first to the last line \[s\].
    pub time: f64,
    /// Length travelled by all vehicles together \[m\].
    pub travelled: f64,
    /// The first contact of each pair of vehicles in each window of time.
    pub contacts: Vec<VehicleContact>,
    /// Number of pairs and windows without a decision.
    pub undecided: usize,
    /// Why there is no verdict.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

/// A contact of two vehicles.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VehicleContact {
    /// Names of the two vehicles.
    pub vehicles: [String; 2],
    /// Time of the contact \[s\].
    pub time: f64,
    /// Distance of the discs or outlines, negative where they overlap \[m\].
    pub clearance: f64,
}

/// Windows in which motions are checked \[s\]; one that would have no line in it lasts until the next line.
const WINDOW: f64 = 20.0;

/// Proves that the vehicles of a record never touched, or shows where.
///
/// # Errors
/// A line that is not part of a record, or fewer than two vehicles, of which nothing could be proved. A record that ends within a line
/// after the first one was cut off there: this is no error, and the verdict is `undecided`.
pub fn certify(text: impl BufRead) -> io::Result<RecordCertificate> {
    let RecordContents { vehicles, tracks, cut } = read(text)?;
    let count = vehicles.len();
    // In a record that was cut, some vehicles may have no line yet.
    let there = vehicles.into_iter().zip(tracks).filter(|(_, track)| !track.is_empty());
    let (there, tracks): (Vec<_>, Vec<_>) = there.unzip();
    Ok(RecordCertificate { vehicles: count, ..checked(&there, &tracks, cut) })
}

fn checked(vehicles: &[RecordVehicle], tracks: &[Vec<[f64; 4]>], error: Option<String>) -> RecordCertificate {
    let mut times: Vec<f64> = tracks.iter().flatten().map(|point| point[0]).collect();
    times.sort_by(f64::total_cmp);
    let (begin, end) = (times.first().copied().unwrap_or(0.0), times.last().copied().unwrap_or(0.0));
    let legs = tracks.iter().flat_map(|track| track.windows(2));
    let travelled = legs.map(|leg| (leg[1][1] - leg[0][1]).hypot(leg[1][2] - leg[0][2])).sum();
    let (format, version) = ("pcr-contacts", 1);
    let (count, time) = (vehicles.len(), end - begin);
    let mut found =
        RecordCertificate { format, version, vehicles: count, time, travelled, error, ..RecordCertificate::default() };
    let far = |track: &Vec<[f64; 4]>| track.iter().flat_map(|[_, x, y, _]| [x.abs(), y.abs()]).fold(1.0, f64::max);
    let far: Vec<f64> = tracks.iter().map(far).collect();
    let tracks: Vec<Vec<[f64; 4]>> = tracks.iter().map(|track| unwound(track)).collect();
    for [from, to] in windows(&times) {
        let parts: Vec<_> = tracks.iter().map(|track| track_between(track, from, to)).collect();
        match met(vehicles, &parts, &far, [from, to]) {
            Ok(met) => {
                found.undecided += met.undecided.len();
                let name = |id: u64| vehicles.get(id as usize).map_or_else(String::new, |vehicle| vehicle.name.clone());
                found.contacts.extend(met.contacts.iter().map(|meeting| VehicleContact {
                    vehicles: meeting.agents.map(name),
                    time: meeting.time,
                    clearance: meeting.clearance,
                }));
            }
            Err(why) => {
                found.error.get_or_insert(why);
            }
        }
    }
    found.verdict = match (found.contacts.is_empty(), found.undecided, &found.error) {
        (false, ..) => "contact",
        (true, 0, None) => "proved",
        _ => "undecided",
    };
    found
}

/// The contacts of vehicles with these parts of their tracks in a window of time.
///
/// # Errors
/// What is no motion, in words.
fn met(
    vehicles: &[RecordVehicle],
    parts: &[Vec<[f64; 4]>],
    far: &[f64],
    window: [f64; 2],
) -> Result<MotionFindings, String> {
    let all = || vehicles.iter().zip(parts).zip(far).enumerate();
    if let Some(discs) = vehicles.iter().map(|vehicle| vehicle.radius).collect::<Option<Vec<f64>>>() {
        let movers = all()
            .zip(discs)
            .map(|((id, ((_, part), &far)), radius)| Mover::new(&agent(id as u64, radius, part, far), window));
        let movers = movers.collect::<Result<Vec<_>, _>>().map_err(|wrong| wrong.to_string())?;
        return Ok(meetings(&movers));
    }
    let mut raw = Vec::new();
    for (id, ((vehicle, part), &far)) in all() {
        raw.extend(bodies(id as u64, vehicle, part, far)?);
    }
    outlines_met(&raw, window).map_err(|wrong| wrong.to_string())
}

fn outlines_met(raw: &[RawBody], window: [f64; 2]) -> Result<MotionFindings, CertifyError> {
    let placed = raw.iter().map(Body::new).collect::<Result<Vec<_>, _>>()?;
    let driven = placed.iter().map(|body| Driven::new(body, window)).collect::<Result<Vec<_>, _>>()?;
    Ok(outline::motion::meetings(&driven))
}

/// The windows from the first of these times to the last one, at most one a time: times are in order.
pub(super) fn windows(times: &[f64]) -> Vec<[f64; 2]> {
    let (Some(&begin), Some(&end)) = (times.first(), times.last()) else { return Vec::new() };
    let (mut windows, mut from, mut next) = (Vec::new(), begin, 0);
    loop {
        next += times[next..].partition_point(|&time| time <= from);
        let to = times.get(next).map_or(end, |&time| time.max(from + WINDOW)).min(end);
        windows.push([from, to]);
        if to >= end {
            return windows;
        }
        from = to;
    }
}

/// The part of a track between two times.
fn track_between(track: &[[f64; 4]], from: f64, to: f64) -> Vec<[f64; 4]> {
    let at = |time: f64| {
        let next = track.partition_point(|point| point[0] <= time);
        match (next.checked_sub(1).and_then(|last| track.get(last)), track.get(next)) {
            (Some(a), Some(b)) => {
                let part = (time - a[0]) / (b[0] - a[0]);
                [time, a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2]), a[3] + part * (b[3] - a[3])]
            }
            (Some(only), None) | (None, Some(only)) => [time, only[1], only[2], only[3]],
            (None, None) => [time, 0.0, 0.0, 0.0],
        }
    };
    let [first, last] = [track.partition_point(|point| point[0] <= from), track.partition_point(|point| point[0] < to)];
    let inside = track.get(first..last).unwrap_or_default().iter().copied();
    std::iter::once(at(from)).chain(inside).chain(std::iter::once(at(to))).collect()
}

/// A disc that goes from point to point; `far` is the largest coordinate of those that they were taken from \[m\].
fn agent(id: u64, radius: f64, points: &[[f64; 4]], far: f64) -> RawAgent {
    let [first, last] = [points.first(), points.last()].map(|end| end.copied().unwrap_or_default());
    let (mut segments, mut phases): (Vec<RawSegment>, Vec<RawPhase>) = (Vec::new(), Vec::new());
    let (mut length, mut fastest, mut heading, mut initial) = (0.0, 0.0_f64, 0.0, None);
    for pair in points.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let (time, way) = (b[0] - a[0], (b[1] - a[1]).hypot(b[2] - a[2]));
        if time <= 0.0 {
            continue;
        }
        if way > 0.0 {
            let direction = (b[2] - a[2]).atan2(b[1] - a[1]);
            let turn = direction - *initial.get_or_insert(direction) - heading;
            let turns = if turn == 0.0 { Vec::new() } else { vec![RawAngle::Radians(turn)] };
            heading += turn;
            segments.push(RawSegment { length: way, radius: None, turns, from: length, to: length + way });
        }
        let speed = way / time;
        fastest = fastest.max(speed);
        let [begin, end] = [a[0] - first[0], b[0] - first[0]];
        phases.push(RawPhase { time: [begin, end], length: [length, length + way], speed: [speed, speed] });
        length += way;
    }
    if segments.is_empty() {
        segments.push(RawSegment { length: 0.0, radius: None, turns: Vec::new(), from: 0.0, to: 0.0 });
        phases.clear();
    }
    // Each direction and each sum is rounded, along all of the way; and so are the coordinates and the times.
    let late = fastest * (last[0] - first[0]);
    let rounding = f64::EPSILON * (length + late + far) * (64.0 + 4.0 * segments.len() as f64);
    let start = [first[1], first[2]];
    let path = RawPath { start, heading: RawAngle::Radians(initial.unwrap_or(0.0)), segments, rounding, step: 0.0 };
    // Discs that are nearer than that are taken for discs that touch.
    let radius = radius + rounding;
    RawAgent { id, radius, path, travel: Some(RawMotion { start: first[0], phases, lag: 0.0, time_excess: 0.0 }) }
}
