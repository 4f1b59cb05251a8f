//! The supervisor as users see it: runs of fleets, kills, lines.

mod alarms;
mod kills;
mod lines;
mod runs;
mod world;
mod writer;
