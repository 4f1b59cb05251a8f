//! Discs in motion as plain numbers, from which every method except pcr starts. This module shares no code with
//! pcr-core.

use pcr_formats::scenario::{Agent, PathSegment};

/// A point \[m\].
pub type Xy = [f64; 2];

/// A disc on its way.
#[derive(Clone, Debug)]
pub struct DiscTrack {
    /// \[m\]
    pub radius: f64,
    ways: Vec<TrackSegment>,
    phases: Vec<TrackPhase>,
    /// From setting off to arrival \[s\].
    pub time: [f64; 2],
    /// Of the path \[m\].
    pub length: f64,
}

/// A line or an arc.
#[derive(Clone, Copy, Debug)]
pub struct TrackSegment {
    /// Travelled before \[m\].
    pub from: f64,
    /// \[m\]
    pub length: f64,
    /// Its first point.
    pub start: Xy,
    /// Heading at its start, as a unit vector.
    pub direction: Xy,
    /// Left positive \[1/m\].
    pub curvature: f64,
}

/// Constant acceleration.
#[derive(Clone, Copy, Debug)]
pub struct TrackPhase {
    /// \[s\]
    pub begin: f64,
    /// \[s\]
    pub duration: f64,
    /// Travelled before \[m\].
    pub from: f64,
    /// At its begin \[m/s\].
    pub speed: f64,
    /// \[m/s²\]
    pub acceleration: f64,
}

impl TrackSegment {
    fn new(from: f64, length: f64, start: Xy, heading: f64, curvature: f64) -> Self {
        let (sin, cos) = heading.sin_cos();
        Self { from, length, start, direction: [cos, sin], curvature }
    }

    /// Position at a length from its start \[m\], by the chord.
    pub fn at(&self, length: f64) -> Xy {
        let [x, y] = self.direction;
        let half = 0.5 * self.curvature * length;
        let [along, across] = if half == 0.0 {
            [length, 0.0]
        } else {
            let (sin, cos) = half.sin_cos();
            let chord = length * sin / half;
            [chord * cos, chord * sin]
        };
        [self.start[0] + along * x - across * y, self.start[1] + along * y + across * x]
    }
}

impl TrackPhase {
    /// Length travelled at a time \[m\].
    pub fn length_at(&self, time: f64) -> f64 {
        let elapsed = (time - self.begin).clamp(0.0, self.duration);
        self.from + elapsed * (self.speed + 0.5 * self.acceleration * elapsed)
    }

    /// When a length is reached \[s\], by the root that loses no digits.
    fn time_at(&self, length: f64) -> f64 {
        let ahead = (length - self.from).max(0.0);
        let reached = (self.speed * self.speed + 2.0 * self.acceleration * ahead).max(0.0).sqrt();
        let elapsed = if ahead > 0.0 { 2.0 * ahead / (self.speed + reached) } else { 0.0 };
        self.begin + elapsed.clamp(0.0, self.duration)
    }

    /// Returns when it ends \[s\].
    pub fn end(&self) -> f64 {
        self.begin + self.duration
    }

    /// Returns its largest speed \[m/s\].
    pub fn top_speed(&self) -> f64 {
        self.speed.max(self.speed + self.acceleration * self.duration)
    }
}

impl DiscTrack {
    /// The motion of an agent of a scenario; footprint and loads count as the disc around all of them.
    pub fn new(agent: &Agent) -> Self {
        let [x, y, mut heading] = agent.start;
        let (mut start, mut from) = ([x, y], 0.0);
        let mut ways = Vec::new();
        for segment in &agent.path {
            let (length, curvature) = match *segment {
                PathSegment::Line { length } => (length, 0.0),
                PathSegment::Arc { radius, sweep, .. } => (radius * sweep.abs(), sweep.signum() / radius),
                PathSegment::Turn { sweep } | PathSegment::Kink { sweep } => {
                    heading += sweep;
                    continue;
                }
                PathSegment::Facing { before, after } => {
                    heading += before - after;
                    continue;
                }
            };
            if length > 0.0 {
                let way = TrackSegment::new(from, length, start, heading, curvature);
                ways.push(way);
                (start, heading, from) = (way.at(length), heading + curvature * length, from + length);
            }
        }
        if ways.is_empty() {
            ways.push(TrackSegment::new(from, 0.0, start, heading, 0.0));
        }
        let phases = phases(agent, from);
        let end = phases.last().map_or(agent.t_start, TrackPhase::end);
        Self { radius: agent.circumscribed_radius(), ways, phases, time: [agent.t_start, end], length: from }
    }

    /// Returns the lines and arcs of the path.
    pub fn ways(&self) -> &[TrackSegment] {
        &self.ways
    }

    /// Returns the phases of constant acceleration.
    pub fn phases(&self) -> &[TrackPhase] {
        &self.phases
    }

    /// The way on which a length lies.
    pub fn way_at(&self, length: f64) -> &TrackSegment {
        let after = self.ways.partition_point(|way| way.from <= length).max(1);
        &self.ways[after - 1]
    }

    /// Position at a travelled length \[m\].
    pub fn at(&self, length: f64) -> Xy {
        let way = self.way_at(length);
        way.at((length - way.from).min(way.length))
    }

    /// Length travelled at a time \[m\].
    pub fn length_at(&self, time: f64) -> f64 {
        let after = self.phases.partition_point(|phase| phase.begin <= time);
        let phase = after.checked_sub(1).and_then(|place| self.phases.get(place));
        phase.map_or(0.0, |phase| phase.length_at(time)).clamp(0.0, self.length)
    }

    /// Position at a time.
    pub fn position(&self, time: f64) -> Xy {
        self.at(self.length_at(time))
    }

    /// When a length is first reached \[s\].
    pub fn time_at(&self, length: f64) -> f64 {
        let after = self.phases.partition_point(|phase| phase.from < length);
        let phase = after.checked_sub(1).and_then(|place| self.phases.get(place));
        phase.map_or(self.time[0], |phase| phase.time_at(length))
    }

    /// \[m/s\]
    pub fn top_speed(&self) -> f64 {
        self.phases.iter().map(TrackPhase::top_speed).fold(0.0, f64::max)
    }

    /// Left, bottom, right and top of a box around the path \[m\]: with the sagitta of arcs on all sides.
    pub fn bounds(&self) -> [f64; 4] {
        let mut bounds = EMPTY;
        for way in &self.ways {
            /// Chords that an arc is divided into.
            const CHORDS: usize = 8;
            let parts = if way.curvature == 0.0 { 1 } else { CHORDS };
            let chord = way.length / parts as f64;
            let sagitta = 0.125 * way.curvature.abs() * chord * chord;
            for k in 0..=parts {
                bounds = hull(bounds, way.at(chord * k as f64), sagitta);
            }
        }
        bounds
    }
}

/// No box.
pub const EMPTY: [f64; 4] = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];

/// The box, with a square around a point.
pub fn hull(bounds: [f64; 4], [x, y]: Xy, half: f64) -> [f64; 4] {
    let [left, bottom, right, top] = bounds;
    [left.min(x - half), bottom.min(y - half), right.max(x + half), top.max(y + half)]
}

/// Whether two boxes come within `reach` of one another.
pub fn near(a: [f64; 4], b: [f64; 4], reach: f64) -> bool {
    a[0] - reach <= b[2] && b[0] - reach <= a[2] && a[1] - reach <= b[3] && b[1] - reach <= a[3]
}

/// The phases of an agent, lengths scaled onto that of its path.
fn phases(agent: &Agent, length: f64) -> Vec<TrackPhase> {
    let (v0, pieces) = agent.motion.pieces(length);
    let (mut begin, mut from, mut speed) = (agent.t_start, 0.0, v0);
    let mut phases = Vec::new();
    for (duration, acceleration) in pieces {
        let phase = TrackPhase { begin, duration, from, speed, acceleration };
        phases.push(phase);
        (begin, from) = (phase.end(), phase.length_at(f64::INFINITY));
        speed = (speed + acceleration * duration).max(0.0);
    }
    if from > 0.0 && length > 0.0 {
        let scale = length / from;
        for phase in &mut phases {
            (phase.from, phase.speed) = (phase.from * scale, phase.speed * scale);
            phase.acceleration *= scale;
        }
    }
    phases
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_formats::scenario::Scenario;

    #[test]
    fn a_load_makes_the_disc_larger() {
        let text = r#"{ "agents": [ { "id": 1, "radius": 0.2, "v_max": 1, "a_max": 1, "start": { "x": 0, "y": 0, "heading": 0 },
            "path": [ { "kind": "line", "length": 2 }, { "kind": "line", "length": 2 } ],
            "loads": [ { "segments": [2, 2], "radius": 0.6 } ] } ] }"#;
        let scenario = Scenario::from_json(text).unwrap();
        assert_eq!(DiscTrack::new(&scenario.agents[0]).radius, 0.6);
    }
}
