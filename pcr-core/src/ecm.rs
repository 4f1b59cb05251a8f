//! The extended collision map: all collision regions of a fleet, both directions of every pair.

mod fill;
#[cfg(feature = "std")]
mod grow;
mod known;

use crate::error::{Full, Mismatch, Unchanged};
use crate::motion::Motion;
use crate::pair::Pair;
use crate::pieces::{List, NONE, Piece, Pieces};
use crate::region::RegionRef;
use crate::scalar::Scalar;
use known::Known;

/// Entry of the table: a region of an unordered pair of agents. 8 bytes.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Region {
    /// The pair, lower index first.
    agents: [u16; 2],
    /// First of its pieces.
    head: u32,
}

const _: () = assert!(size_of::<Region>() == 8, "the documented size of an entry");

impl Region {
    /// A free entry, to fill a storage with.
    pub const EMPTY: Self = Self { agents: [0; 2], head: NONE };

    // Called for each region of a table that is searched.
    #[inline]
    fn agents(self) -> [usize; 2] {
        self.agents.map(usize::from)
    }
}

impl Default for Region {
    fn default() -> Self {
        Self::EMPTY
    }
}

/// Fixed-capacity table of the collision regions of a fleet: the paper's extended collision map (Section 3.1), in
/// which every agent, the one of the highest priority included, finds its regions with every other.
///
/// The storage is the caller's: arrays (`[Region; R]`, `[Piece<S>; P]`), mutable slices or, on a host, vectors.
/// A region is stored once for both directions of a pair, in coordination space; its times follow from the
/// motions when they are asked for. Hence a later start of an agent changes nothing in the table: shift its
/// [`Motion`] and go on.
///
/// The fleet itself is handed to each method, always the same one: another one is refused, by a checksum of the number of
/// agents, their paths and radii. Start times, profiles, margins and lateness may change. [`Ecm::replace`] exchanges one agent,
/// [`Ecm::insert`] and [`Ecm::remove`] are for fleets that grow or shrink at their end. On a host, with the feature `std`, a table
/// over vectors makes room for itself: `Ecm::grown`.
///
/// ```
/// use pcr_core::{Ecm, Limits, Motion, Path, Piece, Point, Pose, Profile, Radians, Region};
/// let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(0.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let paths = [Path::<f64, 1>::starting_at(east)?.line(4.0)?, Path::starting_at(north)?.line(4.0)?];
/// let profile = Profile::rest_to_rest(4.0, Limits { speed: 1.0, acceleration: 1.0 })?;
/// let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0);
/// let fleet = [motion(paths[0].as_path())?, motion(paths[1].as_path())?];
///
/// let ecm = Ecm::build([Region::EMPTY; 4], [Piece::EMPTY; 4], &fleet)?;
/// let region = ecm.row(&fleet, 0)?.next().unwrap();
/// assert_eq!(region.other(), 1);
/// let (time, length) = (region.time(), region.length());
/// assert!((time.lo - 2.0).abs() < 1e-9 && (time.hi - 3.0).abs() < 1e-9);
/// assert!((length.lo - 1.5).abs() < 1e-9 && (length.hi - 2.5).abs() < 1e-9);
/// assert!(region.contains(2.5, 2.4) && !region.contains(2.1, 2.4));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Ecm<S, R, P> {
    /// Sorted by the pair; regions of one pair in the order of their first pieces along the second path.
    regions: R,
    len: usize,
    pieces: Pieces<S, P>,
    fleet: Known,
    /// The agent whose regions these are, if they are those of one.
    only: Option<usize>,
}

#[cfg(feature = "defmt")]
impl<S: Scalar, R, P> defmt::Format for Ecm<S, R, P> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "table of {} regions in {} pieces", self.len(), self.pieces());
    }
}

impl<S: Scalar, R, P> Ecm<S, R, P> {
    /// The table of a fleet without agents.
    pub const fn new(regions: R, pieces: P) -> Self {
        Self { regions, len: 0, pieces: Pieces::new(pieces), fleet: Known::NOBODY, only: None }
    }

    /// Forgets all regions and all agents.
    pub fn clear(&mut self) {
        self.pieces.clear();
        (self.len, self.fleet, self.only) = (0, Known::NOBODY, None);
    }

    /// Number of regions stored; each counts for both directions of its pair.
    pub const fn len(&self) -> usize {
        self.len
    }

    /// Whether there are no regions.
    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Number of pieces stored.
    pub const fn pieces(&self) -> usize {
        self.pieces.len()
    }
}

impl<S: Scalar, R: AsRef<[Region]>, P: AsRef<[Piece<S>]>> Ecm<S, R, P> {
    /// The regions of all ordered pairs, by the ego, then by the other agent. O(agents × regions).
    ///
    /// # Errors
    /// [`Mismatch::OtherFleet`], [`Mismatch::OnlyRow`].
    pub fn regions<'a>(
        &'a self,
        fleet: &'a [Motion<'a, S>],
    ) -> Result<impl Iterator<Item = RegionRef<'a, S>>, Mismatch> {
        self.holds_all(fleet)?;
        Ok((0..fleet.len()).flat_map(move |ego| self.of(fleet, ego)))
    }

    /// The regions that an agent has to keep out of, by the other agent. O(agents + regions).
    ///
    /// # Errors
    /// [`Mismatch`]: none is an answer.
    pub fn row<'a>(
        &'a self,
        fleet: &'a [Motion<'a, S>],
        ego: usize,
    ) -> Result<impl Iterator<Item = RegionRef<'a, S>> + Clone, Mismatch> {
        self.holds(fleet, [ego, ego])?;
        Ok(self.of(fleet, ego))
    }

    /// The regions that an agent has with another one. O(agents + log regions).
    ///
    /// # Errors
    /// As [`Ecm::row`].
    pub fn pair<'a>(
        &'a self,
        fleet: &'a [Motion<'a, S>],
        ego: usize,
        other: usize,
    ) -> Result<impl Iterator<Item = RegionRef<'a, S>> + Clone, Mismatch> {
        self.holds(fleet, [ego, other])?;
        let agents = [ego.min(other), ego.max(other)];
        let begin = self.entries().partition_point(|region| region.agents() < agents);
        let entries = self.entries().iter().skip(begin).take_while(move |region| region.agents() == agents);
        Ok(entries.filter_map(move |region| self.view(fleet, region, ego)))
    }

    /// Whether this is the table of the fleet.
    fn check(&self, fleet: &[Motion<'_, S>]) -> Result<(), Mismatch> {
        if self.fleet == Known::all(fleet) { Ok(()) } else { Err(Mismatch::OtherFleet) }
    }

    /// Whether the table tells of all agents of the fleet.
    pub(crate) fn holds_all(&self, fleet: &[Motion<'_, S>]) -> Result<(), Mismatch> {
        self.check(fleet)?;
        self.only.map_or(Ok(()), |only| Err(Mismatch::OnlyRow(only)))
    }

    /// Whether the table tells of two agents of the fleet, or of all regions of one.
    pub(crate) fn holds(&self, fleet: &[Motion<'_, S>], agents: [usize; 2]) -> Result<(), Mismatch> {
        self.check(fleet)?;
        if let Some(agent) = agents.into_iter().find(|&agent| agent >= fleet.len()) {
            return Err(Mismatch::NoSuchAgent(agent));
        }
        match self.only {
            Some(only) if !agents.contains(&only) => Err(Mismatch::OnlyRow(only)),
            _ => Ok(()),
        }
    }

    fn of<'a>(&'a self, fleet: &'a [Motion<'a, S>], ego: usize) -> impl Iterator<Item = RegionRef<'a, S>> + Clone {
        // In the order of the entries, those of lower partners come first and in order, then those of higher ones.
        let entries = self.entries().iter().filter(move |region| region.agents().contains(&ego));
        entries.filter_map(move |region| self.view(fleet, region, ego))
    }

    /// The places of an agent's regions in the table, with their pairs.
    pub(crate) fn places(&self, ego: usize) -> impl Iterator<Item = (usize, [usize; 2])> {
        let pairs = self.entries().iter().map(|region| region.agents()).enumerate();
        pairs.filter(move |(_, agents)| agents.contains(&ego))
    }

    /// The agents of the region in a place of the table.
    pub(crate) fn agents_at(&self, place: usize) -> Option<[usize; 2]> {
        self.entries().get(place).map(|region| region.agents())
    }

    /// The region in a place of the table, as one of its agents sees it.
    pub(crate) fn at<'a>(&'a self, fleet: &'a [Motion<'a, S>], place: usize, ego: usize) -> Option<RegionRef<'a, S>> {
        self.view(fleet, self.entries().get(place)?, ego)
    }

    fn view<'a>(&'a self, fleet: &'a [Motion<'a, S>], region: &Region, ego: usize) -> Option<RegionRef<'a, S>> {
        let agents = region.agents();
        let pair = Pair::new(fleet.get(agents[0])?, fleet.get(agents[1])?);
        Some(RegionRef::new(pair, List::new(self.pieces.slots(), region.head), agents, agents[1] == ego))
    }

    fn entries(&self) -> &[Region] {
        self.regions.as_ref().get(..self.len).unwrap_or_default()
    }
}

impl<S, R, P> Ecm<S, R, P>
where
    S: Scalar,
    R: AsRef<[Region]> + AsMut<[Region]>,
    P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>,
{
    /// The table of a whole fleet of at most 65535 agents.
    ///
    /// Cost: a box test a pair of agents, and a few hundred operations a pair of segments that meet.
    ///
    /// # Errors
    /// [`Full`] where the storage is too small.
    pub fn build(regions: R, pieces: P, fleet: &[Motion<'_, S>]) -> Result<Self, Full> {
        let mut ecm = Self::new(regions, pieces);
        ecm.fill(fleet).map(|()| ecm)
    }

    /// Becomes the table of a whole fleet, as [`Ecm::build`], in the storage that it has.
    ///
    /// # Errors
    /// [`Full`] where the storage is too small; the table is then that of nobody.
    pub fn fill(&mut self, fleet: &[Motion<'_, S>]) -> Result<(), Full> {
        self.compute(fleet, |ecm| {
            (0..fleet.len()).try_for_each(|agent| ecm.add_pairs(fleet, agent, agent.saturating_add(1)..fleet.len()))
        })
    }

    /// Becomes a table of the regions of one agent with all others only, in the storage that it has. It answers for that agent.
    ///
    /// # Errors
    /// [`Full`] where the storage is too small; the table is then that of nobody.
    pub fn fill_row(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), Full> {
        self.compute(fleet, |ecm| ecm.add_row(fleet, agent))?;
        self.only = Some(agent);
        Ok(())
    }

    /// Adds the regions of one agent with all others of the fleet, whose table this is but for that agent: the last one, of a
    /// fleet that has grown, or one that was removed.
    ///
    /// # Errors
    /// [`Full`] where the storage is too small, and [`Mismatch`], also for an agent that the table has already; the table is then
    /// as it was.
    pub fn insert(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), Unchanged> {
        let own = fleet.get(agent).ok_or(Mismatch::NoSuchAgent(agent))?;
        let known = Known::all(fleet);
        if self.only.is_some() || self.fleet != known.without(agent, own) {
            return Err(Mismatch::OtherFleet.into());
        }
        self.add_row(fleet, agent)?;
        self.fleet = known;
        Ok(())
    }

    /// Removes one agent, with its regions. The table answers again when it is inserted again, or, after the last one, for a fleet
    /// without it. O(agents + regions).
    ///
    /// # Errors
    /// [`Mismatch`].
    pub fn remove(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), Mismatch> {
        self.holds_all(fleet)?;
        let own = fleet.get(agent).ok_or(Mismatch::NoSuchAgent(agent))?;
        self.take_out(agent);
        self.fleet = self.fleet.without(agent, own);
        Ok(())
    }

    /// Removes one agent for good, with its regions: those behind it move up by one number, and the table is that of the fleet
    /// without it. O(agents + regions).
    ///
    /// # Errors
    /// As [`Ecm::remove`].
    pub fn erase(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), Mismatch> {
        self.remove(fleet, agent)?;
        for region in self.regions.as_mut().iter_mut().take(self.len) {
            region.agents = region.agents.map(|other| other.wrapping_sub(u16::from(usize::from(other) > agent)));
        }
        let rest = [fleet.get(..agent), fleet.get(agent.saturating_add(1)..)];
        self.fleet = Known::all(rest.into_iter().flatten().flatten());
        Ok(())
    }

    /// Exchanges the motion of one agent and computes its regions anew; those of the others are not touched.
    ///
    /// # Errors
    /// [`Full`] where the storage is too small, and [`Mismatch`]; the fleet and the table are then as they were.
    pub fn replace<'m>(
        &mut self,
        fleet: &mut [Motion<'m, S>],
        agent: usize,
        motion: Motion<'m, S>,
    ) -> Result<(), Unchanged> {
        self.holds(fleet, [agent, agent])?;
        let Some(place) = fleet.get_mut(agent) else {
            return Err(Mismatch::NoSuchAgent(agent).into());
        };
        let before = core::mem::replace(place, motion);
        self.take_out(agent);
        let outcome = self.add_row(fleet, agent);
        if outcome.is_err()
            && let Some(place) = fleet.get_mut(agent)
        {
            // What was there fits: it is the same computation on the same motions.
            *place = before;
            self.add_row(fleet, agent)?;
        }
        self.fleet = Known::all(&*fleet);
        Ok(outcome?)
    }
}
