//! All collision regions of a fleet, both directions of every pair, on one core.
//!
//! `time` is that of a fleet; the throughput line counts the pieces of both directions, or pairs of agents, so that
//! its inverse is the time of one.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use pcr_benches::{Storage, fleet, scattered};
use pcr_planning::fleet::{Fleet, HostScalar};
use std::hint::black_box;

/// Twice the pieces that are stored: each serves both directions.
fn bench<S: HostScalar>(c: &mut Criterion, name: &str, fleet: &Fleet<S>, throughput: impl Fn(usize, usize) -> usize) {
    let motions = fleet.motions();
    let mut storage = Storage::of(&motions);
    let elements = throughput(motions.len(), storage.pieces.len());
    let mut group = c.benchmark_group("fleet");
    group.throughput(Throughput::Elements(elements as u64));
    group.bench_function(BenchmarkId::new(name, S::NAME), |b| b.iter(|| storage.table(black_box(&motions)).len()));
    group.finish();
}

fn fleets(c: &mut Criterion) {
    let pieces = |_, pieces| 2 * pieces;
    bench(c, "12 agents, 136 regions, by piece", &fleet::<f64>("paper12"), pieces);
    bench(c, "12 agents, 136 regions, by piece", &fleet::<f32>("paper12"), pieces);
    bench(c, "100 agents, 3182 regions, by piece", &fleet::<f64>("table6-100"), pieces);
    bench(c, "100 agents, 3182 regions, by piece", &fleet::<f32>("table6-100"), pieces);
    let pairs = |agents: usize, _| agents * (agents - 1) / 2;
    bench(c, "100 agents that cannot meet, by pair", &scattered::<f64>(10), pairs);
}

criterion_group!(benches, fleets);
criterion_main!(benches);
