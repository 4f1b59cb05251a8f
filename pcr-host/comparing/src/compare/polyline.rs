//! Conservative polylines: paths are flattened and speeds made piecewise constant, so that no position is off by more
//! than a tolerance, and discs are enlarged by it; then each pair of discs on two lines is solved in closed form.
//! Planners for many agents that only support lines work like this.

use super::disc_track::{DiscTrack, EMPTY, Xy, hull, near};
use super::{CollisionMethod, ComparisonFleet, MethodAnswer, MethodContact, MethodQuestion, MethodResult};

/// With the largest distance from the path \[m\].
struct PolylineMethod {
    tolerance: f64,
}

pub(super) fn methods() -> Vec<Box<dyn CollisionMethod>> {
    [1e-3, 1e-2]
        .into_iter()
        .map(|tolerance| Box::new(PolylineMethod { tolerance }) as Box<dyn CollisionMethod>)
        .collect()
}

impl CollisionMethod for PolylineMethod {
    fn name(&self) -> String {
        format!("polyline {} mm", 1e3 * self.tolerance)
    }

    fn question(&self) -> MethodQuestion {
        MethodQuestion::Conflicts
    }

    fn output_description(&self) -> &'static str {
        "intervals, conservative"
    }

    fn answer<'f>(&self, field: &'f ComparisonFleet<'_>) -> MethodResult<'f> {
        let knots: Vec<Vec<VelocityKnot>> =
            field.tracks.iter().map(|track| knots(track, self.tolerance, field.horizon)).collect();
        // Between its knots a path is within the tolerance of the box, which the reach of a pair holds.
        let bound = |knots: &Vec<VelocityKnot>| knots.iter().fold(EMPTY, |bounds, knot| hull(bounds, knot.at, 0.0));
        let bounds: Vec<[f64; 4]> = knots.iter().map(bound).collect();
        let mut found = Vec::new();
        for (first, a) in field.tracks.iter().enumerate() {
            for (second, b) in field.tracks.iter().enumerate().skip(first + 1) {
                let reach = a.radius + b.radius + 2.0 * self.tolerance;
                if near(bounds[first], bounds[second], reach) {
                    contacts(&knots[first], &knots[second], reach, |begin, end| {
                        found.push(MethodContact { agents: [first, second], begin, end: Some(end) });
                    });
                }
            }
        }
        Ok(MethodAnswer::Conflicts(found))
    }
}

/// From here on with constant velocity.
#[derive(Clone, Copy, Debug)]
pub struct VelocityKnot {
    /// When \[s\].
    pub time: f64,
    /// Where.
    pub at: Xy,
    velocity: Xy,
}

/// The times at which a track is cut: where segments and phases begin, and between them so often that on none of the parts
/// acceleration and curvature (with `weight` 1, otherwise less) lead it away from its chord by more than the tolerance.
pub fn cuts(track: &DiscTrack, tolerance: f64, weight: f64) -> Vec<f64> {
    let mut borders: Vec<f64> = track.phases().iter().map(|phase| phase.begin).collect();
    borders.extend(track.ways().iter().map(|way| track.time_at(way.from)));
    borders.extend(track.time);
    borders.sort_by(f64::total_cmp);
    borders.dedup();
    let mut cuts = Vec::new();
    for pair in borders.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let middle = 0.5 * (from + to);
        let curvature = track.way_at(track.length_at(middle)).curvature.abs();
        let phase = track.phases().iter().rev().find(|phase| phase.begin <= middle);
        let (acceleration, speed) = phase.map_or((0.0, 0.0), |phase| (phase.acceleration.abs(), phase.top_speed()));
        let bend = acceleration + weight * curvature * speed * speed;
        let parts = ((to - from) * (bend / (8.0 * tolerance)).sqrt()).ceil().max(1.0);
        cuts.extend((0..parts as usize).map(|k| from + (to - from) * (k as f64 / parts)));
    }
    cuts.push(track.time[1]);
    cuts
}

/// A track as lines: no position is off by more than the tolerance.
pub fn knots(track: &DiscTrack, tolerance: f64, horizon: [f64; 2]) -> Vec<VelocityKnot> {
    let mut times = vec![horizon[0]];
    times.extend(cuts(track, tolerance, 1.0));
    times.push(horizon[1]);
    times.dedup();
    let points: Vec<Xy> = times.iter().map(|&time| track.position(time)).collect();
    let velocity = |k: usize| match (times.get(k + 1), points.get(k + 1)) {
        (Some(next), Some(to)) => [0, 1].map(|axis| (to[axis] - points[k][axis]) / (next - times[k])),
        _ => [0.0; 2],
    };
    (0..times.len()).map(|k| VelocityKnot { time: times[k], at: points[k], velocity: velocity(k) }).collect()
}

/// Hands over each contact, from begin to end.
fn contacts(a: &[VelocityKnot], b: &[VelocityKnot], reach: f64, mut take: impl FnMut(f64, f64)) {
    let mut open: Option<[f64; 2]> = None;
    let (mut i, mut j) = (0, 0);
    while i + 1 < a.len() && j + 1 < b.len() {
        let (from, to) = (a[i].time.max(b[j].time), a[i + 1].time.min(b[j + 1].time));
        if let Some([begin, end]) = contact_times(&a[i], &b[j], from, to, reach) {
            match &mut open {
                Some(last) if last[1] >= begin => last[1] = end,
                _ => {
                    if let Some([begin, end]) = open.replace([begin, end]) {
                        take(begin, end);
                    }
                }
            }
        }
        if a[i + 1].time <= to {
            i += 1;
        }
        if b[j + 1].time <= to {
            j += 1;
        }
    }
    if let Some([begin, end]) = open {
        take(begin, end);
    }
}

/// When two points on lines are within reach, between two times.
fn contact_times(a: &VelocityKnot, b: &VelocityKnot, from: f64, to: f64, reach: f64) -> Option<[f64; 2]> {
    let place = |knot: &VelocityKnot, axis: usize| knot.at[axis] + knot.velocity[axis] * (from - knot.time);
    let apart = [0, 1].map(|axis| place(a, axis) - place(b, axis));
    let speed = [0, 1].map(|axis| a.velocity[axis] - b.velocity[axis]);
    let dot = |p: Xy, q: Xy| p[0] * q[0] + p[1] * q[1];
    let (square, toward) = (dot(speed, speed), dot(apart, speed));
    let short = dot(apart, apart) - reach * reach;
    if square <= 0.0 {
        return (short <= 0.0).then_some([from, to]);
    }
    let discriminant = toward * toward - square * short;
    if discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    let (begin, end) = (from + (-toward - root) / square, from + (-toward + root) / square);
    let (begin, end) = (begin.max(from), end.min(to));
    (begin <= end).then_some([begin, end])
}
