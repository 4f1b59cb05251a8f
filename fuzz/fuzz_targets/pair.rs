//! Any bytes as the dice that make a pair of agents, near degenerate ones included: the audit of the tests holds.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pcr_fixed::Q16;
use pcr_planning::fleet::HostScalar;
use pcr_tests::audit::{Audit, Seen};
use pcr_tests::disc::Disc;
use pcr_tests::generators::{Dice, FACES, pair};
use pcr_tests::oracle::plane::Effort;

const EFFORT: Effort = Effort { resolution: 5e-2, boxes: 500, range: 1e-3 };

fn audit<S: HostScalar>(ego: &Disc, other: &Disc) {
    let (ego, other) = (ego.rounded::<S>(), other.rounded::<S>());
    match Audit::<S>::new(&ego, &other) {
        Err(refused) => assert!(refused.starts_with("refused"), "{refused}"),
        Ok(audit) => {
            audit.all(EFFORT, 6, &mut Seen::default()).unwrap_or_else(|violation| panic!("{}: {violation}", S::NAME))
        }
    }
}

fuzz_target!(|bytes: &[u8]| {
    // Two bytes a face, evenly in [0, 1).
    let mut faces: Vec<f64> =
        bytes.chunks_exact(2).map(|pair| f64::from(u16::from_le_bytes([pair[0], pair[1]])) / 65536.0).collect();
    faces.resize(FACES, 0.5);
    let (ego, other) = pair(&mut Dice::new(faces));
    audit::<f64>(&ego, &other);
    audit::<f32>(&ego, &other);
    audit::<Q16>(&ego, &other);
});
