//! Answers at the limits of the formats: late and fast agents, where products of speed and time are larger than any length.

use pcr_core::scalar::Angle;
use pcr_core::{Curve, Limits, Point, Pose, Scalar};
use pcr_supervisor::{Agent, Answer, Number, Request, Service, Step};

/// Two discs of radius `size` that set off at `start` \[s\] and drive through one another at `speed` \[m/s\], head-on on one line
/// of length 16 `size`.
fn head_on<S: Number>(number: impl Fn(f64) -> S, start: f64, speed: f64, size: f64) -> Vec<Answer<S>> {
    let agent = |x: f64, sign: f64| {
        let one = number(1.0);
        let heading = if sign > 0.0 { S::Angle::ZERO } else { half_turn(one) };
        Agent {
            radius: number(size),
            start_time: number(start),
            limits: Limits { speed: number(speed), acceleration: number(speed) },
            start: Pose { position: Point::new(number(x), number(0.0)), heading },
            path: [Step { curve: Curve::Line, length: number(16.0 * size) }].into_iter().collect(),
        }
    };
    let mut service = Service::<S, 2, 2, 4, 8>::new(&[]);
    let mut answers = Vec::new();
    for request in [
        Request::Add(agent(-8.0 * size, 1.0)),
        Request::Add(agent(8.0 * size, -1.0)),
        Request::Compute,
        Request::Conflicts,
        Request::Row { ego: 0 },
        Request::Replan { agent: 0 },
    ] {
        service.answer(request, 1, |answer| answers.push(answer));
    }
    answers
}

/// A heading of half a turn, of two quarters.
fn half_turn<S: Scalar>(one: S) -> S::Angle {
    let quarter = S::Angle::atan2(one, S::ZERO);
    quarter + quarter
}

fn meet<S: Number>(what: &str, number: impl Fn(f64) -> S + Copy, start: f64, speed: f64, size: f64) {
    let what = format!("{what}: start {start} s, {speed} m/s, radius {size} m");
    let answers = head_on(number, start, speed, size);
    let [Answer::Fleet { .. }, Answer::Fleet { .. }, Answer::Computed { regions: 1, .. }, rest @ ..] = &answers[..]
    else {
        panic!("{what}: {answers:?}")
    };
    let [Answer::Conflict(conflict), Answer::End { count: 1 }, Answer::Region(region), ..] = rest else {
        panic!("{what}: {answers:?}")
    };
    // They go through one another: at some time one is where the other is.
    assert!(conflict.depth > number(1.9 * size), "{what}: {conflict:?}");
    assert!(region.time.lo <= conflict.time.hi && conflict.time.lo <= region.time.hi, "{what}: {region:?}");
    // No delay helps: each ends where the other began.
    assert!(matches!(answers.last(), Some(Answer::Refused(_))), "{what}: {answers:?}");
}

#[test]
fn late_and_fast_agents_are_not_lost_in_any_format() {
    for (start, speed, size) in [(3600.0, 5.0, 0.5), (3600.0, 20.0, 2.0), (4000.0, 50.0, 4.0)] {
        meet("f32", |value| value as f32, start, speed, size);
        meet("q16", |value| pcr_fixed::Q16::from_f64(value).expect("in range"), start, speed, size);
    }
    for (start, speed, size) in [(60_000.0, 5.0, 4.0), (60_000.0, 50.0, 16.0)] {
        meet("q12", |value| pcr_fixed::Q12::from_f64(value).expect("in range"), start, speed, size);
    }
    for (start, speed, size) in [(240.0, 5.0, 0.5), (250.0, 20.0, 2.0)] {
        meet("q20", |value| pcr_fixed::Q20::from_f64(value).expect("in range"), start, speed, size);
    }
}
