//! What the line on the terminal says of the time to go. The tool is no library, so its file is read in.

#[allow(dead_code)]
#[path = "../../src/progress.rs"]
mod source;

use source::remaining;
use std::time::Duration;

#[test]
fn what_is_left_takes_as_long_as_what_is_done() {
    let after = |done| remaining(done, 1000, Duration::from_secs(10));
    assert_eq!([after(9), after(10), after(250), after(1000)], [None, Some(990), Some(30), Some(0)]);
}
