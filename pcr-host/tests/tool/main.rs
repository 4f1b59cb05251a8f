//! The binary `pcr`, end to end: arguments and standard input in; output, messages and exit status out.

mod fixture;
mod lines;
mod output;
mod refusals;
mod streams;
