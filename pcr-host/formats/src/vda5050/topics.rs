//! Names of topics: `prefix/v2/manufacturer/serialNumber/order`.

use super::version::ProtocolVersion;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Why a text cannot be part of a topic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TopicError {
    /// Which part of the topic.
    pub field: &'static str,
    /// The text.
    pub text: String,
    /// Why it is refused.
    pub fault: LevelFault,
}

/// Why a level of a topic is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LevelFault {
    /// It is empty.
    Empty,
    /// It has more than 90 bytes.
    TooLong,
    /// It has a character with a meaning in topics.
    Reserved,
    /// It has a control character.
    Control,
}

impl fmt::Display for LevelFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Empty => "empty",
            Self::TooLong => "more than 90 bytes",
            Self::Reserved => "/, +, # and $ mean something else in topics",
            Self::Control => "control characters",
        })
    }
}

impl fmt::Display for TopicError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {:?}: {}", self.field, self.text, self.fault)
    }
}

impl std::error::Error for TopicError {}

/// A vehicle, by manufacturer and serial number.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct VehicleId {
    /// Manufacturer.
    pub manufacturer: String,
    /// Serial number.
    pub serial_number: String,
}

impl VehicleId {
    /// A key whose parts can be levels of topics.
    ///
    /// # Errors
    /// The part that cannot be a level of a topic, and why.
    pub fn new(manufacturer: &str, serial_number: &str) -> Result<Self, TopicError> {
        for (field, part) in [("manufacturer", manufacturer), ("serialNumber", serial_number)] {
            level(part).map_err(|fault| TopicError { field, text: part.to_owned(), fault })?;
        }
        Ok(Self { manufacturer: manufacturer.into(), serial_number: serial_number.into() })
    }
}

impl fmt::Display for VehicleId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.manufacturer, self.serial_number)
    }
}

/// Checks a level of a topic.
fn level(text: &str) -> Result<(), LevelFault> {
    match text {
        "" => Err(LevelFault::Empty),
        text if text.len() > 90 => Err(LevelFault::TooLong),
        text if text.contains(['/', '+', '#', '$']) => Err(LevelFault::Reserved),
        text if text.chars().any(char::is_control) => Err(LevelFault::Control),
        _ => Ok(()),
    }
}

/// Kinds of messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum TopicKind {
    /// To a vehicle.
    Order,
    /// To a vehicle.
    InstantActions,
    /// From a vehicle.
    State,
    /// From a vehicle.
    Visualization,
    /// From a vehicle.
    Connection,
    /// From a vehicle.
    Factsheet,
    /// To a vehicle, since 3.0.
    Responses,
    /// To a vehicle, since 3.0.
    ZoneSet,
}

impl TopicKind {
    /// All kinds.
    pub const ALL: [Self; 8] = [
        Self::Order,
        Self::InstantActions,
        Self::State,
        Self::Visualization,
        Self::Connection,
        Self::Factsheet,
        Self::Responses,
        Self::ZoneSet,
    ];

    /// Kinds of messages from vehicles.
    pub const OF_VEHICLES: [Self; 4] = [Self::State, Self::Visualization, Self::Connection, Self::Factsheet];

    /// Kinds of messages to vehicles.
    pub const TO_VEHICLES: [Self; 4] = [Self::Order, Self::InstantActions, Self::Responses, Self::ZoneSet];

    /// Returns the kind of messages on a topic, whatever the prefix of its interface; `None` for a kind that is not known.
    pub fn of_topic(topic: &str) -> Option<Self> {
        let last = topic.rsplit('/').next()?;
        Self::ALL.into_iter().find(|kind| kind.text() == last)
    }

    /// Its name in topics.
    pub fn text(self) -> &'static str {
        match self {
            Self::Order => "order",
            Self::InstantActions => "instantActions",
            Self::State => "state",
            Self::Visualization => "visualization",
            Self::Connection => "connection",
            Self::Factsheet => "factsheet",
            Self::Responses => "responses",
            Self::ZoneSet => "zoneSet",
        }
    }

    /// Whether it is sent with quality of service 1, as the standard says for messages that must not be lost; otherwise 0.
    pub fn is_assured(self) -> bool {
        self == Self::Connection
    }

    /// Whether a retained message of this kind is read. Factsheets, connection states and zone sets hold until they are replaced;
    /// a retained state or order may be old.
    pub fn is_lasting(self) -> bool {
        matches!(self, Self::Connection | Self::Factsheet | Self::ZoneSet)
    }

    /// Whether the broker keeps the last message of this kind.
    pub fn is_retained(self) -> bool {
        matches!(self, Self::Connection | Self::Factsheet)
    }
}

/// The topics of one interface, which begin with its prefix.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TopicInterface {
    prefix: String,
}

impl TopicInterface {
    /// The interface with a prefix, which may have several levels.
    ///
    /// # Errors
    /// The level that cannot be part of a topic, and why.
    pub fn new(prefix: &str) -> Result<Self, TopicError> {
        for part in prefix.split('/') {
            level(part).map_err(|fault| TopicError { field: "prefix", text: prefix.to_owned(), fault })?;
        }
        Ok(Self { prefix: prefix.into() })
    }

    /// The topic of a message.
    pub fn topic(&self, version: ProtocolVersion, key: &VehicleId, kind: TopicKind) -> String {
        format!("{}/{}/{}/{}/{}", self.prefix, version.major(), key.manufacturer, key.serial_number, kind.text())
    }

    /// Topic filters for a kind of messages of all vehicles, 2.x and 3.x.
    pub fn filters(&self, kind: TopicKind) -> [String; 2] {
        ["v2", "v3"].map(|major| format!("{}/{major}/+/+/{}", self.prefix, kind.text()))
    }

    /// Whether the major version is 3, the vehicle, and the kind of a topic; `None` if it is no topic of this interface.
    pub fn parse(&self, topic: &str) -> Option<(bool, VehicleId, TopicKind)> {
        let rest = topic.strip_prefix(self.prefix.as_str())?.strip_prefix('/')?;
        let mut levels = rest.split('/');
        let is_third = match levels.next()? {
            "v2" => false,
            "v3" => true,
            _ => return None,
        };
        let key = VehicleId::new(levels.next()?, levels.next()?).ok()?;
        let kind = TopicKind::of_topic(levels.next()?)?;
        levels.next().is_none().then_some((is_third, key, kind))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn topics_are_read_as_they_are_written() {
        let interface = TopicInterface::new("site/uagv").unwrap();
        let key = VehicleId::new("KIT", "0001").unwrap();
        for version in ProtocolVersion::ALL {
            for kind in TopicKind::ALL {
                let topic = interface.topic(version, &key, kind);
                assert_eq!(
                    interface.parse(&topic),
                    Some((version == ProtocolVersion::V3_0, key.clone(), kind)),
                    "{topic}"
                );
            }
        }
        assert_eq!(interface.topic(ProtocolVersion::V2_1, &key, TopicKind::Order), "site/uagv/v2/KIT/0001/order");
        for other in ["uagv/v2/KIT/0001/order", "site/uagvx/v2/KIT/0001/order", "site/uagv/v1/KIT/0001/order"] {
            assert_eq!(interface.parse(other), None, "{other}");
        }
        for other in ["site/uagv/v2/KIT/0001/order/x", "site/uagv/v2/KIT/0001", "site/uagv/v2//0001/order"] {
            assert_eq!(interface.parse(other), None, "{other}");
        }
        assert_eq!(TopicKind::of_topic("any/prefix/v2/KIT/0001/zoneSet"), Some(TopicKind::ZoneSet));
        assert_eq!(TopicKind::of_topic("site/uagv/v2/KIT/0001/states"), None);
        for wrong in ["", "a//b", "a/+", "#", "$SYS"] {
            assert!(TopicInterface::new(wrong).is_err(), "{wrong}");
        }
        assert!(
            VehicleId::new("a/b", "c").is_err()
                && VehicleId::new("a", "").is_err()
                && VehicleId::new("a", "x+").is_err()
        );
    }
}
