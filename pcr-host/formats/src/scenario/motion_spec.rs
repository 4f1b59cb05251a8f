//! Speed over time: along the path, and of turns in place.

/// A part of a profile with a constant acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionPiece {
    /// \[s\]
    pub duration: f64,
    /// \[m/s²\], or that of a turn in place \[rad/s²\].
    pub acceleration: f64,
    /// Whether the vehicle turns in place meanwhile, and its speed is one of rotation.
    pub in_place: bool,
}

impl MotionPiece {
    /// Along the path: a duration \[s\] and an acceleration \[m/s²\].
    pub const fn drive(duration: f64, acceleration: f64) -> Self {
        Self { duration, acceleration, in_place: false }
    }

    /// In place: a duration \[s\] and an acceleration \[rad/s²\].
    pub const fn turn(duration: f64, acceleration: f64) -> Self {
        Self { duration, acceleration, in_place: true }
    }
}

/// Speed over time.
#[derive(Clone, Debug, PartialEq)]
pub enum MotionSpec {
    /// From rest to rest in the least time under these limits.
    RestToRest {
        /// \[m/s\]
        v_max: f64,
        /// \[m/s²\]
        a_max: f64,
    },
    /// A speed at the start, then constant accelerations.
    Profile {
        /// \[m/s\]
        v0: f64,
        /// Its parts. The vehicle is at rest between those along the path and those in place.
        pieces: Vec<MotionPiece>,
    },
}

impl MotionSpec {
    /// The profile with this speed at its start \[m/s\], then durations \[s\] and accelerations \[m/s²\] along the path.
    pub fn profile(v0: f64, pieces: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let drive = |(duration, acceleration)| MotionPiece::drive(duration, acceleration);
        Self::Profile { v0, pieces: pieces.into_iter().map(drive).collect() }
    }

    /// Whether the vehicle turns in place.
    pub fn turns_in_place(&self) -> bool {
        matches!(self, Self::Profile { pieces, .. } if pieces.iter().any(|piece| piece.in_place))
    }

    /// Speed at the start of a path of this length \[m/s\], then durations \[s\] and accelerations \[m/s²\] along it. While the vehicle turns
    /// in place, it waits.
    pub fn pieces(&self, length: f64) -> (f64, Vec<(f64, f64)>) {
        match self {
            Self::Profile { v0, pieces } => {
                let along =
                    |piece: &MotionPiece| (piece.duration, if piece.in_place { 0.0 } else { piece.acceleration });
                (*v0, pieces.iter().map(along).collect())
            }
            Self::RestToRest { .. } if length <= 0.0 => (0.0, Vec::new()),
            Self::RestToRest { v_max, a_max } => {
                let peak = v_max.min((length * a_max).sqrt());
                // If the motion does not reach the largest speed, rounding would leave a small remainder.
                let cruise = if peak < *v_max { 0.0 } else { (length / peak - peak / a_max).max(0.0) };
                (0.0, vec![(peak / a_max, *a_max), (cruise, 0.0), (peak / a_max, -a_max)])
            }
        }
    }
}
