//! Queries at times and lengths that are no numbers, infinite, or the wrong way round: none answers "free".

use pcr_core::scalar::Micro;
use pcr_core::{
    Aabb, BrakingModel, BroadPhase, CheckState, CheckTolerances, EcmEntry, Encounter, Interval, Limits, Motion,
    MovementAuthority, PassingState, Path, Piece, Point, Pose, PrecedenceTable, Profile, Progress, RegionPrecedence,
    earliest_departure, earliest_start, first_conflict, first_overlap, gaps, least_duration, safe_intervals,
    safe_lengths, union,
};
use pcr_planning::fleet::{HostScalar, build_ecm};
use std::f64::consts::FRAC_PI_2;

/// Two agents that collide in the middle of two lines of 4 m after 2 s.
fn crossing<S: HostScalar>() -> ([Path<S, 1>; 2], Profile<S, 1>) {
    let number = S::from_f64;
    let path = |x: f64, y: f64, heading: f64| {
        let pose = Pose { position: Point::new(number(x), number(y)), heading: S::angle(heading).expect("an angle") };
        Path::starting_at(pose).and_then(|path| path.line(number(4.0))).expect("small")
    };
    let profile = Profile::from_pieces(number(1.0), [(number(4.0), S::ZERO)]).expect("small");
    ([path(-2.0, 0.0, 0.0), path(0.0, -2.0, FRAC_PI_2)], profile)
}

fn none_is_free<S: HostScalar>() {
    let (paths, profile) = crossing::<S>();
    let at = |start: f64| {
        [0, 1].map(|k| {
            let start = if k == 0 { S::from_f64(start) } else { S::ZERO };
            let (path, profile) = (paths[k].as_path(), profile.as_profile());
            Motion::new(path, profile, S::from_f64(0.25), start).expect("small")
        })
    };
    let (fleet, number) = (at(0.0), S::from_f64);
    let ecm = build_ecm(&fleet).expect("a small table");
    let row = || ecm.row(&fleet, 0).expect("the table of the fleet");
    let region = row().next().expect("they meet");
    let (nan, endless) = (number(f64::NAN), number(f64::INFINITY));

    // Slices.
    assert!(region.slice_at(nan).eq([region.length()]));
    assert!(region.contains(nan, number(2.0)) && region.contains(number(2.0), nan) && region.contains(nan, nan));
    assert!(!region.contains(number(2.0), endless) && !region.contains(endless, number(2.0)), "it has passed");

    // Intervals of time.
    let pair = Encounter::new(&fleet[0], &fleet[1]);
    let met = pair.contacts(pair.time()).next().expect("a contact").middle();
    let unclear = [
        (nan, nan),
        (nan, number(3.0)),
        (number(1.0), nan),
        (number(3.0), number(1.0)),
        (number(2.25), number(1.75)),
        (-endless, endless),
    ];
    for (lo, hi) in unclear.into_iter().chain([(endless, -endless)]) {
        let during = Interval::new(lo, hi);
        assert!(pair.contacts(during).any(|contact| contact.contains(met)), "{during:?}");
        assert!(pair.conflicts(during).next().is_some() && pair.closest(during).separation < number(0.1), "{during:?}");
        assert!(first_conflict(&fleet[0], row(), during).expect("its row").is_some(), "{during:?}");
        assert!(first_overlap(&fleet[0], row(), during).expect("its row").is_some(), "{during:?}");
        assert!(pair.blocked_lengths(during).any(|part| part.contains(number(2.0))), "{during:?}");
        let middle = Interval::new(number(2.0), number(2.0));
        assert!(pair.blocked(middle, during).any(|window| !(window.hi < met || window.lo > met)), "{during:?}");
        assert!(region.blocked(middle, during).any(|window| !(window.hi < met || window.lo > met)), "{during:?}");
        let safe = |agent| safe_intervals(&fleet, agent, middle, during).expect("an agent");
        assert!(!safe(0).any(|window| window.contains(met)), "{during:?}");
        assert!(
            !safe_lengths(&fleet, 0, during).expect("an agent").any(|part| part.contains(number(2.0))),
            "{during:?}"
        );
        let boxes = BroadPhase::new(vec![Aabb::default(); 18], &fleet, during).expect("room");
        assert!(boxes.contacts().next().is_some(), "{during:?}");
    }

    // Parts of a path.
    let always = Interval::new(number(-9.0), number(9.0));
    for (lo, hi) in
        [(nan, nan), (nan, number(3.0)), (number(1.0), nan), (number(3.0), number(1.0)), (endless, -endless)]
    {
        let part = Interval::new(lo, hi);
        assert!(pair.blocked(part, always).any(|window| window.contains(met)), "{part:?}");
        assert!(region.blocked(part, always).any(|window| window.contains(met)), "{part:?}");
        let mut safe = safe_intervals(&fleet, 0, part, always).expect("an agent");
        assert!(!safe.any(|window| window.contains(met)), "{part:?}");
    }

    // Starts, waits and durations.
    for from in [nan, endless, -endless] {
        assert_eq!(earliest_start(row(), from), None);
        assert_eq!(earliest_departure(row(), number(1.0), from), None);
        assert_eq!(earliest_departure(row(), number(2.0), from), None);
        assert!(least_duration::<S, 1>(row(), from).is_err());
    }
    assert_eq!(earliest_departure(row(), nan, S::ZERO), None);
    assert_eq!(earliest_departure(row(), endless, S::ZERO), None);

    holds(&fleet, nan);
}

/// Of an agent whose place is no number nothing is known: it has passed nothing.
fn holds<S: HostScalar>(fleet: &[Motion<'_, S>; 2], nan: S) {
    let number = S::from_f64;
    let ecm = build_ecm(fleet).expect("a small table");
    let region = ecm.row(fleet, 0).expect("the table of the fleet").next().expect("they meet");
    for (own, other) in [(nan, S::ZERO), (S::ZERO, nan), (nan, nan), (number(-1.0), number(-1.0))] {
        assert_eq!(region.hold(own, other), region.hold(S::ZERO, S::ZERO));
    }
    let storage = (vec![EcmEntry::EMPTY; 4], vec![Piece::EMPTY; 4], vec![RegionPrecedence::EMPTY; 4]);
    let mut orders = PrecedenceTable::build(storage.0, storage.1, storage.2, fleet).expect("room");
    let unknown = Progress { at: Interval::new(nan, nan), stop: nan };
    let tolerances = CheckTolerances { gain: number(1e-3), width: number(1e-3) };
    let mut reaches = vec![CheckState::EMPTY; 2];
    assert!(orders.check(fleet, &[unknown; 2], tolerances, &mut reaches).is_err(), "nobody may pass yet");
    orders.decide(fleet, 0, 1, PassingState::Second, S::ZERO).expect("a pair that meets");
    let known = orders.hold(fleet, 0, &[Progress::default(); 2]).expect("an agent");
    assert!(matches!(known, MovementAuthority::At(hold) if hold < number(2.0)), "{known:?}");
    assert_eq!(orders.hold(fleet, 0, &[unknown; 2]), Ok(known));
    assert_eq!(orders.check(fleet, &[unknown; 2], tolerances, &mut reaches), Ok(()));
}

/// A robot that parks on the crossing: no place frees the other one, and no tolerance lets a check go on for ever.
fn parked<S: HostScalar>() {
    let (paths, _) = crossing::<S>();
    let number = S::from_f64;
    let limits = Limits { speed: number(1.0), acceleration: number(1.0) };
    let profiles = [2.0, 4.0].map(|length| Profile::rest_to_rest(number(length), limits).expect("small"));
    let short = Path::<S, 1>::starting_at(Pose {
        position: Point::new(number(-2.0), S::ZERO),
        heading: S::angle(0.0).expect("an angle"),
    });
    let short = short.and_then(|path| path.line(number(2.0))).expect("small");
    let fleet = [(&short, &profiles[0]), (&paths[1], &profiles[1])].map(|(path, profile)| {
        Motion::new(path.as_path(), profile.as_profile(), number(0.25), S::ZERO).expect("small")
    });
    let mut orders =
        PrecedenceTable::build([EcmEntry::EMPTY; 2], [Piece::EMPTY; 8], [RegionPrecedence::EMPTY; 4], &fleet)
            .expect("room");
    orders.decide(&fleet, 0, 1, PassingState::First, S::ZERO).expect("the fleet");
    for place in [number(f64::INFINITY), number(1e9), S::LIMIT, number(2.0)] {
        let progress = [Progress::at_rest(place), Progress::at_rest(S::ZERO)];
        assert!(matches!(orders.hold(&fleet, 1, &progress), Ok(MovementAuthority::At(_))), "{place:?}");
        for width in [number(f64::NEG_INFINITY), number(-1e9), S::ZERO] {
            for gain in [number(-1.0), S::ZERO, number(f64::NAN), number(0.001)] {
                let found =
                    orders.check(&fleet, &progress, CheckTolerances { width, gain }, &mut [CheckState::EMPTY; 2]);
                assert!(found.is_err(), "{place:?}, {width:?}, {gain:?}");
            }
        }
        orders.passed(&progress);
        assert!(matches!(orders.hold(&fleet, 1, &progress), Ok(MovementAuthority::At(_))), "{place:?}");
    }
    let brakes = BrakingModel::new(number(0.5), number(0.125)).expect("brakes");
    if S::NAME == f64::NAME {
        assert_eq!(brakes.speed(number(f64::NAN)), S::ZERO);
        assert_eq!(brakes.distance(number(f64::NAN)), brakes.distance(S::LIMIT));
    }
    assert!(brakes.speed(number(f64::INFINITY)).is_finite());
}

#[test]
fn who_parks_on_a_crossing_frees_nobody_and_checks_end() {
    parked::<f64>();
    parked::<f32>();
    parked::<pcr_fixed::Q16>();
}

#[test]
fn unions_of_unclear_intervals_end_and_leave_nothing_free() {
    let (nan, wrong) = (Interval::new(1.0, f64::NAN), Interval::new(5.0, -3.0));
    for unclear in [nan, wrong, Interval::new(f64::NAN, f64::NAN), Interval::new(f64::NAN, 7.0)] {
        let intervals = [Interval::new(1.0, 2.0), unclear, Interval::new(4.0, 4.5)];
        let found: Vec<_> = union(intervals.into_iter()).take(9).collect();
        assert!(found.len() < 3 && found.windows(2).all(|pair| pair[0].hi < pair[1].lo), "{unclear:?}: {found:?}");
        let free: Vec<_> = gaps(union(intervals.into_iter()), Interval::new(0.0, 5.0)).take(9).collect();
        assert!(free.iter().all(|gap| !gap.contains(1.5) && !gap.contains(4.25)), "{unclear:?}: {free:?}");
        let (lo, hi) = (unclear.lo.min(unclear.hi), unclear.lo.max(unclear.hi));
        assert!(free.iter().all(|gap| gap.hi <= lo || gap.lo >= hi), "{unclear:?}: {free:?}");
    }
}

#[test]
fn what_is_no_number_is_not_free() {
    none_is_free::<f64>();
    none_is_free::<f32>();
    none_is_free::<Micro>();
}

/// An agent of 17 turns and a third, and one of more than the format knows the direction of.
/// A window of which one end was no number was dropped where the other agent stands.
fn who_stands_blocks<S: HostScalar>() {
    let (paths, profile) = crossing::<S>();
    let motion = |k: usize| Motion::new(paths[k].as_path(), profile.as_profile(), S::from_f64(0.25), S::ZERO);
    let fleet = [motion(0).expect("small"), motion(1).expect("small")];
    let (ego, other) = (&fleet[0], &fleet[0]);
    let (nan, number) = (S::from_f64(f64::NAN), S::from_f64);
    for (place, lo, hi) in [(4.0, number(9.0), nan), (4.0, nan, nan), (0.0, nan, number(-1.0)), (0.0, nan, nan)] {
        let part = Interval::new(number(place), number(place));
        let blocked = Encounter::new(ego, other).blocked(part, Interval::new(lo, hi)).next();
        assert!(blocked.is_some(), "{place} {lo:?} {hi:?}");
    }
}

#[test]
fn who_stands_blocks_in_floating_point() {
    who_stands_blocks::<f64>();
    who_stands_blocks::<f32>();
    who_stands_blocks::<Micro>();
}

#[test]
fn headings_of_many_turns_are_right_or_refused() {
    let pose = |heading: f32| Pose { position: Point::new(0.0_f32, 0.0), heading: pcr_core::Radians(heading) };
    let turns = 163.0_f64 * std::f64::consts::TAU;
    for (heading, accepted) in [(1_024.0, true), (1_024.1, false), (turns as f32, false), (-1_023.9, true)] {
        let path = Path::<f32, 1>::starting_at(pose(heading)).and_then(|path| path.line(1.0));
        assert_eq!(path.is_ok(), accepted, "{heading}");
        if let Ok(path) = path {
            let end = path.as_path().pose_at(1.0).position;
            let (sin, cos) = f64::from(heading).sin_cos();
            let off = (f64::from(end.x) - cos).abs().max((f64::from(end.y) - sin).abs());
            assert!(off < 2e-7, "{off} at {heading}");
        }
    }
    // A path that turns the same way for ever.
    let mut path = Path::<f32, 200>::starting_at(pose(0.0)).expect("small");
    let circles = (0..200).take_while(|_| {
        let next = path.clone().arc(1.0, pcr_core::TurnSide::Left, std::f32::consts::TAU);
        next.map(|next| path = next).is_ok()
    });
    assert_eq!(circles.count(), 162);
    let limits = Limits { speed: 1.0, acceleration: 1.0 };
    let length = path.as_path().length();
    let profile = Profile::rest_to_rest(length, limits).expect("small");
    assert!(Motion::new(path.as_path(), profile.as_profile(), 0.25, 0.0).is_ok());
}
