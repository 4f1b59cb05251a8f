//! VDA 5050 over a real broker, and what does not need one. The runs with a broker: `.ci/test.sh serve`.

mod absence;
mod actions;
mod base_end;
mod broker;
mod cancels;
mod deploy_runs;
mod doubt;
mod dump;
mod faults;
mod following;
mod lanes;
mod limits;
mod long;
mod maps;
mod outlines;
mod pair;
mod pauses;
mod puppet;
mod refusals;
mod restarts;
mod runs;
mod samples;
mod schemas;
mod site;
mod standing;
mod stops;
#[cfg(feature = "tls")]
mod tls;
mod verdicts;
mod yard;
mod zone_sets;
mod zones;
