//! Tracks of agents, ordered by time.

use super::super::timestamp::Timestamp;
use super::super::{ImportError, WarningCode, Warnings};
use super::{BetweenPoses, PoseOptions};
use crate::footprint::Footprint;
use crate::plane_geometry::distance;
use crate::scenario::{Labels, label};
use crate::vda5050::timestamp::written;
use std::collections::HashMap;

/// Most poses of a file.
const MOST: usize = 20_000_000;

/// Times from here on count from the first one, because as one number they would lack digits \[s\].
const LATE: f64 = 1e6;

/// A pose of an agent, and when it had it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimedPose {
    /// \[s\]
    pub t: f64,
    /// \[m\]
    pub point: [f64; 2],
    /// Which way it faces \[rad\], where that is said.
    pub heading: Option<f64>,
    /// How far the agent may be from the point at this time \[m\].
    pub error: f64,
    /// Index of its map.
    pub map: usize,
    /// Whether anything is known between the pose before and this one.
    pub is_joined: bool,
}

/// The poses of an agent.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseTrack {
    /// Number of the agent.
    pub id: u64,
    /// Radius of its disc \[m\]; with a footprint that of the disc around all of it.
    pub radius: f64,
    /// Its outline, if it is no disc: every pose has a heading then.
    pub footprint: Option<Footprint>,
    /// By time, at least one, no two of the same time.
    pub poses: Vec<TimedPose>,
}

/// A time in which an agent stood because the rest of its order was not released.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldTime {
    /// Number of the agent.
    pub id: u64,
    /// From the first message that says so to the first that does not, or the last one of all \[s\].
    pub t: [f64; 2],
}

/// Poses of several agents.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseLog {
    /// Labels of the agents, by their numbers.
    pub labels: Labels,
    /// From when times count: a time stamp, or seconds as the file has them; `None` where the times are those of the file.
    pub origin: Option<String>,
    /// Names of the maps; one without a name where the file has none.
    pub maps: Vec<String>,
    /// By the numbers of the agents, at least one.
    pub tracks: Vec<PoseTrack>,
    /// When agents stood at the end of what was released to them, by the begins; where the format tells that.
    pub held: Vec<HeldTime>,
    /// Whether agents stand at their first and last pose before and after it.
    pub stands_at_ends: bool,
    /// Where agents may be between their poses.
    pub between: BetweenPoses,
}

/// A time as it is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PoseTime {
    stamp: Timestamp,
    /// \[s\], where it is a number.
    seconds: Option<f64>,
}

impl PoseTime {
    /// A time stamp.
    pub(super) fn stamp(text: &str) -> Option<Self> {
        Timestamp::read(text).map(|stamp| Self { stamp, seconds: None })
    }

    /// A number of seconds.
    pub(super) fn number(text: &str) -> Option<Self> {
        let seconds = text.trim().parse::<f64>().ok().filter(|seconds| seconds.abs() <= crate::scenario::LIMIT)?;
        Some(Self { stamp: Timestamp::of_seconds(text.trim(), seconds), seconds: Some(seconds) })
    }

    /// Seconds and nanoseconds since 1970, or since the begin of a simulation.
    #[cfg(feature = "bags")]
    pub(super) fn since_1970(seconds: i64, nanoseconds: i64) -> Option<Self> {
        let fraction = 1e-9 * nanoseconds as f64;
        let is_time = (0..1_000_000_000).contains(&nanoseconds);
        let stamp = Timestamp::of_whole(seconds).plus(fraction);
        is_time.then_some(Self { stamp, seconds: Some(seconds as f64 + fraction) })
    }

    pub(super) fn seconds(seconds: f64) -> Self {
        Self { stamp: Timestamp::of_seconds("", seconds), seconds: Some(seconds) }
    }

    /// Seconds since another one.
    pub(super) fn since(&self, other: &Self) -> f64 {
        self.stamp.since(other.stamp)
    }

    pub(super) fn is_stamp(&self) -> bool {
        self.seconds.is_none()
    }
}

/// Line and character, counted from 1; of a bag the number of the message.
pub(super) type TextPlace = (usize, Option<usize>);

/// A pose as it was read.
#[derive(Clone, Copy, Debug)]
pub(super) struct RawPose {
    pub(super) time: PoseTime,
    pub(super) point: [f64; 2],
    /// \[rad\]
    pub(super) heading: Option<f64>,
    pub(super) error: f64,
    pub(super) map: usize,
    /// Whether the agent was localized since the pose before.
    pub(super) is_joined: bool,
    pub(super) place: TextPlace,
}

struct OpenTrack {
    name: String,
    radius: Option<f64>,
    poses: Vec<RawPose>,
}

/// Numbers by names, in the order in which these appear.
#[derive(Default)]
struct NameIndex {
    indices: HashMap<String, usize>,
}

impl NameIndex {
    /// The index of a name, and whether it is new.
    fn index(&mut self, name: &str) -> (usize, bool) {
        let next = self.indices.len();
        match self.indices.get(name) {
            Some(index) => (*index, false),
            None => (*self.indices.entry(name.to_owned()).or_insert(next), true),
        }
    }
}

/// Collects the poses of a file.
pub(super) struct PoseLogBuilder<'o> {
    options: &'o PoseOptions,
    radius: Option<f64>,
    footprint: Option<Footprint>,
    agents: NameIndex,
    map_index: NameIndex,
    maps: Vec<String>,
    tracks: Vec<OpenTrack>,
    /// Agents that were held, from when to when.
    held: Vec<(usize, [PoseTime; 2])>,
    count: usize,
    /// Whether places are numbers of messages, and not lines.
    pub(super) counts_messages: bool,
    /// Whether the times of an agent may go back in the file.
    pub(super) is_unordered: bool,
    pub(super) stands_at_ends: bool,
    /// Whether the format says that agents go straight and steadily between their poses.
    pub(super) is_straight: bool,
}

impl<'o> PoseLogBuilder<'o> {
    pub(super) fn new(options: &'o PoseOptions, radius: Option<f64>, footprint: Option<Footprint>) -> Self {
        Self {
            options,
            radius,
            footprint,
            agents: NameIndex::default(),
            map_index: NameIndex::default(),
            maps: Vec::new(),
            tracks: Vec::new(),
            held: Vec::new(),
            count: 0,
            counts_messages: false,
            is_unordered: false,
            stands_at_ends: false,
            is_straight: false,
        }
    }

    /// The index of the agent of this name, which is new where it was not heard of.
    pub(super) fn agent(&mut self, name: &str) -> usize {
        let (index, is_new) = self.agents.index(name);
        if is_new {
            let name = if self.options.anonymous { (index + 1).to_string() } else { label(name) };
            self.tracks.push(OpenTrack { name, radius: None, poses: Vec::new() });
        }
        index
    }

    /// What messages call an agent.
    pub(super) fn name(&self, agent: usize) -> String {
        self.tracks.get(agent).map_or_else(String::new, |track| format!("agent {}", track.name))
    }

    /// The index of the map of this name.
    pub(super) fn map(&mut self, name: &str) -> usize {
        let (index, is_new) = self.map_index.index(name);
        if is_new {
            let name = if self.options.anonymous { format!("map {}", index + 1) } else { label(name) };
            self.maps.push(name);
        }
        index
    }

    /// Notes the radius of an agent \[m\]; what it was before, where that was another one.
    pub(super) fn set_radius(&mut self, agent: usize, radius: f64) -> Result<(), f64> {
        match self.tracks.get_mut(agent) {
            Some(OpenTrack { radius: Some(before), .. }) if *before != radius => Err(*before),
            Some(track) => {
                track.radius = Some(radius);
                Ok(())
            }
            None => Ok(()),
        }
    }

    /// Notes that an agent was held.
    pub(super) fn add_held(&mut self, agent: usize, times: [PoseTime; 2]) {
        self.held.push((agent, times));
    }

    /// The pose of an agent before the next one.
    pub(super) fn last(&self, agent: usize) -> Option<&RawPose> {
        self.tracks.get(agent)?.poses.last()
    }

    /// What is wrong at a place.
    fn error_at(&self, (number, column): TextPlace, problem: String) -> ImportError {
        if self.counts_messages {
            ImportError::new(format!("message {number}: {problem}"))
        } else {
            ImportError::at(number, column, problem)
        }
    }

    /// A place in the middle of a sentence.
    fn said(&self, (number, _): TextPlace) -> String {
        format!("{} {number}", if self.counts_messages { "message" } else { "line" })
    }

    /// Adds a pose.
    pub(super) fn add(&mut self, agent: usize, pose: RawPose) -> Result<(), ImportError> {
        self.count += 1;
        if self.count > MOST {
            return Err(self.error_at(pose.place, format!("more than {MOST} poses up to here")));
        }
        if !self.is_unordered
            && let Some(last) = self.last(agent)
            && pose.time.since(&last.time) < 0.0
        {
            let before = self.said(last.place);
            let problem = format!("{}: its time goes back, from that of {before}", self.name(agent));
            return Err(self.error_at(pose.place, problem));
        }
        if let Some(track) = self.tracks.get_mut(agent) {
            track.poses.push(pose);
        }
        Ok(())
    }

    /// Everything that was read.
    pub(super) fn finish(mut self, warnings: &mut Warnings) -> Result<PoseLog, ImportError> {
        let straight = self.is_straight.then_some(BetweenPoses::Straight(0.0));
        let Some(between) = self.options.between().or(straight) else {
            let why = "what agents do between two poses is not in the file; give --deviation (straight at constant speed, to within that) or \
                       --top-speed (any way, no faster)";
            return Err(ImportError::new(why));
        };
        if self.is_straight && self.options.top_speed.is_some() {
            return Err(ImportError::new(
                "--top-speed has no effect: the plan says that agents go straight; give --deviation",
            ));
        }
        for agent in 0..self.tracks.len() {
            self.sort(agent, warnings)?;
            if self.radius.is_none() && self.tracks[agent].radius.is_none() {
                let problem = format!("{}: its radius is not in the file; give --radius", self.name(agent));
                return Err(ImportError::new(problem));
            }
        }
        if self.radius.is_some() && self.tracks.iter().any(|track| track.radius.is_some()) {
            return Err(ImportError::new("--radius: the file has radii of its own"));
        }
        let times = || self.tracks.iter().flat_map(|track| track.poses.first()).map(|pose| pose.time);
        let first = times().reduce(|first, next| if next.since(&first) < 0.0 { next } else { first });
        let Some(first) = first else { return Err(ImportError::new("there is no pose in it")) };
        let (origin, zero) = match first.seconds {
            Some(seconds) if seconds.abs() < LATE => (None, None),
            Some(_) => (Some(first.stamp.whole().to_string()), Some(first.stamp.whole())),
            None => (Some(written(first.stamp.whole() as f64)), Some(first.stamp.whole())),
        };
        let time = |time: &PoseTime| match (zero, time.seconds) {
            (None, Some(seconds)) => seconds,
            (zero, _) => time.stamp.since(Timestamp::of_whole(zero.unwrap_or(0))),
        };
        let (ids, labels) = self.numbers();
        let mut tracks = Vec::with_capacity(self.tracks.len());
        for (track, &id) in self.tracks.iter().zip(&ids) {
            let mut poses: Vec<TimedPose> = Vec::with_capacity(track.poses.len());
            for raw in &track.poses {
                if self.footprint.is_some() && raw.heading.is_none() {
                    let problem = format!(
                        "agent {}: no heading, on which its outline depends; --radius takes it as a disc",
                        track.name
                    );
                    return Err(self.error_at(raw.place, problem));
                }
                let t = time(&raw.time);
                let before = poses.last();
                let is_near = |before: &TimedPose| {
                    before.map == raw.map && self.options.gap.is_none_or(|gap| t - before.t <= gap)
                };
                let is_joined = raw.is_joined && before.is_some_and(is_near);
                if let (true, Some(before), BetweenPoses::TopSpeed { speed, .. }) = (is_joined, before, between) {
                    let least = distance(before.point, raw.point) - before.error - raw.error;
                    let duration = t - before.t;
                    // Rounding is no contradiction.
                    if least > speed * duration * (1.0 + 1e-9) + 1e-9 {
                        let problem = format!(
                            "agent {}: {least:.3} m from the pose before, in {duration:.3} s; at --top-speed {speed} it does not get here",
                            track.name
                        );
                        return Err(self.error_at(raw.place, problem));
                    }
                }
                let RawPose { point, heading, error, map, .. } = *raw;
                poses.push(TimedPose { t, point, heading, error, map, is_joined });
            }
            let radius = track.radius.or(self.radius).unwrap_or_default();
            tracks.push(PoseTrack { id, radius, footprint: self.footprint.clone(), poses });
        }
        let held = self.held.iter().filter_map(|(agent, times)| {
            Some(HeldTime { id: *ids.get(*agent)?, t: [time(&times[0]), time(&times[1])] })
        });
        let mut held: Vec<HeldTime> = held.collect();
        held.sort_by(|a, b| a.t[0].total_cmp(&b.t[0]).then(a.id.cmp(&b.id)));
        tracks.sort_by_key(|track| track.id);
        let maps = if self.maps.is_empty() { vec![String::new()] } else { self.maps };
        Ok(PoseLog { labels, origin, maps, tracks, held, stands_at_ends: self.stands_at_ends, between })
    }

    /// Orders the poses of an agent by time, of which no two are the same.
    fn sort(&mut self, agent: usize, warnings: &mut Warnings) -> Result<(), ImportError> {
        let name = self.name(agent);
        let Some(track) = self.tracks.get_mut(agent) else { return Ok(()) };
        track.poses.sort_by(|a, b| a.time.since(&b.time).total_cmp(&0.0));
        let mut kept: Vec<RawPose> = Vec::with_capacity(track.poses.len());
        let poses = std::mem::take(&mut track.poses);
        for pose in poses {
            match kept.last_mut() {
                Some(last) if pose.time.since(&last.time) == 0.0 => {
                    if (pose.point, pose.map) != (last.point, last.map) || differ(pose.heading, last.heading) {
                        let before = self.said(last.place);
                        return Err(self.error_at(
                            pose.place,
                            format!("{name}: at the same time as in {before}, at another place"),
                        ));
                    }
                    warnings.add(WarningCode::GivenTwice, &name, "a pose is there twice");
                    last.error = last.error.min(pose.error);
                    last.heading = last.heading.or(pose.heading);
                    last.is_joined &= pose.is_joined;
                }
                _ => kept.push(pose),
            }
        }
        let is_empty = kept.is_empty();
        if let Some(track) = self.tracks.get_mut(agent) {
            track.poses = kept;
        }
        if is_empty {
            return Err(ImportError::new(format!("{name}: no pose of it is known")));
        }
        Ok(())
    }

    /// The numbers of the agents, and their labels: names that are numbers are theirs.
    fn numbers(&self) -> (Vec<u64>, Labels) {
        let own = |track: &OpenTrack| track.name.parse::<u64>().ok().filter(|id| id.to_string() == track.name);
        match self.tracks.iter().map(own).collect::<Option<Vec<u64>>>() {
            Some(ids) => (ids, Labels::default()),
            None => {
                let ids: Vec<u64> = (0..self.tracks.len() as u64).collect();
                let names = self.tracks.iter().map(|track| track.name.clone());
                let labels = ids.iter().copied().zip(names).collect();
                (ids, labels)
            }
        }
    }
}

/// Whether two headings are said and are not the same.
fn differ(a: Option<f64>, b: Option<f64>) -> bool {
    a.zip(b).is_some_and(|(a, b)| a != b)
}
