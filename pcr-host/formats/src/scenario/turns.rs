//! Motions with turns in place: an arc of [`TURN`] radius; the vehicle is at rest before and after it. A turn by the
//! angle θ(t) is a motion of the length [`TURN`] θ(t).

use super::{Agent, KINK, MotionSpec, PathSegment, TURN};
use crate::json::{JsonData, JsonNode};

/// Whether a segment in a file is one.
pub(super) fn is_given(segment: &JsonNode<'_>) -> bool {
    let JsonData::Object(members) = &segment.data else { return false };
    members.iter().any(|(key, value)| key == "kind" && matches!(&value.data, JsonData::Text(kind) if kind == "turn"))
}

/// Whether a segment is a turn in place.
fn is_turn(segment: &PathSegment) -> bool {
    matches!(segment, PathSegment::Arc { radius: TURN, .. })
}

impl Agent {
    /// Whether its path has a turn in place, not counting joints that are passed without a stop, or a change of gear: there it stands.
    pub fn turns_in_place(&self) -> bool {
        let turns =
            |segment: &PathSegment| matches!(segment, PathSegment::Arc { radius: TURN, sweep } if sweep.abs() > KINK);
        self.changes_gear() || self.path.iter().any(turns)
    }
}

/// From rest to rest in the least time under limits of speed and acceleration, of turns as well.
pub(super) fn motion(path: &[PathSegment], [v_max, a_max]: [f64; 2], turns: [f64; 2]) -> MotionSpec {
    let mut pieces = Vec::new();
    for run in path.chunk_by(|a, b| !is_turn(a) && !is_turn(b)) {
        let length = run.iter().map(PathSegment::length).sum();
        let [v_max, a_max] = if run.iter().any(is_turn) { turns.map(|limit| limit * TURN) } else { [v_max, a_max] };
        pieces.extend(MotionSpec::RestToRest { v_max, a_max }.pieces(length).1);
    }
    MotionSpec::Profile { v0: 0.0, pieces }
}
