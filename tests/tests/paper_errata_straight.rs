//! What is wrong in the paper's equations for a straight ego (Section 3.3.1, 3.3.2), one test an error: the printed form gives the wrong value of the documented
//! counterexample; the corrected form, the definition of contact and pcr-core agree on the right one.
//!
//! A second test, where there is one, says exactly when the printed form is right, over random cases of every class.
//! `docs/theory/equations.md` has an entry for each.

use pcr_core::PieceType;
use pcr_tests::paper::cases;
use pcr_tests::paper::straight_arc::{eq_19, eq_22, eq_23};
use pcr_tests::paper::straight_straight::{eq_15, eq_17};
use pcr_tests::paper::truth::{
    EACH, PRINTED, RIGHT, SAME, arc, assert_range, example, other, true_length, true_time, within,
};

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
