//! One pair of agents with one crossing in the middle of both paths, for each type of piece.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use pcr_benches::{Storage, from_json};
use std::hint::black_box;

/// A path of length 4 m through the origin in its middle, with this heading there.
fn through_origin(id: u32, heading: f64, arc: bool) -> String {
    let (x, y, start, segment) = if arc {
        // 2 rad of a circle of radius 2: one radian before the origin.
        let before = heading - 1.0;
        let chord = 2.0 * 2.0 * 0.5_f64.sin();
        let direction = heading - 0.5;
        (-chord * direction.cos(), -chord * direction.sin(), before, r#"{"kind":"arc","radius":2,"sweep":2}"#)
    } else {
        (-2.0 * heading.cos(), -2.0 * heading.sin(), heading, r#"{"kind":"line","length":4}"#)
    };
    format!(
        r#"{{"id":{id},"radius":0.15,"v_max":0.5,"a_max":0.3,"start":{{"x":{x},"y":{y},"heading":{start}}},"path":[{segment}]}}"#
    )
}

fn crossings(c: &mut Criterion) {
    let mut group = c.benchmark_group("one crossing, both directions");
    for (name, first, second) in [("SS", false, false), ("SA", false, true), ("AS", true, false), ("AA", true, true)] {
        let agents = [through_origin(1, 0.0, first), through_origin(2, 1.0, second)].join(",");
        let fleet = from_json::<f64>(&format!(r#"{{"agents":[{agents}]}}"#));
        let motions = fleet.motions();
        let mut storage = Storage::of(&motions);
        assert_eq!(storage.regions.len(), 1, "one crossing");
        group
            .bench_function(BenchmarkId::from_parameter(name), |b| b.iter(|| storage.table(black_box(&motions)).len()));
    }
    group.finish();
}

criterion_group!(benches, crossings);
criterion_main!(benches);
