//! Delays with which two discs do not touch, all of an interval of them.
//!
//! Let the second agent set off later by τ. While it is anywhere between τ - h and τ + h, it is never farther than `V h` from where it is
//! with τ, V being its top speed: before it sets off and after its arrival it stands. So if two discs do not touch with the delay τ while
//! the second one is larger by `V h`, and there for longer by h before and after its motion, they touch with none of the delays from τ - h
//! to τ + h. Intervals are halved until that is shown, or a contact.

use crate::data::{Agent, Travel};
use crate::motion::meetings;
use crate::mover::Mover;

/// What is shown of the delays of an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shown {
    /// With none of them the discs touch.
    Free,
    /// With this delay they do \[s\].
    Contact(f64),
    /// With this delay they come so near that rounding leaves it open \[s\].
    Undecided(f64),
}

/// Intervals of one gap at most.
const MOST: usize = 10_000;

/// Two agents, each of which is there from its start until it arrives only.
#[derive(Clone, Debug)]
pub struct Later {
    first: Mover,
    second: Agent,
    start: f64,
    /// Largest speed of the second agent \[m/s\].
    speed: f64,
    /// Duration of the motion of each agent \[s\].
    durations: [f64; 2],
}

impl Later {
    /// The two agents, of which the first sets off at 0 and the second at a delay.
    ///
    /// # Errors
    /// What is wrong with an agent.
    pub fn new(first: &Agent, second: &Agent) -> Result<Self, String> {
        let travel = |agent: &Agent| agent.travel.clone().ok_or_else(|| format!("agent {}: no motion", agent.id));
        let (own, their) = (travel(first)?, travel(second)?);
        let [of_own, of_their] = [&own, &their].map(|travel| travel.phases.last().map_or(0.0, |last| last.time[1]));
        let speed = their.phases.iter().flat_map(|phase| phase.speed).fold(0.0, f64::max);
        // The speed at the faster end of a phase follows from its way, too.
        let mean = their.phases.iter().filter(|phase| phase.time[1] > phase.time[0]).map(|phase| {
            let [way, time] = [phase.length, phase.time].map(|[from, to]| to - from);
            2.0 * way / time - phase.speed[0].min(phase.speed[1])
        });
        let speed = mean.fold(speed, f64::max) * (1.0 + 1e-9);
        if !speed.is_finite() || own.start != 0.0 || their.start != 0.0 {
            return Err(format!("agents {} and {}: starts at 0 and speeds are expected", first.id, second.id));
        }
        let (first, second, start) = (Mover::new(first, [0.0, of_own])?, second.clone(), their.start);
        Ok(Self { first, second, start, speed, durations: [of_own, of_their] })
    }

    /// The delays with which both are there at one time \[s\].
    pub fn together(&self) -> [f64; 2] {
        [-self.durations[1], self.durations[0]]
    }

    /// Whether the discs touch with any delay from `from` to `to`, both included, and the number of intervals that this took.
    ///
    /// # Errors
    /// What is wrong with an agent, such as a start beyond all that is checked.
    pub fn between(&self, [from, to]: [f64; 2]) -> Result<(Shown, usize), String> {
        let [least, most] = self.together();
        let mut rest = vec![[from.max(least), to.min(most)]];
        let mut taken = 0;
        if from > to || !rest.iter().all(|[lo, hi]| lo <= hi) {
            return Ok((Shown::Free, taken));
        }
        // The ends themselves first: they are what is told.
        for end in [from, to].into_iter().filter(|end| (least..=most).contains(end)) {
            match self.at(end, 0.0)? {
                Shown::Free => {}
                other => return Ok((other, taken)),
            }
        }
        while let Some([lo, hi]) = rest.pop() {
            taken += 1;
            let middle = lo + 0.5 * (hi - lo);
            let half = (hi - middle).max(middle - lo) * (1.0 + f64::EPSILON);
            if self.at(middle, half)? == Shown::Free {
                continue;
            }
            match self.at(middle, 0.0)? {
                Shown::Free => {}
                other => return Ok((other, taken)),
            }
            if middle <= lo || middle >= hi || taken >= MOST {
                // Between two numbers there is no delay; what is left after so many is not decided.
                match taken >= MOST {
                    true => return Ok((Shown::Undecided(middle), taken)),
                    false => continue,
                }
            }
            rest.extend([[middle, hi], [lo, middle]]);
        }
        Ok((Shown::Free, taken))
    }

    /// With all delays within `half` of this one.
    fn at(&self, delay: f64, half: f64) -> Result<Shown, String> {
        let travel = self.second.travel.clone().map(|travel| Travel { start: self.start + delay, ..travel });
        let radius =
            (self.second.radius + self.speed * half) * (1.0 + if half > 0.0 { 4.0 * f64::EPSILON } else { 0.0 });
        let second = Agent { radius, travel, ..self.second.clone() };
        let time = if half > 0.0 {
            let (begin, end) = (delay - half, delay + self.durations[1] + half);
            [begin - f64::EPSILON * begin.abs(), end + 2.0 * f64::EPSILON * end.abs()]
        } else {
            [delay, arrival(delay, self.durations[1])]
        };
        let found = meetings(&[self.first.clone(), Mover::new(&second, time)?]);
        Ok(match (found.contacts.is_empty(), found.undecided.is_empty()) {
            (false, _) => Shown::Contact(delay),
            (true, false) => Shown::Undecided(delay),
            (true, true) => Shown::Free,
        })
    }
}

/// The sum, rounded up.
fn arrival(start: f64, duration: f64) -> f64 {
    let sum = start + duration;
    let rest = (start - (sum - duration)) + (duration - (sum - (sum - duration)));
    if rest > 0.0 { sum.next_up() } else { sum }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{Angle, Path, Phase, Segment};

    /// A disc of 0.25 m that goes a line of 4 m at 1 m/s.
    fn line(id: u64, start: [f64; 2], turns: f64) -> Agent {
        let segments = vec![Segment { length: 4.0, radius: None, turns: Vec::new(), from: 0.0, to: 4.0 }];
        let path = Path { start, heading: Angle::Turns(turns), segments, rounding: 0.0, step: 0.0 };
        let phases = vec![Phase { time: [0.0, 4.0], length: [0.0, 4.0], speed: [1.0; 2] }];
        Agent { id, radius: 0.25, path, travel: Some(Travel { start: 0.0, phases, lag: 0.0, time_excess: 0.0 }) }
    }

    fn crossing() -> Later {
        Later::new(&line(1, [-2.0, 0.0], 0.0), &line(2, [0.0, -2.0], 0.25)).expect("two agents")
    }

    /// At right angles discs of 0.25 m touch with delays of up to 0.5 √2 s.
    const END: f64 = std::f64::consts::FRAC_1_SQRT_2;

    #[test]
    fn the_delays_outside_of_what_is_forbidden_are_free() {
        let all = crossing();
        assert_eq!(all.together(), [-4.0, 4.0]);
        for beyond in [1e-12, 1e-9, 1e-3] {
            for gap in [[END + beyond, 4.0], [-4.0, -END - beyond], [END + beyond, 1e9], [4.1, 9.0], [1.0, 1.0]] {
                let (shown, taken) = all.between(gap).expect("numbers");
                assert!(shown == Shown::Free && taken < 500, "{gap:?}: {shown:?} after {taken}");
            }
        }
    }

    #[test]
    fn a_contact_is_found_at_an_end_and_in_between() {
        let all = crossing();
        assert!(matches!(all.between([END - 1e-9, 4.0]), Ok((Shown::Contact(delay), _)) if delay == END - 1e-9));
        assert!(matches!(all.between([-4.0, -END + 1e-9]), Ok((Shown::Contact(delay), _)) if delay == -END + 1e-9));
        // Both ends are free.
        let (shown, _) = all.between([-3.0, 3.0]).expect("numbers");
        assert!(matches!(shown, Shown::Contact(delay) if delay.abs() < END), "{shown:?}");
        // Just at contact: neither.
        assert!(!matches!(all.between([END, END]), Ok((Shown::Contact(_), _))));
    }

    #[test]
    fn who_has_arrived_is_in_nobodys_way() {
        // One behind the other on the same line: the end of the first is the start of the second.
        let all = Later::new(&line(1, [-4.0, 0.0], 0.0), &line(2, [0.0, 0.0], 0.0)).expect("two agents");
        assert!(matches!(all.between([4.0, 5.0]), Ok((Shown::Contact(_), _))));
        assert_eq!(all.between([4.0_f64.next_up(), 5.0]).expect("numbers").0, Shown::Free);
    }
}
