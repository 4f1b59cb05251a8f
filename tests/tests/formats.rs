//! The other formats against `f64`, on the reference pairs: what a smaller format may add, and that it never loses anything.
//!
//! The inputs are rounded to the format first: what that does to a scenario is no error of the algorithm. Lengths are
//! compared at 1 m/s; the motions have tests of their own (`motions.rs`).

use pcr_core::{Interval, RegionRef, excess};
use pcr_fixed::{Q12, Q16, Q20};
use pcr_planning::fleet::HostScalar;
use pcr_tests::audit::{Audit, Seen};
use pcr_tests::disc::{Disc, Leg};
use pcr_tests::oracle::plane::Effort;
use pcr_tests::reference::cases;
use std::f64::consts::TAU;

/// A region in `f32` lies within the exact region of a radius that is larger by this, as a fraction of the larger extent
/// of the two motions, where they do not wait: twice 64 roundoffs, and what the rounding of times adds.
const F32_EXCESS: f64 = 9.6e-6;

/// Samples of each region.
const SAMPLES: u32 = if cfg!(optimized) { 32 } else { 8 };

/// The pairs, in numbers of the format.
fn pairs<S: HostScalar>() -> impl Iterator<Item = (String, Disc, Disc)> {
    cases().into_iter().map(|case| {
        let [ego, other] = [0, 1].map(|k| Disc::of_agent(&case.scenario.agents[k]).rounded::<S>());
        (case.name, ego, other)
    })
}

fn extent(ego: &Disc, other: &Disc) -> f64 {
    let audit = Audit::<f64>::new(ego, other).expect("a valid pair");
    let (motions, _) = audit.table();
    motions[0].extent().max(motions[1].extent())
}

/// The pair for `f64`, where a full turn that was rounded up to `f32` is too long.
fn clipped(disc: &Disc) -> Disc {
    let clip = |leg: &Leg| leg.radius().map_or(*leg, |radius| leg.with_length(leg.length().min(TAU * radius)));
    Disc { legs: disc.legs.iter().map(clip).collect(), ..disc.clone() }
}

/// The slices of all regions at a length of the other's path.
fn slices<S: HostScalar>(regions: &[RegionRef<'_, S>], s: f64) -> Vec<[f64; 2]> {
    let interval = |interval: Interval<S>| [interval.lo.to_f64(), interval.hi.to_f64()];
    regions.iter().flat_map(|region| region.slice_at(S::from_f64(s)).map(interval)).collect()
}

/// Whether every interval of `inner` lies in one of `outer`, lengths right within `tolerance`.
fn within(inner: &[[f64; 2]], outer: &[[f64; 2]], tolerance: f64) -> bool {
    let inside = |a: &[f64; 2], b: &[f64; 2]| b[0] - tolerance <= a[0] && a[1] <= b[1] + tolerance;
    inner.iter().all(|a| outer.iter().any(|b| inside(a, b)))
}

#[test]
fn the_stated_excess_is_what_the_library_says() {
    let mut largest = 0.0_f64;
    for (_, ego, other) in pairs::<f32>() {
        let audit = Audit::<f32>::new(&ego, &other).expect("a valid pair");
        let (motions, _) = audit.table();
        let stated = excess(&motions[0], &motions[1]) / motions[0].extent().max(motions[1].extent());
        largest = largest.max(stated.to_f64());
    }
    assert!(largest <= F32_EXCESS && 0.8 * F32_EXCESS < largest, "{largest:e}");
}

#[test]
fn f32_contains_the_f64_regions_and_is_within_those_of_a_larger_radius() {
    // Joints lie where the format sums them up to, which may be a roundoff of the length away.
    assert_eq!(contains_and_is_within::<f32>(|extent| (F32_EXCESS * extent, f64::from(f32::EPSILON) * extent)), 0);
}

#[test]
fn fixed_point_contains_the_f64_regions_and_is_within_those_of_a_larger_radius() {
    fn refused<S: HostScalar>(digit: f64) -> usize {
        // Ends of slices are numbers of the format: within half a digit of where they are.
        contains_and_is_within::<S>(|_| (0.0, digit))
    }
    let pairs = cases().len();
    assert!(refused::<Q20>(Q20::LAST_DIGIT.to_f64()) < pairs / 2);
    assert!(refused::<Q16>(Q16::LAST_DIGIT.to_f64()) < pairs / 4);
    assert!(refused::<Q12>(Q12::LAST_DIGIT.to_f64()) < pairs / 4);
}

/// Compares slices with those of `f64`, for the radius and for one that is larger by an excess, that of the library at least,
/// with a tolerance of lengths, both by the extent. How many pairs the format cannot hold.
fn contains_and_is_within<S: HostScalar>(allowed: impl Fn(f64) -> (f64, f64)) -> usize {
    let mut refused = 0;
    // A debug run takes some of them.
    for (name, ego, other) in pairs::<S>().step_by(if cfg!(optimized) { 1 } else { 5 }) {
        let Ok(small) = Audit::<S>::new(&ego, &other) else {
            refused += 1;
            continue;
        };
        let (ego, other) = (clipped(&ego), clipped(&other));
        let (larger, tolerance) = allowed(extent(&ego, &other));
        let (motions, _) = small.table();
        let larger = larger.max(excess(&motions[0], &motions[1]).to_f64());
        let exact = Audit::<f64>::new(&ego, &other).expect("a valid pair");
        let grown = Audit::<f64>::new(&ego.grown(larger), &other).expect("a valid pair");
        let (tables, exact_tables, grown_tables) = (small.table(), exact.table(), grown.table());
        let regions: Vec<_> = tables.1.pair(&tables.0, 0, 1).expect("the table of the fleet").collect();
        let exact_regions: Vec<_> =
            exact_tables.1.pair(&exact_tables.0, 0, 1).expect("the table of the fleet").collect();
        let grown_regions: Vec<_> =
            grown_tables.1.pair(&grown_tables.0, 0, 1).expect("the table of the fleet").collect();
        for region in &exact_regions {
            let range = region.other_length();
            for k in 0..=SAMPLES {
                // A number of both formats, inside the range.
                let s = S::from_f64(range.lo + range.length() * f64::from(k) / f64::from(SAMPLES));
                let s = s.min(tables.0[1].path().length()).to_f64();
                let (inner, middle, outer) =
                    (slices(&exact_regions, s), slices(&regions, s), slices(&grown_regions, s));
                assert!(within(&inner, &middle, tolerance), "{name} at {s}: {inner:?} not in {middle:?}");
                assert!(within(&middle, &outer, tolerance), "{name} at {s}: {middle:?} not in {outer:?}");
            }
        }
        // Between two radii with as many regions there is no change of structure.
        if exact_regions.len() == grown_regions.len() {
            assert_eq!(regions.len(), exact_regions.len(), "{name}");
        }
    }
    refused
}

#[test]
fn f32_regions_are_audited_on_the_reference_pairs() {
    const EFFORT: Effort = Effort { resolution: 2e-2, boxes: 3_000, range: 1e-4 };
    let mut seen = Seen::default();
    for (name, ego, other) in pairs::<f32>() {
        let audit = Audit::<f32>::new(&ego, &other).expect("a valid pair");
        if let Err(violation) = audit.all(EFFORT, 12, &mut seen) {
            panic!("{name}: {violation}");
        }
    }
    assert!(seen.regions > 300 && seen.certain > 150, "{seen:?}");
}
