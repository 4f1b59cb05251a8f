//! News of a connection that wait to be handled. If they come faster than that, older positions give way to newer ones of the same
//! vehicle: a bridge that was kept up then reads what is so now, and needs no more memory.

use super::mqtt::LinkEvent;
use pcr_formats::vda5050::topics::TopicKind;
use std::collections::{HashSet, VecDeque};
use std::sync::mpsc::RecvTimeoutError;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Number of news from which on older positions give way.
const LONG: usize = 4_096;

/// Largest number of news, and largest size of their messages \[bytes\]. What comes beyond is dropped, as a broker drops what it cannot
/// deliver.
const MOST: (usize, usize) = (1 << 16, 512 << 20);

/// The end into which news are put. When it is dropped, no more will come.
pub(super) struct InboxSender(InboxReceiver);

/// The end from which news are taken.
#[derive(Clone, Debug, Default)]
pub(super) struct InboxReceiver {
    shared: Arc<(Mutex<InboxState>, Condvar)>,
}

#[derive(Debug, Default)]
struct InboxState {
    queue: VecDeque<LinkEvent>,
    bytes: usize,
    /// Length of the queue at which older positions give way next.
    next: usize,
    lost: DroppedCounters,
    is_over: bool,
}

/// Numbers of messages that are not handled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct DroppedCounters {
    /// Positions that newer ones have replaced.
    pub(super) old: u64,
    /// Messages for which there was no room.
    pub(super) dropped: u64,
}

/// A queue of news.
pub(super) fn inbox() -> (InboxSender, InboxReceiver) {
    let inbox = InboxReceiver::default();
    (InboxSender(inbox.clone()), inbox)
}

impl InboxSender {
    pub(super) fn put(&self, news: LinkEvent) {
        self.0.waiting().put(news);
        self.0.shared.1.notify_one();
    }
}

impl Drop for InboxSender {
    fn drop(&mut self) {
        self.0.waiting().is_over = true;
        self.0.shared.1.notify_one();
    }
}

impl InboxReceiver {
    /// The next news; waits for them.
    ///
    /// # Errors
    /// None have come, or none will come.
    pub(super) fn next(&self, patience: Duration) -> Result<LinkEvent, RecvTimeoutError> {
        let is_idle = |waiting: &mut InboxState| waiting.queue.is_empty() && !waiting.is_over;
        let waiting = self.shared.1.wait_timeout_while(self.waiting(), patience, is_idle);
        let (mut waiting, _) = waiting.unwrap_or_else(PoisonError::into_inner);
        match waiting.queue.pop_front() {
            Some(news) => {
                waiting.bytes -= size(&news);
                Ok(news)
            }
            None if waiting.is_over => Err(RecvTimeoutError::Disconnected),
            None => Err(RecvTimeoutError::Timeout),
        }
    }

    /// Takes the numbers of messages that are not handled.
    pub(super) fn lost(&self) -> DroppedCounters {
        std::mem::take(&mut self.waiting().lost)
    }

    /// A thread that panicked leaves it at worst between two news.
    fn waiting(&self) -> MutexGuard<'_, InboxState> {
        self.shared.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl InboxState {
    fn put(&mut self, news: LinkEvent) {
        let bytes = size(&news);
        let is_full = self.queue.len() >= MOST.0 || self.bytes + bytes > MOST.1;
        if self.queue.len() >= self.next.max(LONG) || is_full {
            self.forget();
            // So that it is looked through again only when that is worth it.
            self.next = 2 * self.queue.len();
        }
        // Whether it is connected is always told, and there is more room for what must not be missed.
        let is_dropped = match &news {
            LinkEvent::Message { topic, .. } if is_urgent(topic) => self.queue.len() >= 2 * MOST.0,
            LinkEvent::Message { .. } => self.queue.len() >= MOST.0 || self.bytes + bytes > MOST.1,
            LinkEvent::Up | LinkEvent::Down(_) => false,
        };
        if is_dropped {
            self.lost.dropped += 1;
            return;
        }
        self.bytes += bytes;
        self.queue.push_back(news);
    }

    /// Of the positions on each topic only the last one stays.
    fn forget(&mut self) {
        let (mut seen, before) = (HashSet::new(), self.queue.len());
        let mut stays: Vec<bool> =
            self.queue.iter().rev().map(|news| position(news).is_none_or(|it| seen.insert(it))).collect();
        self.queue.retain(|_| stays.pop().unwrap_or(true));
        self.lost.old += (before - self.queue.len()) as u64;
        self.bytes = self.queue.iter().map(size).sum();
    }
}

/// Whether messages on a topic tell vehicles to stop, or who is there: other supervisors, too.
fn is_urgent(topic: &str) -> bool {
    matches!(TopicKind::of_topic(topic), Some(TopicKind::InstantActions | TopicKind::Connection))
}

/// The topic of a message with a position that is so now.
fn position(news: &LinkEvent) -> Option<&str> {
    let LinkEvent::Message { topic, kept: false, .. } = news else { return None };
    matches!(TopicKind::of_topic(topic), Some(TopicKind::State | TopicKind::Visualization)).then_some(topic.as_str())
}

fn size(news: &LinkEvent) -> usize {
    match news {
        LinkEvent::Message { topic, payload, .. } => topic.len() + payload.len(),
        LinkEvent::Up | LinkEvent::Down(_) => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Instant;

    fn message(topic: &str, number: usize) -> LinkEvent {
        let payload = number.to_le_bytes().to_vec();
        LinkEvent::Message { topic: topic.into(), payload, kept: false, came: Instant::now() }
    }

    #[test]
    fn older_positions_give_way_and_nothing_else() {
        let (feeder, inbox) = inbox();
        for k in 0..20_000 {
            feeder.put(message(&format!("uagv/v2/m/{}/state", k % 10), k));
            if k % 100 == 0 {
                feeder.put(message("fleet/v2/m/1/order", k));
            }
        }
        feeder.put(LinkEvent::Up);
        drop(feeder);
        let (mut orders, mut last, mut states) = (Vec::new(), [0; 10], 0);
        let ended = loop {
            match inbox.next(Duration::ZERO) {
                Ok(LinkEvent::Message { topic, payload, .. }) => {
                    let number = usize::from_le_bytes(payload.try_into().unwrap());
                    if topic.ends_with("order") {
                        orders.push(number);
                    } else {
                        assert!(number > last[number % 10] || number < 10);
                        (last[number % 10], states) = (number, states + 1);
                    }
                }
                Ok(_) => {}
                Err(ended) => break ended,
            }
        };
        assert_eq!(ended, RecvTimeoutError::Disconnected);
        assert_eq!(orders, (0..200).map(|k| 100 * k).collect::<Vec<_>>());
        assert_eq!(last, [0, 1, 2, 3, 4, 5, 6, 7, 8, 9].map(|k| 19_990 + k));
        assert!(states < 2 * LONG, "{states}");
        assert_eq!(inbox.lost(), DroppedCounters { old: 20_000 - states as u64, dropped: 0 });
        assert_eq!(inbox.lost(), DroppedCounters::default());
    }

    #[test]
    fn there_is_an_end_to_what_waits() {
        let (feeder, inbox) = inbox();
        (0..MOST.0 + 5).for_each(|k| feeder.put(message("fleet/v2/m/1/order", k)));
        feeder.put(LinkEvent::Up);
        assert_eq!(inbox.lost(), DroppedCounters { old: 0, dropped: 5 });
        assert_eq!(inbox.next(Duration::ZERO).map(|news| size(&news)), Ok(18 + 8));
    }
}
