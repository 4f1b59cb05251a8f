//! Which of several bridges at a broker is the active one.

use super::bridge::Publish;
use pcr_formats::vda5050::header::Header;
use pcr_formats::vda5050::messages::Connection;
use pcr_formats::vda5050::stamp;
use pcr_formats::vda5050::topics::Key;
use pcr_formats::vda5050::version::Version;
use serde_json::{Map, Value};
use std::time::Instant;

/// The claim to be the active bridge.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Claim {
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
enum Said {
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

impl Said {
    /// # Errors
    /// Why the message cannot be read. It says nothing then about whether another bridge is active.
    fn read(payload: &[u8]) -> Result<Self, String> {
        if payload.is_empty() {
            return Ok(Self::Nothing);
        }
        let message: Connection = serde_json::from_slice(payload).map_err(|error| error.to_string())?;
        let session = message.rest.get("session").and_then(Value::as_str).ok_or("session: missing")?.to_owned();
        let insists = message.rest.get("insists") == Some(&Value::Bool(true));
        match message.connection_state.as_str() {
            "ONLINE" => Ok(Self::Online { session, insists }),
            "OFFLINE" => Ok(Self::Offline { session }),
            broken if Version::ALL.iter().any(|version| version.broken() == broken) => Ok(Self::Offline { session }),
            other => Err(format!("connectionState: {other:?}")),
        }
    }
}

impl Claim {
    /// Takes what the broker says of claims. Returns a line for the log if our claim has to be sent again.
    ///
    /// # Errors
    /// Why this bridge ends: another one is active, or may be.
    pub(super) fn heard(&mut self, payload: &[u8], own: &str) -> Result<Option<String>, String> {
        let said = match (Said::read(payload), &self) {
            (Ok(said), _) => said,
            (Err(why), Self::Ours) => return Ok(Some(format!("a claim that cannot be read: {why}"))),
            (Err(why), _) => {
                let why = format!("a claim cannot be read ({why}), so another supervisor may be at work");
                return Err(why);
            }
        };
        let is_own = match &said {
            Said::Nothing => false,
            Said::Online { session, .. } | Said::Offline { session } => session == own,
        };
        match (&self, said) {
            (Self::Sent, Said::Online { .. }) if is_own => *self = Self::Seen(Instant::now()),
            // That bridge may be gone: the broker will tell.
            (Self::Asking(_), Said::Online { session, .. }) if !is_own => *self = Self::Theirs(Instant::now(), session),
            (Self::Theirs(..), Said::Nothing | Said::Offline { .. }) => *self = Self::Asking(Instant::now()),
            _ if is_own => {}
            // It claimed before us; a bridge that claims after us sees our claim.
            (Self::Sent, Said::Online { session, .. }) => {
                return Err(format!("another supervisor, {session}, was first"));
            }
            // If both believed to be active, the one with the larger session ends.
            (Self::Seen(_) | Self::Ours, Said::Online { session, insists: true })
                if *self != Self::Ours || session.as_str() < own =>
            {
                return Err(format!("another supervisor, {session}, is at work"));
            }
            (Self::Seen(_) | Self::Ours, Said::Online { session, .. } | Said::Offline { session }) => {
                return Ok(Some(format!("another supervisor, {session}, comes or goes")));
            }
            (Self::Seen(_) | Self::Ours, Said::Nothing) => return Ok(Some("our claim was removed".into())),
            _ => {}
        }
        Ok(None)
    }
}

/// The message with the claim of a session.
pub(super) fn claim(key: &Key, topic: &str, session: &str, state: &str, insists: bool) -> Publish {
    let header = Header::new(key, Version::V2_1, 1, stamp::now());
    let rest = [("session".to_owned(), Value::from(session)), ("insists".to_owned(), insists.into())];
    let rest = Map::from_iter(rest);
    let message = Connection { header, connection_state: state.into(), rest };
    // An empty message would withdraw the claim.
    let payload = serde_json::to_vec(&message).expect("texts and numbers can always be written");
    Publish { topic: topic.into(), payload, assured: true, retain: true }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(session: &str, state: &str, insists: bool) -> Vec<u8> {
        claim(&Key::new("pcr", "supervisor").unwrap(), "t", session, state, insists).payload
    }

    /// What could not be read counted as the word of a supervisor that had ended.
    #[test]
    fn a_claim_that_cannot_be_read_is_no_permission() {
        let now = Instant::now();
        let damaged = [&b"{"[..], b"null", b"{}", br#"{"connectionState":"ONLINE"}"#, &message("a", "online", false)];
        for payload in damaged {
            for mut claim in [Claim::Asking(now), Claim::Theirs(now, "a".into()), Claim::Sent, Claim::Seen(now)] {
                let before = claim.clone();
                let stopped = claim.heard(payload, "b").unwrap_err();
                assert!(stopped.contains("cannot be read"), "{stopped:?}");
                assert_eq!(claim, before);
            }
            let mut ours = Claim::Ours;
            assert!(ours.heard(payload, "b").unwrap().is_some_and(|line| line.contains("cannot be read")));
            assert_eq!(ours, Claim::Ours);
        }
    }

    #[test]
    fn who_has_the_claim() {
        let now = Instant::now();
        let heard = |claim: &Claim, payload: &[u8]| {
            let mut claim = claim.clone();
            claim.heard(payload, "b").map(|line| (claim, line.is_some()))
        };
        let stays = |claim: &Claim, again: bool| Ok((claim.clone(), again));
        let theirs = Claim::Theirs(now, "a".into());
        for over in [vec![], message("a", "OFFLINE", false), message("a", "CONNECTIONBROKEN", false)] {
            assert!(matches!(heard(&theirs, &over), Ok((Claim::Asking(_), false))));
            assert_eq!(heard(&Claim::Asking(now), &over), stays(&Claim::Asking(now), false));
            assert_eq!(heard(&Claim::Sent, &over), stays(&Claim::Sent, false));
            assert_eq!(heard(&Claim::Ours, &over), stays(&Claim::Ours, true));
        }
        let online = |session, insists| message(session, "ONLINE", insists);
        assert!(matches!(heard(&Claim::Asking(now), &online("a", false)), Ok((Claim::Theirs(..), false))));
        assert!(matches!(heard(&Claim::Sent, &online("b", false)), Ok((Claim::Seen(_), false))));
        assert!(heard(&Claim::Sent, &online("a", false)).is_err());
        assert!(heard(&Claim::Seen(now), &online("c", true)).is_err());
        assert_eq!(heard(&Claim::Seen(now), &online("c", false)), stays(&Claim::Seen(now), true));
        assert!(heard(&Claim::Ours, &online("a", true)).is_err());
        assert_eq!(heard(&Claim::Ours, &online("c", true)), stays(&Claim::Ours, true));
        assert_eq!(heard(&Claim::Ours, &online("b", true)), stays(&Claim::Ours, false));
    }
}
