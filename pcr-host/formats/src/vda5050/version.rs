//! Editions of the standard, and the names that they use.

use std::fmt;

/// An edition of VDA 5050.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ProtocolVersion {
    /// 2.0
    V2_0,
    /// 2.1
    V2_1,
    /// 3.0
    V3_0,
}

impl ProtocolVersion {
    /// All editions.
    pub const ALL: [Self; 3] = [Self::V2_0, Self::V2_1, Self::V3_0];

    /// The edition of a `version` field: major, minor, and anything after that.
    pub fn parse(text: &str) -> Option<Self> {
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
    pub fn error(self, error: OrderRejection) -> &'static str {
        match (error, self < Self::V3_0) {
            (OrderRejection::Malformed, true) => "validationError",
            (OrderRejection::Malformed, false) => "VALIDATION_FAILURE",
            (OrderRejection::Order, true) => "orderError",
            (OrderRejection::Order, false) => "INVALID_ORDER",
            (OrderRejection::Outdated, true) => "orderUpdateError",
            (OrderRejection::Outdated, false) => "OUTDATED_ORDER_UPDATE",
            (OrderRejection::Update, true) => "orderUpdateError",
            (OrderRejection::Update, false) => "INVALID_ORDER",
            (OrderRejection::SameUpdate, true) => "orderUpdateError",
            (OrderRejection::SameUpdate, false) => "SAME_ORDER_UPDATE_ID",
            (OrderRejection::Cancelled, true) => "orderUpdateError",
            (OrderRejection::Cancelled, false) => "ORDER_UPDATE_FOLLOWING_CANCEL",
            (OrderRejection::NothingToCancel, true) => "noOrderToCancel",
            (OrderRejection::NothingToCancel, false) => "NO_ORDER_TO_CANCEL",
        }
    }
}

impl fmt::Display for ProtocolVersion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.text())
    }
}

/// The reason why an order is rejected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OrderRejection {
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
