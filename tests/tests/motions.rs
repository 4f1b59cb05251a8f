//! Properties of what depends on time: profiles and their inverses, strips of standing agents, delays.

use pcr_core::{Motion, RegionRef, excess};
use pcr_planning::fleet::{HostScalar, build_ecm};
use pcr_tests::disc::{Course, Disc, Drive};
use pcr_tests::generators::driven_pairs;
use pcr_tests::oracle::{Pair, Travel};
use pcr_tests::settings::settings;
use proptest::prelude::*;

/// Bound on the error of travelled lengths and of times, in slacks of the largest length, time, or length travelled
/// meanwhile: each phase adds a few roundings.
const MOTION: f64 = 4.0;

/// A pair with its drives and start times.
type Driven = ((Disc, Disc), [(Drive, f64); 2]);

/// Both discs in a format, where it can hold them: rounded accelerations may miss the end of a path by too much.
fn courses<S: HostScalar>(((ego, other), drives): &Driven) -> Result<[(Course<S>, Travel); 2], TestCaseError> {
    let course = |disc: &Disc, (drive, start): &(Drive, f64)| -> Result<_, TestCaseError> {
        let disc = disc.rounded::<S>();
        let drive = drive.rounded::<S>();
        let start = S::from_f64(*start).to_f64();
        let course = Course::<S>::driven(&disc, &drive, start).map_err(|_| TestCaseError::reject("does not fit"))?;
        Ok((course, Travel::new(&drive, disc.length(), start)))
    };
    Ok([course(ego, &drives[0])?, course(other, &drives[1])?])
}

/// How far a travelled length may be off \[m\], at speeds up to `speed`.
fn length_bound<S: HostScalar>(motion: &Motion<'_, S>, speed: f64) -> f64 {
    let time = motion.time();
    let span = motion.path().length().to_f64() + speed * time.lo.abs().max(time.hi.abs()).to_f64();
    MOTION * S::slack(S::from_f64(span)).to_f64()
}

fn top_speed<S: HostScalar>(motion: &Motion<'_, S>) -> f64 {
    let speeds = motion.profile().phases().iter().map(|phase| phase.speed_at(phase.time().hi).to_f64());
    speeds.fold(0.0, f64::max)
}

fn travels<S: HostScalar>(driven: &Driven) -> Result<(), TestCaseError> {
    const STEPS: u32 = 64;
    for (course, travel) in courses::<S>(driven)? {
        let motion = course.motion();
        let bound = length_bound(&motion, top_speed(&motion));
        let (time, length) = (motion.time(), motion.path().length());
        prop_assert_eq!(motion.length_at(time.lo), S::ZERO);
        prop_assert_eq!(motion.length_at(time.hi), length);
        let mut before = S::ZERO;
        for k in 0..=STEPS {
            let part = f64::from(k) / f64::from(STEPS);
            let at = S::from_f64(time.lo.to_f64() + part * (time.hi - time.lo).to_f64()).clamp(time.lo, time.hi);
            let way = motion.length_at(at);
            let exact = travel.length_at(at.to_f64());
            prop_assert!(
                (way.to_f64() - exact).abs() <= bound,
                "{:?} at {:?}: {} is exact, bound {}",
                way,
                at,
                exact,
                bound
            );
            prop_assert!(before <= way && way <= length, "not monotone at {:?}", at);
            before = way;
        }
    }
    Ok(())
}

fn inverts<S: HostScalar>(driven: &Driven) -> Result<(), TestCaseError> {
    const STEPS: u32 = 64;
    for (course, _) in courses::<S>(driven)? {
        let motion = course.motion();
        let profile = motion.profile();
        let bound = length_bound(&motion, top_speed(&motion));
        let end = profile.length();
        prop_assert_eq!(profile.first_time_at(S::ZERO), S::ZERO);
        prop_assert_eq!(profile.last_time_at(end), profile.duration());
        let (mut first_before, mut last_before) = (S::ZERO, S::ZERO);
        for k in 0..=STEPS {
            let length = S::from_f64(end.to_f64() * f64::from(k) / f64::from(STEPS)).min(end);
            let (first, last) = (profile.first_time_at(length), profile.last_time_at(length));
            prop_assert!(first <= last, "first {:?} after last {:?} at {:?}", first, last, length);
            prop_assert!(first_before <= first && last_before <= last, "not monotone at {:?}", length);
            (first_before, last_before) = (first, last);
            for time in [first, last] {
                let way = profile.length_at(time);
                prop_assert!((way - length).abs().to_f64() <= bound, "{:?} at {:?}, not {:?}", way, time, length);
            }
        }
    }
    Ok(())
}

/// Time and region belong together: a region is where the other agent is within its lengths, and nowhere else.
fn regions_follow_the_other<S: HostScalar>(driven: &Driven) -> Result<(), TestCaseError> {
    let [(ego, _), (other, _)] = courses::<S>(driven)?;
    let ((ego_disc, other_disc), _) = driven;
    let oracle = Pair::new(&ego_disc.rounded::<S>(), &other_disc.rounded::<S>());
    let motions = [ego.motion(), other.motion()];
    let ecm = build_ecm(&motions).expect("two agents");
    let extent = (motions[0].extent() + motions[1].extent()).to_f64();
    let bound = excess(&motions[0], &motions[1]).to_f64();
    let doubt = pcr_tests::audit::ORACLE_ULPS * f64::EPSILON * extent;
    let (start, end) = (motions[1].time().lo, motions[1].time().hi);
    let regions: Vec<_> = ecm.pair(&motions, 0, 1).expect("the table of the fleet").collect();
    // Before, during and after the travel.
    for k in -4..=36 {
        let time = S::from_f64(start.to_f64() + (end - start).to_f64() * f64::from(k) / 32.0);
        let s = motions[1].length_at(time);
        for m in 0..=16 {
            let length = S::from_f64(oracle.ego.length() * f64::from(m) / 16.0).min(motions[0].path().length());
            let clearance = oracle.clearance(s.to_f64(), length.to_f64());
            let holding: Vec<_> = regions.iter().filter(|region| region.contains(time, length)).collect();
            prop_assert!(
                !holding.is_empty() || clearance > -doubt,
                "({:?}, {:?}) is missed by {}",
                time,
                length,
                clearance
            );
            prop_assert!(holding.is_empty() || clearance <= bound + doubt, "({:?}, {:?}) is invented", time, length);
            for region in holding {
                let range = region.time();
                prop_assert!(range.lo <= time || region.is_open_at_start(), "{:?} before {:?}", time, range);
                prop_assert!(time <= range.hi || region.is_open_at_end(), "{:?} after {:?}", time, range);
            }
        }
    }
    for region in &regions {
        ranges_of_time(region, &motions[1])?;
    }
    Ok(())
}

/// The time range is that of the lengths, and strips are open where the other agent stands in the region.
fn ranges_of_time<S: HostScalar>(region: &RegionRef<'_, S>, other: &Motion<'_, S>) -> Result<(), TestCaseError> {
    let bound = length_bound(other, top_speed(other));
    let (time, length, travel) = (region.time(), region.other_length(), other.time());
    prop_assert!(travel.lo <= time.lo && time.lo <= time.hi && time.hi <= travel.hi);
    prop_assert!(other.length_at(time.lo).to_f64() <= length.lo.to_f64() + bound);
    prop_assert!(other.length_at(time.hi).to_f64() >= length.hi.to_f64() - bound);
    prop_assert!((other.length_at(time.lo) - length.lo).abs().to_f64() <= bound);
    prop_assert!((other.length_at(time.hi) - length.hi).abs().to_f64() <= bound);
    let long = S::from_f64(1000.0);
    prop_assert_eq!(region.is_open_at_start(), region.slice_at(travel.lo - long).next().is_some());
    prop_assert_eq!(region.is_open_at_end(), region.slice_at(travel.hi + long).next().is_some());
    prop_assert_eq!(region.is_open_at_start(), length.lo <= S::ZERO);
    prop_assert_eq!(region.is_open_at_end(), length.hi >= other.path().length());
    prop_assert!(region.slice_at(travel.lo - long).eq(region.slice_at(travel.lo)), "the strip before is constant");
    prop_assert!(region.slice_at(travel.hi + long).eq(region.slice_at(travel.hi)), "the strip after is constant");
    Ok(())
}

/// A delay of the other agent shifts the times of a region, and nothing else of it; a delay of the ego shifts nothing.
fn delays_shift<S: HostScalar>(driven: &Driven) -> Result<(), TestCaseError> {
    // An integer below 2^10 added to the start time: the sum rounds, the regions do not.
    const DELAY: f64 = 37.0;
    let [(ego, _), (other, _)] = courses::<S>(driven)?;
    let motions = [ego.motion(), other.motion()];
    let ecm = build_ecm(&motions).expect("two agents");
    let delay = S::from_f64(DELAY);
    let late = [motions[0], motions[1].delayed(delay).expect("a small delay")];
    let waiting = [motions[0].delayed(delay).expect("a small delay"), motions[1]];
    prop_assert_eq!(
        ecm.pair(&motions, 0, 1).expect("the table of the fleet").count(),
        build_ecm(&late).expect("two agents").pair(&late, 0, 1).expect("the table of the fleet").count()
    );
    for ((region, shifted), same) in ecm
        .pair(&motions, 0, 1)
        .expect("the table of the fleet")
        .zip(ecm.pair(&late, 0, 1).expect("the table of the fleet"))
        .zip(ecm.pair(&waiting, 0, 1).expect("the table of the fleet"))
    {
        prop_assert_eq!((region.length(), region.other_length()), (shifted.length(), shifted.other_length()));
        let reach = region.time().hi.abs().to_f64() + DELAY;
        let bound = MOTION * S::slack(S::from_f64(reach)).to_f64();
        let shift = |a: S, b: S| ((b - a).to_f64() - DELAY).abs() <= bound;
        prop_assert!(shift(region.time().lo, shifted.time().lo) && shift(region.time().hi, shifted.time().hi));
        prop_assert_eq!((region.time(), region.length()), (same.time(), same.length()));
    }
    Ok(())
}

macro_rules! in_format {
    ($module:ident, $format:ident) => {
        mod $module {
            use super::*;

            proptest! {
                #![proptest_config(settings(2000, 10, 39))]

                #[test]
                fn lengths_are_those_of_the_phases_monotone_and_exact_at_the_ends(driven in driven_pairs()) {
                    travels::<$format>(&driven)?;
                }

                #[test]
                fn times_are_the_inverse_of_lengths_waits_included(driven in driven_pairs()) {
                    inverts::<$format>(&driven)?;
                }

                #[test]
                fn regions_are_where_the_other_is_in_their_lengths(driven in driven_pairs()) {
                    regions_follow_the_other::<$format>(&driven)?;
                }

                #[test]
                fn delays_shift_times_only(driven in driven_pairs()) {
                    delays_shift::<$format>(&driven)?;
                }
            }
        }
    };
}

in_format!(in_f64, f64);
in_format!(in_f32, f32);
