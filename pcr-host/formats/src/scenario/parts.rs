//! The motion of an agent on each of its segments, and the agent on a range of its segments.

use super::{Agent, MotionSpec, PathSegment, Placed};

/// Length and speed that are rounding and nothing else, relative.
const NOTHING: f64 = 1e-12;

/// Constant acceleration on one segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// \[s\]
    pub duration: f64,
    /// Speed at its beginning \[m/s\].
    pub before: f64,
    /// Speed at its end \[m/s\].
    pub after: f64,
}

impl Part {
    /// \[m/s²\]
    pub fn acceleration(&self) -> f64 {
        if self.duration > 0.0 { (self.after - self.before) / self.duration } else { 0.0 }
    }
}

impl Agent {
    /// The motion on each segment of the path. A wait where two segments meet belongs to the later one.
    pub fn parts(&self) -> Vec<Vec<Part>> {
        let (v0, pieces) = self.motion.pieces(self.length());
        let mut parts = vec![Vec::new(); self.path.len()];
        let lengths: Vec<f64> = self.path.iter().map(PathSegment::length).collect();
        let near = NOTHING * (1.0 + self.length());
        let (mut place, mut left, mut speed) = (0, lengths.first().copied().unwrap_or(0.0), v0);
        let last = lengths.len().saturating_sub(1);
        for (mut duration, acceleration) in pieces {
            let end = (speed + acceleration * duration).max(0.0);
            // Up to the borders of segments within the piece.
            while place < last {
                let square = speed * speed + 2.0 * acceleration * left;
                let time = if left > 0.0 { 2.0 * left / (speed + square.max(0.0).sqrt()) } else { 0.0 };
                if square < 0.0 || time.is_nan() || time > duration {
                    break;
                }
                // What rounding leaves of a stop is no speed.
                let after = if square > NOTHING * speed * speed { square.sqrt() } else { 0.0 };
                parts[place].push(Part { duration: time, before: speed, after });
                (duration, speed, place) = (duration - time, after, place + 1);
                left = lengths[place];
            }
            if let Some(parts) = parts.get_mut(place) {
                parts.push(Part { duration, before: speed, after: end });
            }
            left -= 0.5 * (speed + end) * duration;
            speed = end;
            // A stop at a border is one.
            if place < last && left < near.min(1e-3 * lengths[place]) {
                place += 1;
                left = lengths[place];
            }
        }
        parts
    }

    /// The agent on its segments from `first` to `last` (from 0), and the length of the path before them \[m\]. It sets off
    /// when it reaches the first of them, and what it waits at the end of the last one belongs to it as well.
    pub fn stretch(&self, first: usize, last: usize) -> (Self, f64) {
        let [x, y, heading] = self.start;
        let stands = Placed { at: [x, y], heading, shape: PathSegment::Line { length: 0.0 } };
        let before = self.path.iter().take(first);
        let reached = before.clone().fold(stands, |last, &shape| Placed {
            at: last.end(),
            heading: last.heading_at_end(),
            shape,
        });
        let parts = self.parts();
        let until: f64 = parts.iter().take(first).flatten().map(|part| part.duration).sum();
        let own = parts.iter().take(last + 1).skip(first).flatten();
        let waits = parts.iter().skip(last + 1).flatten().take_while(|part| part.before == 0.0 && part.after == 0.0);
        let own: Vec<&Part> = own.chain(waits).collect();
        let ([x, y], heading) = (reached.end(), reached.heading_at_end());
        let agent = Self {
            t_start: self.t_start + until,
            start: [x, y, heading],
            path: self.path.iter().take(last + 1).skip(first).copied().collect(),
            motion: MotionSpec::Profile {
                v0: own.first().map_or(0.0, |part| part.before),
                pieces: own.iter().map(|part| (part.duration, part.acceleration())).collect(),
            },
            ..self.clone()
        };
        (agent, before.map(PathSegment::length).sum())
    }
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
        let [(a, from), (b, to)] = [whole.stretch(0, 0), whole.stretch(1, 2)];
        assert_eq!((from, to, a.t_start), (0.0, 2.0, 3.0));
        assert!((a.length() + b.length() - whole.length()).abs() < 1e-15);
        assert!((a.t_start + a.duration() - b.t_start).abs() < 1e-12);
        assert!((b.t_start + b.duration() - (whole.t_start + whole.duration())).abs() < 1e-12);
        assert!((b.start[0] - (1.0 + 2.0 * 0.5_f64.cos())).abs() < 1e-15 && b.start[2] == 0.5);
    }
}
