//! Everything that the library can be asked, with numbers that are no numbers, or at the limits of their format.

use pcr_core::{
    Aabb, BroadPhase, Curve, EcmEntry, Encounter, Interval, Limits, Motion, PathRef, Point, Pose, Profile, SearchNode,
    Segment, SpeedPlanLimits, TurnSide, crossings, earliest_departure, earliest_start, first_conflict, first_overlap,
    least_duration, plan_delays, plan_speed, plan_speeds, safe_intervals, safe_lengths,
};
use pcr_core::{Ecm, Piece, RegionRef};
use pcr_planning::fleet::HostScalar;

/// Numbers that are no numbers, or hardly.
pub const GARBAGE: [f64; 22] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    0.0,
    -0.0,
    f64::MIN_POSITIVE,
    5e-324,
    -5e-324,
    f64::MAX,
    f64::MIN,
    1e300,
    1e-300,
    1e12,
    -1e12,
    1e6,
    1.1e12,
    1e-12,
    f64::EPSILON,
    std::f64::consts::PI,
    1.0,
    -1.0,
    0.5,
];

/// How many numbers a case is made of.
pub const NUMBERS: usize = 40;
/// Steps of a search for contacts beyond which a case is left.
const PATIENCE: f64 = 300.0;
/// Phases of a profile.
const PHASES: usize = 16;

/// A number of the format: one of any size, or a part of its limit.
pub fn number<S: HostScalar>(value: f64, of_limit: bool) -> f64 {
    if of_limit { value * S::LIMIT.to_f64() } else { value }
}

/// A motion, and what it borrows.
struct Parts<S: HostScalar> {
    segments: Vec<Segment<S>>,
    profile: Profile<S, PHASES>,
    radius: S,
    start: S,
}

impl<S: HostScalar> Parts<S> {
    fn new(mut number: impl FnMut() -> S) -> Option<Self> {
        let (x, y, heading) = (number(), number(), number().to_f64());
        let mut last = Segment::standing(Pose { position: Point::new(x, y), heading: S::angle(heading)? }).ok()?;
        let mut segments = vec![];
        for _ in 0..3 {
            let arc =
                last.then_arc(number(), if number() > S::ZERO { TurnSide::Left } else { TurnSide::Right }, number());
            if let Some(next) = arc.or_else(|_| last.then_line(number())).ok().filter(|next| next.length() > S::ZERO) {
                segments.push(next);
                last = next;
            }
        }
        if segments.is_empty() {
            segments.push(last);
        }
        let length = PathRef::new(&segments).ok()?.length();
        let one = S::from_f64(1.0);
        let profile = Profile::rest_to_rest(length, Limits { speed: number(), acceleration: number() });
        let profile =
            profile.or_else(|_| Profile::rest_to_rest(length, Limits { speed: one, acceleration: one })).ok()?;
        // With room for plans, and as the constructor takes phases one by one.
        let phases = profile.as_profile().phases().iter().map(|phase| (phase.time().length(), phase.acceleration()));
        let again = Profile::from_pieces(S::ZERO, phases.clone());
        let profile = again.ok().filter(|again| again.as_profile().length() == length);
        let profile = profile.or_else(|| {
            let duration = length.quotient(one);
            Profile::from_pieces(one, [(duration, S::ZERO)]).ok()
        })?;
        Some(Self { segments, profile, radius: number(), start: number() })
    }

    fn motion(&self) -> Option<Motion<'_, S>> {
        let path = PathRef::new(&self.segments).ok()?;
        let profile = self.profile.as_profile();
        let one = S::from_f64(1.0);
        let motion = Motion::new(path, profile, self.radius, self.start);
        motion.or_else(|_| Motion::new(path, profile, one, S::ZERO)).ok()
    }
}

fn finite<S: HostScalar>(interval: Interval<S>) {
    let Interval { lo, hi } = interval;
    assert!(lo.is_finite() && hi.is_finite() && lo <= hi, "{interval:?}");
}

/// Asks everything of motions that are made of these numbers: nothing may panic, loop or overflow. Whether two of them have a
/// region.
///
/// # Panics
/// Where something does, or where an answer denies what is known: that an agent is in contact with its own copy.
pub fn survives<S: HostScalar>(numbers: &[f64]) -> bool {
    let mut next = numbers.iter().copied().cycle();
    let mut number = || S::from_f64(next.next().unwrap_or_default());
    let parts: Vec<_> = (0..3).filter_map(|_| Parts::new(&mut number)).collect();
    let mut fleet: Vec<_> = parts.iter().filter_map(Parts::motion).collect();
    if let Some(last) = fleet.last_mut() {
        let late = last.with_margin(number()).and_then(|last| last.with_lateness(number()));
        *last = late.unwrap_or(*last);
    }
    let interval = Interval::new(number(), number());
    for motion in &fleet {
        alone(motion, interval);
    }
    let ecm = Ecm::build(vec![EcmEntry::EMPTY; 256], vec![Piece::EMPTY; 1024], &fleet).expect("enough room");
    for region in ecm.regions(&fleet).expect("the table of the fleet") {
        of_region(&region, numbers, interval);
    }
    if fleet.iter().flat_map(|ego| fleet.iter().map(move |other| (ego, other))).all(|(ego, other)| is_quick(ego, other))
    {
        together(&fleet, &ecm, interval);
    }
    !ecm.is_empty()
}

/// What one motion is asked.
fn alone<S: HostScalar>(motion: &Motion<'_, S>, interval: Interval<S>) {
    for time in [interval.lo, interval.hi] {
        let length = motion.length_at(motion.time().lo.max(time));
        assert!(length >= S::ZERO && length <= motion.path().length());
        motion.speed_at(time);
        motion.position_at(time);
        motion.path().pose_at(time);
        let _ = (motion.delayed(time), motion.profile().first_time_at(time), motion.profile().last_time_at(time));
        let _ = Profile::<S, PHASES>::stretched(motion.profile(), time).map(|stretched| {
            let phases = stretched.as_profile().phases();
            assert!(
                phases
                    .iter()
                    .zip(phases.iter().skip(1))
                    .all(|(a, b)| a.length().hi == b.length().lo && a.time().hi == b.time().lo)
            );
        });
    }
    finite(motion.time_in(Interval::new(S::ZERO, motion.path().length())));
    assert!(motion.inflated().extent() >= motion.extent() && motion.time_excess() >= S::ZERO);
}

/// Whether a search for the contacts of two does not take all day, by the bound for discs that hover near contact all the time:
/// T √(c / 2 ε) steps, c the accelerations and the squares of speeds by radii.
fn is_quick<S: HostScalar>(ego: &Motion<'_, S>, other: &Motion<'_, S>) -> bool {
    let pair = Encounter::new(ego, other);
    let bend = |motion: &Motion<'_, S>| {
        let speed = motion.profile().top_speed().to_f64();
        let phases = motion.profile().phases().iter().map(|phase| phase.acceleration().abs().to_f64());
        let arcs = motion.path().segments().iter().filter_map(|segment| match segment.curve() {
            Curve::Line | Curve::Pivot { .. } => None,
            Curve::Arc { radius, .. } => Some(speed * speed / radius.to_f64()),
        });
        phases.fold(0.0, f64::max) + arcs.fold(0.0, f64::max)
    };
    let longest = ego.time().length().max(other.time().length()).to_f64();
    longest * ((bend(ego) + bend(other)) / (2.0 * pair.tolerance().to_f64())).sqrt() < PATIENCE
}

/// What a region is asked.
fn of_region<S: HostScalar>(region: &RegionRef<'_, S>, numbers: &[f64], interval: Interval<S>) {
    finite(region.time());
    finite(region.length());
    finite(region.other_length());
    for &time in numbers {
        region.slice_at(S::from_f64(time)).for_each(finite);
        region.contains(S::from_f64(time), S::from_f64(numbers[0]));
    }
    region.blocked(interval, interval).for_each(drop);
    // Of the whole path some is blocked, at all times.
    let (all, always) = (Interval::new(-S::LIMIT, S::LIMIT), Interval::new(-S::LIMIT, S::LIMIT));
    assert!(region.blocked(all, always).next().is_some());
}

/// What agents are asked together.
fn together<S: HostScalar>(fleet: &[Motion<'_, S>], ecm: &Ecm<S, Vec<EcmEntry>, Vec<Piece<S>>>, interval: Interval<S>) {
    let always = Interval::new(-S::LIMIT, S::LIMIT);
    for (k, ego) in fleet.iter().enumerate() {
        for other in fleet {
            let pair = Encounter::new(ego, other);
            assert!(pair.tolerance() > S::ZERO && pair.radius() > S::ZERO);
            for during in [interval, always] {
                pair.conflicts(during).take(4).for_each(|conflict| finite(conflict.time));
                pair.closest(during);
                pair.blocked(interval, during).for_each(drop);
                pair.blocked_lengths(during).for_each(finite);
            }
            crossings(ego, other).for_each(drop);
        }
        let row = ecm.row(fleet, k).expect("the table of the fleet");
        for region in row.clone() {
            finite(region.forbidden_delays());
            let _ = region.forbidden_durations::<PHASES>().expect("room").map(finite);
        }
        for from in [S::ZERO, interval.lo, interval.hi] {
            let start = earliest_start(row.clone(), from);
            assert!(start.is_none_or(|start| start >= from));
            earliest_departure(row.clone(), interval.lo, from);
            let _ = least_duration::<S, PHASES>(row.clone(), from);
        }
        let met = first_conflict(ego, row.clone(), always).expect("its own row");
        let overlap = first_overlap(ego, row.clone(), interval).expect("its own row");
        assert!(overlap.is_none_or(|met| !met.conflict.touching));
        assert!(met.is_none_or(|met| met.other != k));
        let mut stations = vec![SearchNode::EMPTY; 24];
        let limits = Limits { speed: ego.profile().top_speed(), acceleration: interval.hi };
        for drive in [SpeedPlanLimits::of(ego), Some(SpeedPlanLimits::rest_to_rest(limits))].into_iter().flatten() {
            let _ = plan_speed::<S, PHASES>(ego, drive, row.clone(), &[], &mut stations);
        }
        safe_intervals(fleet, k, interval, interval).expect("an agent of the fleet").for_each(drop);
        safe_lengths(fleet, k, interval).expect("an agent of the fleet").for_each(finite);
        itself(ego, interval);
    }
    if let Ok(boxes) = BroadPhase::new(vec![Aabb::default(); 9 * fleet.len()], fleet, interval) {
        boxes.contacts().take(8).for_each(|(_, time)| finite(time));
    }
    let (mut plan, mut order) = (fleet.to_vec(), (0..fleet.len()).collect::<Vec<_>>());
    let _ = plan_delays(ecm, fleet, &mut plan, &mut order);
    let mut profiles = vec![Profile::<S, PHASES>::standing(); 2 * fleet.len()];
    let mut stations = vec![SearchNode::EMPTY; 24];
    let mut plan = fleet.to_vec();
    let _ = plan_speeds(ecm, fleet, &mut plan, &mut order, &mut profiles, &mut stations);
}

/// An agent and its own copy are in the same place at all times.
fn itself<S: HostScalar>(motion: &Motion<'_, S>, interval: Interval<S>) {
    let pair = Encounter::new(motion, motion);
    for during in [motion.time(), Interval::new(interval.lo, interval.lo), Interval::new(-S::LIMIT, S::LIMIT)] {
        let conflict = pair.conflicts(during).next().expect("the same place");
        assert!(conflict.depth == pair.radius(), "{conflict:?}");
        assert!(pair.closest(during).separation == S::ZERO);
        assert!(pair.blocked_lengths(during).next().is_some());
    }
    let at = motion.path().length();
    assert!(
        pair.blocked(Interval::new(at, at), Interval::new(motion.time().hi, motion.time().hi.max(S::LIMIT)))
            .next()
            .is_some()
    );
}
