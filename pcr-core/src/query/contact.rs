//! Finds when two agents are in contact, in steps that cannot miss a contact. For outlines `bodies` has the steps; for
//! discs they are these.
//!
//! Over a step of length h, let the relative position of the two centres be Δ(t). It deviates by at most
//!
//! ```text
//! e = Σ |a| h² / 8 + w² / 8ϱ          (w the way of an agent, ϱ the radius of its arc; w² / 4ϱ if it speeds up or slows)
//! ```
//!
//! from the chord between its values at both ends (linear interpolation). So the chord decides: if it is outside a
//! circle of R + e there is no contact, if it is inside one of R - e there is. The deviation is 0 at both ends, so
//! weaker conditions are enough to decide that nothing changes in the whole step (`relative_motion::clears`, `relative_motion::keeps`,
//! `LinearRelativeMotion::dives`), also if the step begins at a distance of R. Otherwise the step is shortened to the part in doubt: e
//! falls with the square of the step, and the part in doubt with e. On lines at constant speeds e is 0 and one step is
//! exact; elsewhere an end of a contact takes about four. The worst case is discs that stay at a distance of R within
//! the tolerance for a time T. Since e <= ε / 4 always decides, every step there is longer than h / 2 for
//! h = √(2 ε / c), c = Σ |a| + v²/ϱ; hence a leg takes at most a few T / h + 1 steps. `Contacts::steps` counts them. Agents that go alike
//! (`Leg::goes_like`) move uniformly as seen from each other, and e is 0.

use crate::error::InvalidInput;
use crate::geometry::Interval;
use crate::motion::Motion;
use crate::query::leg_windows::{LegWindow, LegWindows, PairInstant};
use crate::query::relative_motion::{LinearRelativeMotion, clears, keeps};
use crate::scalar::Scalar;

/// A pair of agents in motion: whether and when they are in contact, and how near they come.
///
/// Contacts are found for the sum of the radii plus an allowance for rounding, [`Encounter::tolerance`] at most. An
/// overlap is never missed; discs that are further apart than the tolerance are never reported.
///
/// ```
/// use pcr_core::{Encounter, Interval, Limits, Motion, Path, Point, Pose, Profile, Radians};
/// let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(0.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let paths = [Path::<f64, 1>::starting_at(east)?.line(4.0)?, Path::starting_at(north)?.line(4.0)?];
/// let profile = Profile::<f64, 1>::from_pieces(1.0, [(4.0, 0.0)])?;
/// let east = Motion::new(paths[0].as_path(), profile.as_profile(), 0.25, 0.0)?;
/// let north = Motion::new(paths[1].as_path(), profile.as_profile(), 0.25, 0.5)?;
///
/// let encounter = Encounter::new(&east, &north);
/// let conflict = encounter.conflicts(encounter.time()).next().unwrap();
/// // They are √((t - 2)² + (t - 2.5)²) apart, hence never nearer than 1 / √8.
/// assert!((conflict.deepest.time - 2.25).abs() < 1e-9 && (conflict.deepest.separation - 0.125_f64.sqrt()).abs() < 1e-9);
/// assert!((conflict.time.lo - 2.0).abs() < 1e-8 && (conflict.time.hi - 2.5).abs() < 1e-8);
/// assert!(!conflict.touching);
/// let later = north.delayed(0.5)?;
/// assert_eq!(Encounter::new(&east, &later).contacts(Interval::new(0.0, 9.0)).next(), None);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Encounter<'a, S: Scalar> {
    pub(crate) ego: &'a Motion<'a, S>,
    pub(crate) other: &'a Motion<'a, S>,
    /// Bound on the rounding error of a distance \[m\].
    pad: S,
    tolerance: S,
}

impl<'a, S: Scalar> Encounter<'a, S> {
    /// Pairs two motions. Lengths of the `ego` come first in results.
    pub fn new(ego: &'a Motion<'a, S>, other: &'a Motion<'a, S>) -> Self {
        let pad = pad(ego, other, ego.reach() + other.reach());
        let tolerance = S::tolerance(ego.extent().max(other.extent()));
        Self { ego, other, pad, tolerance: tolerance.max(pad.double().double()) }
    }

    /// The interval from the first start to the last arrival of the two agents \[s\].
    pub fn time(&self) -> Interval<S> {
        self.ego.time().hull(self.other.time())
    }

    /// Sum of the radii \[m\]: those of discs, or those by which outlines are rounded.
    pub fn radius(&self) -> S {
        self.ego.rounding_radius() + self.other.rounding_radius()
    }

    /// Whether any of the two is not a disc about its reference point.
    pub(crate) fn has_outline(&self) -> bool {
        self.ego.has_outline() | self.other.has_outline()
    }

    /// Distance of the reference points at which the agents may be as near as a distance of their polygons \[m\].
    pub(crate) fn spread(&self, distance: S) -> S {
        if self.has_outline() {
            distance + self.ego.outline().spread() + self.other.outline().spread()
        } else {
            distance
        }
    }

    /// Tolerance ε \[m\]: clearances above it are never reported as contacts, and touches ([`Conflict::touching`](crate::Conflict::touching)) are no
    /// deeper. Contacts are not missed, however slight they are. It is the larger of two values: [`Scalar::tolerance`] of the larger extent; and 4 slacks of that
    /// extent plus the distances that both agents go at top speed since the time 0, plus four times the
    /// [`Scalar::drift`] and the [`Scalar::lag`] of both and, in fixed point, the distances at top speed in five last
    /// digits. In `f64` it is 2e-10 of the extent, unless an agent goes farther than some 4000 extents at its top speed in its time since 0:
    /// at 1 m/s and times since 1970 it is about 0.1 mm.
    pub fn tolerance(&self) -> S {
        self.tolerance
    }

    /// The contacts during an interval of time \[s\], in increasing order, each as a whole interval. Each agent stands
    /// at its start before it sets off and at its end after its arrival. All times of motions are within
    /// [`Scalar::LIMIT`], and the interval is limited to that.
    ///
    /// Cost: a comparison of boxes for each pair of segments, and four inversions of a profile for each pair that comes
    /// close. A step takes 50 to 100 ns on a desktop: one to a few steps for pairs that are close at the same time,
    /// about nine for a contact.
    #[cfg_attr(feature = "std", inline(always))]
    pub fn contacts(&self, during: Interval<S>) -> Contacts<'a, S> {
        let reach = self.radius() + self.pad;
        let apart = !self.ego.bounds().expanded(self.spread(reach)).meets(self.other.bounds());
        let windows = (!apart).then(|| LegWindows::new([self.ego, self.other], during.limited(), self.pad));
        Contacts { encounter: *self, radius: reach, windows, scan: None, since: None, last: None, steps: 0 }
    }
}

/// Bound on the rounding error of the distance of two agents \[m\], if both together go so far at their top speeds since the time 0 \[m\].
pub(super) fn pad<S: Scalar>(ego: &Motion<'_, S>, other: &Motion<'_, S>, reach: S) -> S {
    // The slack of both positions (docs/theory/errors.md); the rounding error of a time counts multiplied by the speed.
    let pad = S::slack(ego.extent().max(other.extent()) + reach);
    [ego, other].into_iter().fold(pad, |pad, motion| pad + motion.drift() + motion.lag() + motion.leap())
}

impl<S: Scalar> Motion<'_, S> {
    /// The motion to plan with: its disc is larger by its margin and by its [`Encounter::tolerance`] with itself.
    /// Together two such discs are larger by more than the tolerance of their pair. So discs of the true radii do not
    /// even touch where a query reports a touch of these. The tolerance is that at its own start and arrival. It grows with times, in `f32` by
    /// a millimetre for some 100 m at top speed: a motion that may start much later is made for plans at its latest start, and then given the
    /// earlier one.
    ///
    /// # Errors
    /// [`InvalidInput::OutOfRange`].
    ///
    /// ```
    /// # use pcr_core::{Encounter, Interval, Motion, Path, Point, Pose, Profile, Radians};
    /// # let pose = |x, y, heading| Pose { position: Point::new(x, y), heading: Radians(heading) };
    /// # let east = Path::<f64, 1>::starting_at(pose(-2.0, 0.0, 0.0))?.line(4.0)?;
    /// # let profile = Profile::<f64, 1>::from_pieces(1.0, [(4.0, 0.0)])?;
    /// let motion = Motion::new(east.as_path(), profile.as_profile(), 0.25, 0.0)?.with_margin(0.05)?;
    /// let planned = motion.for_plan()?;
    /// assert!(planned.radius() > 0.3 && planned.radius() < 0.3 + 1e-8 && planned.margin() == 0.0);
    /// # Ok::<(), pcr_core::InvalidInput>(())
    /// ```
    pub fn for_plan(self) -> Result<Self, InvalidInput> {
        let tolerance = Encounter::new(&self, &self).tolerance();
        Ok(self.with_margin(self.margin() + tolerance)?.inflated())
    }
}

impl<S: Scalar> Encounter<'_, S> {
    /// Bound on the rounding error of a distance \[m\].
    pub(crate) fn pad(&self) -> S {
        self.pad
    }
}

/// The contacts of two agents: intervals of time \[s\] in increasing order.
#[derive(Clone, Debug)]
pub struct Contacts<'a, S: Scalar> {
    encounter: Encounter<'a, S>,
    /// Discs are in contact if their centres are within this distance \[m\].
    radius: S,
    /// `None` for paths that are never near each other.
    windows: Option<LegWindows<'a, S>>,
    /// The window that is being searched.
    scan: Option<WindowScan<'a, S>>,
    /// Begin of the current contact.
    since: Option<S>,
    /// The end of the window that was searched last.
    last: Option<PairInstant<S>>,
    steps: u32,
}

#[cfg(feature = "defmt")]
impl<S: Scalar + defmt::Format> defmt::Format for Contacts<'_, S> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "contacts within {} m, {} steps so far", self.radius, self.steps);
    }
}

/// State of the search in a window.
#[derive(Clone, Copy, Debug)]
struct WindowScan<'a, S: Scalar> {
    window: LegWindow<'a, S>,
    now: PairInstant<S>,
    /// Length of the next step \[s\].
    step: S,
}

/// A change at the end of a step.
enum ContactEvent<S> {
    /// Contact begins at this time.
    Begin(S),
    /// Contact has ended at this time.
    End(S),
}

impl<S: Scalar> Contacts<'_, S> {
    /// Number of steps taken so far; each one evaluates both motions. See [`Encounter::contacts`] for how many to
    /// expect.
    pub fn steps(&self) -> u32 {
        self.steps
    }
}

impl<'a, S: Scalar> Contacts<'a, S> {
    /// The next window in which the two agents may come near enough for a contact.
    fn next_scan(&mut self) -> Option<WindowScan<'a, S>> {
        let reach = self.encounter.spread(self.radius + self.encounter.tolerance);
        let window = self.windows.as_mut()?.next(reach)?;
        let now = self.last.filter(|last| last.time == window.time.lo).unwrap_or_else(|| window.at(window.time.lo));
        Some(WindowScan { window, now, step: window.time.length() })
    }

    /// Searches the rest of a window, up to the end of a contact.
    fn rest_of(&mut self, mut scan: WindowScan<'a, S>) -> Option<Interval<S>> {
        loop {
            let event = self.step(&mut scan);
            let over = scan.now.time >= scan.window.time.hi;
            let ended = match event {
                Some(ContactEvent::Begin(time)) => {
                    self.since = Some(time);
                    None
                }
                Some(ContactEvent::End(time)) => self.since.take().map(|since| Interval::new(since, time)),
                None => None,
            };
            if over || ended.is_some() {
                self.last = Some(scan.now);
                self.scan = (!over).then_some(scan);
                return ended;
            }
        }
    }

    /// One step of the search; returns an event if something changes.
    fn step(&mut self, scan: &mut WindowScan<'_, S>) -> Option<ContactEvent<S>> {
        self.steps = self.steps.saturating_add(1);
        if self.encounter.has_outline() {
            return self.step_of_outlines(scan);
        }
        let WindowScan { window, now, step } = *scan;
        let left = window.time.hi - now.time;
        let (duration, to) = if step < left { (step, now.time + step) } else { (left, window.time.hi) };
        let ahead = window.at(to);
        let error = window.deviation(&now, &ahead);
        let (ends, inside) = ([now.apart, ahead.apart], self.since.is_some());
        let Encounter { tolerance, pad, .. } = self.encounter;
        let goes_on = if inside {
            keeps(ends, self.radius + tolerance, error)
        } else {
            clears(ends, self.radius + pad, error, pad)
        };
        let next = if goes_on {
            NextScan { from: to, step: duration.double(), event: None }
        } else {
            let chord = LinearRelativeMotion::between(now.apart, ahead.apart);
            // If the relative velocity is constant the chord is exact. Two agents with equal velocities can stay at a
            // distance of R; with an error above 0 every step would then be as short as possible.
            let error = if window.is_uniform(&now, &ahead) { S::ZERO } else { error };
            let stretch = ScanStep { now, ahead, chord, error, duration, radius: self.radius, tolerance, pad };
            if inside { stretch.follow() } else { stretch.search() }
        };
        scan.now = if next.from >= to {
            ahead
        } else if next.from > now.time {
            window.at(next.from)
        } else {
            now
        };
        scan.step = next.step;
        next.event
    }
}

impl<S: Scalar> Contacts<'_, S> {
    /// One step of the search for outlines: as long as they certainly stay apart, or in contact (`bodies`).
    // Not inlined: pairs of discs would need the stack of it.
    #[inline(never)]
    fn step_of_outlines(&self, scan: &mut WindowScan<'_, S>) -> Option<ContactEvent<S>> {
        let WindowScan { window, now, .. } = *scan;
        let Encounter { ego, other, tolerance, pad } = self.encounter;
        let bodies = window.bodies([ego, other], &now, Interval::new(now.time, window.time.hi));
        let quarter = tolerance.half().half();
        let step = if self.since.is_some() {
            // The hysteresis avoids many short contacts of outlines that hover at a distance of R. The pad is a quarter of the tolerance at most, so
            // another quarter remains for a step.
            if bodies.separation > self.radius + quarter {
                return Some(ContactEvent::End(now.time));
            }
            bodies.stay_near(self.radius + (tolerance - pad.double()))
        } else {
            if bodies.separation <= self.radius + quarter.half() {
                return Some(ContactEvent::Begin(now.time));
            }
            bodies.stay_apart(self.radius)
        };
        let to = now.time + step.min(window.time.length());
        if to >= window.time.hi {
            scan.now = window.at(window.time.hi);
            return None;
        }
        if to <= now.time {
            // A step below the last digit of the time: what cannot be excluded counts as contact.
            let next = now.time + S::rounding(now.time.abs().max(window.time.length())).double();
            scan.now = window.at(next.min(window.time.hi));
            return self.since.is_none().then_some(ContactEvent::Begin(now.time));
        }
        scan.now = window.at(to);
        None
    }
}

/// A step: both its ends, and the chord between them.
struct ScanStep<S> {
    now: PairInstant<S>,
    ahead: PairInstant<S>,
    chord: LinearRelativeMotion<S>,
    /// Largest deviation of the relative position from the chord.
    error: S,
    duration: S,
    radius: S,
    tolerance: S,
    pad: S,
}

/// Where the search continues, the length of the next step, and an event before that.
struct NextScan<S> {
    from: S,
    step: S,
    event: Option<ContactEvent<S>>,
}

impl<S: Scalar> ScanStep<S> {
    /// Without contact: looks for the begin of one.
    fn search(&self) -> NextScan<S> {
        let Some(near) = self.chord.within(self.radius + self.error) else {
            return self.advance();
        };
        let begin = if near.lo > S::ZERO { self.time_at(near.lo) } else { self.now.time };
        let certain = self.chord.within(self.radius - self.error);
        let doubt = certain.map(|certain| self.time_at(certain.lo) - begin);
        match self.refined(begin, doubt) {
            Some(next) if !self.decides(doubt) => next,
            _ => {
                let kept = self.chord.within(self.radius + self.tolerance - self.error);
                let lasts = kept.is_some_and(|kept| kept.hi >= self.chord.length);
                let from = if lasts { self.ahead.time } else { begin };
                NextScan { from, step: S::LIMIT, event: Some(ContactEvent::Begin(begin)) }
            }
        }
    }

    /// In contact: looks for its end, where the discs are apart by the tolerance. This hysteresis avoids many short
    /// contacts of discs that hover at a distance of R.
    fn follow(&self) -> NextScan<S> {
        let outer = self.radius + self.tolerance;
        let kept = self.chord.within(outer - self.error);
        let kept = kept.filter(|kept| kept.lo <= S::ZERO || self.chord.dives(outer, self.error));
        if kept.is_some_and(|kept| kept.hi >= self.chord.length) {
            return self.advance();
        }
        // Parts of the chord within smaller radii lie inside the kept part.
        let left_at = |radius: S| {
            let hi = kept.and_then(|_| self.chord.within(radius)).map(|part| part.hi);
            hi.map_or(self.now.time, |hi| self.time_at(hi))
        };
        let from = left_at(self.radius - self.error);
        let gone = self.chord.within(outer + self.error).filter(|all| all.hi < self.chord.length);
        let doubt = gone.map(|all| self.time_at(all.hi) - from);
        match self.refined(from, doubt) {
            _ if self.decides(doubt) => {
                let event = Some(ContactEvent::End(left_at(self.radius + self.error)));
                // A chord that has left the circle does not come back.
                let from = if kept.is_some() { self.ahead.time } else { self.now.time };
                NextScan { from, step: S::LIMIT, event }
            }
            Some(next) => next,
            // The step is down to the last digit of the time: what cannot be excluded counts as contact.
            None => self.advance(),
        }
    }

    /// Nothing changes during the whole step.
    fn advance(&self) -> NextScan<S> {
        NextScan { from: self.ahead.time, step: self.duration.double(), event: None }
    }

    /// A shorter step: the part in doubt, at most half of this step; `None` if the time would not change.
    fn refined(&self, from: S, doubt: Option<S>) -> Option<NextScan<S>> {
        let half = self.duration.half();
        let step = doubt.map_or(half, |doubt| doubt.min(half));
        (from + step > from).then_some(NextScan { from, step, event: None })
    }

    /// Whether the chord is as good as the motion: its error is within the tolerance, and either within a few roundings
    /// or a shorter step would hardly be better.
    fn decides(&self, doubt: Option<S>) -> bool {
        let quarter = |x: S| x.half().half();
        let shrinks = doubt.is_some_and(|doubt| doubt < quarter(self.duration));
        self.error <= quarter(self.tolerance) && (self.error <= self.pad.double().double().double() || !shrinks)
    }

    /// The time at which the chord has the length `x`.
    fn time_at(&self, x: S) -> S {
        if x < self.chord.length {
            self.now.time + self.duration.portion(x, self.chord.length)
        } else {
            self.ahead.time
        }
    }
}

impl<S: Scalar> Iterator for Contacts<'_, S> {
    type Item = Interval<S>;

    fn next(&mut self) -> Option<Interval<S>> {
        loop {
            let scan = self.scan.take().or_else(|| self.next_scan());
            // A contact ends where windows do not follow one another without a gap.
            if let (Some(since), Some(last)) = (self.since, self.last)
                && scan.as_ref().is_none_or(|scan| last.time < scan.now.time)
            {
                (self.since, self.scan) = (None, scan);
                return Some(Interval::new(since, last.time));
            }
            let ended = self.rest_of(scan?);
            if ended.is_some() {
                return ended;
            }
        }
    }
}
