//! Random fleets: nobody touches anybody, whatever happens to messages, robots and the supervisor; and everybody arrives.

use crate::world::{Trouble, World};

const SEEDS: u64 = if cfg!(debug_assertions) { 6 } else { 24 };

fn run(seed: u64, trouble: Trouble, restarts: f64) -> World {
    let mut world = World::new(seed, 2 + (seed % 9) as usize, trouble);
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
    world
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

#[test]
fn fleets_whose_supervisor_is_restarted() {
    runs(Trouble { lost: 0.2, late: 3.0, stops: 0.002 }, 0.01);
}
