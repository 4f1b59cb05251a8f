//! The motion of an agent on each of its segments, and the agent on a range of its segments.

use super::{Agent, MotionPiece, MotionSpec, PathSegment, PlacedSegment, turns};

/// Length and speed that are rounding and nothing else, relative.
const NOTHING: f64 = 1e-12;

/// Time that is rounding and nothing else, relative.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Share of the segments beside a border within which a stop may be off it by rounding. A segment may be so short that a long way before
/// it is off by more than any fixed share of a millionth.
const BESIDE: f64 = 0.25;

/// Constant acceleration on one segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentPhase {
    /// \[s\]
    pub duration: f64,
    /// Speed at its beginning \[m/s\]; that of a turn in place \[rad/s\].
    pub before: f64,
    /// Speed at its end \[m/s\]; that of a turn in place \[rad/s\].
    pub after: f64,
}

impl SegmentPhase {
    /// A wait.
    const fn standing(duration: f64) -> Self {
        Self { duration, before: 0.0, after: 0.0 }
    }

    /// Whether the agent moves or turns.
    pub fn moves(&self) -> bool {
        self.before > 0.0 || self.after > 0.0
    }

    /// \[m/s²\]; that of a turn in place \[rad/s²\].
    pub fn acceleration(&self) -> f64 {
        if self.duration > 0.0 { (self.after - self.before) / self.duration } else { 0.0 }
    }
}

/// An agent on a range of its segments.
#[derive(Clone, Debug)]
pub struct AgentPart {
    /// The agent with these segments alone.
    pub agent: Agent,
    /// Its parts, which are those of the whole.
    pub parts: Vec<Vec<SegmentPhase>>,
    /// Length of the path before them \[m\].
    pub from: f64,
}

impl Agent {
    /// The motion on each segment of the path. A wait where two segments meet belongs to the later one.
    ///
    /// A stop within rounding of a segment border, on either side, counts as at the border: near a stop a tiny error of the length is a
    /// large error of the time.
    pub fn parts(&self) -> Vec<Vec<SegmentPhase>> {
        let lengths: Vec<f64> = self.path.iter().map(PathSegment::length).collect();
        match &self.motion {
            MotionSpec::Profile { v0, pieces } if self.motion.turns_in_place() => {
                self.parts_between_turns(*v0, pieces, &lengths)
            }
            _ => {
                let (v0, pieces) = self.motion.pieces(self.length());
                along(v0, &pieces, &lengths, NOTHING)
            }
        }
    }

    /// The same of a profile that turns in place. Turns part the path and the profile, and between two of them is what is between them in
    /// both.
    fn parts_between_turns(&self, v0: f64, pieces: &[MotionPiece], lengths: &[f64]) -> Vec<Vec<SegmentPhase>> {
        let mut parts: Vec<Vec<SegmentPhase>> = Vec::with_capacity(self.path.len());
        let (mut left, mut first_speed, mut rotation) = (pieces, v0, 0.0);
        loop {
            let from = parts.len();
            let next = self.path.iter().skip(from).position(PathSegment::takes_turning);
            let before = next.map_or(self.path.len(), |next| from + next);
            let (own, rest) = left.split_at(left.iter().position(|piece| piece.in_place).unwrap_or(left.len()));
            let mut driven: Vec<(f64, f64)> = own.iter().map(|piece| (piece.duration, piece.acceleration)).collect();
            left = rest;
            // What it waits before it turns.
            let mut turning = Vec::new();
            while next.is_some()
                && let Some((duration, _)) = driven.pop_if(|piece| piece.1 == 0.0 && !left.is_empty())
            {
                turning.insert(0, SegmentPhase::standing(duration));
            }
            let own = lengths.get(from..before).unwrap_or_default();
            parts.extend(along(std::mem::take(&mut first_speed), &driven, own, NOTHING));
            let Some(turn) = self.path.get(before) else {
                // Behind the last turn there may be no segment to wait on.
                if from == before
                    && let Some(last) = parts.last_mut()
                {
                    last.extend(driven.iter().map(|piece| SegmentPhase::standing(piece.0)));
                }
                return parts;
            };
            let phases = turns::phases(left, turn.sweep().abs(), rotation);
            left = left.get(phases.len()..).unwrap_or_default();
            rotation = phases.last().map_or(rotation, |last| last.after);
            turning.extend(phases);
            parts.push(turning);
        }
    }

    /// The agent on its segments from `first` to `last` (from 0). It sets off when it reaches the first of them, and what it waits at
    /// the end of the last one belongs to it as well.
    pub fn stretch(&self, first: usize, last: usize) -> AgentPart {
        let [x, y, heading] = self.start;
        let stands = PlacedSegment { start: [x, y], heading, shape: PathSegment::Line { length: 0.0 } };
        let before = self.path.iter().take(first);
        let reached = before.clone().fold(stands, |last, &shape| PlacedSegment {
            start: last.end(),
            heading: last.heading_at_end(),
            shape,
        });
        let mut parts = self.parts();
        let until: f64 = parts.iter().take(first).flatten().map(|part| part.duration).sum();
        let after = parts.split_off(parts.len().min(last + 1));
        let mut own = parts.split_off(parts.len().min(first));
        if let Some(end) = own.last_mut() {
            end.extend(after.into_iter().flatten().take_while(|part| !part.moves()));
        }
        let ([x, y], heading) = (reached.end(), reached.heading_at_end());
        let mut path: Vec<PathSegment> = self.path.iter().take(last + 1).skip(first).copied().collect();
        // It begins with the heading of the vehicle, from which the way leads at the angle that it had before.
        let facing = before.clone().fold(0.0, |facing, shape| shape.facing_after(facing));
        if let Some(PathSegment::Facing { before, .. }) = path.first_mut() {
            *before = 0.0;
        } else if facing != 0.0 {
            path.insert(0, PathSegment::Facing { before: 0.0, after: facing });
            own.insert(0, Vec::new());
        }
        let pieces = path.iter().zip(&own).flat_map(|(segment, phases)| {
            let turns = segment.takes_turning();
            phases.iter().map(move |phase| MotionPiece {
                duration: phase.duration,
                acceleration: phase.acceleration(),
                in_place: turns && phase.moves(),
            })
        });
        let pieces: Vec<MotionPiece> = pieces.collect();
        let at_start = own.iter().flatten().next().filter(|_| !pieces.first().is_some_and(|piece| piece.in_place));
        let agent = Self {
            t_start: self.t_start + until,
            start: [x, y, heading + facing],
            path,
            motion: MotionSpec::Profile { v0: at_start.map_or(0.0, |phase| phase.before), pieces },
            ..self.clone()
        };
        AgentPart { agent, parts: own, from: before.map(PathSegment::length).sum() }
    }
}

/// The phases of a motion along segments of these lengths \[m\], from a speed \[m/s\] with durations \[s\] and accelerations \[m/s²\].
/// A stop within a share `near` of the way since the last one of a border is at the border.
pub(super) fn along(v0: f64, pieces: &[(f64, f64)], lengths: &[f64], near: f64) -> Vec<Vec<SegmentPhase>> {
    let mut parts = vec![Vec::new(); lengths.len()];
    let last = lengths.len().saturating_sub(1);
    let (mut place, mut left, mut speed) = (0, lengths.first().copied().unwrap_or(0.0), v0);
    // Times that are rounding: a part as short would have any acceleration.
    let short = ROUNDING * pieces.iter().map(|(duration, _)| duration).sum::<f64>();
    // Largest speed since the last stop, and length since the last one at a border.
    let (mut fastest, mut since) = (v0, 0.0);
    for &(mut duration, acceleration) in pieces {
        let reached = speed + acceleration * duration;
        fastest = f64::max(fastest, reached);
        let end = if reached > NOTHING * fastest { reached } else { 0.0 };
        let way = 0.5 * (speed + end) * duration;
        since += way;
        let border = match end == 0.0 && speed > 0.0 {
            true => border_at(lengths.get(place..).unwrap_or_default(), left, way, near * since),
            false => None,
        };
        let border = border.map(|further| place + further);
        // Up to the borders of segments within the piece, and of those that are at its ends but for rounding up to there.
        while place < border.unwrap_or(last) {
            let after = (speed * speed + 2.0 * acceleration * left).sqrt();
            let time = if left > 0.0 { 2.0 * left / (speed + after) } else { 0.0 };
            if after.is_nan() || time.is_nan() || time > duration - short {
                break;
            }
            let (time, after, over) = if time > short { (time, after, 0.0) } else { (0.0, speed, left) };
            if time > 0.0 {
                parts[place].push(SegmentPhase { duration: time, before: speed, after });
            }
            (duration, speed, place) = (duration - time, after, place + 1);
            left = lengths[place] + over;
        }
        if let Some(parts) = parts.get_mut(place) {
            parts.push(SegmentPhase { duration, before: speed, after: end });
        }
        left -= 0.5 * (speed + end) * duration;
        speed = end;
        if end == 0.0 {
            fastest = 0.0;
        }
        if let Some(border) = border {
            (place, since) = (border + 1, 0.0);
            left = lengths[place];
        }
    }
    parts
}

/// The first of these segments whose end is within `near` of a stop after `way`. `left` is the remaining length of the first
/// segment. `None` at the end of the last one.
fn border_at(lengths: &[f64], left: f64, way: f64, near: f64) -> Option<usize> {
    let mut border = left;
    for (k, pair) in lengths.windows(2).enumerate() {
        let next = lengths.iter().skip(k + 1).copied().find(|length| *length > 0.0).unwrap_or(f64::INFINITY);
        if (border - way).abs() <= near.min(BESIDE * pair[0].min(next)) {
            return Some(k);
        }
        border += pair[1];
        if border > way + near {
            return None;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use crate::scenario::Scenario;

    #[test]
    fn stretches_follow_one_another() {
        let text = r#"{ "agents": [ { "id": 1, "radius": 0.2, "start": { "x": 1, "y": 2, "heading": 0.5 }, "t_start": 3,
            "path": [ { "kind": "line", "length": 2 }, { "kind": "arc", "radius": 1, "sweep": 1.5 }, { "kind": "line", "length": 0.5 } ],
            "profile": { "v0": 0, "pieces": [ { "duration": 2, "accel": 1 }, { "duration": 2, "accel": -1 },
                { "duration": 5, "accel": 0 } ] } } ] }"#;
        let whole = &Scenario::from_json(text).unwrap().agents[0];
        let [(a, from), (b, to)] =
            [whole.stretch(0, 0), whole.stretch(1, 2)].map(|stretch| (stretch.agent, stretch.from));
        assert_eq!((from, to, a.t_start), (0.0, 2.0, 3.0));
        assert!((a.length() + b.length() - whole.length()).abs() < 1e-15);
        assert!((a.t_start + a.duration() - b.t_start).abs() < 1e-12);
        assert!((b.t_start + b.duration() - (whole.t_start + whole.duration())).abs() < 1e-12);
        assert!((b.start[0] - (1.0 + 2.0 * 0.5_f64.cos())).abs() < 1e-15 && b.start[2] == 0.5);
    }
}
