//! Collision regions by the definition alone.
//!
//! Nothing here is shared with the library, neither code nor formulas: positions are complex numbers (the integral of
//! the heading), and regions are found by subdivision. All conclusions rest on one fact: if both paths are
//! parameterised by length, `|ρ_i(l) - ρ_j(s)|` changes by at most the way travelled. The value in the middle of a box
//! of the (s, l) plane therefore decides the whole box, or the box is halved.
//!
//! ```text
//! route    position on a path
//! travel   travelled length over time, and its inverse by bisection
//! contact  when two driven discs touch
//! line     what a disc covers of a path: certified intervals
//! plane    connected components in the (s, l) plane: certified
//! ```

pub mod contact;
pub mod line;
pub mod plane;
pub mod route;
pub mod travel;

pub use route::Route;
pub use travel::Travel;

/// Two routes and the sum of their radii.
#[derive(Clone, Debug)]
pub struct Pair {
    /// Route of the ego (length `l`).
    pub ego: Route,
    /// Route of the other (length `s`).
    pub other: Route,
    /// Combined radius \[m\].
    pub radius: f64,
}

impl Pair {
    /// The pair of two discs.
    pub fn new(ego: &crate::disc::Disc, other: &crate::disc::Disc) -> Self {
        Self { ego: Route::new(ego), other: Route::new(other), radius: ego.radius + other.radius }
    }

    /// How far the discs are from contact \[m\]: negative where they overlap.
    pub fn clearance(&self, s: f64, l: f64) -> f64 {
        let (p, q) = (self.ego.at(l), self.other.at(s));
        (p.0 - q.0).hypot(p.1 - q.1) - self.radius
    }
}
