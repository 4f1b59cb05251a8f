//! The paper's equations (7)-(39), as corrected, against pcr-core and against the definition of contact.
//!
//! Random crossings of each type on long paths at constant speed: every quadrant of θ, both turns, combined radii
//! smaller and larger than the radii of the arcs. Errors of the paper, one by one: `paper_errata_*.rs`.

use pcr_core::{PieceType, Radians};
use pcr_tests::paper::arc_arc::{eq_35, eq_36};
use pcr_tests::paper::arc_straight::{eq_24, eq_26, eq_27, eq_31, eq_32};
use pcr_tests::paper::definition::{self, point};
use pcr_tests::paper::global::{eq_07, eq_38, eq_39};
use pcr_tests::paper::kernels::{self, Found};
use pcr_tests::paper::straight_arc::{eq_18, eq_19, eq_21};
use pcr_tests::paper::straight_straight::{eq_08, eq_11, eq_12, eq_14, eq_14_discriminant, eq_16};
use pcr_tests::paper::{EVERYWHERE, Pcr, Range, cases};
use std::f64::consts::TAU;

/// Times \[s\] and lengths \[m\]: two `f64` computations of numbers up to 400, amplified by up to the inverse square root
/// of [`cases::of_type`]'s distance from tangency. The largest difference seen is below a tenth of it.
const TOLERANCE: f64 = 1e-9;

/// Residuals of squares \[m²\] of numbers up to 1e3.
const RESIDUAL: f64 = 1e-9;

/// Random cases of each class; there are 4 (SS), 24 (SA, AS) and 48 (AA) classes.
const EACH: usize = 25;

const TYPES: [PieceType; 4] = [PieceType::SS, PieceType::SA, PieceType::AS, PieceType::AA];

/// Where in a range slices are compared.
const INSIDE: [f64; 5] = [0.03, 0.3, 0.5, 0.7, 0.97];

fn all(each: usize) -> impl Iterator<Item = Pcr> {
    TYPES.into_iter().flat_map(move |piece_type| cases::of_type(piece_type, each))
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() < TOLERANCE
}

/// The finite range that a region has on a carrier of this lap length (infinite: a line), or one that runs round it.
fn same_range(expected: Range, found: Range, lap: f64) -> bool {
    if expected == EVERYWHERE {
        return found[1] - found[0] > lap;
    }
    near(expected[0], found[0]) && near(expected[1], found[1])
}

/// Times at which the slices of a region are compared, within the other's travel.
fn inner_times(pcr: &Pcr) -> Vec<f64> {
    let [lo, hi] = match pcr.time_range() {
        EVERYWHERE => [-TAU, TAU].map(|angle| angle * pcr.other.map_or(0.0, |arc| arc.radius) / pcr.v),
        range => range,
    };
    INSIDE.map(|fraction| lo + fraction * (hi - lo)).to_vec()
}

/// Whether a slice of the library is what the contour equations say: their interval, on one or more laps.
fn same_slice(pcr: &Pcr, t: f64, found: &[Range], path: Range) -> bool {
    let Some(expected) = pcr.slice(t) else {
        return found.is_empty();
    };
    let lap = pcr.own.map_or(f64::INFINITY, |arc| TAU * arc.radius);
    if expected[1] - expected[0] >= lap {
        return found == [path];
    }
    !found.is_empty()
        && found.iter().all(|found| {
            let laps = match pcr.own {
                None => 0.0,
                Some(_) => lap * ((found[0] + found[1] - expected[0] - expected[1]) / (2.0 * lap)).round(),
            };
            // An end of the ego's path may cut off a lap.
            let cut = found[0] <= path[0] || found[1] >= path[1];
            cut || near(found[0], expected[0] + laps) && near(found[1], expected[1] + laps)
        })
}

fn assert_agreement(piece_type: PieceType) {
    let cases = cases::of_type(piece_type, EACH);
    assert!(cases.len() >= 4 * EACH);
    for pcr in cases {
        let times = inner_times(&pcr);
        for ego_first in [true, false] {
            let found = kernels::find(&pcr, ego_first, &times);
            let other_lap = pcr.other.map_or(0.0, |arc| TAU * arc.radius / pcr.v);
            let own_lap = pcr.own.map_or(0.0, |arc| TAU * arc.radius);
            assert!(same_range(pcr.time_range(), found.time, other_lap), "{pcr:?} {:?} {found:?}", pcr.time_range());
            assert!(
                same_range(pcr.length_range(), found.length, own_lap),
                "{pcr:?} {:?} {found:?}",
                pcr.length_range()
            );
            for (t, slice) in times.iter().zip(&found.slices) {
                assert!(same_slice(&pcr, *t, slice, found.path), "{pcr:?} at {t}: {:?} {slice:?}", pcr.slice(*t));
            }
        }
    }
}

#[test]
fn straight_straight_regions_are_those_of_eq_13_15_17() {
    assert_agreement(PieceType::SS);
}

#[test]
fn straight_arc_regions_are_those_of_eq_13_22_23() {
    assert_agreement(PieceType::SA);
}

#[test]
fn arc_straight_regions_are_those_of_eq_26_30_33() {
    assert_agreement(PieceType::AS);
}

#[test]
fn arc_arc_regions_are_those_of_eq_26_34_37() {
    assert_agreement(PieceType::AA);
}

#[test]
fn the_corrected_ranges_are_those_of_the_definition() {
    for pcr in all(EACH) {
        let (time, length) = (definition::time_range(&pcr), definition::length_range(&pcr));
        let same = |a: Range, b: Range| a == b || near(a[0], b[0]) && near(a[1], b[1]);
        assert!(same(pcr.time_range(), time), "{pcr:?} {:?} {time:?}", pcr.time_range());
        assert!(same(pcr.length_range(), length), "{pcr:?} {:?} {length:?}", pcr.length_range());
    }
}

#[test]
fn the_cases_hold_single_merged_and_endless_regions_of_every_type_with_arcs() {
    for piece_type in [PieceType::SA, PieceType::AS, PieceType::AA] {
        let cases = cases::of_type(piece_type, EACH);
        let endless = |pcr: &&Pcr| pcr.time_range() == EVERYWHERE || pcr.length_range() == EVERYWHERE;
        let endless = cases.iter().filter(endless).count();
        assert!(
            endless > 10 && endless < cases.len() / 2 + cases.len() / 4,
            "{piece_type}: {endless} of {}",
            cases.len()
        );
    }
}

#[test]
fn eq_08_11_12_the_intersections_lie_on_the_contour_and_on_the_path() {
    for pcr in cases::of_type(PieceType::SS, EACH).into_iter().chain(cases::of_type(PieceType::SA, EACH)) {
        for t in inner_times(&pcr) {
            let centre = pcr.position(t);
            for point in eq_12(centre, pcr.r).into_iter().flatten() {
                assert!(eq_08(point, centre, pcr.r).abs() < RESIDUAL, "{pcr:?} at {t}");
                assert_eq!(eq_11(point), 0.0);
            }
        }
    }
}

#[test]
fn eq_09_18_19_20_are_the_motion_of_the_other_agent() {
    for pcr in all(EACH) {
        for t in inner_times(&pcr) {
            let (paper, walked) = (pcr.position(t), point(pcr.theta, pcr.other, pcr.v * t));
            assert!(near(paper[0], walked[0]) && near(paper[1], walked[1]), "{pcr:?} at {t}");
            if let Some(arc) = pcr.other {
                assert!(eq_18(paper, eq_19(pcr.theta, arc), arc).abs() < RESIDUAL, "{pcr:?} at {t}");
            }
        }
    }
}

#[test]
fn eq_14_holds_at_every_contact_and_its_discriminant_vanishes_at_the_extreme_lengths() {
    for pcr in cases::of_type(PieceType::SS, EACH) {
        for t in inner_times(&pcr) {
            let centre = pcr.position(t);
            for point in eq_12(centre, pcr.r).into_iter().flatten() {
                assert!(eq_14(&pcr, point[0], centre[0]).abs() < RESIDUAL, "{pcr:?} at {t}");
            }
        }
        let scale = 1.0 + pcr.theta.tan().powi(2);
        for l in pcr.length_range() {
            assert!(eq_14_discriminant(&pcr, l).abs() < RESIDUAL * scale, "{pcr:?}");
            assert!(eq_14_discriminant(&pcr, 0.9 * l) > 0.0 && eq_14_discriminant(&pcr, 1.1 * l) < 0.0, "{pcr:?}");
        }
    }
}

#[test]
fn eq_16_holds_inside_the_time_range_and_not_just_outside() {
    for pcr in cases::of_type(PieceType::SS, EACH).into_iter().chain(cases::of_type(PieceType::SA, EACH)) {
        assert!(inner_times(&pcr).into_iter().all(|t| eq_16(&pcr, t)), "{pcr:?}");
        let [lo, hi] = pcr.time_range();
        if lo.is_finite() {
            let beyond = 1e-6 * (hi - lo);
            assert!(!eq_16(&pcr, lo - beyond) && !eq_16(&pcr, hi + beyond), "{pcr:?}");
        }
    }
}

#[test]
fn eq_21_the_extreme_lengths_of_sa_lie_on_the_paths_translated_by_the_radius() {
    for pcr in cases::of_type(PieceType::SA, EACH) {
        let arc = pcr.other.expect("SA");
        for l in pcr.length_range() {
            let residual = [1.0, -1.0].map(|side| eq_21([l, 0.0], eq_19(pcr.theta, arc), arc, pcr.r, side).abs());
            assert!(residual[0].min(residual[1]) < RESIDUAL, "{pcr:?}");
        }
    }
}

#[test]
fn eq_24_27_the_chord_holds_both_intersections() {
    for pcr in cases::of_type(PieceType::AS, EACH).into_iter().chain(cases::of_type(PieceType::AA, EACH)) {
        let own = pcr.own.expect("an arc");
        for t in inner_times(&pcr) {
            let p1 = pcr.position(t);
            let range = eq_26::corrected(p1, pcr.r, own).filter(|range| range[1] - range[0] < TAU * own.radius);
            for l in range.into_iter().flatten() {
                let contact = point(0.0, Some(own), l);
                assert!(eq_24(contact, own).abs() < RESIDUAL, "{pcr:?} at {t}");
                assert!(eq_08(contact, p1, pcr.r).abs() < RESIDUAL, "{pcr:?} at {t}");
                assert!(eq_27(contact, p1, pcr.r, own).abs() < RESIDUAL, "{pcr:?} at {t}");
            }
        }
    }
}

#[test]
fn eq_31_32_35_36_hold_when_the_circles_touch() {
    for pcr in cases::of_type(PieceType::AS, EACH).into_iter().chain(cases::of_type(PieceType::AA, EACH)) {
        let own = pcr.own.expect("an arc");
        for t in pcr.time_range().into_iter().filter(|t| t.is_finite()) {
            let p1 = pcr.position(t);
            let residuals = [1.0, -1.0].map(|side| match pcr.other {
                None => [eq_31(p1, pcr.r, own, side), eq_32::corrected(&pcr, own, -side, t)],
                Some(other) => {
                    let phi = pcr.v / other.radius * t;
                    let line = eq_35(&pcr, own, other, side, p1);
                    // (35) is half of the difference of (18) and (31).
                    assert!((line - eq_36(&pcr, own, other, side, phi)).abs() < RESIDUAL, "{pcr:?}");
                    [eq_31(p1, pcr.r, own, side), 2.0 * line]
                }
            });
            assert!(residuals.iter().all(|[a, b]| (a.abs() - b.abs()).abs() < RESIDUAL), "{pcr:?} {residuals:?}");
            assert!(residuals.iter().any(|[a, _]| a.abs() < RESIDUAL), "{pcr:?} {residuals:?}");
        }
    }
}

/// Descriptor and region of a case, in {A}.
fn in_a(found: &Found) -> ([f64; 2], [f64; 2]) {
    let begin = eq_07([found.time[0], found.length[0]], found.origin);
    let end = eq_07([found.time[1], found.length[1]], found.origin);
    (begin, end)
}

#[test]
fn eq_07_39_the_crossing_of_the_library_is_the_origin_of_the_local_frame() {
    for pcr in all(5) {
        let found = kernels::find(&pcr, true, &[]);
        let [t, l] = eq_39::corrected(&found.crossing);
        assert!(near(t, found.origin[0]) && near(l, found.origin[1]), "{pcr:?} {found:?}");
        let (begin, end) = in_a(&found);
        assert!(begin[0] < t && t < end[0] && begin[1] < l && l < end[1], "{pcr:?} {found:?}");
    }
}

#[test]
fn table_iii_the_descriptor_of_the_library_has_the_parameters_of_the_case() {
    for pcr in all(5) {
        let crossing = kernels::find(&pcr, false, &[]).crossing;
        let Radians(theta) = crossing.theta;
        assert_eq!(crossing.piece_type, pcr.piece_type());
        assert!(near(crossing.combined_radius, pcr.r) && near(crossing.speed, pcr.v), "{pcr:?} {crossing:?}");
        assert!(near(((theta - pcr.theta) / TAU).round() * TAU, theta - pcr.theta), "{pcr:?} {crossing:?}");
    }
}

#[test]
fn eq_38_the_region_is_what_the_time_range_and_the_contour_enclose() {
    for pcr in cases::of_type(PieceType::SS, EACH) {
        let [lower, upper] = pcr.length_range();
        let times = inner_times(&pcr);
        let found = kernels::find(&pcr, true, &times);
        for (t, slices) in times.iter().zip(&found.slices) {
            for step in 0..=20 {
                let l = lower + (upper - lower) * f64::from(step) / 20.0;
                let inside = slices.iter().any(|slice| slice[0] <= l && l <= slice[1]);
                assert_eq!(eq_38([*t, l], pcr.time_range(), |t| pcr.slice(t)), inside, "{pcr:?} at {t}, {l}");
            }
        }
    }
}
