//! Finds the end of an interval of forbidden values, starting from one value inside, by searching for contacts.
//!
//! Towards the end of the forbidden interval a contact gets shorter: its duration D falls with the square root of the
//! distance to the end, because the discs overlap less and less deeply. So D² falls linearly, and two values inside
//! give a guess of the end. It is only a guess: the value that is returned has been tried, with no contact, and a value inside is no
//! further from it than the resolution. Where the guesses do not help, the bracket is bisected.
//!
//! A contact that a start or an arrival cuts off gets shorter in another way: then D itself falls linearly. Where that is possible, both guesses
//! are made, and the one that moved less since the value before is followed.

use crate::scalar::{Scalar, Wide};

/// Largest number of values that are tried; formats with fewer digits need fewer.
const TRIALS: u32 = 96;
/// The bracket is bisected once in this number of trials, whatever the guesses say.
const PATIENCE: u32 = 12;

/// What happens in a region with one value of a delay, a wait or a duration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Trial<S> {
    /// The agents come nowhere near each other where the region is.
    Clear,
    /// They meet where the region is, but at a point that belongs to another region.
    Elsewhere,
    /// They touch for this time \[s\], so slightly that the point may or may not belong to the region.
    Touch(S),
    /// They are at a point of the region, in a contact of this duration \[s\].
    Contact(S),
}

impl<S: Scalar> Trial<S> {
    /// The duration of what counts as a contact; `strictly`, one in another region counts, too.
    fn contact(self, strictly: bool) -> Option<S> {
        match self {
            Self::Touch(long) | Self::Contact(long) => Some(long),
            Self::Elsewhere if strictly => Some(S::ZERO),
            Self::Elsewhere | Self::Clear => None,
        }
    }

    /// Whether the agents are in the region for certain.
    pub(super) fn is_inside(self) -> bool {
        matches!(self, Self::Contact(_))
    }
}

/// A bracket: a value inside the forbidden interval, and one outside that was tried and is clear.
#[derive(Clone, Copy, Debug)]
pub(super) struct ForbiddenBracket<S> {
    inside: S,
    outside: S,
    /// The bracket is not made narrower than this.
    resolution: S,
    /// Whether the start or the arrival of an agent may cut a contact off.
    cut: bool,
}

impl<S: Scalar> ForbiddenBracket<S> {
    /// The bracket from a value inside to the first value that is clear, of `near`, larger steps away from it, and `far`. `None` if there is none.
    pub(super) fn new(inside: S, [near, far]: [S; 2], resolution: S, trial: &impl Fn(S) -> Trial<S>) -> Option<Self> {
        let rises = inside <= far;
        let (mut outside, mut step) = (near, (near - inside).abs().max(resolution));
        loop {
            if trial(outside) == Trial::Clear {
                return Some(Self { inside, outside, resolution, cut: false });
            }
            let next = if rises { (outside + step).min(far) } else { (outside - step).max(far) };
            // In the far range of floating point a step may change nothing.
            if next == outside {
                return None;
            }
            // Values and steps are at most twice the limit, so that no sum overflows.
            (outside, step) = (next, step.double().min(S::LIMIT.double()));
        }
    }

    /// Returns the bracket with the note whether the start or the arrival of an agent may cut a contact off.
    pub(super) fn with_cuts(self, cut: bool) -> Self {
        Self { cut, ..self }
    }

    /// The value outside, which is clear.
    pub(super) fn outside(&self) -> S {
        self.outside
    }

    /// A value that is clear, when the bracket has been narrowed down.
    pub(super) fn shrunk(self, trial: &impl Fn(S) -> Trial<S>) -> S {
        let (end, clear) = self.narrowed(trial, false);
        if end == clear {
            return clear;
        }
        // The interval of another region begins before this one ends: a contact there may hide one of this region.
        Self { inside: end, outside: clear, ..self }.narrowed(trial, true).1
    }

    /// The value outside when the bracket has been narrowed down, and the nearest one that is clear.
    fn narrowed(&self, trial: &impl Fn(S) -> Trial<S>, strictly: bool) -> (S, S) {
        let Self { mut inside, mut outside, resolution, cut } = *self;
        let mut clear = outside;
        // The last two values inside, and the previous guesses.
        let (mut near, mut far) = (trial(inside).contact(strictly).map(|long| (inside, long)), None);
        let mut before = [None; 2];
        for number in 0..TRIALS {
            if (outside - inside).abs() <= resolution {
                break;
            }
            let between = |place: &S| inside.min(outside) < *place && *place < inside.max(outside);
            let inner = near.zip(far);
            let squares = inner.and_then(|(near, far)| vanishing(near, far)).filter(between);
            let plain = inner.filter(|_| cut).and_then(|(near, far)| vanishing_cut(near, far)).filter(between);
            let guesses = [squares, plain];
            let (next, guess) = steadier(guesses, before);
            let places =
                next.filter(|_| number % PATIENCE != 0).map(|next| beside(next, guess, inside, outside, resolution));
            before = guesses;
            let place = places.and_then(|places| places.into_iter().find(between));
            let place = place.unwrap_or_else(|| inside + (outside - inside).half());
            let found = trial(place);
            match found.contact(strictly) {
                Some(long) => {
                    (near, far) = (Some((place, long)), near);
                    inside = place;
                }
                None => {
                    outside = place;
                    if found == Trial::Clear {
                        clear = place;
                    }
                }
            }
        }
        (outside, clear)
    }
}

/// Extrapolates the squares of the durations at two values linearly, and returns where they vanish.
fn vanishing<S: Scalar>((near, short): (S, S), (far, long): (S, S)) -> Option<S> {
    if short >= long {
        return None;
    }
    // (near - far) short² / (long² - short²)
    let part = (near - far).abs().portion(short, long + short);
    let left = part.times(short).narrow().quotient(long - short);
    Some(if near < far { near - left } else { near + left })
}

/// Returns the value at which a contact would vanish whose duration falls linearly, from two values inside with their durations.
fn vanishing_cut<S: Scalar>((near, short): (S, S), (far, long): (S, S)) -> Option<S> {
    if short >= long {
        return None;
    }
    // (near - far) short / (long - short)
    let left = (near - far).abs().times(short).narrow().quotient(long - short);
    Some(if near < far { near - left } else { near + left })
}

/// Of two guesses the one that is nearer to the same one before, and that one; the first one if neither is.
fn steadier<S: Scalar>([first, second]: [Option<S>; 2], before: [Option<S>; 2]) -> (Option<S>, Option<S>) {
    let moved = |now: Option<S>, before: Option<S>| now.zip(before).map(|(now, before)| (now - before).abs());
    match (moved(first, before[0]), moved(second, before[1])) {
        (Some(one), Some(other)) if other < one => (second, before[1]),
        (None, Some(_)) => (second, before[1]),
        _ => (first, before[0]),
    }
}

/// Values to try next to a guess, at a distance equal to its uncertainty: one short of it, which improves the next
/// guess, or one beyond it if the bracket is almost closed from inside.
fn beside<S: Scalar>(guess: S, before: Option<S>, inside: S, outside: S, resolution: S) -> [S; 2] {
    let fine = resolution.half();
    let doubt = (guess - before.unwrap_or(inside)).abs().half().half().max(fine.half());
    let (short, long) = if inside < outside { (guess - doubt, guess + doubt) } else { (guess + doubt, guess - doubt) };
    let beyond = if inside < outside { guess + fine } else { guess - fine };
    if doubt <= fine && (guess - inside).abs() <= fine { [beyond, long] } else { [short, long] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::cell::Cell;

    /// Contacts whose squared durations fall linearly to 0 at `end`, behind which another region hides them up to `hidden`.
    fn trial(at: f64, end: f64, hidden: f64, sign: f64) -> Trial<f64> {
        match sign * at {
            at if at <= end => Trial::Contact((end - at).sqrt()),
            at if at <= hidden => Trial::Elsewhere,
            _ => Trial::Clear,
        }
    }

    #[test]
    fn brackets_end_at_the_first_step_that_is_clear() {
        for sign in [1.0, -1.0] {
            let found = |near: f64, far: f64, end: f64| {
                let bracket =
                    ForbiddenBracket::new(-sign, [sign * near, sign * far], 1e-3, &|at| trial(at, end, end, sign));
                bracket.map(|bracket| sign * bracket.outside())
            };
            assert_eq!(found(0.5, 100.0, 0.25), Some(0.5));
            // Steps of 1.5, 3, 6 from 0.5: never farther than twice the way.
            assert_eq!(found(0.5, 100.0, 1.0), Some(2.0));
            assert_eq!(found(0.5, 100.0, 4.5), Some(5.0));
            assert_eq!(found(0.5, 4.75, 4.5), Some(4.75));
            assert_eq!(found(0.5, 4.0, 4.5), None);
        }
    }

    #[test]
    fn ends_are_clear_and_within_the_resolution() {
        for sign in [1.0, -1.0] {
            // Also around 0, where the sum of both ends is less than any resolution.
            for (from, to, end, hidden) in
                [(-1.0, 1.0, 0.3, 0.3), (-8.0, -2.0, -5.0, -5.0), (2.0, 9.0, 3.0, 7.5), (-1.0, 1.0, -0.5, 0.25)]
            {
                let count = Cell::new(0);
                let tried = |at: f64| {
                    count.set(count.get() + 1);
                    trial(at, end, hidden, sign)
                };
                let bracket = ForbiddenBracket::new(sign * from, [sign * to; 2], 1e-6, &tried).unwrap();
                let found = bracket.shrunk(&tried);
                assert_eq!(trial(found, end, hidden, sign), Trial::Clear);
                let excess = sign * found - hidden;
                assert!((0.0..=1e-6).contains(&excess), "{sign} {end} {hidden}: {excess}");
                assert!(count.get() < 2 * TRIALS as usize, "{}", count.get());
            }
        }
    }

    #[test]
    fn ends_at_which_contacts_are_cut_off_take_few_trials() {
        for sign in [1.0, -1.0] {
            for end in [-0.4, 0.05, 0.9] {
                let count = Cell::new(0);
                let tried = |at: f64| {
                    count.set(count.get() + 1);
                    if sign * at < end { Trial::Contact(end - sign * at) } else { Trial::Clear }
                };
                let bracket = ForbiddenBracket::new(-sign, [sign; 2], 1e-9, &tried).unwrap();
                let found = bracket.with_cuts(true).shrunk(&tried);
                assert_eq!(tried(found), Trial::Clear);
                let excess = sign * found - end;
                assert!((0.0..=1e-9).contains(&excess), "{sign} {end}: {excess}");
                // With the squares of the durations alone they are more than 50.
                assert!(count.get() < 12, "{sign} {end}: {}", count.get());
            }
        }
    }

    #[test]
    fn guesses_are_where_the_squares_of_durations_vanish() {
        let long = |at: f64, end: f64| (at, (end - at).abs().sqrt());
        for end in [3.0, -3.0, 0.5] {
            for side in [1.0, -1.0] {
                let [near, far] = [1.0, 4.0].map(|away| long(end - side * away, end));
                let guess = vanishing(near, far).unwrap();
                assert!((guess - end).abs() < 1e-12, "{guess} {end}");
                let [near_cut, far_cut] = [near, far].map(|(at, _)| (at, (end - at).abs()));
                let cut = vanishing_cut(near_cut, far_cut).unwrap();
                assert!((cut - end).abs() < 1e-12, "{cut} {end}");
                assert_eq!(vanishing_cut(far_cut, near_cut), None);
                assert_eq!(vanishing(far, near), None);
                assert_eq!(vanishing(near, near), None);
            }
        }
    }

    #[test]
    fn values_beside_a_guess_are_short_of_it_first_and_beyond_it_at_last() {
        for sign in [1.0, -1.0] {
            let places = |guess: f64, before: Option<f64>, inside: f64| {
                beside(sign * guess, before.map(|before| sign * before), sign * inside, sign * 10.0, 0.5)
                    .map(|place| sign * place)
            };
            // A quarter of the change of the guess, on both sides of it.
            assert_eq!(places(4.0, Some(8.0), 0.0), [3.0, 5.0]);
            assert_eq!(places(4.0, None, 0.0), [3.0, 5.0]);
            // Within half of the resolution from inside: beyond it.
            assert_eq!(places(4.0, Some(4.25), 3.875), [4.25, 4.125]);
            assert_eq!(places(4.0, Some(4.25), 3.5), [3.875, 4.125]);
        }
    }
}
