//! Whoever waits for somebody who is late goes first, if nobody has to wait for that.

use pcr_serve::course::{Shape, Start};
use pcr_serve::entry::{Entry, Keep, Nowhere};
use pcr_serve::robot::Abilities;
use pcr_serve::supervisor::{Proposal, Report, Settings, Supervisor, Verdict};
use std::f64::consts::FRAC_PI_2;
use std::io;
use std::sync::{Arc, Mutex};

const STEP: f64 = 0.5;

/// Remembers all entries.
#[derive(Clone, Default)]
struct Memory(Arc<Mutex<Vec<Entry>>>);

impl Keep for Memory {
    fn keep(&mut self, entries: &[Entry]) -> io::Result<()> {
        self.0.lock().unwrap().extend_from_slice(entries);
        Ok(())
    }
}

/// One from the west, 30 m before a crossing, that is to go first, and a slow one from the south, 12 m before it.
fn crossing(keeper: Box<dyn Keep>) -> Supervisor {
    let mut own = Supervisor::new(Settings::default(), keeper);
    let abilities = |speed| Abilities { radius: 0.4, margin: 0.0, speed, acceleration: 0.5 };
    own.add("west", abilities(1.0), Start { x: -30.0, y: 0.0, heading: 0.0 }).unwrap();
    own.add("south", abilities(0.3), Start { x: 0.0, y: -12.0, heading: FRAC_PI_2 }).unwrap();
    for (robot, length) in [("west", 40.0), ("south", 24.0)] {
        let path = vec![Shape::Line { length }];
        let mission = Proposal { robot: robot.into(), mission: "1".into(), after: None, start: None, path };
        assert!(matches!(own.mission(&mission, 0.0), Ok(Verdict::Admitted { .. })));
    }
    own
}

/// Both go on as far as they may, the one from the west not beyond a length up to a time. Until the other one has gone beyond a length, or
/// two minutes are over.
fn run(own: &mut Supervisor, [stays, until]: [f64; 2], beyond: f64) -> f64 {
    let mut now = 0.0;
    while now < 120.0 && own.robot("south").unwrap().at < beyond {
        for name in ["west", "south"] {
            let robot = own.robot(name).unwrap();
            let far = if name == "west" && now < until { stays } else { f64::INFINITY };
            let at = (robot.at + robot.abilities.speed * STEP).min(robot.granted).min(far).max(robot.at);
            own.position(&Report { robot: name.into(), path: robot.path, at: [at; 2], age: 0.0 }, now).unwrap();
        }
        let [west, south] = ["west", "south"].map(|name| own.robot(name).unwrap());
        // They are at (at - 30, 0) and (0, at - 12).
        assert!((west.at - 30.0).hypot(south.at - 12.0) >= 0.8, "they touch at {now} s");
        own.settle(now).unwrap();
        now += STEP;
    }
    now
}

#[test]
fn a_robot_that_waits_goes_before_one_that_is_late() {
    let memory = Memory::default();
    let mut own = crossing(Box::new(memory.clone()));
    // It needs 43 s to beyond the crossing. The other one stands at its start for two minutes.
    let passed = run(&mut own, [0.0, 120.0], 13.0);
    assert!(passed < 55.0, "{passed}");
    assert_eq!(own.counts().turned, 1);
    let entries = memory.0.lock().unwrap().clone();
    let restored = Supervisor::restored(Settings::default(), entries, Box::new(Nowhere)).unwrap();
    assert!(own.orders().decisions().eq(restored.orders().decisions()));
    // The other one comes to its end, too.
    assert_eq!(run(&mut own, [0.0, 0.0], f64::INFINITY), 120.0);
    assert!(own.robots().iter().all(|robot| robot.has_arrived(0.1)));
}

#[test]
fn nobody_is_made_to_wait_for_it() {
    // 5 m before the crossing: it would have to brake.
    let mut own = crossing(Box::new(Nowhere));
    assert_eq!(run(&mut own, [24.0, 120.0], 13.0), 120.0);
    assert_eq!(own.counts().turned, 0);
}

#[test]
fn a_right_that_was_given_is_kept() {
    // As far before the crossing as at the start, but it has been told that it may go there.
    let mut own = crossing(Box::new(Nowhere));
    own.stops_at("west", 40.0).unwrap();
    assert_eq!(run(&mut own, [0.0, 120.0], 13.0), 120.0);
    assert_eq!(own.counts().turned, 0);
}
