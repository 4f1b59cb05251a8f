//! Prints the paper's scenario as the source that the firmware includes: firmware/supervisor/src/scenario/paper12.rs.

fn main() {
    print!("{}", pcr_tests::constants::source());
}
