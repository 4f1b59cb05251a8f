//! The motion of an agent on each of its segments, and the agent on a range of its segments.

use super::{Agent, MotionSpec, PathSegment, PlacedSegment};

/// Length and speed that are rounding and nothing else, relative.
const NOTHING: f64 = 1e-12;

/// Time that is rounding and nothing else, relative.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Share of the segments beside a border within which a stop may be off it by rounding. A turn in place is some
/// nanometres long, on which a long way before it may be off by more than any fixed share of a millionth.
const BESIDE: f64 = 0.25;

/// Constant acceleration on one segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentPhase {
    /// \[s\]
    pub duration: f64,
    /// Speed at its beginning \[m/s\].
    pub before: f64,
    /// Speed at its end \[m/s\].
    pub after: f64,
}

impl SegmentPhase {
    /// \[m/s²\]
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
    /// A stop within rounding of a segment border, on either side, counts as at the border. Near a stop a tiny error of the length is a
    /// large error of the time, and a segment of a nanometre is a turn in place.
    pub fn parts(&self) -> Vec<Vec<SegmentPhase>> {
        let (v0, pieces) = self.motion.pieces(self.length());
        let mut parts = vec![Vec::new(); self.path.len()];
        let lengths: Vec<f64> = self.path.iter().map(PathSegment::length).collect();
        let last = lengths.len().saturating_sub(1);
        let (mut place, mut left, mut speed) = (0, lengths.first().copied().unwrap_or(0.0), v0);
        // Times that are rounding: a part as short would have any acceleration.
        let short = ROUNDING * pieces.iter().map(|(duration, _)| duration).sum::<f64>();
        // Largest speed since the last stop, and length since the last one at a border.
        let (mut fastest, mut since) = (v0, 0.0);
        for (mut duration, acceleration) in pieces {
            let reached = speed + acceleration * duration;
            fastest = f64::max(fastest, reached);
            let end = if reached > NOTHING * fastest { reached } else { 0.0 };
            let way = 0.5 * (speed + end) * duration;
            since += way;
            let border = match end == 0.0 && speed > 0.0 {
                true => border_at(lengths.get(place..).unwrap_or_default(), left, way, NOTHING * since),
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
            end.extend(after.into_iter().flatten().take_while(|part| part.before == 0.0 && part.after == 0.0));
        }
        let ([x, y], heading) = (reached.end(), reached.heading_at_end());
        let all = own.iter().flatten();
        let agent = Self {
            t_start: self.t_start + until,
            start: [x, y, heading],
            path: self.path.iter().take(last + 1).skip(first).copied().collect(),
            motion: MotionSpec::Profile {
                v0: all.clone().next().map_or(0.0, |part| part.before),
                pieces: all.map(|part| (part.duration, part.acceleration())).collect(),
            },
            ..self.clone()
        };
        AgentPart { agent, parts: own, from: before.map(PathSegment::length).sum() }
    }
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
