//! Collision regions in path-time space: what an agent must keep out of (Eq. 38).

use crate::error::is_no_number;
use crate::geometry::Interval;
use crate::intervals::union;
use crate::motion::Motion;
use crate::pair::Pair;
use crate::pair::footprint::Share;
use crate::pieces::List;
use crate::scalar::Scalar;
use crate::segment::{Curve, Segment};

/// One collision region of an ordered pair of agents: the connected set of (time, length along the path of
/// the *ego*) in which the ego's disc overlaps that of the *other* agent.
///
/// It contains the exact region of the combined radius and lies within the exact region of a radius that is larger by
/// [`RegionRef::excess`]: no collision is lost, whatever the number format. `docs/errors.md` derives the bound and names
/// the tests.
#[derive(Clone, Debug)]
pub struct RegionRef<'a, S: Scalar> {
    pair: Pair<'a, S>,
    pieces: List<'a, S>,
    agents: [usize; 2],
    /// Whether the ego is the second agent of the pair.
    transposed: bool,
}

/// One segment of the ego against one segment of the other: the part of a region that one closed form describes.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PieceRef<'a, S: Scalar> {
    /// Segment of the ego's path.
    pub ego: &'a Segment<S>,
    /// Segment of the other's path.
    pub other: &'a Segment<S>,
    /// Places of both segments in their paths.
    pub segments: [usize; 2],
    /// Length range along the ego's path \[m\].
    pub length: Interval<S>,
    /// Length range along the other's path \[m\].
    pub other_length: Interval<S>,
    /// Which of the intervals that are covered of the segment of the first agent of the pair, that of the lower index, it stands
    /// for.
    pub share: Share,
}

/// The types of Section 3.3 of the paper; the first letter is the ego's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum PieceType {
    /// Straight against straight.
    SS,
    /// Straight ego against an arc.
    SA,
    /// Ego on an arc against straight.
    AS,
    /// Arc against arc.
    AA,
}

impl PieceType {
    /// The type of a pair of shapes.
    pub fn of<S>(ego: Curve<S>, other: Curve<S>) -> Self {
        match (ego, other) {
            (Curve::Line, Curve::Line) => Self::SS,
            (Curve::Line, Curve::Arc { .. }) => Self::SA,
            (Curve::Arc { .. }, Curve::Line) => Self::AS,
            (Curve::Arc { .. }, Curve::Arc { .. }) => Self::AA,
        }
    }
}

impl core::fmt::Display for PieceType {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.pad(match self {
            Self::SS => "SS",
            Self::SA => "SA",
            Self::AS => "AS",
            Self::AA => "AA",
        })
    }
}

impl<S: Scalar> PieceRef<'_, S> {
    /// Type of the piece.
    pub fn piece_type(&self) -> PieceType {
        PieceType::of(self.ego.curve(), self.other.curve())
    }
}

#[cfg(feature = "defmt")]
impl<S: Scalar + defmt::Format> defmt::Format for RegionRef<'_, S> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "region of {} with {}: {} s, {} m", self.ego(), self.other(), self.time(), self.length());
    }
}

impl<'a, S: Scalar> RegionRef<'a, S> {
    pub(crate) fn new(pair: Pair<'a, S>, pieces: List<'a, S>, agents: [usize; 2], transposed: bool) -> Self {
        Self { pair, pieces, agents, transposed }
    }

    /// Index of the ego in the fleet.
    pub fn ego(&self) -> usize {
        self.agents[usize::from(self.transposed)]
    }

    /// Index of the other agent in the fleet.
    pub fn other(&self) -> usize {
        self.agents[usize::from(!self.transposed)]
    }

    /// The same region as the other agent sees it, which is then the ego.
    #[must_use]
    pub fn swapped(self) -> Self {
        Self { transposed: !self.transposed, ..self }
    }

    /// Length range along the ego's path \[m\], rounded outward.
    pub fn length(&self) -> Interval<S> {
        self.hull(self.transposed)
    }

    /// Length range along the other's path \[m\], rounded outward.
    pub fn other_length(&self) -> Interval<S> {
        self.hull(!self.transposed)
    }

    /// Time range \[s\], rounded outward: the other agent is then in [`RegionRef::other_length`].
    pub fn time(&self) -> Interval<S> {
        self.other_motion().time_in(self.other_length())
    }

    /// The bound ε of this region, [`excess`] of its pair \[m\].
    pub fn excess(&self) -> S {
        self.pair.excess()
    }

    /// What rounding may do to a distance \[m\].
    pub(crate) fn slack(&self) -> S {
        self.pair.slack
    }

    /// Whether the region begins with the other agent standing at its start: it then reaches back as a strip
    /// of constant slice.
    pub fn is_open_at_start(&self) -> bool {
        self.other_length().lo <= S::ZERO
    }

    /// Whether the region ends with the other agent standing at its end: it then goes on as a strip of
    /// constant slice.
    pub fn is_open_at_end(&self) -> bool {
        self.other_length().hi >= self.other_motion().path().length()
    }

    /// The lengths along the ego's path inside the region at a time \[m\], as disjoint intervals in increasing
    /// order, rounded outward. Before the other agent sets off and after its arrival this is the strip of the
    /// agent standing there. At a time that is no number it is all of the region.
    ///
    /// Cost: two to three times the pieces of the region, for each interval.
    pub fn slice_at(&self, time: S) -> impl Iterator<Item = Interval<S>> + Clone + use<'a, S> {
        // Intervals of neighbouring segments meet at the joint.
        union(self.intervals(self.other_motion().length_at(time)))
    }

    /// Whether the ego at this length of its path \[m\] overlaps the other agent at this time \[s\] in this region. What is no
    /// number cannot be told to be free.
    pub fn contains(&self, time: S, length: S) -> bool {
        is_no_number(length) || self.covers(length, self.other_motion().length_at(time))
    }

    /// Whether a length of the ego's path and one of the other's belong to the region.
    pub(crate) fn covers(&self, length: S, other_length: S) -> bool {
        self.intervals(other_length).any(|interval| interval.contains(length))
    }

    /// Points inside the region, as lengths of the ego's path and the other's; none where it is all but empty.
    pub(crate) fn inner_points(&self) -> impl Iterator<Item = [S; 2]> {
        let places = self.pieces().flat_map(|piece| {
            let Interval { lo, hi } = piece.other_length;
            let middle = piece.other_length.middle();
            [middle, Interval::new(lo, middle).middle(), Interval::new(middle, hi).middle()]
        });
        places.flat_map(|at| self.intervals(at).map(move |interval| [interval.middle(), at]))
    }

    /// The pieces, at least one.
    pub fn pieces(&self) -> impl Iterator<Item = PieceRef<'a, S>> + Clone + use<'a, S> {
        let (pair, transposed) = (self.pair, self.transposed);
        self.pieces.clone().filter_map(move |piece| {
            let indices = [usize::from(piece.first_segment), usize::from(piece.second_segment)];
            let first = pair.first.path().segments().get(indices[0])?;
            let second = pair.second.path().segments().get(indices[1])?;
            Some(if transposed {
                let segments = [indices[1], indices[0]];
                let share = piece.share;
                PieceRef { ego: second, other: first, segments, length: piece.second, other_length: piece.first, share }
            } else {
                PieceRef {
                    ego: first,
                    other: second,
                    segments: indices,
                    length: piece.first,
                    other_length: piece.second,
                    share: piece.share,
                }
            })
        })
    }

    /// The motion of the ego.
    pub fn ego_motion(&self) -> &'a Motion<'a, S> {
        if self.transposed { self.pair.second } else { self.pair.first }
    }

    /// The motion of the other agent.
    pub fn other_motion(&self) -> &'a Motion<'a, S> {
        if self.transposed { self.pair.first } else { self.pair.second }
    }

    /// Length range along the path of the first agent of the pair, or of the second.
    fn hull(&self, of_second: bool) -> Interval<S> {
        let mut parts = self.pieces.clone().map(|piece| if of_second { piece.second } else { piece.first });
        let first = parts.next().unwrap_or_default();
        parts.fold(first, Interval::hull)
    }

    /// The intervals of all pieces at a length of the other's path, in no order, overlapping where pieces do.
    fn intervals(&self, at: S) -> Slices<'a, S> {
        let Self { pair, ref pieces, transposed, .. } = *self;
        let range = self.length();
        // Of what is no number nothing can be told: no part of the region is free.
        Slices { pair, pieces: pieces.clone(), transposed, at, range, rest: is_no_number(at).then_some(range) }
    }
}

/// Iterator of [`RegionRef::intervals`].
#[derive(Clone, Debug)]
struct Slices<'a, S: Scalar> {
    pair: Pair<'a, S>,
    pieces: List<'a, S>,
    transposed: bool,
    at: S,
    /// Length range of the region.
    range: Interval<S>,
    /// The second interval of the last piece, or what is there whatever the pieces are.
    rest: Option<Interval<S>>,
}

impl<S: Scalar> Iterator for Slices<'_, S> {
    type Item = Interval<S>;

    // Adaptors make many copies of what they inline, and this is large.
    #[inline(never)]
    fn next(&mut self) -> Option<Interval<S>> {
        loop {
            let slice = match self.rest.take() {
                Some(slice) => slice,
                None => {
                    let (piece, at) = (self.pieces.next()?, self.at);
                    let slices = if self.transposed {
                        self.pair.slices_of_second(piece, at)
                    } else {
                        self.pair.slices_of_first(piece, at)
                    };
                    let [first, second] = slices;
                    self.rest = second;
                    let Some(first) = first else { continue };
                    first
                }
            };
            // Both are rounded outward; what they share is the better bound.
            if slice.meets(self.range) {
                return Some(slice.common(self.range));
            }
        }
    }
}

/// By how much the combined radius of two agents may seem larger than it is \[m\]: the bound ε on what rounding adds to
/// their regions, derived in `docs/errors.md`. Times have one of their own, [`Motion::time_excess`].
///
/// It depends on the number format and on the larger [`Motion::extent`]; in floating point also on the way that an agent
/// would go at its top speed in the whole time of its motion, in fixed point on the number of arcs. Neither the number of
/// lines or phases nor the start times count.
pub fn excess<S: Scalar>(first: &Motion<'_, S>, second: &Motion<'_, S>) -> S {
    Pair::new(first, second).excess()
}
