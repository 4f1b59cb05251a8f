//! The state of a robot: its abilities, its path, its place on the path, and how far it has been allowed to go.

use crate::closed_area::{AreasOnPath, SpeedLimit};
use crate::owned_path::{OwnedPath, PathElement, PathRounding};
use pcr_core::{Interval, InvalidInput, Motion, MovementAuthority, Progress};
use pcr_formats::footprint::Footprint;
use pcr_planning::fleet::ConvexBody;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt;

/// Additional radius of all discs and outlines \[m\]: for the rounding of paths that are cut and joined, and of lengths in messages.
pub const ROOM: f64 = 1e-6;

/// If a robot is behind a length that it had passed by more than this plus twice its margin, it counts as having gone back
/// \[m\].
pub const BACK: f64 = 0.05;

/// The outline and the abilities of a robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "TraitsRecord", into = "TraitsRecord")]
pub struct RobotTraits {
    /// Radius of the disc that contains it, also while it turns in place \[m\]: with a footprint that of the disc around all of it.
    pub radius: f64,
    /// Its outline; `None` for a disc. It faces along its path.
    pub footprint: Option<Footprint>,
    /// Distance by which any of its points may be off, because it is off its path or turned; kept free around it \[m\].
    pub margin: f64,
    /// Largest speed \[m/s\].
    pub speed: f64,
    /// Deceleration with which it stops \[m/s²\].
    pub acceleration: f64,
}

/// The traits in messages and in the journal: a radius or a footprint.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct TraitsRecord {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    radius: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    footprint: Option<Footprint>,
    #[serde(default)]
    margin: f64,
    speed: f64,
    acceleration: f64,
}

impl TryFrom<TraitsRecord> for RobotTraits {
    type Error = &'static str;

    fn try_from(record: TraitsRecord) -> Result<Self, &'static str> {
        let TraitsRecord { radius, footprint, margin, speed, acceleration } = record;
        let radius = match (radius, &footprint) {
            (Some(radius), None) => radius,
            (None, Some(footprint)) => footprint.circumscribed_radius(),
            (Some(_), Some(_)) => return Err("a robot has a radius or a footprint, not both"),
            (None, None) => return Err("a robot has a radius or a footprint"),
        };
        Ok(Self { radius, footprint, margin, speed, acceleration })
    }
}

impl From<RobotTraits> for TraitsRecord {
    fn from(traits: RobotTraits) -> Self {
        let RobotTraits { radius, footprint, margin, speed, acceleration } = traits;
        Self { radius: footprint.is_none().then_some(radius), footprint, margin, speed, acceleration }
    }
}

/// Largest value of each trait, in its unit.
const MOST: f64 = 1e4;

/// A value of a robot's traits that is out of range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TraitsError {
    /// Name of the value.
    pub name: &'static str,
    /// The value, in its unit.
    pub value: f64,
    /// Least value that is allowed.
    pub least: f64,
}

impl fmt::Display for TraitsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, value, least } = self;
        write!(f, "{name}: {value} is out of range; allowed is {least} to {MOST}")
    }
}

impl std::error::Error for TraitsError {}

impl RobotTraits {
    /// Returns the traits if all values are in their ranges.
    ///
    /// # Errors
    /// [`TraitsError`] for the first value that is not.
    pub fn checked(self) -> Result<Self, TraitsError> {
        for (name, value, least) in [
            ("radius", self.radius, 1e-4),
            ("speed", self.speed, 1e-4),
            ("acceleration", self.acceleration, 1e-4),
            ("margin", self.margin, 0.0),
        ] {
            if !(least..=MOST).contains(&value) {
                return Err(TraitsError { name, value, least });
            }
        }
        Ok(self)
    }

    /// Radius with margin, for which orders are made \[m\].
    pub fn radius_with_margin(&self) -> f64 {
        self.radius + self.margin + ROOM
    }

    /// Returns what has to be kept free of others: its disc, or the convex hull of its outline, larger by its margin. Where its heading is
    /// not known, that is the disc around its outline.
    ///
    /// # Errors
    /// [`InvalidInput`] where it is out of range.
    pub fn body(&self, any_heading: bool) -> Result<ConvexBody, InvalidInput> {
        match self.footprint.as_ref().filter(|_| !any_heading) {
            None => Ok(ConvexBody::Disc(self.radius_with_margin())),
            outline => ConvexBody::of_vehicle(outline, self.radius)?.inflated(self.margin + ROOM),
        }
    }

    /// Distance from the reference point within which a turn moves its points \[m\]; 0 for a disc.
    pub(crate) fn spread(&self) -> f64 {
        if self.footprint.is_some() { self.radius } else { 0.0 }
    }

    /// Distance in which it stops from its largest speed \[m\].
    pub fn braking(&self) -> f64 {
        self.speed * self.speed / (2.0 * self.acceleration)
    }
}

/// The reason why a robot may not go on, whatever its orders say.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "why")]
pub enum Alarm {
    /// It is beyond its hold.
    Beyond {
        /// Its hold \[m\].
        #[serde(rename = "told")]
        notified_limit: f64,
        /// Upper end of the reported position \[m\].
        at: f64,
    },
    /// It is behind a length that it had passed: others may be allowed to go there.
    Back {
        /// Length that it had passed \[m\].
        passed: f64,
        /// Lengths of its path between which it is now \[m\].
        between: [f64; 2],
    },
    /// It is not on its path.
    Off {
        /// Position \[m\].
        x: f64,
        /// \[m\]
        y: f64,
    },
}

/// A mission that waits to be admitted.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct PendingMission {
    /// Id that the fleet manager gave it.
    pub mission: String,
    /// Length of the present path at which the mission leaves it \[m\].
    pub after: f64,
    /// Number of the present path.
    pub path: u64,
    /// Shapes of the mission's path.
    pub shapes: Vec<PathElement>,
    /// Whether the robot may have any heading on them.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub any_heading: bool,
    /// Number in the queue: missions with lower numbers are tried first.
    pub turn: u64,
    /// Where it may end until the rest of it is admitted, in the order of travel.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ends: Vec<MissionEnd>,
}

/// A place at which a mission may end for now.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MissionEnd {
    /// Id of the mission that ends there.
    pub mission: String,
    /// Number of shapes of the whole mission up to there.
    pub shapes: usize,
}

/// The request of a mission. A second request under the same id has to be equal to it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MissionFingerprint {
    /// Length of the path before at which the mission begins \[m\].
    pub after: f64,
    /// Number of shapes at the end of the path that belong to the mission.
    pub shapes: usize,
    /// Whether the robot may have any heading on them.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub any_heading: bool,
}

/// How far the passing orders allow a robot to go, for the positions of the others at the time of the computation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrecedenceLimit {
    /// The hold.
    pub hold: MovementAuthority<f64>,
    /// The robot that it waits for, by its index, and the length of that robot \[m\]: when that one has gone on, the hold may
    /// be further.
    pub waits_for: Option<(usize, f64)>,
    /// Its own length \[m\]: when it has gone on, it may have passed what kept it.
    pub at: f64,
}

/// Notes that other modules have stored about a robot, by key.
pub(crate) type RobotNotes = BTreeMap<String, Value>;

/// Appends to a note that is a list; a missing note is an empty list. `false` if the note is not a list.
pub(crate) fn remember(notes: &mut RobotNotes, key: &str, more: &[Value]) -> bool {
    let Value::Array(list) = notes.entry(key.into()).or_insert_with(|| Value::Array(Vec::new())) else {
        return false;
    };
    list.extend_from_slice(more);
    true
}

/// A robot in the supervisor.
#[derive(Clone, Debug)]
pub struct SupervisedRobot {
    /// Name of the robot.
    pub name: String,
    /// Its abilities.
    pub abilities: RobotTraits,
    /// What is kept free of others: [`RobotTraits::body`].
    pub(crate) body: ConvexBody,
    /// Whether it may have any heading on its present path.
    pub any_heading: bool,
    /// Its present path.
    pub course: OwnedPath,
    /// What is missing from the start of the path.
    pub rest: PathRounding,
    /// Number of its path. The first one is 1 above the highest number of any removed robot; each new path has the next number.
    pub path: u64,
    /// Where the path begins, as a length of the way since the robot was added \[m\]: the sum of what was cut off from earlier
    /// paths.
    pub origin: f64,
    /// Id of the mission that it got last.
    pub mission: Option<String>,
    /// Request of that mission; `None` if it is not known.
    pub asked: Option<MissionFingerprint>,
    /// Ids of earlier missions, oldest first: a late repetition of their requests has no effect.
    pub past: Vec<String>,
    /// Length that it has certainly reached \[m\]; never decreases on the same path.
    pub arc_length: f64,
    /// Length that it had certainly not passed at the time `heard` \[m\].
    pub up_to: f64,
    /// Time to which `up_to` belongs \[s\]; `None` before the first position since the start.
    pub heard: Option<f64>,
    /// Time of its last message \[s\].
    pub alive: Option<f64>,
    /// Hold that it may be told now \[m\].
    pub granted: f64,
    /// Largest hold that it may have been told \[m\]. It equals `granted`, except after a restart: then it is the hold of the
    /// journal, which the robot may have reached, but which must not be told again before it is computed anew.
    pub notified_limit: f64,
    /// The hold in the journal \[m\], at least `told`.
    pub ceiling: f64,
    /// Next length at which it can stop \[m\]: a hold before that is of no use to it. 0 after a restart.
    pub next: f64,
    /// How far its orders allow it to go; `None` if that has to be computed.
    pub authority: Option<PrecedenceLimit>,
    /// Its alarm, if there is one.
    pub alarm: Option<Alarm>,
    /// The robot because of which it must stop, as that one may be anywhere near.
    pub stopped: Option<String>,
    /// Name of the closed area before which it waits.
    pub(crate) closure: Option<String>,
    /// The closed areas on its path; `None` before they were looked for.
    pub(crate) areas: Option<AreasOnPath>,
    /// Where its speed is limited on its path, as it was told.
    pub(crate) speed_limits: Vec<SpeedLimit>,
    /// The number of the path and the revision of the closures of which these are; `None`: nothing was told since the start.
    pub(crate) limits_at: Option<(u64, u64)>,
    /// Its waiting mission, if there is one.
    pub waiting: Option<PendingMission>,
    /// What it does where it stands, in words, as it says.
    pub(crate) doing: Option<String>,
    /// Whether a person has said that it is away.
    pub(crate) away: bool,
    /// Whether it was away, was added since, and it has not been looked yet whether it stands where others may go.
    pub(crate) returned: bool,
    /// Whether it has been reported as silent.
    pub silent: bool,
    /// Time at which it was last seen to advance, or got a path \[s\].
    pub moved: Option<f64>,
    /// Whether a standstill because of it has been reported since then.
    pub stands: bool,
    /// Notes that other modules have stored about it, by key.
    pub notes: RobotNotes,
}

impl SupervisedRobot {
    /// A robot that stands at the start of its path. Other robots may still have the right to go there.
    ///
    /// # Errors
    /// [`InvalidInput`] for an outline that is out of range.
    pub fn new(
        name: String,
        abilities: RobotTraits,
        any_heading: bool,
        course: OwnedPath,
    ) -> Result<Self, InvalidInput> {
        Ok(Self {
            name,
            body: abilities.body(any_heading)?,
            abilities,
            any_heading,
            course,
            rest: PathRounding::default(),
            path: 1,
            origin: 0.0,
            mission: None,
            asked: None,
            past: Vec::new(),
            arc_length: 0.0,
            up_to: 0.0,
            heard: None,
            alive: None,
            granted: 0.0,
            notified_limit: 0.0,
            ceiling: 0.0,
            next: 0.0,
            authority: None,
            alarm: None,
            stopped: None,
            closure: None,
            areas: None,
            speed_limits: Vec::new(),
            limits_at: None,
            waiting: None,
            doing: None,
            away: false,
            returned: false,
            silent: false,
            moved: None,
            stands: false,
            notes: RobotNotes::new(),
        })
    }

    /// Request of its mission: length of the path before, shapes, and whether it may have any heading; `None` if it is not known.
    pub(crate) fn mission_request(&self) -> Option<(f64, &[PathElement], bool)> {
        let MissionFingerprint { after, shapes, any_heading } = self.asked?;
        let all = self.course.shapes();
        Some((after, all.get(all.len().checked_sub(shapes)?..)?, any_heading))
    }

    /// Stores the id of a mission that is over.
    pub fn outlives(past: &mut Vec<String>, mission: String) {
        /// Number of ids that are kept.
        const MOST: usize = 32;
        past.push(mission);
        let first = past.len().saturating_sub(MOST);
        past.drain(..first);
    }

    /// The motion of its disc or outline on its path.
    ///
    /// # Errors
    /// [`InvalidInput`] for a radius, and for an outline that would turn in no time; both were checked when the robot got its path.
    pub fn motion(&self) -> Result<Motion<'_, f64>, InvalidInput> {
        self.course.motion(&self.body)
    }

    /// Distance from the reference point within which a turn moves its points \[m\]; 0 for a disc.
    pub(crate) fn spread(&self) -> f64 {
        if self.body.is_disc() { 0.0 } else { self.body.reach() }
    }

    /// How much further than what it was told it may be by its margin \[m\]: where its path bends, its corners go further than it does.
    pub(crate) fn allowance(&self) -> f64 {
        (self.abilities.margin + ROOM) / self.course.stretch(self.spread())
    }

    /// Its position, and where it can come to rest: it may go up to `told` without asking again.
    pub fn progress(&self) -> Progress<f64> {
        Progress { at: Interval::new(self.arc_length, self.notified_limit), stop: self.notified_limit }
    }

    /// Where it can be at a time \[m\]: the upper end grows with its speed, up to `told`.
    pub fn possible_positions(&self, now: f64) -> Interval<f64> {
        let grown =
            self.heard.map_or(f64::INFINITY, |heard| self.up_to + self.abilities.speed * (now - heard).max(0.0));
        Interval::new(self.arc_length, grown.min(self.notified_limit).max(self.arc_length))
    }

    /// Hold that it needs so that it does not have to brake within the lookahead \[m\]. It is further on than the width, so that a robot that
    /// has come to its hold but for that is told the next one.
    pub fn wanted(&self, lookahead: f64, width: f64) -> f64 {
        let way = self.abilities.braking() + self.abilities.speed * lookahead;
        (self.up_to + way.max(2.0 * width)).max(self.next).min(self.course.length())
    }

    /// Whether it has reached the end of its path, within a width \[m\].
    pub fn has_arrived(&self, width: f64) -> bool {
        self.arc_length >= self.course.length() - width
    }
}
