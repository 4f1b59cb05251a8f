//! Outlines of agents: convex polygons, rounded by a radius. Discs, capsules and rectangles are cases.
//!
//! An outline is given in the frame of the agent: the reference point, which follows the path, is the origin; `x` points
//! ahead, along the heading of the agent, and `y` to its left. It is the set of all points within `radius` of the polygon of its corners.

pub(crate) mod placed;

use crate::error::{self, InvalidInput, in_range, not_negative};
use crate::geometry::{Direction, Vector};
use crate::scalar::{Scalar, Unit, Wide};
use heapless::Vec;

/// Largest number of corners of an outline.
pub(crate) const MOST_CORNERS: usize = 16;

/// A corner of an outline, and the edge from it to the next corner.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Corner<S: Scalar> {
    /// Place \[m\].
    pub(crate) at: Vector<S>,
    /// Outward normal of the edge to the next corner.
    pub(crate) outward: Direction<S>,
    /// Length of that edge \[m\]; 0 if there is only one corner.
    pub(crate) length: S,
}

impl<S: Scalar> Corner<S> {
    /// The reference point as the only corner, that of a disc; also to fill storage for corners with.
    pub const CENTRE: Self = Self { at: Vector { x: S::ZERO, y: S::ZERO }, outward: Direction::X, length: S::ZERO };

    /// Returns the place of the corner in the frame of the agent \[m\].
    pub fn at(&self) -> Vector<S> {
        self.at
    }
}

/// A convex polygon of at most `N` corners, rounded by a radius; `N` is at most 16.
///
/// ```
/// use pcr_core::{Outline, Vector};
/// // A forklift: its reference point is 0.3 m before its rear.
/// let rectangle = Outline::<f64, 4>::rectangle(1.2, 0.3, 0.4, 0.4, 0.0)?;
/// let rounded = Outline::<f64, 2>::capsule(Vector { x: -0.2, y: 0.0 }, Vector { x: 0.9, y: 0.0 }, 0.4)?;
/// assert!((rectangle.as_outline().reach() - 1.6_f64.sqrt()).abs() < 1e-12);
/// assert!((rounded.as_outline().reach() - 1.3).abs() < 1e-12);
/// # Ok::<(), pcr_core::InvalidInput>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Outline<S: Scalar, const N: usize> {
    /// Empty for a disc about the reference point.
    corners: Vec<Corner<S>, N>,
    radius: S,
    spread: S,
}

impl<S: Scalar, const N: usize> Outline<S, N> {
    /// Returns the disc of this radius \[m\] about the reference point.
    ///
    /// # Errors
    /// [`InvalidInput::NonFinite`], [`InvalidInput::OutOfRange`], [`InvalidInput::NonPositive`], [`InvalidInput::TooSmall`].
    pub fn disc(radius: S) -> Result<Self, InvalidInput> {
        error::radius(radius)?;
        Ok(Self { corners: Vec::new(), radius, spread: S::ZERO })
    }

    /// Returns the points within `radius` of the line between two points \[m\].
    ///
    /// # Errors
    /// As [`Outline::polygon`].
    pub fn capsule(from: Vector<S>, to: Vector<S>, radius: S) -> Result<Self, InvalidInput> {
        Self::polygon([from, to], radius)
    }

    /// Returns the rectangle that reaches so far ahead of the reference point, behind it, to its left and to its right
    /// \[m\], rounded by a radius on the outside. A negative number is a side that does not contain the reference point.
    ///
    /// # Errors
    /// As [`Outline::polygon`].
    pub fn rectangle(ahead: S, behind: S, left: S, right: S, radius: S) -> Result<Self, InvalidInput> {
        let corners = [(-behind, -right), (ahead, -right), (ahead, left), (-behind, left)];
        Self::polygon(corners.map(|(x, y)| Vector { x, y }), radius)
    }

    /// Returns the convex polygon with these corners \[m\], counter-clockwise, rounded by a radius on the outside. One corner makes
    /// a disc, two make a capsule.
    ///
    /// Cost: the square of the number of corners.
    ///
    /// # Errors
    /// [`InvalidInput::NonFinite`], [`InvalidInput::OutOfRange`], [`InvalidInput::Negative`] (radius); [`InvalidInput::Full`] for more than
    /// `N` corners; [`InvalidInput::NonPositive`] without corners, or for a single corner without a radius;
    /// [`InvalidInput::TooSmall`] for corners that are not distinct; [`InvalidInput::NotConvex`] if the corners do not turn left,
    /// once around a polygon without straight angles.
    pub fn polygon(corners: impl IntoIterator<Item = Vector<S>>, radius: S) -> Result<Self, InvalidInput> {
        const { assert!(N <= MOST_CORNERS, "an outline has at most 16 corners") };
        not_negative(radius, "radius of the outline")?;
        let mut all: Vec<Corner<S>, N> = Vec::new();
        let mut spread = S::ZERO;
        for at in corners {
            in_range(at.x, "x of a corner")?;
            in_range(at.y, "y of a corner")?;
            all.push(Corner { at, ..Corner::CENTRE }).map_err(|_| InvalidInput::Full("corner"))?;
            spread = spread.max(at.norm_squared().sqrt());
        }
        in_range(spread.double() + radius.double(), "size of the outline")?;
        // The root and its square are rounded, and turning a corner rounds it again.
        spread = if spread > S::ZERO { spread + S::rounding(spread) } else { spread };
        match all.as_slice() {
            [] => return Err(InvalidInput::NonPositive("number of corners")),
            [_] => error::radius(radius).map(|_| ())?,
            _ => lay(&mut all, S::rounding(spread).double())?,
        }
        if let [only] = all.as_slice()
            && only.at == Corner::<S>::CENTRE.at
        {
            all.clear();
        }
        Ok(Self { corners: all, radius, spread })
    }

    /// Returns the outline in the form that motions take.
    pub fn as_outline(&self) -> OutlineRef<'_, S> {
        OutlineRef { corners: &self.corners, radius: self.radius, spread: self.spread }
    }
}

/// Computes the edges of a polygon, and checks that it is convex: every other corner lies on the inner side of every
/// edge, by more than `least` \[m\]. This also excludes polygons that wind around twice.
fn lay<S: Scalar>(corners: &mut [Corner<S>], least: S) -> Result<(), InvalidInput> {
    let count = corners.len();
    for k in 0..count {
        let next = (if k.wrapping_add(1) == count { corners.first() } else { corners.get(k.wrapping_add(1)) })
            .map(|corner| corner.at);
        let (Some(next), Some(corner)) = (next, corners.get_mut(k)) else { continue };
        let edge = Vector { x: next.x - corner.at.x, y: next.y - corner.at.y };
        corner.length = edge.norm_squared().sqrt();
        if corner.length <= least {
            return Err(InvalidInput::TooSmall("edge of the outline"));
        }
        let [cos, sin] = S::unit_vector(edge.x, edge.y, corner.length);
        corner.outward = Direction { cos: sin, sin: -cos };
    }
    for (k, edge) in (0..corners.len()).zip(corners.iter()) {
        let ends = [k, if k.wrapping_add(1) == count { 0 } else { k.wrapping_add(1) }];
        for (_, other) in (0..corners.len()).zip(corners.iter()).filter(|(j, _)| !ends.contains(j)) {
            let apart = Vector { x: other.at.x - edge.at.x, y: other.at.y - edge.at.y };
            if apart.along(edge.outward) >= -least {
                return Err(InvalidInput::NotConvex);
            }
        }
    }
    Ok(())
}

/// An outline of any capacity, borrowed.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct OutlineRef<'a, S: Scalar> {
    /// Empty for a disc about the reference point.
    corners: &'a [Corner<S>],
    radius: S,
    spread: S,
}

impl<'a, S: Scalar> OutlineRef<'a, S> {
    /// Returns the outline with these corners, taken in their order from an outline that was checked: for a program that keeps the corners of
    /// many outlines in memory of its own, as [`PathRef::new`](crate::PathRef::new) does for segments.
    ///
    /// Cost: the square of the number of corners.
    ///
    /// # Errors
    /// As [`Outline::polygon`]; [`InvalidInput::Disconnected`] if they are not all corners of one outline.
    ///
    /// ```
    /// use pcr_core::{Outline, OutlineRef};
    /// let truck = Outline::<f64, 4>::rectangle(0.6, 0.6, 0.4, 0.4, 0.0)?;
    /// let mut kept = truck.as_outline().corners().to_vec();
    /// assert_eq!(OutlineRef::new(&kept, 0.0)?.reach(), truck.as_outline().reach());
    /// kept.swap(0, 1);
    /// assert!(OutlineRef::new(&kept, 0.0).is_err());
    /// # Ok::<(), pcr_core::InvalidInput>(())
    /// ```
    pub fn new(corners: &'a [Corner<S>], radius: S) -> Result<Self, InvalidInput> {
        if corners.is_empty() {
            return Ok(Self::disc(error::radius(radius)?));
        }
        let checked = Outline::<S, MOST_CORNERS>::polygon(corners.iter().map(|corner| corner.at), radius)?;
        if checked.corners.as_slice() == corners {
            Ok(Self { corners, radius, spread: checked.spread })
        } else {
            Err(InvalidInput::Disconnected("corner"))
        }
    }

    /// The outline with these corners, which were checked.
    pub(crate) const fn of(corners: &'a [Corner<S>], radius: S, spread: S) -> Self {
        Self { corners, radius, spread }
    }

    /// The disc of this radius about the reference point, which was checked.
    pub(crate) const fn disc(radius: S) -> Self {
        Self { corners: &[], radius, spread: S::ZERO }
    }

    /// Returns the corners of the polygon, counter-clockwise; none for a disc about the reference point.
    pub fn corners(self) -> &'a [Corner<S>] {
        self.corners
    }

    /// Returns the radius by which the polygon is rounded \[m\].
    pub fn radius(self) -> S {
        self.radius
    }

    /// Returns the radius of the disc about the reference point that contains the outline, rounded up \[m\].
    pub fn reach(self) -> S {
        self.radius + self.spread
    }

    /// The largest distance of a corner from the reference point, rounded up \[m\]; 0 for a disc.
    pub(crate) fn spread(self) -> S {
        self.spread
    }
}

impl<'a, S: Scalar, const N: usize> From<&'a Outline<S, N>> for OutlineRef<'a, S> {
    fn from(outline: &'a Outline<S, N>) -> Self {
        outline.as_outline()
    }
}

/// Whether the corner at this index of a polygon is the farthest one in a direction, by at most `by` \[m\]. Its neighbours
/// decide, because the polygon is convex.
pub(crate) fn supports<S: Scalar>(corners: &[Corner<S>], index: usize, direction: Direction<S>, by: S) -> bool {
    let before = if index == 0 { corners.last() } else { corners.get(index.wrapping_sub(1)) };
    let (Some(before), Some(corner)) = (before, corners.get(index)) else { return false };
    // Along the edge that leaves the corner, and backwards along the edge that arrives at it.
    corner.length.scale(corner.outward.cross(direction)) <= by
        && before.length.scale(-before.outward.cross(direction)) <= by
}

/// The opposite direction.
pub(crate) fn opposite<S: Scalar>(direction: Direction<S>) -> Direction<S> {
    Direction { cos: S::Unit::ZERO - direction.cos, sin: S::Unit::ZERO - direction.sin }
}

#[cfg(all(test, feature = "libm"))]
mod tests {
    use super::*;

    fn vectors<const N: usize>(corners: [(f64, f64); N]) -> [Vector<f64>; N] {
        corners.map(|(x, y)| Vector { x, y })
    }

    fn polygon<const N: usize>(corners: [(f64, f64); N]) -> Result<Outline<f64, 16>, InvalidInput> {
        Outline::polygon(vectors(corners), 0.1)
    }

    #[test]
    fn what_is_no_convex_polygon_is_refused_by_name() {
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        assert!(polygon(square).is_ok());
        let mut clockwise = square;
        clockwise.reverse();
        assert_eq!(polygon(clockwise).err(), Some(InvalidInput::NotConvex));
        assert_eq!(polygon([(0.0, 0.0), (1.0, 0.0), (0.2, 0.2), (0.0, 1.0)]).err(), Some(InvalidInput::NotConvex));
        assert_eq!(polygon([(0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (0.0, 1.0)]).err(), Some(InvalidInput::NotConvex));
        // A pentagram only turns left, but winds around twice.
        let star: [_; 5] = core::array::from_fn(|k| libm::sincos(core::f64::consts::TAU * 0.4 * k as f64));
        assert_eq!(polygon(star.map(|(y, x)| (x, y))).err(), Some(InvalidInput::NotConvex));
        assert_eq!(polygon([(0.0, 0.0), (0.0, 0.0)]).err(), Some(InvalidInput::TooSmall("edge of the outline")));
        assert_eq!(
            polygon([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 0.0)]).err(),
            Some(InvalidInput::TooSmall("edge of the outline"))
        );
        assert_eq!(polygon([]).err(), Some(InvalidInput::NonPositive("number of corners")));
        assert_eq!(polygon([(f64::NAN, 0.0)]).err(), Some(InvalidInput::NonFinite("x of a corner")));
        assert_eq!(Outline::<f64, 3>::polygon(vectors(square), 0.1).err(), Some(InvalidInput::Full("corner")));
        assert_eq!(
            Outline::<f64, 4>::polygon(vectors(square), -0.1).err(),
            Some(InvalidInput::Negative("radius of the outline"))
        );
        assert_eq!(
            Outline::<f64, 1>::polygon(vectors([(1.0, 0.0)]), 0.0).err(),
            Some(InvalidInput::NonPositive("radius"))
        );
        assert_eq!(Outline::<f64, 4>::disc(0.0).err(), Some(InvalidInput::NonPositive("radius")));
    }

    #[test]
    fn one_corner_at_the_reference_point_is_a_disc() {
        let disc = Outline::<f64, 1>::polygon(vectors([(0.0, 0.0)]), 0.3).unwrap();
        assert!(disc.as_outline().corners().is_empty() && disc.as_outline().reach() == 0.3);
        let beside = Outline::<f64, 1>::polygon(vectors([(3.0, 4.0)]), 0.5).unwrap();
        assert!(beside.as_outline().corners().len() == 1 && (beside.as_outline().reach() - 5.5).abs() < 1e-14);
    }

    #[test]
    fn edges_have_outward_normals_and_neighbours_decide_what_supports() {
        let outline = Outline::<f64, 4>::rectangle(1.0, 0.5, 0.25, 0.75, 0.0).unwrap();
        let corners = outline.as_outline().corners();
        let normals = [(0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)];
        for (corner, (cos, sin)) in corners.iter().zip(normals) {
            assert_eq!((corner.outward.cos, corner.outward.sin), (cos, sin));
        }
        for k in 0..720 {
            let (sin, cos) = libm::sincos(f64::from(k) * core::f64::consts::PI / 360.0 + 1e-3);
            let direction = Direction { cos, sin };
            let most = corners.iter().map(|corner| corner.at.along(direction)).fold(f64::MIN, f64::max);
            for (index, corner) in corners.iter().enumerate() {
                assert_eq!(supports(corners, index, direction, 0.0), corner.at.along(direction) >= most - 1e-12);
            }
        }
    }
}
