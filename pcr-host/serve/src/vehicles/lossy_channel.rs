//! Messages that are lost, late, repeated or out of order.

use pcr_formats::splitmix64::SplitMix64;
use serde::{Deserialize, Serialize};

/// The rates of faults of the transport.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ChannelFaults {
    /// Share of messages that are lost.
    #[serde(rename = "lost")]
    pub loss_rate: f64,
    /// Share of messages that come twice.
    #[serde(rename = "twice")]
    pub duplicate_rate: f64,
    /// Share of messages that come late, after later ones.
    #[serde(rename = "late")]
    pub reorder_rate: f64,
    /// Largest delay of a late message \[s\].
    pub delay: f64,
}

/// Messages on their way.
#[derive(Debug)]
pub(crate) struct LossyChannel<T> {
    climate: ChannelFaults,
    random: SplitMix64,
    underway: Vec<(f64, u64, T)>,
    count: u64,
}

impl<T: Clone> LossyChannel<T> {
    /// A transport without messages.
    pub(crate) fn new(climate: ChannelFaults, seed: u64) -> Self {
        Self { climate, random: SplitMix64(seed), underway: Vec::new(), count: 0 }
    }

    /// Changes the rates; messages on their way are not affected.
    pub(crate) fn change(&mut self, climate: ChannelFaults) {
        self.climate = climate;
    }

    /// Sends a message at a time \[s\].
    pub(crate) fn send(&mut self, message: T, now: f64) {
        let ChannelFaults { loss_rate: lost, duplicate_rate: twice, reorder_rate: late, delay } = self.climate;
        if self.random.unit() < lost {
            return;
        }
        let times = if self.random.unit() < twice { 2 } else { 1 };
        for _ in 0..times {
            let comes = if self.random.unit() < late { now + delay * self.random.unit() } else { now };
            self.underway.push((comes, self.count, message.clone()));
            self.count += 1;
        }
    }

    /// Takes the messages that have arrived.
    pub(crate) fn take_arrived(&mut self, now: f64) -> Vec<T> {
        let (mut come, rest): (Vec<_>, Vec<_>) =
            std::mem::take(&mut self.underway).into_iter().partition(|it| it.0 <= now);
        self.underway = rest;
        come.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        come.into_iter().map(|(_, _, message)| message).collect()
    }
}
