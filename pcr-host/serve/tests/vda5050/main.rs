//! VDA 5050 over a real broker: `.ci/test.sh serve`.

mod broker;
mod runs;
mod site;
