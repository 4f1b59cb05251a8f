//! The supervisor as users see it: runs of fleets, kills, lines.

mod alarms;
mod asked;
mod away;
mod closures;
mod deploy;
mod former;
mod holds;
mod joints;
mod kills;
mod lines;
mod office;
mod overtaken;
mod pauses;
mod runs;
mod sockets;
mod standby;
mod stops;
mod world;
mod writer;
