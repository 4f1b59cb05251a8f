//! What is wrong in the paper's equations, one test an error: the printed form gives the wrong value of the documented
//! counterexample; the corrected form, the definition of contact and pcr-core agree on the right one.
//!
//! A second test, where there is one, says exactly when the printed form is right, over random cases of every class.
//! `docs/equations.md` has an entry for each.

use pcr_core::{Crossing, Ecm, Motion, Path, Piece, PieceType, Point, Pose, Profile, Radians, Region, Turn, crossings};
use pcr_tests::paper::arc_arc::{centre_distance, eq_34, eq_37};
use pcr_tests::paper::arc_straight::{eq_10, eq_25, eq_26, eq_28, eq_29, eq_30, eq_32, eq_33};
use pcr_tests::paper::global::eq_39;
use pcr_tests::paper::straight_arc::{eq_19, eq_22, eq_23};
use pcr_tests::paper::straight_straight::{eq_15, eq_17};
use pcr_tests::paper::{Arc, EVERYWHERE, Pcr, Range, Vec2, cases, definition, kernels, norm};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The documented numbers have three or four decimals.
const PRINTED: f64 = 6e-4;

/// Two computations of the right value \[s\] or \[m\].
const SAME: f64 = 1e-9;

/// A printed equation is right where it agrees to this \[s\] or \[m\]; no wrong one comes as near by chance in these cases.
const RIGHT: f64 = 1e-7;

/// Random cases of each class.
const EACH: usize = 25;

fn within(a: Range, b: Range, tolerance: f64) -> bool {
    a == b || (a[0] - b[0]).abs() < tolerance && (a[1] - b[1]).abs() < tolerance
}

#[track_caller]
fn assert_range(found: Range, expected: Range, tolerance: f64) {
    // Documented as NaN, infinite, or a number.
    let same = |a: f64, b: f64| a == b || a.is_nan() && b.is_nan() || (a - b).abs() < tolerance;
    assert!(same(found[0], expected[0]) && same(found[1], expected[1]), "{found:?} is not {expected:?}");
}

fn arc(radius: f64, dir: f64) -> Option<Arc> {
    Some(Arc { radius, dir })
}

/// A case with the numbers that most counterexamples share.
fn example(theta: f64, own: Option<Arc>, other: Option<Arc>) -> Pcr {
    Pcr { r: 0.3, v: 0.4, theta, own, other }
}

/// The true time range, on which the corrected form, the definition and the library agree.
#[track_caller]
fn true_time(pcr: &Pcr) -> Range {
    let range = pcr.time_range();
    assert_range(definition::time_range(pcr), range, SAME);
    assert_range(kernels::find(pcr, true, &[]).time, range, SAME);
    range
}

/// The true length range, on which the corrected form, the definition and the library agree.
#[track_caller]
fn true_length(pcr: &Pcr) -> Range {
    let range = pcr.length_range();
    assert_range(definition::length_range(pcr), range, SAME);
    assert_range(kernels::find(pcr, true, &[]).length, range, SAME);
    range
}

/// The true slice, on which the corrected form and the library agree, with contact at its ends.
#[track_caller]
fn true_slice(pcr: &Pcr, t: f64) -> Range {
    let found = kernels::find(pcr, true, &[t]);
    assert_eq!(found.slices[0].len(), 1, "{found:?}");
    let range = pcr.slice(t).expect("a slice");
    assert_range(found.slices[0][0], range, SAME);
    for l in range {
        let [contact, centre] =
            [definition::point(0.0, pcr.own, l), definition::point(pcr.theta, pcr.other, pcr.v * t)];
        assert!((norm([contact[0] - centre[0], contact[1] - centre[1]]) - pcr.r).abs() < SAME);
    }
    range
}

fn own(pcr: &Pcr) -> Arc {
    pcr.own.expect("an arc")
}

fn other(pcr: &Pcr) -> Arc {
    pcr.other.expect("an arc")
}

#[test]
fn eq_15_and_17_exchange_their_ends_where_the_other_comes_from_the_left() {
    let pcr = example(-1.0, None, None);
    assert_range(eq_15::as_printed(&pcr), [0.3565, -0.3565], PRINTED);
    assert_range(eq_17::as_printed(&pcr), [0.891, -0.891], PRINTED);
    assert_range(true_length(&pcr), [-0.3565, 0.3565], PRINTED);
    assert_range(true_time(&pcr), [-0.891, 0.891], PRINTED);
}

#[test]
fn eq_15_and_17_are_right_exactly_for_a_positive_sine() {
    for pcr in cases::of_type(PieceType::SS, EACH) {
        let right = pcr.theta.sin() > 0.0;
        assert_eq!(within(eq_15::as_printed(&pcr), pcr.length_range(), RIGHT), right, "{pcr:?}");
        assert_eq!(within(eq_17::as_printed(&pcr), pcr.time_range(), RIGHT), right, "{pcr:?}");
    }
}

#[test]
fn eq_22_has_the_wrong_sign_at_one_end() {
    let pcr = example(1.0, None, arc(1.5, 1.0));
    assert_range(eq_22::as_printed(&pcr, other(&pcr)), [0.3772, 0.3450], PRINTED);
    assert_range(true_length(&pcr), [-0.3772, 0.3450], PRINTED);
}

#[test]
fn eq_22_is_never_right() {
    for pcr in cases::of_type(PieceType::SA, EACH) {
        assert!(!within(eq_22::as_printed(&pcr, other(&pcr)), pcr.length_range(), RIGHT), "{pcr:?}");
    }
}

#[test]
fn eq_22_is_imaginary_where_the_line_passes_the_inner_circle_by() {
    // |c₁y| = 1.5 cos 0.3 = 1.433 > 1.5 - 0.3.
    let pcr = example(0.3, None, arc(1.5, 1.0));
    assert!(eq_22::as_printed(&pcr, other(&pcr))[0].is_nan());
    let [cx, cy] = eq_19(pcr.theta, other(&pcr));
    let outer = (1.8_f64.powi(2) - cy * cy).sqrt();
    assert_range(true_length(&pcr), [cx - outer, cx + outer], SAME);
}

#[test]
fn eq_23_takes_the_wrong_flank_for_a_negative_sine() {
    let pcr = example(-1.0, None, arc(1.5, 1.0));
    assert_range(eq_23::as_printed(&pcr, other(&pcr)), [-5.266, -3.443], PRINTED);
    assert_range(true_time(&pcr), [-0.838, 0.985], PRINTED);
}

#[test]
fn eq_23_has_no_root_where_two_crossings_share_a_region() {
    let pcr = example(0.3, None, arc(1.5, 1.0));
    assert_range(eq_23::as_printed(&pcr, other(&pcr)), [f64::NAN, 1.555], PRINTED);
    assert_range(true_time(&pcr), [-3.805, 1.555], PRINTED);
}

#[test]
fn eq_23_is_right_exactly_on_a_rising_flank_that_holds_both_contacts() {
    for pcr in cases::of_type(PieceType::SA, EACH) {
        let arc = other(&pcr);
        let cy = eq_19(pcr.theta, arc)[1];
        let on_flank = [-pcr.r, pcr.r].iter().all(|side| ((side - cy) / arc.radius).abs() <= 1.0);
        let right = pcr.theta.sin() > 0.0 && on_flank;
        assert_eq!(within(eq_23::as_printed(&pcr, arc), pcr.time_range(), RIGHT), right, "{pcr:?}");
        assert!(!right || pcr.r < arc.radius, "{pcr:?}");
    }
}

#[test]
fn eq_10_the_inverse_of_the_path_takes_the_intersections_to_the_collision_length() {
    let pcr = example(1.0, arc(1.5, -1.0), None);
    let own = own(&pcr);
    for t in [-0.5, 0.0, 0.5] {
        // The two intersections of the circles (8) and (24), from the triangle of their centres.
        let (p1, c2) = (pcr.position(t), eq_25(own));
        let towards: Vec2 = [p1[0] - c2[0], p1[1] - c2[1]];
        let distance = norm(towards);
        let along = (distance.powi(2) + own.radius.powi(2) - pcr.r.powi(2)) / (2.0 * distance);
        let across = (own.radius.powi(2) - along * along).sqrt();
        let unit = towards.map(|x| x / distance);
        let lengths = [1.0, -1.0].map(|side| {
            let side = side * across;
            eq_10([c2[0] + along * unit[0] - side * unit[1], c2[1] + along * unit[1] + side * unit[0]], own)
        });
        assert_range(true_slice(&pcr, t), lengths, SAME);
    }
}

#[test]
fn eq_26_squares_the_radius_that_it_should_index() {
    let pcr = example(1.0, arc(1.5, -1.0), None);
    let (own, p1) = (own(&pcr), pcr.position(0.3));
    let slice = true_slice(&pcr, 0.3);
    // Here (28) and (29) are right, and the exponent is the only error.
    assert_range(eq_26::with_printed_angles(p1, pcr.r, own), slice, SAME);
    assert_range(eq_26::as_printed(p1, pcr.r, own), slice.map(|l| 1.5 * l), SAME);
}

#[test]
fn eq_28_loses_the_branch_where_the_chord_is_beyond_the_centre() {
    let pcr = Pcr { r: 0.6, ..example(1.0, arc(0.4, -1.0), None) };
    let p1 = pcr.position(-1.0);
    assert_range(eq_26::with_printed_angles(p1, pcr.r, own(&pcr)), [-0.752, -0.276], PRINTED);
    assert_range(true_slice(&pcr, -1.0), [-1.533, 0.505], PRINTED);
}

#[test]
fn eq_28_has_no_value_where_the_disc_holds_the_circle_nor_where_it_does_not_reach_it() {
    // Next to the centre of the circle: D = 0.1, and D + ς₂ = 0.5 <= 0.6.
    let circle = Arc { radius: 0.4, dir: 1.0 };
    assert!(eq_28::as_printed([0.1, 0.4], 0.6, circle).is_nan());
    assert_eq!(eq_28::corrected([0.1, 0.4], 0.6, circle), Some(TAU));
    // Far away there is no chord.
    assert!(eq_28::as_printed([2.0, 0.4], 0.6, circle).is_nan());
    assert_eq!(eq_28::corrected([2.0, 0.4], 0.6, circle), None);
}

#[test]
fn eq_28_and_29_are_right_exactly_before_the_centre_and_on_the_near_half_of_the_clockwise_circle() {
    let (mut right, mut wrong) = (0, 0);
    for pcr in cases::of_type(PieceType::AS, EACH).into_iter().chain(cases::of_type(PieceType::AA, EACH)) {
        let own = own(&pcr);
        let [lo, hi] = if pcr.time_range() == EVERYWHERE { [-1.0, 1.0] } else { pcr.time_range() };
        for fraction in [0.1, 0.35, 0.6, 0.85] {
            let p1 = pcr.position(lo + fraction * (hi - lo));
            let relative = p1[1] - eq_25(own)[1];
            let distance = norm([p1[0], relative]);
            let Some(phi) = eq_28::corrected(p1, pcr.r, own).filter(|phi| *phi < TAU) else {
                continue;
            };
            let before_centre = distance.powi(2) + own.radius.powi(2) >= pcr.r.powi(2);
            assert_eq!((eq_28::as_printed(p1, pcr.r, own) - phi).abs() < RIGHT, before_centre, "{pcr:?} {p1:?}");
            let epsilon = eq_29::corrected(p1, own);
            let near_half = own.dir < 0.0 && relative > 0.0;
            // For c₂'' the printed angle has the other sign, or lies on the other half of the circle.
            assert_eq!((eq_29::as_printed(p1, own) - epsilon).abs() < RIGHT, near_half, "{pcr:?} {p1:?}");
            *(if before_centre && near_half { &mut right } else { &mut wrong }) += 1;
        }
    }
    assert!(right > 100 && wrong > 100, "{right} {wrong}");
}

#[test]
fn eq_29_has_the_wrong_sign_for_the_counter_clockwise_circle() {
    let pcr = example(1.0, arc(1.5, 1.0), None);
    assert_range(eq_26::with_printed_angles(pcr.position(0.3), pcr.r, own(&pcr)), [-0.363, 0.224], PRINTED);
    assert_range(true_slice(&pcr, 0.3), [-0.224, 0.363], PRINTED);
}

#[test]
fn eq_29_loses_half_of_the_circle() {
    let pcr = Pcr { v: 1.0, ..example(4.0, arc(0.5, -1.0), None) };
    assert_range(eq_26::with_printed_angles(pcr.position(0.85), pcr.r, own(&pcr)), [0.384, 0.934], PRINTED);
    let corrected = pcr.slice(0.85).expect("a slice");
    assert_range(corrected, [-1.187, -0.637], PRINTED);
    // The line is about to leave the circle there: the slice belongs to the next crossing, with a region of its own or, as
    // here, with the same one. Full circles repeat it every π metres.
    let slices = &kernels::find(&pcr, true, &[0.85]).slices[0];
    let laps = |found: &Range| (found[0] - corrected[0]) / PI;
    assert!(slices.iter().any(|found| (laps(found) - laps(found).round()).abs() < SAME), "{slices:?}");
    assert!(!slices.iter().any(|found| (found[0] - 0.384).abs() < PRINTED), "{slices:?}");
}

#[test]
fn eq_30_inverts_a_ratio_and_has_the_wrong_sign_at_one_end() {
    let pcr = example(1.0, arc(1.5, -1.0), None);
    assert_range(true_length(&pcr), [-0.3941, 0.3353], PRINTED);
    assert!(eq_30::as_printed(&pcr, own(&pcr))[0].is_nan());
    assert!(!within(eq_30::with_ratio_inverted(&pcr, own(&pcr)), pcr.length_range(), RIGHT));
}

#[test]
fn eq_30_is_never_right() {
    for pcr in cases::of_type(PieceType::AS, EACH) {
        assert!(!within(eq_30::as_printed(&pcr, own(&pcr)), pcr.length_range(), RIGHT), "{pcr:?}");
        assert!(!within(eq_30::with_ratio_inverted(&pcr, own(&pcr)), pcr.length_range(), RIGHT), "{pcr:?}");
    }
}

#[test]
fn eq_32_is_that_of_the_counter_clockwise_circle() {
    for dir in [1.0, -1.0] {
        let pcr = example(1.0, arc(1.5, dir), None);
        let own = own(&pcr);
        let residual = |equation: fn(&Pcr, Arc, f64, f64) -> f64, t: f64| {
            [1.0, -1.0].map(|side| equation(&pcr, own, side, t).abs()).into_iter().fold(f64::INFINITY, f64::min)
        };
        for t in true_time(&pcr) {
            assert!(residual(eq_32::corrected, t) < SAME);
            assert_eq!(residual(eq_32::as_printed, t) < SAME, dir > 0.0);
        }
    }
}

#[test]
fn eq_33_takes_both_roots_of_one_contact() {
    let pcr = example(1.0, arc(1.5, -1.0), None);
    assert_range(eq_33::as_printed(&pcr, own(&pcr), -1.0), [-0.863, 7.174], PRINTED);
    assert_range(eq_33::as_printed(&pcr, own(&pcr), 1.0), [0.943, 5.368], PRINTED);
    assert_range(true_time(&pcr), [-0.9431, 0.8625], PRINTED);
}

#[test]
fn eq_33_is_right_exactly_for_merged_regions_and_a_line_that_enters_the_counter_clockwise_circle() {
    for pcr in cases::of_type(PieceType::AS, EACH) {
        let own = own(&pcr);
        let line = own.radius * pcr.theta.cos().abs();
        let merged = pcr.r >= own.radius || own.radius - pcr.r <= line;
        let printed = |side| within(eq_33::as_printed(&pcr, own, side), pcr.time_range(), RIGHT);
        assert_eq!(printed(-1.0), merged && own.dir > 0.0, "{pcr:?}");
        assert!(!printed(1.0), "{pcr:?}");
    }
}

#[test]
fn eq_34_uses_the_wrong_corner_of_the_triangle_and_has_the_wrong_sign_at_one_end() {
    let pcr = example(1.0, arc(1.5, -1.0), arc(1.2, 1.0));
    assert!(eq_34::as_printed(&pcr, own(&pcr), other(&pcr)).iter().any(|l| l.is_nan()));
    let [lo, hi] = eq_34::with_denominator_corrected(&pcr, own(&pcr), other(&pcr));
    assert_range([lo, hi], [-0.488, -0.328], PRINTED);
    assert_range(true_length(&pcr), [-0.4877, 0.3278], PRINTED);
}

#[test]
fn eq_34_is_never_right() {
    for pcr in cases::of_type(PieceType::AA, EACH) {
        let (own, other) = (own(&pcr), other(&pcr));
        assert!(!within(eq_34::as_printed(&pcr, own, other), pcr.length_range(), RIGHT), "{pcr:?}");
        assert!(!within(eq_34::with_denominator_corrected(&pcr, own, other), pcr.length_range(), RIGHT), "{pcr:?}");
    }
}

#[test]
fn eq_37_takes_the_wrong_flank_where_the_other_enters_the_circle() {
    let pcr = example(1.0, arc(1.5, 1.0), arc(1.2, 1.0));
    assert_range(eq_37::as_printed(&pcr, own(&pcr), other(&pcr)), [-2.647, -0.846], PRINTED);
    assert_range(true_time(&pcr), [-0.950, 0.851], PRINTED);
}

#[test]
fn eq_37_is_right_exactly_where_the_other_leaves_and_both_contacts_are_on_the_flank() {
    for pcr in cases::of_type(PieceType::AA, EACH) {
        let (own, other) = (own(&pcr), other(&pcr));
        let on_flank = eq_37::arguments(&pcr, own, other).iter().all(|sine| sine.abs() <= 1.0);
        let right = eq_37::alpha(&pcr, own, other) > 0.0 && on_flank && pcr.r < own.radius;
        assert_eq!(within(eq_37::as_printed(&pcr, own, other), pcr.time_range(), RIGHT), right, "{pcr:?}");
    }
}

fn motions_of<'a>(paths: &'a [Path<f64, 3>; 2], profiles: &'a [Profile<f64, 1>; 2], r: f64) -> [Motion<'a, f64>; 2] {
    [0, 1].map(|k| {
        Motion::new(paths[k].as_path(), profiles[k].as_profile(), 0.5 * r, 0.0).expect("a motion of a valid path")
    })
}

fn pose(x: f64, y: f64, heading: f64) -> Pose<f64> {
    Pose { position: Point::new(x, y), heading: Radians(heading) }
}

#[test]
fn eq_38_a_region_may_have_two_intervals_at_one_time() {
    // The ego goes east for 3 m, turns round on a half circle of radius 0.5 and comes back 1 m further north; the other
    // goes north at x = 2.82. Its disc of R = 0.7 comes within reach of the way back (at y = 0.3) before it
    // reaches the apex of the turn (at y = 0.5 - √(0.7² - 0.68²) = 0.334).
    let way_out = Path::starting_at(pose(0.0, 0.0, 0.0)).and_then(|path| path.line(3.0));
    let ego = way_out.and_then(|path| path.arc(0.5, Turn::Left, 0.5 * PI)).and_then(|path| path.line(3.0));
    let other = Path::starting_at(pose(2.82, -2.0, FRAC_PI_2)).and_then(|path| path.line(5.0));
    let paths = [ego.expect("a path"), other.expect("a path")];
    let constant = |length: f64| Profile::from_pieces(1.0, [(length, 0.0)]).expect("a profile");
    let profiles = [constant(6.0 + 0.5 * PI), constant(5.0)];
    let fleet = motions_of(&paths, &profiles, 0.7);
    let ecm = Ecm::build([Region::EMPTY; 8], [Piece::EMPTY; 32], &fleet).expect("room");
    let regions: Vec<_> = ecm.pair(&fleet, 0, 1).collect();
    assert_eq!(regions.len(), 1);
    let slices_at = |y: f64| regions[0].slice_at(y + 2.0).map(|slice| [slice.lo, slice.hi]).collect::<Vec<Range>>();
    let slices = slices_at(0.32);
    assert_eq!(slices.len(), 2, "{slices:?}");
    for l in slices.iter().flatten() {
        let contact = fleet[0].path().point_at(*l);
        assert!((norm([contact.x - 2.82, contact.y - 0.32]) - 0.7).abs() < SAME, "{slices:?}");
    }
    let half = (0.7_f64.powi(2) - 0.68_f64.powi(2)).sqrt();
    let back = 3.0 + 0.5 * PI + 0.18;
    assert_range(slices[1], [back - half, back + half], SAME);
    assert_eq!((slices_at(0.2).len(), slices_at(0.5).len()), (1, 1));
}

#[test]
fn eq_39_takes_the_length_along_the_wrong_path() {
    // The ego meets the crossing after 1 m, the other after 3 m.
    let ego = Path::starting_at(pose(-1.0, 0.0, 0.0)).and_then(|path| path.line(4.0));
    let other = Path::starting_at(pose(0.0, -3.0, FRAC_PI_2)).and_then(|path| path.line(4.0));
    let paths = [ego.expect("a path"), other.expect("a path")];
    let profiles = [2.0, 0.5].map(|speed| Profile::from_pieces(speed, [(4.0 / speed, 0.0)]).expect("a profile"));
    let fleet = motions_of(&paths, &profiles, 0.5);
    let all: Vec<Crossing<f64>> = crossings(&fleet[0], &fleet[1]).collect();
    assert_eq!(all.len(), 1);
    assert_range(eq_39::as_printed(&all[0]), [6.0, 3.0], SAME);
    assert_range(eq_39::corrected(&all[0]), [6.0, 1.0], SAME);
    let ecm = Ecm::build([Region::EMPTY; 2], [Piece::EMPTY; 4], &fleet).expect("room");
    let holds = |[t, l]: [f64; 2]| ecm.pair(&fleet, 0, 1).any(|region| region.contains(t, l));
    assert!(holds(eq_39::corrected(&all[0])) && !holds(eq_39::as_printed(&all[0])));
}

#[test]
fn table_iii_the_turn_of_an_arc_belongs_to_the_parameters() {
    // Both turns of either arc, everything else equal: four different regions.
    let turns = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let ranges = turns.map(|(own, other)| true_length(&example(1.0, arc(1.5, own), arc(1.2, other))));
    for (k, a) in ranges.iter().enumerate() {
        assert!(ranges[..k].iter().all(|b| !within(*a, *b, RIGHT)), "{ranges:?}");
    }
}

#[test]
fn table_iii_a_reflection_turns_every_region_into_one_with_a_clockwise_ego() {
    let flip = |arc: Option<Arc>| arc.map(|arc| Arc { dir: -arc.dir, ..arc });
    for piece_type in [PieceType::SS, PieceType::SA, PieceType::AS, PieceType::AA] {
        for pcr in cases::of_type(piece_type, 5) {
            let mirrored = Pcr { theta: -pcr.theta, own: flip(pcr.own), other: flip(pcr.other), ..pcr };
            let (here, there) = (kernels::find(&pcr, true, &[0.0]), kernels::find(&mirrored, true, &[0.0]));
            assert!(within(here.time, there.time, SAME) && within(here.length, there.length, SAME), "{pcr:?}");
        }
    }
}

#[test]
fn sections_3_3_3_contradict_one_another_about_the_turn_of_the_ego() {
    // (29) holds for c₂' only, (33) for c₂'' only: no clockwise or counter-clockwise AS case has both right.
    for pcr in cases::of_type(PieceType::AS, EACH) {
        let own = own(&pcr);
        let p1 = pcr.position(0.01 * pcr.r / pcr.v);
        let angle = (eq_29::as_printed(p1, own) - eq_29::corrected(p1, own)).abs() < RIGHT;
        let time = [1.0, -1.0].iter().any(|side| within(eq_33::as_printed(&pcr, own, *side), pcr.time_range(), RIGHT));
        assert!(!(angle && time), "{pcr:?}");
    }
}

#[test]
fn the_distance_of_the_centres_is_that_of_the_cosine_formula() {
    // θ⁰ of (34) is the angle at c₂ from the origin to c₁.
    for pcr in cases::of_type(PieceType::AA, 5) {
        let (own, other) = (own(&pcr), other(&pcr));
        let ([x1, y1], [x2, y2]) = (eq_19(pcr.theta, other), eq_25(own));
        let centres = centre_distance(&pcr, own, other);
        let cos = (own.radius.powi(2) + centres.powi(2) - other.radius.powi(2)) / (2.0 * centres * own.radius);
        let dot = (x1 - x2) * -x2 + (y1 - y2) * -y2;
        assert!((cos - dot / (centres * own.radius)).abs() < SAME, "{pcr:?}");
    }
}
