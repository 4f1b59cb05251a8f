//! Converts the speed profile of a scenario to phases of the core.

use super::{HostScalar, RangeProblem, derived, number};
use pcr_core::Phase;
use pcr_formats::scenario::speed_after;

/// Rounds in which the last digits of the travelled length are settled. One does it; a second one mends
/// its rounding.
const ROUNDS: usize = 3;

/// Share of the longest way of a piece from which on it may be made longer or shorter.
const SHARE: f64 = 0.125;

/// Piece of the profile (from 0) where there is one, and what is wrong.
type PhaseFault = (Option<usize>, RangeProblem);

/// The phases of `pieces` (durations \[s\] and accelerations \[m/s²\]) from speed `v0` \[m/s\].
///
/// Each phase aims at the speed that the piece reaches exactly, so that speeds do not drift and a stop is a stop. What
/// rounding leaves of the difference to `length` \[m\] goes into the duration of the fastest piece that is not short, where it
/// costs the least time.
///
/// # Errors
/// The piece (from 0), if it is one, and what is wrong: a number that does not fit the format.
pub fn phases<S: HostScalar>(v0: f64, pieces: &[(f64, f64)], length: S) -> Result<Vec<Phase<S>>, PhaseFault> {
    let targets = targets(v0, pieces);
    let mean = |k: usize| 0.5 * (targets.get(k).copied().unwrap_or(v0) + targets.get(k + 1).copied().unwrap_or(0.0));
    let way = |k: usize| pieces.get(k).map_or(0.0, |(duration, _)| duration * mean(k));
    let longest = (0..pieces.len()).map(way).fold(0.0, f64::max);
    // A short one may not have as much to give.
    let moving = (0..pieces.len()).filter(|&k| way(k) > 0.0 && way(k) >= SHARE * longest);
    let fastest = moving.max_by(|&a, &b| mean(a).total_cmp(&mean(b)));
    let first = number::<S>("v0", v0).map_err(|problem| (None, problem))?;
    let mut correction = 0.0;
    let mut phases = Vec::<Phase<S>>::new();
    for _ in 0..ROUNDS {
        phases.clear();
        let mut speed = first;
        for (k, (&(duration, _), &after)) in pieces.iter().zip(targets.iter().skip(1)).enumerate() {
            let longer = if Some(k) == fastest { correction } else { 0.0 };
            let next = phase(phases.last(), speed, after, duration + longer).map_err(|problem| (Some(k), problem))?;
            phases.push(next.0);
            speed = next.1;
        }
        let travelled = phases.last().map_or(S::ZERO, |last| last.length().hi);
        let short = (length - travelled).to_f64();
        match fastest {
            Some(fastest) if short != 0.0 && mean(fastest) > 0.0 => correction += short / mean(fastest),
            _ => break,
        }
    }
    Ok(phases)
}

/// The speeds at the joints of the pieces, one more than there are pieces.
fn targets(v0: f64, pieces: &[(f64, f64)]) -> Vec<f64> {
    let (mut speed, mut fastest) = (v0, v0);
    let mut speeds = vec![v0];
    for (duration, accel) in pieces {
        speed = speed_after(speed + accel * duration, fastest);
        fastest = fastest.max(speed);
        speeds.push(speed);
    }
    speeds
}

/// The phase that follows `last` from the speed `before` to the speed `after`, and the speed that it reaches. A phase that the format
/// takes as one of no duration reaches none.
fn phase<S: HostScalar>(
    last: Option<&Phase<S>>,
    before: S,
    after: f64,
    duration: f64,
) -> Result<(Phase<S>, S), RangeProblem> {
    // A speed that the format takes as 0 is none, unless a last digit of a length is travelled with it.
    let stands = S::from_f64(after) == S::ZERO && after * duration <= S::slack(S::ZERO).to_f64();
    let after = if stands { S::ZERO } else { number("speed", after)? };
    let duration = number::<S>("duration", duration)?;
    let begin = |duration| Phase::starting_at(before, duration, S::ZERO);
    let phase = match (last, duration > S::ZERO) {
        (None, false) => begin(duration),
        (Some(last), false) => last.then(duration, S::ZERO),
        (None, true) => begin(S::ZERO).and_then(|begin| begin.then_to(duration, after)),
        (Some(last), true) => last.then_to(duration, after),
    };
    Ok((phase.map_err(derived::<S>)?, if duration > S::ZERO { after } else { before }))
}
