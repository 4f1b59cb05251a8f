//! Audits far more pairs than the tests do: `campaign FIRST_SEED COUNT [BOXES]`, in `f64` and `f32`.
//!
//! Prints every violation with its seed, which `pcr_tests::generators` turns into the pair again.

use pcr_host::fleet::Format;
use pcr_tests::audit::{Audit, Seen, Violation};
use pcr_tests::disc::Disc;
use pcr_tests::generators::{Dice, RELATIONS, related};
use pcr_tests::oracle::Route;
use pcr_tests::oracle::plane::Effort;
use std::panic::{AssertUnwindSafe, catch_unwind};

fn main() {
    let arguments: Vec<usize> = std::env::args().skip(1).filter_map(|argument| argument.parse().ok()).collect();
    let (first, count) = (arguments.first().copied().unwrap_or(0), arguments.get(1).copied().unwrap_or(10_000));
    let effort = Effort { resolution: 1e-2, boxes: arguments.get(2).copied().unwrap_or(20_000), range: 1e-4 };
    let (mut seen64, mut seen32) = (Seen::default(), Seen::default());
    let mut failures = 0;
    for seed in first..first + count {
        let relation = RELATIONS[seed % RELATIONS.len()];
        let (ego, other) = related(relation, &mut Dice::seeded(seed as u64));
        let mut report = |format: &str, outcome: Result<(), Violation>| {
            // Radii above the limit of a format are refused, as they should be.
            if let Err(violation) = outcome
                && !violation.starts_with("refused: radius")
            {
                println!("seed {seed} {relation:?} {format}: {violation}");
                failures += 1;
            }
        };
        if count == 1 {
            shortened::<f64>(&ego, &other, effort);
            shortened::<f32>(&ego, &other, effort);
        }
        report("f64", audit::<f64>(&ego, &other, effort, &mut seen64));
        report("f32", audit::<f32>(&ego, &other, effort, &mut seen32));
    }
    println!("{count} pairs, {failures} violations\nf64 {seen64:?}\nf32 {seen32:?}");
}

fn audit<S: Format>(ego: &Disc, other: &Disc, effort: Effort, seen: &mut Seen) -> Result<(), Violation> {
    const SAMPLES: usize = 24;
    let (ego, other) = (ego.rounded::<S>(), other.rounded::<S>());
    let run = AssertUnwindSafe(|| Audit::<S>::new(&ego, &other)?.all(effort, SAMPLES, seen));
    catch_unwind(run).unwrap_or_else(|_| Err("panic".into()))
}

/// Prints a failing pair without the legs that do not matter.
fn shortened<S: Format>(ego: &Disc, other: &Disc, effort: Effort) {
    let fails = |ego: &Disc, other: &Disc| audit::<S>(ego, other, effort, &mut Seen::default()).err();
    let mut pair = [ego.clone(), other.clone()];
    if fails(ego, other).is_none() {
        return;
    }
    for agent in [0, 1] {
        // From the end, which moves nothing, then from the start.
        for first in [false, true] {
            while !pair[agent].legs.is_empty() {
                let mut shorter = pair.clone();
                let disc = &mut shorter[agent];
                if first {
                    let leg = disc.legs.remove(0);
                    let (x, y) = Route::new(disc).at(0.0);
                    let alone = Disc { legs: vec![leg], start: [x, y, disc.start[2]], ..disc.clone() };
                    let (x, y) = Route::new(&alone).at(leg.length());
                    disc.start = [x, y, disc.start[2] + leg.sweep()];
                } else {
                    disc.legs.pop();
                }
                if fails(&shorter[0], &shorter[1]).is_none() {
                    break;
                }
                pair = shorter;
            }
        }
    }
    println!("{}: {}", S::NAME, fails(&pair[0], &pair[1]).unwrap_or_default());
    let [ego, other] = pair.map(|disc| disc.rounded::<S>());
    println!("  ego {ego:?}\n  other {other:?}");
    if let Ok(audit) = Audit::<S>::new(&ego, &other) {
        let (motions, ecm) = audit.table();
        for region in ecm.pair(&motions, 0, 1) {
            println!(
                "  region s {:?} l {:?}, {} pieces",
                region.other_length(),
                region.length(),
                region.pieces().count()
            );
        }
    }
}
