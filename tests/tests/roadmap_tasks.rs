//! Tasks of others on roadmaps: all are done without a contact, however late robots are, and at least as many a second as published.

use pcr_execution::ExecutionError;
use pcr_execution::lifelong::{
    CoordinationMethod, DelayModel, LifelongOptions, MeasuredLifelongRun, TaskStream, run_tasks,
};
use pcr_lab::roadmap::read;

/// Roadmaps, and the published tasks a second.
const SETS: [(&str, f64); 9] = [
    (include_str!("../data/real/cplp/set0_301c854d.json"), 0.423),
    (include_str!("../data/real/cplp/set1_688009a3.json"), 0.945),
    (include_str!("../data/real/cplp/set2_7cd988d3.json"), 1.797),
    (include_str!("../data/real/cplp/set3_082915a1.json"), 0.404),
    (include_str!("../data/real/cplp/set4_83630882.json"), 0.917),
    (include_str!("../data/real/cplp/set5_bb6cd4d7.json"), 1.604),
    (include_str!("../data/real/cplp/set6_6fcc5c86.json"), 0.403),
    (include_str!("../data/real/cplp/set7_2910f867.json"), 0.875),
    (include_str!("../data/real/cplp/set8_15ee252a.json"), 1.511),
];

const ON_TIME: DelayModel = DelayModel { stopped: 0.0, stop: 5.0, slip: 0.0 };

fn done(set: &str, count: usize, delays: DelayModel) -> (MeasuredLifelongRun, TaskStream) {
    let (imported, mut all) = read(set).expect("a roadmap");
    all.tasks.truncate(count);
    let request = LifelongOptions {
        agents: all.starts.len(),
        duration: 3000.0,
        delays,
        seed: 1,
        method: CoordinationMethod::Orders,
    };
    let report = run_tasks(&imported, request, &all).expect("a run");
    let outcome = &report.outcome;
    assert_eq!((outcome.missions, outcome.robots), (all.tasks.len(), all.starts.len()));
    assert_eq!(
        (outcome.certificate.verdict, outcome.authority_overruns, outcome.stuck),
        ("proved", 0, 0),
        "{outcome:?}"
    );
    // Nothing is done before it comes.
    assert!(report.last_arrival >= all.tasks.iter().map(|(_, time)| *time).fold(0.0, f64::max));
    (report, all)
}

#[test]
fn all_tasks_are_done_and_nobody_touches_anybody() {
    let (sets, count) = if cfg!(optimized) { (&SETS[..], usize::MAX) } else { (&SETS[..1], 10) };
    for (set, published) in sets {
        let (report, tasks) = done(set, count, ON_TIME);
        let a_second = tasks.tasks.len() as f64 / report.last_arrival;
        assert!(count < usize::MAX || a_second > *published, "{a_second} a second, {published} are published");
    }
}

#[test]
fn late_robots_do_all_tasks() {
    let (sets, count) = if cfg!(optimized) { (&SETS[..3], usize::MAX) } else { (&SETS[..1], 10) };
    sets.iter().for_each(|(set, _)| drop(done(set, count, DelayModel::default())));
}

/// A robot that stands at the node of a task when it comes, or passes it on its way to another one, does it.
#[test]
fn tasks_are_done_by_whoever_is_there() {
    let set = SETS[0].0;
    let (_, all) = read(set).expect("a roadmap");
    let tasks = |tasks: &[(usize, f64)]| TaskStream { tasks: tasks.to_vec(), ..all.clone() };
    let run = |tasks: &TaskStream| {
        let (imported, _) = read(set).expect("a roadmap");
        let request = LifelongOptions {
            agents: 10,
            duration: 300.0,
            delays: ON_TIME,
            seed: 1,
            method: CoordinationMethod::Orders,
        };
        run_tasks(&imported, request, tasks).expect("a run")
    };
    let stands = run(&tasks(&[(all.starts[3], 5.0), (all.starts[3], 5.0)]));
    assert_eq!((stands.outcome.missions, stands.decisions.len()), (2, 0));
    assert!(stands.last_arrival >= 5.0 && stands.last_arrival < 5.2, "{}", stands.last_arrival);
    let far = (0..50).find(|node| !all.starts.contains(node)).expect("a node where nobody stands");
    let [once, twice] = [&[(far, 0.0)][..], &[(far, 0.0), (far, 0.0)]].map(|list| run(&tasks(list)));
    assert_eq!((once.outcome.missions, twice.outcome.missions), (1, 2));
    assert_eq!(once.last_arrival, twice.last_arrival);
}

#[test]
fn places_that_are_none_are_refused() {
    let (imported, tasks) = read(SETS[0].0).expect("a roadmap");
    let request = LifelongOptions {
        agents: 10,
        duration: 10.0,
        delays: DelayModel::default(),
        seed: 1,
        method: CoordinationMethod::Orders,
    };
    let wrong = |tasks: TaskStream| run_tasks(&imported, request, &tasks).expect_err("a wrong place");
    let node = wrong(TaskStream { starts: vec![0, 50], ..tasks.clone() });
    assert_eq!(node.to_string(), "node 50 is none of the 50 of the layout");
    assert!(wrong(TaskStream { tasks: vec![(51, 0.0)], ..tasks.clone() }).to_string().contains("node 51"));
    assert_eq!(
        wrong(TaskStream { starts: vec![3, 3], ..tasks }),
        ExecutionError::Touching(["0".to_owned(), "1".to_owned()])
    );
}
