//! Start delays of bodies: exact ends by hand, bounds and answers against samples.

use super::*;
use crate::delays;
use crate::outline::delays::Traversal;

/// At a constant speed of 1.
fn steady(length: f64) -> RawMotion {
    let phase = RawPhase { time: [0.0, length], length: [0.0, length], speed: [1.0; 2] };
    RawMotion { start: 7.0, phases: vec![phase], lag: 0.0, time_excess: 0.0 }
}

/// A truck of 1.2 by 0.8 m on a lane of 4 m.
fn truck(id: u64, start: [f64; 2], direction: f64) -> RawBody {
    let lane = single(RawCourse::Line, 4.0, ahead());
    RawBody {
        travel: Some(steady(4.0)),
        ..body(id, rectangle([1.2, 0.8], [0.0; 2], 0.0), start, direction, vec![lane])
    }
}

fn verdict(raw: [&RawBody; 2], forbidden: &[[f64; 2]]) -> (delays::Verdict, usize) {
    let bodies = raw.map(|raw| Body::new(raw).unwrap());
    let [a, b] = bodies.each_ref().map(|body| Traversal::new(body).unwrap());
    a.outside(&b, forbidden)
}

#[test]
fn outside_of_the_exact_delays_trucks_are_free() {
    // Behind one another on one lane 1.2 m have to pass; across, (1.2 + 0.8) m: in the crossing from the first contact of the one to the
    // last one of the other.
    let behind = [truck(1, [0.0; 2], 0.0), truck(2, [0.0; 2], 0.0)];
    let across = [truck(1, [-2.0, 0.0], 0.0), truck(2, [0.0, -2.0], FRAC_PI_2)];
    let beside = [truck(1, [0.0; 2], 0.0), truck(2, [0.0, 0.8 + 1e-6], 0.0)];
    for (pair, end) in [(&behind, 1.2), (&across, 2.0)] {
        for beyond in [1e-12, 1e-9, 1e-6, 1e-3, 1.0] {
            let (found, cells) = verdict([&pair[0], &pair[1]], &[[-end - beyond, end + beyond]]);
            assert!(found == delays::Verdict::Free && cells < 2000, "{end} {beyond}: {found:?} after {cells}");
        }
        for missing in [1e-9, 1e-3, 0.3] {
            for (forbidden, sign) in [([-end - 1e-9, end - missing], 1.0), ([missing - end, end + 1e-9], -1.0)] {
                let (found, _) = verdict([&pair[0], &pair[1]], &[forbidden]);
                let delays::Verdict::Contact(contact) = found else { panic!("{missing}: {found:?}") };
                let delay = contact.delay * sign;
                assert!(end - missing <= delay && delay < end && contact.clearance < 0.0, "{contact:?}");
            }
        }
    }
    let (found, cells) = verdict([&beside[0], &beside[1]], &[]);
    assert!(found == delays::Verdict::Free && cells < 2000, "{found:?} after {cells}");
    assert!(matches!(verdict([&behind[0], &behind[1]], &[]).0, delays::Verdict::Contact(_)));
}

#[test]
fn without_a_motion_there_is_no_traversal() {
    let raw = RawBody { travel: None, ..truck(1, [0.0; 2], 0.0) };
    let body = Body::new(&raw).unwrap();
    assert_eq!(Traversal::new(&body).unwrap_err().to_string(), "body 1: no motion");
}

#[test]
fn bounds_hold_on_two_clocks() {
    let mut dice = Dice(11);
    let [mut used, mut near_zero] = [0; 2];
    for round in 0..6000 {
        let raw = [random(&mut dice, 1), random(&mut dice, 2)];
        let bodies = [Body::new(&raw[0]).unwrap(), Body::new(&raw[1]).unwrap()];
        let near = [0, 1].map(|k| &bodies[k].segments[0].near);
        let middle = [0, 1].map(|k| dice.unit() * raw[k].segments[0].length);
        let [a, b] = [0, 1].map(|k| near[k].posture(number(middle[k])));
        let speeds = [0; 2].map(|_| dice.of(&[0.0, 1.0, 0.7]));
        let accelerations = [0; 2].map(|_| dice.of(&[0.0, 0.0, 0.5, -1.0]));
        let [half, shift] = [0; 2].map(|_| dice.of(&[0.3, 0.05, 1e-3]));
        let change = Change::Clocks {
            speeds: speeds.map(number),
            accelerations: accelerations.map(number),
            half: number(half),
            shift: number(shift),
        };
        let seen = below(near, [&a, &b], &change);
        for k in 0..40 {
            let part = |dice: &mut Dice| if k < 16 { dice.of(&[-1.0, 1.0, 0.0]) } else { dice.between(-1.0, 1.0) };
            let t = half * part(&mut dice);
            let times = [t, t + shift * part(&mut dice)];
            let at = [0, 1].map(|k| middle[k] + (speeds[k] + 0.5 * accelerations[k] * times[k]) * times[k]);
            let found = plain([&raw[0], &raw[1]], at);
            assert!(sure(seen.anywhere) <= found + 1e-12, "{round} {raw:?} {middle:?} {change:?}: {seen:?} {found}");
            used += usize::from(seen.anywhere.mid > 0.0);
            near_zero += usize::from(seen.anywhere.mid > 0.5 * found && found > 0.0);
        }
    }
    assert!(used > 20_000 && near_zero > 20_000, "{used} {near_zero}");
}

/// Delays at which samples touch are forbidden, with what lies between them; a hundredth less on either side is refuted, and a little more is
/// free.
#[test]
fn delays_of_random_bodies_are_those_of_samples() {
    const STEPS: usize = 60;
    let mut dice = Dice(5);
    let [mut free, mut refuted, mut undecided, mut most] = [0; 4];
    for round in 0..60 {
        let mut raw = [random(&mut dice, 1), random(&mut dice, 2)];
        for body in &mut raw {
            let length = body.segments[0].length;
            body.travel = Some(if dice.unit() < 0.5 { steady(length) } else { travel(0.0, length, 1.0) });
        }
        let ends = [0, 1].map(|k| raw[k].travel.as_ref().unwrap().phases.last().unwrap().time[1]);
        let length_at = |k: usize, time: f64| {
            let phases = &raw[k].travel.as_ref().unwrap().phases;
            let phase = phases.iter().find(|phase| time <= phase.time[1]).unwrap_or(phases.last().unwrap());
            let ([from, to], since) = (phase.time, time - phase.time[0]);
            let gain = (phase.speed[1] - phase.speed[0]) / (to - from);
            phase.length[0] + (phase.speed[0] + 0.5 * gain * since) * since
        };
        let radius = raw[0].outline.radius + raw[1].outline.radius;
        let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
        for i in 0..=STEPS {
            for j in 0..=STEPS {
                let times = [i, j].map(|k| k as f64 / STEPS as f64);
                let times = [times[0] * ends[0], times[1] * ends[1]];
                if plain([&raw[0], &raw[1]], [length_at(0, times[0]), length_at(1, times[1])]) <= radius {
                    (from, to) = (from.min(times[0] - times[1]), to.max(times[0] - times[1]));
                }
            }
        }
        let pair = [&raw[0], &raw[1]];
        // Beyond what lies between two samples.
        let apart = (ends[0] + ends[1]) / STEPS as f64;
        let told = if from <= to { vec![[from - 2.0 * apart, to + 2.0 * apart]] } else { Vec::new() };
        let (found, cells) = verdict(pair, &told);
        most = most.max(cells);
        match found {
            delays::Verdict::Free => free += 1,
            delays::Verdict::Contact(contact) => {
                // Between the samples of grazing ways, where it is right.
                let times = [contact.time, contact.time - contact.delay];
                let there = plain(pair, [length_at(0, times[0]), length_at(1, times[1])]);
                assert!(there <= radius + 1e-9, "{round}: {contact:?} {there}");
            }
            delays::Verdict::Undecided(_) => undecided += 1,
        }
        if from < to {
            let part = 0.05 * (to - from);
            for short in [[from + part, to + 2.0 * apart], [from - 2.0 * apart, to - part]] {
                let (found, _) = verdict(pair, &[short]);
                assert!(found != delays::Verdict::Free, "{round}: {short:?} of {from} to {to}");
                refuted += usize::from(matches!(found, delays::Verdict::Contact(_)));
            }
        }
    }
    assert!(
        free > 40 && refuted > 40 && undecided < 3,
        "{free} free, {refuted} refuted, {undecided} open, {most} cells"
    );
}
