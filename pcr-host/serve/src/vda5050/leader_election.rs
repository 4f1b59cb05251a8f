//! Which of several bridges at a broker is the active one.

use super::bridge::MqttMessage;
use pcr_formats::vda5050::decode::{self, MessageLimits};
use pcr_formats::vda5050::header::MessageHeader;
use pcr_formats::vda5050::messages::Connection;
use pcr_formats::vda5050::timestamp;
use pcr_formats::vda5050::topics::VehicleId;
use pcr_formats::vda5050::version::ProtocolVersion;
use serde_json::{Map, Value};
use std::time::Instant;

/// The claim to be the active bridge.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum LeaderState {
    /// Not known yet; since when.
    Asking(Instant),
    /// Another bridge, of this session, has a claim but may be gone; since when.
    Theirs(Instant, String),
    /// Our claim was sent.
    Sent,
    /// The broker has returned our claim; since when no other bridge has objected.
    Seen(Instant),
    /// This bridge is active.
    Ours,
}

/// What a message says about the claim of a bridge.
#[derive(Clone, Debug, PartialEq)]
enum LeaderMessage {
    /// The retained message was removed.
    Nothing,
    /// A bridge has a claim.
    Online {
        session: String,
        /// It objects to other claims.
        insists: bool,
    },
    /// A bridge has ended.
    Offline { session: String },
}

impl LeaderMessage {
    /// # Errors
    /// Why the message cannot be read. It says nothing then about whether another bridge is active.
    fn read(payload: &[u8]) -> Result<Self, String> {
        if payload.is_empty() {
            return Ok(Self::Nothing);
        }
        let message: Connection = decode::read(payload, MessageLimits::default()).map_err(|error| error.to_string())?;
        let session = message.rest.get("session").and_then(Value::as_str).ok_or("session: missing")?.to_owned();
        let insists = message.rest.get("insists") == Some(&Value::Bool(true));
        match message.connection_state.as_str() {
            "ONLINE" => Ok(Self::Online { session, insists }),
            "OFFLINE" => Ok(Self::Offline { session }),
            broken if ProtocolVersion::ALL.iter().any(|version| version.broken() == broken) => {
                Ok(Self::Offline { session })
            }
            other => Err(format!("connectionState: {other:?}")),
        }
    }
}

impl LeaderState {
    /// Takes what the broker says of claims. Returns a line for the log if our claim has to be sent again.
    ///
    /// # Errors
    /// Why this bridge ends: another one is active, or may be.
    pub(super) fn heard(&mut self, payload: &[u8], own: &str) -> Result<Option<String>, String> {
        let said = match (LeaderMessage::read(payload), &self) {
            (Ok(said), _) => said,
            (Err(why), Self::Ours) => return Ok(Some(format!("a claim that cannot be read: {why}"))),
            (Err(why), _) => {
                let why = format!("a claim cannot be read ({why}), so another supervisor may be at work");
                return Err(why);
            }
        };
        let is_own = match &said {
            LeaderMessage::Nothing => false,
            LeaderMessage::Online { session, .. } | LeaderMessage::Offline { session } => session == own,
        };
        match (&self, said) {
            (Self::Sent, LeaderMessage::Online { .. }) if is_own => *self = Self::Seen(Instant::now()),
            // That bridge may be gone: the broker will tell.
            (Self::Asking(_), LeaderMessage::Online { session, .. }) if !is_own => {
                *self = Self::Theirs(Instant::now(), session)
            }
            (Self::Theirs(..), LeaderMessage::Nothing | LeaderMessage::Offline { .. }) => {
                *self = Self::Asking(Instant::now())
            }
            _ if is_own => {}
            // It claimed before us; a bridge that claims after us sees our claim.
            (Self::Sent, LeaderMessage::Online { session, .. }) => {
                return Err(format!("another supervisor, {session}, was first"));
            }
            // If both believed to be active, the one with the larger session ends.
            (Self::Seen(_) | Self::Ours, LeaderMessage::Online { session, insists: true })
                if *self != Self::Ours || session.as_str() < own =>
            {
                return Err(format!("another supervisor, {session}, is at work"));
            }
            (
                Self::Seen(_) | Self::Ours,
                LeaderMessage::Online { session, .. } | LeaderMessage::Offline { session },
            ) => {
                return Ok(Some(format!("another supervisor, {session}, comes or goes")));
            }
            (Self::Seen(_) | Self::Ours, LeaderMessage::Nothing) => return Ok(Some("our claim was removed".into())),
            _ => {}
        }
        Ok(None)
    }
}

/// The message with the claim of a session.
pub(super) fn claim(key: &VehicleId, topic: &str, session: &str, state: &str, insists: bool) -> MqttMessage {
    let header = MessageHeader::new(key, ProtocolVersion::V2_1, 1, timestamp::now());
    let rest = [("session".to_owned(), Value::from(session)), ("insists".to_owned(), insists.into())];
    let rest = Map::from_iter(rest);
    let message = Connection { header, connection_state: state.into(), rest };
    // An empty message would withdraw the claim.
    let payload = serde_json::to_vec(&message).expect("texts and numbers can always be written");
    MqttMessage { topic: topic.into(), payload, at_least_once: true, retain: true }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(session: &str, state: &str, insists: bool) -> Vec<u8> {
        claim(&VehicleId::new("pcr", "supervisor").unwrap(), "t", session, state, insists).payload
    }

    /// What could not be read counted as the word of a supervisor that had ended.
    #[test]
    fn a_claim_that_cannot_be_read_is_no_permission() {
        let now = Instant::now();
        let damaged = [&b"{"[..], b"null", b"{}", br#"{"connectionState":"ONLINE"}"#, &message("a", "online", false)];
        for payload in damaged {
            for mut claim in [
                LeaderState::Asking(now),
                LeaderState::Theirs(now, "a".into()),
                LeaderState::Sent,
                LeaderState::Seen(now),
            ] {
                let before = claim.clone();
                let stopped = claim.heard(payload, "b").unwrap_err();
                assert!(stopped.contains("cannot be read"), "{stopped:?}");
                assert_eq!(claim, before);
            }
            let mut ours = LeaderState::Ours;
            assert!(ours.heard(payload, "b").unwrap().is_some_and(|line| line.contains("cannot be read")));
            assert_eq!(ours, LeaderState::Ours);
        }
    }

    #[test]
    fn who_has_the_claim() {
        let now = Instant::now();
        let heard = |claim: &LeaderState, payload: &[u8]| {
            let mut claim = claim.clone();
            claim.heard(payload, "b").map(|line| (claim, line.is_some()))
        };
        let stays = |claim: &LeaderState, again: bool| Ok((claim.clone(), again));
        let theirs = LeaderState::Theirs(now, "a".into());
        for over in [vec![], message("a", "OFFLINE", false), message("a", "CONNECTIONBROKEN", false)] {
            assert!(matches!(heard(&theirs, &over), Ok((LeaderState::Asking(_), false))));
            assert_eq!(heard(&LeaderState::Asking(now), &over), stays(&LeaderState::Asking(now), false));
            assert_eq!(heard(&LeaderState::Sent, &over), stays(&LeaderState::Sent, false));
            assert_eq!(heard(&LeaderState::Ours, &over), stays(&LeaderState::Ours, true));
        }
        let online = |session, insists| message(session, "ONLINE", insists);
        assert!(matches!(heard(&LeaderState::Asking(now), &online("a", false)), Ok((LeaderState::Theirs(..), false))));
        assert!(matches!(heard(&LeaderState::Sent, &online("b", false)), Ok((LeaderState::Seen(_), false))));
        assert!(heard(&LeaderState::Sent, &online("a", false)).is_err());
        assert!(heard(&LeaderState::Seen(now), &online("c", true)).is_err());
        assert_eq!(heard(&LeaderState::Seen(now), &online("c", false)), stays(&LeaderState::Seen(now), true));
        assert!(heard(&LeaderState::Ours, &online("a", true)).is_err());
        assert_eq!(heard(&LeaderState::Ours, &online("c", true)), stays(&LeaderState::Ours, true));
        assert_eq!(heard(&LeaderState::Ours, &online("b", true)), stays(&LeaderState::Ours, false));
    }
}
