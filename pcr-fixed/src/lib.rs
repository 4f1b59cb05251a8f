//! Fixed-point number types for [`pcr_core`]: the same closed forms on processors without a floating-point unit.
//!
//! This crate contains number types only; the algorithms are those of `pcr-core`. It uses floating-point operations
//! only to convert values from or to floating point.
//!
//! | type | last digit | arena and times up to | meant for |
//! |---|---|---|---|
//! | [`Q20`] | 2⁻²⁰ m = 0.95 µm | ±256 m, 256 s | small robots, tables, cells |
//! | [`Q16`] | 2⁻¹⁶ m = 15 µm | ±4096 m, 68 min | halls, yards |
//! | [`Q12`] | 2⁻¹² m = 0.24 mm | ±65 km, 18 h | ports, fields, mines |
//!
//! Speeds and accelerations have the same resolution, in m/s and m/s². Angles are [`Turns`]: 32-bit fractions of a
//! turn, which wrap around as angles do. The constructors of `pcr-core` refuse values that do not fit; after that
//! nothing overflows. `docs/theory/errors-fixed.md` bounds the sums. `docs/theory/errors.md` bounds the regions: they contain the
//! exact ones, and lie within those for a radius that is larger by 16 last digits plus one for each arc
//! ([`pcr_core::excess`]).
//!
//! ```
//! use pcr_core::{Limits, Motion, Path, Point, Pose, Profile};
//! use pcr_fixed::{OutOfRange, Q16, Turns};
//!
//! let metres = |value: f64| Q16::from_f64(value); // rounded to nearest
//! let start = Pose { position: Point::new(metres(-2.0)?, metres(0.0)?), heading: Turns::QUARTER };
//! let path = Path::<Q16, 1>::starting_at(start)?.line(metres(4.0)?)?;
//! let limits = Limits { speed: metres(1.0)?, acceleration: metres(0.5)? };
//! let profile = Profile::rest_to_rest(path.as_path().length(), limits)?;
//! let motion = Motion::new(path.as_path(), profile.as_profile(), metres(0.25)?, metres(0.0)?)?;
//! assert_eq!(motion.position_at(metres(3.0)?), Point::new(metres(-2.0)?, metres(2.0)?));
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```
//!
//! # Features
//! `serde`, `defmt`: implement the traits of these crates for the number types. A number is serialized as its bits, an
//! `i32`.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![no_std]

/// The program of the README is run by the tests of the documentation.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

mod convert;
mod display;
mod integer;
mod product;
mod q;
mod ramp;
mod roots;
mod scalar;
mod scaled;
mod sine;
mod trigonometry;
mod turns;

pub use convert::OutOfRange;
pub use product::Product;
pub use q::{Q, Q12, Q16, Q20};
pub use sine::Sine;
pub use turns::Turns;
