//! What the module refuses, and that an answer of no rows means that there is nothing.

use pcr_web::agents::Input;
use pcr_web::fleet::{Fleet, Memory, Rows};
use pcr_web::limits::{AGENTS, LEGS, STRIDE};
use pcr_web::message::Fault;

/// Two that cross, 4 m before them.
fn crossing() -> Box<Input> {
    let mut input = Box::new([0.0; AGENTS * STRIDE]);
    input[..10].copy_from_slice(&[-4.0, 0.0, 0.0, 0.4, 0.0, 1.0, 0.5, 1.0, 8.0, 0.0]);
    let turned = [0.0, -4.0, std::f64::consts::FRAC_PI_2, 0.4, 0.0, 1.0, 0.5, 1.0, 8.0, 0.0];
    input[STRIDE..STRIDE + 10].copy_from_slice(&turned);
    input
}

fn fleet() -> Fleet<'static> {
    // As large as the tables of the module: on a stack of its own there is no room for it.
    std::thread::Builder::new()
        .stack_size(16 << 20)
        .spawn(|| Box::leak(Box::new(Memory::NEW)))
        .and_then(|thread| thread.join().map_err(|_| std::io::Error::other("no memory")))
        .map(Fleet::new)
        .expect("memory for a test")
}

fn asked(ask: impl FnOnce(&mut Fleet<'static>, &mut Rows) + Send + 'static) {
    let run = move || ask(&mut fleet(), &mut Box::new(Rows::EMPTY));
    std::thread::Builder::new().stack_size(32 << 20).spawn(run).expect("a thread").join().expect("no panic");
}

#[test]
fn a_crossing_has_a_region_a_conflict_and_a_plan() {
    asked(|fleet, rows| {
        assert_eq!(fleet.build(&crossing(), 2), Ok(1));
        assert_eq!(fleet.regions(rows), Ok(2));
        assert_eq!(fleet.conflicts(rows), Ok(1));
        assert_eq!(fleet.holds(rows, 0.0), Err(Fault::Refused(pcr_core::AdmissionError::Meeting([0, 1]))));
        assert_eq!(fleet.plan(rows), Ok(2));
        let delays = rows.numbers().to_vec();
        assert!(delays.iter().any(|&delay| delay > 0.5));
        // The table is that of the fleet again.
        assert_eq!(fleet.regions(rows), Ok(2));
        let mut later = crossing();
        (later[4], later[STRIDE + 4]) = (delays[0], delays[1]);
        assert_eq!(fleet.build(&later, 2), Ok(1));
        assert_eq!(fleet.conflicts(rows), Ok(0));
        assert_eq!(fleet.holds(rows, 0.0), Ok(2));
        assert_eq!(rows.numbers().iter().filter(|hold| hold.is_finite()).count(), 1);
    });
}

#[test]
fn what_is_no_fleet_is_refused_and_leaves_nobody() {
    asked(|fleet, rows| {
        let wrong = |place: usize, value: f64| {
            let mut input = crossing();
            input[place] = value;
            input
        };
        for (place, value) in [
            (0, f64::NAN),
            (3, 0.0),
            (3, f64::INFINITY),
            (5, -1.0),
            (7, 0.5),
            (7, LEGS as f64 + 1.0),
            (7, -1.0),
            (8, -2.0),
        ] {
            assert!(fleet.build(&crossing(), 2).is_ok());
            assert!(fleet.build(&wrong(place, value), 2).is_err(), "{place}: {value}");
            // There is nobody of whom "no conflict" could be said.
            assert_eq!(
                [fleet.map(rows, 0, 0.0, 1.0, 10), fleet.conflicts(rows), fleet.regions(rows)],
                [Err(Fault::NotBuilt); 3]
            );
        }
        assert_eq!(fleet.build(&crossing(), AGENTS + 1), Err(Fault::Agents(AGENTS + 1)));
        assert!(fleet.build(&crossing(), 2).is_ok());
        assert_eq!(fleet.map(rows, 2, 0.0, 1.0, 10), Err(Fault::Mismatch(pcr_core::MismatchError::NoSuchAgent(2))));
        assert_eq!(fleet.map(rows, 0, f64::NAN, 1.0, 10), Err(Fault::Question("the time")));
        assert_eq!(fleet.map(rows, 0, 5.0, 0.0, usize::MAX >> 40), Err(Fault::Rows));
        assert_eq!(fleet.track(rows, 2, 0.0, 1.0, 10), Err(Fault::Mismatch(pcr_core::MismatchError::NoSuchAgent(2))));
        assert_eq!(fleet.track(rows, 0, 0.0, f64::INFINITY, 10), Err(Fault::Question("the time")));
        assert_eq!(fleet.track(rows, 0, 0.0, 1.0, usize::MAX >> 40), Err(Fault::Rows));
        // The last time is not finite although both numbers are.
        assert_eq!(fleet.map(rows, 0, 0.0, 1e308, 10), Err(Fault::Question("the time")));
        assert_eq!(fleet.track(rows, 0, 0.0, 1e308, 10), Err(Fault::Question("the time")));
        // Half the way of 8 m from rest to rest at half the time, and nowhere else before and after.
        assert_eq!(fleet.track(rows, 0, -5.0, 10.0, 3), Ok(3));
        assert_eq!(rows.numbers(), [0.0, 4.0, 8.0]);
    });
}

#[test]
fn one_that_stands_forbids_its_place_before_and_after() {
    asked(|fleet, rows| {
        let map = |fleet: &mut Fleet<'static>, rows: &mut Rows, other: [f64; 10]| {
            let mut input = crossing();
            input[STRIDE..STRIDE + 10].copy_from_slice(&other);
            assert_eq!(fleet.build(&input, 2), Ok(1));
            assert_eq!(fleet.regions(rows), Ok(2));
            let open = rows.numbers()[8..10].to_vec();
            let count = fleet.map(rows, 0, 0.0, 1.0, 11).expect("a map");
            let times: Vec<f64> = rows.numbers().chunks_exact(4).map(|row| row[0]).collect();
            assert_eq!(count, times.len());
            assert!(rows.numbers().chunks_exact(4).all(|row| row[1] == 1.0 && row[2] < 4.0 && row[3] > 4.0));
            (open, times)
        };
        let north = std::f64::consts::FRAC_PI_2;
        let all: Vec<f64> = (0..11).map(f64::from).collect();
        let stands = [0.0, 0.0, north, 0.4, 0.0, 1.0, 0.5, 0.0, 0.0, 0.0];
        assert_eq!(map(fleet, rows, stands), (vec![1.0, 1.0], all.clone()));
        // It arrives at 1.8 s, and stays in the way.
        let arrives = [0.0, -0.4, north, 0.4, 0.0, 1.0, 0.5, 1.0, 0.4, 0.0];
        let (open, times) = map(fleet, rows, arrives);
        assert_eq!((open[1], &times[2..]), (1.0, &all[2..]));
        // It stands in the way up to its start at 8 s.
        let leaves = [0.0, 0.0, north, 0.4, 8.0, 1.0, 0.5, 1.0, 4.0, 0.0];
        let (open, times) = map(fleet, rows, leaves);
        assert_eq!((open, &times[..9]), (vec![1.0, 0.0], &all[..9]));
    });
}

#[test]
fn a_plan_of_which_there_is_none_leaves_the_table() {
    asked(|fleet, rows| {
        let mut input = crossing();
        // Nobody passes one that stands on the way.
        input[STRIDE..STRIDE + 10].copy_from_slice(&[0.0, 0.0, 0.0, 0.4, 0.0, 1.0, 0.5, 0.0, 0.0, 0.0]);
        assert_eq!(fleet.build(&input, 2), Ok(1));
        assert!(matches!(fleet.plan(rows), Err(Fault::Unsolved(_))));
        assert_eq!(fleet.regions(rows), Ok(2));
    });
}

/// Numbers as JavaScript has them. Nothing else here calls the exports, which have one state.
#[test]
fn what_is_no_whole_number_is_none() {
    let call = || {
        for agents in [f64::NAN, -1.0, 1.9, 4_294_967_296.0, f64::INFINITY] {
            assert_eq!(pcr_web::pcr_build(0.0), 0);
            assert_eq!(pcr_web::pcr_conflicts(), 0, "nobody");
            assert_eq!((pcr_web::pcr_build(agents), pcr_web::pcr_conflicts()), (-1, -1), "{agents}");
        }
        assert_eq!(pcr_web::pcr_build(0.0), 0);
        for number in [f64::NAN, 0.9, 4_294_967_296.0] {
            assert_eq!((pcr_web::pcr_map(number, 0.0, 1.0, 1.0), pcr_web::pcr_track(number, 0.0, 1.0, 1.0)), (-1, -1));
            assert_eq!(pcr_web::pcr_map(0.0, 0.0, 1.0, number), -1);
        }
    };
    std::thread::Builder::new().stack_size(64 << 20).spawn(call).expect("a thread").join().expect("no panic");
}
