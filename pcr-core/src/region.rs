//! Collision regions in path-time space, which an agent must keep out of (Eq. 38).

use crate::error::is_no_number;
use crate::geometry::Interval;
use crate::intervals::union;
use crate::lap::Branch;
use crate::motion::Motion;
use crate::pair::AgentPair;
use crate::piece_store::{Piece, PieceList};
use crate::scalar::Scalar;
use crate::segment::{Curve, Segment};

/// One collision region of an ordered pair of agents: the connected set of (time, length along the path of
/// the *ego*) in which the ego's disc overlaps that of the *other* agent.
///
/// It contains the exact region for the sum of the radii R. Its slice at any length lies within the exact region for R +
/// [`RegionRef::excess`]; its first and last length may reach those of the exact region for R + 5/2 of it. So rounding never
/// hides a collision, in any number format. `docs/theory/errors.md` derives the bounds and names the tests.
#[derive(Clone, Debug)]
pub struct RegionRef<'a, S: Scalar> {
    pair: AgentPair<'a, S>,
    pieces: PieceList<'a, S>,
    agents: [usize; 2],
    /// Whether the ego is the second agent of the stored pair.
    transposed: bool,
}

/// A piece of a region: the part that belongs to one segment of the ego and one of the other agent, described by one
/// closed form.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PieceRef<'a, S: Scalar> {
    /// Segment of the ego's path.
    pub ego: &'a Segment<S>,
    /// Segment of the other agent's path.
    pub other: &'a Segment<S>,
    /// Indices of both segments in their paths.
    pub segments: [usize; 2],
    /// Range of lengths along the ego's path \[m\].
    pub length: Interval<S>,
    /// Range of lengths along the other agent's path \[m\].
    pub other_length: Interval<S>,
    /// The other disc can cover two intervals of a segment at once; this says which of them belongs to the piece. It
    /// refers to the segment of the agent with the lower index. It has no meaning for outlines.
    pub share: Branch,
    /// k and n: of the n intervals that the other outline covers at once of the segment of the agent with the lower index, the piece is the
    /// k-th, counted from 0. `None` for two discs that do not turn in place.
    pub rank: Option<[u8; 2]>,
}

/// Types of pieces (paper, Section 3.3); the first letter stands for the ego's segment. A turn in place counts as an arc.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum PieceType {
    /// Straight ego, straight other.
    SS,
    /// Straight ego, other on an arc.
    SA,
    /// Ego on an arc, straight other.
    AS,
    /// Both on arcs.
    AA,
}

impl PieceType {
    /// The type for these shapes of segments.
    pub fn of<S>(ego: Curve<S>, other: Curve<S>) -> Self {
        match (ego, other) {
            (Curve::Line, Curve::Line) => Self::SS,
            (Curve::Line, _) => Self::SA,
            (_, Curve::Line) => Self::AS,
            _ => Self::AA,
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
    pub(crate) fn new(pair: AgentPair<'a, S>, pieces: PieceList<'a, S>, agents: [usize; 2], transposed: bool) -> Self {
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

    /// Returns this region as the other agent sees it, which becomes the ego.
    #[must_use]
    pub fn swapped(self) -> Self {
        Self { transposed: !self.transposed, ..self }
    }

    /// Range of lengths along the ego's path \[m\], rounded outward.
    pub fn length(&self) -> Interval<S> {
        self.hull(self.transposed)
    }

    /// Range of lengths along the other agent's path \[m\], rounded outward.
    pub fn other_length(&self) -> Interval<S> {
        self.hull(!self.transposed)
    }

    /// Range of times \[s\] at which the other agent is in [`RegionRef::other_length`], rounded outward.
    pub fn time(&self) -> Interval<S> {
        self.other_motion().time_in(self.other_length())
    }

    /// Error bound ε of this region \[m\]: [`excess`] of its pair.
    pub fn excess(&self) -> S {
        self.pair.excess()
    }

    /// Bound on the rounding error of a distance \[m\].
    pub(crate) fn slack(&self) -> S {
        self.pair.slack
    }

    /// Whether the region begins while the other agent stands at its start. The lengths that are covered then are also
    /// covered at all earlier times.
    pub fn is_open_at_start(&self) -> bool {
        self.other_length().lo <= S::ZERO
    }

    /// Whether the region ends while the other agent stands at its end. The lengths that are covered then are also
    /// covered at all later times.
    pub fn is_open_at_end(&self) -> bool {
        self.other_length().hi >= self.other_motion().path().length()
    }

    /// Whether the ego can pass the region before the other agent, and after it. It cannot pass before if the region
    /// contains the end of its path or the start of the other's, and not after if the start of its path or the other's end.
    pub(crate) fn lets_pass(&self) -> [bool; 2] {
        let length = self.length();
        let before = length.hi < self.ego_motion().path().length() && !self.is_open_at_start();
        [before, length.lo > S::ZERO && !self.is_open_at_end()]
    }

    /// The lengths of the ego's path \[m\] that are inside the region at a time \[s\]: disjoint intervals in increasing
    /// order, rounded outward. Before the other agent sets off, they are those that it covers at its start; after its
    /// arrival, those that it covers at its end. If the time is NaN, the result is the whole length range of the
    /// region.
    ///
    /// Cost for each interval: two to three times the number of pieces of the region.
    pub fn slice_at(&self, time: S) -> impl Iterator<Item = Interval<S>> + Clone + use<'a, S> {
        // Intervals of neighbouring segments meet at the joint of the segments.
        union(self.intervals(self.other_motion().length_at(time)))
    }

    /// Whether, in this region, the ego at this length of its path \[m\] overlaps the other agent at this time \[s\].
    /// `true` if the length is NaN; if the time is, whether the length is in the range of the region.
    pub fn contains(&self, time: S, length: S) -> bool {
        is_no_number(length) || self.covers(length, self.other_motion().length_at(time))
    }

    /// Whether a length of the ego's path and a length of the other's path lie in the region.
    pub(crate) fn covers(&self, length: S, other_length: S) -> bool {
        self.intervals(other_length).any(|interval| interval.contains(length))
    }

    /// Points inside the region, as lengths of the ego's path and of the other's; none if the region is almost empty.
    pub(crate) fn inner_points(&self) -> impl Iterator<Item = [S; 2]> {
        let places = self.pieces().flat_map(|piece| {
            let Interval { lo, hi } = piece.other_length;
            let middle = piece.other_length.middle();
            [middle, Interval::new(lo, middle).middle(), Interval::new(middle, hi).middle()]
        });
        places.flat_map(|at| self.intervals(at).map(move |interval| [interval.middle(), at]))
    }

    /// The pieces of the region; there is at least one.
    pub fn pieces(&self) -> impl Iterator<Item = PieceRef<'a, S>> + Clone + use<'a, S> {
        let (pair, transposed) = (self.pair, self.transposed);
        self.pieces.clone().filter_map(move |piece| {
            let indices = [usize::from(piece.first_segment), usize::from(piece.second_segment)];
            let first = pair.first.path().segments().get(indices[0])?;
            let second = pair.second.path().segments().get(indices[1])?;
            let (share, rank) =
                if pair.has_outline() { (Branch::Only, Some(piece.rank())) } else { (piece.share(), None) };
            Some(if transposed {
                let segments = [indices[1], indices[0]];
                let (length, other_length) = (piece.second, piece.first);
                PieceRef { ego: second, other: first, segments, length, other_length, share, rank }
            } else {
                PieceRef {
                    ego: first,
                    other: second,
                    segments: indices,
                    length: piece.first,
                    other_length: piece.second,
                    share,
                    rank,
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

    /// Range of lengths along the path of the first agent of the pair, or of the second.
    fn hull(&self, of_second: bool) -> Interval<S> {
        let mut parts = self.pieces.clone().map(|piece| if of_second { piece.second } else { piece.first });
        let first = parts.next().unwrap_or_default();
        parts.fold(first, Interval::hull)
    }

    /// The intervals of all pieces at a length of the other's path: unordered, and overlapping where pieces overlap.
    fn intervals(&self, at: S) -> CrossSections<'a, S> {
        let Self { pair, ref pieces, transposed, .. } = *self;
        let range = self.length();
        // For NaN the whole range of the region is returned.
        let (rest, open) = (is_no_number(at).then_some(range), None);
        CrossSections { pair, pieces: pieces.clone(), transposed, at, range, rest, open }
    }
}

/// Iterator of [`RegionRef::intervals`].
#[derive(Clone, Debug)]
struct CrossSections<'a, S: Scalar> {
    pair: AgentPair<'a, S>,
    pieces: PieceList<'a, S>,
    transposed: bool,
    at: S,
    /// Range of lengths of the region.
    range: Interval<S>,
    /// The second interval of the last piece; at NaN the whole range.
    rest: Option<Interval<S>>,
    /// The last piece of a pair of outlines, and how many of its intervals were returned, if there are more.
    open: Option<(&'a Piece<S>, usize)>,
}

impl<S: Scalar> Iterator for CrossSections<'_, S> {
    type Item = Interval<S>;

    // Not inlined: iterator adaptors would copy this large function many times.
    #[inline(never)]
    fn next(&mut self) -> Option<Interval<S>> {
        loop {
            let slice = match self.rest.take() {
                Some(slice) => slice,
                None if self.pair.has_outline() => {
                    let (piece, index) = self.open.take().or_else(|| Some((self.pieces.next()?, 0)))?;
                    let (slice, more) = self.pair.part_at(piece, self.transposed, self.at, index);
                    self.open = more.then_some((piece, index.wrapping_add(1)));
                    let Some(slice) = slice else { continue };
                    slice
                }
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
            // Both are rounded outward, so their intersection is the tighter bound.
            if slice.meets(self.range) {
                return Some(slice.common(self.range));
            }
        }
    }
}

/// Error bound ε of the regions of two agents \[m\]: rounding makes a region look as if the sum of the radii were
/// larger, by ε at most. `docs/theory/errors.md` derives it. Times have a bound of their own, [`Motion::time_excess`].
///
/// ε depends on the number format and on the larger [`Motion::extent`]. In floating point it also depends on the
/// distance that an agent would go at its top speed during its whole motion, in fixed point on the number of arcs. It
/// does not depend on the number of lines or phases, or on start times.
pub fn excess<S: Scalar>(first: &Motion<'_, S>, second: &Motion<'_, S>) -> S {
    AgentPair::new(first, second).excess()
}
