//! Fleets on sites where robots get into one another's way: how many of them are active, and how often a mission is overtaken.

use crate::lifelong::{WAREHOUSE, graph, layout, one_way};
use pcr_execution::lifelong::{CoordinationMethod, DelayModel, LifelongOptions, LifelongReport, aisles, streets};
use pcr_formats::import::{ImportedLayout, InputFormat};
use pcr_formats::missions::SiteChanges;
use std::collections::VecDeque;
use std::f64::consts::TAU;

/// A node in the middle, and dead ends around it.
fn star(arms: usize) -> ImportedLayout {
    let around = |k: usize| (TAU * k as f64 / arms as f64).sin_cos();
    let mut points = vec![[0.0, 0.0]];
    points.extend((0..arms).map(|k| [8.0 * around(k).1, 8.0 * around(k).0]));
    let edges: Vec<[usize; 2]> = (1..=arms).map(|arm| [0, arm]).collect();
    layout(InputFormat::Nav2, &graph(&points, &edges), 0.4)
}

/// A two-way lane with sidings that are dead ends.
fn sidings() -> ImportedLayout {
    let mut points: Vec<[f64; 2]> = (0..9).map(|k| [6.0 * f64::from(k), 0.0]).collect();
    points.extend([1, 3, 5, 7].map(|k| [6.0 * f64::from(k), 2.5]));
    let mut edges: Vec<[usize; 2]> = (0..8).map(|k| [k, k + 1]).collect();
    edges.extend([[1, 9], [3, 10], [5, 11], [7, 12]]);
    layout(InputFormat::Nav2, &graph(&points, &edges), 0.4)
}

/// A one-way round.
fn round(count: usize, radius: f64) -> ImportedLayout {
    let around = |k: usize| (TAU * k as f64 / count as f64).sin_cos();
    let points: Vec<[f64; 2]> = (0..count).map(|k| [radius * around(k).1, radius * around(k).0]).collect();
    let edges: Vec<[usize; 2]> = (0..count).map(|k| [k, (k + 1) % count]).collect();
    layout(InputFormat::Nav2, &one_way(&points, &edges), 0.4)
}

fn warehouse() -> ImportedLayout {
    layout(InputFormat::Nav2, WAREHOUSE, 0.4)
}

fn request(agents: usize, minutes: f64) -> LifelongOptions {
    let (delays, method) = (DelayModel::default(), CoordinationMethod::Orders);
    LifelongOptions { agents, duration: 60.0 * minutes, delays, seed: 1, method }
}

/// The fleet with as many active robots as do most missions.
fn limited(site: &ImportedLayout, agents: usize, minutes: f64) -> LifelongReport {
    let answer = LifelongReport::limited(
        site,
        request(agents, minutes),
        &SiteChanges::default(),
        &[CoordinationMethod::Orders],
        &|_, _| {},
    );
    let answer = answer.expect("a run");
    assert!(answer.is_sound(), "{answer:?}");
    assert_eq!((answer.asked, answer.hours), (agents, minutes / 60.0));
    assert_eq!((answer.runs.len(), answer.runs[0].outcome.robots), (1, answer.active), "{answer:?}");
    assert!(answer.trials.first().is_some_and(|trial| trial.robots == agents), "{answer:?}");
    answer
}

/// The fleet with all robots active.
fn whole(site: &ImportedLayout, agents: usize, minutes: f64) -> LifelongReport {
    LifelongReport::run(site, request(agents, minutes), &[CoordinationMethod::Orders]).expect("a run")
}

fn rate(answer: &LifelongReport) -> f64 {
    answer.runs[0].outcome.missions_per_hour
}

#[test]
fn more_robots_never_do_fewer_missions() {
    let minutes = if cfg!(optimized) { 8.0 } else { 3.0 };
    let sites = [
        ("star", star(10), vec![2, 4, 8, 9, 10, 11]),
        ("sidings", sidings(), vec![2, 4, 6, 8]),
        ("ring", round(16, 12.0), vec![1, 2, 8, 16]),
        ("loop", round(8, 6.5), vec![1, 2, 3, 4, 8]),
        ("warehouse", warehouse(), if cfg!(optimized) { vec![4, 8, 16, 24] } else { vec![2, 4] }),
    ];
    for (name, site, fleets) in sites {
        let mut most: f64 = 0.0;
        for agents in fleets {
            let answer = limited(&site, agents, minutes);
            let does = rate(&answer);
            assert!(does >= 0.95 * most, "{name}, {agents} robots: {does} an hour after {most}: {answer:?}");
            most = most.max(does);
        }
    }
}

/// Without the limit eight robots on a star do less than four, and the answer with it is that of the fleet that was chosen.
#[test]
fn robots_that_would_be_in_the_way_are_not_active() {
    let minutes = if cfg!(optimized) { 15.0 } else { 6.0 };
    let site = star(10);
    let [few, many] = [4, 8].map(|agents| whole(&site, agents, minutes));
    assert!(rate(&many) < 0.9 * rate(&few), "{} and {}", rate(&few), rate(&many));
    let answer = limited(&site, 8, minutes);
    assert!(answer.active < 8 && rate(&answer) >= rate(&few), "{answer:?}");
    let alike = whole(&site, answer.active, minutes);
    assert_eq!(answer.runs[0].outcome, alike.runs[0].outcome);
    let of = |robots: usize| answer.trials.iter().find(|trial| trial.robots == robots).expect("a trial");
    assert_eq!((of(8).missions_per_hour, of(answer.active).missions_per_hour), (rate(&many), rate(&answer)));
    assert!((of(8).hours * 60.0 - minutes).abs() < 1e-9 && !of(8).standstill, "{answer:?}");
}

/// Trial runs are shorter than long runs, and what is answered is the whole run; also for other methods with the same robots.
#[test]
fn whole_runs_follow_trial_runs() {
    let minutes = 20.0;
    let site = round(8, 6.5);
    let methods = [CoordinationMethod::Orders, CoordinationMethod::RouteLocks];
    let told = std::cell::RefCell::new(Vec::new());
    let answer = LifelongReport::limited(&site, request(3, minutes), &SiteChanges::default(), &methods, &|now, all| {
        told.borrow_mut().push((now, all))
    });
    let answer = answer.expect("a run");
    assert_eq!((answer.runs.len(), answer.active), (2, 3), "{answer:?}");
    assert_eq!(answer.runs[0].outcome, whole(&site, 3, minutes).runs[0].outcome);
    let told = told.into_inner();
    assert!(told.is_sorted_by_key(|it| it.0) && told.iter().all(|it| it.0 <= it.1 + 1e-9), "{told:?}");
}

/// The most edges from a node to another one on a shortest route.
fn diameter(site: &ImportedLayout) -> usize {
    let count = site.layout.nodes.len();
    let mut next = vec![Vec::new(); count];
    for edge in &site.layout.edges {
        let [from, to] = edge.ends;
        let both = [(edge.ways[0], from, to), (edge.ways[1], to, from)];
        both.into_iter().filter(|it| it.0).for_each(|(_, from, to)| next[from].push(to));
    }
    let farthest = |start: usize| {
        let mut steps = vec![None; count];
        steps[start] = Some(0);
        let mut open = VecDeque::from([start]);
        while let Some(node) = open.pop_front() {
            for &to in &next[node] {
                if steps[to].is_none() {
                    steps[to] = steps[node].map(|steps: usize| steps + 1);
                    open.push_back(to);
                }
            }
        }
        steps.into_iter().flatten().max().unwrap_or(0)
    };
    (0..count).map(farthest).max().unwrap_or(0)
}

/// With n robots and at most D edges between two nodes a mission is overtaken 4 n times before it goes first, and then at most by the
/// missions of those n robots that make way for it on each of these edges.
#[test]
fn a_mission_is_overtaken_a_limited_number_of_times() {
    let minutes = if cfg!(optimized) { 10.0 } else { 4.0 };
    let aws = layout(InputFormat::Nav2, include_str!("../data/real/nav2/aws_graph.geojson"), 0.3);
    // On the last ones no mission has to wait for so long that it counts as starved.
    let sites = [
        (false, "loop", round(8, 6.5), vec![4, 7, 8]),
        (false, "ring", round(16, 12.0), vec![8, 15]),
        (false, "star", star(10), vec![4, 8, 10]),
        (false, "sidings", sidings(), vec![6, 8]),
        (true, "streets of 2", streets(2), vec![6]),
        (true, "streets of 3", streets(3), vec![12]),
        (true, "aisles", aisles(3), vec![8]),
        (true, "aws", aws, vec![10]),
        (true, "warehouse", warehouse(), if cfg!(optimized) { vec![12, 24] } else { vec![4] }),
    ];
    let mut most = 0;
    for (is_served, name, site, fleets) in sites {
        for agents in fleets {
            let answer = whole(&site, agents, minutes);
            let outcome = &answer.runs[0].outcome;
            let limit = (4 + diameter(&site)) * agents;
            println!(
                "{name}, {agents} robots: overtaken {} of {limit}, starved {}",
                outcome.overtaken, outcome.starved
            );
            assert!(outcome.overtaken <= limit, "{name}, {agents}: overtaken {} times: {outcome:?}", outcome.overtaken);
            let is_starved = outcome.missions == 0 || outcome.starved > 0;
            assert!(!is_served || !is_starved, "{name}, {agents}: {outcome:?}");
            most = most.max(outcome.overtaken);
        }
    }
    // Otherwise nothing was counted.
    assert!(most > 4, "{most}");
}
