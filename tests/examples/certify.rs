use pcr_fixed::{Q12, Q16, Q20};
use pcr_host::certify::{Certified, table_of};
use pcr_host::fleet::Format;
use pcr_host::scenario::Scenario;
use std::time::Instant;

fn one<S: Format>(file: &str, scenario: &Scenario, margin: bool) {
    let table = match table_of::<S>(scenario) {
        Ok(t) => t,
        Err(e) => {
            println!("{file} {}: {e}", S::NAME);
            return;
        }
    };
    let start = Instant::now();
    let c = Certified::of("", &table, margin);
    let took = start.elapsed();
    println!(
        "{file} {}: {:?} {} segs {} pieces {} steps {:?} margin {:?} r {} u {} {:?}",
        S::NAME,
        c.verdict,
        c.segment_pairs,
        c.pieces,
        c.steps,
        took,
        c.margin,
        c.refuted.len(),
        c.undecided.len(),
        c.error
    );
    for p in c.refuted.iter().chain(&c.undecided).take(3) {
        println!("   {p:?}");
    }
}

fn main() {
    for file in std::env::args().skip(1) {
        let s = Scenario::from_json(&std::fs::read_to_string(&file).unwrap()).unwrap();
        one::<f64>(&file, &s, true);
        one::<f32>(&file, &s, true);
        one::<Q20>(&file, &s, true);
        one::<Q16>(&file, &s, true);
        one::<Q12>(&file, &s, true);
    }
}
