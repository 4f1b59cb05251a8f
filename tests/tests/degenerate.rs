//! Degenerate positions, one by one, with exact answers: in real layouts they are the common ones.
//!
//! All agents drive at 1 m/s from the time 0 on, so that the time is the length `s` along the other's path.

use pcr_core::{Encounter, Interval, Limits, Motion, Path, Point, Pose, Profile, Radians, Scalar};
use pcr_tests::audit::Audit;
use pcr_tests::disc::{Disc, Leg};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Largest error of a length where contact is transversal \[m\]; the configurations are about 10 m large.
const EXACT: f64 = 1e-12;

/// Where discs just touch, a residual of a slack (about 1e-14 m) moves a contact along the path by its square root.
const TOUCHING: f64 = 1e-6;

fn disc(radius: f64, x: f64, y: f64, heading: f64, legs: &[Leg]) -> Disc {
    Disc { radius, start: [x, y, heading], legs: legs.to_vec() }
}

/// A region: ranges, and slices between some lengths of the other.
#[derive(Debug)]
struct Found {
    s: Interval<f64>,
    l: Interval<f64>,
    slices: Vec<(f64, Vec<Interval<f64>>)>,
}

fn regions(ego: &Disc, other: &Disc) -> Vec<Found> {
    const SLICES: u32 = 16;
    let audit = Audit::<f64>::new(ego, other).expect("a valid pair");
    let (motions, ecm) = audit.table();
    let found = |region: pcr_core::RegionRef<'_, f64>| {
        let s = region.other_length();
        let at = |k| s.lo + (s.hi - s.lo) * f64::from(k) / f64::from(SLICES);
        // Not at the ends, where a slice may be a point, and rounding decides about it.
        let slices = (1..SLICES).map(|k| (at(k), region.slice_at(at(k)).collect())).collect();
        Found { s, l: region.length(), slices }
    };
    let mut regions: Vec<_> = ecm.pair(&motions, 0, 1).expect("the table of the fleet").map(found).collect();
    regions.sort_by(|a, b| (a.s.lo + a.l.lo).total_cmp(&(b.s.lo + b.l.lo)));
    regions
}

fn assert_near(got: Interval<f64>, lo: f64, hi: f64, tolerance: f64) {
    assert!((got.lo - lo).abs() <= tolerance && (got.hi - hi).abs() <= tolerance, "{got:?} is not [{lo}, {hi}]");
}

/// One region with these ranges, whose slice at `s` is one interval.
fn assert_band(found: &Found, s: [f64; 2], l: [f64; 2], slice: impl Fn(f64) -> [f64; 2]) {
    assert_near(found.s, s[0], s[1], EXACT);
    assert_near(found.l, l[0], l[1], EXACT);
    for (s, slices) in &found.slices {
        let [lo, hi] = slice(*s);
        assert_eq!(slices.len(), 1, "slices at {s}: {slices:?}");
        assert_near(slices[0], lo.max(l[0]), hi.min(l[1]), EXACT);
    }
}

fn only(found: Vec<Found>) -> Found {
    assert_eq!(found.len(), 1, "{found:?}");
    found.into_iter().next().expect("one region")
}

#[test]
fn crossing_at_right_angles_is_a_circle() {
    let ego = disc(2.0, -10.0, 0.0, 0.0, &[Leg::Line(20.0)]);
    let other = disc(3.0, 0.0, -8.0, FRAC_PI_2, &[Leg::Line(16.0)]);
    let found = only(regions(&ego, &other));
    assert_near(found.s, 3.0, 13.0, EXACT);
    assert_near(found.l, 5.0, 15.0, EXACT);
    // 3-4-5: 3 m before the crossing the slice reaches 4 m to both sides.
    let audit = Audit::<f64>::new(&ego, &other).expect("a valid pair");
    let (motions, ecm) = audit.table();
    let region = ecm.pair(&motions, 0, 1).expect("the table of the fleet").next().expect("one region");
    let slices: Vec<_> = region.slice_at(5.0).collect();
    assert_eq!(slices.len(), 1);
    assert_near(slices[0], 6.0, 14.0, EXACT);
}

#[test]
fn head_on_on_one_line_is_a_band_down_the_plane() {
    let ego = disc(0.5, 0.0, 0.0, 0.0, &[Leg::Line(10.0)]);
    let other = disc(0.5, 10.0, 0.0, PI, &[Leg::Line(10.0)]);
    assert_band(&only(regions(&ego, &other)), [0.0, 10.0], [0.0, 10.0], |s| [9.0 - s, 11.0 - s]);
}

#[test]
fn following_on_one_line_is_a_band_up_the_plane() {
    let ego = disc(0.5, 0.0, 0.0, 0.0, &[Leg::Line(10.0)]);
    let other = disc(0.5, 2.0, 0.0, 0.0, &[Leg::Line(8.0)]);
    assert_band(&only(regions(&ego, &other)), [0.0, 8.0], [1.0, 10.0], |s| [s + 1.0, s + 3.0]);
}

#[test]
fn lanes_nearer_than_the_radii_are_a_narrower_band() {
    let ego = disc(0.5, 0.0, 0.0, 0.0, &[Leg::Line(10.0)]);
    let other = disc(0.5, 10.0, 0.6, PI, &[Leg::Line(10.0)]);
    assert_band(&only(regions(&ego, &other)), [0.0, 10.0], [0.0, 10.0], |s| [9.2 - s, 10.8 - s]);
}

#[test]
fn lanes_further_apart_than_the_radii_are_free() {
    let ego = disc(0.5, 0.0, 0.0, 0.0, &[Leg::Line(10.0)]);
    let other = disc(0.5, 10.0, 1.0 + 1e-9, PI, &[Leg::Line(10.0)]);
    assert!(regions(&ego, &other).is_empty());
}

#[test]
fn lanes_that_just_touch_are_one_thin_band() {
    let ego = disc(0.5, 0.0, 0.0, 0.0, &[Leg::Line(10.0)]);
    let other = disc(0.5, 0.0, 1.0, 0.0, &[Leg::Line(10.0)]);
    let found = only(regions(&ego, &other));
    assert_near(found.s, 0.0, 10.0, EXACT);
    assert_near(found.l, 0.0, 10.0, EXACT);
    for (s, slices) in found.slices {
        assert_eq!(slices.len(), 1);
        assert!(slices[0].contains(s));
        assert_near(slices[0], s, s, TOUCHING);
    }
}

#[test]
fn concentric_arcs_are_a_band() {
    // Radii 2 and 3, R = 1.5: contact below the angle of the law of cosines.
    let half = ((4.0 + 9.0 - 2.25) / 12.0_f64).acos();
    let ego = disc(0.75, 2.0, 0.0, FRAC_PI_2, &[Leg::arc(2.0, PI)]);
    let other = disc(0.75, 3.0, 0.0, FRAC_PI_2, &[Leg::arc(3.0, PI)]);
    let slice = |s: f64| [2.0 * (s / 3.0 - half), 2.0 * (s / 3.0 + half)];
    assert_band(&only(regions(&ego, &other)), [0.0, 3.0 * PI], [0.0, TAU], slice);
    // The other way round.
    let back = disc(0.75, -3.0, 0.0, FRAC_PI_2, &[Leg::arc(3.0, -PI)]);
    let slice = |s: f64| [2.0 * (PI - s / 3.0 - half), 2.0 * (PI - s / 3.0 + half)];
    assert_band(&only(regions(&ego, &back)), [0.0, 3.0 * PI], [0.0, TAU], slice);
}

#[test]
fn concentric_arcs_further_apart_than_the_radii_are_free() {
    let ego = disc(0.5, 2.0, 0.0, FRAC_PI_2, &[Leg::arc(2.0, PI)]);
    let other = disc(0.5 - 1e-9, 3.0, 0.0, FRAC_PI_2, &[Leg::arc(3.0, PI)]);
    assert!(regions(&ego, &other).is_empty());
}

#[test]
fn concentric_arcs_that_just_touch_are_one_thin_band() {
    let ego = disc(0.5, 2.0, 0.0, FRAC_PI_2, &[Leg::arc(2.0, PI)]);
    let other = disc(0.5, 3.0, 0.0, FRAC_PI_2, &[Leg::arc(3.0, PI)]);
    let found = only(regions(&ego, &other));
    assert_near(found.s, 0.0, 3.0 * PI, TOUCHING);
    assert_near(found.l, 0.0, TAU, TOUCHING);
}

/// Full turns of 2 m radius from the same point: half the width of the band, and the length of the turn.
const CIRCLE: f64 = 2.0;

fn half_width(r: f64) -> f64 {
    2.0 * CIRCLE * (0.5 * r / CIRCLE).asin()
}

#[test]
fn following_around_a_full_circle_is_a_band_and_two_corners() {
    let (width, length) = (half_width(1.0), TAU * CIRCLE);
    let ego = disc(0.6, 0.0, 0.0, 0.0, &[Leg::arc(CIRCLE, TAU)]);
    let other = disc(0.4, 0.0, 0.0, 0.0, &[Leg::arc(CIRCLE, TAU)]);
    let found = regions(&ego, &other);
    assert_eq!(found.len(), 3, "{found:?}");
    let band = found.iter().find(|region| region.s.length() > 6.0).expect("the band");
    assert_band(band, [0.0, length], [0.0, length], |s| [s - width, s + width]);
    let above = found.iter().find(|region| region.l.lo > 6.0).expect("the corner in which the ego is a turn ahead");
    assert_band(above, [0.0, width], [length - width, length], |s| [length - width + s, length]);
    let below = found.iter().find(|region| region.s.lo > 6.0).expect("the corner in which the other is a turn ahead");
    assert_band(below, [length - width, length], [0.0, width], |s| [0.0, width - (length - s)]);
}

#[test]
fn head_on_around_a_full_circle_is_a_band_and_two_corners() {
    let (width, length) = (half_width(1.0), TAU * CIRCLE);
    let ego = disc(0.6, 0.0, 0.0, 0.0, &[Leg::arc(CIRCLE, TAU)]);
    let other = disc(0.4, 0.0, 0.0, PI, &[Leg::arc(CIRCLE, -TAU)]);
    let found = regions(&ego, &other);
    assert_eq!(found.len(), 3, "{found:?}");
    assert_band(&found[0], [0.0, width], [0.0, width], |s| [0.0, width - s]);
    assert_band(&found[1], [0.0, length], [0.0, length], |s| [length - s - width, length - s + width]);
    assert_band(&found[2], [length - width, length], [length - width, length], |s| [2.0 * length - s - width, length]);
}

#[test]
fn a_line_through_a_large_circle_meets_it_twice() {
    // The circle about (0, 2), the line at its height: contacts within 1 m.
    let ego = disc(0.5, 0.0, 0.0, 0.0, &[Leg::arc(2.0, TAU)]);
    let other = disc(0.5, -5.0, 2.0, 0.0, &[Leg::Line(10.0)]);
    let found = regions(&ego, &other);
    assert_eq!(found.len(), 2, "{found:?}");
    let half = 2.0 * 0.5_f64.asin();
    // The circle comes to the right side of the line first, at a quarter turn.
    let (left, right) = if found[0].l.lo > PI { (&found[0], &found[1]) } else { (&found[1], &found[0]) };
    assert_near(left.s, 2.0, 4.0, EXACT);
    assert_near(left.l, 3.0 * PI - half, 3.0 * PI + half, EXACT);
    assert_near(right.s, 6.0, 8.0, EXACT);
    assert_near(right.l, PI - half, PI + half, EXACT);
}

#[test]
fn a_disc_larger_than_the_circle_covers_it_at_once() {
    let ego = disc(0.75, 0.0, -1.0, 0.0, &[Leg::arc(1.0, TAU)]);
    let other = disc(0.75, -5.0, 0.0, 0.0, &[Leg::Line(10.0)]);
    let found = only(regions(&ego, &other));
    assert_near(found.s, 2.5, 7.5, EXACT);
    assert_near(found.l, 0.0, TAU, EXACT);
    for (s, slices) in &found.slices {
        // All of it while the centre is within R - 1 of that of the circle.
        if (s - 5.0).abs() < 0.499 {
            assert_eq!(slices.len(), 1);
            assert_near(slices[0], 0.0, TAU, EXACT);
        }
    }
}

/// A disc that covers all of an arc but for a gap opposite: what lies before the gap and what lies behind it are two regions, at a joint,
/// too, where each is as long as the gap moves, so that their ranges meet.
#[test]
fn two_laps_stay_two_at_a_joint() {
    let (third, inner) = (PI / 3.0, 0.2_f64);
    let ego = disc(0.575, 1.0, 0.0, FRAC_PI_2, &[Leg::arc(1.0, 5.0 * third)]);
    let from = 260.0_f64.to_radians();
    let part = 70.0_f64.to_radians();
    let legs = [Leg::arc(inner, part), Leg::arc(inner, part)];
    let other = disc(0.575, inner * from.cos(), inner * from.sin(), from + FRAC_PI_2, &legs);
    let all = 2.0 * part * inner;
    // Half of what is covered, from the law of cosines.
    let half = ((1.0 + inner * inner - 1.15 * 1.15) / (2.0 * inner)).acos();
    let found = regions(&ego, &other);
    assert_eq!(found.len(), 2, "{found:?}");
    let turn = |s: f64| from + s / inner;
    assert_band(&found[0], [0.0, all], [0.0, turn(all) + half - TAU], |s| [0.0, turn(s) + half - TAU]);
    assert_band(&found[1], [0.0, all], [turn(0.0) - half, 5.0 * third], |s| [turn(s) - half, 5.0 * third]);
    let swapped = regions(&other, &ego);
    assert_eq!(swapped.len(), 2, "{swapped:?}");
    for (found, swapped) in found.iter().zip(&swapped) {
        assert_near(swapped.l, found.s.lo, found.s.hi, EXACT);
        assert_near(swapped.s, found.l.lo, found.l.hi, EXACT);
    }
}

#[test]
fn a_line_tangent_to_a_circle_at_the_combined_radius_touches_it_once() {
    let ego = disc(0.5, 0.0, -2.0, 0.0, &[Leg::arc(2.0, TAU)]);
    let outside = disc(0.5, -5.0, 3.0, 0.0, &[Leg::Line(10.0)]);
    let found = only(regions(&ego, &outside));
    assert!(found.s.contains(5.0) && found.l.contains(TAU));
    assert_near(found.s, 5.0, 5.0, TOUCHING);
    assert_near(found.l, TAU, TAU, TOUCHING);
    let missed = Disc { start: [-5.0, 3.0 + 1e-9, 0.0], ..outside };
    assert!(regions(&ego, &missed).is_empty());
}

#[test]
fn a_line_that_grazes_a_circle_has_the_ranges_of_its_normals() {
    // 2.5 m from the centre: reached within √(3² - 2.5²) along the line, and up to 1.5 m of height on the circle.
    let ego = disc(0.5, 0.0, -2.0, 0.0, &[Leg::arc(2.0, TAU)]);
    let other = disc(0.5, -5.0, 2.5, 0.0, &[Leg::Line(10.0)]);
    let found = only(regions(&ego, &other));
    let (along, around) = (2.75_f64.sqrt(), 2.0 * 0.75_f64.acos());
    assert_near(found.s, 5.0 - along, 5.0 + along, EXACT);
    assert_near(found.l, TAU - around, TAU + around, EXACT);
}

#[test]
fn an_agent_that_stands_in_the_way_is_one_slice_for_ever() {
    let ego = disc(0.6, 0.0, 0.0, 0.0, &[Leg::Line(10.0)]);
    let other = disc(0.4, 5.0, 0.6, 1.0, &[]);
    let audit = Audit::<f64>::new(&ego, &other).expect("a valid pair");
    let (motions, ecm) = audit.table();
    let region = ecm.pair(&motions, 0, 1).expect("the table of the fleet").next().expect("one region");
    assert_eq!(ecm.len(), 1);
    assert_eq!((region.time().lo, region.time().hi), (0.0, 0.0));
    assert!(region.is_open_at_start() && region.is_open_at_end());
    for time in [-100.0, 0.0, 100.0] {
        let slices: Vec<_> = region.slice_at(time).collect();
        assert_eq!(slices.len(), 1);
        assert_near(slices[0], 4.2, 5.8, EXACT);
    }
    // From the other side the standing agent sees it pass.
    let seen = ecm.pair(&motions, 1, 0).expect("the table of the fleet").next().expect("one region");
    assert_near(seen.time(), 4.2, 5.8, EXACT);
    assert_eq!((seen.length().lo, seen.length().hi), (0.0, 0.0));
    assert!(seen.contains(5.0, 0.0) && !seen.contains(4.1, 0.0) && !seen.is_open_at_start());
}

#[test]
fn standing_agents_overlap_or_do_not() {
    let at = |x| disc(0.5, x, 0.0, 0.0, &[]);
    for (distance, count) in [(0.0, 1), (0.9, 1), (1.0, 1), (1.0 + 1e-9, 0), (2.0, 0)] {
        let found = regions(&at(0.0), &at(distance));
        assert_eq!(found.len(), count, "at {distance}");
        assert!(
            found.iter().all(|region| (region.s.lo, region.s.hi, region.l.lo, region.l.hi) == (0.0, 0.0, 0.0, 0.0))
        );
    }
}

#[test]
fn identical_paths_are_one_band_over_all_joints() {
    let legs = [Leg::Line(2.0), Leg::arc(1.5, FRAC_PI_2), Leg::Line(3.0), Leg::arc(1.5, -FRAC_PI_2), Leg::Line(2.0)];
    let (ego, other) = (disc(0.3, 0.0, 0.0, 0.0, &legs), disc(0.2, 0.0, 0.0, 0.0, &legs));
    let found = only(regions(&ego, &other));
    let length = ego.length();
    assert_near(found.s, 0.0, length, EXACT);
    assert_near(found.l, 0.0, length, EXACT);
    assert!(found.slices.iter().all(|(s, slices)| slices.len() == 1 && slices[0].contains(*s)));
    // On the lines the band is R to both sides.
    let line = &found.slices[0];
    assert!(line.0 < 1.5);
    assert_near(line.1[0], (line.0 - 0.5).max(0.0), line.0 + 0.5, EXACT);
}

#[test]
fn the_same_path_the_other_way_is_one_band_over_all_joints() {
    let legs = [Leg::Line(2.0), Leg::arc(1.5, FRAC_PI_2), Leg::Line(3.0)];
    let ego = disc(0.3, 0.0, 0.0, 0.0, &legs);
    let other = Disc { radius: 0.2, ..pcr_tests::generators::reversed(&ego) };
    let found = only(regions(&ego, &other));
    let length = ego.length();
    assert_near(found.s, 0.0, length, EXACT);
    assert_near(found.l, 0.0, length, EXACT);
    assert!(found.slices.iter().all(|(s, slices)| slices.len() == 1 && slices[0].contains(length - s)));
}

#[test]
fn a_tangential_merge_is_one_region_to_the_end() {
    // A quarter circle runs into the ego's line 2 m after its start.
    let ego = disc(0.25, 0.0, 0.0, 0.0, &[Leg::Line(6.0)]);
    let other = disc(0.25, 0.0, -2.0, FRAC_PI_2, &[Leg::arc(2.0, -FRAC_PI_2), Leg::Line(4.0)]);
    let found = only(regions(&ego, &other));
    // The arc comes within R of the line at the angle with the sine 1.5 / 2.
    assert_near(found.s, 2.0 * 0.75_f64.asin(), PI + 4.0, EXACT);
    assert_eq!(found.l.hi, 6.0);
    let (s, slices) = found.slices.last().expect("slices");
    let ahead = 2.0 + (s - PI);
    assert_near(slices[0], ahead - 0.5, (ahead + 0.5).min(6.0), EXACT);
}

#[test]
fn a_common_start_is_a_region_from_the_start_on() {
    // At right angles: a quarter of the circle of a crossing.
    let ego = disc(0.5, 0.0, 0.0, 0.0, &[Leg::Line(5.0)]);
    let other = disc(0.5, 0.0, 0.0, FRAC_PI_2, &[Leg::Line(5.0)]);
    let found = only(regions(&ego, &other));
    assert_band(&found, [0.0, 1.0], [0.0, 1.0], |s| [0.0, ((1.0 - s) * (1.0 + s)).max(0.0).sqrt()]);
}

#[test]
fn segments_of_length_zero_change_nothing() {
    let plain = disc(0.3, 0.0, 0.0, 0.0, &[Leg::Line(3.0), Leg::arc(1.0, 2.0)]);
    let padded = disc(0.3, 0.0, 0.0, 0.0, &[Leg::Line(0.0), Leg::Line(3.0), Leg::arc(7.0, 0.0), Leg::arc(1.0, 2.0)]);
    let other = disc(0.2, 2.0, -1.0, FRAC_PI_2, &[Leg::Line(4.0)]);
    assert_eq!(format!("{:?}", regions(&plain, &other)), format!("{:?}", regions(&padded, &other)));
}

#[test]
fn an_almost_straight_arc_is_almost_the_line() {
    // The arc of 1e7 m radius leaves its tangent by 8e-7 m in 4 m.
    const SAGITTA: f64 = 8e-7;
    let arc = disc(0.5, -2.0, 0.0, 0.0, &[Leg::Left { radius: 1e7, length: 4.0 }]);
    let other = disc(0.5, 0.0, -3.0, FRAC_PI_2, &[Leg::Line(6.0)]);
    let found = only(regions(&arc, &other));
    assert_near(found.s, 2.0, 4.0, SAGITTA);
    assert_near(found.l, 1.0, 3.0, SAGITTA);
}

#[test]
fn a_tiny_circle_is_almost_a_point() {
    // Radius 1 mm, covered as a whole but for the last 2 mm.
    let circle = disc(0.5, 0.0, -1e-3, 0.0, &[Leg::arc(1e-3, TAU)]);
    let other = disc(0.5, -3.0, 0.0, 0.0, &[Leg::Line(6.0)]);
    let found = only(regions(&circle, &other));
    assert_near(found.s, 3.0 - 1.001, 3.0 + 1.001, EXACT);
    assert_near(found.l, 0.0, TAU * 1e-3, EXACT);
}

#[test]
fn a_joint_inside_a_region_does_not_cut_it() {
    // The ego turns on the other's line, so that the region is made of several pieces.
    let legs: Vec<_> = (0..8).map(|k| if k % 2 == 0 { Leg::Line(0.1) } else { Leg::arc(0.5, 0.2) }).collect();
    let ego = disc(0.5, -0.4, 0.0, 0.0, &legs);
    let other = disc(0.5, 0.0, -4.0, FRAC_PI_2, &[Leg::Line(4.0), Leg::Line(4.0)]);
    let audit = Audit::<f64>::new(&ego, &other).expect("a valid pair");
    let (motions, ecm) = audit.table();
    assert_eq!(ecm.len(), 1);
    assert!(
        ecm.pair(&motions, 0, 1).expect("the table of the fleet").next().expect("one region").pieces().count() >= 8
    );
}

/// A leg that is shorter than any rounding changes nothing, however short it is: not what is met on the way, and not when.
#[test]
fn legs_of_hardly_any_length_change_no_conflict() {
    fn met<S: Scalar<Angle = Radians<S>>>(tiny: S, number: fn(f64) -> S) -> (S, S) {
        let path = |[x, y, heading]: [f64; 3], lengths: &[S]| {
            let pose = Pose { position: Point::new(number(x), number(y)), heading: Radians(number(heading)) };
            let path =
                lengths.iter().try_fold(Path::<S, 3>::starting_at(pose).unwrap(), |path, &length| path.line(length));
            path.unwrap()
        };
        let profile = |path: &Path<S, 3>, speed: f64, acceleration: f64| {
            let limits = Limits { speed: number(speed), acceleration: number(acceleration) };
            Profile::<S, 3>::rest_to_rest(path.as_path().length(), limits).unwrap()
        };
        let a = path([1.893, -2.326, 2.1995], &[tiny, number(1.1313), tiny]);
        let b = path([2.842, -1.628, -1.905], &[number(1.773)]);
        let (p, q) = (profile(&a, 1.86, 0.0211), profile(&b, 0.7046, 1.205));
        let motion = |path: &Path<S, 3>, profile: &Profile<S, 3>, radius: f64| -> (Path<S, 3>, Profile<S, 3>, S) {
            (path.clone(), profile.clone(), number(radius))
        };
        let [a, b] = [motion(&a, &p, 0.888), motion(&b, &q, 0.2117)];
        let [a, b] = [&a, &b].map(|(path, profile, radius)| {
            Motion::new(path.as_path(), profile.as_profile(), *radius, S::ZERO).unwrap()
        });
        let encounter = Encounter::new(&a, &b);
        let conflict = encounter.conflicts(encounter.time()).next().expect("a conflict");
        (conflict.time.lo, conflict.depth)
    }
    let (time, depth) = met(0.0, |number| number);
    assert!((depth - 0.4092).abs() < 1e-4, "{time} {depth}");
    for tiny in [5e-324, 1e-320, 1e-310, 1e-200, 0.9e-150, 1.1e-150, 1e-100, 1e-30, 1e-15] {
        let (at, deep) = met(tiny, |number| number);
        assert!((at - time).abs() < 1e-9 && (deep - depth).abs() < 1e-9, "{tiny}: {at} {deep}");
    }
    for tiny in [1e-45, 1e-44, 1e-43, 1e-40, 1e-38, 0.9e-18, 1.1e-18, 1e-15, 1e-9] {
        let (at, deep) = met(tiny as f32, |number| number as f32);
        assert!((f64::from(at) - time).abs() < 1e-3 && (f64::from(deep) - depth).abs() < 1e-3, "{tiny}: {at} {deep}");
    }
}
