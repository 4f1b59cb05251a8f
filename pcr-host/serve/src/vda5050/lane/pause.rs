//! Pauses: ours, where a vehicle must not go on, and those of others, which are theirs to end.

use super::super::door::Refusal;
use super::super::messages::{Action, InstantActions};
use super::super::state::ActionState;
use super::super::topics::Kind;
use super::notes::noted;
use super::release::AGAIN;
use super::{Lane, To};
use crate::robot::Robot;
use crate::supervisor::{Damaged, Supervisor};
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// The note of what is kept of pauses.
const NOTE: &str = "pauses";

/// How our own actions are called.
const OURS: [&str; 2] = ["pcr-startPause-", "pcr-stopPause-"];

/// What we have asked the vehicle for, until it does so.
#[derive(Debug)]
struct Asked {
    /// To pause, or to go on.
    stops: bool,
    /// When \[s\].
    at: f64,
    /// By which action.
    id: String,
}

/// Who has paused a vehicle.
#[derive(Debug, Default)]
pub(super) struct Pauses {
    asked: Option<Asked>,
    /// Whether the manager has asked it to pause last, or to go on, and when \[s\]: its states do not tell of that at once.
    wish: Option<(bool, f64)>,
    kept: Kept,
}

/// What is kept in the journal.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Kept {
    /// Others have paused it, too: who ends ours must not end theirs.
    others: bool,
    /// Actions of the manager that let it go, for when it may.
    held: Vec<Action>,
}

impl Pauses {
    /// What the journal has.
    ///
    /// # Errors
    /// [`Damaged`] where that cannot be read.
    pub(super) fn remembered(robot: Option<&Robot>) -> Result<Self, Damaged> {
        Ok(Self { kept: noted(robot, NOTE)?.unwrap_or_default(), ..Self::default() })
    }
}

impl Lane {
    /// Stops the vehicle where it must not go on, and lets it go again: said again until it says so, as either may be lost.
    pub fn pause(&mut self, supervisor: &mut Supervisor, now: f64) {
        let Ok(robot) = supervisor.robot(&self.name) else { return };
        let stops = robot.stopped.is_some();
        let said = self.says_paused();
        let before = self.pauses.kept.clone();
        self.pauses.kept.others = self.is_paused_by_others(now);
        if let Some(version) = self.version.filter(|_| !stops && !self.pauses.kept.held.is_empty()) {
            let held = std::mem::take(&mut self.pauses.kept.held);
            (self.pauses.kept.others, self.pauses.wish) = (false, Some((false, now)));
            let header = self.header(Kind::InstantActions, version);
            self.post(To::Vehicle, Kind::InstantActions, version, &InstantActions::new(header, held));
        }
        if self.pauses.kept != before {
            self.note_pauses(supervisor);
        }
        let others = self.pauses.kept.others;
        match &self.pauses.asked {
            // Who has paused it otherwise lets it go.
            None if !(stops || said && !others && self.has_paused()) => {}
            Some(asked) if asked.stops && !stops && others => self.pauses.asked = None,
            // Paused though it was let go: by somebody else since then.
            Some(asked) if !asked.stops && !stops && (!said || self.has_done(&asked.id)) => self.pauses.asked = None,
            Some(asked) if asked.stops == stops && (said == stops || now - asked.at < AGAIN) => {}
            _ => {
                let id = self.ask_for(if stops { "startPause" } else { "stopPause" });
                self.pauses.asked = Some(Asked { stops, at: now, id });
            }
        }
    }

    /// Takes from what the manager wants at once what would let a vehicle go that has to stand: that is passed on when it may go.
    pub(super) fn hold_back(
        &mut self,
        supervisor: &mut Supervisor,
        actions: Vec<Action>,
        now: f64,
    ) -> (Vec<Action>, Option<Refusal>) {
        let by = supervisor.robot(&self.name).ok().and_then(|robot| robot.stopped.clone());
        let (mut due, mut refusal) = (Vec::new(), None);
        let before = self.pauses.kept.clone();
        for (k, action) in actions.into_iter().enumerate() {
            let held = &mut self.pauses.kept.held;
            match (action.action_type.as_str(), &by) {
                ("stopPause", Some(by)) => {
                    let why = format!("it stands for {by}; {:?} is passed on when it may go", action.action_id);
                    refusal.get_or_insert(Refusal::new(format!("actions[{k}]"), why));
                    if held.iter().all(|other| other.action_id != action.action_id) {
                        held.push(action);
                    }
                    self.pauses.kept.others = false;
                    continue;
                }
                ("stopPause", None) => self.pauses.wish = Some((false, now)),
                ("startPause", _) => {
                    if let Some(overtaken) = held.first() {
                        let why = format!("{:?} is not passed on: it is to pause since", overtaken.action_id);
                        refusal.get_or_insert(Refusal::new(format!("actions[{k}]"), why));
                    }
                    held.clear();
                    (self.pauses.kept.others, self.pauses.wish) = (true, Some((true, now)));
                    // What lets it go is not said again.
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

    /// Remembers who has paused it.
    pub(super) fn note_pauses(&self, supervisor: &mut Supervisor) {
        self.note(supervisor, NOTE, serde_json::to_value(&self.pauses.kept).unwrap_or_default());
    }

    fn says_paused(&self) -> bool {
        self.state.as_ref().and_then(|state| state.rest.get("paused")?.as_bool()).unwrap_or(false)
    }

    /// Whether somebody else has paused it, by what the manager has just said or else by what the vehicle says.
    fn is_paused_by_others(&self, now: f64) -> bool {
        let Pauses { asked, wish, kept } = &self.pauses;
        match wish {
            Some((wish, at)) if now - at < AGAIN => *wish,
            // Since the start it has not said anything.
            _ if self.state.is_none() => kept.others,
            _ if !self.says_paused() => false,
            _ => kept.others || asked.is_none() && kept.held.is_empty() && !self.has_paused(),
        }
    }

    /// Whether it was we who have paused it last: a message of ours that came late, or one from before a restart.
    fn has_paused(&self) -> bool {
        let Some(state) = &self.state else { return false };
        let mut all = state.action_states.iter().chain(state.instant_action_states.iter().flatten());
        let is_pause = |action: &&ActionState| {
            // Vehicles need not say what kind an action is of.
            let kind = action.rest.get("actionType").and_then(Value::as_str);
            matches!(kind, Some("startPause" | "stopPause")) || OURS.iter().any(|own| action.action_id.starts_with(own))
        };
        all.rfind(is_pause).is_some_and(|action| action.action_id.starts_with(OURS[0]))
    }

    fn has_done(&self, id: &str) -> bool {
        self.state.as_ref().is_some_and(|state| state.action(id) == Some("FINISHED"))
    }
}
