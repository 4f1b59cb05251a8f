//! The firmware's scenario is that of the tool.

#[test]
fn the_constants_of_the_firmware_are_generated_from_the_scenario_of_the_tool() {
    let committed = include_str!("../../firmware/supervisor/src/scenario/paper12.rs");
    assert_eq!(committed, pcr_tests::constants::source(), "run `cargo run -p pcr-tests --example constants`");
}
