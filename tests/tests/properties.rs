//! Properties of the regions of any pair, in `f64` and `f32`, on pairs that aim at degenerate positions.
//!
//! The audit is against the definition (`pcr_tests::oracle`); all pairs are the same in every run. Far more are tried
//! by `cargo run --release -p pcr-tests --example campaign`.

use pcr_core::{Motion, RegionRef};
use pcr_planning::fleet::HostScalar;
use pcr_tests::audit::{Audit, Seen, Violation};
use pcr_tests::disc::Disc;
use pcr_tests::generators::{Dice, moved, pairs, reversed, split};
use pcr_tests::oracle::plane::Effort;
use pcr_tests::settings::settings;
use proptest::prelude::*;

/// Samples along each side of the rectangle of lengths.
const SAMPLES: usize = if cfg!(optimized) { 24 } else { 12 };

/// What the oracle may spend on the components of a pair.
const EFFORT: Effort = Effort { resolution: 2e-2, boxes: if cfg!(optimized) { 20_000 } else { 4_000 }, range: 1e-5 };

/// What it may spend on finding out whether the number of components is critical.
const GLANCE: Effort = Effort { resolution: 3e-2, boxes: 3_000, range: f64::INFINITY };

fn audit<S: HostScalar>((ego, other): &(Disc, Disc)) -> Option<Audit<S>> {
    let (ego, other) = (ego.rounded::<S>(), other.rounded::<S>());
    // Diameters of 2e7 m are above the limit of `f32`.
    let limit = S::LIMIT.to_f64();
    let fits = |disc: &Disc| disc.legs.iter().all(|leg| leg.radius().is_none_or(|radius| 2.0 * radius <= limit));
    (fits(&ego) && fits(&other)).then(|| Audit::new(&ego, &other).expect("a valid pair"))
}

fn hold(outcome: Result<(), Violation>) -> Result<(), TestCaseError> {
    outcome.map_err(TestCaseError::fail)
}

/// Every property of a single pair, in a format.
macro_rules! audited {
    ($module:ident, $format:ident) => {
        mod $module {
            use super::*;

            proptest! {
                #![proptest_config(settings(2000, 10, 38))]

                #[test]
                fn p1_ends_of_slices_are_contacts_and_slices_lie_in_the_ranges(pair in pairs()) {
                    hold(audit::<$format>(&pair).map_or(Ok(()), |audit| audit.contours(SAMPLES, &mut Seen::default())))?;
                }

                #[test]
                fn p2_no_collision_is_outside_and_nothing_is_invented(pair in pairs()) {
                    hold(audit::<$format>(&pair).map_or(Ok(()), |audit| audit.coverage(SAMPLES)))?;
                }

                #[test]
                fn p3_swapping_ego_and_other_transposes(pair in pairs()) {
                    hold(audit::<$format>(&pair).map_or(Ok(()), |audit| audit.transpose()))?;
                }

            }

            proptest! {
                #![proptest_config(settings(800, 10, 38))]

                #[test]
                fn p2_what_is_covered_at_a_time_is_in_one_slice(pair in pairs()) {
                    hold(audit::<$format>(&pair).map_or(Ok(()), |audit| audit.sections(SAMPLES)))?;
                }

                #[test]
                fn p4_ranges_are_reached(pair in pairs()) {
                    hold(audit::<$format>(&pair).map_or(Ok(()), |audit| audit.ranges()))?;
                }

                #[test]
                fn p5_larger_radius_larger_regions(pair in pairs(), by in 0.0..0.3_f64) {
                    grows::<$format>(&pair, by)?;
                }

                #[test]
                fn p6_rigid_motions_change_nothing(pair in pairs(), x in -9.0..9.0_f64, y in -9.0..9.0_f64, turn in -3.2..3.2_f64) {
                    let image = (moved(&pair.0, [x, y, turn]), moved(&pair.1, [x, y, turn]));
                    same_regions::<$format>(&pair, &image, |s, l| (s, l))?;
                }

                #[test]
                fn p7_driving_the_other_way_mirrors_lengths(pair in pairs()) {
                    let (ego, other) = (pair.0.length(), pair.1.length());
                    same_regions::<$format>(&pair, &(reversed(&pair.0), pair.1.clone()), |s, l| (s, ego - l))?;
                    same_regions::<$format>(&pair, &(pair.0.clone(), reversed(&pair.1)), |s, l| (other - s, l))?;
                }

                #[test]
                fn p8_cutting_segments_changes_nothing(pair in pairs(), seed in any::<u64>()) {
                    let (mut cut, mut dice) = (pair.clone(), Dice::seeded(seed));
                    split(&mut cut.0, &mut dice);
                    split(&mut cut.1, &mut dice);
                    same_regions::<$format>(&pair, &cut, |s, l| (s, l))?;
                }
            }
        }
    };
}

audited!(in_f64, f64);
audited!(in_f32, f32);

proptest! {
    #![proptest_config(settings(150, 5, 38))]

    #[test]
    fn p9_regions_are_the_connected_components_f64(pair in pairs()) {
        hold(audit::<f64>(&pair).map_or(Ok(()), |audit| audit.components(EFFORT, &mut Seen::default())))?;
    }

    #[test]
    fn p9_regions_are_the_connected_components_f32(pair in pairs()) {
        hold(audit::<f32>(&pair).map_or(Ok(()), |audit| audit.components(EFFORT, &mut Seen::default())))?;
    }
}

/// The number of the region at a point, from 1; 0 outside all of them.
fn label<S: HostScalar>(motions: &[Motion<'_, S>; 2], regions: &[RegionRef<'_, S>], s: f64, l: f64) -> usize {
    // Mapped lengths may be a rounding beyond the end.
    let on_path = |length: f64, agent: usize| S::from_f64(length).clamp(S::ZERO, motions[agent].path().length());
    let (s, l) = (on_path(s, 1), on_path(l, 0));
    regions.iter().position(|region| region.contains(s, l)).map_or(0, |index| index + 1)
}

/// Growing the combined radius by more than the bounds of both keeps every region inside one region.
fn grows<S: HostScalar>(pair: &(Disc, Disc), by: f64) -> Result<(), TestCaseError> {
    let large = (pair.0.grown(by), pair.1.clone());
    let (Some(small), Some(large)) = (audit::<S>(pair), audit::<S>(&large)) else {
        return Ok(());
    };
    if by < MAPPED * (small.bound() + large.bound()) {
        return Ok(());
    }
    let ((motions, ecm), (large_motions, large_ecm)) = (small.table(), large.table());
    let regions: Vec<_> = ecm.pair(&motions, 0, 1).expect("the table of the fleet").collect();
    let large_regions: Vec<_> = large_ecm.pair(&large_motions, 0, 1).expect("the table of the fleet").collect();
    let mut holder = vec![0; regions.len()];
    for (s, l) in small.sampled(SAMPLES) {
        let (s, l) = (s.to_f64(), l.to_f64());
        let (inside, around) = (label(&motions, &regions, s, l), label(&large_motions, &large_regions, s, l));
        if inside > 0 {
            prop_assert!(around > 0, "({}, {}) is lost", s, l);
            let holder = &mut holder[inside - 1];
            prop_assert!(*holder == 0 || *holder == around, "a region is torn");
            *holder = around;
        }
    }
    Ok(())
}

/// Both pairs have the same regions, points of the first one mapped by `map`. Points about in contact are left out, and
/// where the number of components is critical only what is covered is compared.
fn same_regions<S: HostScalar>(
    pair: &(Disc, Disc),
    image: &(Disc, Disc),
    map: impl Fn(f64, f64) -> (f64, f64),
) -> Result<(), TestCaseError> {
    let (Some(a), Some(b)) = (audit::<S>(pair), audit::<S>(image)) else {
        return Ok(());
    };
    let margin = MAPPED * (a.bound() + b.bound());
    let ((motions, ecm), (image_motions, image_ecm)) = (a.table(), b.table());
    let regions: Vec<_> = ecm.pair(&motions, 0, 1).expect("the table of the fleet").collect();
    let image_regions: Vec<_> = image_ecm.pair(&image_motions, 0, 1).expect("the table of the fleet").collect();
    let certain = a.known(GLANCE, margin).certain() && b.known(GLANCE, margin).certain();
    let mut partners: Vec<(usize, usize)> = Vec::new();
    for (s, l) in a.sampled(SAMPLES) {
        if a.clearance(s, l).abs() <= margin {
            continue;
        }
        let (s, l) = (s.to_f64(), l.to_f64());
        let (t, m) = map(s, l);
        let partner = (label(&motions, &regions, s, l), label(&image_motions, &image_regions, t, m));
        prop_assert_eq!(partner.0 == 0, partner.1 == 0, "({}, {}) is covered once only", s, l);
        if certain && !partners.contains(&partner) {
            prop_assert!(
                partners.iter().all(|p| p.0 != partner.0 && p.1 != partner.1),
                "({}, {}) changes its region",
                s,
                l
            );
            partners.push(partner);
        }
    }
    Ok(())
}

/// Mapping a pair rounds its coordinates, headings and lengths once more: by so many bounds of the two pairs a position
/// may be off.
const MAPPED: f64 = 4.0;
