//! What is wrong in the paper's equations for an ego on an arc (Sections 3.3.3, 3.3.4), one test an error: the printed form gives the wrong value of the documented
//! counterexample; the corrected form, the definition of contact and pcr-core agree on the right one.
//!
//! A second test, where there is one, says exactly when the printed form is right, over random cases of every class.
//! `docs/theory/equations.md` has an entry for each.

use pcr_core::PieceType;
use pcr_tests::paper::arc_arc::{centre_distance, eq_34, eq_37};
use pcr_tests::paper::arc_straight::{eq_10, eq_25, eq_26, eq_28, eq_29, eq_30, eq_32, eq_33};
use pcr_tests::paper::straight_arc::eq_19;
use pcr_tests::paper::truth::{
    EACH, PRINTED, RIGHT, SAME, arc, assert_range, example, other, own, true_length, true_slice, true_time, within,
};
use pcr_tests::paper::{Arc, EVERYWHERE, Pcr, Range, Vec2, cases, kernels, norm};
use std::f64::consts::{PI, TAU};

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
