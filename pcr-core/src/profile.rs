//! Speed profiles: the map λ from time to travelled length (Eq. 1-3) and its inverse, in closed form.
//!
//! A profile is a chain of phases of constant acceleration; a phase at speed 0 is a wait. Times count from the start of
//! the motion, so a delay does not change a profile. Both maps are evaluated from the slow end of a phase, where the
//! square root of the inverse does not cancel (docs/theory/equations.md, time map).

use crate::error::{self, InvalidInput, in_range, not_negative, positive};
use crate::geometry::Interval;
use crate::scalar::{AccelerationRamp, Scalar, Wide};
use heapless::Vec;

/// A phase of a motion at constant acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Phase<S> {
    /// Time since the start of the motion \[s\].
    time: Interval<S>,
    /// Travelled length \[m\].
    length: Interval<S>,
    /// Speed at the beginning and at the end \[m/s\].
    speed: [S; 2],
    /// Acceleration \[m/s²\].
    acceleration: S,
}

impl<S: Scalar> Phase<S> {
    /// The first phase of a profile: from the speed `speed` \[m/s\], for `duration` \[s\] at `acceleration` \[m/s²\].
    ///
    /// # Errors
    /// [`InvalidInput::NonFinite`], [`InvalidInput::OutOfRange`], [`InvalidInput::Negative`] for the duration and either speed. A
    /// final speed that is negative only because of rounding is set to 0.
    pub fn starting_at(speed: S, duration: S, acceleration: S) -> Result<Self, InvalidInput> {
        not_negative(speed, "initial speed")?;
        Self::origin(speed).then(duration, acceleration)
    }

    /// An empty phase before the first one: no time, no length.
    pub(crate) fn origin(speed: S) -> Self {
        let origin = Interval::new(S::ZERO, S::ZERO);
        Self { time: origin, length: origin, speed: [speed, speed], acceleration: S::ZERO }
    }

    /// The phase that follows `self`, up to the length `to` and the speed `speed`. These are arguments and not
    /// computed, so that rounding errors do not add up.
    pub(crate) fn until(&self, duration: S, to: S, speed: S, acceleration: S) -> Self {
        Self {
            time: Interval::new(self.time.hi, self.time.hi + duration),
            length: Interval::new(self.length.hi, to),
            speed: [self.speed[1], speed],
            acceleration,
        }
    }

    /// Merges both phases if they follow one another at the same acceleration, which is not known to be that where it was rounded.
    pub(crate) fn joined(&self, next: &Self) -> Option<Self> {
        let is_same = self.acceleration == next.acceleration && self.is_exact() && next.is_exact();
        is_same.then(|| Self {
            time: Interval::new(self.time.lo, next.time.hi),
            length: Interval::new(self.length.lo, next.length.hi),
            speed: [self.speed[0], next.speed[1]],
            acceleration: self.acceleration,
        })
    }

    /// Whether the acceleration leads from one speed to the other. Rounded to a fixed-point format it may not, over a long time.
    fn is_exact(&self) -> bool {
        let [before, after] = self.speed;
        let gain = self.acceleration.times(self.time.length()).narrow();
        (before + gain - after).abs() <= S::rounding(before.max(after) + self.acceleration.abs()).double()
    }

    /// The phase that follows `self`: `duration` \[s\] at `acceleration` \[m/s²\].
    ///
    /// # Errors
    /// As [`Phase::starting_at`].
    pub fn then(&self, duration: S, acceleration: S) -> Result<Self, InvalidInput> {
        not_negative(duration, "duration")?;
        in_range(acceleration, "acceleration")?;
        let [_, before] = self.speed;
        let gain = acceleration.times(duration).narrow();
        let mut after = in_range(before + gain, "speed")?;
        if after < S::ZERO {
            // The rounding error of the acceleration is multiplied by the duration.
            if after < -(S::slack(before) + S::slack(acceleration.abs()).times(duration).narrow()) {
                return Err(InvalidInput::Negative("speed"));
            }
            after = S::ZERO;
        }
        let travelled = (before + after).times(duration).half().narrow();
        let time = Interval::new(self.time.hi, in_range(self.time.hi + duration, "duration of the profile")?);
        let length = Interval::new(self.length.hi, in_range(self.length.hi + travelled, "length of the profile")?);
        Ok(Self { time, length, speed: [before, after], acceleration })
    }

    /// The phase that follows `self`: `duration` \[s\] at the acceleration that leads to the speed `after` \[m/s\]. In fixed point this is more
    /// accurate than [`Phase::then`], where the rounding error of the acceleration counts multiplied by the duration.
    ///
    /// # Errors
    /// As [`Phase::starting_at`], and [`InvalidInput::NonPositive`] for the duration.
    ///
    /// ```
    /// # use pcr_core::Phase;
    /// let begin = Phase::starting_at(0.0, 0.0, 0.0)?;
    /// let phase = begin.then_to(4.0, 2.0)?;
    /// assert_eq!((phase.speed(), phase.acceleration(), phase.length().hi), ([0.0, 2.0], 0.5, 4.0));
    /// # Ok::<(), pcr_core::InvalidInput>(())
    /// ```
    pub fn then_to(&self, duration: S, after: S) -> Result<Self, InvalidInput> {
        positive(duration, "duration")?;
        not_negative(after, "speed")?;
        let [_, before] = self.speed;
        let acceleration = acceleration(after - before, duration)?;
        let travelled = (before + after).times(duration).half().narrow();
        in_range(self.time.hi + duration, "duration of the profile")?;
        let to = in_range(self.length.hi + travelled, "length of the profile")?;
        Ok(self.until(duration, to, after, acceleration))
    }

    /// Time since the start of the motion \[s\].
    pub fn time(&self) -> Interval<S> {
        self.time
    }

    /// Travelled length \[m\].
    pub fn length(&self) -> Interval<S> {
        self.length
    }

    /// Speed at the beginning and at the end \[m/s\].
    pub fn speed(&self) -> [S; 2] {
        self.speed
    }

    /// Acceleration \[m/s²\].
    pub fn acceleration(&self) -> S {
        self.acceleration
    }

    /// Speed at a time since the start of the motion \[m/s\].
    pub fn speed_at(&self, time: S) -> S {
        let [before, after] = self.speed;
        let (elapsed, whole) = (time.clamp(self.time.lo, self.time.hi) - self.time.lo, self.time.length());
        let gain = if whole > S::ZERO { (after - before).portion(elapsed, whole) } else { S::ZERO };
        (before + gain).clamp(before.min(after), before.max(after))
    }

    fn slows(&self) -> bool {
        self.acceleration < S::ZERO
    }

    /// Largest distance of the travelled length from a linear function of the time, over a part of the phase of this
    /// duration \[m\].
    pub(crate) fn bulge(&self, duration: S) -> S {
        S::ramp_bulge(self.ramp(), duration)
    }

    /// Whether the travelled lengths differ by a linear function of the time.
    pub(crate) fn goes_like(&self, other: &Self) -> bool {
        self.slows() == other.slows() && S::ramps_alike(self.ramp(), other.ramp())
    }

    /// The ramp that begins at the start of a phase that speeds up, or at the end of one that slows down.
    fn ramp(&self) -> AccelerationRamp<S> {
        let [before, after] = self.speed;
        let (slow, fast) = if self.slows() { (after, before) } else { (before, after) };
        let acceleration = self.acceleration.abs();
        AccelerationRamp { slow, fast, acceleration, duration: self.time.length(), length: self.length.length() }
    }

    pub(crate) fn length_at(&self, time: S) -> S {
        let elapsed = if self.slows() { self.time.hi - time } else { time - self.time.lo };
        let way = S::ramp_length(self.ramp(), elapsed);
        let length = if self.slows() { self.length.hi - way } else { self.length.lo + way };
        length.clamp(self.length.lo, self.length.hi)
    }

    pub(crate) fn time_at(&self, length: S) -> S {
        let way = if self.slows() { self.length.hi - length } else { length - self.length.lo };
        let elapsed = S::ramp_time(self.ramp(), way);
        let time = if self.slows() { self.time.hi - elapsed } else { self.time.lo + elapsed };
        time.clamp(self.time.lo, self.time.hi)
    }
}

/// The acceleration of a change of speed. Its sign tells which end is the slow one, so none is rounded to 0.
fn acceleration<S: Scalar>(change: S, duration: S) -> Result<S, InvalidInput> {
    let rounded = in_range(change.quotient(duration), "acceleration")?;
    Ok(match rounded == S::ZERO {
        true if change > S::ZERO => S::LEAST,
        true if change < S::ZERO => -S::LEAST,
        _ => rounded,
    })
}

/// Speed and acceleration that an agent may not exceed (Eq. 3).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Limits<S> {
    /// Largest speed \[m/s\].
    pub speed: S,
    /// Largest acceleration and deceleration \[m/s²\].
    pub acceleration: S,
}

/// A profile of at most `N` phases.
///
/// ```
/// use pcr_core::{Limits, Profile};
/// let limits = Limits { speed: 1.0, acceleration: 0.5 };
/// let profile = Profile::<f64, 3>::rest_to_rest(5.0, limits)?;
/// let profile = profile.as_profile();
/// assert_eq!(profile.duration(), 7.0); // 2 s to speed up, 3 s of cruise, 2 s to stop
/// assert_eq!(profile.length_at(3.5), 2.5);
/// assert_eq!(profile.first_time_at(2.5), 3.5);
/// # Ok::<(), pcr_core::InvalidInput>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Profile<S: Scalar, const N: usize> {
    phases: Vec<Phase<S>, N>,
}

impl<S: Scalar> Profile<S, 3> {
    /// The trapezoid profile over `length` \[m\] from rest to rest in the least time (Eq. 3); a triangle if the largest
    /// speed is not reached.
    ///
    /// # Errors
    /// [`InvalidInput::NonFinite`], [`InvalidInput::OutOfRange`], [`InvalidInput::Negative`] (length), [`InvalidInput::NonPositive`] (limits).
    pub fn rest_to_rest(length: S, limits: Limits<S>) -> Result<Self, InvalidInput> {
        let length = error::length(length)?;
        positive(limits.speed, "largest speed")?;
        positive(limits.acceleration, "largest acceleration")?;
        let mut phases = Vec::new();
        if length > S::ZERO {
            let peak = limits.speed.min(length.times(limits.acceleration).sqrt());
            // The only divisions of this constructor: a speed by an acceleration, a length by a speed.
            let ramp = peak.quotient(limits.acceleration);
            let ramp_length = peak.times(ramp).narrow().half().min(length.half());
            let cruise_length = (length - ramp_length.double()).max(S::ZERO);
            let cruise = cruise_length.quotient(peak);
            let end = in_range(ramp.double() + cruise, "duration of the profile")?;
            let times = [S::ZERO, ramp, ramp + cruise, end];
            let lengths = [S::ZERO, ramp_length, ramp_length + cruise_length, length];
            let speeds = [S::ZERO, peak, peak, S::ZERO];
            let accelerations = [limits.acceleration, S::ZERO, -limits.acceleration];
            let mut from = S::ZERO;
            for k in 0..3 {
                let phase = Phase {
                    time: Interval::new(times[k], times[k + 1]),
                    length: Interval::new(from, lengths[k + 1]),
                    speed: [speeds[k], speeds[k + 1]],
                    acceleration: accelerations[k],
                };
                // The length of a phase without duration is added to a neighbour, so that the agent does not jump.
                if phase.time.lo < phase.time.hi {
                    phases.push(phase).map_err(|_| InvalidInput::Full("phase"))?;
                    from = lengths[k + 1];
                }
            }
            if let Some(last) = phases.last_mut() {
                last.length.hi = length;
            }
        }
        Ok(Self { phases })
    }
}

impl<S: Scalar, const N: usize> Profile<S, N> {
    /// A profile that begins with the speed `speed` \[m/s\] and has each acceleration \[m/s²\] for its duration \[s\].
    ///
    /// # Errors
    /// As [`Phase::starting_at`], and [`InvalidInput::Full`] for more than `N` pieces.
    pub fn from_pieces(speed: S, pieces: impl IntoIterator<Item = (S, S)>) -> Result<Self, InvalidInput> {
        let mut phases: Vec<Phase<S>, N> = Vec::new();
        for (duration, acceleration) in pieces {
            let phase = match phases.last() {
                None => Phase::starting_at(speed, duration, acceleration)?,
                Some(last) => last.then(duration, acceleration)?,
            };
            phases.push(phase).map_err(|_| InvalidInput::Full("phase"))?;
        }
        Ok(Self { phases })
    }

    /// The profile, made slower or faster as a whole so that it takes `duration` \[s\]. If D is its own duration, times
    /// are multiplied by `duration` / D, speeds by D / `duration`, and accelerations by the square of that. Lengths do
    /// not change.
    ///
    /// # Errors
    /// [`InvalidInput::NonFinite`], [`InvalidInput::OutOfRange`] (also for speeds and accelerations), [`InvalidInput::NonPositive`]
    /// (duration), and [`InvalidInput::Full`] for more than `N` phases.
    pub fn stretched(profile: ProfileRef<'_, S>, duration: S) -> Result<Self, InvalidInput> {
        positive(duration, "duration")?;
        let whole = profile.duration();
        let speed = |speed: S| in_range(speed.portion(whole, duration), "speed");
        let mut phases: Vec<Phase<S>, N> = Vec::new();
        let first = profile.phases().first().map_or(S::ZERO, |first| first.speed[0]);
        let mut last = Phase::origin(speed(first)?);
        for phase in profile.phases() {
            let to = if phase.time.hi < whole { duration.portion(phase.time.hi, whole) } else { duration };
            let (time, [_, before], after) = (to - last.time.hi, last.speed, speed(phase.speed[1])?);
            // The length of a phase without duration is added to a neighbour, so that the agent does not jump.
            if time > S::ZERO {
                let acceleration = acceleration(after - before, time)?;
                last = Phase {
                    time: Interval::new(last.time.hi, to),
                    ..last.until(time, phase.length.hi, after, acceleration)
                };
                phases.push(last).map_err(|_| InvalidInput::Full("phase"))?;
            }
        }
        if let Some(last) = phases.last_mut() {
            last.length.hi = profile.length();
        }
        Ok(Self { phases })
    }

    /// Returns the profile with another capacity, for example to store the profiles of a fleet as one type.
    ///
    /// # Errors
    /// [`InvalidInput::Full`] for more than `N` phases.
    ///
    /// ```
    /// # use pcr_core::{Limits, Profile};
    /// let limits = Limits { speed: 1.0, acceleration: 1.0 };
    /// let profiles: [Profile<f64, 8>; 2] = [
    ///     Profile::copied(Profile::rest_to_rest(4.0, limits)?.as_profile())?,
    ///     Profile::from_pieces(0.5, [(8.0, 0.0)])?,
    /// ];
    /// # Ok::<(), pcr_core::InvalidInput>(())
    /// ```
    pub fn copied(profile: ProfileRef<'_, S>) -> Result<Self, InvalidInput> {
        Ok(Self { phases: Vec::from_slice(profile.phases()).map_err(|_| InvalidInput::Full("phase"))? })
    }

    /// The profile of an agent that stands: it has no phases.
    pub const fn standing() -> Self {
        Self { phases: Vec::new() }
    }

    /// Appends `next`, which follows `phase`, and sets `phase` to it. If the last phase has the same acceleration, the
    /// two are merged. A phase without duration adds nothing; its length is added to the phase that follows.
    pub(crate) fn extend(&mut self, phase: &mut Phase<S>, next: Phase<S>) -> Result<(), InvalidInput> {
        if next.time.length() <= S::ZERO {
            return Ok(());
        }
        *phase = next;
        match self.phases.last_mut().and_then(|last| Some((last.joined(&next)?, last))) {
            Some((joined, last)) => *last = joined,
            None => self.phases.push(next).map_err(|_| InvalidInput::Full("phase"))?,
        }
        Ok(())
    }

    /// The profile in the form that algorithms take.
    pub fn as_profile(&self) -> ProfileRef<'_, S> {
        ProfileRef { phases: &self.phases }
    }
}

/// A profile of any capacity, borrowed: phases that follow one another, or none for an agent that stands.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ProfileRef<'a, S> {
    phases: &'a [Phase<S>],
}

impl<'a, S: Scalar> ProfileRef<'a, S> {
    /// A profile of phases that were built one from the other.
    ///
    /// # Errors
    /// [`InvalidInput::Disconnected`] if they were not.
    pub fn new(phases: &'a [Phase<S>]) -> Result<Self, InvalidInput> {
        let mut end = (S::ZERO, S::ZERO, phases.first().map_or(S::ZERO, |first| first.speed[0]));
        for phase in phases {
            if (phase.time.lo, phase.length.lo, phase.speed[0]) != end {
                return Err(InvalidInput::Disconnected("phase"));
            }
            end = (phase.time.hi, phase.length.hi, phase.speed[1]);
        }
        Ok(Self { phases })
    }

    /// The profile of phases that were built one from the other, which was checked.
    pub(crate) const fn of(phases: &'a [Phase<S>]) -> Self {
        Self { phases }
    }

    /// The phases.
    pub fn phases(self) -> &'a [Phase<S>] {
        self.phases
    }

    /// Time from start to end \[s\].
    pub fn duration(self) -> S {
        self.phases.last().map_or(S::ZERO, |last| last.time.hi)
    }

    /// Travelled length from start to end \[m\].
    pub fn length(self) -> S {
        self.phases.last().map_or(S::ZERO, |last| last.length.hi)
    }

    /// Largest speed \[m/s\]. O(phases).
    pub fn top_speed(self) -> S {
        self.phases.iter().flat_map(|phase| phase.speed).fold(S::ZERO, S::max)
    }

    /// λ: length travelled at a time since the start \[m\]. It is constant before 0 and after the end. O(log phases).
    pub fn length_at(self, time: S) -> S {
        self.at(time).map_or(S::ZERO, |phase| phase.length_at(time.clamp(phase.time.lo, phase.time.hi)))
    }

    /// Speed at a time since the start \[m/s\]; 0 before the start and after the end. O(log phases).
    pub fn speed_at(self, time: S) -> S {
        if time < S::ZERO || time > self.duration() {
            return S::ZERO;
        }
        self.at(time).map_or(S::ZERO, |phase| phase.speed_at(time))
    }

    /// Inverse of λ: first time since the start at which `length` \[m\] is reached. O(log phases).
    pub fn first_time_at(self, length: S) -> S {
        let index = self.phases.partition_point(|phase| phase.length.hi < length);
        match self.phases.get(index) {
            Some(phase) if length <= phase.length.lo => phase.time.lo,
            Some(phase) => phase.time_at(length),
            None => self.duration(),
        }
    }

    /// Inverse of λ: last time since the start at which `length` \[m\] is not exceeded, after any wait there.
    /// O(log phases).
    #[cfg_attr(feature = "std", inline(always))]
    pub fn last_time_at(self, length: S) -> S {
        let index = self.phases.partition_point(|phase| phase.length.lo <= length);
        match index.checked_sub(1).and_then(|last| self.phases.get(last)) {
            Some(phase) if phase.length.hi <= length => phase.time.hi,
            Some(phase) => phase.time_at(length),
            None => S::ZERO,
        }
    }

    fn at(self, time: S) -> Option<&'a Phase<S>> {
        let index = self.phases.partition_point(|phase| phase.time.hi < time);
        self.phases.get(index).or(self.phases.last())
    }
}
