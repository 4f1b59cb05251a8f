//! "Outward by construction", in every number format: no collision is outside the regions, nothing in them is further
//! than the stated excess from one, and times are rounded outward (`pcr_tests::outward`, `docs/theory/errors.md`).
//!
//! The long command is
//! `cargo run --release -p pcr-tests --example outward -- --pairs 100000000 --seed 1`.

use pcr_core::scalar::Micro;
use pcr_core::{Motion, excess};
use pcr_fixed::{Q12, Q16, Q20};
use pcr_planning::fleet::HostScalar;
use pcr_tests::case_ranges::run_on_all_processors;
use pcr_tests::disc::{Course, Disc, Drive, Leg};
use pcr_tests::exact::{DoubleDouble, Route};
use pcr_tests::generators::{Dice, RELATIONS, drive, related};
use pcr_tests::outward::{Checked, Seen, run};

/// Cases of a format that are checked: 82,500 in all in a release run, less in a debug run. They are the same in every run; new ones
/// are for the long command.
const fn cases(release: u64) -> u64 {
    if cfg!(optimized) { release } else { 1_000 }
}

fn holds<S: HostScalar>(first: u64, cases: u64, held: f64) {
    let tally = run_on_all_processors(run::<S>, first, cases, |_, _| ());
    println!("{}: {tally}", S::NAME);
    assert!(tally.violations.is_empty(), "{}: {:#?}", S::NAME, tally.violations);
    assert_eq!(tally.cases(), cases);
    assert!(tally.seen.pairs as f64 > held * cases as f64, "{tally}");
    // A run that refuses, misses or decides next to nothing proves as much.
    let seen = tally.seen;
    assert!(seen.regions > seen.pairs, "{tally}");
    assert!(seen.inside > 5 * seen.pairs && seen.outside > 5 * seen.pairs && seen.decided > seen.pairs, "{tally}");
    // Ends of slices lie about half the excess out, as they should: the bound is neither idle nor used up.
    assert!(0.0 < seen.margin && seen.margin < 0.5 && 0.5 < seen.excess && seen.excess <= 1.0, "{tally}");
}

#[test]
fn regions_are_outward_in_f64() {
    holds::<f64>(100_000_000, cases(15_000), 0.98);
}

#[test]
fn regions_are_outward_in_f32() {
    holds::<f32>(1, cases(15_000), 0.95);
}

#[test]
fn regions_are_outward_in_micro() {
    holds::<Micro>(1, cases(7_500), 0.95);
}

// A half of the cases is beyond the limits of a fixed-point format; those that it holds are counted.
#[test]
fn regions_are_outward_in_q20() {
    holds::<Q20>(1, cases(15_000), 0.48);
}

#[test]
fn regions_are_outward_in_q16() {
    holds::<Q16>(1, cases(15_000), 0.58);
}

#[test]
fn regions_are_outward_in_q12() {
    holds::<Q12>(1, cases(15_000), 0.64);
}

/// The pairs that found faults, by the seeds they had in an earlier order of the cases.
fn held_once<S: HostScalar>(seeds: &[u64]) {
    for &seed in seeds {
        let mut dice = Dice::seeded(seed);
        let relation = RELATIONS[dice.below(RELATIONS.len())];
        let pair = related(relation, &mut dice);
        let mut dice = Dice::seeded(!seed);
        let drives = [&pair.0, &pair.1].map(|disc| match seed % 2 {
            0 => (Drive::Unit, 0.0),
            _ => (drive(&mut dice, disc.length()), dice.range(-5.0, 50.0)),
        });
        let checked = Checked::<S>::new(&pair, &drives).expect("the format can hold it");
        for tries in 0..100 {
            let outcome = checked.check(&mut Dice::seeded(tries), &mut Seen::default());
            assert_eq!(outcome, Ok(true), "{seed} in {}", S::NAME);
        }
    }
}

#[test]
fn an_arrival_is_not_before_its_time() {
    // The sum of the start time and the duration was rounded down.
    held_once::<f64>(&[45, 61, 111, 129, 157]);
    held_once::<f32>(&[131, 157, 165, 209, 369]);
}

#[test]
fn a_slab_ends_where_contact_only_just_does() {
    // Rounding alone decided whether there was an event at its end: the range went on beyond.
    held_once::<f32>(&[1862, 66586, 70985]);
}

/// Cases of the long command that were violations once.
fn case_holds<S: HostScalar>(seeds: &[u64]) {
    for &seed in seeds {
        let tally = run::<S>(seed, 1);
        assert_eq!(tally.violations, Vec::<String>::new(), "{seed} in {}", S::NAME);
        assert_eq!(tally.seen.pairs, 1, "{seed} in {} is refused", S::NAME);
    }
}

/// Contact all along an arc about a point: whether its middle is covered is rounding, and was seen differently from the
/// arc and from the point.
#[test]
fn an_interval_belongs_to_its_piece_although_its_middle_only_touches() {
    case_holds::<Q16>(&[76_248, 247_753]);
    case_holds::<Q12>(&[217_531, 289_883]);
}

/// Two intervals of a circle that is about to be covered, which rounding shows as one from the point.
#[test]
fn an_interval_may_be_part_of_two_pieces() {
    case_holds::<Q16>(&[41_800_936]);
}

/// Circles that all but touch from inside: a gap of two digits on one path, none on the other, and a turning point in it.
#[test]
fn a_gap_by_rounding_alone_is_none() {
    case_holds::<Q16>(&[100_327_658]);
}

/// The whole circle in the piece, two intervals at the joint: the shorter one leads on.
#[test]
fn pieces_are_joined_by_any_of_their_intervals() {
    case_holds::<Q12>(&[40_599_347, 41_182_836]);
}

/// The turning point of an interval at the start of an arc, of which rounding made one before it.
#[test]
fn an_interval_turns_back_at_an_end_of_the_segment() {
    case_holds::<Q12>(&[226_983, 20_155_155]);
}

/// Contact from inside an arc beside its centre, which the squares of distances from the circle lose.
#[test]
fn a_turning_point_beside_a_centre_is_found_from_the_centre_alone() {
    case_holds::<Q12>(&[7_044_395]);
}

#[test]
fn what_a_disc_covers_beside_a_centre_is_in_the_region() {
    held_once::<f32>(&[8895]);
}

/// A disc as large as an arc, but for a digit: contact all around, where rounding decides on ends and turning points.
#[test]
fn a_disc_that_fits_an_arc_is_followed_all_the_way() {
    case_holds::<Q16>(&[208_864, 239_816]);
    case_holds::<Q20>(&[41_639_206]);
    case_holds::<Q16>(&[60_330_273]);
    case_holds::<Q12>(&[60_521_926]);
}

/// A disc about the end of an arc in which another arc fits, and touches it from inside.
#[test]
fn a_circle_that_only_just_is_covered_is_cut_at_its_far_end() {
    case_holds::<Q12>(&[60_453_906]);
}

/// A full circle of which both ends are covered, but for a step so little that rounding shows one interval.
#[test]
fn one_interval_may_be_either_of_two() {
    case_holds::<f32>(&[100_059_337]);
}

/// A path of so many legs, the same two over and over: their rounding errors do not cancel.
fn repeated(legs: [Leg; 2], count: usize) -> Disc {
    Disc { radius: 0.25, start: [1.5, -2.5, 0.6], legs: legs.into_iter().cycle().take(count).collect() }
}

#[test]
fn a_pair_that_no_table_can_hold_is_none_that_was_checked() {
    // Round and round the same circle: each of 300 arcs meets each of 300.
    let disc = repeated([Leg::arc(1.0, 3.0); 2], 300);
    let drive = || (Drive::Unit, 0.0);
    let checked = Checked::<f64>::new(&(disc.clone(), disc), &[drive(), drive()]).expect("the format can hold it");
    let mut seen = Seen::default();
    assert_eq!(checked.check(&mut Dice::seeded(1), &mut seen), Ok(false));
    assert_eq!(seen.pairs, 0);
}

/// Largest distance of a point of the path from where it should be \[m\], and half the excess of a pair of it.
fn drift<S: HostScalar>(disc: &Disc) -> (f64, f64) {
    let disc = disc.rounded::<S>();
    let course = Course::<S>::new(&disc).expect("a path that the format can hold");
    let (motion, route) = (course.motion(), Route::new::<S>(&disc));
    let distance = |k: u32| {
        let length = motion.path().length();
        let at = S::from_f64(length.to_f64() * f64::from(k) / 4000.0).min(length);
        let (point, exact) = (motion.path().point_at(at), route.at(at.to_f64().into()));
        let [x, y] = [exact[0] - point.x.to_f64().into(), exact[1] - point.y.to_f64().into()].map(DoubleDouble::to_f64);
        x.hypot(y)
    };
    // Sums of lengths are compensated: rounded once.
    let rounded = (DoubleDouble::from(motion.path().length().to_f64()) - route.length()).abs().to_f64();
    assert!(rounded <= S::EPSILON * route.length().to_f64(), "{}: lengths are off by {rounded:e}", S::NAME);
    let slack = 0.5 * excess(&motion, &motion).to_f64();
    ((0..=4000).map(distance).fold(0.0, f64::max), slack)
}

#[test]
fn a_path_of_a_thousand_legs_is_as_exact_as_one_of_two() {
    let shapes = [
        [Leg::arc(0.7, 0.9), Leg::arc(0.5, -0.9)],
        [Leg::Line(0.3), Leg::arc(1.3, -0.02)],
        [Leg::Line(0.3), Leg::Line(0.1)],
        [Leg::arc(0.9, 1.2), Leg::Line(0.7)],
    ];
    for legs in shapes {
        let long = repeated(legs, 1000);
        for (error, slack) in [drift::<f64>(&long), drift::<f32>(&long)] {
            // Less than it may be for a single arc.
            assert!(error < 0.4 * slack, "{legs:?}: {error:e}, slack {slack:e}");
        }
        // Half a last digit an arc, which is part of the bound.
        for (error, slack) in [drift::<Q20>(&repeated(legs, 200)), drift::<Q16>(&long), drift::<Q12>(&long)] {
            assert!(error < 0.5 * slack, "{legs:?}: {error:e}, slack {slack:e}");
        }
    }
}

/// Excess of a motion from rest to rest over two lines and two arcs with another one, in units of `of`.
fn stated<S: HostScalar>(of: impl Fn(&Motion<'_, S>) -> f64) -> f64 {
    let legs = vec![Leg::Line(4.0), Leg::arc(1.0, 1.5), Leg::Line(2.0), Leg::arc(0.8, -1.0)];
    let disc = Disc { radius: 0.25, start: [1.0, 2.0, 0.3], legs };
    let course = Course::<S>::driven(&disc.rounded::<S>(), &Drive::Limits(1.0, 0.5), 3.0).expect("a motion");
    let motion = course.motion();
    excess(&motion, &motion).to_f64() / of(&motion)
}

#[test]
fn the_excess_is_as_documented() {
    // As a part of the extent: 128 roundoffs, and 16 for the way at top speed in the time of the motion, here 1.2 extents.
    let of_extent = (stated::<f64>(|m| m.extent()), stated::<f32>(|m| m.extent().to_f64()));
    assert!((146.0..148.0).contains(&(of_extent.0 / (0.5 * f64::EPSILON))), "{of_extent:?}");
    assert!((146.0..148.0).contains(&(of_extent.1 / (0.5 * f64::from(f32::EPSILON)))), "{of_extent:?}");
    assert!(of_extent.1 < 1e-5);
    // 140 of the extent.
    let of_micro = stated::<Micro>(|m| m.extent().to_f64()) / (0.5 * f64::from(f32::EPSILON));
    assert!((158.0..160.0).contains(&of_micro), "{of_micro}");
    // In last digits: 16, and 2 for the two arcs of either path.
    assert_eq!(stated::<Q20>(|_| Q20::LAST_DIGIT.to_f64()), 20.0);
    assert_eq!(stated::<Q16>(|_| Q16::LAST_DIGIT.to_f64()), 20.0);
    assert_eq!(stated::<Q12>(|_| Q12::LAST_DIGIT.to_f64()), 20.0);
}
