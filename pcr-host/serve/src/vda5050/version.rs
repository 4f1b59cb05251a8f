//! Editions of the standard, and the names that they use.

use std::fmt;

/// An edition.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Version {
    /// 2.0
    V2_0,
    /// 2.1
    V2_1,
    /// 3.0
    V3_0,
}

impl Version {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::V2_0, Self::V2_1, Self::V3_0];

    /// That of a `version` in a message: major, minor, and whatever follows.
    pub fn of(text: &str) -> Option<Self> {
        let mut parts = text.trim().split('.');
        match (parts.next()?, parts.next()?) {
            ("2", "0") => Some(Self::V2_0),
            ("2", "1") => Some(Self::V2_1),
            ("3", "0") => Some(Self::V3_0),
            _ => None,
        }
    }

    /// As messages write it.
    pub fn text(self) -> &'static str {
        match self {
            Self::V2_0 => "2.0.0",
            Self::V2_1 => "2.1.0",
            Self::V3_0 => "3.0.0",
        }
    }

    /// As topics write it.
    pub fn major(self) -> &'static str {
        if self < Self::V3_0 { "v2" } else { "v3" }
    }

    /// The state of a connection that has broken.
    pub fn broken(self) -> &'static str {
        if self < Self::V3_0 { "CONNECTIONBROKEN" } else { "CONNECTION_BROKEN" }
    }

    /// An error of a state, as this edition calls it.
    pub fn error(self, error: Error) -> &'static str {
        match (error, self < Self::V3_0) {
            (Error::Malformed, true) => "validationError",
            (Error::Malformed, false) => "VALIDATION_FAILURE",
            (Error::Order, true) => "orderError",
            (Error::Order, false) => "INVALID_ORDER",
            (Error::Outdated, true) => "orderUpdateError",
            (Error::Outdated, false) => "OUTDATED_ORDER_UPDATE",
            (Error::Update, true) => "orderUpdateError",
            (Error::Update, false) => "INVALID_ORDER",
            (Error::NothingToCancel, true) => "noOrderToCancel",
            (Error::NothingToCancel, false) => "NO_ORDER_TO_CANCEL",
        }
    }
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.text())
    }
}

/// Why an order is not taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error {
    /// It is no order.
    Malformed,
    /// It cannot be carried out.
    Order,
    /// It is older than what is held.
    Outdated,
    /// It does not go on where what is held ends.
    Update,
    /// There is no order.
    NothingToCancel,
}
