//! The error types of the crate.

use core::fmt;

/// Why a path, a profile or a motion was refused. The string names the invalid quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum InvalidInput {
    /// The quantity is NaN or infinite.
    NonFinite(&'static str),
    /// The quantity is below zero.
    Negative(&'static str),
    /// The quantity must be above zero.
    NonPositive(&'static str),
    /// The magnitude of the quantity is above [`Scalar::LIMIT`](crate::Scalar::LIMIT).
    OutOfRange(&'static str),
    /// The quantity is below [`Scalar::LEAST`](crate::Scalar::LEAST).
    TooSmall(&'static str),
    /// The arc sweeps more than one full turn. Split it into several arcs.
    SweepOverOneTurn,
    /// The segment or phase does not begin where its predecessor ends.
    Disconnected(&'static str),
    /// The profile is longer or shorter than the path. Lengths are rounded down \[mm\].
    LengthMismatch {
        /// Length of the path \[mm\].
        path: u32,
        /// Length that the profile travels \[mm\].
        profile: u32,
    },
    /// The fixed capacity is used up.
    Full(&'static str),
    /// The corners of an outline are not those of a convex polygon, counter-clockwise.
    NotConvex,
    /// The path has a turn without a length, during which an outline that is no disc sweeps an area. Give it a lever: [`Path::pivot`](crate::Path::pivot).
    TurnInPlace,
    /// An arc is so tight beside the outline, or the lever of a turn in place so short, that rounding a length would move its corners too far.
    Lever,
    /// The path turns in place with a length, for which the crate has to have its feature `outlines`.
    NeedsOutlines,
}

impl fmt::Display for InvalidInput {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NonFinite(what) => write!(f, "{what} is not a finite number"),
            Self::Negative(what) => write!(f, "{what} is below zero"),
            Self::NonPositive(what) => write!(f, "{what} is not above zero"),
            Self::OutOfRange(what) => write!(f, "{what} is out of range"),
            Self::TooSmall(what) => write!(f, "{what} is too small for the number format"),
            Self::SweepOverOneTurn => f.write_str("the arc sweeps more than one turn"),
            Self::Disconnected(what) => write!(f, "the {what} does not begin where its predecessor ends"),
            Self::LengthMismatch { path, profile } if path == profile => {
                let [metres, rest] = [path / 1000, path % 1000];
                write!(f, "the profile misses the end of the path, {metres}.{rest:03} m, by less than 1 mm")
            }
            Self::LengthMismatch { path, profile } => {
                let [metres, rest, own, own_rest] = [profile / 1000, profile % 1000, path / 1000, path % 1000];
                write!(f, "the profile travels {metres}.{rest:03} m, the path has {own}.{own_rest:03} m")
            }
            Self::Full(what) => write!(f, "there is no room for another {what}"),
            Self::NotConvex => f.write_str("the corners of the outline do not turn left around a convex polygon"),
            Self::TurnInPlace => {
                f.write_str("the outline sweeps an area in a turn without a length; give the turn a lever")
            }
            Self::Lever => {
                f.write_str("an arc of the path is too tight, or a lever too short, for the size of the outline")
            }
            Self::NeedsOutlines => f.write_str("turns in place with a length need the feature `outlines`"),
        }
    }
}

impl core::error::Error for InvalidInput {}

/// There is not enough room for the result. What was stored before is intact, unless the function says otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum CapacityError {
    /// The table needs at least this many pieces; [`Ecm::needed`](crate::Ecm::needed) counts them all.
    Pieces {
        /// Number of pieces that the call needed before it stopped.
        needed: usize,
        /// Number of pieces that there is room for.
        capacity: usize,
    },
    /// The table needs at least this many regions; [`Ecm::needed`](crate::Ecm::needed) counts them all.
    Regions {
        /// Number of regions that the call needed before it stopped.
        needed: usize,
        /// Number of regions that there is room for.
        capacity: usize,
    },
    /// These two agents have more than 32767 pieces with each other; more storage does not help.
    Pair([usize; 2]),
    /// An agent whose index is above 65535 has a region.
    Agents,
    /// A [`BroadPhase`](crate::BroadPhase) needs at least two boxes for each agent.
    Boxes {
        /// Number of boxes that are needed.
        needed: usize,
        /// Number of boxes that there is room for.
        capacity: usize,
    },
    /// [`PrecedenceTable`](crate::PrecedenceTable) needs one order for each region, and, to admit an agent, as many more as that agent
    /// has regions.
    Orders {
        /// Number of orders that are needed.
        needed: usize,
        /// Number of orders that there is room for.
        capacity: usize,
    },
    /// A check of [`PrecedenceTable`](crate::PrecedenceTable) needs one [`CheckState`](crate::CheckState) for each agent.
    Reaches {
        /// Number of states that are needed.
        needed: usize,
        /// Number of states that there is room for.
        capacity: usize,
    },
    /// Two outlines touch at more lengths of a pair of segments than the kernel has room for; more storage does not help.
    Contacts,
}

impl fmt::Display for CapacityError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pieces { needed, capacity } => write!(f, "there is room for {capacity} pieces, not for {needed}"),
            Self::Regions { needed, capacity } => write!(f, "there is room for {capacity} regions, not for {needed}"),
            Self::Pair([a, b]) => write!(f, "agents {a} and {b} of the fleet have more than 32767 pieces"),
            Self::Agents => f.write_str("an agent whose index is above 65535 has a region"),
            Self::Boxes { needed, capacity } => write!(f, "there is room for {capacity} boxes, not for {needed}"),
            Self::Orders { needed, capacity } => write!(f, "there is room for {capacity} orders, not for {needed}"),
            Self::Reaches { needed, capacity } => {
                write!(f, "there is room to check the orders of {capacity} agents, not of {needed}")
            }
            Self::Contacts => f.write_str("two outlines touch at too many lengths of a pair of segments"),
        }
    }
}

impl core::error::Error for CapacityError {}

/// The arguments do not belong together: agent and fleet, or fleet and table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum MismatchError {
    /// The fleet has no such agent.
    NoSuchAgent(usize),
    /// The table was computed for another fleet: the number of agents, their paths, radii, order or
    /// [lags](crate::Motion::lag) differ. About one in two billion such fleets is overlooked, because all of this is
    /// compared by checksums of 32 bits.
    OtherFleet,
    /// The table holds the regions of this agent only ([`Ecm::fill_row`](crate::Ecm::fill_row)).
    OnlyRow(usize),
    /// The table is being computed in parts ([`Ecm::fill_pairs`](crate::Ecm::fill_pairs)), and is not complete yet.
    Unfinished,
    /// The agent has no region at this index of the table.
    NoSuchRegion(usize),
}

impl fmt::Display for MismatchError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSuchAgent(agent) => write!(f, "the fleet has no agent {agent}"),
            Self::OtherFleet => {
                f.write_str("the table of regions is that of another fleet, or of motions with another lag")
            }
            Self::OnlyRow(agent) => write!(f, "the table holds the regions of agent {agent} only"),
            Self::Unfinished => f.write_str("the table is not complete yet"),
            Self::NoSuchRegion(place) => write!(f, "the agent has no region in place {place} of the table"),
        }
    }
}

impl core::error::Error for MismatchError {}

/// Why a table was not filled or changed. Every method that returns it says what is then in the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum EcmError {
    /// There is not enough room.
    Full(CapacityError),
    /// The fleet or the agent is not that of the table.
    Mismatch(MismatchError),
}

impl From<CapacityError> for EcmError {
    fn from(full: CapacityError) -> Self {
        Self::Full(full)
    }
}

impl From<MismatchError> for EcmError {
    fn from(mismatch: MismatchError) -> Self {
        Self::Mismatch(mismatch)
    }
}

impl fmt::Display for EcmError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Full(full) => full.fmt(f),
            Self::Mismatch(mismatch) => mismatch.fmt(f),
        }
    }
}

impl core::error::Error for EcmError {}

/// Returns `value` if it is finite and within the limits of its format.
pub(crate) fn in_range<S: crate::Scalar>(value: S, what: &'static str) -> Result<S, InvalidInput> {
    if !value.is_finite() {
        return Err(InvalidInput::NonFinite(what));
    }
    // Compared without `abs`, because the least number of a fixed-point format has no magnitude.
    if value > S::LIMIT || value < -S::LIMIT {
        return Err(InvalidInput::OutOfRange(what));
    }
    Ok(value)
}

/// Whether the value is NaN. Comparisons with NaN are false, and a query must not read that as "no contact".
pub(crate) fn is_no_number<S: crate::Scalar>(value: S) -> bool {
    !(value <= S::ZERO || value > S::ZERO)
}

/// Returns `value` if it is in range and not negative.
pub(crate) fn not_negative<S: crate::Scalar>(value: S, what: &'static str) -> Result<S, InvalidInput> {
    if in_range(value, what)? < S::ZERO { Err(InvalidInput::Negative(what)) } else { Ok(value) }
}

/// A length, in range and not negative. Below the square of [`Scalar::LEAST`](crate::Scalar::LEAST) it is taken as 0: the
/// product of a length with an acceleration would lose its digits to underflow, and a segment without any length could
/// then get the time of a whole ramp.
pub(crate) fn length<S: crate::Scalar>(value: S) -> Result<S, InvalidInput> {
    let least = crate::scalar::Wide::narrow(S::LEAST.times(S::LEAST));
    Ok(if not_negative(value, "length")? < least { S::ZERO } else { value })
}

/// Checks the radius of a disc or an arc.
pub(crate) fn radius<S: crate::Scalar>(value: S) -> Result<S, InvalidInput> {
    if positive(value, "radius")? < S::LEAST { Err(InvalidInput::TooSmall("radius")) } else { Ok(value) }
}

/// Returns `value` if it is in range and above zero.
pub(crate) fn positive<S: crate::Scalar>(value: S, what: &'static str) -> Result<S, InvalidInput> {
    if in_range(value, what)? > S::ZERO { Ok(value) } else { Err(InvalidInput::NonPositive(what)) }
}

#[cfg(test)]
mod tests {
    use super::{CapacityError, EcmError, InvalidInput, MismatchError};
    use core::fmt::Write;
    use heapless::String;

    #[test]
    fn messages_name_all_agents() {
        let text = |value: &dyn core::fmt::Display| {
            let mut text = String::<80>::new();
            write!(text, "{value}").map(|()| text)
        };
        let pair = text(&CapacityError::Pair([3, 17])).unwrap();
        assert_eq!(pair, "agents 3 and 17 of the fleet have more than 32767 pieces");
        let lengths = |path, profile| text(&InvalidInput::LengthMismatch { path, profile }).unwrap();
        assert_eq!(lengths(10_004, 7_500), "the profile travels 7.500 m, the path has 10.004 m");
        assert_eq!(lengths(1_050, 1_050), "the profile misses the end of the path, 1.050 m, by less than 1 mm");
        assert_eq!(text(&EcmError::from(MismatchError::NoSuchAgent(5))).unwrap(), "the fleet has no agent 5");
        assert_eq!(
            text(&EcmError::from(MismatchError::OnlyRow(4))).unwrap(),
            "the table holds the regions of agent 4 only"
        );
    }
}
