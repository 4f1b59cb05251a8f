//! Angles of a scenario, in radians or, by keys of their own, in degrees; and warnings about angles that are probably in the wrong unit.

use super::facing::file_segments;
use super::json_fields::{NumberRange, ObjectFields, ScenarioError, figure};
use super::{MotionSpec, PathSegment, Scenario};
use crate::warning::WarningCode;
use std::f64::consts::TAU;

/// Key at the top of a file that declares the unit of its angles.
pub(super) const UNIT: &str = "angles";

/// The only value of [`UNIT`]: angles above one turn are meant.
pub(super) const RADIANS: &str = "radians";

/// An angle above which radians are doubted: one turn, which files may give with four digits.
const DOUBTED: f64 = 1.001 * TAU;

/// A field with an angle, an angular speed or an angular acceleration: its key in radians, and its key in degrees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AngleField {
    /// Direction of an agent at its start.
    Heading,
    /// Angle of an arc or of a turn in place.
    Sweep,
    /// Angle from the direction of travel to the heading.
    Facing,
    /// Largest speed of turns in place.
    TurnSpeed,
    /// Largest acceleration of turns in place.
    TurnAcceleration,
    /// Acceleration of a turn in place in a piece of a profile.
    PieceAcceleration,
}

impl AngleField {
    const ALL: [Self; 6] =
        [Self::Heading, Self::Sweep, Self::Facing, Self::TurnSpeed, Self::TurnAcceleration, Self::PieceAcceleration];

    /// The keys for radians and for degrees.
    pub(super) const fn keys(self) -> [&'static str; 2] {
        match self {
            Self::Heading => ["heading", "heading_deg"],
            Self::Sweep => ["sweep", "sweep_deg"],
            Self::Facing => ["facing", "facing_deg"],
            Self::TurnSpeed => ["turn_v_max", "turn_v_max_deg"],
            Self::TurnAcceleration => ["turn_a_max", "turn_a_max_deg"],
            Self::PieceAcceleration => ["turn_accel", "turn_accel_deg"],
        }
    }

    /// What messages call more than it should be.
    const fn excess(self) -> &'static str {
        match self {
            Self::Heading | Self::Sweep | Self::Facing => "is more than one turn in radians",
            Self::TurnSpeed => "is more than one turn a second in radians",
            Self::TurnAcceleration | Self::PieceAcceleration => {
                "is more than one turn a second, each second, in radians"
            }
        }
    }

    const fn range(self) -> NumberRange {
        match self {
            Self::Heading | Self::Sweep | Self::Facing | Self::PieceAcceleration => NumberRange::Any,
            Self::TurnSpeed | Self::TurnAcceleration => NumberRange::Positive,
        }
    }

    /// Whether a field has it, in either unit.
    pub(super) fn is_in(self, fields: &ObjectFields<'_>) -> bool {
        self.keys().iter().any(|key| fields.get(key).is_some())
    }
}

/// The angles in radians that are above one turn, by field: the first one with its place, and how many there are.
#[derive(Debug, Default)]
pub(super) struct Doubts([Option<(String, f64, usize)>; 6]);

impl Doubts {
    /// Reads an angle \[rad\], and notes it if it is given in radians and above one turn.
    pub(super) fn angle(&mut self, fields: &ObjectFields<'_>, angle: AngleField) -> Result<f64, ScenarioError> {
        let [radians, degrees] = angle.keys();
        if fields.get(degrees).is_some() {
            if fields.get(radians).is_some() {
                let problem = format!("given beside {radians}; give either radians ({radians}) or degrees ({degrees})");
                return Err(fields.refused(degrees, problem));
            }
            // A number above 0 may be none in radians.
            return match fields.number(degrees, angle.range())?.to_radians() {
                0.0 if matches!(angle.range(), NumberRange::Positive) => Err(fields.refused(degrees, "too small")),
                radians => Ok(radians),
            };
        }
        let value = fields.number(radians, angle.range())?;
        if value.abs() > DOUBTED {
            match &mut self.0[angle as usize] {
                Some((_, _, count)) => *count += 1,
                none => *none = Some((fields.called(radians), value, 1)),
            }
        }
        Ok(value)
    }

    /// The warnings, a line for each kind of field.
    pub(super) fn warnings(&self) -> Vec<String> {
        let kinds = AngleField::ALL.into_iter().filter_map(|angle| Some((angle, self.0[angle as usize].as_ref()?)));
        let warning = |(angle, (place, value, count)): (AngleField, &(String, f64, usize))| {
            let [_, degrees] = angle.keys();
            let more = if *count > 1 { format!(" (and {} more)", count - 1) } else { String::new() };
            let value = figure(*value);
            WarningCode::AngleUnit.text(format_args!(
                "{place}: {value} {}{more}; use {degrees} for degrees, or add \"{UNIT}\": \"{RADIANS}\" to the file if this is \
                 meant",
                angle.excess()
            ))
        };
        kinds.map(warning).collect()
    }
}

impl Scenario {
    /// Whether a file of it has to declare that its angles are in radians, because some of them would be doubted.
    pub(super) fn has_doubted_angles(&self) -> bool {
        self.agents.iter().any(|agent| {
            let pieces = match &agent.motion {
                MotionSpec::Profile { pieces, .. } => &pieces[..],
                MotionSpec::RestToRest { .. } => &[],
            };
            let turning = pieces.iter().filter(|piece| piece.in_place).map(|piece| piece.acceleration);
            let sweeps = agent.path.iter().map(PathSegment::sweep);
            let facings = file_segments(&agent.path).map(|(_, facing)| facing);
            sweeps.chain(facings).chain(turning).chain([agent.start[2]]).any(|angle| angle.abs() > DOUBTED)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_in_the_order_of_the_table() {
        for (place, angle) in AngleField::ALL.into_iter().enumerate() {
            assert_eq!(angle as usize, place);
            let [radians, degrees] = angle.keys();
            assert_eq!(format!("{radians}_deg"), degrees);
        }
    }
}
