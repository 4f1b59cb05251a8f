//! Where an agent may be between two poses.
//!
//! On the straight line at constant speed u it would be at n(t), a part λ = τ / T of the way, with τ the time since the first pose and T the
//! time between both. With a top speed v it is within v τ of the first pose a and within v (T − τ) of the second pose b. For any such place
//! p, by Stewart's theorem,
//!
//! ```text
//! |p − n|² = (1 − λ) |p − a|² + λ |p − b|² − λ (1 − λ) |b − a|² ≤ (v² − u²) τ (T − τ)
//! ```
//!
//! and by the triangle inequality |p − n| ≤ (v + u) τ and (v + u) (T − τ). The least of these three bounds is attained, so it is the radius of
//! the least disc around n that contains all places. It grows up to the middle of the time, and is symmetric about it.
//!
//! Where headings count, it would turn steadily by the shorter way, at a rate u. With a greatest rate w, its heading differs from that of the
//! first pose by w τ at most, and so from the steady one by (w + |u|) τ; likewise before the second pose. An angle moves no point of a body
//! farther than by that angle times its distance from the reference point.

use pcr_formats::import::{BetweenPoses, PoseTrack, TimedPose};
use pcr_formats::plane_geometry::distance;
use std::f64::consts::{PI, TAU};

/// An agent between two poses, or at one.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoundedLeg {
    /// \[s\]
    pub(super) t: [f64; 2],
    pub(super) ends: [[f64; 2]; 2],
    pub(super) map: usize,
    /// By how much it may be off at all times \[m\].
    constant: f64,
    /// v² − u², and v + u; both 0 where it goes straight. From above.
    speeds: [f64; 2],
    /// Heading at both ends of the steady turn \[rad\]; 0 where headings do not count.
    headings: [f64; 2],
    /// w + |u|, from above \[rad/s\]; 0 where it turns steadily.
    turning: f64,
}

/// What a few roundings add to a number.
const FEW: f64 = 8.0 * f64::EPSILON;

impl BoundedLeg {
    /// An agent that stands.
    pub(super) fn standing(pose: &TimedPose, t: [f64; 2], between: BetweenPoses) -> Self {
        let constant = pose.error + deviation(between);
        let headings = [pose.heading.unwrap_or_default(); 2];
        Self { t, ends: [pose.point; 2], map: pose.map, constant, speeds: [0.0; 2], headings, turning: 0.0 }
    }

    /// An agent between two poses.
    fn between(a: &TimedPose, b: &TimedPose, between: BetweenPoses) -> Self {
        let error = a.error.max(b.error);
        let speeds = match between {
            BetweenPoses::Straight(_) => [0.0; 2],
            BetweenPoses::TopSpeed { speed: top, .. } => {
                let duration = b.t - a.t;
                let length = distance(a.point, b.point);
                // With errors of the poses, the straight way may be shorter or longer than that between the points.
                let [least, most] = [length - a.error - b.error, length + a.error + b.error];
                let [least, most] = [least.max(0.0) * (1.0 - FEW), most.min(top * duration) * (1.0 + FEW)];
                let [least, most] = [least, most].map(|length| length / duration);
                // Rounding of v² and u² where they are nearly the same.
                let rounding = FEW * top * top;
                [(top * top - least * least).max(0.0) + rounding, (top + most) * (1.0 + FEW)]
            }
        };
        let constant = (error + deviation(between)) * (1.0 + FEW);
        let [from, to] = [a, b].map(|pose| pose.heading.unwrap_or_default());
        let turn = to - from;
        let turn = turn - TAU * (turn / TAU).round();
        let turning = match between {
            BetweenPoses::Straight(_) => 0.0,
            BetweenPoses::TopSpeed { rotation, .. } => (rotation + turn.abs() / (b.t - a.t)) * (1.0 + FEW),
        };
        let headings = [from, from + turn];
        Self { t: [a.t, b.t], ends: [a.point, b.point], map: a.map, constant, speeds, headings, turning }
    }

    /// The legs of an agent in the order of time; before the first pose and after the last one it stands where the record says so.
    pub(super) fn all(track: &PoseTrack, between: BetweenPoses, stands: Option<[f64; 2]>) -> Vec<Self> {
        let (Some(first), Some(last)) = (track.poses.first(), track.poses.last()) else { return Vec::new() };
        let mut legs = Vec::with_capacity(track.poses.len() + 2);
        if let Some([begin, _]) = stands.filter(|span| span[0] < first.t) {
            legs.push(Self::standing(first, [begin, first.t], between));
        }
        let is_alone = |k: usize| {
            let next = track.poses.get(k + 1).is_none_or(|next| !next.is_joined);
            next && (k == 0 || !track.poses[k].is_joined)
        };
        for (k, pose) in track.poses.iter().enumerate() {
            match track.poses.get(k + 1).filter(|next| next.is_joined) {
                Some(next) => legs.push(Self::between(pose, next, between)),
                // What is known at one time only is compared with others at that time.
                None if is_alone(k) => legs.push(Self::standing(pose, [pose.t; 2], between)),
                None => {}
            }
        }
        if let Some([_, end]) = stands.filter(|span| span[1] > last.t) {
            legs.push(Self::standing(last, [last.t, end], between));
        }
        legs
    }

    /// Where it would be on the straight line at constant speed; to within [`BoundedLeg::rounding`] on each axis.
    pub(super) fn position_at(&self, t: f64) -> [f64; 2] {
        let [a, b] = self.ends;
        if t <= self.t[0] || a == b {
            return a;
        }
        if t >= self.t[1] {
            return b;
        }
        let part = (t - self.t[0]) / (self.t[1] - self.t[0]);
        [0, 1].map(|axis| a[axis] + (b[axis] - a[axis]) * part)
    }

    /// Which way it would face, turning steadily \[rad\].
    pub(super) fn heading_at(&self, t: f64) -> f64 {
        let [from, to] = self.headings;
        if from == to {
            return from;
        }
        from + (to - from) * ((t - self.t[0]) / (self.t[1] - self.t[0])).clamp(0.0, 1.0)
    }

    /// How fast it would turn \[rad/s\], from above.
    pub(super) fn turning_rate(&self) -> f64 {
        let [from, to] = self.headings;
        if from == to { 0.0 } else { (to - from).abs() / (self.t[1] - self.t[0]) * (1.0 + FEW) }
    }

    /// How far it may be turned from that \[rad\]: the most and the least in a time. Half a turn is any heading.
    pub(super) fn turns(&self, [s, e]: [f64; 2]) -> [f64; 2] {
        let at = |t: f64| (self.turning * (t - self.t[0]).min(self.t[1] - t).max(0.0) * (1.0 + FEW)).min(PI);
        let middle = self.t[0] + 0.5 * (self.t[1] - self.t[0]);
        let [first, last] = [s, e].map(at);
        [at(middle.clamp(s, e)).max(first).max(last), first.min(last)]
    }

    /// Rounding error of a position on each axis \[m\]: seven roundings, each of at most half of a machine epsilon of both ends.
    pub(super) fn rounding(&self) -> f64 {
        let [a, b] = self.ends;
        4.0 * f64::EPSILON * [a[0], a[1], b[0], b[1]].iter().map(|value| value.abs()).sum::<f64>()
    }

    /// How far it may be from that line at a time \[m\], from above.
    pub(super) fn deviation_at(&self, t: f64) -> f64 {
        let [squares, sum] = self.speeds;
        if sum == 0.0 {
            return self.constant;
        }
        let [since, until] = [(t - self.t[0]).max(0.0), (self.t[1] - t).max(0.0)];
        let ellipse = (squares * since * until).sqrt();
        (ellipse.min(sum * since.min(until)) + self.constant) * (1.0 + FEW)
    }

    /// The most and the least of that in a time \[m\].
    pub(super) fn deviations([s, e]: [f64; 2], leg: &Self) -> [f64; 2] {
        if leg.speeds[1] == 0.0 {
            return [leg.constant; 2];
        }
        let middle = leg.t[0] + 0.5 * (leg.t[1] - leg.t[0]);
        let [first, last] = [s, e].map(|t| leg.deviation_at(t));
        let most = leg.deviation_at(middle.clamp(s, e)).max(first).max(last);
        // Half of a rounding of the middle may hide the very top.
        [most * (1.0 + FEW), first.min(last)]
    }

    /// How far it may be from that line at any time \[m\], from above.
    pub(super) fn most(&self) -> f64 {
        Self::deviations(self.t, self)[0]
    }
}

fn deviation(between: BetweenPoses) -> f64 {
    match between {
        BetweenPoses::Straight(deviation) => deviation,
        BetweenPoses::TopSpeed { .. } => 0.0,
    }
}
