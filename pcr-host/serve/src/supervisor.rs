//! The supervisor decides how far each robot may go.
//!
//! Requests change its state. [`Supervisor::settle`] then lets robots go on, writes data that must not be lost to the
//! journal, and only then returns the messages to be sent. Times are seconds of any monotonic clock.

mod absence;
mod admission;
mod alarms;
mod areas;
mod authority;
mod closures;
mod deadlock_report;
mod fleet_pause;
#[cfg(test)]
mod outline_tests;
mod positions;
mod restore;
mod robot_notes;
mod waiting_missions;
mod zones;

pub use absence::{StandingPlace, UnplacedVehicle};
pub use admission::{AdmissionResult, MissionRequest};
pub use closures::ClosureImpact;
pub use fleet_pause::{PAUSE, PauseAbility, PauseImpact};
pub use positions::PositionReport;
pub use restore::{JournalError, JournalState};
pub use zones::ZoneArea;

use crate::event::{CancelCause, SupervisorEvent};
use crate::journal_entry::{JournalEntry, JournalStore};
use crate::owned_path::{OwnedPath, StartPose};
use crate::page_layout::PageLayout;
use crate::request_error::RequestError;
use crate::robot::{RobotTraits, SupervisedRobot};
use pcr_core::{
    AdmissionError, CheckState, CheckTolerances, EcmEntry, InvalidInput, Motion, Piece, PrecedenceTable, Progress,
    RegionPrecedence,
};
use pcr_formats::scenario::label;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Orders on the heap.
pub(crate) type FleetPrecedences = PrecedenceTable<f64, Vec<EcmEntry>, Vec<Piece<f64>>, Vec<RegionPrecedence<f64>>>;

/// Settings of a supervisor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupervisorConfig {
    /// Distance by which the reported lower end of a position may be behind the stop at which the robot stands \[m\]. Missions are
    /// admitted if all robots can finish in spite of it.
    pub position_uncertainty: f64,
    /// How long before braking a robot is told its next hold \[s\]. A hold that was told cannot be withdrawn, so a longer time leaves
    /// fewer decisions open.
    pub lookahead: f64,
    /// The journal gets a hold that is further than the one told by up to this \[m\], so that not every hold needs a write. After a restart
    /// the hold of the journal counts as told.
    pub persisted_reserve: f64,
    /// A robot counts as silent if no message of it came for this long \[s\].
    pub report_timeout: f64,
    /// A hold that advances by less than this \[m\] is not sent, except if it is where the robot has to wait.
    pub step: f64,
    /// If a robot with a task has not advanced for this long, the reason is reported \[s\].
    pub deadlock_timeout: f64,
}

impl Default for SupervisorConfig {
    fn default() -> Self {
        Self {
            position_uncertainty: 0.1,
            lookahead: 2.0,
            persisted_reserve: 2.0,
            report_timeout: 5.0,
            step: 0.05,
            deadlock_timeout: 60.0,
        }
    }
}

/// Numbers of events since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SupervisorCounters {
    /// Number of position messages.
    pub positions: u64,
    /// Number of position messages about a path that the robot no longer has.
    pub(crate) outdated: u64,
    /// Number of missions requested.
    pub missions: u64,
    /// Number of missions admitted.
    pub admitted: u64,
    /// Number of attempts to admit a mission that were refused.
    pub refused: u64,
    /// Number of missions given up.
    pub dropped: u64,
    /// Number of holds told.
    pub holds: u64,
    /// Number of holds computed.
    pub evaluations: u64,
    /// Number of alarms.
    pub alarms: u64,
    /// Number of writes of the journal.
    pub writes: u64,
}

/// The supervisor of a fleet.
pub struct Supervisor {
    settings: SupervisorConfig,
    layout: PageLayout,
    robots: Vec<SupervisedRobot>,
    names: HashMap<String, usize>,
    orders: FleetPrecedences,
    reaches: Vec<CheckState<f64>>,
    keeper: Box<dyn JournalStore>,
    /// Changes that are not in the journal yet.
    entries: Vec<JournalEntry>,
    /// Events to be sent once these changes are in the journal.
    events: Vec<SupervisorEvent>,
    /// Number of those that tell robots to stop and were taken by [`Supervisor::stops`].
    stops_taken: usize,
    /// For each robot whether its position has changed since it was last written to the journal.
    unsaved: Vec<bool>,
    /// Number of the next mission that has to wait.
    turn: u64,
    /// For each robot with a waiting mission: when it is tried again \[s\], the number of attempts, and what kept it.
    tries: HashMap<String, waiting_missions::AdmissionRetry>,
    /// Number of times a robot was added or removed.
    census: u64,
    /// Names of the robots and vehicles that are away.
    away: BTreeSet<String>,
    /// Vehicles that have not said where they stand.
    unplaced: BTreeMap<String, UnplacedVehicle>,
    /// Areas that are closed, by name.
    closures: BTreeMap<String, closures::ClosedPath>,
    /// Areas of single robots, by the name of the robot.
    zones: BTreeMap<String, Vec<areas::Area>>,
    /// Whether any area is closed, and whether the speed is limited in any.
    is_any_shut: bool,
    is_any_slow: bool,
    /// A number that changes whenever an area begins or ends.
    closure_revision: u64,
    /// Whether the whole fleet is paused.
    paused: bool,
    /// Which vehicles do not say that they can be paused.
    pause_abilities: BTreeMap<String, PauseAbility>,
    /// Names of vehicles that may be away without being here.
    expected: BTreeSet<String>,
    /// Highest path number of any removed robot. New robots get higher numbers, so late messages of a removed robot with the same name are
    /// recognised.
    spent: u64,
    /// The first time that the supervisor was given \[s\].
    begun: Option<f64>,
    /// Time of the last search for robots that do not advance \[s\].
    looked: f64,
    /// Whether a robot may be in the way of another one that was allowed to go there.
    hazards: bool,
    counts: SupervisorCounters,
    broken: Option<String>,
}

impl std::fmt::Debug for Supervisor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Supervisor").field("robots", &self.robots).finish_non_exhaustive()
    }
}

impl Supervisor {
    /// A supervisor without robots.
    pub fn new(settings: SupervisorConfig, keeper: Box<dyn JournalStore>) -> Self {
        Self {
            settings,
            layout: PageLayout::default(),
            robots: Vec::new(),
            names: HashMap::new(),
            orders: FleetPrecedences::new(Vec::new(), Vec::new(), Vec::new()),
            reaches: Vec::new(),
            keeper,
            entries: Vec::new(),
            events: Vec::new(),
            stops_taken: 0,
            unsaved: Vec::new(),
            turn: 0,
            tries: HashMap::new(),
            census: 0,
            away: BTreeSet::new(),
            unplaced: BTreeMap::new(),
            closures: BTreeMap::new(),
            zones: BTreeMap::new(),
            is_any_shut: false,
            is_any_slow: false,
            closure_revision: 0,
            paused: false,
            pause_abilities: BTreeMap::new(),
            expected: BTreeSet::new(),
            spent: 0,
            begun: None,
            looked: f64::NEG_INFINITY,
            hazards: false,
            counts: SupervisorCounters::default(),
            broken: None,
        }
    }

    /// The settings.
    pub fn settings(&self) -> &SupervisorConfig {
        &self.settings
    }

    /// The lanes that the page draws.
    pub fn layout(&self) -> &PageLayout {
        &self.layout
    }

    /// All robots, in the order of their indices in the table of orders.
    pub fn robots(&self) -> &[SupervisedRobot] {
        &self.robots
    }

    /// One robot.
    ///
    /// # Errors
    /// [`RequestError::NoSuchRobot`].
    pub fn robot(&self, name: &str) -> Result<&SupervisedRobot, RequestError> {
        self.robot_index(name).map(|place| &self.robots[place])
    }

    /// A number that changes whenever a robot is added or removed.
    pub(crate) fn census(&self) -> u64 {
        self.census
    }

    /// The robot for which a robot has to wait at its hold; `None` if the hold is the end of its path.
    pub fn waits_for(&self, robot: &SupervisedRobot) -> Option<&str> {
        let wait = robot.authority?;
        let end = robot.course.length();
        let bound = wait.hold.length(end).unwrap_or(robot.granted);
        let (by, _) = wait.waits_for.filter(|_| bound < end && robot.granted >= bound)?;
        self.robots.get(by).map(|by| by.name.as_str())
    }

    /// The passing orders of [`Supervisor::fleet`].
    pub fn orders(&self) -> &FleetPrecedences {
        &self.orders
    }

    /// The motions of the robots, as the table of orders has them.
    ///
    /// # Errors
    /// [`RequestError::Invalid`] if a robot has none.
    pub fn fleet(&self) -> Result<Vec<Motion<'_, f64>>, RequestError> {
        fleet(&self.robots)
    }

    /// Numbers of events since the start.
    pub fn counts(&self) -> SupervisorCounters {
        self.counts
    }

    /// Takes a new layout for the page.
    ///
    /// # Errors
    /// [`RequestError::Broken`].
    pub fn draw(&mut self, layout: PageLayout) -> Result<(), RequestError> {
        self.works()?;
        self.entries.push(JournalEntry::Layout(layout.clone()));
        self.layout = layout;
        Ok(())
    }

    /// Adds a robot that stands; one that was away is not any more. Robots that have not yet been allowed to pass there wait for it until it has a mission.
    ///
    /// # Errors
    /// [`RequestError::RobotExists`], [`RequestError::Invalid`]. Adding the same robot twice is no error before it has a mission.
    pub fn add(&mut self, name: &str, abilities: RobotTraits, start: StartPose) -> Result<(), RequestError> {
        self.works()?;
        if let Ok(robot) = self.robot(name) {
            let same = robot.abilities == abilities && robot.mission.is_none() && robot.course.start() == start;
            return if same { Ok(()) } else { Err(RequestError::RobotExists) };
        }
        if name.is_empty() || label(name) != name {
            return Err(RequestError::invalid("the name of a robot is 1 to 200 printable characters"));
        }
        if self.closures.contains_key(name) || name == PAUSE {
            return Err(RequestError::invalid("a closed area, or the pause of the fleet, has this name"));
        }
        let abilities = abilities.checked().map_err(RequestError::invalid)?;
        let returned = self.is_away(name);
        self.insert(SupervisedRobot { returned, ..standing(name, abilities, start)? })?;
        if returned {
            // It was away, and is here: it is not any more.
            self.away.remove(name);
            self.entries.push(JournalEntry::Away { robot: name.into(), away: false });
            self.events.push(SupervisorEvent::Back { robot: name.into() });
        }
        Ok(())
    }

    /// Moves a robot to a place off its path, without a mission, after it was seen there: all its rights are void. The ids of
    /// its missions stay known.
    ///
    /// # Errors
    /// [`RequestError::NoSuchRobot`], [`RequestError::Invalid`]; nothing has changed then. [`RequestError::Broken`].
    pub fn reseat(&mut self, name: &str, start: StartPose) -> Result<(), RequestError> {
        self.works()?;
        let place = self.robot_index(name)?;
        let robot = &self.robots[place];
        let mut new = standing(name, robot.abilities.clone(), start)?;
        new.path = robot.path + 1;
        new.past.clone_from(&robot.past);
        new.away = robot.away;
        let waiting = robot.waiting.as_ref().map(|waiting| &waiting.mission);
        for mission in robot.mission.iter().chain(waiting) {
            SupervisedRobot::outlives(&mut new.past, mission.clone());
        }
        let motion = new.motion().map_err(RequestError::invalid)?;
        let mut fleet = fleet(&self.robots)?;
        let replaced = retry_with_growth(&mut self.orders, |orders| Ok(orders.replace(&mut fleet, place, motion)?));
        drop(fleet);
        replaced.map_err(RequestError::invalid)?;
        let before = std::mem::replace(&mut self.robots[place], new);
        if let Some(waiting) = before.waiting {
            self.drops(name, waiting.mission, CancelCause::Moved);
        }
        if before.alarm.is_some() {
            self.events.push(SupervisorEvent::Clear { robot: name.into() });
        }
        if before.stopped.is_some() {
            self.events.push(SupervisorEvent::Go { robot: name.into() });
        }
        self.unsaved[place] = false;
        self.tries.remove(name);
        self.forget_holds();
        self.hazards = true;
        self.keep_robot(place)
    }

    fn insert(&mut self, robot: SupervisedRobot) -> Result<(), RequestError> {
        let name = robot.name.clone();
        self.robots.push(SupervisedRobot { path: self.spent + 1, ..robot });
        let place = self.robots.len() - 1;
        if let Err(fault) = self.inserted(place) {
            self.robots.pop();
            return Err(fault);
        }
        self.census += 1;
        self.names.insert(name, place);
        self.unsaved.push(false);
        self.reaches.push(CheckState::EMPTY);
        self.forget_holds();
        self.hazards = true;
        self.keep_robot(place)
    }

    fn inserted(&mut self, place: usize) -> Result<(), RequestError> {
        let fleet = fleet(&self.robots)?;
        retry_with_growth(&mut self.orders, |orders| Ok(orders.insert(&fleet, place)?)).map_err(RequestError::invalid)
    }

    /// Writes a robot with its orders to the journal. Where that is impossible a restart would forget what was decided.
    fn keep_robot(&mut self, place: usize) -> Result<(), RequestError> {
        let known = self.known(place).map_err(|fault| self.breaks(fault.to_string()))?;
        self.entries.push(JournalEntry::Robot(Box::new(known)));
        Ok(())
    }

    /// Removes a robot, which has to be physically gone. Returns `false` if there is no robot of this name.
    ///
    /// # Errors
    /// [`RequestError::Broken`]; [`RequestError::Invalid`] if the table of orders is not that of the robots.
    pub fn remove(&mut self, name: &str) -> Result<bool, RequestError> {
        self.works()?;
        let Ok(place) = self.robot_index(name) else { return Ok(false) };
        self.orders.erase(&fleet(&self.robots)?, place).map_err(RequestError::invalid)?;
        self.census += 1;
        self.spent = self.spent.max(self.robots.remove(place).path);
        self.unsaved.remove(place);
        self.reaches.pop();
        self.tries.remove(name);
        self.names = self.robots.iter().enumerate().map(|(place, robot)| (robot.name.clone(), place)).collect();
        self.entries.push(JournalEntry::Removed { robot: name.into() });
        // Whether a vehicle is away counts on: it is not here for that.
        if !self.expected.contains(name) && self.away.remove(name) {
            self.entries.push(JournalEntry::Away { robot: name.into(), away: false });
        }
        self.forget_holds();
        self.hazards = true;
        Ok(true)
    }

    fn robot_index(&self, name: &str) -> Result<usize, RequestError> {
        self.names.get(name).copied().ok_or(RequestError::NoSuchRobot)
    }

    /// Why the journal could not be written: nothing is told any more but stops.
    pub(crate) fn broken(&self) -> Option<&str> {
        self.broken.as_deref()
    }

    fn works(&self) -> Result<(), RequestError> {
        self.broken.clone().map_or(Ok(()), |why| Err(RequestError::Broken { why }))
    }

    /// From now on nothing is told but stops.
    fn breaks(&mut self, why: String) -> RequestError {
        self.events.retain(|event| matches!(event, SupervisorEvent::Stop { .. }));
        self.broken = Some(why.clone());
        RequestError::Broken { why }
    }

    fn forget_holds(&mut self) {
        self.robots.iter_mut().for_each(|robot| robot.authority = None);
    }

    fn progress(&self) -> Vec<Progress<f64>> {
        self.robots.iter().map(SupervisedRobot::progress).collect()
    }

    fn tolerances(&self) -> CheckTolerances<f64> {
        /// Smallest advance that counts as progress \[m\].
        const GAIN: f64 = 1e-3;
        CheckTolerances { width: self.settings.position_uncertainty, gain: GAIN }
    }

    /// Decides what follows from requests and positions: raises holds, and tries waiting missions again. The results may not be
    /// sent before [`Supervisor::settle`].
    pub fn decide(&mut self, now: f64) {
        if self.broken.is_some() {
            return;
        }
        self.begun(now);
        self.retry(now);
        self.note_silence(now);
        let limits = self.limits(now);
        self.tell_speed_limits();
        self.release(&limits);
        self.note_standstill(now);
    }

    /// The events since the last call that tell robots to stop. They may be sent at once: a stop is not in the journal, because it is decided
    /// again after a restart. They are also among those that [`Supervisor::keep`] returns, in their places; what was decided before them and
    /// would let these robots go on is taken back.
    pub fn stops(&mut self) -> Vec<SupervisorEvent> {
        let (mut stops, mut events): (Vec<SupervisorEvent>, Vec<SupervisorEvent>) = Default::default();
        for event in std::mem::take(&mut self.events) {
            if let SupervisorEvent::Stop { .. } = event {
                events.retain(|before| !event.overtakes(before));
                stops.push(event.clone());
            }
            events.push(event);
        }
        self.events = events;
        stops.split_off(std::mem::replace(&mut self.stops_taken, stops.len()))
    }

    /// [Decides](Supervisor::decide), and writes the journal. The returned events may be sent, because they are in the journal.
    ///
    /// # Errors
    /// [`RequestError::Broken`]: the journal could not be written. Nothing may be told then, now or later, but stops.
    pub fn settle(&mut self, now: f64) -> Result<Vec<SupervisorEvent>, RequestError> {
        self.decide(now);
        self.keep()
    }

    /// Writes what was decided to the journal. The returned events may be sent, because they are in the journal.
    ///
    /// # Errors
    /// As [`Supervisor::settle`].
    pub fn keep(&mut self) -> Result<Vec<SupervisorEvent>, RequestError> {
        self.save()?;
        self.stops_taken = 0;
        Ok(std::mem::take(&mut self.events))
    }

    /// [Settles](Supervisor::settle) for the last time: the journal then has what robots were told, and not more.
    ///
    /// # Errors
    /// As [`Supervisor::settle`].
    pub fn finish(&mut self, now: f64) -> Result<Vec<SupervisorEvent>, RequestError> {
        let events = self.settle(now)?;
        self.lower_ceilings();
        self.write()?;
        Ok(events)
    }

    /// Writes all changes to the journal, with the ceilings that belong to them.
    fn save(&mut self) -> Result<(), RequestError> {
        if !self.entries.is_empty() {
            self.set_ceilings();
        }
        self.write()
    }

    fn write(&mut self) -> Result<(), RequestError> {
        self.works()?;
        if self.entries.is_empty() {
            return Ok(());
        }
        // Positions are saved with the holds that depend on them. Without the positions, a restored hold would lie too far ahead.
        let unsaved = self.unsaved.iter_mut().zip(&self.robots).filter(|(unsaved, _)| **unsaved);
        let places = unsaved.map(|(unsaved, robot)| {
            *unsaved = false;
            (robot.name.clone(), robot.path, robot.arc_length)
        });
        let places: Vec<_> = places.collect();
        if !places.is_empty() {
            self.entries.push(JournalEntry::Places { places });
        }
        self.counts.writes += 1;
        let kept = match self.keeper.is_long() {
            true => {
                let all = self.snapshot().map_err(|fault| self.breaks(fault.to_string()))?;
                self.keeper.restart(&all)
            }
            false => self.keeper.keep(&self.entries),
        };
        self.entries.clear();
        kept.map_err(|error| self.breaks(error.to_string()))
    }
}

/// A robot that stands, without a mission.
fn standing(name: &str, abilities: RobotTraits, start: StartPose) -> Result<SupervisedRobot, RequestError> {
    let course = OwnedPath::new(start, Vec::new()).map_err(RequestError::invalid)?;
    let robot = SupervisedRobot::new(name.into(), abilities, false, course).map_err(RequestError::invalid)?;
    robot.motion().map_err(RequestError::invalid)?;
    Ok(robot)
}

/// The motions of the robots, each at the index of its robot.
fn fleet(robots: &[SupervisedRobot]) -> Result<Vec<Motion<'_, f64>>, RequestError> {
    let named = |robot: &SupervisedRobot, why: InvalidInput| RequestError::invalid(format!("{}: {why}", robot.name));
    robots.iter().map(|robot| robot.motion().map_err(|why| named(robot, why))).collect()
}

/// Changes a table, which grows as long as it is full.
fn retry_with_growth(
    table: &mut FleetPrecedences,
    mut change: impl FnMut(&mut FleetPrecedences) -> Result<(), AdmissionError>,
) -> Result<(), AdmissionError> {
    loop {
        match change(table) {
            Err(AdmissionError::Full(full)) => table.grow(full)?,
            done => return done,
        }
    }
}
