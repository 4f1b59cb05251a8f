//! Use of a table: slices, membership, exchange of one agent of 100.

use criterion::{Criterion, criterion_group, criterion_main};
use pcr_benches::{Storage, fleet};
use std::hint::black_box;

fn queries(c: &mut Criterion) {
    let fleet = fleet::<f64>("paper12");
    let motions = fleet.motions();
    let mut storage = Storage::of(&motions);
    let ecm = storage.table(&motions);
    c.bench_function("slice at the middle of each of 136 regions", |b| {
        b.iter(|| {
            ecm.regions(&motions)
                .expect("the table of the fleet")
                .flat_map(|region| region.slice_at(region.time().middle()))
                .count()
        });
    });
    c.bench_function("membership in each of 136 regions", |b| {
        let inside = |region: &pcr_core::RegionRef<'_, f64>| region.contains(region.time().middle(), black_box(5.0));
        b.iter(|| ecm.regions(&motions).expect("the table of the fleet").filter(inside).count());
    });
}

fn exchange(c: &mut Criterion) {
    let fleet = fleet::<f64>("table6-100");
    let mut motions = fleet.motions();
    let mut storage = Storage::of(&motions);
    let same = motions[50];
    let planned = motions.clone();
    let mut ecm = storage.table(&planned);
    c.bench_function("exchange of one agent of 100", |b| {
        b.iter(|| ecm.replace(&mut motions, 50, black_box(same)).is_ok());
    });
}

criterion_group!(benches, queries, exchange);
criterion_main!(benches);
