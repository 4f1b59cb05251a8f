//! Plans: first conflicts, delays and speeds of agents, plans of fleets, and a new plan for one agent of 100, on one core.
//!
//! `time` of the first group is that of all agents of the fleet, one after the other; the throughput line counts agents, so
//! that its inverse is the time of one.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use pcr_benches::{Storage, fleet, lanes};
use pcr_core::{
    Motion, Profile, SearchNode, SpeedPlanLimits, earliest_start, first_conflict, plan_delays, plan_speed, plan_speeds,
};
use pcr_planning::fleet::Fleet;
use std::hint::black_box;

/// Phases of a profile, and stations along a path.
const PHASES: usize = 64;
const STATIONS: usize = 257;

fn agents(c: &mut Criterion) {
    for (name, fleet) in [("12", fleet::<f64>("paper12")), ("100", fleet::<f64>("table6-100"))] {
        let motions = fleet.motions();
        let time = Motion::span(&motions);
        let mut storage = Storage::of(&motions);
        let ecm = storage.table(&motions);
        let mut group = c.benchmark_group(format!("every agent of {name}"));
        group.throughput(Throughput::Elements(motions.len() as u64));
        group.bench_function("first conflict with its row", |b| {
            let rows = || black_box(&motions).iter().enumerate();
            b.iter(|| {
                rows()
                    .filter_map(|(k, motion)| {
                        first_conflict(motion, ecm.row(&motions, k).expect("the table of the fleet"), time)
                            .expect("its own row")
                    })
                    .count()
            });
        });
        group.bench_function("earliest start", |b| {
            b.iter(|| {
                (0..motions.len())
                    .filter_map(|k| earliest_start(ecm.row(black_box(&motions), k).expect("its table"), 0.0))
                    .count()
            });
        });
        group.sample_size(10);
        let mut stations = vec![SearchNode::EMPTY; STATIONS];
        group.bench_function("speed plan", |b| {
            b.iter(|| {
                let planned = (0..motions.len()).filter(|&k| {
                    let regions = ecm.row(black_box(&motions), k).expect("its table");
                    plan_speed::<f64, PHASES>(
                        &motions[k],
                        SpeedPlanLimits::of(&motions[k]).expect("from rest to rest"),
                        regions,
                        &[],
                        &mut stations,
                    )
                    .is_ok()
                });
                planned.count()
            });
        });
        group.finish();
    }
}

fn by_delays(c: &mut Criterion, name: &str, fleet: &Fleet<f64>) {
    let motions = fleet.motions();
    let mut storage = Storage::of(&motions);
    let ecm = storage.table(&motions);
    let mut group = c.benchmark_group("fleet plan by delays");
    group.sample_size(10);
    group.bench_function(BenchmarkId::from_parameter(name), |b| {
        b.iter(|| {
            let (mut plan, mut order) = (motions.clone(), (0..motions.len()).collect::<Vec<_>>());
            plan_delays(&ecm, black_box(&motions), &mut plan, &mut order).expect("a plan")
        });
    });
    group.finish();
}

fn by_speeds(c: &mut Criterion, name: &str, fleet: &Fleet<f64>) {
    let motions = fleet.motions();
    let mut storage = Storage::of(&motions);
    let ecm = storage.table(&motions);
    let mut stations = vec![SearchNode::EMPTY; STATIONS];
    let mut group = c.benchmark_group("fleet plan by speeds");
    group.sample_size(10);
    group.bench_function(BenchmarkId::from_parameter(name), |b| {
        b.iter(|| {
            let (mut plan, mut order) = (motions.clone(), (0..motions.len()).collect::<Vec<_>>());
            let mut profiles = vec![Profile::<f64, PHASES>::standing(); 4 * motions.len()];
            plan_speeds(&ecm, black_box(&motions), &mut plan, &mut order, &mut profiles, &mut stations).expect("a plan")
        });
    });
    group.finish();
}

fn fleets(c: &mut Criterion) {
    let (small, large) = (fleet::<f64>("paper12"), lanes(1));
    by_delays(c, "12 agents", &small);
    by_delays(c, "100 agents, 2500 crossings", &large);
    by_delays(c, "1000 agents, ten times the 100", &lanes(10));
    by_speeds(c, "12 agents", &small);
    by_speeds(c, "100 agents, 2500 crossings", &large);
}

/// The table with another motion of the agent, and its earliest start among the others; each agent in turn.
fn replanning(c: &mut Criterion) {
    let fleet = fleet::<f64>("table6-100");
    let mut motions = fleet.motions();
    let mut storage = Storage::of(&motions);
    let planned = motions.clone();
    let mut ecm = storage.table(&planned);
    let mut agents = (0..motions.len()).cycle();
    c.bench_function("a new start for one agent of 100, its regions anew", |b| {
        b.iter(|| {
            let agent = agents.next().unwrap_or_default();
            let same = motions[agent];
            let replaced = ecm.replace(&mut motions, agent, black_box(same));
            replaced.is_ok().then(|| earliest_start(ecm.row(&motions, agent).expect("the table of the fleet"), 0.0))
        });
    });
    c.bench_function("a new start for one agent of 100, regions as they are", |b| {
        b.iter(|| {
            earliest_start(ecm.row(black_box(&motions), agents.next().unwrap_or_default()).expect("its table"), 0.0)
        });
    });
}

criterion_group!(benches, agents, fleets, replanning);
criterion_main!(benches);
