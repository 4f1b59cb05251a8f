//! The paper's own equations (7)-(39), as printed and as corrected: what the library is compared with.
//!
//! They live in the paper's frame {B}: the ego, agent 2, passes the origin along `+x` at length 0; the other, agent 1,
//! passes it at time 0 with heading θ and speed υ₁. Each equation that computes something is a module or a function
//! named after its number; where the printed form is wrong there are two, `as_printed` and `corrected`.
//! `docs/theory/equations.md` has a line, a counterexample and a test for each.
//!
//! ```text
//! straight_straight   (8)-(17)     SS, and the contour of the grown agent
//! straight_arc        (18)-(23)    SA
//! arc_straight        (24)-(33)    AS
//! arc_arc             (34)-(37)    AA
//! global              (7), (38), (39)
//! cases               random crossings
//! definition          contact by its definition, searched by walking: what decides who is right
//! kernels             the same crossing through pcr-core
//! truth               the right value, on which all agree, for the tests of what is wrong
//! ```
//!
//! All of it is `f64` and holds for infinite lines and full circles, one crossing at a time. Where a region runs on
//! into the next crossing of the same carriers (paper Fig. 14b), the corrected forms give the merged range, and
//! [`EVERYWHERE`] where it never ends. None of it is used by the library.

pub mod arc_arc;
pub mod arc_straight;
pub mod cases;
pub mod definition;
pub mod global;
pub mod kernels;
pub mod straight_arc;
pub mod straight_straight;
pub mod truth;

use pcr_core::PieceType;

/// A point or vector of the plane \[m\].
pub type Vec2 = [f64; 2];

/// A range of times \[s\] or lengths \[m\], lower end first (which a wrong equation may fail to keep).
pub type Range = [f64; 2];

/// The range of a region that runs round a circle for ever.
pub const EVERYWHERE: Range = [f64::NEG_INFINITY, f64::INFINITY];

/// A circular arc: ς and dir.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// Radius of curvature ς \[m\].
    pub radius: f64,
    /// 1 counter-clockwise, -1 clockwise.
    pub dir: f64,
}

/// A parameterized collision region in {B}: the arguments of Tables III and IV.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pcr {
    /// Sum of the radii r̂₁ \[m\].
    pub r: f64,
    /// Speed of the other agent υ₁ \[m/s\].
    pub v: f64,
    /// Angle from the direction of ρ₂ to that of ρ₁ at the crossing \[rad\].
    pub theta: f64,
    /// Shape of the ego's path ρ₂ (`None`: straight).
    pub own: Option<Arc>,
    /// Shape of the other's path ρ₁ (`None`: straight).
    pub other: Option<Arc>,
}

impl Pcr {
    /// Type of Section 3.3.
    pub fn piece_type(&self) -> PieceType {
        match (self.own, self.other) {
            (None, None) => PieceType::SS,
            (None, Some(_)) => PieceType::SA,
            (Some(_), None) => PieceType::AS,
            (Some(_), Some(_)) => PieceType::AA,
        }
    }

    /// p₁(t): Eq. (9) or (20).
    pub fn position(&self, t: f64) -> Vec2 {
        match self.other {
            None => straight_straight::eq_09(self, t),
            Some(arc) => straight_arc::eq_20(self, arc, t),
        }
    }

    /// The time range column of Table IV: Eq. (17), (23), (33) or (37), corrected.
    pub fn time_range(&self) -> Range {
        match (self.own, self.other) {
            (None, None) => straight_straight::eq_17::corrected(self),
            (None, Some(other)) => straight_arc::eq_23::corrected(self, other),
            (Some(own), None) => arc_straight::eq_33::corrected(self, own),
            (Some(own), Some(other)) => arc_arc::eq_37::corrected(self, own, other),
        }
    }

    /// The length range: Eq. (15), (22), (30) or (34), corrected.
    pub fn length_range(&self) -> Range {
        match (self.own, self.other) {
            (None, None) => straight_straight::eq_15::corrected(self),
            (None, Some(other)) => straight_arc::eq_22::corrected(self, other),
            (Some(own), None) => arc_straight::eq_30::corrected(self, own),
            (Some(own), Some(other)) => arc_arc::eq_34::corrected(self, own, other),
        }
    }

    /// The contour column of Table IV: Eq. (13) or (26), corrected. On an arc the length is that of the lap next to
    /// the crossing; `None` where nothing is within reach.
    pub fn slice(&self, t: f64) -> Option<Range> {
        match self.own {
            None => straight_straight::eq_13(self.position(t), self.r),
            Some(own) => arc_straight::eq_26::corrected(self.position(t), self.r, own),
        }
    }
}

/// The length of a vector \[m\].
pub fn norm([x, y]: Vec2) -> f64 {
    x.hypot(y)
}
