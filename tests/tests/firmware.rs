//! The firmware's scenario is that of the tool, and its documents tell what fleets take.

use pcr_core::{Direction, EcmEntry, Piece, RegionPrecedence, Segment};
use pcr_formats::scenario::Scenario;
use pcr_planning::fleet::{Fleet, build_ecm};

#[test]
fn the_constants_of_the_firmware_are_generated_from_the_scenario_of_the_tool() {
    let committed = include_str!("../../firmware/supervisor/src/scenario/paper12.rs");
    assert_eq!(committed, pcr_tests::constants::source(), "run `cargo run -p pcr-tests --example constants`");
}

/// Bytes of a segment in firmware, which leaves out outlines and with them the direction in which a body looks, and whether it keeps that.
const SEGMENT_BYTES: usize = size_of::<Segment<f32>>() - size_of::<(Direction<f32>, bool)>();

/// Bytes that each agent's motion takes beside its segments, on the Cortex-M4F in `f32`, as it was measured for 12 agents.
fn bytes_an_agent() -> usize {
    let measured = include_str!("../../firmware/expected/thumbv7em-none-eabihf-f32.txt");
    let line = measured.lines().find(|line| line.ends_with("bytes of the motions in RAM")).expect("a figure");
    let bytes: usize = line.split_whitespace().next().expect("a number").parse().expect("a number");
    (bytes - 36 * SEGMENT_BYTES).div_ceil(12)
}

/// A number as the documents have it.
fn written(number: usize) -> String {
    if number < 1000 { number.to_string() } else { format!("{},{:03}", number / 1000, number % 1000) }
}

#[test]
fn the_sizes_of_larger_fleets_are_as_documented() {
    let (document, mut missing) = (include_str!("../../docs/guide/firmware.md"), Vec::new());
    for (agents, name) in [(12, "paper12"), (30, "table6-30"), (50, "table6-50"), (100, "table6-100")] {
        let path = format!("{}/data/{name}.json", env!("CARGO_MANIFEST_DIR"));
        let scenario = Scenario::from_json(&std::fs::read_to_string(path).expect("a file")).expect("a scenario");
        let fleet = Fleet::<f32>::new(&scenario).expect("a fleet");
        let motions = fleet.motions();
        let ecm = build_ecm(&motions).expect("a table");
        let segments: usize = motions.iter().map(|motion| motion.path().segments().len()).sum();
        let table = ecm.len() * size_of::<EcmEntry>() + ecm.pieces() * size_of::<Piece<f32>>();
        let placed = segments * SEGMENT_BYTES + agents * bytes_an_agent();
        let orders = ecm.len() * size_of::<RegionPrecedence<f32>>();
        let numbers = [agents, segments, ecm.len(), ecm.pieces(), table, placed, orders].map(written);
        let row = format!("| {} |", numbers.join(" | "));
        if !document.contains(&row) {
            missing.push(row);
        }
    }
    assert!(missing.is_empty(), "docs/guide/firmware.md needs\n{}", missing.join("\n"));
}
