//! Tests of single segments.

use super::*;
use crate::Radians;
use core::f64::consts::{FRAC_PI_2, PI, TAU};

fn origin(heading: f64) -> Segment<f64> {
    Segment::standing(Pose { position: Point::new(0.0, 0.0), heading: Radians(heading) }).unwrap()
}

#[test]
fn quarter_circles_end_where_they_should() {
    for (turn, y, heading) in [(TurnSide::Left, 2.0, FRAC_PI_2), (TurnSide::Right, -2.0, -FRAC_PI_2)] {
        let arc = origin(0.0).then_arc(2.0, turn, PI).unwrap();
        assert!((arc.end.x - 2.0).abs() < 1e-15 && (arc.end.y - y).abs() < 1e-15);
        assert_eq!(arc.heading_at(PI), Radians(heading));
        assert_eq!(arc.heading_at(FRAC_PI_2), Radians(0.5 * heading));
    }
}

#[test]
fn a_turn_in_place_leaves_the_segment_as_it_is() {
    let line = origin(0.0).then_line(2.0).unwrap();
    let turned = line.turned(Radians(FRAC_PI_2)).unwrap();
    assert_eq!((turned.end, turned.bounds, turned.to), (line.end, line.bounds, line.to));
    let next = turned.then_line(3.0).unwrap();
    assert_eq!((next.start, next.from), (line.end, 2.0));
    assert!((next.end.x - 2.0).abs() < 1e-15 && (next.end.y - 3.0).abs() < 1e-15);
    assert_eq!(line.turned(Radians(f64::NAN)), Err(InvalidInput::NonFinite("turn")));
}

#[cfg(feature = "outlines")]
#[test]
fn a_pivot_turns_the_heading_and_leaves_the_place() {
    let line = origin(0.0).then_line(2.0).unwrap();
    for (turn, heading) in [(TurnSide::Left, FRAC_PI_2), (TurnSide::Right, -FRAC_PI_2)] {
        let pivot = line.then_pivot(0.5, turn, 0.5 * FRAC_PI_2).unwrap();
        assert_eq!((pivot.start, pivot.end, pivot.from, pivot.to), (line.end, line.end, 2.0, 2.0 + 0.5 * FRAC_PI_2));
        assert_eq!(pivot.bounds, Aabb::around(line.end, line.end));
        for u in [0.0, 0.1, 0.7] {
            assert_eq!(pivot.point_at(u), line.end);
        }
        assert_eq!(pivot.heading_at(0.25 * FRAC_PI_2), Radians(0.5 * heading));
        assert_eq!(pivot.heading_at(pivot.length), Radians(heading));
        let next = pivot.then_line(1.0).unwrap();
        assert!((next.end.x - 2.0).abs() < 1e-15 && (next.end.y - heading.signum()).abs() < 1e-15);
    }
    let refused = |lever, length| line.then_pivot(lever, TurnSide::Left, length).unwrap_err();
    assert_eq!(refused(0.0, 1.0), InvalidInput::NonPositive("lever"));
    assert_eq!(refused(-0.5, 1.0), InvalidInput::NonPositive("lever"));
    assert_eq!(refused(f64::NAN, 1.0), InvalidInput::NonFinite("lever"));
    assert_eq!(refused(1e-80, 1e-80), InvalidInput::TooSmall("lever"));
    assert_eq!(refused(9e11, 1.0), InvalidInput::OutOfRange("lever"));
    assert_eq!(refused(0.5, -1.0), InvalidInput::Negative("length"));
    assert_eq!(refused(0.5, 0.5 * TAU + 1e-9), InvalidInput::SweepOverOneTurn);
}

#[test]
fn headings_of_too_many_turns_are_refused() {
    let at = |heading: f32| Segment::standing(Pose { position: Point::new(0.0_f32, 0.0), heading: Radians(heading) });
    assert!(at(-1_024.0).is_ok());
    assert_eq!(at(1_024.1), Err(InvalidInput::OutOfRange("heading")));
    let last = at(1_023.0).unwrap();
    assert_eq!(last.turned(Radians(2.0)), Err(InvalidInput::OutOfRange("heading")));
    assert!(last.turned(Radians(-2.0)).is_ok());
    assert_eq!(last.then_arc(1.0, TurnSide::Left, 2.0), Err(InvalidInput::OutOfRange("heading")));
    assert!(last.then_arc(1.0, TurnSide::Right, 2.0).is_ok());
    let pose = Pose { position: Point::new(0.0, 0.0), heading: Radians(1.7e7) };
    assert_eq!(Segment::<f64>::standing(pose), Err(InvalidInput::OutOfRange("heading")));
}

#[test]
fn what_does_not_fit_is_refused_by_name() {
    let start = origin(0.0);
    assert_eq!(start.then_line(-1.0), Err(InvalidInput::Negative("length")));
    assert_eq!(start.then_line(f64::NAN), Err(InvalidInput::NonFinite("length")));
    assert_eq!(start.then_line(2e12), Err(InvalidInput::OutOfRange("length")));
    assert_eq!(start.then_arc(0.0, TurnSide::Left, 1.0), Err(InvalidInput::NonPositive("radius")));
    assert_eq!(start.then_arc(1.0, TurnSide::Left, TAU + 1e-9), Err(InvalidInput::SweepOverOneTurn));
    assert_eq!(start.then_arc(1.0, TurnSide::Left, TAU).map(|arc| arc.length), Ok(TAU));
    let far = start.then_line(9e11).unwrap();
    assert_eq!(far.then_line(9e11), Err(InvalidInput::OutOfRange("x")));
}
