//! Boxes, intervals and paths by hand: what they hold, to each side.

use pcr_core::{Aabb, Interval, InvalidInput, Path, Point, Pose, Profile, TurnSide, gaps, union};
use pcr_fixed::Q16;
use pcr_planning::fleet::HostScalar;
use std::f64::consts::{FRAC_PI_2, PI};

fn bounds([x, y, to_x, to_y]: [f64; 4]) -> Aabb<f64> {
    Aabb::around(Point::new(x, y), Point::new(to_x, to_y))
}

#[test]
fn a_box_extends_as_far_as_its_farthest_side() {
    for sides in [
        [-7.0, 1.0, 2.0, 3.0],
        [1.0, -7.0, 2.0, 3.0],
        [1.0, 2.0, 7.0, 3.0],
        [1.0, 2.0, 3.0, 7.0],
        [-7.0, 0.0, -6.0, 0.0],
    ] {
        assert_eq!(bounds(sides).extent(), 7.0, "{sides:?}");
    }
    // The side that is nearer to zero, on the far side of it.
    assert_eq!(bounds([-7.0, -9.0, -6.0, -8.0]).extent(), 9.0);
}

#[test]
fn boxes_meet_where_they_do_along_both_axes() {
    let own = bounds([0.0, 0.0, 2.0, 2.0]);
    for (other, meets) in [
        ([1.0, 1.0, 3.0, 3.0], true),
        ([2.0, 2.0, 3.0, 3.0], true),
        ([2.1, 0.0, 3.0, 2.0], false),
        ([0.0, 2.1, 2.0, 3.0], false),
        ([-3.0, -3.0, -0.1, 1.0], false),
    ] {
        assert_eq!([own.meets(bounds(other)), bounds(other).meets(own)], [meets; 2], "{other:?}");
    }
}

#[test]
fn gaps_and_unions_of_intervals_that_touch_are_none_and_one() {
    let interval = |(lo, hi): (f64, f64)| Interval::new(lo, hi);
    let parts = [(2.0, 3.0), (0.0, 1.0), (1.0, 1.5), (3.0, 3.0), (5.0, 6.0)].map(interval);
    let found: Vec<_> = union(parts.iter().copied()).collect();
    assert_eq!(found, [(0.0, 1.5), (2.0, 3.0), (5.0, 6.0)].map(interval));
    let between = |lo, hi| gaps(found.iter().copied(), Interval::new(lo, hi)).collect::<Vec<_>>();
    assert_eq!(between(-1.0, 7.0), [(-1.0, 0.0), (1.5, 2.0), (3.0, 5.0), (6.0, 7.0)].map(interval));
    assert_eq!(between(0.0, 6.0), [(1.5, 2.0), (3.0, 5.0)].map(interval));
    assert_eq!(between(3.5, 4.0), [interval((3.5, 4.0))]);
    assert_eq!(between(2.0, 3.0), []);
    assert_eq!(between(1.5, 2.0), [interval((1.5, 2.0))]);
}

fn start<S: HostScalar>() -> Path<S, 2> {
    Path::starting_at(Pose { position: Point::new(S::ZERO, S::ZERO), heading: S::angle(0.0).expect("an angle") })
        .expect("a pose")
}

fn sweeps<S: HostScalar>() {
    let number = S::from_f64;
    for (sweep, side) in [(FRAC_PI_2, 1.0), (-FRAC_PI_2, -1.0)] {
        let path = start::<S>().arc_by(number(2.0), number(sweep)).expect("a quarter");
        let (length, end) = (path.as_path().length(), path.as_path().pose_at(number(4.0)).position);
        let close = |a: S, b: f64| (a.to_f64() - b).abs() < 1e-4;
        assert!(close(length, PI) && close(end.x, 2.0) && close(end.y, 2.0 * side), "{end:?}");
    }
    let none = start::<S>().arc_by(number(2.0), S::ZERO).expect("no arc");
    assert_eq!(none.as_path().length(), S::ZERO);
    // A diameter is a number of the format, too.
    let wide = start::<S>().arc(S::LIMIT.half() + S::LIMIT.half().half(), TurnSide::Left, number(1.0));
    assert!(matches!(wide, Err(InvalidInput::OutOfRange("diameter of the arc"))));
    let beyond = start::<S>().arc_by(number(2.0), S::LIMIT.double());
    assert!(matches!(beyond, Err(InvalidInput::OutOfRange("sweep"))));
    // A turn in place between two lines, and one before the first.
    for first in [0.0, 1.0] {
        let path = start::<S>()
            .line(number(first))
            .and_then(|path| path.turn(S::angle(FRAC_PI_2).expect("an angle")))
            .expect("a turn");
        let path = path.line(number(3.0)).expect("a line");
        let end = path.as_path().pose_at(number(4.0)).position;
        assert!((end.x.to_f64() - first).abs() < 1e-4 && (end.y.to_f64() - 3.0).abs() < 1e-4, "{end:?}");
    }
}

#[test]
fn arcs_by_their_sweep_and_turns_in_place() {
    sweeps::<f64>();
    sweeps::<f32>();
    sweeps::<Q16>();
}

#[test]
fn speeds_are_those_of_the_phase_and_none_outside() {
    let profile = Profile::<f64, 3>::from_pieces(1.0, [(2.0, 0.5), (1.0, -1.0)]).expect("a profile");
    let speed = |time| profile.as_profile().speed_at(time);
    assert_eq!([-0.1, 0.0, 1.0, 2.0, 2.5, 3.0, 3.1].map(speed), [0.0, 1.0, 1.5, 2.0, 1.5, 1.0, 0.0]);
}
