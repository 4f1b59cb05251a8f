//! Finds the end of an interval of forbidden values, starting from one value inside, by searching for contacts.
//!
//! Towards the end of the forbidden interval a contact gets shorter: its duration D falls with the square root of the
//! distance to the end, because the discs overlap less and less deeply. So D² falls linearly, and two values inside
//! give a guess of the end. It is only a guess: the value that is returned lies outside, and a value inside is no
//! further from it than the resolution. Where the guesses do not help, the bracket is bisected.

use crate::scalar::{Scalar, Wide};

/// Largest number of values that are tried; formats with fewer digits need fewer.
const TRIALS: u32 = 96;
/// The bracket is bisected once in this number of trials, whatever the guesses say.
const PATIENCE: u32 = 12;

/// A bracket: a value inside the forbidden interval, and one outside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bracket<S> {
    pub(super) inside: S,
    pub(super) outside: S,
    /// The bracket is not made narrower than this.
    pub(super) resolution: S,
}

impl<S: Scalar> Bracket<S> {
    /// The value outside when the bracket has been narrowed down. `contact` returns the duration of the contact at a
    /// value, `None` if there is no contact.
    pub(super) fn shrunk(self, contact: impl Fn(S) -> Option<S>) -> S {
        let Self { mut inside, mut outside, resolution } = self;
        // The last two values inside, and the previous guess.
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

/// Values to try next to a guess, at a distance equal to its uncertainty: one short of it, which improves the next
/// guess, or one beyond it if the bracket is almost closed from inside.
fn beside<S: Scalar>(guess: S, before: Option<S>, inside: S, outside: S, resolution: S) -> [S; 2] {
    let fine = resolution.half();
    let doubt = (guess - before.unwrap_or(inside)).abs().half().half().max(fine.half());
    let (short, long) = if inside < outside { (guess - doubt, guess + doubt) } else { (guess + doubt, guess - doubt) };
    let beyond = if inside < outside { guess + fine } else { guess - fine };
    if doubt <= fine && (guess - inside).abs() <= fine { [beyond, long] } else { [short, long] }
}
