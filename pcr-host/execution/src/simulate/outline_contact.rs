//! Collisions of outlines on the true poses: they move and turn uniformly from frame to frame. It shares nothing with any plan: the
//! distance of two polygons, at as many times as its change allows.

use super::frame_contact::{FrameContact, ROUNDING};
use super::vector::{PlaneVector, dot, norm, sub};
use pcr_planning::fleet::ConvexBody;
use std::f64::consts::{PI, TAU};

/// A body, and its poses at the frames.
#[derive(Clone, Debug)]
pub(super) struct BodyTrack<'t> {
    corners: Vec<PlaneVector>,
    radius: f64,
    reach: f64,
    positions: &'t [PlaneVector],
    headings: &'t [f64],
}

impl<'t> BodyTrack<'t> {
    pub(super) fn new(body: &ConvexBody, positions: &'t [PlaneVector], headings: &'t [f64]) -> Self {
        let (corners, radius) = body.corners();
        Self { corners, radius, reach: body.reach(), positions, headings }
    }

    pub(super) fn is_disc(&self) -> bool {
        self.corners.len() == 1
    }

    /// Corners at a time between a frame and the next one, of which `share` is over.
    fn placed(&self, frame: usize, share: f64) -> Vec<PlaneVector> {
        let [from, to] = [frame, frame + 1].map(|frame| self.positions[frame.min(self.positions.len() - 1)]);
        let [begin, end] = [frame, frame + 1].map(|frame| self.headings[frame.min(self.headings.len() - 1)]);
        let heading = begin + share * turned(begin, end);
        let (sin, cos) = heading.sin_cos();
        let at = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
        let turned = |[x, y]: &PlaneVector| [at[0] + x * cos - y * sin, at[1] + x * sin + y * cos];
        self.corners.iter().map(turned).collect()
    }

    /// Its way in a frame \[m\], and how far a point of it moves by its turn at most \[m\].
    fn way(&self, frame: usize) -> (PlaneVector, f64) {
        let next = frame + 1;
        let turn = turned(self.headings[frame], self.headings[next]);
        (sub(self.positions[next], self.positions[frame]), self.reach * turn.abs())
    }
}

fn turned(from: f64, to: f64) -> f64 {
    (to - from + PI).rem_euclid(TAU) - PI
}

/// The contacts of two tracks, those in successive frames as one, and the least distance of the bodies \[m\].
pub(super) fn meetings(first: &BodyTrack<'_>, second: &BodyTrack<'_>) -> (Vec<FrameContact>, f64) {
    let (mut contacts, mut nearest): (Vec<FrameContact>, f64) = (Vec::new(), f64::INFINITY);
    let radius = first.radius + second.radius;
    for frame in 0..first.positions.len().min(second.positions.len()).saturating_sub(1) {
        // What is farther than the least distance so far, and no contact, is not looked at again.
        let apart = norm(sub(first.positions[frame], second.positions[frame])) - first.reach - second.reach;
        // The distance changes by no more than one moves as seen from the other, and by both turns.
        let ((own, turn), (other, its)) = (first.way(frame), second.way(frame));
        let way = norm(sub(own, other)) + turn + its;
        if apart - way > nearest.max(0.0) {
            continue;
        }
        let at = |share: f64| separation(&first.placed(frame, share), &second.placed(frame, share)) - radius;
        let least = least(&at, way, nearest);
        nearest = nearest.min(least);
        if -least <= ROUNDING {
            continue;
        }
        match contacts.last_mut() {
            Some(last) if last.frames[1] == frame => {
                *last = FrameContact { frames: [last.frames[0], frame + 1], depth: last.depth.max(-least) };
            }
            _ => contacts.push(FrameContact { frames: [frame, frame + 1], depth: -least }),
        }
    }
    (contacts, nearest)
}

/// The least distance in a frame, in which it changes by at most `way` \[m\], if it is below `bound` or 0.
fn least(at: &dyn Fn(f64) -> f64, way: f64, bound: f64) -> f64 {
    let ends = [at(0.0), at(1.0)];
    let mut best = ends[0].min(ends[1]);
    let mut open = vec![([0.0, 1.0], ends)];
    while let Some(([from, to], [a, b])) = open.pop() {
        let change = way * (to - from);
        let lower = 0.5 * (a + b - change);
        // Distance and depth are found to a micrometre, and whether there is a contact as exactly as rounding allows.
        let is_decided = best < -ROUNDING || lower >= -ROUNDING;
        if lower >= best - if is_decided { 1e-6 } else { 0.5 * ROUNDING } || lower > bound.max(0.0) {
            continue;
        }
        let middle = 0.5 * (from + to);
        let here = at(middle);
        best = best.min(here);
        open.extend([([from, middle], [a, here]), ([middle, to], [here, b])]);
    }
    best
}

/// Distance of two convex polygons \[m\]; below 0 where they overlap, by the least translation that parts them.
fn separation(first: &[PlaneVector], second: &[PlaneVector]) -> f64 {
    let gap = [(first, second), (second, first)].map(|(own, other)| widest_gap(own, other));
    let gap = gap[0].max(gap[1]);
    if f64::NEG_INFINITY < gap && gap < 0.0 {
        return gap;
    }
    let near = [(first, second), (second, first)].map(|(own, other)| {
        let sides = || own.iter().zip(own.iter().cycle().skip(1));
        other
            .iter()
            .flat_map(|&point| sides().map(move |(a, b)| from_side(point, *a, *b)))
            .fold(f64::INFINITY, f64::min)
    });
    near[0].min(near[1])
}

/// The largest gap between two polygons along the normals of the sides of the first \[m\].
fn widest_gap(own: &[PlaneVector], other: &[PlaneVector]) -> f64 {
    let sides = own.iter().zip(own.iter().cycle().skip(1));
    let gap = |(a, b): (&PlaneVector, &PlaneVector)| {
        let side = sub(*b, *a);
        let length = norm(side);
        if length <= 0.0 {
            return f64::NEG_INFINITY;
        }
        let outward = [side[1] / length, -side[0] / length];
        other.iter().map(|&point| dot(sub(point, *a), outward)).fold(f64::INFINITY, f64::min)
    };
    // A single corner has no sides: the distance tells all.
    if own.len() < 3 { f64::NEG_INFINITY } else { sides.map(gap).fold(f64::NEG_INFINITY, f64::max) }
}

fn from_side(point: PlaneVector, a: PlaneVector, b: PlaneVector) -> f64 {
    let (side, away) = (sub(b, a), sub(point, a));
    let squared = dot(side, side);
    let share = if squared > 0.0 { (dot(away, side) / squared).clamp(0.0, 1.0) } else { 0.0 };
    norm(sub(away, [share * side[0], share * side[1]]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_formats::footprint::Footprint;

    fn rectangle(half: [f64; 2]) -> ConvexBody {
        let corners = [[1, 1], [-1, 1], [-1, -1], [1, -1]];
        let corners = corners.map(|sides| [0, 1].map(|k| half[k] * f64::from(sides[k])));
        let footprint = Footprint::new(corners.to_vec()).expect("a footprint");
        ConvexBody::of_vehicle(Some(&footprint), 0.0).expect("a body")
    }

    #[test]
    fn the_least_distance_is_found_within_a_frame() {
        let (long, square) = (rectangle([0.6, 0.2]), rectangle([0.1, 0.1]));
        // It turns by a right angle beside the other one, which its corner passes at 45° or so.
        let (still, headings) = ([[0.0, 0.0], [0.0, 0.0]], [0.0, 0.5 * PI]);
        for x in [0.6, 0.72, 0.74, 0.8] {
            let (there, none) = ([[x, 0.0], [x, 0.0]], [0.0, 0.0]);
            let tracks = [BodyTrack::new(&long, &still, &headings), BodyTrack::new(&square, &there, &none)];
            let (contacts, nearest) = meetings(&tracks[0], &tracks[1]);
            let sampled = (0..=100_000).map(|k| {
                let share = f64::from(k) / 100_000.0;
                separation(&tracks[0].placed(0, share), &tracks[1].placed(0, share))
            });
            let sampled = sampled.fold(f64::INFINITY, f64::min);
            assert!(nearest <= sampled + 1e-12 && nearest >= sampled - 2e-5, "{x}: {nearest} {sampled}");
            assert_eq!(contacts.is_empty(), sampled > 0.0, "{x}");
        }
    }

    #[test]
    fn discs_are_bodies_with_one_corner() {
        let (disc, long) = (ConvexBody::Disc(0.3), rectangle([0.6, 0.2]));
        let (a, b, none) = ([[0.0, 1.0], [0.0, 0.6]], [[0.0, 0.0]; 2], [0.0; 2]);
        let (contacts, nearest) = meetings(&BodyTrack::new(&disc, &a, &none), &BodyTrack::new(&long, &b, &none));
        assert!(contacts.is_empty() && (nearest - 0.1).abs() < 1e-9, "{nearest}");
        let a = [[0.0, 1.0], [0.0, 0.4]];
        let (contacts, nearest) = meetings(&BodyTrack::new(&disc, &a, &none), &BodyTrack::new(&disc, &b, &none));
        assert!((nearest + 0.2).abs() < 1e-9 && (contacts[0].depth - 0.2).abs() < 2e-6, "{nearest}");
    }
}
