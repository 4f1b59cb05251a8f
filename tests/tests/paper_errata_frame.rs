//! What is wrong in the paper's equations and tables between the frames (Section 3.4), one test an error: the printed form gives the wrong value of the documented
//! counterexample; the corrected form, the definition of contact and pcr-core agree on the right one.
//!
//! `docs/theory/equations.md` has an entry for each.

use pcr_core::{
    Crossing, Ecm, EcmEntry, Motion, Path, Piece, PieceType, Point, Pose, Profile, Radians, TurnSide, crossings,
};
use pcr_tests::paper::global::eq_39;
use pcr_tests::paper::truth::{RIGHT, SAME, arc, assert_range, example, true_length, within};
use pcr_tests::paper::{Arc, Pcr, Range, cases, kernels, norm};
use std::f64::consts::{FRAC_PI_2, PI};

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
    let ego = way_out.and_then(|path| path.arc(0.5, TurnSide::Left, 0.5 * PI)).and_then(|path| path.line(3.0));
    let other = Path::starting_at(pose(2.82, -2.0, FRAC_PI_2)).and_then(|path| path.line(5.0));
    let paths = [ego.expect("a path"), other.expect("a path")];
    let constant = |length: f64| Profile::from_pieces(1.0, [(length, 0.0)]).expect("a profile");
    let profiles = [constant(6.0 + 0.5 * PI), constant(5.0)];
    let fleet = motions_of(&paths, &profiles, 0.7);
    let ecm = Ecm::build([EcmEntry::EMPTY; 8], [Piece::EMPTY; 32], &fleet).expect("room");
    let regions: Vec<_> = ecm.pair(&fleet, 0, 1).expect("the table of the fleet").collect();
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
    let ecm = Ecm::build([EcmEntry::EMPTY; 2], [Piece::EMPTY; 4], &fleet).expect("room");
    let holds =
        |[t, l]: [f64; 2]| ecm.pair(&fleet, 0, 1).expect("the table of the fleet").any(|region| region.contains(t, l));
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
