//! Any bytes as lines to a supervisor: answered or refused, never a panic, and what is told of a robot only grows.
#![no_main]

use pcr_serve::journal_entry::NullStore;
use pcr_serve::lines::handle;
use pcr_serve::supervisor::{Supervisor, SupervisorConfig};

const FLEET: [&str; 4] = [
    r#"{"verb":"add","robot":"a","start":{"x":-3,"y":0,"heading":0},"abilities":{"radius":0.25,"speed":1,"acceleration":0.5}}"#,
    r#"{"verb":"add","robot":"b","start":{"x":0,"y":-3,"heading":1.5},"abilities":{"radius":0.25,"speed":1,"acceleration":0.5}}"#,
    r#"{"verb":"mission","robot":"a","mission":"1","path":[{"kind":"line","length":6}]}"#,
    r#"{"verb":"mission","robot":"b","mission":"1","path":[{"kind":"line","length":6}]}"#,
];

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut supervisor = Supervisor::new(SupervisorConfig::default(), Box::new(NullStore));
    let lines = FLEET.iter().map(|line| line.as_bytes()).chain(bytes.split(|byte| *byte == b'\n').take(64));
    for (line, tick) in lines.zip(0_u32..) {
        let now = f64::from(tick) * 0.1;
        let told: Vec<_> =
            supervisor.robots().iter().map(|robot| (robot.name.clone(), robot.path, robot.granted)).collect();
        let reply = handle(&mut supervisor, line, now, now);
        assert!(reply.answer.get("ok").is_some() != reply.answer.get("error").is_some());
        supervisor.settle(now).expect("a journal that is nowhere");
        for (name, path, granted) in told {
            let Ok(robot) = supervisor.robot(&name) else { continue };
            assert!(robot.path > path || robot.granted >= granted || robot.path == 1);
            assert!(robot.arc_length <= robot.notified_limit && robot.granted <= robot.notified_limit);
        }
    }
});
