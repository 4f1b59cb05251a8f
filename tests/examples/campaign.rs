//! Audits far more pairs than the tests do: `campaign FIRST_SEED COUNT [BOXES] [FORMAT...]`, in all number formats or in
//! those that are named (`f64 f32 q16 q20 q12`).
//!
//! Prints every violation with its seed, which `pcr_tests::generators` turns into the pair again.

use pcr_fixed::{Q12, Q16, Q20};
use pcr_planning::fleet::HostScalar;
use pcr_tests::audit::{Audit, Seen, Violation};
use pcr_tests::disc::Disc;
use pcr_tests::generators::{Dice, RELATIONS, related};
use pcr_tests::oracle::Route;
use pcr_tests::oracle::plane::Effort;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};

fn main() {
    let numbers: Vec<usize> = std::env::args().skip(1).filter_map(|argument| argument.parse().ok()).collect();
    let names: Vec<String> = std::env::args().skip(1).filter(|argument| argument.parse::<usize>().is_err()).collect();
    let (first, count) = (numbers.first().copied().unwrap_or(0), numbers.get(1).copied().unwrap_or(10_000));
    let effort = Effort { resolution: 1e-2, boxes: numbers.get(2).copied().unwrap_or(20_000), range: 1e-4 };
    let seeds = first..first + count;
    run::<f64>(&names, seeds.clone(), effort);
    run::<f32>(&names, seeds.clone(), effort);
    run::<Q16>(&names, seeds.clone(), effort);
    run::<Q20>(&names, seeds.clone(), effort);
    run::<Q12>(&names, seeds, effort);
}

/// The campaign in one format, if it is asked for.
fn run<S: HostScalar>(names: &[String], seeds: Range<usize>, effort: Effort) {
    if !names.is_empty() && !names.iter().any(|name| name == S::NAME) {
        return;
    }
    let (count, mut seen, mut refused, mut failures) = (seeds.len(), Seen::default(), 0, 0);
    for seed in seeds {
        let relation = RELATIONS[seed % RELATIONS.len()];
        let (ego, other) = related(relation, &mut Dice::seeded(seed as u64));
        if count == 1 {
            shortened::<S>(&ego, &other, effort);
        }
        match audit::<S>(&ego, &other, effort, &mut seen) {
            // What is above the limit of a format is refused, as it should be.
            Err(violation) if violation.starts_with("refused: ") && violation.ends_with("is out of range") => {
                refused += 1
            }
            Err(violation) => {
                println!("seed {seed} {relation:?} {}: {violation}", S::NAME);
                failures += 1;
            }
            Ok(()) => {}
        }
    }
    println!("{}: {count} pairs, {refused} out of range, {failures} violations, {seen:?}", S::NAME);
}

fn audit<S: HostScalar>(ego: &Disc, other: &Disc, effort: Effort, seen: &mut Seen) -> Result<(), Violation> {
    const SAMPLES: usize = 24;
    let (ego, other) = (ego.rounded::<S>(), other.rounded::<S>());
    let run = AssertUnwindSafe(|| Audit::<S>::new(&ego, &other)?.all(effort, SAMPLES, seen));
    catch_unwind(run).unwrap_or_else(|_| Err("panic".into()))
}

/// Prints a failing pair without the legs that do not matter.
fn shortened<S: HostScalar>(ego: &Disc, other: &Disc, effort: Effort) {
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
        for region in ecm.pair(&motions, 0, 1).expect("the table of the fleet") {
            println!(
                "  region s {:?} l {:?}, {} pieces",
                region.other_length(),
                region.length(),
                region.pieces().count()
            );
        }
    }
}
