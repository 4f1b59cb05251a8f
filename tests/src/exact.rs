//! Positions, travelled lengths and times in 106 bits, for the format's numbers as exact input: what the bounds of
//! `docs/theory/errors.md` are held against, `f64`'s included. Nothing is shared with the library but the numbers.

mod route;
mod travel;

pub use pcr_certify::double_double::DoubleDouble;
pub use route::{Place, Route};
pub use travel::Travel;
