//! Passing orders as C asks for them, in all number formats: the same crossing with the same numbers.

use pcr_ffi::*;
use std::ptr::{null, null_mut};

/// The tests of a number format: its module and numbers; a quarter of a turn; its largest number; how a number becomes one of it, and back.
macro_rules! formats {
    ($($format:ident: $real:ty, $heading:expr, $most:expr, |$v:ident| $to:expr, |$r:ident| $from:expr;)*) => {
        $(mod $format {
            use super::*;
            use pcr_ffi::$format::*;

            fn real($v: f64) -> $real {
                $to
            }

            fn value($r: $real) -> f64 {
                $from
            }

            fn slots<T: Copy>(empty: T, count: usize) -> *mut T {
                Box::leak(vec![empty; count].into_boxed_slice()).as_mut_ptr()
            }

            fn memory(agents: usize, orders: usize) -> PcrMemory {
                PcrMemory {
                    segments: slots(PcrSegmentStorage::EMPTY, 2 * agents),
                    segment_count: 2 * agents,
                    phases: slots(PcrPhaseStorage::EMPTY, 4 * agents),
                    phase_count: 4 * agents,
                    motions: slots(PcrMotionStorage::EMPTY, agents),
                    motion_count: agents,
                    entries: slots(PcrRegionStorage::EMPTY, 8),
                    entry_count: 8,
                    pieces: slots(PcrPieceStorage::EMPTY, 8),
                    piece_count: 8,
                    orders: if orders == 0 { null_mut() } else { slots(PcrPrecedenceStorage::EMPTY, orders) },
                    order_count: orders,
                    robots: if orders == 0 { null_mut() } else { slots(PcrCheckStorage::EMPTY, agents) },
                    corners: null_mut(),
                    corner_count: 0,
                }
            }

            /// 4 m east, or north, through the origin; `at` moves it along its own left.
            fn agent(north: bool, start: f64, at: f64) -> PcrAgent {
                let legs: &'static [PcrPathSegment] =
                    Box::leak(Box::new([PcrPathSegment { curve: PCR_LINE, length: real(4.0), radius: real(0.0) }]));
                let (x, y) = if north { (-at, -2.0) } else { (-2.0, at) };
                PcrAgent {
                    x: real(x),
                    y: real(y),
                    heading: if north { $heading } else { Default::default() },
                    radius: real(0.25),
                    start: real(start),
                    legs: legs.as_ptr(),
                    leg_count: 1,
                    speed: real(1.0),
                    acceleration: real(1.0),
                    stretches: null(),
                    stretch_count: 0,
                    corners: null(),
                    corner_count: 0,
                    facing: Default::default(),
                }
            }

            fn fleet(orders: usize, agents: &[PcrAgent]) -> PcrFleet {
                let mut fleet = PcrFleet::EMPTY;
                assert_eq!(pcr_fleet_init(Some(&mut fleet), Some(&memory(4, orders))), PcrStatus::Ok);
                for agent in agents {
                    assert_eq!(pcr_fleet_add(Some(&mut fleet), Some(agent)), PcrStatus::Ok);
                }
                assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::Ok);
                fleet
            }

            fn hold(fleet: &PcrFleet, agent: usize) -> (PcrAuthorityKind, f64) {
                let mut hold = PcrMovementAuthority::default();
                assert_eq!(pcr_fleet_hold(Some(fleet), agent, Some(&mut hold)), PcrStatus::Ok);
                (hold.kind, value(hold.length))
            }

            fn passes(fleet: &PcrFleet, agent: usize) -> Vec<(u16, u8)> {
                let (mut out, mut count) = ([PcrRegionPrecedence::default(); 8], 0);
                let asked = pcr_fleet_passings(Some(fleet), agent, out.as_mut_ptr(), out.len(), Some(&mut count));
                assert_eq!(asked, PcrStatus::Ok);
                out[..count].iter().map(|passing| (passing.other, passing.pass)).collect()
            }

            fn report(fleet: &mut PcrFleet, agent: usize, at: f64) -> PcrStatus {
                let at = PcrInterval { lo: real(at), hi: real(at) };
                pcr_fleet_report(Some(fleet), agent, Some(&PcrProgress { at, stop: at.hi }))
            }

            fn near(hold: (PcrAuthorityKind, f64), length: f64) -> bool {
                hold.0 == PcrAuthorityKind::At && hold.1 <= length && hold.1 > length - 1e-3
            }

            fn tolerances() -> PcrCheckTolerances {
                PcrCheckTolerances { width: real(0.01), gain: real(0.01) }
            }

            /// What comes of a mission of agent 1.
            fn admit(
                fleet: &mut PcrFleet,
                by: &PcrAgent,
                prefer: Option<&[u8; 3]>,
                why: &mut PcrAdmissionError,
            ) -> (PcrStatus, Vec<(u16, u8)>, (PcrAuthorityKind, f64)) {
                let prefer = prefer.map_or(null(), |prefer| prefer.as_ptr());
                let (start, tolerances) = (PcrProgress::default(), tolerances());
                let status =
                    pcr_fleet_admit(Some(fleet), 1, Some(by), Some(&start), Some(&tolerances), prefer, Some(why));
                (status, passes(fleet, 1), hold(fleet, 1))
            }

            const WHY: PcrAdmissionError = PcrAdmissionError { reason: PcrAdmissionErrorKind::Late, agents: [7; 2] };

            /// What replaces an agent may have the path of the one before: its table belongs to it, its orders do not.
            #[test]
            fn orders_do_not_outlive_an_agent_although_the_next_one_has_the_same_path() {
                let (east, north, far) = (agent(false, 0.0, 0.0), agent(true, 0.0, 0.0), agent(true, 0.0, 40.0));
                let through = |fleet: &mut PcrFleet| {
                    assert_eq!(pcr_fleet_decide(Some(fleet), 1, 0, PCR_SECOND), PcrStatus::Ok);
                    assert_eq!(report(fleet, 0, 2.6), PcrStatus::Ok);
                    assert_eq!(pcr_fleet_passed(Some(fleet)), PcrStatus::Ok);
                    assert_eq!(hold(fleet, 1), (PcrAuthorityKind::Free, 4.0));
                };
                let not_built = |fleet: &PcrFleet| {
                    let held = pcr_fleet_hold(Some(fleet), 1, Some(&mut PcrMovementAuthority::default()));
                    assert_eq!(held, PcrStatus::NotBuilt);
                };
                // A row, and the other agent begins anew.
                let mut row = fleet(4, &[east, north]);
                assert_eq!(pcr_fleet_build_row(Some(&mut row), 1), PcrStatus::Ok);
                through(&mut row);
                assert_eq!(pcr_fleet_replace(Some(&mut row), 0, Some(&east)), PcrStatus::Ok);
                not_built(&row);
                // A row, and its own agent begins anew, behind the region when it was decided.
                assert_eq!(pcr_fleet_build_row(Some(&mut row), 1), PcrStatus::Ok);
                assert_eq!(report(&mut row, 1, 2.6), PcrStatus::Ok);
                assert_eq!(pcr_fleet_decide(Some(&mut row), 1, 0, PCR_SECOND), PcrStatus::Ok);
                assert_eq!(pcr_fleet_replace(Some(&mut row), 1, Some(&north)), PcrStatus::Ok);
                not_built(&row);
                // A row, and an agent is removed and added again.
                assert_eq!(pcr_fleet_build_row(Some(&mut row), 1), PcrStatus::Ok);
                through(&mut row);
                assert_eq!(pcr_fleet_remove(Some(&mut row), 0), PcrStatus::Ok);
                assert_eq!(pcr_fleet_add(Some(&mut row), Some(&east)), PcrStatus::Ok);
                not_built(&row);
                // A whole table, of a fleet with an agent more for a while.
                let mut whole = fleet(4, &[east, north]);
                through(&mut whole);
                assert_eq!(pcr_fleet_add(Some(&mut whole), Some(&far)), PcrStatus::Ok);
                assert_eq!(pcr_fleet_replace(Some(&mut whole), 0, Some(&east)), PcrStatus::Ok);
                assert_eq!(pcr_fleet_remove(Some(&mut whole), 2), PcrStatus::Ok);
                not_built(&whole);
                // Replaced in a table that is built, it is undecided.
                let mut whole = fleet(4, &[east, north]);
                through(&mut whole);
                assert_eq!(pcr_fleet_replace(Some(&mut whole), 0, Some(&east)), PcrStatus::Ok);
                assert_eq!(passes(&whole, 1), [(0, PCR_UNDECIDED)]);
                assert!(near(hold(&whole, 1), 1.5));
            }

            #[test]
            fn reports_beyond_the_path_are_refused_and_give_way_to_nobody() {
                let (east, north) = (agent(false, 0.0, 0.0), agent(true, 0.0, 0.0));
                let mut fleet = fleet(4, &[east, north]);
                assert_eq!(pcr_fleet_decide(Some(&mut fleet), 1, 0, PCR_SECOND), PcrStatus::Ok);
                for beyond in [4.1, 260.0] {
                    assert_eq!(report(&mut fleet, 0, beyond), PcrStatus::OutOfRange);
                    assert!(near(hold(&fleet, 1), 1.5));
                    let lengths = PcrInterval { lo: real(beyond), hi: real(beyond) };
                    let (place, mut why) = (PcrProgress { at: lengths, stop: lengths.hi }, WHY);
                    let (fleet, tolerances) = (Some(&mut fleet), tolerances());
                    let status =
                        pcr_fleet_admit(fleet, 0, Some(&east), Some(&place), Some(&tolerances), null(), Some(&mut why));
                    assert_eq!((status, why), (PcrStatus::OutOfRange, WHY));
                }
                assert_eq!(report(&mut fleet, 0, 4.0), PcrStatus::Ok);
                assert_eq!(hold(&fleet, 1), (PcrAuthorityKind::Free, 4.0));
            }

            #[test]
            fn memory_without_a_part_of_it_is_refused_before_a_fleet_loses_any() {
                let given = memory(4, 4);
                let mut fleet = PcrFleet::EMPTY;
                assert_eq!(pcr_fleet_init(Some(&mut fleet), Some(&given)), PcrStatus::Ok);
                for agent in [agent(false, 0.0, 0.0), agent(true, 0.0, 0.0)] {
                    assert_eq!(pcr_fleet_add(Some(&mut fleet), Some(&agent)), PcrStatus::Ok);
                }
                assert_eq!(pcr_fleet_build(Some(&mut fleet)), PcrStatus::Ok);
                let before = passes(&fleet, 1);
                let without = [
                    PcrMemory { robots: null_mut(), ..given },
                    PcrMemory { orders: null_mut(), ..given },
                    PcrMemory { pieces: null_mut(), ..given },
                ];
                for without in &without {
                    assert_eq!(pcr_fleet_init(Some(&mut fleet), Some(without)), PcrStatus::Null);
                    assert_eq!(passes(&fleet, 1), before);
                }
            }

            #[test]
            fn a_stopping_distance_beyond_the_format_is_no_answer() {
                let way = |deceleration: f64, reaction: f64, speed: f64| {
                    let brakes = PcrBrakingModel { deceleration: real(deceleration), reaction: real(reaction) };
                    let mut way = real(7.0);
                    (pcr_stopping_way(Some(&brakes), real(speed), Some(&mut way)), value(way))
                };
                let (status, far) = way(0.5, 0.0, 1.0);
                assert!(status == PcrStatus::Ok && (1.0..1.001).contains(&far), "{far}");
                assert_eq!(way(0.5, 0.0, -1.0), (PcrStatus::Negative, 7.0));
                let most: f64 = $most;
                // So much from a speed with a long reaction, and with brakes that hardly brake.
                assert_eq!(way(1.0, most.sqrt(), 2.0 * most.sqrt()), (PcrStatus::OutOfRange, 7.0));
                assert_eq!(way(0.01, 0.0, most.sqrt()), (PcrStatus::OutOfRange, 7.0));
            }

            #[test]
            fn a_plan_becomes_orders_and_the_second_waits_until_the_first_is_through() {
                let mut fleet = fleet(4, &[agent(false, 0.0, 0.0), agent(true, 3.0, 0.0)]);
                assert!(near(hold(&fleet, 0), 1.5) && near(hold(&fleet, 1), 1.5), "nothing is decided");
                let mut why = WHY;
                assert_eq!(pcr_fleet_orders_as_planned(Some(&mut fleet), Some(&mut why)), PcrStatus::Ok);
                assert_eq!((passes(&fleet, 0), passes(&fleet, 1)), (vec![(1, PCR_FIRST)], vec![(0, PCR_SECOND)]));
                assert_eq!(hold(&fleet, 0), (PcrAuthorityKind::Free, 4.0));
                assert!(near(hold(&fleet, 1), 1.5));
                assert_eq!(pcr_fleet_check(Some(&mut fleet), Some(&tolerances()), Some(&mut why)), PcrStatus::Ok);
                // Late reports change nothing.
                assert_eq!((report(&mut fleet, 0, 2.75), report(&mut fleet, 0, 1.0)), (PcrStatus::Ok, PcrStatus::Ok));
                assert_eq!(hold(&fleet, 1), (PcrAuthorityKind::Free, 4.0));
                assert_eq!(pcr_fleet_passed(Some(&mut fleet)), PcrStatus::Ok);
                assert_eq!(passes(&fleet, 1), [(0, PCR_OVER)]);
                assert_eq!(why, WHY);
            }

            #[test]
            fn who_meets_is_refused_by_name_and_a_decision_helps() {
                let mut fleet = fleet(4, &[agent(false, 0.0, 0.0), agent(true, 0.0, 0.0)]);
                let mut why = WHY;
                assert_eq!(pcr_fleet_orders_as_planned(Some(&mut fleet), Some(&mut why)), PcrStatus::Refused);
                assert_eq!(why, PcrAdmissionError { reason: PcrAdmissionErrorKind::Meeting, agents: [0, 1] });
                assert_eq!(pcr_fleet_check(Some(&mut fleet), Some(&tolerances()), Some(&mut why)), PcrStatus::Refused);
                assert_eq!(why.reason, PcrAdmissionErrorKind::Stuck);
                assert_eq!(pcr_fleet_decide(Some(&mut fleet), 1, 0, 9), PcrStatus::NoSuchPass);
                assert_eq!(pcr_fleet_decide(Some(&mut fleet), 1, 5, PCR_FIRST), PcrStatus::NoSuchAgent);
                assert_eq!(pcr_fleet_decide(Some(&mut fleet), 1, 0, PCR_FIRST), PcrStatus::Ok);
                assert_eq!(passes(&fleet, 0), [(1, PCR_SECOND)]);
                assert_eq!(pcr_fleet_decide_at(Some(&mut fleet), 1, 0, PCR_FIRST), PcrStatus::NoSuchRegion);
                assert_eq!(pcr_fleet_decide_at(Some(&mut fleet), 0, 0, PCR_FIRST), PcrStatus::Ok);
                assert_eq!(passes(&fleet, 0), [(1, PCR_FIRST)]);
                let bad = PcrCheckTolerances { gain: real(0.0), ..tolerances() };
                assert_eq!(pcr_fleet_check(Some(&mut fleet), Some(&bad), None), PcrStatus::NonPositive);
                assert_eq!(pcr_fleet_check(Some(&mut fleet), Some(&tolerances()), None), PcrStatus::Ok);
            }

            #[test]
            fn a_mission_is_admitted_with_orders_or_nothing_changes() {
                let aside = |at| PcrAgent { legs: null(), leg_count: 0, ..agent(true, 0.0, at) };
                let mut fleet = fleet(6, &[agent(false, 0.0, 0.0), aside(3.0), agent(true, 0.0, 1.0)]);
                let mut why = WHY;
                assert_eq!(admit(&mut fleet, &agent(true, 0.0, 0.0), Some(&[9; 3]), &mut why).0, PcrStatus::NoSuchPass);
                let second = admit(&mut fleet, &agent(true, 0.0, 0.0), None, &mut why);
                // The third runs beside it, out of reach. Nothing is decided about that one and the first, which both wait for
                // ever anyway: it goes first, whatever is preferred.
                assert_eq!((second.0, second.1), (PcrStatus::Ok, vec![(0, PCR_FIRST)]), "0 and 2 are undecided");
                assert_eq!(pcr_fleet_check(Some(&mut fleet), Some(&tolerances()), Some(&mut why)), PcrStatus::Refused);
                assert_eq!(why.reason, PcrAdmissionErrorKind::Stuck);
                assert_eq!(pcr_fleet_decide(Some(&mut fleet), 0, 2, PCR_FIRST), PcrStatus::Ok);
                let second = admit(&mut fleet, &agent(true, 0.0, 0.0), None, &mut why);
                assert_eq!((second.0, second.1), (PcrStatus::Ok, vec![(0, PCR_SECOND)]));
                assert!(near(second.2, 1.5));
                let first = admit(&mut fleet, &agent(true, 0.0, 0.0), Some(&[PCR_FIRST; 3]), &mut why);
                assert_eq!((first.0, first.1), (PcrStatus::Ok, vec![(0, PCR_FIRST)]));
                // One that would stand on the other's path for good.
                let stands = PcrAgent { x: real(0.0), y: real(0.0), legs: null(), leg_count: 0, ..agent(true, 0.0, 0.0) };
                let before = (passes(&fleet, 1), hold(&fleet, 1));
                let refused = admit(&mut fleet, &stands, None, &mut why);
                assert_eq!((refused.0, (refused.1, refused.2)), (PcrStatus::Refused, before));
                assert_eq!(why, PcrAdmissionError { reason: PcrAdmissionErrorKind::Blocked, agents: [1, 0] });
            }

            #[test]
            fn who_leaves_moves_the_others_up_and_the_table_goes_on() {
                let mut fleet = fleet(6, &[agent(false, 0.0, 0.5), agent(false, 0.0, 0.0), agent(true, 0.0, 0.0)]);
                assert_eq!(pcr_fleet_decide(Some(&mut fleet), 2, 1, PCR_SECOND), PcrStatus::Ok);
                assert_eq!(report(&mut fleet, 1, 2.75), PcrStatus::Ok);
                assert_eq!(pcr_fleet_remove(Some(&mut fleet), 3), PcrStatus::NoSuchAgent);
                assert_eq!(pcr_fleet_remove(Some(&mut fleet), 0), PcrStatus::Ok);
                assert_eq!(pcr_fleet_agents(Some(&fleet)), 2);
                assert_eq!(passes(&fleet, 1), [(0, PCR_SECOND)]);
                assert_eq!(hold(&fleet, 1), (PcrAuthorityKind::Free, 4.0), "what was reported moves up, too");
                // What is free again is enough for another one.
                assert_eq!(pcr_fleet_add(Some(&mut fleet), Some(&agent(false, 0.0, -1.0))), PcrStatus::Ok);
                assert_eq!(pcr_fleet_add(Some(&mut fleet), Some(&agent(false, 0.0, 1.0))), PcrStatus::Ok);
                let mut count = 0;
                let asked = pcr_fleet_regions(Some(&fleet), 0, null_mut(), 0, Some(&mut count));
                assert_eq!(asked, PcrStatus::NotBuilt);
                assert_eq!(pcr_fleet_remove(Some(&mut fleet), 3), PcrStatus::Ok);
                assert_eq!(pcr_fleet_remove(Some(&mut fleet), 2), PcrStatus::Ok);
                let mut held = PcrMovementAuthority::default();
                assert_eq!(pcr_fleet_hold(Some(&fleet), 1, Some(&mut held)), PcrStatus::NotBuilt, "nor is it then");
            }

            #[test]
            fn a_row_is_for_one_and_without_memory_there_are_no_orders() {
                let agents = [agent(false, 0.0, 0.0), agent(true, 0.0, 0.0), agent(false, 0.0, 1.0)];
                let mut fleet = self::fleet(4, &agents);
                assert_eq!(pcr_fleet_build_row(Some(&mut fleet), 3), PcrStatus::NoSuchAgent);
                assert_eq!(pcr_fleet_build_row(Some(&mut fleet), 1), PcrStatus::Ok);
                assert_eq!(pcr_fleet_decide(Some(&mut fleet), 1, 0, PCR_SECOND), PcrStatus::Ok);
                assert!(near(hold(&fleet, 1), 1.5));
                let mut other = PcrMovementAuthority::default();
                assert_eq!(pcr_fleet_hold(Some(&fleet), 0, Some(&mut other)), PcrStatus::OnlyRow);
                assert_eq!(pcr_fleet_hold(Some(&fleet), 1, None), PcrStatus::Null);
                let mut replaced = self::fleet(4, &agents);
                assert_eq!(pcr_fleet_build_row(Some(&mut replaced), 1), PcrStatus::Ok);
                assert_eq!(pcr_fleet_replace(Some(&mut replaced), 1, Some(&agents[0])), PcrStatus::Ok);
                assert_eq!(pcr_fleet_hold(Some(&replaced), 1, Some(&mut other)), PcrStatus::NotBuilt);
                let mut none = self::fleet(0, &agents);
                assert_eq!(pcr_fleet_hold(Some(&none), 1, Some(&mut other)), PcrStatus::NoOrders);
                assert_eq!(report(&mut none, 1, 1.0), PcrStatus::NoOrders);
                assert_eq!(pcr_fleet_check(Some(&mut none), Some(&tolerances()), None), PcrStatus::NoOrders);
                let backward = PcrProgress { at: PcrInterval { lo: real(2.0), hi: real(1.0) }, stop: real(3.0) };
                assert_eq!(pcr_fleet_report(Some(&mut fleet), 1, Some(&backward)), PcrStatus::OutOfRange);
                let behind = PcrProgress { at: PcrInterval { lo: real(1.0), hi: real(2.0) }, stop: real(1.5) };
                assert_eq!(pcr_fleet_report(Some(&mut fleet), 1, Some(&behind)), PcrStatus::OutOfRange);
                assert_eq!(report(&mut fleet, 1, -1.0), PcrStatus::Negative);
                assert_eq!(report(&mut fleet, 3, 1.0), PcrStatus::NoSuchAgent);
            }

            #[test]
            fn stopping_ways_are_those_of_the_hand_calculation() {
                let brakes = PcrBrakingModel { deceleration: real(0.5), reaction: real(0.5) };
                let mut found = real(0.0);
                assert_eq!(pcr_stopping_way(Some(&brakes), real(1.0), Some(&mut found)), PcrStatus::Ok);
                assert!((value(found) - 1.5).abs() < 1e-3);
                assert_eq!(pcr_stopping_speed(Some(&brakes), real(1.5), Some(&mut found)), PcrStatus::Ok);
                assert!((value(found) - 1.0).abs() < 1e-3);
                let none = PcrBrakingModel { deceleration: real(0.0), ..brakes };
                assert_eq!(pcr_stopping_way(Some(&none), real(1.0), Some(&mut found)), PcrStatus::NonPositive);
                assert_eq!(pcr_stopping_way(None, real(1.0), Some(&mut found)), PcrStatus::Null);
            }
        })*
    };
}

formats! {
    single: f32, std::f32::consts::FRAC_PI_2, 1e6, |v| v as f32, |r| f64::from(r);
    double: f64, std::f64::consts::FRAC_PI_2, 1e12, |v| v, |r| r;
    fixed: i32, 1 << 30, 4096.0, |v| (v * 65536.0).round() as i32, |r| f64::from(r) / 65536.0;
}
