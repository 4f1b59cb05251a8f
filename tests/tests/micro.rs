//! The number type `Micro` on the reference pairs: its regions contain the exact ones and lie within those of a radius
//! that is larger by its own bound.

use pcr_core::scalar::Micro;
use pcr_tests::audit::{Audit, Seen};
use pcr_tests::disc::Disc;
use pcr_tests::oracle::plane::Effort;
use pcr_tests::reference::cases;

#[test]
fn micro_regions_are_audited_on_the_reference_pairs() {
    const EFFORT: Effort = Effort { resolution: 2e-2, boxes: 3_000, range: 1e-4 };
    let mut seen = Seen::default();
    for case in cases() {
        let [ego, other] = [0, 1].map(|k| Disc::of_agent(&case.scenario.agents[k]).rounded::<f32>());
        let audit = Audit::<Micro>::new(&ego, &other).expect("a valid pair");
        if let Err(violation) = audit.all(EFFORT, 12, &mut seen) {
            panic!("{}: {violation}", case.name);
        }
    }
    assert!(seen.regions > 300 && seen.certain > 150, "{seen:?}");
}
