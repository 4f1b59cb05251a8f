//! Tables and contacts of outlines that touch, proved by the independent checker.
//!
//! The long command is `cargo run --release -p pcr-tests --example certify_outlines -- --pairs 10000000 --seed 1`.

use pcr_tests::case_ranges::run_on_all_processors;
use pcr_tests::certified_outlines::FORMATS;

/// Pairs of a format: each takes 0.1 to 0.5 s.
const PAIRS: u64 = 60;

#[test]
fn tables_and_contacts_of_outlines_are_proved_in_every_format() {
    for (name, run) in FORMATS {
        let proofs = run_on_all_processors(*run, 5_000, PAIRS, |_, _| ());
        println!("{name}: {proofs}");
        assert_eq!(proofs.refuted, Vec::<String>::new(), "{name}");
        // Two outlines without rounding that touch exactly are within rounding of what is to be proved.
        assert!(proofs.undecided.len() as u64 * 20 <= PAIRS, "{name}: {:?}", proofs.undecided);
        assert_eq!(proofs.cases(), PAIRS);
        assert!(proofs.proved * 10 > 9 * PAIRS && proofs.ranked > PAIRS / 2 && proofs.contacts > PAIRS / 4, "{proofs}");
    }
}
