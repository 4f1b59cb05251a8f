//! The extended collision map: all collision regions of a fleet, both directions of every pair.

#[cfg(feature = "std")]
mod grow;

use crate::bits::{self, Ones};
use crate::error::{Full, Mismatch, Unchanged};
use crate::motion::Motion;
use crate::pair::Pair;
use crate::pieces::{List, NONE, Piece, Pieces};
use crate::region::RegionRef;
use crate::scalar::Scalar;
use crate::segment::ROW;
use core::cell::Cell;
use core::ops::Range;

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

/// The agents that a table knows: how many, and the sum of their checksums.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Known {
    agents: usize,
    sum: u32,
}

impl Known {
    const NOBODY: Self = Self { agents: 0, sum: 0 };

    fn all<'m, S: Scalar + 'm>(fleet: impl IntoIterator<Item = &'m Motion<'m, S>>) -> Self {
        (0_usize..).zip(fleet).fold(Self::NOBODY, |known, (agent, motion)| known.with(agent, motion))
    }

    fn with<S: Scalar>(self, agent: usize, motion: &Motion<'_, S>) -> Self {
        let sum = self.sum.wrapping_add(motion.digest(agent));
        Self { agents: self.agents.wrapping_add(1), sum }
    }

    fn without<S: Scalar>(self, agent: usize, motion: &Motion<'_, S>) -> Self {
        let sum = self.sum.wrapping_sub(motion.digest(agent));
        Self { agents: self.agents.wrapping_sub(1), sum }
    }
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
        let rest = (0..).zip(fleet).filter(|&(place, _): &(usize, _)| place != agent);
        self.fleet = Known::all(rest.map(|(_, motion)| motion));
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

    /// Computes all regions, or those of a row, of a fleet.
    fn compute(&mut self, fleet: &[Motion<'_, S>], add: impl Fn(&mut Self) -> Result<(), Full>) -> Result<(), Full> {
        self.clear();
        match add(self) {
            Ok(()) => self.fleet = Known::all(fleet),
            Err(full) => {
                self.clear();
                return Err(full);
            }
        }
        Ok(())
    }

    /// Adds the regions of an agent with all others, or nothing.
    fn add_row(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), Full> {
        let mut partners = [0..agent, agent.saturating_add(1)..fleet.len()].into_iter();
        let added = partners.try_for_each(|partners| self.add_pairs(fleet, agent, partners));
        if added.is_err() {
            self.take_out(agent);
        }
        added
    }

    /// Adds the regions of an agent with others, all of them before or after it in the fleet.
    fn add_pairs(&mut self, fleet: &[Motion<'_, S>], agent: usize, partners: Range<usize>) -> Result<(), Full> {
        let (Some(own), Some(others)) = (fleet.get(agent), fleet.get(partners.clone())) else {
            return Ok(());
        };
        let swept = own.swept();
        for (row, begin) in others.chunks(ROW).zip(partners.step_by(ROW)) {
            for place in Ones(bits::row(row.iter().map(|other| swept.meets(other.swept())))) {
                let (Some(other), partner) = (row.get(place as usize), begin.wrapping_add(place as usize)) else {
                    break;
                };
                let lower = partner < agent;
                let (agents, first, second) =
                    if lower { ([partner, agent], other, own) } else { ([agent, partner], own, other) };
                self.add_pair(agents, Pair::new(first, second))?;
            }
        }
        Ok(())
    }

    /// Where there is no room, some regions of the pair may stay behind: the caller takes out one of the agents, or all.
    fn add_pair(&mut self, agents: [usize; 2], pair: Pair<'_, S>) -> Result<(), Full> {
        if let Err(full) = pair.find(&mut self.pieces) {
            let no_storage_helps = self.pieces.pair_is_full();
            self.pieces.take_back();
            return Err(if no_storage_helps { Full::Pair(agents) } else { full });
        }
        if self.pieces.first_pending() == NONE {
            return Ok(());
        }
        // A table that is built from scratch grows at its end.
        let entries = self.entries();
        let at_end = entries.last().is_none_or(|last| last.agents() < agents);
        let mut index = if at_end { entries.len() } else { entries.partition_point(|region| region.agents() < agents) };
        while let Some(head) = self.pieces.take_region() {
            if let Err(full) = self.insert_entry(index, agents, head) {
                self.pieces.release(head);
                self.pieces.take_back();
                return Err(full);
            }
            // There is an entry at this index: no saturation.
            index = index.saturating_add(1);
        }
        Ok(())
    }

    fn insert_entry(&mut self, index: usize, agents: [usize; 2], head: u32) -> Result<(), Full> {
        let [Ok(first), Ok(second)] = agents.map(u16::try_from) else {
            return Err(Full::Agents);
        };
        let len = self.len.saturating_add(1);
        let behind = self.regions.as_mut().get_mut(index..len).ok_or(Full::Regions)?;
        // Every entry from here on moves up by one place.
        let places = Cell::from_mut(behind).as_slice_of_cells();
        for neighbours in places.windows(2).rev() {
            if let [place, next] = neighbours {
                next.set(place.get());
            }
        }
        if let Some(place) = places.first() {
            place.set(Region { agents: [first, second], head });
        }
        self.len = len;
        Ok(())
    }

    /// Removes the entries of an agent, and gives their pieces back.
    fn take_out(&mut self, agent: usize) {
        let mut kept = 0_usize;
        for index in 0..self.len {
            let regions = self.regions.as_mut();
            let Some(&region) = regions.get(index) else {
                break;
            };
            if region.agents().contains(&agent) {
                self.pieces.release(region.head);
            } else {
                if let Some(place) = regions.get_mut(kept) {
                    *place = region;
                }
                // Never above `index`: it cannot saturate, but the compiler does not see it.
                kept = kept.saturating_add(1);
            }
        }
        self.len = kept;
    }
}
