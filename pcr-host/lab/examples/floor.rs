//! Writes the random fleet of the evaluation as a scenario: `cargo run --release -p pcr-lab --example floor -- 100000 > floor.json`.

use pcr_comparing::compare::crowd;
use std::io::{self, Write};

fn main() -> io::Result<()> {
    let agents = std::env::args().nth(1).and_then(|agents| agents.parse().ok()).unwrap_or(1000);
    io::stdout().write_all(crowd(agents, 0).to_json().as_bytes())
}
