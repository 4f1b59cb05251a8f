//! All tests of the supervisor's jobs, as one program.

mod can;
mod dump;
mod limits;
mod line;
mod service;
mod traffic;
mod wire;
mod wire_format;
