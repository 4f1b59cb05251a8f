//! Tasks of others on a roadmap: all are done without a contact, however late robots are.

use pcr_planning::lifelong::{Delays, Method, Report, Request, Tasks, run_tasks};
use pcr_tests::roadmap_tasks::read;

const SET: &str = include_str!("../data/real/cplp/set0_301c854d.json");

fn done(tasks: usize, delays: Delays) -> (Report, Tasks) {
    let (imported, mut all) = read(SET).expect("a roadmap");
    all.tasks.truncate(tasks);
    let request = Request { agents: all.starts.len(), duration: 3000.0, delays, seed: 1, method: Method::Orders };
    (run_tasks(&imported, request, &all).expect("a run"), all)
}

const COUNT: usize = if cfg!(optimized) { 100 } else { 10 };

#[test]
fn all_tasks_are_done_and_nobody_touches_anybody() {
    for delays in [Delays { stopped: 0.0, slip: 0.0, ..Delays::default() }, Delays::default()] {
        let (report, tasks) = done(COUNT, delays);
        let outcome = &report.outcome;
        assert_eq!((outcome.missions, outcome.robots), (tasks.tasks.len(), tasks.starts.len()));
        assert_eq!((outcome.certificate.verdict, outcome.breaches, outcome.stuck), ("proved", 0, 0), "{outcome:?}");
        // Nothing is done before it comes.
        assert!(report.last_arrival >= tasks.tasks.iter().map(|(_, time)| *time).fold(0.0, f64::max));
    }
}

#[test]
fn places_that_are_none_are_refused() {
    let (imported, tasks) = read(SET).expect("a roadmap");
    let request = Request { agents: 10, duration: 10.0, delays: Delays::default(), seed: 1, method: Method::Orders };
    let wrong = |tasks: Tasks| run_tasks(&imported, request, &tasks).expect_err("a wrong place");
    let node = wrong(Tasks { starts: vec![0, 50], ..tasks.clone() });
    assert_eq!(node, "node 50 is none of the 50 of the layout");
    assert!(wrong(Tasks { tasks: vec![(51, 0.0)], ..tasks.clone() }).contains("node 51"));
    assert_eq!(wrong(Tasks { starts: vec![3, 3], ..tasks }), "robots 0 and 1 touch where they begin");
}
