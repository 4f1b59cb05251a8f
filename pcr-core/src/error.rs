//! What the constructors refuse, and why.

use core::fmt;

/// Why a path, a profile or a motion was refused. The string names the offending quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Invalid {
    /// It is NaN or infinite.
    NonFinite(&'static str),
    /// It is below zero.
    Negative(&'static str),
    /// It must be above zero.
    NonPositive(&'static str),
    /// Its magnitude is above [`Scalar::LIMIT`](crate::Scalar::LIMIT).
    OutOfRange(&'static str),
    /// An arc may sweep one full turn; split longer ones.
    SweepOverOneTurn,
    /// It does not begin where its predecessor ends.
    Disconnected(&'static str),
    /// The profile does not end where the path does.
    LengthMismatch,
    /// The capacity is used up.
    Full(&'static str),
}

impl fmt::Display for Invalid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NonFinite(what) => write!(f, "{what} is not a finite number"),
            Self::Negative(what) => write!(f, "{what} is below zero"),
            Self::NonPositive(what) => write!(f, "{what} is not above zero"),
            Self::OutOfRange(what) => write!(f, "{what} is out of range"),
            Self::SweepOverOneTurn => f.write_str("the arc sweeps more than one turn"),
            Self::Disconnected(what) => write!(f, "the {what} does not begin where its predecessor ends"),
            Self::LengthMismatch => f.write_str("the profile does not travel the length of the path"),
            Self::Full(what) => write!(f, "there is no room for another {what}"),
        }
    }
}

impl core::error::Error for Invalid {}

/// There is no room for what was to be stored. What was there is intact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Full {
    /// More pieces are needed.
    Pieces,
    /// More regions are needed.
    Regions,
    /// These two agents have more than 32767 pieces with each other; no storage is large enough.
    Pair([usize; 2]),
    /// The fleet has more than 65535 agents.
    Agents,
    /// Each agent of a [`BroadPhase`](crate::BroadPhase) needs two boxes at least.
    Boxes,
    /// Each region of [`Orders`](crate::Orders) needs an order; an agent that is admitted needs as many more as it has regions.
    Orders,
    /// Each agent of a check of [`Orders`](crate::Orders) needs a [`Reach`](crate::Reach).
    Reaches,
}

impl fmt::Display for Full {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pieces => f.write_str("there is no room for another piece"),
            Self::Regions => f.write_str("there is no room for another region"),
            Self::Pair([a, b]) => write!(f, "agents {a} and {b} of the fleet have more than 32767 pieces"),
            Self::Agents => f.write_str("the fleet has more than 65535 agents"),
            Self::Boxes => f.write_str("there is room for less than two boxes an agent"),
            Self::Orders => f.write_str("there is no room for another order"),
            Self::Reaches => f.write_str("there is room to check the orders of fewer agents"),
        }
    }
}

impl core::error::Error for Full {}

/// `value` if it is finite and within the limits of its format.
pub(crate) fn in_range<S: crate::Scalar>(value: S, what: &'static str) -> Result<S, Invalid> {
    if !value.is_finite() {
        return Err(Invalid::NonFinite(what));
    }
    // Not by its magnitude, which the least number of a fixed-point format does not have.
    if value > S::LIMIT || value < -S::LIMIT {
        return Err(Invalid::OutOfRange(what));
    }
    Ok(value)
}

/// `value` if it is in range and not negative.
pub(crate) fn not_negative<S: crate::Scalar>(value: S, what: &'static str) -> Result<S, Invalid> {
    if in_range(value, what)? < S::ZERO { Err(Invalid::Negative(what)) } else { Ok(value) }
}

/// `value` if it is in range and above zero.
pub(crate) fn positive<S: crate::Scalar>(value: S, what: &'static str) -> Result<S, Invalid> {
    if in_range(value, what)? > S::ZERO { Ok(value) } else { Err(Invalid::NonPositive(what)) }
}
