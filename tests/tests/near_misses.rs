//! What only just does not touch: events and turning points of contacts that are missed by parts of the slack, as derived in
//! docs/theory/errors.md, and of none that is missed by more. The slack is far above rounding here, so that each rule shows alone.

use pcr_core::{Point, Pose, Segment, TurnSide, internals};
use pcr_fixed::{Q12, Q16, Q20};
use pcr_planning::fleet::HostScalar;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The combined radius \[m\], and the slack that is played with.
const RADIUS: f64 = 1.0;
const SLACK: f64 = 1.0 / 32.0;

/// A line, or an arc of this radius to the left, from a place.
fn segment<S: HostScalar>([x, y, heading]: [f64; 3], length: f64, bend: Option<f64>) -> Segment<S> {
    let position = Point::new(S::from_f64(x), S::from_f64(y));
    let start = Segment::standing(Pose { position, heading: S::angle(heading).expect("an angle") }).expect("small");
    let length = S::from_f64(length);
    let next = match bend {
        None => start.then_line(length),
        Some(radius) => start.then_arc(S::from_f64(radius), TurnSide::Left, length),
    };
    next.expect("small")
}

/// Two radians of the upper half of a circle about the origin, to the left or to the right, whose middle is on top: one lap, with
/// no change of it.
fn upper<S: HostScalar>(bend: f64, turn: TurnSide) -> Segment<S> {
    let side = if turn == TurnSide::Left { 1.0 } else { -1.0 };
    let from = FRAC_PI_2 - side;
    let position = Point::new(S::from_f64(bend * from.cos()), S::from_f64(bend * from.sin()));
    let start = Segment::standing(Pose { position, heading: S::angle(from + side * FRAC_PI_2).expect("an angle") })
        .expect("small");
    start.then_arc(S::from_f64(bend), turn, S::from_f64(2.0 * bend)).expect("small")
}

/// Events along the second, and turning lengths of the first \[m\].
fn found<S: HostScalar>(first: &Segment<S>, second: &Segment<S>, radius: f64) -> [Vec<f64>; 2] {
    let mut found = [Vec::new(), Vec::new()];
    let [events, turns] = &mut found;
    let sizes = [S::from_f64(radius), S::from_f64(SLACK)];
    internals::events(first, second, sizes, |s| events.push(s.to_f64()), |l| turns.push(l.to_f64()));
    found
}

fn has(lengths: &[f64], at: f64) -> bool {
    lengths.iter().any(|length| (length - at).abs() < 8e-3)
}

/// The end of a line over the middle of another one: two events where it is in reach, the foot up to a slack further out.
fn ends_of_lines<S: HostScalar>() {
    let second = segment::<S>([-3.0, 0.0, 0.0], 6.0, None);
    for side in [1.0, -1.0] {
        for (missed, foot) in [(-0.5, false), (0.1, true), (0.9, true), (1.1, false), (3.0, false)] {
            let off = RADIUS + missed * SLACK;
            // It comes down to there, or sets off from there.
            let down = segment::<S>([0.0, side * (off + 5.0), -side * FRAC_PI_2], 5.0, None);
            let up = segment::<S>([0.0, side * off, side * FRAC_PI_2], 5.0, None);
            for (first, end) in [(down, 5.0), (up, 0.0)] {
                let [events, turns] = found(&first, &second, RADIUS);
                assert_eq!(has(&events, 3.0), foot, "{missed} slacks: {events:?}");
                let half = (RADIUS * RADIUS - off * off).max(0.0).sqrt();
                let both = missed >= 0.0 || has(&events, 3.0 - half) && has(&events, 3.0 + half);
                assert!(both && has(&events, 0.0) && has(&events, 6.0), "{missed} slacks: {events:?}");
                // An end that touches may be that of a contact just beyond it: half a slack outside, a slack inside.
                assert_eq!(has(&turns, end), (-1.0..=0.5).contains(&missed), "{missed} slacks: {turns:?}");
            }
        }
        for (missed, turns_there) in [(-1.1, false), (-0.9, true), (0.4, true), (0.6, false)] {
            // Head on: the contact at the offset of the end is not normal to the second line, the end counts by its offset.
            let first = segment::<S>([0.0, side * (RADIUS + missed * SLACK), 0.0], 2.0, None);
            let [_, turns] = found(&first, &second, RADIUS);
            assert_eq!([has(&turns, 0.0), has(&turns, 2.0)], [turns_there; 2], "{missed} slacks: {turns:?}");
        }
    }
}

/// A path that turns back short of a line, or passes an arc outside: one event where half a slack is missed at most.
fn normals<S: HostScalar>() {
    for (missed, there) in [(0.4, true), (0.6, false)] {
        // An arc of 2 m whose lowest point is as far above the line.
        let line = segment::<S>([-4.0, 0.0, 0.0], 8.0, None);
        let arc = segment::<S>([-2.0, 2.0 + RADIUS + missed * SLACK, -FRAC_PI_2], 2.0 * PI, Some(2.0));
        let [events, _] = found(&line, &arc, RADIUS);
        assert_eq!(has(&events, PI), there, "arc beside a line, {missed} slacks: {events:?}");
        let [_, turns] = found(&arc, &line, RADIUS);
        assert_eq!(has(&turns, PI), there, "turning point of an arc, {missed} slacks: {turns:?}");
        // A line that passes an arc of 2 m about the origin outside, and a smaller one.
        for (bend, turn) in
            [(2.0, TurnSide::Left), (2.0, TurnSide::Right), (1.75, TurnSide::Left), (1.75, TurnSide::Right)]
        {
            let own = upper::<S>(bend, turn);
            let passing = segment::<S>([-3.0, bend + RADIUS + missed * SLACK, 0.0], 6.0, None);
            let [events, _] = found(&own, &passing, RADIUS);
            assert_eq!(has(&events, 3.0), there, "line outside {bend} m, {missed} slacks: {events:?}");
            let [_, turns] = found(&passing, &own, RADIUS);
            assert_eq!(has(&turns, 3.0), there, "turning point outside {bend} m, {missed} slacks: {turns:?}");
        }
        // Two arcs of 2 m whose circles are as far apart.
        for turn in [TurnSide::Left, TurnSide::Right] {
            let own = upper::<S>(2.0, turn);
            let other = segment::<S>([-2.0, 4.0 + RADIUS + missed * SLACK, -FRAC_PI_2], 2.0 * PI, Some(2.0));
            let [events, turns] = found(&own, &other, RADIUS);
            let both = [has(&events, PI), has(&turns, 2.0)];
            assert_eq!(both, [there; 2], "two arcs, {missed} slacks: {events:?} {turns:?}");
        }
    }
}

/// From inside an arc: P1 about the centre below twice the radius, right to a slack; P3 beyond, which takes (ϱ + R) / (ϱ - R) times
/// half a slack for touching.
fn inside<S: HostScalar>() {
    let cases = [(1.75, 0.9, true), (1.75, 1.2, false), (4.0, 0.7, true), (4.0, 1.0, false)];
    for ((bend, missed, there), turn) in
        cases.into_iter().flat_map(|case| [(case, TurnSide::Left), (case, TurnSide::Right)])
    {
        let own = upper::<S>(bend, turn);
        // A line through the circle that stays off the ring inside which nothing is in contact.
        let passing = segment::<S>([-1.0, bend - RADIUS + missed * SLACK, 0.0], 2.0, None);
        let [events, _] = found(&own, &passing, RADIUS);
        assert_eq!(has(&events, 1.0), there, "{missed} slacks inside {bend} m: {events:?}");
    }
}

/// An arc is followed lap by lap up to a radius of sixteen slacks more than the disc: where the foot leaves one lap for another, behind
/// the centre, is an event.
fn laps<S: HostScalar>() {
    for (slacks, there) in [(1.0, true), (15.5, true), (16.0, true), (16.5, false), (20.0, false)] {
        for turn in [TurnSide::Left, TurnSide::Right] {
            let own = upper::<S>(RADIUS + slacks * SLACK, turn);
            // Out of reach of its ends, and off the ring inside which nothing is in contact.
            let behind = segment::<S>([-1.0, -0.7, 0.0], 2.0, None);
            let [events, _] = found(&own, &behind, RADIUS);
            assert_eq!(has(&events, 1.0), there, "{slacks} slacks: {events:?}");
        }
    }
}

/// A disc that holds all of a circle about any point near its centre: the two ends of the diameter are events.
fn whole_circles<S: HostScalar>() {
    let circle = segment::<S>([1.0, 0.0, FRAC_PI_2], TAU, Some(1.0));
    for off in [0.2, 0.45] {
        let first = segment::<S>([off, 5.0, -FRAC_PI_2], 5.0, None);
        let [events, _] = found(&first, &circle, 1.5);
        assert!(has(&events, PI), "the far end of the diameter through the point at {off} m: {events:?}");
    }
}

/// An arc that bulges away from a line by so many slacks more than it may: its two ends are within reach, its middle is not. By half a
/// slack at most that is no gap, as rounding makes those, and there is one piece; else there are two, and both reach to where the
/// line comes nearest to the circle from inside, beyond the points at which they end on the arc.
fn gaps<S: HostScalar>() {
    let line = segment::<S>([0.0, 0.0, 0.0], 8.0, None);
    let (half, radius) = (0.5_f64, 2.0);
    for (missed, count) in [(-0.5, 1), (0.3, 1), (0.7, 2), (2.0, 2)] {
        let above = RADIUS + missed * SLACK;
        // From left to right over the top of a circle about (4, above - 2).
        let (sin, cos) = half.sin_cos();
        let position = Point::new(S::from_f64(4.0 - radius * sin), S::from_f64(above - radius + radius * cos));
        let start = Segment::standing(Pose { position, heading: S::angle(half).expect("an angle") }).expect("small");
        let arc =
            start.then_arc(S::from_f64(radius), TurnSide::Right, S::from_f64(2.0 * half * radius)).expect("small");
        let mut found = Vec::new();
        let sizes = [S::from_f64(RADIUS), S::from_f64(SLACK)];
        let to_f64 = |interval: pcr_core::Interval<S>| [interval.lo.to_f64(), interval.hi.to_f64()];
        internals::pieces(&line, &arc, sizes, |ranges| found.push(ranges.map(to_f64))).expect("room");
        assert_eq!(found.len(), count, "{missed} slacks: {found:?}");
        let near = |a: f64, b: f64| (a - b).abs() < 8e-3;
        // The ends of the arc are the lowest points, at this height.
        let height = above - radius + radius * cos;
        let reach = (RADIUS * RADIUS - height * height).sqrt();
        let outer = [4.0 - radius * sin - reach, 4.0 + radius * sin + reach];
        let [first, last] = [found[0], found[count - 1]];
        assert!(near(first[0][0], outer[0]) && near(last[0][1], outer[1]), "{missed} slacks: {found:?}, {outer:?}");
        assert!(near(first[1][0], 0.0) && near(last[1][1], 2.0 * half * radius), "{missed} slacks: {found:?}");
        if count == 2 {
            // Along the arc up to where it is at the height of R, along the line to where the ring of ϱ - R meets it.
            let edge = (1.0 - missed * SLACK / radius).acos() * radius;
            let turn = (1.0 - (1.0 - missed * SLACK).powi(2)).sqrt();
            assert!(near(first[1][1], radius * half - edge) && near(last[1][0], radius * half + edge), "{found:?}");
            assert!(near(first[0][1], 4.0 - turn) && near(last[0][0], 4.0 + turn), "{found:?}");
        }
        // The other way round there are as many pieces, over the same lengths.
        let mut swapped = Vec::new();
        internals::pieces(&arc, &line, sizes, |ranges| swapped.push(ranges.map(to_f64))).expect("room");
        assert_eq!(swapped.len(), count, "{missed} slacks: {swapped:?}");
        for ([line, arc], [first, second]) in found.iter().zip(&swapped) {
            let same = |a: &[f64; 2], b: &[f64; 2]| near(a[0], b[0]) && near(a[1], b[1]);
            assert!(same(line, second) && same(arc, first), "{missed} slacks: {found:?} {swapped:?}");
        }
    }
}

macro_rules! in_format {
    ($name:ident, $format:ty) => {
        #[test]
        fn $name() {
            ends_of_lines::<$format>();
            normals::<$format>();
            inside::<$format>();
            laps::<$format>();
            whole_circles::<$format>();
            gaps::<$format>();
        }
    };
}

in_format!(near_misses_are_events_up_to_the_slack_in_f64, f64);
in_format!(near_misses_are_events_up_to_the_slack_in_f32, f32);
in_format!(near_misses_are_events_up_to_the_slack_in_q20, Q20);
in_format!(near_misses_are_events_up_to_the_slack_in_q16, Q16);
in_format!(near_misses_are_events_up_to_the_slack_in_q12, Q12);

/// A line that passes an arc, inside of it out of reach, from where it is but a third of a slack too far away to a third of a slack
/// after: two pieces, and what lies before the first and after the last is part of neither.
#[test]
fn gaps_lie_between_two_contacts() {
    for turn in [TurnSide::Left, TurnSide::Right] {
        let own = upper::<f64>(4.0, turn);
        let [outer, inner] = [5.0, 3.0].map(|distance: f64| (distance * distance - 2.8 * 2.8).sqrt());
        let more = SLACK / 3.0;
        let passing = segment::<f64>([-outer - more, 2.8, 0.0], 2.0 * (outer + more), None);
        let mut found = Vec::new();
        let add = |[_, second]: [pcr_core::Interval<f64>; 2]| found.extend([second.lo, second.hi]);
        internals::pieces(&own, &passing, [RADIUS, SLACK], add).expect("room");
        let exact = [-outer, -inner, inner, outer].map(|x| x + outer + more);
        let near = found.iter().zip(exact).all(|(found, exact)| (found - exact).abs() < 1e-12);
        assert!(found.len() == 4 && near, "{found:?} {exact:?}");
    }
}

/// As an arc is that is half a turn or longer, whatever its radius.
#[test]
fn half_a_turn_is_followed_lap_by_lap() {
    let behind = segment::<f64>([-1.0, -2.0, 0.0], 2.0, None);
    for (length, there) in [(4.0 * PI, true), ((4.0 * PI).next_down(), false), (4.5 * PI, true), (3.5 * PI, false)] {
        // Its middle is on top of a circle about the origin.
        let from = FRAC_PI_2 - length / 8.0;
        let own = segment::<f64>([4.0 * from.cos(), 4.0 * from.sin(), from + FRAC_PI_2], length, Some(4.0));
        let [events, _] = found(&own, &behind, RADIUS);
        assert_eq!(has(&events, 1.0), there, "{length} m: {events:?}");
    }
}
