//! The extended collision map: the table of all collision regions of a fleet, for both directions of every pair.

mod fill;
mod fleet_checksum;
#[cfg(feature = "alloc")]
#[cfg_attr(docsrs, doc(cfg(feature = "alloc")))]
mod vec_storage;

use crate::error::{CapacityError, EcmError, MismatchError};
use crate::motion::Motion;
use crate::pair::AgentPair;
use crate::piece_store::{NONE, Piece, PieceList, PieceStore};
use crate::region::RegionRef;
use crate::scalar::Scalar;
use fleet_checksum::FleetChecksum;

/// An entry of the table [`Ecm`]: one region of an unordered pair of agents. 8 bytes.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EcmEntry {
    /// The pair, lower index first.
    agents: [u16; 2],
    /// Index of the first piece of the region.
    head: u32,
}

const _: () = assert!(size_of::<EcmEntry>() == 8, "the documented size of an entry");

impl EcmEntry {
    /// An unused entry, to fill the storage of a table with.
    pub const EMPTY: Self = Self { agents: [0; 2], head: NONE };

    // Called for every region of the table in a search.
    #[inline]
    fn agents(self) -> [usize; 2] {
        self.agents.map(usize::from)
    }
}

/// Numbers of regions and pieces of a table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EcmCapacity {
    /// Number of regions, each for both directions of its pair.
    pub regions: usize,
    /// Number of pieces.
    pub pieces: usize,
}

impl Default for EcmEntry {
    fn default() -> Self {
        Self::EMPTY
    }
}

/// Table of the collision regions of a fleet, of fixed capacity: the paper's extended collision map (Section 3.1). It
/// has the regions of every agent with every other one, also those of the agent with the highest priority.
///
/// The caller provides the storage: arrays (`[EcmEntry; R]`, `[Piece<S>; P]`), mutable slices or, on a host, vectors. A
/// region is stored once for both directions of a pair, in coordination space; its times are computed from the motions
/// at each query. Hence the table does not change when an agent starts later: pass its delayed [`Motion`] to the next
/// query.
///
/// Every method takes the fleet as an argument and refuses a fleet other than that of the table. It compares a checksum
/// of the number of agents, their paths, their radii and the lags for which the regions hold, which has 32 bits: it guards
/// against mistakes, and overlooks about one in two billion. Start times, margins and lateness may change, and so may
/// profiles ([`Motion::with_profile`]) as long as the [`Motion::lag`] does not grow.
///
/// A motion whose lag has grown (by a longer wait in floating point, or a profile that misses the end of its path by
/// more) is refused: the regions would be too small for it, or missing where the agents only came near. Give it to
/// [`Ecm::replace`], or the longest duration to [`Motion::with_longest`] before the table is made. A motion that is made
/// anew by [`Motion::new`] has the lag of its own profile, and is refused also where that is smaller.
///
/// [`Ecm::replace`] replaces one agent. [`Ecm::insert`] and [`Ecm::remove`] are for fleets to which agents are added,
/// or from which they are removed, at the end. On a host, with the feature `alloc`, a table that stores vectors can grow:
/// see `Ecm::grown`.
///
/// ```
/// use pcr_core::{Ecm, Limits, Motion, Path, Piece, Point, Pose, Profile, Radians, EcmEntry};
/// let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(0.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let paths = [Path::<f64, 1>::starting_at(east)?.line(4.0)?, Path::starting_at(north)?.line(4.0)?];
/// let profile = Profile::rest_to_rest(4.0, Limits { speed: 1.0, acceleration: 1.0 })?;
/// let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0);
/// let fleet = [motion(paths[0].as_path())?, motion(paths[1].as_path())?];
///
/// let ecm = Ecm::build([EcmEntry::EMPTY; 4], [Piece::EMPTY; 4], &fleet)?;
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
    /// Sorted by pair; regions of the same pair are in the order of their first pieces along the second path.
    regions: R,
    len: usize,
    pieces: PieceStore<S, P>,
    fleet: FleetChecksum,
    coverage: Coverage,
}

/// Which of the regions of its fleet a table holds.
#[derive(Clone, Copy, Debug)]
enum Coverage {
    /// All.
    All,
    /// Those of one agent ([`Ecm::fill_row`]).
    Row(usize),
    /// Those of all pairs before this one ([`Ecm::fill_pairs`]).
    Before([usize; 2]),
}

#[cfg(feature = "defmt")]
impl<S: Scalar, R, P> defmt::Format for Ecm<S, R, P> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "table of {} regions in {} pieces", self.len(), self.pieces());
    }
}

impl<S: Scalar, R, P> Ecm<S, R, P> {
    /// An empty table, for a fleet without agents.
    pub const fn new(regions: R, pieces: P) -> Self {
        Self { regions, len: 0, pieces: PieceStore::new(pieces), fleet: FleetChecksum::NOBODY, coverage: Coverage::All }
    }

    /// Removes all regions; the table is then that of a fleet without agents.
    pub fn clear(&mut self) {
        self.pieces.clear();
        (self.len, self.fleet, self.coverage) = (0, FleetChecksum::NOBODY, Coverage::All);
    }

    /// Number of regions stored; each one serves both directions of its pair.
    pub const fn len(&self) -> usize {
        self.len
    }

    /// Whether the table has no regions.
    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Number of pieces stored.
    pub const fn pieces(&self) -> usize {
        self.pieces.len()
    }
}

impl<S: Scalar, R: AsRef<[EcmEntry]>, P: AsRef<[Piece<S>]>> Ecm<S, R, P> {
    /// The regions of all ordered pairs, sorted by the ego, then by the other agent. O(agents × regions).
    ///
    /// # Errors
    /// [`MismatchError::OtherFleet`], [`MismatchError::OnlyRow`].
    pub fn regions<'a>(
        &'a self,
        fleet: &'a [Motion<'a, S>],
    ) -> Result<impl Iterator<Item = RegionRef<'a, S>>, MismatchError> {
        self.holds_all(fleet)?;
        Ok((0..fleet.len()).flat_map(move |ego| self.of(fleet, ego)))
    }

    /// Every region of the table once, seen by the agent with the lower index: sorted by this agent, then by the other
    /// one, which sees it as [`RegionRef::swapped`]. O(agents + regions), less than [`Ecm::regions`].
    ///
    /// # Errors
    /// [`MismatchError::OtherFleet`], [`MismatchError::OnlyRow`].
    pub fn regions_once<'a>(
        &'a self,
        fleet: &'a [Motion<'a, S>],
    ) -> Result<impl Iterator<Item = RegionRef<'a, S>> + Clone, MismatchError> {
        self.holds_all(fleet)?;
        Ok(self.entries().iter().filter_map(move |region| self.view(fleet, region, region.agents()[0])))
    }

    /// The regions of one agent, which it has to keep out of, sorted by the other agent. O(agents + regions).
    ///
    /// # Errors
    /// [`MismatchError`]. If there is no error, an empty iterator means that the agent has no regions.
    pub fn row<'a>(
        &'a self,
        fleet: &'a [Motion<'a, S>],
        ego: usize,
    ) -> Result<impl Iterator<Item = RegionRef<'a, S>> + Clone, MismatchError> {
        self.holds(fleet, [ego, ego])?;
        Ok(self.of(fleet, ego))
    }

    /// The regions of one agent in a plan: the motions of the fleet with other starts and profiles. Contacts deeper than
    /// [`Encounter::tolerance`](crate::Encounter::tolerance) are in these regions also where a lag is larger than the table allows for,
    /// as four times the lags are part of the tolerance.
    pub(crate) fn row_of_plan<'a>(
        &'a self,
        fleet: &[Motion<'_, S>],
        plan: &'a [Motion<'a, S>],
        ego: usize,
    ) -> Result<impl Iterator<Item = RegionRef<'a, S>> + Clone, MismatchError> {
        self.holds(fleet, [ego, ego])?;
        let mut both = fleet.iter().zip(plan);
        let is_same = fleet.len() == plan.len() && both.all(|(given, planned)| planned.is_same_disc(given));
        if is_same { Ok(self.of(plan, ego)) } else { Err(MismatchError::OtherFleet) }
    }

    /// The regions of the agent `ego` with the agent `other`. O(agents + log regions).
    ///
    /// # Errors
    /// As [`Ecm::row`].
    pub fn pair<'a>(
        &'a self,
        fleet: &'a [Motion<'a, S>],
        ego: usize,
        other: usize,
    ) -> Result<impl Iterator<Item = RegionRef<'a, S>> + Clone, MismatchError> {
        self.holds(fleet, [ego, other])?;
        let agents = [ego.min(other), ego.max(other)];
        let begin = self.entries().partition_point(|region| region.agents() < agents);
        let entries = self.entries().iter().skip(begin).take_while(move |region| region.agents() == agents);
        Ok(entries.filter_map(move |region| self.view(fleet, region, ego)))
    }

    /// Checks that this is the table of the fleet.
    fn check(&self, fleet: &[Motion<'_, S>]) -> Result<(), MismatchError> {
        if self.fleet == FleetChecksum::all(fleet) { Ok(()) } else { Err(MismatchError::OtherFleet) }
    }

    /// Checks that the table holds the regions of all agents of the fleet.
    pub(crate) fn holds_all(&self, fleet: &[Motion<'_, S>]) -> Result<(), MismatchError> {
        self.check(fleet)?;
        self.is_complete()
    }

    /// Checks that the table holds the regions of all agents of its fleet.
    pub(crate) fn is_complete(&self) -> Result<(), MismatchError> {
        match self.coverage {
            Coverage::All => Ok(()),
            Coverage::Row(only) => Err(MismatchError::OnlyRow(only)),
            Coverage::Before(_) => Err(MismatchError::Unfinished),
        }
    }

    /// Checks that the table holds the regions of these two agents, or, if both are the same, all regions of that
    /// agent.
    pub(crate) fn holds(&self, fleet: &[Motion<'_, S>], agents: [usize; 2]) -> Result<(), MismatchError> {
        self.check(fleet)?;
        if let Some(agent) = agents.into_iter().find(|&agent| agent >= fleet.len()) {
            return Err(MismatchError::NoSuchAgent(agent));
        }
        match self.coverage {
            Coverage::Row(only) if agents.contains(&only) => Ok(()),
            _ => self.is_complete(),
        }
    }

    fn of<'a>(&'a self, fleet: &'a [Motion<'a, S>], ego: usize) -> impl Iterator<Item = RegionRef<'a, S>> + Clone {
        // Entries are sorted by pair: partners with lower indices come first, in order, then those with higher ones.
        let entries = self.entries().iter().filter(move |region| region.agents().contains(&ego));
        entries.filter_map(move |region| self.view(fleet, region, ego))
    }

    /// The agents of the region at this index of the table.
    pub(crate) fn agents_at(&self, place: usize) -> Option<[usize; 2]> {
        self.entries().get(place).map(|region| region.agents())
    }

    /// The region at this index of the table, seen by one of its agents.
    pub(crate) fn at<'a>(&'a self, fleet: &'a [Motion<'a, S>], place: usize, ego: usize) -> Option<RegionRef<'a, S>> {
        self.view(fleet, self.entries().get(place)?, ego)
    }

    fn view<'a>(&'a self, fleet: &'a [Motion<'a, S>], region: &EcmEntry, ego: usize) -> Option<RegionRef<'a, S>> {
        let agents = region.agents();
        let pair = AgentPair::new(fleet.get(agents[0])?, fleet.get(agents[1])?);
        Some(RegionRef::new(pair, PieceList::new(self.pieces.slots(), region.head), agents, agents[1] == ego))
    }

    fn entries(&self) -> &[EcmEntry] {
        self.regions.as_ref().get(..self.len).unwrap_or_default()
    }
}

impl<S, R, P> Ecm<S, R, P>
where
    S: Scalar,
    R: AsRef<[EcmEntry]> + AsMut<[EcmEntry]>,
    P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>,
{
    /// Computes the table of a whole fleet of at most 65536 agents.
    ///
    /// Cost: a box test for each pair of agents, and a few hundred operations for each pair of segments that meet.
    ///
    /// # Errors
    /// [`CapacityError`] if the storage is too small.
    pub fn build(regions: R, pieces: P, fleet: &[Motion<'_, S>]) -> Result<Self, CapacityError> {
        let mut ecm = Self::new(regions, pieces);
        ecm.fill(fleet).map(|()| ecm)
    }

    /// Computes the table of a whole fleet, like [`Ecm::build`], in the existing storage.
    ///
    /// # Errors
    /// [`CapacityError`] if the storage is too small; the table is then empty, as after [`Ecm::clear`].
    pub fn fill(&mut self, fleet: &[Motion<'_, S>]) -> Result<(), CapacityError> {
        self.compute(fleet, |ecm| {
            (0..fleet.len()).try_for_each(|agent| ecm.add_pairs(fleet, agent, agent.saturating_add(1)..fleet.len()))
        })
    }

    /// Begins to compute the table of a whole fleet in parts, for a program that may not be busy for as long as [`Ecm::fill`] takes. Every
    /// call of [`Ecm::fill_pairs`] then continues. Until the last one, other methods refuse the table ([`MismatchError::Unfinished`]);
    /// [`Ecm::clear`] and those that fill the table begin anew.
    ///
    /// ```
    /// # use pcr_core::{Ecm, EcmEntry, MismatchError, Motion, Path, Piece, Point, Pose, Profile, Radians};
    /// # let stands = Path::<f64, 1>::starting_at(Pose { position: Point::new(0.0, 0.0), heading: Radians(0.0) })?;
    /// # let profile = Profile::<f64, 1>::standing();
    /// # let fleet = [Motion::new(stands.as_path(), profile.as_profile(), 0.25, 0.0)?; 5];
    /// let mut ecm = Ecm::new([EcmEntry::EMPTY; 16], [Piece::EMPTY; 16]);
    /// ecm.begin_fill(&fleet);
    /// while !ecm.fill_pairs(&fleet, 1)? {
    ///     // What cannot wait.
    ///     assert_eq!(ecm.row(&fleet, 0).err(), Some(MismatchError::Unfinished));
    /// }
    /// assert_eq!(ecm.row(&fleet, 0)?.count(), 4);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    pub fn begin_fill(&mut self, fleet: &[Motion<'_, S>]) {
        self.clear();
        (self.fleet, self.coverage) = (FleetChecksum::all(fleet), Coverage::Before([0, 1]));
    }

    /// Continues what [`Ecm::begin_fill`] has begun, with at most `pairs` pairs of agents. Returns whether the table is complete; it is then the
    /// one that [`Ecm::fill`] makes.
    ///
    /// Cost: for each pair a box test, and, where the boxes meet, a few hundred operations for each pair of segments that do.
    ///
    /// # Errors
    /// [`CapacityError`] if the storage is too small; the table is then empty, as after [`Ecm::clear`]. [`MismatchError::OtherFleet`] if the
    /// table is that of another fleet; it is then unchanged.
    pub fn fill_pairs(&mut self, fleet: &[Motion<'_, S>], pairs: usize) -> Result<bool, EcmError> {
        self.check(fleet)?;
        let Coverage::Before([mut agent, mut other]) = self.coverage else {
            return self.is_complete().map(|()| true).map_err(EcmError::from);
        };
        for _ in 0..pairs {
            if other >= fleet.len() {
                agent = agent.saturating_add(1);
                other = agent.saturating_add(1);
            }
            if other >= fleet.len() {
                break;
            }
            let after = other.saturating_add(1);
            if let Err(full) = self.add_pairs(fleet, agent, other..after) {
                self.clear();
                return Err(full.into());
            }
            other = after;
        }
        let is_complete = other >= fleet.len() && agent.saturating_add(2) >= fleet.len();
        self.coverage = if is_complete { Coverage::All } else { Coverage::Before([agent, other]) };
        Ok(is_complete)
    }

    /// Counts the regions and pieces that the table of a fleet takes. The pairs are counted one by one in the storage of this table, so
    /// it only has to have room for the pieces of the pair with the most of them, and for no regions. The table is then empty, as after
    /// [`Ecm::clear`].
    ///
    /// Cost: that of [`Ecm::fill`]. To pause in between, sum the numbers of two agents at a time.
    ///
    /// # Errors
    /// [`CapacityError::Pieces`] if a pair does not fit; [`CapacityError::Pair`], [`CapacityError::Agents`] and [`CapacityError::Contacts`]
    /// if no storage is large enough.
    ///
    /// ```
    /// # use pcr_core::{CapacityError, Ecm, EcmCapacity, EcmEntry, Motion, Path, Piece, Point, Pose, Profile, Radians};
    /// # let stands = Path::<f64, 1>::starting_at(Pose { position: Point::new(0.0, 0.0), heading: Radians(0.0) })?;
    /// # let profile = Profile::<f64, 1>::standing();
    /// # let fleet = [Motion::new(stands.as_path(), profile.as_profile(), 0.25, 0.0)?; 5];
    /// let mut ecm = Ecm::new([EcmEntry::EMPTY; 2], [Piece::EMPTY; 16]);
    /// assert_eq!(ecm.fill(&fleet), Err(CapacityError::Regions { needed: 3, capacity: 2 }));
    /// assert_eq!(ecm.needed(&fleet), Ok(EcmCapacity { regions: 10, pieces: 10 }));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn needed(&mut self, fleet: &[Motion<'_, S>]) -> Result<EcmCapacity, CapacityError> {
        self.clear();
        let mut all = EcmCapacity::default();
        for (agent, first) in (0..fleet.len()).zip(fleet) {
            for (other, second) in (0..fleet.len()).zip(fleet).skip(agent.saturating_add(1)) {
                if first.swept().meets(second.swept()) {
                    let EcmCapacity { regions, pieces } =
                        self.count_pair([agent, other], AgentPair::new(first, second))?;
                    all.regions = all.regions.saturating_add(regions);
                    all.pieces = all.pieces.saturating_add(pieces);
                }
            }
        }
        Ok(all)
    }

    /// Makes this table a copy of another one, in its own storage: to move a table to larger storage, or to hand it to another task while
    /// the next one is computed. O(regions + pieces).
    ///
    /// # Errors
    /// [`CapacityError::Regions`], [`CapacityError::Pieces`] if the storage is smaller than what the other table uses; this table is then unchanged.
    ///
    /// ```
    /// # use pcr_core::{Ecm, EcmEntry, Motion, Path, Piece, Point, Pose, Profile, Radians};
    /// # let stands = Path::<f64, 1>::starting_at(Pose { position: Point::new(0.0, 0.0), heading: Radians(0.0) })?;
    /// # let profile = Profile::<f64, 1>::standing();
    /// # let fleet = [Motion::new(stands.as_path(), profile.as_profile(), 0.25, 0.0)?; 2];
    /// let small = Ecm::build([EcmEntry::EMPTY; 1], [Piece::EMPTY; 1], &fleet)?;
    /// let mut large = Ecm::new([EcmEntry::EMPTY; 8], [Piece::EMPTY; 8]);
    /// large.copy_from(&small)?;
    /// assert_eq!(large.row(&fleet, 0)?.count(), 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn copy_from<R2, P2>(&mut self, other: &Ecm<S, R2, P2>) -> Result<(), CapacityError>
    where
        R2: AsRef<[EcmEntry]>,
        P2: AsRef<[Piece<S>]>,
    {
        let (room, used) = (self.regions.as_mut().iter_mut(), other.entries().iter());
        if room.len() < used.len() {
            return Err(CapacityError::Regions { needed: used.len(), capacity: room.len() });
        }
        self.pieces.copy_from(&other.pieces)?;
        room.zip(used).for_each(|(slot, entry)| *slot = *entry);
        (self.len, self.fleet, self.coverage) = (other.len, other.fleet, other.coverage);
        Ok(())
    }

    /// Computes the regions of one agent with all others, in the existing storage. The table can then be queried for
    /// that agent only.
    ///
    /// # Errors
    /// [`CapacityError`] if the storage is too small; the table is then empty, as after [`Ecm::clear`].
    /// [`MismatchError::NoSuchAgent`]; the table is then unchanged.
    pub fn fill_row(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), EcmError> {
        if agent >= fleet.len() {
            return Err(MismatchError::NoSuchAgent(agent).into());
        }
        self.compute(fleet, |ecm| ecm.add_row(fleet, agent))?;
        self.coverage = Coverage::Row(agent);
        Ok(())
    }

    /// Adds the regions of one agent with all others of the fleet. The table must be that of the same fleet without
    /// this agent: either the agent is new, at the end of the fleet, or it was taken out by [`Ecm::remove`].
    ///
    /// # Errors
    /// [`CapacityError`] if the storage is too small, and [`MismatchError`], also if the table has the agent already; the table is
    /// then unchanged.
    pub fn insert(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), EcmError> {
        let own = fleet.get(agent).ok_or(MismatchError::NoSuchAgent(agent))?;
        let known = FleetChecksum::all(fleet);
        self.is_complete()?;
        if self.fleet != known.without(agent, own) {
            return Err(MismatchError::OtherFleet.into());
        }
        self.add_row(fleet, agent)?;
        self.fleet = known;
        Ok(())
    }

    /// Removes the regions of one agent. Afterwards the table can be used again when the agent has been inserted again,
    /// or, if it was the last one of the fleet, for the fleet without it. O(agents + regions + pieces).
    ///
    /// # Errors
    /// [`MismatchError`].
    pub fn remove(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), MismatchError> {
        self.holds_all(fleet)?;
        let own = fleet.get(agent).ok_or(MismatchError::NoSuchAgent(agent))?;
        self.take_out(agent);
        self.fleet = self.fleet.without(agent, own);
        Ok(())
    }

    /// Removes one agent for good, with its regions. The index of every agent behind it decreases by one, and the table
    /// is then that of the fleet without the agent. O(agents + regions + pieces).
    ///
    /// # Errors
    /// As [`Ecm::remove`].
    pub fn erase(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), MismatchError> {
        self.remove(fleet, agent)?;
        for region in self.regions.as_mut().iter_mut().take(self.len) {
            region.agents = region.agents.map(|other| other.wrapping_sub(u16::from(usize::from(other) > agent)));
        }
        let rest = [fleet.get(..agent), fleet.get(agent.saturating_add(1)..)];
        self.fleet = FleetChecksum::all(rest.into_iter().flatten().flatten());
        Ok(())
    }

    /// Replaces the motion of one agent and computes its regions again; the regions between other agents are not
    /// touched.
    ///
    /// # Errors
    /// [`CapacityError`] if the storage is too small, and [`MismatchError`]; the fleet and the table are then unchanged.
    pub fn replace<'m>(
        &mut self,
        fleet: &mut [Motion<'m, S>],
        agent: usize,
        motion: Motion<'m, S>,
    ) -> Result<(), EcmError> {
        self.holds(fleet, [agent, agent])?;
        let Some(place) = fleet.get_mut(agent) else {
            return Err(MismatchError::NoSuchAgent(agent).into());
        };
        let before = core::mem::replace(place, motion);
        self.take_out(agent);
        let outcome = self.add_row(fleet, agent);
        if outcome.is_err()
            && let Some(place) = fleet.get_mut(agent)
        {
            // The old regions fit, as they are computed again from the same motions. If they did not, there would be no answer.
            *place = before;
            if self.add_row(fleet, agent).is_err() {
                self.clear();
                return Ok(outcome?);
            }
        }
        self.fleet = FleetChecksum::all(&*fleet);
        Ok(outcome?)
    }
}
