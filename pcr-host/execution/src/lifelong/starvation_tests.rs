//! How often a mission is overtaken: on every site where its goal can be reached, a limited number of times.

use super::outcome::LifelongResult;
use super::route_graph::RouteGraph;
use super::{CoordinationMethod, DelayModel, LifelongOptions, aisles, run, streets};
use pcr_formats::import::{ImportOptions, ImportedLayout, InputFormat, Warnings, roads};
use std::collections::VecDeque;

fn real(name: &str) -> ImportedLayout {
    let path = format!("{}/../../tests/data/real/nav2/{name}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a layout");
    let options = ImportOptions { radius: Some(0.3), ..ImportOptions::default() };
    roads(InputFormat::Nav2, &text, &options, &mut Warnings::default()).expect("a layout")
}

/// The most edges on a shortest route between two nodes of a site.
fn diameter(site: &RouteGraph) -> usize {
    let farthest = |start: usize| {
        let mut steps = vec![usize::MAX; site.points.len()];
        steps[start] = 0;
        let mut open = VecDeque::from([start]);
        let mut most = 0;
        while let Some(node) = open.pop_front() {
            most = most.max(steps[node]);
            for &atom in &site.leaving[node] {
                let to = site.atoms[atom].ends[1];
                if steps[to] == usize::MAX {
                    steps[to] = steps[node] + 1;
                    open.push_back(to);
                }
            }
        }
        most
    };
    (0..site.points.len()).map(farthest).max().unwrap_or(0)
}

fn outcome(site: &ImportedLayout, agents: usize, seed: u64) -> LifelongResult {
    let (delays, method) = (DelayModel::default(), CoordinationMethod::Orders);
    run(site, LifelongOptions { agents, duration: 600.0, delays, seed, method }).expect("a run").outcome
}

/// With n robots and at most D edges between two nodes: 4 n times before it goes first, and then by the n robots that make way for it on each of
/// these edges.
#[test]
fn no_mission_is_overtaken_more_often_than_the_bound_on_any_of_these_sites() {
    let sites = [
        ("streets of 2", streets(2), vec![3, 6]),
        ("streets of 3", streets(3), vec![6, 12]),
        ("aisles", aisles(3), vec![4, 8]),
        ("aws", real("aws_graph.geojson"), vec![4, 10]),
        ("warehouse", real("warehouse_graph.geojson"), vec![6, 12]),
    ];
    let mut most = 0;
    for (name, site, fleets) in sites {
        let limit = 4 + diameter(&RouteGraph::new(&site).expect("a site"));
        for agents in fleets {
            for seed in 1..=2 {
                let found = outcome(&site, agents, seed);
                println!("{name}, {agents} robots: overtaken {} of {}", found.overtaken, limit * agents);
                assert!(found.overtaken <= limit * agents, "{name}, {agents} robots: {found:?}");
                assert!(found.missions > 0 && found.starved == 0, "{name}, {agents} robots: {found:?}");
                most = most.max(found.overtaken);
            }
        }
    }
    // Otherwise nothing was counted.
    assert!(most > 0, "{most}");
}
