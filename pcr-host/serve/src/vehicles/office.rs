//! The manager at a broker.

use super::manager::{Manager, Sent};
use crate::vda5050::bridge::Publish;
use crate::vda5050::mqtt::{Broker, Link, News};
use pcr_formats::vda5050::topics::{Interface, Kind};
use std::sync::mpsc::{Receiver, channel};
use std::time::Instant;

/// A manager at a broker.
#[derive(Debug)]
pub struct Office {
    /// The manager.
    pub manager: Manager,
    interface: Interface,
    link: Link,
    news: Receiver<News>,
    begin: Instant,
}

impl Office {
    /// Connects it.
    ///
    /// # Errors
    /// The invalid setting.
    pub fn open(broker: &Broker, interface: Interface, manager: Manager) -> Result<Self, String> {
        let (sender, news) = channel();
        let filters = interface.filters(Kind::State).to_vec();
        let link = Link::open(broker, "pcr-manager", None, filters, move |it| {
            // An office that has been dropped needs no news.
            let _ = sender.send(it);
        })?;
        Ok(Self { manager, interface, link, news, begin: Instant::now() })
    }

    /// Handles the messages that have come.
    pub fn step(&mut self) {
        let now = self.begin.elapsed().as_secs_f64();
        while let Ok(news) = self.news.try_recv() {
            let News::Message { topic, payload, .. } = news else { continue };
            let Some((_, key, Kind::State)) = self.interface.parse(&topic) else { continue };
            for Sent { key, version, payload } in self.manager.receive(&key, &payload, now) {
                let topic = self.interface.topic(version, &key, Kind::Order);
                // A lost message is sent again.
                let _ = self.link.publish(Publish { topic, payload, assured: false, retain: false });
            }
        }
    }
}
