//! Builds the table of a fleet again and again, for profilers: `work FLEET TIMES`, a name in `tests/data` and a count.

use pcr_benches::{Storage, fleet};
use std::hint::black_box;

fn main() {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "paper12".into());
    let times: u32 = arguments.next().and_then(|times| times.parse().ok()).unwrap_or(1);
    let fleet = fleet::<f64>(&name);
    let motions = fleet.motions();
    let mut storage = Storage::of(&motions);
    for _ in 0..times {
        black_box(storage.table(black_box(&motions)).len());
    }
}
