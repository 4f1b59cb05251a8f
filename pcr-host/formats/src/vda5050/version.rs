//! Editions of the standard, and the names that they use.

use std::fmt;

/// An edition of VDA 5050.
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
    /// All editions.
    pub const ALL: [Self; 3] = [Self::V2_0, Self::V2_1, Self::V3_0];

    /// The edition of a `version` field: major, minor, and anything after that.
    pub fn of(text: &str) -> Option<Self> {
        let mut parts = text.trim().split('.');
        match (parts.next()?, parts.next()?) {
            ("2", "0") => Some(Self::V2_0),
            ("2", "1") => Some(Self::V2_1),
            ("3", "0") => Some(Self::V3_0),
            _ => None,
        }
    }

    /// Its name in messages.
    pub fn text(self) -> &'static str {
        match self {
            Self::V2_0 => "2.0.0",
            Self::V2_1 => "2.1.0",
            Self::V3_0 => "3.0.0",
        }
    }

    /// Its name in topics.
    pub fn major(self) -> &'static str {
        if self < Self::V3_0 { "v2" } else { "v3" }
    }

    /// Connection state of a broken connection.
    pub fn broken(self) -> &'static str {
        if self < Self::V3_0 { "CONNECTIONBROKEN" } else { "CONNECTION_BROKEN" }
    }

    /// Error type of an error in this edition.
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
            (Error::SameUpdate, true) => "orderUpdateError",
            (Error::SameUpdate, false) => "SAME_ORDER_UPDATE_ID",
            (Error::Cancelled, true) => "orderUpdateError",
            (Error::Cancelled, false) => "ORDER_UPDATE_FOLLOWING_CANCEL",
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

/// The reason why an order is rejected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error {
    /// It is not a valid order.
    Malformed,
    /// It cannot be carried out.
    Order,
    /// It is older than the present order.
    Outdated,
    /// It does not continue the present order.
    Update,
    /// It has the number of an update that was taken, and another content.
    SameUpdate,
    /// It continues an order that was cancelled.
    Cancelled,
    /// There is no order to cancel.
    NothingToCancel,
}
