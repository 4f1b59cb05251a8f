//! Decides which message of a kind is the newest one of a vehicle.
//!
//! Messages come late, repeated and in any order. Time stamps tell which of two was written later, or else message numbers, which count
//! modulo 2³².
//!
//! A vehicle that was switched off and on may restart its count and its clock, so its new messages look late. Therefore a message that
//! does not continue the newest one counts as late until a restart is proved. The proof is a message that names a request which was
//! sent after the newest message had come, or a row of messages that follow one another for longer than any message can be late
//! ([`LATEST`]). For that long afterwards, messages closer to the old count belong to the old count.
//!
//! The first messages after a start of the supervisor may have been written before it. The same two proofs show that they were not.

use pcr_formats::vda5050::header::MessageHeader;

/// No message is later than this \[s\].
pub(super) const LATEST: f64 = 60.0;

/// Number of late messages in a row, each newer than the one before, after which a request is sent to the vehicle.
const ROW: u32 = 3;

/// Time between two requests \[s\].
pub(super) const AGAIN: f64 = 1.0;

/// Number, time stamp and arrival of a message.
#[derive(Clone, Copy, Debug, PartialEq)]
struct MessageStamp {
    number: u64,
    stamp: Option<f64>,
    /// Time at which the message came \[s\].
    received_at: f64,
}

impl MessageStamp {
    fn of(header: &MessageHeader, came: f64) -> Self {
        Self { number: header.header_id, stamp: pcr_formats::import::seconds(&header.timestamp), received_at: came }
    }

    /// Whether the message was written after another one, if both belong to the same count.
    fn follows(&self, other: &Self) -> bool {
        match self.stamp.zip(other.stamp) {
            Some((own, before)) if own != before => own > before,
            _ => (1..1 << 31).contains(&self.ahead(other)),
        }
    }

    /// Difference of the numbers modulo 2³²: some vehicles count with 64 bits, others begin again after 2³².
    fn ahead(&self, other: &Self) -> u32 {
        (self.number as u32).wrapping_sub(other.number as u32)
    }

    /// Whether the message is nearer to `to` than to `than`, by time stamps or else by numbers.
    fn is_nearer(&self, to: &Self, than: &Self) -> bool {
        if let (Some(own), Some(to), Some(than)) = (self.stamp, to.stamp, than.stamp) {
            return (own - to).abs() < (own - than).abs();
        }
        let distance = |other| self.ahead(other).min(other.ahead(self));
        distance(to) < distance(than)
    }
}

/// A row of messages that follow one another, but not the newest one.
#[derive(Clone, Copy, Debug)]
struct MessageRun {
    last: MessageStamp,
    count: u32,
    /// Time at which the first one came \[s\].
    since: f64,
}

/// The position of a message in the order of its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Recency {
    /// The newest message.
    Newest,
    /// The newest message, the first of a restarted count: all messages before it are older.
    Anew,
    /// An older message, or one of unknown age.
    Late,
}

/// What is known after a start of the supervisor, until a message is certainly not older than it.
#[derive(Clone, Debug)]
struct RestartGrace {
    /// Ids of the last requests, and the time of the last one \[s\].
    asked: Vec<String>,
    asked_at: f64,
    /// Number of messages, and the time at which the first one came \[s\].
    count: u32,
    since: f64,
}

/// The newest message of a kind.
#[derive(Clone, Debug, Default)]
pub(super) struct RecencyFilter {
    known: Option<MessageStamp>,
    /// The newest message of the old count, and the time at which the present count began \[s\].
    before: Option<(MessageStamp, f64)>,
    row: Option<MessageRun>,
    /// Id and time of a request that was sent after the newest message had come \[s\].
    asked: Option<(String, f64)>,
    /// `None`: the newest message is certainly not from before the start.
    begun: Option<RestartGrace>,
}

impl RecencyFilter {
    /// At the start of the supervisor.
    pub(super) fn begun() -> Self {
        let (asked, asked_at) = (Vec::new(), f64::NEG_INFINITY);
        Self { begun: Some(RestartGrace { asked, asked_at, count: 0, since: 0.0 }), ..Self::default() }
    }

    /// Whether the newest message is certainly not from before the start.
    pub(super) fn is_proven(&self) -> bool {
        self.begun.is_none()
    }

    /// Takes a message; `names` tells whether the message mentions the action with an id.
    pub(super) fn take(&mut self, header: &MessageHeader, now: f64, names: impl Fn(&str) -> bool) -> Recency {
        let place = self.classify(header, now, &names);
        let begun = self.begun.take_if(|begun| begun.asked.iter().any(|id| names(id)));
        if let Some(begun) = self.begun.as_mut().filter(|_| begun.is_none() && place != Recency::Late) {
            let since = if begun.count == 0 { now } else { begun.since };
            (begun.count, begun.since) = (begun.count.saturating_add(1), since);
            if begun.count >= ROW && now - since > LATEST {
                self.begun = None;
            }
        }
        place
    }

    fn classify(&mut self, header: &MessageHeader, now: f64, names: impl Fn(&str) -> bool) -> Recency {
        let mark = MessageStamp::of(header, now);
        let Some(known) = self.known.filter(|known| !(mark.follows(known) && self.is_of(known, &mark))) else {
            *self = Self { known: Some(mark), before: self.before, begun: self.begun.take(), ..Self::default() };
            return Recency::Newest;
        };
        let row = match self.row {
            Some(row) if mark.follows(&row.last) => MessageRun { last: mark, count: row.count + 1, ..row },
            _ => MessageRun { last: mark, count: 1, since: now },
        };
        let is_answer = self.asked.as_ref().is_some_and(|(id, _)| names(id));
        if is_answer || row.count >= ROW && now - row.since > LATEST {
            let begun = self.begun.take();
            *self = Self { known: Some(mark), before: Some((known, now)), begun, ..Self::default() };
            return Recency::Anew;
        }
        self.row = Some(row);
        Recency::Late
    }

    /// Whether a request should be sent, whose answer is certainly newer.
    pub(super) fn is_in_doubt(&self, now: f64) -> bool {
        let has_row = self.row.is_some_and(|row| row.count >= ROW);
        has_row && self.asked.as_ref().is_none_or(|(_, at)| now - at >= AGAIN)
            || self.begun.as_ref().is_some_and(|begun| now - begun.asked_at >= AGAIN)
    }

    /// Notes that a request was sent.
    pub(super) fn asks(&mut self, id: String, now: f64) {
        /// Number of requests that are kept: an answer may come after the next ones were sent.
        const KEPT: usize = 8;
        if let Some(begun) = &mut self.begun {
            begun.asked.drain(..(begun.asked.len() + 1).saturating_sub(KEPT));
            begun.asked.push(id.clone());
            begun.asked_at = now;
        }
        self.asked = Some((id, now));
    }

    /// Returns by how much later than this one a message of another kind was written \[s\]; `None` if nobody knows. Only time stamps tell,
    /// because each kind has numbers of its own.
    pub(super) fn lead(&self, header: &MessageHeader, now: f64) -> Option<f64> {
        let mark = MessageStamp::of(header, now);
        let known = self.known.filter(|known| self.is_of(known, &mark))?;
        mark.stamp.zip(known.stamp).map(|(own, known)| own - known)
    }

    /// Whether a message belongs to the present count and not to the old one.
    fn is_of(&self, known: &MessageStamp, mark: &MessageStamp) -> bool {
        let before = self.before.filter(|(_, since)| mark.received_at - since <= LATEST);
        before.is_none_or(|(before, _)| mark.is_nearer(known, &before))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(number: u64, timestamp: &str) -> MessageHeader {
        MessageHeader { header_id: number, timestamp: timestamp.into(), ..MessageHeader::default() }
    }

    fn at(second: u32) -> String {
        format!("2030-01-01T00:{:02}:{:02}.000Z", second / 60, second % 60)
    }

    #[test]
    fn stamps_decide_and_numbers_where_there_are_none() {
        let nothing = |_: &str| false;
        for (first, second, is_newer) in [
            ((5, at(10)), (6, at(11)), true),
            // It counts anew.
            ((5, at(10)), (1, at(11)), true),
            ((5, at(10)), (6, at(9)), false),
            ((5, at(10)), (6, at(10)), true),
            ((5, at(10)), (5, at(10)), false),
            ((5, at(10)), (4, at(10)), false),
            // Its clock was set.
            ((5, at(10)), (6, at(800)), true),
            ((5, String::new()), (6, "soon".into()), true),
            ((5, String::new()), (4, at(10)), false),
            ((u64::from(u32::MAX), String::new()), (0, String::new()), true),
            ((0, String::new()), (u64::from(u32::MAX), String::new()), false),
        ] {
            let mut newest = RecencyFilter::default();
            assert_eq!(newest.take(&header(first.0, &first.1), 1.0, nothing), Recency::Newest);
            let place = newest.take(&header(second.0, &second.1), 2.0, nothing);
            assert_eq!(place == Recency::Newest, is_newer, "{first:?} {second:?}");
        }
    }

    #[test]
    fn a_vehicle_counts_anew_when_that_is_proved() {
        for (is_heard, has_clock, after) in [(true, true, 4), (false, true, 62), (true, false, 4), (false, false, 62)] {
            let at = |second| if has_clock { at(second) } else { String::new() };
            let mut newest = RecencyFilter::default();
            let mut asked = false;
            newest.take(&header(500, &at(600)), 0.0, |_| false);
            for k in 1..=120 {
                let place = newest.take(&header(k, &at(k as u32)), k as f64, |id| is_heard && asked && id == "r");
                let expected = if k < after {
                    Recency::Late
                } else if k == after {
                    Recency::Anew
                } else {
                    Recency::Newest
                };
                assert_eq!(place, expected, "{k}");
                if newest.is_in_doubt(k as f64) {
                    newest.asks("r".into(), k as f64);
                    asked = true;
                }
                // Late messages of the old count are not newer.
                for late in [490, 510] {
                    let place = newest.clone().take(&header(late, &at(late as u32 + 100)), k as f64 + 0.5, |_| false);
                    assert!(k < after || k > after + 59 || place == Recency::Late, "{k} {late}");
                }
            }
        }
        // A newer message came in between, so the answer to the request proves nothing.
        let mut newest = RecencyFilter::default();
        newest.take(&header(500, &at(600)), 0.0, |_| false);
        newest.asks("r".into(), 1.0);
        newest.take(&header(501, &at(602)), 2.0, |_| false);
        assert_eq!(newest.take(&header(499, &at(599)), 3.0, |id| id == "r"), Recency::Late);
    }
}
