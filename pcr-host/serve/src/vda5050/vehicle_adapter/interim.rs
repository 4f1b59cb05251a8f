//! Decides whether a state was written before a visualization whose position has counted already.
//!
//! A vehicle sends positions on two topics, which may overtake each other. A state that is newer than all other states can be older than
//! the last visualization; its position is then behind, although the vehicle is where it may be. Only time stamps tell, because each
//! topic has numbers of its own.
//!
//! Such a state raises no alarm. A vehicle whose clock is wrong must not get rid of its alarms in this way: a state that contradicts the
//! visualization makes the supervisor send a `stateRequest`, and a state that names it is newer. Without an answer, states count again
//! after [`LATEST`], because no message is later than that.

use super::recency::{AGAIN, LATEST};
use pcr_formats::vda5050::header::MessageHeader;

/// The last visualization whose position has counted.
#[derive(Clone, Debug, Default)]
pub(super) struct Interim {
    last: Option<LastVisualization>,
    /// Time of the first state that contradicts it \[s\]; `None` if the last state did not.
    contradicted: Option<f64>,
    /// Id of the last request since the visualization came, and time of the last request \[s\].
    asked: Option<String>,
    asked_at: Option<f64>,
}

#[derive(Clone, Copy, Debug)]
struct LastVisualization {
    /// Its time stamp \[s\].
    stamp: f64,
    /// Time at which it came \[s\].
    came: f64,
}

impl Interim {
    /// Notes a visualization whose position counts.
    pub(super) fn take(&mut self, header: &MessageHeader, now: f64) {
        // One that comes later is also written later: others do not count. What answers an earlier request may be older than it.
        self.last = stamp(header).map(|stamp| LastVisualization { stamp, came: now });
        self.asked = None;
    }

    /// Returns when the visualization came \[s\], if the newest state was not written after it. `names` tells whether the state mentions
    /// the action with an id.
    pub(super) fn overtook(&self, header: &MessageHeader, now: f64, names: impl Fn(&str) -> bool) -> Option<f64> {
        let last = self.last.filter(|last| now - last.came <= LATEST)?;
        let is_answer = self.asked.as_ref().is_some_and(|id| names(id));
        let is_too_long = self.contradicted.is_some_and(|since| now - since > LATEST);
        let is_before = stamp(header).is_some_and(|stamp| stamp <= last.stamp);
        (is_before && !is_answer && !is_too_long).then_some(last.came)
    }

    /// Notes that a state contradicts the visualization, and returns whether to send a request.
    pub(super) fn contradicts(&mut self, now: f64) -> bool {
        self.contradicted.get_or_insert(now);
        self.asked_at.is_none_or(|at| now - at >= AGAIN)
    }

    /// Notes the id of a request that was sent.
    pub(super) fn asks(&mut self, id: String, now: f64) {
        (self.asked, self.asked_at) = (Some(id), Some(now));
    }

    /// Notes that a state agrees with the visualization.
    pub(super) fn agrees(&mut self) {
        (self.contradicted, self.asked) = (None, None);
    }
}

fn stamp(header: &MessageHeader) -> Option<f64> {
    pcr_formats::import::seconds(&header.timestamp)
}
