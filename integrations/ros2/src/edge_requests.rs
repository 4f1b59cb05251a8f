//! Requests to a route server: what it has to be told so that the right edges are closed, and when again.

use crate::messages::{DynamicEdgesRequest, DynamicEdgesResponse};
use std::collections::BTreeSet;
use std::time::Duration;

/// How long an answer is waited for, and how long after a refusal it is asked again.
const PATIENCE: Duration = Duration::from_secs(2);
/// After that closed edges are told again: a server that was started anew has forgotten them.
const REFRESH: Duration = Duration::from_secs(10);

/// What a route server was told. Times are since the node began.
#[derive(Clone, Debug, Default)]
pub struct EdgeRequests {
    /// The edges that may be closed there because of what was told.
    may_be_closed: BTreeSet<u16>,
    /// The last request, while there is no answer that says it was done.
    open: Option<(Duration, BTreeSet<u16>)>,
    /// When the last request was done.
    done: Duration,
}

impl EdgeRequests {
    /// The request that is due, so that these edges are closed, and no other one that was closed here. `None` where the server has been told, or has
    /// time left to answer.
    pub fn due(&mut self, closed: &BTreeSet<u16>, now: Duration) -> Option<DynamicEdgesRequest> {
        let is_due = match &self.open {
            Some((sent, asked)) => asked != closed || now.saturating_sub(*sent) >= PATIENCE,
            None if self.may_be_closed == *closed => !closed.is_empty() && now.saturating_sub(self.done) >= REFRESH,
            None => true,
        };
        if !is_due {
            return None;
        }
        let opened = self.may_be_closed.difference(closed).copied().collect();
        self.may_be_closed.extend(closed);
        self.open = Some((now, closed.clone()));
        Some(DynamicEdgesRequest {
            closed_edges: closed.iter().copied().collect(),
            opened_edges: opened,
            adjust_edges: Vec::new(),
        })
    }

    /// Whether the last request has no answer although there was time.
    pub fn is_late(&self, now: Duration) -> bool {
        self.open.as_ref().is_some_and(|(sent, _)| now.saturating_sub(*sent) >= PATIENCE)
    }

    /// Takes the answer to the last request. One that says it was not done leaves the request open: it is due again.
    pub fn answered(&mut self, answer: DynamicEdgesResponse, now: Duration) {
        if answer.success
            && let Some((_, closed)) = self.open.take()
        {
            (self.may_be_closed, self.done) = (closed, now);
        }
    }
}
