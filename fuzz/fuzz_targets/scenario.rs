//! Any bytes as a scenario file: refused with a message, or its regions are computed in every number format.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pcr_fixed::{Q12, Q16, Q20};
use pcr_formats::scenario::{Agent, MotionSpec, Scenario};
use pcr_planning::fleet::HostScalar;
use pcr_planning::regions::{RegionOptions, RegionsReport};

fn answer<S: HostScalar>(scenario: &Scenario) {
    match RegionsReport::compute::<S>(scenario, RegionOptions { slices: Some(3), ..RegionOptions::default() }) {
        Ok(answer) => {
            for region in &answer.regions {
                assert!(region.t[0] <= region.t[1] && region.l[0] <= region.l[1], "{region:?}");
                for slice in region.slices.iter().flatten() {
                    assert!(slice.l.iter().all(|[lo, hi]| lo <= hi), "{slice:?}");
                    assert!(slice.l.windows(2).all(|pair| pair[0][1] < pair[1][0]), "{slice:?}");
                }
            }
        }
        Err(failure) => assert!(!failure.to_string().is_empty()),
    }
}

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match Scenario::from_json(text) {
        Err(error) => assert!(!error.to_string().is_empty()),
        Ok(scenario) => {
            // What is written is read again, a profile but for its scaling onto the path.
            let again = Scenario::from_json(&scenario.to_json()).unwrap_or_else(|error| panic!("{error}"));
            for (again, agent) in again.agents.iter().zip(&scenario.agents) {
                let motion = match agent.motion {
                    MotionSpec::RestToRest { .. } => again.motion.clone(),
                    MotionSpec::Profile { .. } => agent.motion.clone(),
                };
                assert_eq!(&Agent { motion, ..again.clone() }, agent);
            }
            assert_eq!(again.agents.len(), scenario.agents.len());
            // Full turns are one segment each.
            let segments: f64 =
                scenario.agents.iter().flat_map(|agent| &agent.path).map(|part| 1.0 + part.length()).sum();
            // An outline is computed with as up to 64 discs.
            let outlined = scenario.agents.iter().any(|agent| agent.footprint.is_some() || !agent.loads.is_empty());
            if scenario.agents.len() <= 4 && segments < if outlined { 20.0 } else { 1e3 } {
                answer::<f64>(&scenario);
                answer::<f32>(&scenario);
                answer::<Q16>(&scenario);
                answer::<Q20>(&scenario);
                answer::<Q12>(&scenario);
            }
        }
    }
});
