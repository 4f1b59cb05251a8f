//! Restores a supervisor from its journal.

use super::closures::ClosedPath;
use super::{FleetPrecedences, Supervisor, SupervisorConfig, fleet, retry_with_growth};
use crate::journal_entry::{JournalEntry, JournalStore, StoredPrecedence, StoredRobot};
use crate::page_layout::PageLayout;
use crate::request_error::RequestError;
use crate::robot::{Alarm, SupervisedRobot, remember};
use pcr_core::{CheckState, MismatchError, PassingState};
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::fmt;

/// The reason why a journal cannot be continued.
#[derive(Clone, Debug, PartialEq)]
pub struct JournalError(pub(crate) String);

impl fmt::Display for JournalError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for JournalError {}

impl From<MismatchError> for JournalError {
    fn from(mismatch: MismatchError) -> Self {
        Self(mismatch.to_string())
    }
}

/// The state after a number of entries.
#[derive(Debug, Default)]
pub struct JournalState {
    layout: PageLayout,
    robots: Vec<StoredRobot>,
    spent: u64,
    away: BTreeSet<String>,
    closures: BTreeMap<String, ClosedPath>,
    paused: bool,
}

impl JournalState {
    /// Number of robots.
    pub fn robots(&self) -> usize {
        self.robots.len()
    }

    fn robot(&mut self, name: &str) -> Result<&mut StoredRobot, JournalError> {
        let found = self.robots.iter_mut().find(|robot| robot.name == name);
        found.ok_or_else(|| JournalError(format!("an entry is about the robot {name}, which is not there")))
    }

    /// Takes the next entry.
    ///
    /// # Errors
    /// [`JournalError`] if it contradicts those before it.
    pub fn take(&mut self, entry: JournalEntry) -> Result<(), JournalError> {
        match entry {
            JournalEntry::Layout(layout) => self.layout = layout,
            JournalEntry::Robot(known) => {
                // These are its orders with all others, so earlier orders of others with it are removed.
                for other in &mut self.robots {
                    other.orders.retain(|kept| kept.with != known.name);
                }
                match self.robots.iter_mut().find(|robot| robot.name == known.name) {
                    Some(robot) => *robot = *known,
                    None => self.robots.push(*known),
                }
            }
            JournalEntry::Removed { robot } => {
                self.spent = self.spent.max(self.robot(&robot)?.path);
                self.robots.retain(|other| other.name != robot);
                for other in &mut self.robots {
                    other.orders.retain(|kept| kept.with != robot);
                }
            }
            JournalEntry::Spent { path } => self.spent = self.spent.max(path),
            JournalEntry::Ceiling { robot, path, persisted_limit: ceiling } => {
                let known = self.robot(&robot)?;
                if known.path == path {
                    known.ceiling = ceiling;
                }
            }
            JournalEntry::Places { places } => {
                for (robot, path, at) in places {
                    // The robot may have been removed in the same batch.
                    if let Ok(known) = self.robot(&robot)
                        && known.path == path
                    {
                        known.arc_length = known.arc_length.max(at);
                    }
                }
            }
            JournalEntry::Waiting { robot, waiting } => {
                let known = self.robot(&robot)?;
                if let Some(before) = std::mem::replace(&mut known.waiting, waiting) {
                    SupervisedRobot::outlives(&mut known.past, before.mission);
                }
            }
            JournalEntry::Note { robot, key, note } => {
                self.robot(&robot)?.notes.insert(key, note);
            }
            JournalEntry::More { robot, key, more } => {
                if !remember(&mut self.robot(&robot)?.notes, &key, &more) {
                    return Err(JournalError(format!("{robot}, {key}: more of what is no list")));
                }
            }
            JournalEntry::Away { robot, away: true } => _ = self.away.insert(robot),
            JournalEntry::Away { robot, away: false } => _ = self.away.remove(&robot),
            JournalEntry::Closed(area) => {
                let closed = ClosedPath::new(area).map_err(|fault| JournalError(fault.to_string()))?;
                self.closures.insert(closed.area.name.clone(), closed);
            }
            JournalEntry::Opened { closure } => _ = self.closures.remove(&closure),
            JournalEntry::Paused { paused } => self.paused = paused,
            JournalEntry::Alarm { robot, alarm } => self.robot(&robot)?.alarm = alarm,
        }
        Ok(())
    }
}

impl Supervisor {
    /// The supervisor with the state of these entries. Holds that may have been told count as told.
    ///
    /// # Errors
    /// [`JournalError`] if the entries contradict one another, or if the regions of the paths differ from those for which the orders
    /// were made.
    pub fn restored(
        settings: SupervisorConfig,
        entries: Vec<JournalEntry>,
        keeper: Box<dyn JournalStore>,
    ) -> Result<Self, JournalError> {
        let mut state = JournalState::default();
        entries.into_iter().try_for_each(|entry| state.take(entry))?;
        let mut own = Self::new(settings, keeper);
        (own.layout, own.spent, own.away) = (state.layout, state.spent, state.away);
        (own.closures, own.paused) = (state.closures, state.paused);
        if own.spent >= MOST {
            return Err(JournalError("a number of a path that cannot be".into()));
        }
        let mut kept: HashMap<[String; 2], Vec<StoredPrecedence>> = HashMap::new();
        for known in state.robots {
            for order in &known.orders {
                kept.entry([known.name.clone(), order.with.clone()]).or_default().push(order.clone());
            }
            own.names.insert(known.name.clone(), own.robots.len());
            let turn = known.waiting.as_ref().map_or(0, |waiting| waiting.turn);
            let away = own.away.contains(&known.name);
            own.robots.push(SupervisedRobot { away, ..robot(known)? });
            own.turn = own.turn.max(turn + 1);
        }
        let count = own.robots.len();
        (own.unsaved, own.reaches, own.hazards) = (vec![false; count], vec![CheckState::EMPTY; count], true);
        own.order(kept)?;
        own.areas_changed();
        own.note_pause();
        Ok(own)
    }

    /// Restores the passing orders.
    fn order(&mut self, mut kept: HashMap<[String; 2], Vec<StoredPrecedence>>) -> Result<(), JournalError> {
        let fleet = fleet(&self.robots).map_err(|fault| JournalError(fault.to_string()))?;
        let mut orders = FleetPrecedences::new(Vec::new(), Vec::new(), Vec::new());
        retry_with_growth(&mut orders, |orders| Ok(orders.fill(&fleet)?))
            .map_err(|refused| JournalError(refused.to_string()))?;
        let mut missing = HashSet::new();
        for ego in 0..fleet.len() {
            let name = &self.robots[ego].name;
            let row: Vec<_> = orders
                .row(&fleet, ego)?
                .map(|(place, region, _)| (place, region.other(), [region.length(), region.other_length()]))
                .collect();
            for group in row.chunk_by(|a, b| a.1 == b.1) {
                let other = &self.robots[group[0].1].name;
                let Some(made) = kept.remove(&[name.clone(), other.clone()]) else {
                    // The row of the other robot has them.
                    missing.insert([ego, group[0].1]);
                    continue;
                };
                let same = |(found, kept): (&(usize, usize, [pcr_core::Interval<f64>; 2]), &StoredPrecedence)| {
                    let ends = found.2.iter().flat_map(|length| [length.lo, length.hi]);
                    ends.zip(kept.lengths.as_flattened()).all(|(a, b)| (a - b).abs() <= 1e-6)
                };
                if made.len() != group.len() || !group.iter().zip(&made).all(same) {
                    return Err(JournalError(format!(
                        "the regions of {name} and {other} are not those of the journal"
                    )));
                }
                for (&(place, ..), order) in group.iter().zip(&made) {
                    orders.decide_at(&fleet, place, ego, PassingState::from(order.pass), order.active_from)?;
                }
            }
        }
        if let Some([robot, other]) = missing.iter().find(|[ego, other]| missing.contains(&[*other, *ego])) {
            let [robot, other] = [robot, other].map(|place| &self.robots[*place].name);
            return Err(JournalError(format!("the journal has no orders of {robot} and {other}, which meet")));
        }
        if let Some([robot, other]) = kept.into_keys().next() {
            return Err(JournalError(format!("the journal has orders of {robot} and {other}, which do not meet")));
        }
        drop(fleet);
        self.orders = orders;
        Ok(())
    }

    /// Entries for the whole present state.
    ///
    /// # Errors
    /// [`RequestError::Invalid`] if the table of orders is not that of the robots.
    pub fn snapshot(&self) -> Result<Vec<JournalEntry>, RequestError> {
        let layout = std::iter::once(Ok(JournalEntry::Layout(self.layout.clone())));
        let robots = (0..self.robots.len()).map(|place| {
            let mut known = self.known(place)?;
            // Each order once: with robots of lower index.
            let before = |kept: &StoredPrecedence| self.names.get(&kept.with).is_some_and(|&other| other < place);
            known.orders.retain(before);
            Ok(JournalEntry::Robot(Box::new(known)))
        });
        let spent = (self.spent > 0).then_some(Ok(JournalEntry::Spent { path: self.spent }));
        let away = self.away.iter().map(|name| Ok(JournalEntry::Away { robot: name.clone(), away: true }));
        let closed = self.closures().map(|area| Ok(JournalEntry::Closed(area.clone())));
        let paused = self.paused.then_some(Ok(JournalEntry::Paused { paused: true }));
        layout.chain(spent).chain(robots).chain(away).chain(closed).chain(paused).collect()
    }
}

/// Numbers of paths and of missions in the queue are below this, so that they can go on counting.
const MOST: u64 = 1 << 53;

fn robot(known: StoredRobot) -> Result<SupervisedRobot, JournalError> {
    let abilities = known.abilities.checked().map_err(|why| JournalError(format!("{}: {why}", known.name)))?;
    let (name, refused) = (known.name.clone(), known.name);
    let robot = SupervisedRobot::new(name, abilities, known.any_heading, known.course);
    let mut robot = robot.map_err(|why| JournalError(format!("{refused}: {why}")))?;
    let end = robot.course.length();
    let counts = known.path < MOST && known.waiting.as_ref().is_none_or(|waiting| waiting.turn < MOST);
    if !counts
        || !known.rest.is_valid()
        || ![known.arc_length, known.ceiling, known.origin].iter().all(|value| *value >= 0.0)
    {
        return Err(JournalError(format!("{}: a number that cannot be", robot.name)));
    }
    (robot.path, robot.origin, robot.rest) = (known.path, known.origin, known.rest);
    (robot.mission, robot.asked, robot.past) = (known.mission, known.asked, known.past);
    robot.arc_length = known.arc_length.min(end);
    robot.up_to = robot.arc_length;
    robot.ceiling = known.ceiling.max(robot.arc_length).min(end);
    (robot.granted, robot.notified_limit) = (robot.arc_length, robot.ceiling);
    // It has been told nothing further since then.
    if let Some(Alarm::Beyond { notified_limit: told, .. }) = known.alarm {
        robot.notified_limit = robot.notified_limit.min(told.max(robot.arc_length));
    }
    robot.alarm = known.alarm;
    robot.waiting = known.waiting;
    robot.notes = known.notes;
    Ok(robot)
}
