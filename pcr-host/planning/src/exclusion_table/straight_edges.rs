//! Closed forms for straight edges that are driven at constant speed: the start delays with which two vehicles touch,
//! and the times at which a vehicle touches one that stands (docs/theory/equations.md, "Delays of straight edges"). They do
//! not allocate, so that a solver can compute them whenever it considers a pair.

/// Unit roundoff.
const ULP: f64 = f64::EPSILON / 2.0;
/// Roundings that a distance is made of, at most; docs/theory/equations.md counts them.
const ROUNDINGS: f64 = 32.0;

/// A straight edge, driven at constant speed from its start to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StraightEdge {
    start: [f64; 2],
    end: [f64; 2],
    /// Unit vector.
    direction: [f64; 2],
    /// \[m\]
    length: f64,
    /// \[m/s\]
    speed: f64,
    /// \[s\]
    duration: f64,
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// `a + b by`.
fn moved(a: [f64; 2], b: [f64; 2], by: f64) -> [f64; 2] {
    [a[0] + b[0] * by, a[1] + b[1] * by]
}

/// Lengths of a segment from the origin in a direction that are within reach of a point.
fn covered(direction: [f64; 2], length: f64, point: [f64; 2], reach: f64) -> Option<[f64; 2]> {
    let (foot, aside) = (dot(point, direction), cross(direction, point).abs());
    let half = ((reach - aside) * (reach + aside)).sqrt();
    // NaN counts as not covered.
    let covered = [(foot - half).max(0.0), (foot + half).min(length)];
    (aside <= reach && covered[0] <= covered[1]).then_some(covered)
}

impl StraightEdge {
    /// From one point to another \[m\] at a speed \[m/s\]. `None` for what is not finite, for a speed that is not above 0, and where
    /// length or duration are beyond 1e9.
    pub fn new(from: [f64; 2], to: [f64; 2], speed: f64) -> Option<Self> {
        let way = [to[0] - from[0], to[1] - from[1]];
        let length = way[0].hypot(way[1]);
        let direction = if length > 0.0 { [way[0] / length, way[1] / length] } else { [1.0, 0.0] };
        let duration = length / speed;
        let is_valid = from.iter().all(|x| x.abs() <= 1e9) && speed > 0.0 && speed <= 1e9;
        (is_valid && length <= 1e9 && duration <= 1e9).then_some(Self {
            start: from,
            end: to,
            direction,
            length,
            speed,
            duration,
        })
    }

    /// Its two ends.
    pub fn ends(&self) -> [[f64; 2]; 2] {
        [self.start, self.end]
    }

    /// Its speed \[m/s\].
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// How long it takes \[s\].
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// How much later than on this edge a vehicle may set off on another one and touch the vehicle on this one \[s\], while both are
    /// on their edges; `reach` is the sum of the radii \[m\]. Negative delays are earlier starts. Touching counts. `None` where they
    /// never touch.
    ///
    /// Rounded outward: there is no contact outside of the interval, and its ends are within [`StraightEdge::error_bound`] of those for a
    /// reach that is larger by that of lengths. About 40 ns on a desktop.
    ///
    /// ```
    /// use pcr_planning::exclusion_table::StraightEdge;
    /// let east = StraightEdge::new([-2.0, 0.0], [2.0, 0.0], 1.0).unwrap();
    /// let north = StraightEdge::new([0.0, -2.0], [0.0, 2.0], 1.0).unwrap();
    /// let [from, to] = east.delays(&north, 0.5).unwrap();
    /// assert!((from + 0.5 * 2.0_f64.sqrt()).abs() < 1e-12 && (to - 0.5 * 2.0_f64.sqrt()).abs() < 1e-12);
    /// assert_eq!(east.delays(&StraightEdge::new([3.0, -2.0], [3.0, 2.0], 1.0).unwrap(), 0.5), None);
    /// ```
    pub fn delays(&self, other: &Self, reach: f64) -> Option<[f64; 2]> {
        if reach.is_nan() {
            // For NaN all delays count as unsafe.
            return Some([-other.duration, self.duration]);
        }
        // From the other's start to this one's.
        let between = [self.start[0] - other.start[0], self.start[1] - other.start[1]];
        let reach = reach + self.rounding_bound(other, between, reach);
        let mut all = [f64::INFINITY, f64::NEG_INFINITY];
        let mut met = |lo: f64, hi: f64| all = [all[0].min(lo), all[1].max(hi)];
        // One of them is at an end of its edge.
        for (length, time) in [(0.0, 0.0), (self.length, self.duration)] {
            let at = moved(between, self.direction, length);
            if let Some([lo, hi]) = covered(other.direction, other.length, at, reach) {
                met(time - hi / other.speed, time - lo / other.speed);
            }
        }
        for (length, time) in [(0.0, 0.0), (other.length, other.duration)] {
            let [x, y] = moved(between, other.direction, -length);
            if let Some([lo, hi]) = covered(self.direction, self.length, [-x, -y], reach) {
                met(lo / self.speed - time, hi / self.speed - time);
            }
        }
        for delay in self.grazing(other, between, reach).into_iter().flatten() {
            met(delay, delay);
        }
        let rounding = self.time_rounding(other);
        (all[0] <= all[1]).then_some([all[0] - rounding, all[1] + rounding])
    }

    /// The delays at which they graze one another between the ends of their edges: passing, they touch in one moment.
    fn grazing(&self, other: &Self, between: [f64; 2], reach: f64) -> [Option<f64>; 2] {
        let [own, their] = [[0.0; 2]; 2];
        let (own, their) = (moved(own, self.direction, self.speed), moved(their, other.direction, other.speed));
        let passing = moved(own, their, -1.0);
        let square = dot(passing, passing);
        // As `passing` is rounded: with the product of the two directions edges that hardly turn would lose digits.
        let turn = cross(passing, their);
        if turn == 0.0 || square == 0.0 {
            return [None; 2];
        }
        let (aside, wide) = (cross(between, passing), reach * square.sqrt());
        [-wide, wide].map(|wide| {
            let delay = (aside + wide) / turn;
            let time = -dot(moved(between, their, delay), passing) / square;
            let on_both = 0.0 <= time && time <= self.duration && 0.0 <= time - delay && time - delay <= other.duration;
            on_both.then_some(delay)
        })
    }

    /// When a vehicle on this edge touches one that stands at a point \[s\], from its start; as [`StraightEdge::delays`].
    pub fn times_at(&self, point: [f64; 2], reach: f64) -> Option<[f64; 2]> {
        let to = [point[0] - self.start[0], point[1] - self.start[1]];
        if [to[0], to[1], reach].iter().any(|x| x.is_nan()) {
            return Some([0.0, self.duration]);
        }
        let slack = ROUNDINGS * ULP * (to[0].abs() + to[1].abs() + self.length + reach);
        let [lo, hi] = covered(self.direction, self.length, to, reach + slack)?;
        let rounding = 8.0 * ULP * self.duration;
        Some([(lo / self.speed - rounding).max(0.0), hi / self.speed + rounding])
    }

    /// ε of [`StraightEdge::delays`]: of lengths \[m\], and of times \[s\].
    pub fn error_bound(&self, other: &Self, reach: f64) -> [f64; 2] {
        let between = [self.start[0] - other.start[0], self.start[1] - other.start[1]];
        [2.0 * self.rounding_bound(other, between, reach), 2.0 * self.time_rounding(other)]
    }

    /// Bound on the rounding error of a distance \[m\].
    fn rounding_bound(&self, other: &Self, between: [f64; 2], reach: f64) -> f64 {
        ROUNDINGS * ULP * (between[0].abs() + between[1].abs() + self.length + other.length + reach)
    }

    /// Bound on the rounding error of a delay, if lengths are exact \[s\].
    fn time_rounding(&self, other: &Self) -> f64 {
        8.0 * ULP * (self.duration + other.duration)
    }
}

#[cfg(test)]
mod tests {
    use super::StraightEdge;

    fn edge(from: [f64; 2], to: [f64; 2]) -> StraightEdge {
        StraightEdge::new(from, to, 1.0).unwrap()
    }

    fn assert_near(found: Option<[f64; 2]>, expected: [f64; 2]) {
        let found = found.expect("an interval");
        assert!(found[0] <= expected[0] && expected[0] - found[0] < 1e-12, "{found:?} {expected:?}");
        assert!(expected[1] <= found[1] && found[1] - expected[1] < 1e-12, "{found:?} {expected:?}");
    }

    #[test]
    fn one_behind_the_other_may_not_start_too_soon() {
        let [first, second] = [edge([0.0, 0.0], [5.0, 0.0]), edge([1.0, 0.0], [6.0, 0.0])];
        assert_near(first.delays(&second, 2.0), [-1.0, 3.0]);
        assert_near(second.delays(&first, 2.0), [-3.0, 1.0]);
        // On the same edge, and on a short one.
        assert_near(first.delays(&first, 2.0), [-2.0, 2.0]);
        let short = edge([0.0, 0.0], [0.5, 0.0]);
        assert_near(short.delays(&short, 2.0), [-0.5, 0.5]);
    }

    #[test]
    fn towards_one_another_they_touch_whenever_both_are_there() {
        let [first, second] = [edge([0.0, 0.0], [5.0, 0.0]), edge([5.0, 0.0], [0.0, 0.0])];
        assert_near(first.delays(&second, 2.0), [-5.0, 5.0]);
        // The second one comes to an end before it is in the way.
        let away = edge([9.0, 0.0], [7.5, 0.0]);
        assert_eq!(first.delays(&away, 2.0), None);
        assert_near(first.delays(&edge([9.0, 0.0], [6.5, 0.0]), 2.0), [4.5 - 2.5, 5.0 - 2.0]);
    }

    #[test]
    fn different_speeds() {
        let fast = StraightEdge::new([-4.0, 0.0], [4.0, 0.0], 2.0).unwrap();
        let slow = edge([0.0, -4.0], [0.0, 4.0]);
        // At the crossing after 2 s and 4 s; passing at (2, -1), the delay moves the one by 1 m/s across √5.
        let half = 0.5 * 5.0_f64.sqrt() / 2.0;
        assert_near(fast.delays(&slow, 0.5), [-2.0 - half, -2.0 + half]);
    }

    #[test]
    fn one_that_stands_is_touched_for_a_time() {
        let first = edge([0.0, 0.0], [5.0, 0.0]);
        assert_near(first.times_at([3.0, 0.0], 1.0), [2.0, 4.0]);
        assert_near(first.times_at([5.5, 0.0], 1.0), [4.5, 5.0]);
        assert_eq!(first.times_at([3.0, 1.1], 1.0), None);
    }

    #[test]
    fn what_is_no_edge_is_refused() {
        for (from, to, speed) in [
            ([f64::NAN, 0.0], [1.0, 0.0], 1.0),
            ([0.0, 0.0], [f64::INFINITY, 0.0], 1.0),
            ([0.0, 0.0], [1.0, 0.0], 0.0),
            ([0.0, 0.0], [1.0, 0.0], -1.0),
            ([0.0, 0.0], [1.0, 0.0], f64::NAN),
            ([0.0, 0.0], [1.0, 0.0], 1e-12),
            ([2e9, 0.0], [2e9, 1.0], 1.0),
        ] {
            assert_eq!(StraightEdge::new(from, to, speed), None);
        }
    }
}
