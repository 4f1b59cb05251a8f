//! Using motions and regions: conflict checks of whole fleets, on one core.
//!
//! `time` is that of a fleet; the throughput line counts pairs of agents, so that its inverse is the time of one.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use pcr_benches::{boxes, fleet, scattered};
use pcr_core::{BroadPhase, Encounter, Motion};
use pcr_planning::fleet::{Fleet, HostScalar};
use std::hint::black_box;

fn pairs<'a, S: HostScalar>(motions: &'a [Motion<'a, S>]) -> impl Iterator<Item = Encounter<'a, S>> {
    let pairs = (0..motions.len()).flat_map(|i| (i + 1..motions.len()).map(move |j| [i, j]));
    pairs.map(|[i, j]| Encounter::new(&motions[i], &motions[j]))
}

fn bench<S: HostScalar>(c: &mut Criterion, name: &str, fleet: &Fleet<S>) {
    let motions = fleet.motions();
    let time = Motion::span(&motions);
    let mut group = c.benchmark_group("conflicts");
    group.throughput(Throughput::Elements((motions.len() * (motions.len() - 1) / 2) as u64));
    let mut boxes = boxes(&motions);
    group.bench_function(BenchmarkId::new(format!("{name}, when"), S::NAME), |b| {
        b.iter(|| {
            let broad_phase = BroadPhase::new(&mut boxes[..], black_box(&motions), time);
            broad_phase.map_or(0, |broad_phase| broad_phase.contacts().count())
        })
    });
    group.bench_function(BenchmarkId::new(format!("{name}, when, pair by pair"), S::NAME), |b| {
        b.iter(|| pairs(black_box(&motions)).map(|pair| pair.contacts(time).count()).sum::<usize>())
    });
    group.bench_function(BenchmarkId::new(format!("{name}, when and how deep"), S::NAME), |b| {
        b.iter(|| pairs(black_box(&motions)).map(|pair| pair.conflicts(time).count()).sum::<usize>())
    });
    group.bench_function(BenchmarkId::new(format!("{name}, closest approach"), S::NAME), |b| {
        b.iter(|| {
            let nearest = pairs(black_box(&motions)).map(|pair| pair.closest(time).separation);
            nearest.fold(S::LIMIT, S::min)
        })
    });
    group.finish();
}

fn conflicts(c: &mut Criterion) {
    bench(c, "12 agents", &fleet::<f64>("paper12"));
    bench(c, "12 agents", &fleet::<f32>("paper12"));
    bench(c, "100 agents", &fleet::<f64>("table6-100"));
    bench(c, "100 agents that cannot meet", &scattered::<f64>(10));
}

criterion_group!(benches, conflicts);
criterion_main!(benches);
