//! Names of topics: `prefix/v2/manufacturer/serialNumber/order`.

use super::version::Version;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Which vehicle.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Key {
    /// Who has made it.
    pub manufacturer: String,
    /// Which of theirs.
    pub serial_number: String,
}

impl Key {
    /// One that topics can name.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn new(manufacturer: &str, serial_number: &str) -> Result<Self, String> {
        for (field, part) in [("manufacturer", manufacturer), ("serialNumber", serial_number)] {
            level(part).map_err(|why| format!("{field} {part:?}: {why}"))?;
        }
        Ok(Self { manufacturer: manufacturer.into(), serial_number: serial_number.into() })
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.manufacturer, self.serial_number)
    }
}

/// A level of a topic.
fn level(text: &str) -> Result<(), &'static str> {
    match text {
        "" => Err("empty"),
        text if text.len() > 90 => Err("more than 90 bytes"),
        text if text.contains(['/', '+', '#', '$']) => Err("/, +, # and $ mean something else in topics"),
        text if text.chars().any(char::is_control) => Err("control characters"),
        _ => Ok(()),
    }
}

/// What is in a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// To a vehicle.
    Order,
    /// To a vehicle.
    InstantActions,
    /// Of a vehicle.
    State,
    /// Of a vehicle.
    Visualization,
    /// Of a vehicle.
    Connection,
    /// Of a vehicle.
    Factsheet,
    /// To a vehicle, since 3.0.
    Responses,
    /// To a vehicle, since 3.0.
    ZoneSet,
}

impl Kind {
    /// All of them.
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

    /// What vehicles publish.
    pub const OF_VEHICLES: [Self; 4] = [Self::State, Self::Visualization, Self::Connection, Self::Factsheet];

    /// What vehicles read.
    pub const TO_VEHICLES: [Self; 4] = [Self::Order, Self::InstantActions, Self::Responses, Self::ZoneSet];

    /// As topics write it.
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

    /// At least once, for what must not be lost; else best effort, as the standard says.
    pub fn is_assured(self) -> bool {
        self == Self::Connection
    }

    /// Whether one that was said at any time before is read: what a vehicle is, and what holds until it is taken back. A state or an order that
    /// somebody let the broker keep is that of another time.
    pub fn is_lasting(self) -> bool {
        matches!(self, Self::Connection | Self::Factsheet | Self::ZoneSet)
    }

    /// Whether the broker keeps the last one.
    pub fn is_retained(self) -> bool {
        matches!(self, Self::Connection | Self::Factsheet)
    }
}

/// The topics of one interface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Interface {
    prefix: String,
}

impl Interface {
    /// That of a prefix, which may have several levels.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn new(prefix: &str) -> Result<Self, String> {
        for part in prefix.split('/') {
            level(part).map_err(|why| format!("prefix {prefix:?}: {why}"))?;
        }
        Ok(Self { prefix: prefix.into() })
    }

    /// Its prefix.
    pub fn prefix(&self) -> &str {
        &self.prefix
    }

    /// The topic of a message.
    pub fn topic(&self, version: Version, key: &Key, kind: Kind) -> String {
        format!("{}/{}/{}/{}/{}", self.prefix, version.major(), key.manufacturer, key.serial_number, kind.text())
    }

    /// What to subscribe to for a kind of messages of all vehicles, 2.x and 3.x.
    pub fn filters(&self, kind: Kind) -> [String; 2] {
        ["v2", "v3"].map(|major| format!("{}/{major}/+/+/{}", self.prefix, kind.text()))
    }

    /// Major version, vehicle and kind of a topic; none if it is not one of these.
    pub fn parse(&self, topic: &str) -> Option<(bool, Key, Kind)> {
        let rest = topic.strip_prefix(self.prefix.as_str())?.strip_prefix('/')?;
        let mut levels = rest.split('/');
        let is_third = match levels.next()? {
            "v2" => false,
            "v3" => true,
            _ => return None,
        };
        let key = Key::new(levels.next()?, levels.next()?).ok()?;
        let kind = levels.next()?;
        let kind = Kind::ALL.into_iter().find(|known| known.text() == kind)?;
        levels.next().is_none().then_some((is_third, key, kind))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn topics_are_read_as_they_are_written() {
        let interface = Interface::new("site/uagv").unwrap();
        let key = Key::new("KIT", "0001").unwrap();
        for version in Version::ALL {
            for kind in Kind::ALL {
                let topic = interface.topic(version, &key, kind);
                assert_eq!(interface.parse(&topic), Some((version == Version::V3_0, key.clone(), kind)), "{topic}");
            }
        }
        assert_eq!(interface.topic(Version::V2_1, &key, Kind::Order), "site/uagv/v2/KIT/0001/order");
        for other in ["uagv/v2/KIT/0001/order", "site/uagvx/v2/KIT/0001/order", "site/uagv/v1/KIT/0001/order"] {
            assert_eq!(interface.parse(other), None, "{other}");
        }
        for other in ["site/uagv/v2/KIT/0001/order/x", "site/uagv/v2/KIT/0001", "site/uagv/v2//0001/order"] {
            assert_eq!(interface.parse(other), None, "{other}");
        }
        for wrong in ["", "a//b", "a/+", "#", "$SYS"] {
            assert!(Interface::new(wrong).is_err(), "{wrong}");
        }
        assert!(Key::new("a/b", "c").is_err() && Key::new("a", "").is_err() && Key::new("a", "x+").is_err());
    }
}
