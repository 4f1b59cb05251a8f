//! Outlines that change along the path, because a vehicle carries a load on some of its segments.

use super::Agent;
use crate::footprint::Footprint;

/// Another outline on some segments of a path.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadOutline {
    /// First and last segment (from 0) with it.
    pub segments: [usize; 2],
    /// Radius of the disc \[m\]; with a footprint that of the disc around all of it.
    pub radius: f64,
    /// The outline, if it is no disc.
    pub footprint: Option<Footprint>,
}

/// The outline on a stretch of the path.
#[derive(Clone, Copy, Debug)]
pub struct SpanOutline<'a> {
    pub segments: [usize; 2],
    pub radius: f64,
    pub footprint: Option<&'a Footprint>,
}

impl Agent {
    /// Radius of the disc around all outlines \[m\].
    pub fn circumscribed_radius(&self) -> f64 {
        self.loads.iter().map(|load| load.radius).fold(self.radius, f64::max)
    }

    /// Whether it is more than one convex outline: its outline is concave or has too many corners, or it has loads.
    pub fn has_parts(&self) -> bool {
        !self.loads.is_empty() || self.footprint.as_ref().is_some_and(|footprint| footprint.parts().nth(1).is_some())
    }

    /// The outlines on all stretches of the path, one after the other.
    pub fn outlines(&self) -> Vec<SpanOutline<'_>> {
        let last = self.path.len().saturating_sub(1);
        let own = |first: usize, last: usize| SpanOutline {
            segments: [first, last],
            radius: self.radius,
            footprint: self.footprint.as_ref(),
        };
        let (mut outlines, mut next) = (Vec::new(), 0);
        for LoadOutline { segments, radius, footprint } in &self.loads {
            if let Some(before) = segments[0].checked_sub(1).filter(|before| *before >= next) {
                outlines.push(own(next, before));
            }
            outlines.push(SpanOutline { segments: *segments, radius: *radius, footprint: footprint.as_ref() });
            next = segments[1] + 1;
        }
        if next <= last {
            outlines.push(own(next, last));
        }
        outlines
    }
}
