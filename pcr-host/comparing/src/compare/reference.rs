//! The reference for all answers: contacts and slices by the definition, found by bisection until the distance that can
//! be travelled in the rest decides. It uses no formula of any method.

use super::disc_track::{DiscTrack, Xy, near};

/// Ends are known within this way \[m\].
const TOLERANCE: f64 = 1e-10;

/// Evaluations of a search at most: discs that touch all along would take any number.
const BUDGET: usize = 200_000;

/// A contact of two discs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceContact {
    /// From when to when \[s\].
    pub time: [f64; 2],
    /// Whether it is certain: the others are within 1e-10 m of touching only.
    pub certain: bool,
}

/// Where a function that changes no faster than its argument is at most 0, in `[lo, hi]`.
fn below(f: impl Fn(f64) -> f64, [lo, hi]: [f64; 2]) -> Vec<ReferenceContact> {
    let mut found: Vec<ReferenceContact> = Vec::new();
    let mut stack = vec![[lo, hi]];
    let mut spent = 0;
    while let Some([a, b]) = stack.pop() {
        let half = 0.5 * (b - a);
        let value = f(a + half);
        spent += 1;
        if value > half {
            continue;
        }
        let certain = value <= -half;
        if !certain && half > TOLERANCE && spent < BUDGET {
            stack.extend([[a + half, b], [a, a + half]]);
            continue;
        }
        match found.last_mut() {
            Some(last) if last.time[1] == a => {
                last.time[1] = b;
                last.certain |= certain;
            }
            _ => found.push(ReferenceContact { time: [a, b], certain }),
        }
    }
    found
}

fn distance(a: Xy, b: Xy) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// When two discs are in contact during a time \[s\].
pub fn contacts(a: &DiscTrack, b: &DiscTrack, during: [f64; 2]) -> Vec<ReferenceContact> {
    let reach = a.radius + b.radius;
    if !near(a.bounds(), b.bounds(), reach) {
        return Vec::new();
    }
    // Argument: the way that both can have travelled. Discs that stand need a speed, too.
    let speed = a.top_speed() + b.top_speed() + 1e-3;
    let clearance = |x: f64| distance(a.position(x / speed), b.position(x / speed)) - reach;
    let mut found = below(clearance, during.map(|time| time * speed));
    for contact in &mut found {
        contact.time = contact.time.map(|x| x / speed);
    }
    found
}

/// The lengths of a path within `reach` of a point \[m\].
pub fn slice(path: &DiscTrack, point: Xy, reach: f64) -> Vec<[f64; 2]> {
    let clearance = |length: f64| distance(path.at(length), point) - reach;
    below(clearance, [0.0, path.length]).into_iter().map(|part| part.time).collect()
}
