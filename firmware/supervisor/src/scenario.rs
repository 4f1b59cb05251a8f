//! The paper's 12 agents in each number format, rounded to the format at compile time.
//!
//! `scenario/paper12.rs` is generated from the scenario embedded in the tool: `cargo run -p pcr-tests --example
//! constants`. A test of the host's workspace compares the two.

pub mod crowd;

/// Number of agents of the scenario.
pub const AGENTS: usize = 12;
/// Number of lines and arcs of the scenario.
pub const SEGMENTS: usize = 36;
/// Number of lines and arcs, with room for the path of one more agent, which replaces another one.
pub const ROOM: usize = SEGMENTS + crate::agent::MAX_STEPS;
/// Number of collision regions of the scenario, each for both directions of its pair, with room for a few more.
pub const REGIONS: usize = 80;
/// Number of pieces of these regions, with room for a few more.
pub const PIECES: usize = 112;

/// Number of orders for these regions, and for those of a robot that gets another path.
pub const ORDERS: usize = REGIONS + 40;

/// Defines a module with the scenario in a number format, and the conversions of decimals to numbers and angles of the
/// format.
macro_rules! scenario {
    ($(#[$attribute:meta])* $module:ident: $number:ty, $angle:ty, |$v:ident| $to_number:expr, |$a:ident| $to_angle:expr) => {
        $(#[$attribute])*
        pub mod $module {
            use crate::agent::{Agent, Step};
            use pcr_core::{Curve, Limits, Point, Pose, TurnSide};

            /// The number format.
            pub type Number = $number;

            const fn number($v: f64) -> Number {
                $to_number
            }

            const fn angle($a: f64) -> $angle {
                $to_angle
            }

            include!("scenario/paper12.rs");
        }
    };
}

#[cfg(feature = "float")]
scenario!(
    /// The scenario in `f32`.
    float: f32, pcr_core::Radians<f32>, |v| v as f32, |a| pcr_core::Radians(a as f32)
);

#[cfg(feature = "micromath")]
scenario!(
    /// The scenario in [`pcr_core::scalar::Micro`].
    micro: pcr_core::scalar::Micro, pcr_core::Radians<Number>,
    |v| pcr_core::scalar::Micro(v as f32),
    |a| pcr_core::Radians(pcr_core::scalar::Micro(a as f32))
);

/// The same for a fixed-point format. A value that does not fit does not compile.
#[cfg(feature = "fixed")]
macro_rules! fixed {
    ($($(#[$attribute:meta])* $module:ident: $number:ident,)*) => {
        $(scenario!(
            $(#[$attribute])*
            $module: pcr_fixed::$number, pcr_fixed::Turns,
            |v| match pcr_fixed::$number::from_f64(v) {
                Ok(number) => number,
                Err(_) => panic!("out of range"),
            },
            |a| match pcr_fixed::Turns::from_radians(a) {
                Ok(angle) => angle,
                Err(_) => panic!("out of range"),
            }
        );)*
    };
}

#[cfg(feature = "fixed")]
fixed!(
    /// The scenario in Q20.12.
    q12: Q12,
    /// The scenario in Q16.16.
    q16: Q16,
    /// The scenario in Q12.20.
    q20: Q20,
);
