//! The binary `pcr`, end to end: arguments and standard input in; output, messages and exit status out.

mod abort;
mod certify;
mod check;
mod compare;
#[cfg(unix)]
mod console;
mod examples;
mod exclusions;
mod files;
mod fixture;
mod formats;
mod grids;
mod habits;
mod identity;
mod import;
mod large;
mod lines;
mod locks;
mod margins;
mod missions;
mod outlines;
mod output;
mod plan;
mod progress;
mod readers;
mod records;
mod refusals;
mod rules;
mod schema;
mod serve;
mod serve_running;
mod simulate;
mod sources;
mod streams;
mod units;
mod warnings;
