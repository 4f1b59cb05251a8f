//! Claims that hold or fail by little, in special positions.

use super::*;

/// Two bodies on their first segments: how far they are at least, and what is shown of it.
fn claim(raw: [&RawBody; 2], ranges: [[f64; 2]; 2], least: f64) -> (Verdict, usize) {
    let bodies = [Body::new(raw[0]).unwrap(), Body::new(raw[1]).unwrap()];
    let segments = Segments([&bodies[0].segments[0], &bodies[1].segments[0]]);
    let mut steps = 0;
    (segments.farther(ranges.map(number_of), Ball::from(least), &mut steps), steps)
}

/// A claim that holds by a nanometre is proved, one that fails by as much refuted; one that is just so is never proved.
fn is_decided(name: &str, raw: [&RawBody; 2], ranges: [[f64; 2]; 2], exact: f64) {
    let (proved, steps) = claim(raw, ranges, exact - 1e-9);
    assert_eq!(proved, Verdict::Proved, "{name} after {steps}");
    assert!(steps < 5_000, "{name}: {steps}");
    let (refuted, _) = claim(raw, ranges, exact + 1e-9);
    assert!(matches!(refuted, Verdict::Refuted(_)), "{name}: {refuted:?}");
    // Within what the `f64` of the bound leaves: nothing is proved that is not so.
    let (just, _) = claim(raw, ranges, exact + 1e-15);
    assert_ne!(just, Verdict::Proved, "{name}");
}

fn line(id: u64, outline: RawOutline, start: [f64; 2], direction: f64, length: f64) -> RawBody {
    body(id, outline, start, direction, vec![single(RawCourse::Line, length, ahead())])
}

fn pivot(id: u64, outline: RawOutline, start: [f64; 2], direction: f64, turn: f64) -> RawBody {
    body(id, outline, start, direction, vec![single(RawCourse::Pivot { lever: 1.0 }, turn, ahead())])
}

fn arc(id: u64, outline: RawOutline, start: [f64; 2], direction: f64, radius: f64, turn: f64) -> RawBody {
    let length = turn * radius.abs();
    body(id, outline, start, direction, vec![single(RawCourse::Arc { radius }, length, ahead())])
}

#[test]
fn special_positions_are_decided_to_a_nanometre() {
    let truck = || rectangle([1.2, 0.8], [0.0; 2], 0.0);
    // Parallel edges all along both lanes, side by side, in both directions.
    for back in [0.0, PI] {
        let own = line(1, truck(), [0.0, 0.0], 0.0, 3.0);
        let other = line(2, truck(), [3.0 * back / PI, 1.05], back, 3.0);
        is_decided("lanes", [&own, &other], [[0.0, 3.0]; 2], 0.25);
    }
    // A pinch: corners touch before the flat side does, which is nearest to the wall in between; about the parallel position.
    let [turning, wall] = turning_beside_a_wall();
    let parallel = [[PI - 0.1, PI + 0.1], [0.9, 0.9]];
    let corners = 0.6_f64.hypot(0.4);
    is_decided("pinch", [&turning, &wall], parallel, 0.5 - corners * (0.4_f64.atan2(0.6) + 0.1).sin());
    is_decided("before the pinch", [&turning, &wall], [[PI, PI], [0.9, 0.9]], 0.1);
    // The pivot on a corner, and inside of an edge; the other one passes the far corner.
    let passer = line(2, rectangle([0.4, 0.4], [0.0; 2], 0.1), [-4.0, 2.0], 0.0, 8.0);
    let cornered = pivot(1, rectangle([1.2, 0.8], [0.6, 0.4], 0.0), [0.0; 2], 0.0, TAU);
    is_decided("pivot on a corner", [&cornered, &passer], [[0.0, TAU], [0.0, 8.0]], 1.8 - 1.2_f64.hypot(0.8));
    let edged = pivot(1, rectangle([1.2, 0.8], [0.0, 0.4], 0.0), [0.0; 2], 0.0, TAU);
    is_decided("pivot on an edge", [&edged, &passer], [[0.0, TAU], [0.0, 8.0]], 1.8 - 0.6_f64.hypot(0.8));
    // A fork whose reference point is far from it: the corners go faster than the path.
    let fork = pivot(1, rectangle([1.0, 0.2], [2.0, 0.0], 0.0), [0.0; 2], 0.0, TAU);
    let beside = line(2, rectangle([0.4, 0.4], [0.0; 2], 0.0), [-4.0, 3.0], 0.0, 8.0);
    is_decided("fork", [&fork, &beside], [[0.0, TAU], [0.0, 8.0]], 2.8 - 2.5_f64.hypot(0.1));
    // A tight turn of a large body, whose corners go twelve times as fast as the reference point.
    let tight = arc(1, truck(), [0.0, -0.05], 0.0, 0.05, TAU * 0.999_999);
    let far = (0.4_f64 + 0.05).hypot(0.6);
    is_decided("lever", [&tight, &beside], [[0.0, 0.05 * TAU * 0.999_999], [0.0, 8.0]], 2.8 - far);
    // Corner on corner, exactly at a distance of 5 m, and lines that move away from there.
    let one = line(1, rectangle([1.0, 1.0], [-0.5, -0.5], 0.0), [0.0; 2], PI, 2.0);
    let mut one = one;
    one.segments[0].heading = RawHeading::Steady(RawAngle::Radians(0.0));
    let two = line(2, rectangle([1.0, 1.0], [0.5, 0.5], 0.0), [3.0, 4.0], 0.0, 2.0);
    is_decided("corner on corner", [&one, &two], [[0.0, 2.0]; 2], 5.0);
    // Crab: across its heading along a line, and reverse gear on an arc.
    let mut crab = line(1, truck(), [0.0, 0.0], 0.0, 3.0);
    crab.segments[0].heading = RawHeading::Along(RawAngle::Turns(0.25));
    is_decided("crab", [&crab, &line(2, truck(), [0.0, 1.25], 0.0, 3.0)], [[0.0, 3.0]; 2], 0.25);
    let mut reverse = arc(1, rectangle([1.2, 0.8], [0.4, 0.0], 0.0), [0.0, -2.0], 0.0, 2.0, TAU * 0.999_999);
    reverse.segments[0].heading = RawHeading::Along(RawAngle::Radians(PI));
    let standing = line(2, rectangle([0.2, 0.2], [0.0; 2], 0.0), [0.0, 0.0], 0.0, 0.0);
    is_decided("reverse", [&reverse, &standing], [[0.0, 2.0 * TAU * 0.999_999], [0.0, 0.0]], 1.6 - 0.1_f64.hypot(0.1));
}

#[test]
fn a_distance_that_is_the_same_along_a_curve_is_decided_to_a_micrometre() {
    // Two rectangles on concentric arcs, the same way round: the distance depends on one angle less the other one only, and is least along
    // a diagonal of the square of lengths. What is missing there to a nanometre takes more boxes than are looked at.
    let truck = || rectangle([0.6, 0.4], [0.0; 2], 0.0);
    let inner = arc(1, truck(), [0.0, -1.0], 0.0, 1.0, 1.5);
    let outer = arc(2, truck(), [0.0, -2.0], 0.0, 2.0, 1.5);
    let exact = 1.8 - 0.3_f64.hypot(1.2);
    for (by, steps_allowed) in [(1e-3, 3_000), (1e-6, 100_000)] {
        let (proved, steps) = claim([&inner, &outer], [[0.0, 1.5], [0.0, 3.0]], exact - by);
        assert!(proved == Verdict::Proved && steps < steps_allowed, "{by}: {proved:?} after {steps}");
        let (refuted, _) = claim([&inner, &outer], [[0.0, 1.5], [0.0, 3.0]], exact + by);
        assert!(matches!(refuted, Verdict::Refuted(_)), "{by}: {refuted:?}");
    }
    let (beyond, _) = claim([&inner, &outer], [[0.0, 1.5], [0.0, 3.0]], exact - 1e-12);
    assert!(matches!(beyond, Verdict::Undecided(_)), "{beyond:?}");
}
