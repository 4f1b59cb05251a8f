//! Collisions on the true positions: exact for discs that move uniformly from frame to frame, and independent of any
//! plan.

use super::vector::{PlaneVector, add, dot, norm, scale, sub};

/// Overlaps up to this depth \[m\] are rounding.
pub(super) const ROUNDING: f64 = 1e-9;

/// Two discs in contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FrameContact {
    /// First and last frame.
    pub(super) frames: [usize; 2],
    /// Largest overlap \[m\].
    pub(super) depth: f64,
}

/// The contacts of two tracks (one position per frame) for a sum of radii \[m\]; contacts in successive frames are one.
pub(super) fn contacts(first: &[PlaneVector], second: &[PlaneVector], radius: f64) -> Vec<FrameContact> {
    let apart: Vec<PlaneVector> = first.iter().zip(second).map(|(a, b)| sub(*b, *a)).collect();
    let mut contacts: Vec<FrameContact> = Vec::new();
    for (frame, pair) in apart.windows(2).enumerate() {
        let depth = radius - nearest(pair[0], pair[1]);
        if depth <= ROUNDING {
            continue;
        }
        match contacts.last_mut() {
            Some(last) if last.frames[1] == frame => {
                *last = FrameContact { frames: [last.frames[0], frame + 1], depth: last.depth.max(depth) };
            }
            _ => contacts.push(FrameContact { frames: [frame, frame + 1], depth }),
        }
    }
    contacts
}

/// The least distance of two tracks \[m\].
pub(super) fn separation(first: &[PlaneVector], second: &[PlaneVector]) -> f64 {
    let apart: Vec<PlaneVector> = first.iter().zip(second).map(|(a, b)| sub(*b, *a)).collect();
    apart.windows(2).map(|pair| nearest(pair[0], pair[1])).fold(f64::INFINITY, f64::min)
}

/// The least distance from the origin to a straight line between two points.
fn nearest(from: PlaneVector, to: PlaneVector) -> f64 {
    let way = sub(to, from);
    let squared = dot(way, way);
    let part = if squared > 0.0 { (-dot(from, way) / squared).clamp(0.0, 1.0) } else { 0.0 };
    norm(add(from, scale(way, part)))
}
