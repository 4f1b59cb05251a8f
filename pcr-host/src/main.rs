//! The command `pcr`.

fn main() {}
