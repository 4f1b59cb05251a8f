//! Times in which a contact is proved, or cannot be known, by bounds of a distance in any time.

/// Halves of halves of a time, after which it is not divided any more.
const DEEPEST: u32 = 60;

/// Relative rounding of a length.
const FEW: f64 = 8.0 * f64::EPSILON;

/// Bounds of the distance in a time.
pub(super) struct DistanceBounds {
    /// Least distance of the straight motions, from below \[m\].
    pub(super) near: f64,
    /// Largest one, from above \[m\].
    pub(super) far: f64,
    /// When it is least, as far as that is known \[s\].
    pub(super) t: f64,
    /// By how much both deviate at most and at least \[m\].
    pub(super) deviations: [f64; 2],
}

impl DistanceBounds {
    /// The least distance, whatever both did within their bounds, from below \[m\].
    pub(super) fn lower(&self) -> f64 {
        let lower = self.near - self.deviations[0];
        lower - FEW * (self.near.abs() + self.deviations[0])
    }
}

/// A time in which a contact is proved, or not known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct OpenSpan {
    pub(super) t: [f64; 2],
    pub(super) is_contact: bool,
    /// Bounds of the least distance of the centres in that time \[m\].
    pub(super) separation: [f64; 2],
    /// Bounds of the least distance of the bodies \[m\].
    pub(super) clearance: [f64; 2],
}

/// Bounds of a least distance.
#[derive(Clone, Copy, Debug)]
pub(super) struct LeastDistance {
    /// \[m\]
    pub(super) lower: f64,
    /// \[m\]
    pub(super) upper: f64,
    /// When the straight motions are nearest, how near \[s, m\], and on which map.
    pub(super) straight: (f64, f64),
    pub(super) map: usize,
    /// What the lower bound can become at most \[m\].
    pub(super) attained: f64,
}

impl LeastDistance {
    pub(super) const NONE: Self = Self {
        lower: f64::INFINITY,
        upper: f64::INFINITY,
        straight: (0.0, f64::INFINITY),
        map: 0,
        attained: f64::INFINITY,
    };

    /// Distance beyond which nothing is of interest \[m\].
    pub(super) fn farthest(&self) -> f64 {
        self.attained
    }
}

/// A distance of two agents, of which one each leg has bounds.
pub(super) trait BoundedDistance {
    /// Its bounds in a time.
    fn bounds(&self, time: [f64; 2]) -> DistanceBounds;

    /// Below which it is a contact, from below and from above \[m\].
    fn limit(&self) -> [f64; 2];

    /// Distances that differ by less are not told apart \[m\].
    fn tolerance(&self) -> f64;

    /// What is known of a time that is not divided any more.
    fn span(&self, time: [f64; 2], bounds: &DistanceBounds, is_contact: bool) -> OpenSpan;

    /// Adds the times in which a contact is not excluded, in their order.
    fn open_spans(&self, time: [f64; 2], spans: &mut Vec<OpenSpan>) {
        self.divide(time, 0, spans);
    }

    /// The same, of a part that is so many times half of a half.
    fn divide(&self, time: [f64; 2], depth: u32, spans: &mut Vec<OpenSpan>) {
        let bounds = self.bounds(time);
        let (near, far, [most, least]) = (bounds.near, bounds.far, bounds.deviations);
        let limit = self.limit();
        if bounds.lower() > limit[1] {
            return;
        }
        let is_contact = far + most + FEW * (far.abs() + most) < limit[0];
        let is_never_excluded = far - least <= limit[1] + self.tolerance();
        let is_never_proved = near + least >= limit[0] - self.tolerance();
        let middle = time[0] + 0.5 * (time[1] - time[0]);
        let is_short = depth >= DEEPEST || middle <= time[0] || middle >= time[1];
        if is_contact || is_short || (is_never_excluded && is_never_proved) {
            spans.push(self.span(time, &bounds, is_contact));
            return;
        }
        self.divide([time[0], middle], depth + 1, spans);
        self.divide([middle, time[1]], depth + 1, spans);
    }
}
