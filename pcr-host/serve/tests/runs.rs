//! Random fleets: nobody touches anybody, whatever happens to messages, robots and the supervisor; and everybody arrives.

use crate::world::{Trouble, World};
use pcr_serve::event::SupervisorEvent;

const SEEDS: u64 = if cfg!(debug_assertions) { 6 } else { 24 };

fn run(seed: u64, trouble: Trouble, restarts: f64) -> World {
    let mut world = World::new(seed, 2 + (seed % 9) as usize, trouble);
    runs_on(&mut world, seed, restarts);
    world
}

/// Lets it run, and then come to rest.
fn runs_on(world: &mut World, seed: u64, restarts: f64) {
    while world.now < 120.0 {
        world.step();
        if world.dice().unit() < restarts {
            world.restart();
        }
    }
    // Whoever has a path comes to its end.
    world.open = false;
    while !world.vehicles.iter().all(|vehicle| vehicle.has_arrived())
        || world.supervisor.robots().iter().any(|robot| robot.arc_length < robot.course.length() - 0.1)
    {
        world.step();
        let late: Vec<&str> = world
            .vehicles
            .iter()
            .filter(|vehicle| !vehicle.has_arrived())
            .map(|vehicle| vehicle.name.as_str())
            .collect();
        assert!(world.now < 1200.0, "seed {seed}: {late:?} do not arrive");
    }
    world.certify();
}

fn runs(trouble: Trouble, restarts: f64) {
    let (mut admitted, mut waits, mut steps, mut alarms) = (0, 0, 0, 0);
    for seed in 0..SEEDS {
        let world = run(seed, trouble, restarts);
        admitted += world.vehicles.iter().map(|vehicle| vehicle.missions).sum::<u32>();
        waits += world.waits;
        steps += world.steps;
        alarms += world.supervisor.counts().alarms;
    }
    println!("{admitted} missions, {waits} had to wait, {steps} intervals certified, {alarms} alarms");
    assert!(admitted > 20 * SEEDS as u32 && waits > SEEDS as u32 && steps > 1000 && alarms == 0);
}

#[test]
fn fleets_with_good_messages() {
    runs(Trouble { lost: 0.0, late: 0.0, stops: 0.0 }, 0.0);
}

#[test]
fn fleets_with_messages_lost_late_and_repeated() {
    runs(Trouble { lost: 0.3, late: 5.0, stops: 0.005 }, 0.0);
}

/// Whatever part of a mission is admitted, its robot comes to the end of that, and nobody touches it there.
#[test]
fn fleets_whose_missions_are_admitted_in_parts() {
    let mut parts = 0;
    for seed in 0..SEEDS {
        let trouble = Trouble { lost: 0.1, late: 1.0, stops: 0.002 };
        let mut world = World::new(seed, 4 + (seed % 7) as usize, trouble);
        world.in_parts = true;
        runs_on(&mut world, seed, 0.005);
        assert_eq!(world.supervisor.counts().alarms, 0);
        parts += world.parts;
    }
    println!("{parts} parts");
    assert!(parts > SEEDS as u32);
}

#[test]
fn fleets_whose_supervisor_is_restarted() {
    runs(Trouble { lost: 0.2, late: 3.0, stops: 0.002 }, 0.01);
}

/// A person pauses the fleet again and again, also while the supervisor is restarted: nobody is granted anything meanwhile, all stand after they have
/// braked and their messages have come, and all go on.
#[test]
fn fleets_that_are_paused_and_resumed() {
    let (mut pauses, mut missions) = (0, 0);
    for seed in 0..SEEDS {
        let mut world = World::new(seed, 2 + (seed % 9) as usize, Trouble { lost: 0.2, late: 1.0, stops: 0.0 });
        while world.now < 120.0 {
            let until = world.now + world.dice().uniform(1.0, 20.0);
            while world.now < until {
                world.step();
            }
            world.supervisor.pause().unwrap();
            let (begin, until) = (world.now, world.now + world.dice().uniform(1.0, 20.0));
            while world.now < until {
                let events = world.step();
                let grants = |event: &&SupervisorEvent| {
                    matches!(
                        event,
                        SupervisorEvent::Hold { .. } | SupervisorEvent::Admitted { .. } | SupervisorEvent::Go { .. }
                    )
                };
                assert_eq!(events.iter().find(grants), None, "seed {seed}");
                let is_braked = world.now > begin + 8.0;
                assert!(!is_braked || world.vehicles.iter().all(|vehicle| vehicle.speed == 0.0), "seed {seed}");
                if world.dice().unit() < 0.02 {
                    world.restart();
                }
            }
            assert!(world.supervisor.resume().unwrap(), "seed {seed}");
            pauses += 1;
        }
        world.open = false;
        while !world.vehicles.iter().all(|vehicle| vehicle.has_arrived()) {
            world.step();
            assert!(world.now < 1200.0, "seed {seed}: not all arrive");
        }
        world.certify();
        missions += world.vehicles.iter().map(|vehicle| vehicle.missions).sum::<u32>();
    }
    println!("{pauses} pauses, {missions} missions");
    assert!(pauses > 4 * SEEDS && missions > 10 * SEEDS as u32, "{pauses} pauses, {missions} missions");
}
