//! Values that a query calls free, judged by [`pcr_certify`], which shares no code with the library: with a delay, a duration or a wait that
//! is free, the motions as the library builds them have to be apart at all times.
//!
//! The judge needs no tolerance: whatever rounds a motion that is built is part of that motion. Scenes aim at what is hard: long times, motions from
//! rest to rest, coordinates as far out as the format has them, and ends of intervals where discs touch along a line. Directed search changes one
//! number of a scene at a time, and keeps what leaves less clearance at an end.

use crate::case_ranges::{Total, in_every_format};
use crate::disc::{Course, Disc, Drive, Driven, Leg};
use crate::generators::{Dice, drive, leg};
use crate::oracle::Pair;
use pcr_certify::motion::{Mover, meetings};
use pcr_core::{Encounter, Interval, Motion, Profile, RegionRef, earliest_start, excess, least_duration, union};
use pcr_planning::checker_input;
use pcr_planning::fleet::{HostScalar, build_ecm};
use std::f64::consts::{FRAC_PI_2, PI};

/// Phases of a profile, at most.
const PHASES: usize = 16;

/// Two discs in motion.
pub type Scene = [Driven; 2];

/// What has come of many scenes.
#[derive(Clone, Debug, Default)]
pub struct Ends {
    /// Scenes with a region.
    pub scenes: u64,
    /// Free values that were judged.
    pub values: u64,
    /// Of these, ends of intervals and results of searches.
    pub ends: u64,
    /// The least clearance at an end, in parts of [`excess`], and the number of the scene.
    pub least: Option<(f64, u64)>,
    /// Free values at which the motions are not apart.
    pub lost: Vec<String>,
    /// Ends of deep regions that were compared with the exact ones.
    pub compared: u64,
    /// Those that are farther out than the bound says.
    pub wide: Vec<String>,
}

impl Total for Ends {
    fn add(&mut self, other: &Self) {
        self.scenes += other.scenes;
        self.values += other.values;
        self.ends += other.ends;
        self.lost.extend_from_slice(&other.lost);
        self.compared += other.compared;
        self.wide.extend_from_slice(&other.wide);
        let both = [self.least, other.least].into_iter().flatten();
        self.least = both.min_by(|a, b| a.0.total_cmp(&b.0));
    }
}

impl Ends {
    /// The headings of [`Ends::row`].
    pub const HEADINGS: &str =
        "| format | not apart | scenes | free values | smallest clearance | its scene |\n|---|---|---|---|---|---|";

    /// A row of the table in `docs/theory/errors.md`.
    pub fn row(&self, format: &str) -> String {
        let Self { scenes, values, least, lost, .. } = self;
        let [least, seed] = match least {
            Some((least, seed)) => [format!("{least:.3}"), seed.to_string()],
            None => [const { String::new() }; 2],
        };
        format!("| <a id=\"f-{format}\"></a>`{format}` | {} | {scenes} | {values} | {least} | {seed} |", lost.len())
    }
}

/// Whether two motions are proved to be apart by more than a distance \[m\] during a time \[s\]. The headings are those at the starts of their paths.
///
/// # Panics
/// If the checker does not take a motion of the library.
pub fn apart<S: HostScalar>(motions: [&Motion<'_, S>; 2], headings: [f64; 2], time: [f64; 2], more: f64) -> bool {
    let mover = |place: usize| {
        let heading = S::angle(headings[place]).expect("an angle");
        let mut agent = checker_input::agent(place as u64, motions[place], heading, &[]);
        // Less than the radius of one disc may be taken from both.
        let [own, their] = motions.map(|motion| motion.radius().to_f64());
        agent.radius +=
            if more < 0.0 { more * [own, their][place] / (own + their) } else { more * (1.0 - place as f64) };
        Mover::new(&agent, time).expect("a motion of the library")
    };
    let found = meetings(&[mover(0), mover(1)]);
    found.contacts.is_empty() && found.undecided.is_empty()
}

/// Two motions, and the headings at their starts.
struct Both<'a, S: HostScalar> {
    fleet: [Motion<'a, S>; 2],
    headings: [f64; 2],
}

impl<S: HostScalar> Both<'_, S> {
    /// Whether the other agent and the ego in another motion along its path are proved to be apart.
    fn apart(&self, ego: &Motion<'_, S>, time: [f64; 2], more: f64) -> bool {
        apart([ego, &self.fleet[1]], self.headings, time, more)
    }

    /// The largest clearance up to 16 ε for which they are apart, in parts of ε.
    fn clearance(&self, ego: &Motion<'_, S>, time: [f64; 2]) -> f64 {
        let unit = excess(ego, &self.fleet[1]).to_f64();
        let (mut least, mut most) = (0.0, 16.0);
        for _ in 0..11 {
            let middle = 0.5 * (least + most);
            if self.apart(ego, time, middle * unit) {
                least = middle;
            } else {
                most = middle;
            }
        }
        least
    }

    /// Judges the ego's motion with a value that is free.
    fn judge(&self, what: &str, value: S, ego: &Motion<'_, S>, time: [f64; 2], is_end: bool, found: &mut Ends) {
        found.values += 1;
        if !self.apart(ego, time, 0.0) {
            found.lost.push(format!("{what} {value:?}"));
        } else if is_end {
            found.ends += 1;
            let least = self.clearance(ego, time);
            if found.least.is_none_or(|(known, _)| least < known) {
                found.least = Some((least, 0));
            }
        }
    }
}

impl<S: HostScalar> Both<'_, S> {
    /// Compares the ends of what deep regions forbid: just inside of an end, discs that are larger by what the bound allows meet.
    fn compare<'r>(&self, row: impl Iterator<Item = RegionRef<'r, S>>, discs: [&Disc; 2], found: &mut Ends)
    where
        S: 'r,
    {
        let pair = Pair::new(discs[0], discs[1]);
        let all = self.fleet[0].time().hull(self.fleet[1].time());
        let latest = all.lo.abs().max(all.hi.abs());
        let resolution = S::tolerance(all.length()).max(S::rounding(latest).double().double());
        for region in row {
            let lengths = region.other_length();
            let depths =
                (1..16).map(|k| lengths.lo.to_f64() + lengths.length().to_f64() * f64::from(k) / 16.0).flat_map(|at| {
                    let at = region.other_motion().time_in(Interval::new(S::from_f64(at), S::from_f64(at))).lo;
                    let s = region.other_motion().length_at(at).to_f64();
                    let slices: Vec<f64> =
                        region.slice_at(at).map(|slice| pair.clearance(s, slice.middle().to_f64())).collect();
                    slices
                });
            let tolerance = Encounter::new(&self.fleet[0], &self.fleet[1]).tolerance().to_f64();
            if depths.fold(f64::INFINITY, f64::min) > -8.0 * tolerance {
                continue;
            }
            for (what, passing, Interval { lo, hi }) in
                [("delay", false, region.forbidden_delays()), ("passing", true, region.passing_delays())]
            {
                for (end, inward) in [(lo, resolution.double()), (hi, -resolution.double())] {
                    let Ok(ego) = self.fleet[0].delayed(end + inward) else { continue };
                    if end.abs() >= S::LIMIT {
                        continue;
                    }
                    // An allowance and a tolerance; the times that the allowance is for may be later than these.
                    let more = 3.0 * tolerance.max(Encounter::new(&ego, &self.fleet[1]).tolerance().to_f64());
                    let (own, their) = (ego.time(), self.fleet[1].time());
                    let under_way = [own.lo.max(their.lo).to_f64(), own.hi.min(their.hi).to_f64()];
                    found.compared += 1;
                    if self.apart(&ego, if passing { under_way } else { ALWAYS }, more) {
                        found.wide.push(format!("{what} {end:?}"));
                    }
                }
            }
        }
    }
}

const ALWAYS: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// The finite ends of disjoint intervals, and free values beyond them.
fn free_values<S: HostScalar>(forbidden: &[Interval<S>], beyond: bool, dice: &mut Dice) -> Vec<(S, bool)> {
    let mut values = Vec::new();
    for interval in forbidden {
        for (end, sign) in [(interval.lo, -1.0), (interval.hi, 1.0)].into_iter().filter(|(end, _)| end.abs() < S::LIMIT)
        {
            values.push((end, true));
            if beyond {
                let away =
                    (0..10).map(|_| end.to_f64() + sign * (1.0 + end.to_f64().abs()) * dice.magnitude(1e-16, 3.0));
                let next = [1.0, 2.0, 3.0].map(|digits| end.to_f64() + sign * digits * S::STEP);
                values.extend(
                    away.chain(next)
                        .filter(|value| value.abs() < S::LIMIT.to_f64())
                        .map(|value| (S::from_f64(value), false)),
                );
            }
        }
    }
    let is_free = |value: S| !forbidden.iter().any(|interval| interval.lo < value && value < interval.hi);
    values.retain(|&(value, _)| is_free(value));
    values
}

/// The course of a disc whose path ends where its profile does: the judge takes the difference for a place that is not known.
fn fitted<S: HostScalar>(driven: &Driven) -> Option<(Course<S>, Driven)> {
    let mut driven = driven.clone();
    for _ in 0..3 {
        let (course, rounded) = Course::<S>::rounded(&driven)?;
        let motion = course.motion();
        let gap = (motion.profile().length() - motion.path().length()).to_f64();
        if gap == 0.0 {
            return Some((course, rounded));
        }
        driven = rounded;
        let last = driven.0.legs.last_mut()?;
        *last = last.with_length(last.length() + gap);
    }
    Course::<S>::rounded(&driven)
}

/// Judges what the queries call free in a scene; `None` if it does not fit the format or has no region. With `beyond`, also values next to the ends of
/// intervals and far from them.
pub fn judged<S: HostScalar>(scene: &Scene, beyond: bool, seed: u64) -> Option<Ends> {
    let dice = &mut Dice::seeded(seed ^ 0x5eed);
    let courses = scene.each_ref().map(fitted::<S>);
    let [Some((own, (disc, ..))), Some((their, (other, ..)))] = courses else { return None };
    let both = Both { fleet: [own.motion(), their.motion()], headings: [disc.start[2], other.start[2]] };
    let fleet = &both.fleet;
    let ecm = build_ecm(fleet).ok()?;
    let row = || ecm.row(fleet, 0).expect("the table of the fleet");
    row().next()?;
    let mut found = Ends { scenes: 1, ..Ends::default() };
    let delayed = |delay: S| fleet[0].delayed(delay).ok();
    let forbidden: Vec<Interval<S>> = union(row().map(|region| region.forbidden_delays())).collect();
    for (delay, is_end) in free_values(&forbidden, beyond, dice) {
        let Some(ego) = delayed(delay) else { continue };
        both.judge("delay", delay, &ego, ALWAYS, is_end, &mut found);
    }
    let passing: Vec<Interval<S>> = union(row().map(|region| region.passing_delays())).collect();
    for (delay, is_end) in free_values(&passing, beyond, dice) {
        let Some(ego) = delayed(delay) else { continue };
        let ends = |motion: &Motion<'_, S>| {
            let start = motion.time().lo.to_f64();
            [start, start + motion.profile().duration().to_f64()]
        };
        let ([a, b], [c, d]) = (ends(&ego), ends(&fleet[1]));
        let time = [a.max(c), b.min(d)];
        if time[0] <= time[1] {
            both.judge("passing", delay, &ego, time, is_end, &mut found);
        }
    }
    if beyond {
        both.compare(row(), [&disc, &other], &mut found);
    }
    for from in [S::ZERO, fleet[1].time().lo - fleet[0].time().hi] {
        if let Some(delay) = earliest_start(row(), from) {
            both.judge("start", delay, &fleet[0].delayed(delay).expect("a delay"), ALWAYS, delay > from, &mut found);
        }
    }
    let own = fleet[0].profile();
    if own.duration() <= S::ZERO {
        return Some(found);
    }
    let regions: Result<Vec<_>, _> =
        row().map(|region: RegionRef<'_, S>| region.forbidden_durations::<PHASES>()).collect();
    let forbidden: Vec<Interval<S>> = union(regions.expect("room").into_iter().flatten()).collect();
    let mut stretched = |what: &str, duration: S, is_end: bool| {
        let Ok(profile) = Profile::<S, PHASES>::stretched(own, duration) else { return };
        let Ok(ego) = fleet[0].with_profile(profile.as_profile(), fleet[0].time().lo) else { return };
        both.judge(what, duration, &ego, ALWAYS, is_end, &mut found);
    };
    for (duration, is_end) in free_values(&forbidden, beyond, dice).into_iter().filter(|(value, _)| *value > S::ZERO) {
        stretched("duration", duration, is_end);
    }
    for from in [own.duration(), own.duration().half().half()].into_iter().filter(|from| *from > S::ZERO) {
        if let Ok(Some(duration)) = least_duration::<S, PHASES>(row(), from) {
            stretched("least duration", duration, duration > from);
        }
    }
    Some(found)
}

/// The scene of this number.
pub fn scene<S: HostScalar>(seed: u64) -> Scene {
    let dice = &mut Dice::seeded(seed);
    let limit = S::LIMIT.to_f64();
    // 0.9 of the farthest that the format has, or coordinates of UTM.
    let far = [[0.0; 2], [1000.0_f64.min(0.5 * limit); 2], [5e5_f64.min(0.5 * limit), 5.4e6_f64.min(0.9 * limit)]];
    let [x, y] = far[dice.below(3)];
    let line = |radius: f64, [x, y, heading]: [f64; 3], length: f64| Disc {
        radius,
        start: [x, y, heading],
        legs: vec![Leg::Line(length)],
    };
    match seed % 5 {
        // A crossing near the end of the ego's path, which the other one passes long after the start.
        0 => {
            let (length, radius) = (dice.range(2.0, 12.0), dice.range(0.1, 0.5));
            let time = dice.magnitude(3.0, 0.8 * limit.min(1e5));
            let steady = |length: f64| Drive::Pieces(1.0, vec![(length, 0.0)]);
            let other = line(radius, [length - 0.5 * radius, -2.0, FRAC_PI_2], 4.0);
            [(line(radius, [0.0; 3], length), steady(length), 0.0), (other, steady(4.0), time)]
        }
        // From rest to rest, at any angle, far out.
        1 => {
            let (angle, radius) = (dice.range(0.3, PI - 0.3), dice.range(0.2, 0.6));
            let [before, after, own] = [dice.range(1.5, 4.0), dice.range(1.5, 4.0), dice.range(3.0, 6.0)];
            let (sin, cos) = angle.sin_cos();
            let at = dice.range(1.0, own - 1.0);
            let limits = |dice: &mut Dice| Drive::Limits(dice.range(0.5, 1.5), dice.range(0.2, 1.5));
            let other = line(radius, [x + at - before * cos, y - before * sin, angle], before + after);
            let drives = [limits(dice), limits(dice)];
            let [own_drive, other_drive] = drives;
            [(line(radius, [x, y, 0.0], own), own_drive, 0.0), (other, other_drive, dice.range(0.0, 3.0))]
        }
        // The other one's line is tangent to the disc at the ego's start or end, or beside its line.
        2 => {
            let (radius, own, length) = (dice.range(0.2, 0.5), dice.range(2.0, 5.0), dice.range(2.0, 6.0));
            let off =
                2.0 * radius + dice.sign() * dice.magnitude(1e-16, 1e-3) * if dice.chance(0.8) { 1.0 } else { 0.0 };
            let start = match dice.below(3) {
                0 => [x + own + off, y - 0.5 * length, FRAC_PI_2],
                1 => [x - off, y - 0.5 * length, FRAC_PI_2],
                _ => [x + dice.range(-1.0, 1.0), y + off, if dice.chance(0.5) { 0.0 } else { PI }],
            };
            let drives = [drive(dice, own), drive(dice, length)];
            let [own_drive, other_drive] = drives;
            [
                (line(radius, [x, y, 0.0], own), own_drive, dice.range(0.0, 2.0)),
                (line(radius, start, length), other_drive, dice.range(0.0, 2.0)),
            ]
        }
        // Any paths and profiles, today or long after the time 0.
        kind => {
            let late = if kind == 3 { 0.0 } else { dice.magnitude(1.0, 0.8 * limit.min(1e5)) };
            [(); 2].map(|()| {
                let start = [x + dice.range(-2.0, 2.0), y + dice.range(-2.0, 2.0), dice.range(-PI, PI)];
                let legs = (0..1 + dice.below(3)).map(|_| leg(dice)).collect();
                let disc = Disc { radius: dice.range(0.05, 0.4), start, legs };
                let drive = drive(dice, disc.rounded::<S>().length());
                (disc, drive, late + dice.range(0.0, 5.0))
            })
        }
    }
}

/// The scenes of these numbers.
pub fn scenes<S: HostScalar>(first: u64, count: u64) -> Ends {
    let mut all = Ends::default();
    for seed in first..first + count {
        if let Some(found) = judged::<S>(&scene::<S>(seed), true, seed) {
            all.add(&numbered(found, seed));
        }
    }
    all
}

fn numbered(mut found: Ends, seed: u64) -> Ends {
    found.least = found.least.map(|(least, _)| (least, seed));
    found.lost.iter_mut().chain(&mut found.wide).for_each(|value| *value = format!("scene {seed}: {value}"));
    found
}

/// Directed search from the scenes of these numbers: each step changes one number, and is kept unless it leaves more clearance.
pub fn searches<S: HostScalar>(first: u64, count: u64, steps: u64) -> Ends {
    let mut all = scenes::<S>(first, count);
    for seed in first..first + count {
        let mut at = scene::<S>(seed);
        let Some((mut least, _)) = judged::<S>(&at, false, seed).and_then(|found| found.least) else { continue };
        for step in 0..steps {
            let next = changed(&at, &mut Dice::seeded(seed.wrapping_mul(0x1_0000_0001).wrapping_add(step)));
            let Some(found) = judged::<S>(&next, false, seed) else { continue };
            if let Some((less, _)) = found.least.filter(|(less, _)| *less <= least) {
                (at, least) = (next, less);
            }
            all.add(&Ends { scenes: 0, ..numbered(found, seed) });
        }
    }
    all
}

/// One number of the scene, changed.
fn changed(scene: &Scene, dice: &mut Dice) -> Scene {
    let mut scene = scene.clone();
    let place = dice.below(2);
    let (disc, drive, start) = &mut scene[place];
    let by = 1.0 + dice.sign() * dice.magnitude(1e-15, 0.1);
    let off = dice.sign() * dice.magnitude(1e-12, 0.1);
    match dice.below(7) {
        0 => *start += off,
        1 => disc.radius *= by,
        2 => disc.start[0] += off,
        3 => disc.start[1] += off,
        4 => disc.start[2] += off,
        5 => match drive {
            Drive::Limits(speed, acceleration) => *(if dice.chance(0.5) { speed } else { acceleration }) *= by,
            Drive::Unit | Drive::Pieces(..) => *start += off,
        },
        _ => *start *= by,
    }
    scene
}

/// A search of so many scenes from a first one on, by so many steps.
pub type Search = fn(u64, u64, u64) -> Ends;

/// The formats by name.
pub const FORMATS: [(&str, Search); 6] = in_every_format!(searches);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_one_of_a_table() {
        let found =
            Ends { scenes: 7, values: 1_234, least: Some((0.25, 3)), lost: vec![String::new()], ..Ends::default() };
        let row = "| <a id=\"f-q16\"></a>`q16` | 1 | 7 | 1234 | 0.250 | 3 |";
        assert_eq!(found.row("q16"), row);
        let columns = |line: &str| line.matches('|').count();
        assert!(Ends::HEADINGS.lines().all(|line| columns(line) == columns(&found.row("q16"))));
    }
}
