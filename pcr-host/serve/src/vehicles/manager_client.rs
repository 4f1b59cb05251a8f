//! The manager at a broker.

use super::manager::{FleetManager, OutgoingMessage};
use crate::setup_error::SetupError;
use crate::vda5050::bridge::MqttMessage;
use crate::vda5050::mqtt::{BrokerAddress, LinkEvent, MqttLink};
use pcr_formats::vda5050::topics::{TopicInterface, TopicKind};
use std::sync::mpsc::{Receiver, channel};
use std::time::Instant;

/// A manager at a broker.
#[derive(Debug)]
pub struct ManagerClient {
    /// The manager.
    pub manager: FleetManager,
    interface: TopicInterface,
    link: MqttLink,
    news: Receiver<LinkEvent>,
    begin: Instant,
}

impl ManagerClient {
    /// Connects it.
    ///
    /// # Errors
    /// The invalid setting.
    pub fn open(broker: &BrokerAddress, interface: TopicInterface, manager: FleetManager) -> Result<Self, SetupError> {
        let (sender, news) = channel();
        let filters = interface.filters(TopicKind::State).to_vec();
        let link = MqttLink::open(broker, "pcr-manager", None, filters, move |it| {
            // An office that has been dropped needs no news.
            let _ = sender.send(it);
        })?;
        Ok(Self { manager, interface, link, news, begin: Instant::now() })
    }

    /// Handles the messages that have come.
    pub fn step(&mut self) {
        let now = self.begin.elapsed().as_secs_f64();
        while let Ok(news) = self.news.try_recv() {
            let LinkEvent::Message { topic, payload, .. } = news else { continue };
            let Some((_, key, TopicKind::State)) = self.interface.parse(&topic) else { continue };
            for OutgoingMessage { key, version, payload } in self.manager.receive(&key, &payload, now) {
                let topic = self.interface.topic(version, &key, TopicKind::Order);
                // A lost message is sent again.
                let _ = self.link.publish(MqttMessage { topic, payload, at_least_once: false, retain: false });
            }
        }
    }
}
