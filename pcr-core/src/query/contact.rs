//! When two discs are in contact, found in steps that cannot miss anything.
//!
//! Over a step of length h the relative position Δ(t) of the two centres stays within
//!
//! ```text
//! e = Σ |a| h² / 8 + w² / 8ϱ          (w the way of an agent, ϱ the radius of its arc; w² / 4ϱ if it speeds up or slows)
//! ```
//!
//! of the chord between its values at both ends (linear interpolation), so that the chord decides: outside a circle of
//! R + e there is no contact, inside one of R - e there is. As the deviation is 0 at both ends, less decides that nothing
//! happens at all (`chord::clears`, `chord::keeps`, `Chord::dives`), also where a step begins at a distance of R. Else the step
//! is cut to the part in doubt: e falls with the square of the step, and the part in doubt with e. On lines at constant speeds
//! e is 0 and one step is exact; elsewhere an end of a contact takes about four. The worst case is discs that stay at a
//! distance of R within the tolerance for a time T: every step there is at least h = √(2 ε / c) long, c = Σ |a| + v²/ϱ, as
//! e <= ε / 4 always decides; hence at most a few T / h + 1 steps a leg. `Contacts::steps` counts them.

use crate::error::Invalid;
use crate::geometry::Interval;
use crate::motion::Motion;
use crate::query::chord::{Chord, clears, keeps};
use crate::query::windows::{Instant, Window, Windows};
use crate::scalar::Scalar;

/// Two agents in motion: are they in contact, when, how near do they come.
///
/// Contact is found for the sum of the radii plus the rounding of the format, [`Encounter::tolerance`] at most. What
/// is deeper than that is never missed; what is further apart is never reported.
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
    /// What rounding may do to a distance \[m\].
    pad: S,
    tolerance: S,
}

impl<'a, S: Scalar> Encounter<'a, S> {
    /// The two, whose order says whose lengths come first.
    pub fn new(ego: &'a Motion<'a, S>, other: &'a Motion<'a, S>) -> Self {
        let extent = ego.extent().max(other.extent());
        let quadruple = |length: S| length.double().double();
        // The slack of both positions (docs/errors.md); the last digit of a time counts with the speed.
        let pad = S::slack(extent + ego.reach() + other.reach());
        let pad = [ego, other].into_iter().fold(pad, |pad, motion| pad + motion.drift() + motion.lag() + motion.leap());
        Self { ego, other, pad, tolerance: S::tolerance(extent).max(quadruple(pad)) }
    }

    /// From the first start to the last arrival of the two \[s\].
    pub fn time(&self) -> Interval<S> {
        self.ego.time().hull(self.other.time())
    }

    /// Sum of the radii \[m\].
    pub fn radius(&self) -> S {
        self.ego.radius() + self.other.radius()
    }

    /// ε: contacts deeper than this are never missed, clearances above it never taken for a contact \[m\]. The larger
    /// of [`Scalar::tolerance`] of the larger extent and 4 slacks of that extent and both ways at top speed since the
    /// time 0, with four times the [`Scalar::drift`] and the [`Scalar::lag`] of both, and, in fixed point, their ways at top
    /// speed in five last digits; 2e-10 of the extent in `f64` unless times are beyond 1e5
    /// extents.
    pub fn tolerance(&self) -> S {
        self.tolerance
    }

    /// When the discs are in contact during an interval of time \[s\], in increasing order, each as long as it lasts.
    /// Both stand at their start before they set off and at their end after their arrival. Beyond [`Scalar::LIMIT`] nobody
    /// moves: an interval that goes further is cut there.
    ///
    /// Cost: a comparison of boxes a pair of segments, four times of lengths where two come near each other, and 50 to
    /// 100 ns a step on a desktop: one to a few where they do so at the same time, about nine for a contact.
    #[cfg_attr(feature = "std", inline(always))]
    pub fn contacts(&self, during: Interval<S>) -> Contacts<'a, S> {
        let reach = self.radius() + self.pad;
        let apart = !self.ego.bounds().expanded(reach).meets(self.other.bounds());
        let windows = (!apart).then(|| Windows::new([self.ego, self.other], during.limited(), self.pad));
        Contacts { encounter: *self, radius: reach, windows, scan: None, since: None, last: None, steps: 0 }
    }
}

impl<S: Scalar> Motion<'_, S> {
    /// The motion to plan with: of a disc that is larger by its margin and by its [`Encounter::tolerance`] with itself. Two such
    /// discs grow by more than the tolerance of their pair together, so that those of the true radii do not even touch where
    /// these are told to touch.
    ///
    /// # Errors
    /// [`Invalid::OutOfRange`].
    ///
    /// ```
    /// # use pcr_core::{Encounter, Interval, Motion, Path, Point, Pose, Profile, Radians};
    /// # let pose = |x, y, heading| Pose { position: Point::new(x, y), heading: Radians(heading) };
    /// # let east = Path::<f64, 1>::starting_at(pose(-2.0, 0.0, 0.0))?.line(4.0)?;
    /// # let profile = Profile::<f64, 1>::from_pieces(1.0, [(4.0, 0.0)])?;
    /// let motion = Motion::new(east.as_path(), profile.as_profile(), 0.25, 0.0)?.with_margin(0.05)?;
    /// let planned = motion.for_plan()?;
    /// assert!(planned.radius() > 0.3 && planned.radius() < 0.3 + 1e-8 && planned.margin() == 0.0);
    /// # Ok::<(), pcr_core::Invalid>(())
    /// ```
    pub fn for_plan(self) -> Result<Self, Invalid> {
        let tolerance = Encounter::new(&self, &self).tolerance();
        Ok(self.with_margin(self.margin() + tolerance)?.inflated())
    }
}

impl<S: Scalar> Encounter<'_, S> {
    /// What rounding may do to a distance \[m\].
    pub(crate) fn pad(&self) -> S {
        self.pad
    }
}

/// The contacts of two agents: intervals of time \[s\] in increasing order.
#[derive(Clone, Debug)]
pub struct Contacts<'a, S: Scalar> {
    encounter: Encounter<'a, S>,
    /// Contact is within this \[m\].
    radius: S,
    /// `None` for paths that are apart.
    windows: Option<Windows<'a, S>>,
    /// The window that is being searched.
    scan: Option<Scan<'a, S>>,
    /// Since when there is contact.
    since: Option<S>,
    /// The end of the window that was searched last.
    last: Option<Instant<S>>,
    steps: u32,
}

#[cfg(feature = "defmt")]
impl<S: Scalar + defmt::Format> defmt::Format for Contacts<'_, S> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "contacts within {} m, {} steps so far", self.radius, self.steps);
    }
}

/// How far a window is searched.
#[derive(Clone, Copy, Debug)]
struct Scan<'a, S: Scalar> {
    window: Window<'a, S>,
    now: Instant<S>,
    /// Length of the next step \[s\].
    step: S,
}

/// What a step ends in.
enum Event<S> {
    /// Contact begins at this time.
    Begin(S),
    /// Contact has ended at this time.
    End(S),
}

impl<S: Scalar> Contacts<'_, S> {
    /// Steps taken so far: evaluations of both motions. See [`Encounter::contacts`] for how many to expect.
    pub fn steps(&self) -> u32 {
        self.steps
    }
}

impl<'a, S: Scalar> Contacts<'a, S> {
    /// The next window in which the two may come as near as a contact lasts.
    fn next_scan(&mut self) -> Option<Scan<'a, S>> {
        let reach = self.radius + self.encounter.tolerance;
        let window = self.windows.as_mut()?.next(reach)?;
        let now = self.last.filter(|last| last.time == window.time.lo).unwrap_or_else(|| window.at(window.time.lo));
        Some(Scan { window, now, step: window.time.length() })
    }

    /// Searches the rest of a window, up to the end of a contact.
    fn rest_of(&mut self, mut scan: Scan<'a, S>) -> Option<Interval<S>> {
        loop {
            let event = self.step(&mut scan);
            let over = scan.now.time >= scan.window.time.hi;
            let ended = match event {
                Some(Event::Begin(time)) => {
                    self.since = Some(time);
                    None
                }
                Some(Event::End(time)) => self.since.take().map(|since| Interval::new(since, time)),
                None => None,
            };
            if over || ended.is_some() {
                self.last = Some(scan.now);
                self.scan = (!over).then_some(scan);
                return ended;
            }
        }
    }

    /// One step of the search; an event where something changes.
    fn step(&mut self, scan: &mut Scan<'_, S>) -> Option<Event<S>> {
        self.steps = self.steps.saturating_add(1);
        let Scan { window, now, step } = *scan;
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
            Next { from: to, step: duration.double(), event: None }
        } else {
            let chord = Chord::between(now.apart, ahead.apart);
            let stretch = Stretch { now, ahead, chord, error, duration, radius: self.radius, tolerance, pad };
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

/// A step: both its ends, and the chord between them.
struct Stretch<S> {
    now: Instant<S>,
    ahead: Instant<S>,
    chord: Chord<S>,
    /// How far the relative position may be from the chord.
    error: S,
    duration: S,
    radius: S,
    tolerance: S,
    pad: S,
}

/// Where the search goes on, how far the next step reaches, and what has happened until then.
struct Next<S> {
    from: S,
    step: S,
    event: Option<Event<S>>,
}

impl<S: Scalar> Stretch<S> {
    /// Out of contact: looks for its begin.
    fn search(&self) -> Next<S> {
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
                Next { from, step: S::LIMIT, event: Some(Event::Begin(begin)) }
            }
        }
    }

    /// In contact: looks for its end, which is where the discs are apart by the tolerance: what hovers does not flicker.
    fn follow(&self) -> Next<S> {
        let outer = self.radius + self.tolerance;
        let kept = self.chord.within(outer - self.error);
        let kept = kept.filter(|kept| kept.lo <= S::ZERO || self.chord.dives(outer, self.error));
        if kept.is_some_and(|kept| kept.hi >= self.chord.length) {
            return self.advance();
        }
        // Parts of the chord within smaller radii lie inside the part that is kept.
        let left_at = |radius: S| {
            let hi = kept.and_then(|_| self.chord.within(radius)).map(|part| part.hi);
            hi.map_or(self.now.time, |hi| self.time_at(hi))
        };
        let from = left_at(self.radius - self.error);
        let gone = self.chord.within(outer + self.error).filter(|all| all.hi < self.chord.length);
        let doubt = gone.map(|all| self.time_at(all.hi) - from);
        match self.refined(from, doubt) {
            _ if self.decides(doubt) => {
                let event = Some(Event::End(left_at(self.radius + self.error)));
                // A chord does not come back.
                let from = if kept.is_some() { self.ahead.time } else { self.now.time };
                Next { from, step: S::LIMIT, event }
            }
            Some(next) => next,
            // Times have a last digit, too: contact is what cannot be excluded.
            None => self.advance(),
        }
    }

    /// Nothing happens on the whole step.
    fn advance(&self) -> Next<S> {
        Next { from: self.ahead.time, step: self.duration.double(), event: None }
    }

    /// A shorter step, unless it would be none: the part in doubt, at most half of this one.
    fn refined(&self, from: S, doubt: Option<S>) -> Option<Next<S>> {
        let half = self.duration.half();
        let step = doubt.map_or(half, |doubt| doubt.min(half));
        (from + step > from).then_some(Next { from, step, event: None })
    }

    /// Whether the chord is as good as the motion: within the tolerance, and within a few roundings or where the next step
    /// would not be much better.
    fn decides(&self, doubt: Option<S>) -> bool {
        let quarter = |x: S| x.half().half();
        let shrinks = doubt.is_some_and(|doubt| doubt < quarter(self.duration));
        self.error <= quarter(self.tolerance) && (self.error <= self.pad.double().double().double() || !shrinks)
    }

    /// When the chord is at `x`.
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
            // No contact outlasts the windows that follow one another.
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
