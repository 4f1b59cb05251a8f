//! Delays of crossings and of random motions against closed forms and plain samples.

use super::*;
use crate::dice::Dice;
use crate::raw::{RawAngle, RawMotion, RawPath, RawPhase, RawSegment};
use std::f64::consts::FRAC_1_SQRT_2;

/// A disc of 0.25 m that goes a line of 4 m at 1 m/s.
fn line(start: [f64; 2], turns: f64) -> Traversal {
    let (sin, cos) = (turns * std::f64::consts::TAU).sin_cos();
    let end = [start[0] + (4.0 * cos).round(), start[1] + (4.0 * sin).round()];
    Traversal::straight(0.25, [start, end], 1.0).expect("a line")
}

/// From rest to rest on a line, with 1 m/s at most and accelerations of 0.5 m/s².
fn rest_to_rest(radius: f64, start: [f64; 2], turns: f64, length: f64) -> Traversal {
    let segments = vec![RawSegment { length, radius: None, turns: Vec::new(), from: 0.0, to: length }];
    let path = RawPath { start, heading: RawAngle::Turns(turns), segments, rounding: 0.0, step: 0.0 };
    let cruise = 2.0 + (length - 2.0);
    let phases = vec![
        RawPhase { time: [0.0, 2.0], length: [0.0, 1.0], speed: [0.0, 1.0] },
        RawPhase { time: [2.0, cruise], length: [1.0, length - 1.0], speed: [1.0, 1.0] },
        RawPhase { time: [cruise, cruise + 2.0], length: [length - 1.0, length], speed: [1.0, 0.0] },
    ];
    let travel = Some(RawMotion { start: 0.0, phases, lag: 0.0, time_excess: 0.0 });
    Traversal::new(&RawAgent { id: 1, radius, path, travel }).expect("a motion")
}

fn crossing() -> [Traversal; 2] {
    [line([-2.0, 0.0], 0.0), line([0.0, -2.0], 0.25)]
}

#[test]
fn outside_of_the_exact_delays_a_crossing_is_free() {
    let [first, second] = crossing();
    // At right angles discs of 0.25 m touch with delays of up to 0.5 √2 s.
    for beyond in [1e-15, 1e-12, 1e-9, 1e-3, 1.0] {
        let end = FRAC_1_SQRT_2 + beyond;
        let (verdict, cells) = first.outside(&second, &[[-end, end]]);
        assert!(verdict == Verdict::Free && cells < 1000, "{beyond}: {verdict:?} after {cells}");
    }
}

#[test]
fn an_interval_that_ends_too_early_shows_a_contact() {
    let [first, second] = crossing();
    let end = FRAC_1_SQRT_2 + 1e-9;
    for missing in [1e-12, 1e-9, 1e-3, 0.1, 1.0] {
        let short = FRAC_1_SQRT_2 - missing;
        for (forbidden, at) in [([-end, short], 1.0), ([-short, end], -1.0)] {
            let (verdict, _) = first.outside(&second, &[forbidden]);
            let Verdict::Contact(found) = verdict else { panic!("{missing}: {verdict:?}") };
            assert!((short..FRAC_1_SQRT_2).contains(&(found.delay * at)) && found.clearance < 0.0, "{found:?}");
            // Told with the time at which it is.
            let [own, their] = [found.time - 2.0, found.time - found.delay - 2.0];
            assert!(own.hypot(their) < 0.5, "{found:?}");
        }
    }
    assert!(matches!(first.outside(&second, &[]).0, Verdict::Contact(_)));
    // Two intervals with a gap.
    let gap = [[-end, 0.1], [0.1 + 1e-9, end]];
    assert!(matches!(first.outside(&second, &gap).0, Verdict::Contact(found) if found.delay > 0.1));
    assert_eq!(first.outside(&second, &[[-end, 0.1], [0.1, end]]).0, Verdict::Free);
}

#[test]
fn who_has_arrived_is_in_nobodys_way() {
    // The second one begins where the first one ends: they touch as long as both are there, and 0.5 s before that.
    let (first, second) = (line([-4.0, 0.0], 0.0), line([0.0, 0.0], 0.0));
    assert_eq!(first.outside(&second, &[[3.5 - 1e-9, 4.0 + 1e-9]]).0, Verdict::Free);
    let verdict = first.outside(&second, &[[3.5 - 1e-9, 4.0 - 1e-9]]).0;
    assert!(matches!(verdict, Verdict::Contact(found) if found.delay > 4.0 - 1e-9), "{verdict:?}");
}

#[test]
fn who_stands_just_beside_the_other_one_is_decided() {
    for origin in [[0.0, 0.0], [500_000.0, 5_400_000.0]] {
        let at = |x: f64, y: f64| [origin[0] + x, origin[1] + y];
        // The end of the first one is 1 m beside the line of the second one, and the other way round. They touch until the first one
        // has arrived, where the second one passes after 4 s: up to a delay of 6 s - 4 s.
        let (first, second) = (rest_to_rest(0.5, at(0.0, 0.0), 0.0, 4.0), rest_to_rest(0.5, at(3.0, -3.0), 0.25, 4.0));
        assert_eq!((first.duration(), second.duration()), (6.0, 6.0));
        let [least, most] = [-2.0, 2.0];
        for beyond in [1e-9, 1e-6, 1e-3] {
            let (verdict, cells) = first.outside(&second, &[[least - beyond, most + beyond]]);
            assert!(verdict == Verdict::Free && cells < 20_000, "{beyond}: {verdict:?} after {cells}");
            let verdict = first.outside(&second, &[[least - beyond, most - beyond]]).0;
            assert!(beyond < 1e-3 || matches!(verdict, Verdict::Contact(_)), "{beyond}: {verdict:?}");
            assert!(verdict != Verdict::Free, "{beyond}");
        }
    }
}

#[test]
fn the_least_of_a_quadratic_is_below_all_of_it_and_reached_by_convex_ones() {
    let mut dice = Dice(5);
    let mut reached = 0;
    for _ in 0..400 {
        let [one, t, s, tt, ts, ss] = core::array::from_fn(|_| 4.0 * dice.unit() - 2.0);
        let tt = if dice.unit() < 0.7 { tt.abs() } else { tt };
        let (k, h) = (0.1 + dice.unit(), if dice.unit() < 0.5 { 0.0 } else { dice.unit() });
        let value = |x: f64, y: f64| one + t * x + s * y + tt * x * x + ts * x * y + ss * y * y;
        let at = |place: i32, most: f64| most * f64::from(place) / 40.0;
        let all = (-40..=40).flat_map(|x| (-40..=40).map(move |y| (x, y)));
        let sampled = all.map(|(x, y)| value(at(x, k), at(y, h))).fold(f64::INFINITY, f64::min);
        let quadratic =
            Quadratic::<f64> { one: one.into(), t: t.into(), s: s.into(), tt: tt.into(), ts: ts.into(), ss: ss.into() };
        let bound = quadratic.least(k.into(), h.into()).to_f64();
        assert!(bound <= sampled + 1e-12, "{bound} is above {sampled}");
        // Of one variable, the exact least value where it is bent upward.
        if h == 0.0 && tt > 0.0 {
            let exact = value((-t / (2.0 * tt)).clamp(-k, k), 0.0);
            assert!((bound - exact).abs() < 1e-9, "{bound} is not {exact}");
            reached += 1;
        }
    }
    assert!(reached > 100);
}

#[test]
fn neighbours_have_boxes_that_meet() {
    let all = [line([0.0, 0.0], 0.0), line([0.0, 0.5], 0.0), line([0.0, 1.2], 0.0), line([4.4, 0.0], 0.25)];
    let near = Neighbours::new(&all);
    assert_eq!([0, 1, 2, 3].map(|one| near.after(one)), [vec![1, 3], vec![3], vec![3], vec![]]);
}

/// Lines and arcs near the origin, from rest to rest, with a phase that lasts no longer than a rounding.
fn bent(dice: &mut Dice, id: u64) -> RawAgent {
    let (mut from, mut segments) = (0.0, Vec::new());
    for _ in 0..3 {
        let (length, bend) = (0.2 + 2.0 * dice.unit(), dice.unit() - 0.5);
        let radius = Some((0.4 + dice.unit()).copysign(bend)).filter(|_| dice.unit() < 0.6);
        segments.push(RawSegment { length, radius, turns: Vec::new(), from, to: from + length });
        from += length;
    }
    let (half, middle) = (1.0 + 3.0 * dice.unit(), 0.5 * from);
    let top = from / half;
    let next = [half.next_up(), middle.next_up()];
    let phases = vec![
        RawPhase { time: [0.0, half], length: [0.0, middle], speed: [0.0, top] },
        RawPhase { time: [half, next[0]], length: [middle, next[1]], speed: [top; 2] },
        RawPhase { time: [next[0], 2.0 * half], length: [next[1], from], speed: [top, 0.0] },
    ];
    let start = [4.0 * dice.unit() - 2.0, 4.0 * dice.unit() - 2.0];
    let path = RawPath { start, heading: RawAngle::Turns(dice.unit()), segments, rounding: 1e-15, step: 0.0 };
    let travel = Some(RawMotion { start: 0.0, phases, lag: 0.0, time_excess: 0.0 });
    RawAgent { id, radius: 0.2, path, travel }
}

/// What is found at one delay, by the proof of motions.
fn touch(first: &RawAgent, second: &RawAgent, delay: f64) -> bool {
    let mover = |agent: &RawAgent, start: f64| {
        let mut agent = agent.clone();
        let travel = agent.travel.as_mut().expect("a motion");
        travel.start = start;
        let end = start + travel.phases.last().expect("a phase").time[1];
        Mover::new(&agent, [start, end]).expect("a motion")
    };
    !crate::motion::meetings(&[mover(first, 0.0), mover(second, delay)]).contacts.is_empty()
}

#[test]
fn arcs_are_free_just_where_no_motion_touches() {
    let (mut dice, mut free, mut refuted) = (Dice(1), 0, 0);
    for _ in 0..60 {
        let agents = [bent(&mut dice, 1), bent(&mut dice, 2)];
        let [first, second] = [0, 1].map(|one| Traversal::new(&agents[one]).expect("a motion"));
        let (least, most) = (-second.duration(), first.duration());
        let at = |k: i32| least + (most - least) * f64::from(k) / 200.0;
        let hits: Vec<i32> = (0..=200).filter(|&k| touch(&agents[0], &agents[1], at(k))).collect();
        let mut intervals: Vec<[f64; 2]> = Vec::new();
        for &k in &hits {
            match intervals.last_mut() {
                Some(last) if at(k - 1) <= last[1] => last[1] = at(k),
                _ => intervals.push([at(k), at(k)]),
            }
        }
        // Samples miss up to a step at each end.
        let step = at(1) - at(0);
        let wide: Vec<[f64; 2]> = intervals.iter().map(|[lo, hi]| [lo - step, hi + step]).collect();
        let (verdict, cells) = first.outside(&second, &wide);
        assert!(cells < 20_000, "{verdict:?} after {cells}");
        match verdict {
            Verdict::Free => free += 1,
            // Shorter than a step, and therefore not sampled: a contact all the same.
            Verdict::Contact(found) => assert!(touch(&agents[0], &agents[1], found.delay), "{found:?}"),
            Verdict::Undecided(found) => panic!("{found:?}"),
        }
        // A sample less at an end, and none of an interval.
        for cut in 0..intervals.len() {
            let mut short = wide.clone();
            short[cut] = [intervals[cut][0] + 1e-7, short[cut][1]];
            let mut none = wide.clone();
            none.remove(cut);
            for table in [short, none] {
                let (verdict, _) = first.outside(&second, &table);
                let Verdict::Contact(found) = verdict else { panic!("{verdict:?}") };
                assert!(touch(&agents[0], &agents[1], found.delay) && found.clearance < 0.0, "{found:?}");
                assert!(!table.iter().any(|[lo, hi]| (lo..hi).contains(&&found.delay)), "{found:?} {table:?}");
                refuted += 1;
            }
        }
    }
    assert!(free > 50 && refuted > 30, "{free} {refuted}");
}
