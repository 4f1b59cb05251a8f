//! Passing orders: who passes a collision region first. Kept, nobody collides, whatever the delays (docs/theory.md).
//!
//! ```text
//! hold        how far the second may go past one region             Hold, RegionRef::hold
//! ```

mod hold;

pub use hold::Hold;
