//! The header of every message.

use super::decode::DecodeError;
use super::topics::VehicleId;
use super::version::ProtocolVersion;
use serde::{Deserialize, Serialize};

/// Defines a message: its header, its fields, and a map of all other fields.
macro_rules! message {
    ($(#[$meta:meta])* $name:ident { $($(#[$field_meta:meta])* $field:ident : $type:ty,)* }) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq, ::serde::Serialize, ::serde::Deserialize)]
        #[serde(rename_all = "camelCase")]
        pub struct $name {
            /// The header.
            #[serde(flatten)]
            pub header: $crate::vda5050::header::MessageHeader,
            $($(#[$field_meta])* pub $field: $type,)*
            /// All other fields of the message, kept unchanged.
            #[serde(flatten)]
            pub rest: ::serde_json::Map<String, ::serde_json::Value>,
        }
    };
}
pub(super) use message;

/// The header of a message.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct MessageHeader {
    /// Header id: counts the messages of a topic.
    pub header_id: u64,
    /// Time stamp, by the clock of the sender.
    pub timestamp: String,
    /// Edition of the standard.
    pub version: String,
    /// Manufacturer of the vehicle.
    pub manufacturer: String,
    /// Serial number of the vehicle.
    pub serial_number: String,
}

impl MessageHeader {
    /// The header of a message of ours.
    pub fn new(key: &VehicleId, version: ProtocolVersion, header_id: u64, timestamp: String) -> Self {
        let VehicleId { manufacturer, serial_number } = key.clone();
        Self { header_id, timestamp, version: version.text().into(), manufacturer, serial_number }
    }

    /// The edition, if the message is about the vehicle of its topic and has the major version of its topic.
    ///
    /// # Errors
    /// The field that does not fit.
    pub fn check(&self, key: &VehicleId, is_third: bool) -> Result<ProtocolVersion, DecodeError> {
        for (field, said, topic) in [
            ("manufacturer", &self.manufacturer, &key.manufacturer),
            ("serialNumber", &self.serial_number, &key.serial_number),
        ] {
            // Isaac Mission Dispatch leaves both empty in its orders: the topic says whose they are.
            if said != topic && !said.is_empty() {
                return Err(DecodeError::new(field, format!("{said:?}, but the topic is that of {topic:?}")));
            }
        }
        let version = self.edition()?;
        if (version == ProtocolVersion::V3_0) != is_third {
            let why = format!("{version} in a topic of v{}", if is_third { 3 } else { 2 });
            return Err(DecodeError::new("version", why));
        }
        Ok(version)
    }

    /// The edition.
    ///
    /// # Errors
    /// One that is not read.
    pub fn edition(&self) -> Result<ProtocolVersion, DecodeError> {
        let unknown = || DecodeError::new("version", format!("{:?}; 2.0, 2.1 and 3.0 are read", self.version));
        ProtocolVersion::parse(&self.version).ok_or_else(unknown)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_are_about_the_vehicle_of_their_topic_or_name_none() {
        let key = VehicleId { manufacturer: "acme".into(), serial_number: "7".into() };
        let named = |manufacturer: &str, serial_number: &str| MessageHeader {
            version: "2.0.0".into(),
            manufacturer: manufacturer.into(),
            serial_number: serial_number.into(),
            ..MessageHeader::default()
        };
        for names in [["acme", "7"], ["", ""]] {
            assert_eq!(named(names[0], names[1]).check(&key, false), Ok(ProtocolVersion::V2_0));
        }
        for [names, field] in [[["other", "7"], ["manufacturer", ""]], [["acme", "8"], ["serialNumber", ""]]] {
            let refused = named(names[0], names[1]).check(&key, false).unwrap_err().to_string();
            assert!(refused.contains(field[0]) && refused.contains("the topic is that of"), "{refused}");
        }
        assert!(named("", "").check(&key, true).is_err());
    }
}
