//! Fixed-point number types for [`pcr_core`]: the same closed forms on processors without a floating-point unit.
//!
//! Number types and nothing else; the algorithm is that of `pcr-core`. No floating-point operation is made unless a
//! value is converted from or to one.
//!
//! | type | last digit | arena and times up to | meant for |
//! |---|---|---|---|
//! | [`Q20`] | 2⁻²⁰ m = 0.95 µm | ±256 m, 256 s | small robots, tables, cells |
//! | [`Q16`] | 2⁻¹⁶ m = 15 µm | ±4096 m, 68 min | halls, yards |
//! | [`Q12`] | 2⁻¹² m = 0.24 mm | ±65 km, 18 h | ports, fields, mines |
//!
//! Speeds and accelerations have the same digits, in m/s and m/s². Angles are [`Turns`]: 32-bit fractions of a turn, which
//! wrap as angles do. Whatever does not fit is refused by the constructors of `pcr-core`; afterwards nothing overflows.
//! `docs/errors-fixed.md` has the bounds of its sums, `docs/errors.md` that on the regions: they contain the exact ones,
//! and lie within those of a radius that is larger by 16 last digits and one for each arc ([`pcr_core::excess`]).
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
//! `serde`, `defmt`: their traits on the number types; on the wire a number is its bits, an `i32`.
#![no_std]

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
