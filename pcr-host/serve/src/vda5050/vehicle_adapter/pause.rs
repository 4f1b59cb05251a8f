//! Pauses: our own, while a vehicle must not go on, and those of others, which only they may end.

use super::VehicleAdapter;
use super::journal_notes::noted;
use super::recency::LATEST;
use super::release::AGAIN;
use crate::robot::SupervisedRobot;
use crate::supervisor::{JournalError, PAUSE, Supervisor};
use pcr_formats::vda5050::decode::DecodeError;
use pcr_formats::vda5050::decode::{self, MessageLimits};
use pcr_formats::vda5050::messages::{Action, InstantActions};
use pcr_formats::vda5050::state::{ActionState, ErrorEntry};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Key of the note about pauses.
const NOTE: &str = "pauses";

/// Time between two attempts with a vehicle that refuses to pause, or to go on \[s\]: it keeps the state of each.
const REFUSED: f64 = 30.0;

/// Largest number of `stopPause` actions that are held back: a manager may repeat them for hours.
const MOST: usize = 16;

/// Prefixes of the ids of our own actions.
const OURS: [&str; 2] = ["pcr-startPause-", "pcr-stopPause-"];

/// Our last request to the vehicle, until it is done.
#[derive(Debug)]
struct PauseRequest {
    /// Whether it asks the vehicle to pause, or to go on.
    stops: bool,
    /// Time at which it was sent \[s\].
    at: f64,
    /// Action id.
    id: String,
    /// Our request to pause that this one ends, and the time at which this was first asked for \[s\], as long as the vehicle may still
    /// be carrying it out: it then pauses after it was told to go on.
    ends: Option<(String, f64)>,
}

/// The pauses of a vehicle.
#[derive(Debug, Default)]
pub(super) struct VehiclePauses {
    asked: Option<PauseRequest>,
    /// The last request of the manager, to pause or to go on, and its time \[s\]: states show it only later.
    wish: Option<(bool, f64)>,
    /// Whether the vehicle has refused our last request to pause (`true`), or to go on.
    refused: Option<bool>,
    kept: StoredPauses,
    /// Whether an action was taken back since the journal was last told.
    is_unnoted: bool,
}

/// The part that is kept in the journal.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct StoredPauses {
    /// Whether the vehicle is also paused by others; then we must not end their pause.
    #[serde(rename = "others")]
    pauses_of_others: bool,
    /// `stopPause` actions of the manager, held back until the vehicle may go.
    #[serde(rename = "held")]
    withheld_actions: Vec<Action>,
}

impl VehiclePauses {
    /// What the journal has.
    ///
    /// # Errors
    /// [`JournalError`] where that cannot be read.
    pub(super) fn remembered(robot: Option<&SupervisedRobot>) -> Result<Self, JournalError> {
        Ok(Self { kept: noted(robot, NOTE)?.unwrap_or_default(), ..Self::default() })
    }
}

impl VehicleAdapter {
    /// Pauses the vehicle when it must not go on, and lets it go on afterwards. Either is repeated until the vehicle confirms
    /// it.
    pub fn pause(&mut self, supervisor: &mut Supervisor, now: f64) {
        let Ok(robot) = supervisor.robot(&self.name) else { return };
        let stops = robot.stopped.is_some();
        let said = self.says_paused();
        let before = self.pauses.kept.clone();
        self.pauses.kept.pauses_of_others = self.is_paused_by_others(now);
        if let Some(version) = self.version.filter(|_| !stops && !self.pauses.kept.withheld_actions.is_empty()) {
            let held = std::mem::take(&mut self.pauses.kept.withheld_actions);
            (self.pauses.kept.pauses_of_others, self.pauses.wish) = (false, Some((false, now)));
            self.act(version, &held, &Map::new());
        }
        if std::mem::take(&mut self.pauses.is_unnoted) || self.pauses.kept != before {
            self.note_pauses(supervisor);
        }
        let others = self.pauses.kept.pauses_of_others;
        let ends = self.pauses.asked.as_ref().filter(|_| !stops).and_then(|asked| self.still_ends(asked, now));
        self.note_refusal();
        let again = if self.pauses.refused.is_some() { REFUSED } else { AGAIN };
        match &self.pauses.asked {
            // A pause of others is ended by them.
            None if !(stops || said && !others && self.has_paused()) => {}
            Some(asked) if asked.stops && !stops && others => self.pauses.asked = None,
            Some(asked) if !asked.stops && !stops && ends.is_none() && asked.ends.is_some() && said => {
                // It has paused only now: what let it go before had no effect.
                self.ask_pause(stops, None, now);
            }
            // It is paused although it was let go: by others, since then.
            Some(asked) if !asked.stops && !stops && ends.is_none() && (!said || self.has_done(&asked.id)) => {
                self.pauses.asked = None;
            }
            Some(asked) if asked.stops == stops && (said == stops || now - asked.at < again) => {}
            // It does not say whether it is paused.
            Some(asked) if asked.stops && stops && !self.tells_pauses() && self.has_done(&asked.id) => {}
            _ => self.ask_pause(stops, ends, now),
        }
    }

    /// Notes whether the vehicle refuses our last request, until it does what was asked or something else is asked. It is told in the log once.
    fn note_refusal(&mut self) {
        let said = self.says_paused();
        let Some(asked) = self.pauses.asked.as_ref().filter(|asked| asked.stops != said) else {
            self.pauses.refused = None;
            return;
        };
        self.pauses.refused.take_if(|stops| *stops != asked.stops);
        let has_failed = self.state.as_ref().is_some_and(|state| state.action(&asked.id) == Some("FAILED"));
        if has_failed && self.pauses.refused.is_none() {
            self.pauses.refused = Some(asked.stops);
            self.remarks.extend(self.refusal_of_pause().map(str::to_owned));
            self.mirror();
        }
    }

    /// What the vehicle refuses, in words.
    fn refusal_of_pause(&self) -> Option<&'static str> {
        Some(match self.pauses.refused? {
            true => {
                "it has to stop, and refuses to pause: it may go on to the end of what was released; stop it by hand"
            }
            false => "it may go on, and refuses to end its pause: let it go on by hand",
        })
    }

    /// The same as an error in states.
    pub(super) fn pause_error(&self) -> Option<ErrorEntry> {
        Some(ErrorEntry::warning("pauseRefused", self.refusal_of_pause()?.to_owned(), &[("vehicle", &self.name)]))
    }

    fn ask_pause(&mut self, stops: bool, ends: Option<(String, f64)>, now: f64) {
        let id = self.ask_for(if stops { "startPause" } else { "stopPause" });
        self.pauses.asked = Some(PauseRequest { stops, at: now, id, ends });
    }

    /// Our request to pause that the vehicle may still be carrying out, as it is let go. Vehicles that do not report their actions
    /// have done so after [`LATEST`].
    fn still_ends(&self, asked: &PauseRequest, now: f64) -> Option<(String, f64)> {
        let ends = if asked.stops { Some((asked.id.clone(), now)) } else { asked.ends.clone() };
        let is_over =
            |id: &str| self.state.as_ref().is_some_and(|state| matches!(state.action(id), Some("FINISHED" | "FAILED")));
        ends.filter(|(id, since)| !is_over(id) && now - since < LATEST)
    }

    /// Removes from instant actions of the manager those that would let a vehicle go on that has to stand. They are passed on
    /// when it may go.
    pub(super) fn hold_back(
        &mut self,
        supervisor: &mut Supervisor,
        actions: Vec<Action>,
        now: f64,
    ) -> (Vec<Action>, Option<DecodeError>) {
        let by = supervisor.robot(&self.name).ok().and_then(|robot| robot.stopped.clone());
        let (mut due, mut refusal) = (Vec::new(), None);
        let before = self.pauses.kept.clone();
        for (k, action) in actions.into_iter().enumerate() {
            let held = &mut self.pauses.kept.withheld_actions;
            match (action.action_type.as_str(), &by) {
                ("stopPause", Some(by)) => {
                    let is_held = held.iter().any(|other| other.action_id == action.action_id);
                    let what = if is_held || held.len() < MOST {
                        "is passed on when it may go".to_owned()
                    } else {
                        format!("is not passed on: {MOST} of them wait already")
                    };
                    let who =
                        if by == PAUSE { "the fleet is paused".to_owned() } else { format!("it stands for {by}") };
                    let why = format!("{who}; {:?} {what}", action.action_id);
                    refusal.get_or_insert(DecodeError::new(format!("actions[{k}]"), why));
                    if !is_held && held.len() < MOST {
                        held.push(action);
                    }
                    self.pauses.kept.pauses_of_others = false;
                    continue;
                }
                ("stopPause", None) => self.pauses.wish = Some((false, now)),
                ("startPause", _) => {
                    if let Some(overtaken) = held.first() {
                        let why = format!("{:?} is not passed on: it is to pause since", overtaken.action_id);
                        refusal.get_or_insert(DecodeError::new(format!("actions[{k}]"), why));
                    }
                    held.clear();
                    (self.pauses.kept.pauses_of_others, self.pauses.wish) = (true, Some((true, now)));
                    // An older request to go on is not repeated.
                    self.pauses.asked.take_if(|asked| !asked.stops);
                }
                _ => {}
            }
            due.push(action);
        }
        if self.pauses.kept != before {
            self.note_pauses(supervisor);
        }
        (due, refusal)
    }

    /// Holds back the `stopPause` actions of the manager in a message that is not sent, because the vehicle was told to stop since.
    pub(crate) fn withhold_stop_pause(&mut self, payload: &[u8]) {
        let Ok(message) = decode::read::<InstantActions>(payload, MessageLimits::default()) else { return };
        // One that the manager has overtaken by a pause is void.
        let is_void = matches!(self.pauses.wish, Some((true, _)));
        let is_ours = |action: &Action| OURS.iter().any(|own| action.action_id.starts_with(own));
        let held = &mut self.pauses.kept.withheld_actions;
        for action in message.list().unwrap_or_default().iter().filter(|action| !is_void && !is_ours(action)) {
            if held.len() < MOST && held.iter().all(|other| other.action_id != action.action_id) {
                held.push(action.clone());
                self.pauses.is_unnoted = true;
            }
        }
    }

    /// Whether it was told to stop, and not yet to go on.
    pub(crate) fn has_to_stop(&self) -> bool {
        self.pauses.asked.as_ref().is_some_and(|asked| asked.stops)
    }

    /// Stores the pauses in the journal.
    pub(super) fn note_pauses(&self, supervisor: &mut Supervisor) {
        self.note(supervisor, NOTE, &self.pauses.kept);
    }

    fn tells_pauses(&self) -> bool {
        self.state.as_ref().is_some_and(|state| state.rest.get("paused").is_some_and(Value::is_boolean))
    }

    fn says_paused(&self) -> bool {
        self.state.as_ref().and_then(|state| state.rest.get("paused")?.as_bool()).unwrap_or(false)
    }

    /// Whether others have paused it, by the last request of the manager or else by its state.
    fn is_paused_by_others(&self, now: f64) -> bool {
        let VehiclePauses { asked, wish, kept, .. } = &self.pauses;
        match wish {
            Some((wish, at)) if now - at < AGAIN => *wish,
            // It has sent no state since the start.
            _ if self.state.is_none() => kept.pauses_of_others,
            _ if !self.says_paused() => false,
            _ => kept.pauses_of_others || asked.is_none() && kept.withheld_actions.is_empty() && !self.has_paused(),
        }
    }

    /// Whether the last pause was ours: a late message of ours, or one from before a restart.
    fn has_paused(&self) -> bool {
        let Some(state) = &self.state else { return false };
        let mut all = state.action_states.iter().chain(state.instant_action_states.iter().flatten());
        let is_pause = |action: &&ActionState| {
            // Vehicles need not report the type of an action.
            let kind = action.rest.get("actionType").and_then(Value::as_str);
            matches!(kind, Some("startPause" | "stopPause")) || OURS.iter().any(|own| action.action_id.starts_with(own))
        };
        all.rfind(is_pause).is_some_and(|action| action.action_id.starts_with(OURS[0]))
    }

    fn has_done(&self, id: &str) -> bool {
        self.state.as_ref().is_some_and(|state| state.action(id) == Some("FINISHED"))
    }
}
