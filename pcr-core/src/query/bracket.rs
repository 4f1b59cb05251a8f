//! The end of an interval of which one place is known, bracketed by looking for contacts.
//!
//! Towards the end of what is forbidden a contact gets shorter and shorter: its duration D falls with the square root of
//! what is left, because the discs pass each other ever less deep. D² goes to 0 as a line does, and two places inside tell
//! where. That is a guess and no more: what is returned lies outside, a place inside is not further from it than the
//! resolution, and where the guesses do not help the bracket is halved.

use crate::scalar::{Scalar, Wide};

/// Places that are tried, at most; fewer where the format has fewer digits.
const TRIALS: u32 = 96;
/// Every so many trials the bracket is halved, whatever the guesses say.
const PATIENCE: u32 = 12;

/// A bracket: a place inside, with how long the contact is there, and one outside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bracket<S> {
    pub(super) inside: S,
    pub(super) outside: S,
    /// It is not made narrower than this.
    pub(super) resolution: S,
}

impl<S: Scalar> Bracket<S> {
    /// The place outside when the bracket has shrunk. `contact` tells how long the contact at a place is, `None` where
    /// there is none.
    pub(super) fn shrunk(self, contact: impl Fn(S) -> Option<S>) -> S {
        let Self { mut inside, mut outside, resolution } = self;
        // Two places inside, and the guess before.
        let (mut near, mut far, mut guess) = (contact(inside).map(|long| (inside, long)), None, None);
        for trial in 0..TRIALS {
            if (outside - inside).abs() <= resolution {
                break;
            }
            let between = |place: &S| inside.min(outside) < *place && *place < inside.max(outside);
            let next = near.zip(far).and_then(|(near, far)| vanishing(near, far)).filter(between);
            let places =
                next.filter(|_| trial % PATIENCE != 0).map(|next| beside(next, guess, inside, outside, resolution));
            guess = next;
            let place = places.and_then(|places| places.into_iter().find(between));
            let place = place.unwrap_or_else(|| inside + (outside - inside).half());
            match contact(place) {
                Some(long) => {
                    (near, far) = (Some((place, long)), near);
                    inside = place;
                }
                None => outside = place,
            }
        }
        outside
    }
}

/// Where the square of the durations at two places vanishes, on the line through both.
fn vanishing<S: Scalar>((near, short): (S, S), (far, long): (S, S)) -> Option<S> {
    if short >= long {
        return None;
    }
    // (near - far) short² / (long² - short²)
    let part = (near - far).abs().portion(short, long + short);
    let left = part.times(short).narrow().quotient(long - short);
    Some(if near < far { near - left } else { near + left })
}

/// Places to try beside a guess, as far from it as it is uncertain: short of it, which makes the next guess better, or
/// beyond it where the bracket is all but closed from inside.
fn beside<S: Scalar>(guess: S, before: Option<S>, inside: S, outside: S, resolution: S) -> [S; 2] {
    let fine = resolution.half();
    let doubt = (guess - before.unwrap_or(inside)).abs().half().half().max(fine.half());
    let (short, long) = if inside < outside { (guess - doubt, guess + doubt) } else { (guess + doubt, guess - doubt) };
    let beyond = if inside < outside { guess + fine } else { guess - fine };
    if doubt <= fine && (guess - inside).abs() <= fine { [beyond, long] } else { [short, long] }
}
