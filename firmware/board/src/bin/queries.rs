//! Searches for the fleets whose queries and orders take most instructions for each unit of the bounds in docs/maintain/firmware.md: changes
//! paths, speeds and start times a little, keeps what takes no less, and goes on from there. `check.sh` compares what is found with the
//! bounds. QEMU must run with `ICOUNT=7`.
//!
//! A build with `PCR_WORST_ROUNDS=100` climbs a hundred times as often as `check.sh` has time for, and reports after every round.
#![no_std]
#![no_main]

use core::hint::black_box;
use pcr_board::courses::{self, Course, ONE, Random};
use pcr_board::meter::Meter;
use pcr_board::{Number, entry, out};
use pcr_core::scalar::{Angle, Wide};
use pcr_core::{
    CheckState, CheckTolerances, Curve, EcmEntry, Encounter, FleetMotions, FleetStorage, Limits, Motion, PassingState,
    PathProposal, Piece, Point, Pose, PrecedenceTable, Progress, RegionPrecedence, Scalar, TurnSide,
    earliest_departure, earliest_start, first_conflict,
};
use pcr_supervisor::dump::Line;
use pcr_supervisor::{Agent, Step};
use semihosting::process;
use static_cell::ConstStaticCell;

/// Segments of a path; climbs in a round, and changes in each.
const SIZES: [(usize, u32, u32); 3] = [(1, 3, 120), (2, 2, 100), (4, 1, 100)];
/// Agents of a fleet, and one more path, which one of them gets.
const FLEET: usize = 3;
const PATHS: usize = FLEET + 1;
const REGIONS: usize = 32;
const PIECES: usize = 96;
const ORDERS: usize = 2 * REGIONS;

type Storage = FleetStorage<'static, Number, PATHS, { 4 * PATHS }>;
type Table = PrecedenceTable<Number, [EcmEntry; REGIONS], [Piece<Number>; PIECES], [RegionPrecedence<Number>; ORDERS]>;

static STORE: ConstStaticCell<Storage> = ConstStaticCell::new(Storage::new());
static TABLE: ConstStaticCell<Table> = ConstStaticCell::new(PrecedenceTable::new(
    [EcmEntry::EMPTY; REGIONS],
    [Piece::EMPTY; PIECES],
    [RegionPrecedence::EMPTY; ORDERS],
));

pcr_board::meter_interrupt!();

#[entry]
fn main() -> ! {
    process::exit(if run().is_some() { 0 } else { 1 })
}

#[derive(Clone, Copy)]
enum Query {
    Contacts,
    FirstConflict,
    ForbiddenDelays,
    EarliestStart,
    EarliestDeparture,
    Hold,
    Check,
    Admit,
}

impl Query {
    /// Of two paths one is changed, or of all four.
    const fn bits(self) -> u32 {
        if self.is_of_all() { 2 } else { 1 }
    }

    const fn is_of_all(self) -> bool {
        matches!(self, Self::Hold | Self::Check | Self::Admit)
    }

    const ALL: [(Self, &'static [u8]); 8] = [
        (Self::Contacts, b"Encounter::contacts"),
        (Self::FirstConflict, b"first_conflict"),
        (Self::ForbiddenDelays, b"RegionRef::forbidden_delays"),
        (Self::EarliestStart, b"earliest_start"),
        (Self::EarliestDeparture, b"earliest_departure"),
        (Self::Hold, b"PrecedenceTable::hold"),
        (Self::Check, b"PrecedenceTable::check"),
        (Self::Admit, b"PrecedenceTable::admit"),
    ];
}

fn run() -> Option<()> {
    let (store, table) = (STORE.try_take()?, TABLE.try_take()?);
    let mut search = Search { meter: Meter::new(), store, table, random: Random::new(), too_large: 0 };
    let mut longest = Query::ALL.map(|_| Cost::NONE);
    for _ in 0..courses::rounds()? {
        for ((query, _), most) in Query::ALL.into_iter().zip(&mut longest) {
            for (size, climbs, changes) in SIZES {
                for _ in 0..climbs {
                    *most = most.larger(search.climb(query, size, changes)?);
                }
            }
        }
        search.report(&longest)?;
    }
    Some(())
}

/// What a query took, and the units of its bound.
#[derive(Clone, Copy)]
struct Cost {
    count: u32,
    units: u32,
}

impl Cost {
    const NONE: Self = Self { count: 0, units: 1 };

    fn larger(self, other: Self) -> Self {
        let [own, their] =
            [[self.count, other.units], [other.count, self.units]].map(|[a, b]| u64::from(a).wrapping_mul(b.into()));
        if their >= own { other } else { self }
    }

    fn per_unit(self) -> Option<u32> {
        self.count.saturating_add(self.units.saturating_sub(1)).checked_div(self.units)
    }
}

struct Search {
    meter: Meter,
    store: &'static mut Storage,
    table: &'static mut Table,
    random: Random,
    /// Fleets that the table had no room for.
    too_large: u32,
}

impl Search {
    fn report(&mut self, longest: &[Cost]) -> Option<()> {
        for ((_, name), most) in Query::ALL.into_iter().zip(longest) {
            let line = Line::default().integer(most.per_unit()?, 9).text(b"  instructions a unit of ").text(name);
            out::print(line.text(b", the longest found\n").as_bytes());
        }
        let line = Line::default().integer(self.hovering()?.per_unit()?, 9);
        out::print(line.text(b"  instructions a unit of two that keep their distance\n").as_bytes());
        let line = Line::default().integer(self.too_large, 9);
        out::print(line.text(b"  fleets in this search that the table has no room for\n").as_bytes());
        Some(())
    }

    /// The largest cost on one climb.
    fn climb(&mut self, query: Query, size: usize, changes: u32) -> Option<Cost> {
        let mut paths = [(); PATHS].map(|()| self.random.course());
        let mut most = self.cost(query, &paths, size)?;
        for _ in 0..changes {
            let mut other = paths;
            for _ in 0..=self.random.below(1) {
                let path = other.get_mut(self.random.below(query.bits()) as usize)?;
                self.random.change(path, size, true);
            }
            let cost = self.cost(query, &other, size)?;
            if most.larger(cost).count == cost.count {
                (paths, most) = (other, cost);
            }
        }
        Some(most)
    }

    /// The cost of a query of the first agents; none if the table has no room for them.
    fn cost(&mut self, query: Query, paths: &[Course; PATHS], size: usize) -> Option<Cost> {
        self.store.clear();
        self.table.clear();
        for path in paths {
            path.add(self.store, size).ok()?;
        }
        let mut all = FleetMotions::new();
        all.fill(self.store);
        let (fleet, new) = all.split_at_mut_checked(FLEET)?;
        let used = if query.is_of_all() { fleet } else { fleet.get_mut(..2)? };
        if self.table.fill(used).is_err() {
            self.too_large = self.too_large.saturating_add(1);
            return Some(Cost::NONE);
        }
        if query.is_of_all() {
            orders(&self.meter, self.table, query, used, *new.first()?)
        } else {
            self.pair(query, used)
        }
    }

    /// The cost of a query about the first two agents.
    #[inline(never)]
    fn pair(&self, query: Query, fleet: &[Motion<'_, Number>]) -> Option<Cost> {
        let [ego, other] = fleet.first_chunk()?;
        let (encounter, row) = (Encounter::new(ego, other), self.table.ecm().row(fleet, 0).ok()?);
        let (search, pieces) = (units(ego, other), count(self.table.ecm().pieces()));
        let regions = count(self.table.ecm().len());
        let replan = search.saturating_add(pieces.saturating_mul(2)).saturating_mul(10);
        let (time, middle) = (encounter.time(), Scalar::half(ego.path().length()));
        let (count, units) = match query {
            Query::FirstConflict => {
                let first = || black_box(first_conflict(black_box(ego), row, time).is_ok());
                (self.meter.count(first).0, search.saturating_mul(regions.saturating_add(2)))
            }
            Query::ForbiddenDelays => {
                let mut most = 0_u32;
                for region in row {
                    most = most.max(self.meter.count(|| black_box(region.forbidden_delays())).0);
                }
                (most, replan)
            }
            Query::EarliestStart => {
                let start = || black_box(earliest_start(row, Number::default()));
                (self.meter.count(start).0, replan.saturating_mul(regions.max(1)))
            }
            Query::EarliestDeparture => {
                let departure = || black_box(earliest_departure(row, middle, Number::default()));
                (self.meter.count(departure).0, replan.saturating_mul(regions.max(1)))
            }
            _ => (self.meter.count(|| black_box(encounter.contacts(time).last())).0, search),
        };
        Some(Cost { count, units })
    }

    /// Two agents on arcs about one centre, side by side at a distance of the sum of their radii all the way, with the time for which
    /// they are as its own part of the bound.
    #[inline(never)]
    fn hovering(&mut self) -> Option<Cost> {
        self.store.clear();
        let (half, zero) = (Scalar::half(ONE), Number::default());
        for radius in [half, ONE] {
            let length = Scalar::half(<Number as Scalar>::Angle::circumference(radius).times(ONE).narrow());
            let path = &[Step { curve: Curve::Arc { radius, turn: TurnSide::Left }, length }];
            let heading = <Number as Scalar>::Angle::atan2(ONE, zero);
            let start = Pose { position: Point::new(radius, zero), heading };
            // Alike as seen from the centre.
            let limits = Limits { speed: radius, acceleration: radius };
            let agent = Agent { radius: Scalar::half(half), start_time: zero, limits, start, path: &path[..] };
            agent.add_to(self.store).ok()?;
        }
        let mut fleet = FleetMotions::new();
        fleet.fill(self.store);
        let [ego, other] = fleet.first_chunk()?;
        let encounter = Encounter::new(ego, other);
        let (count, _) = self.meter.count(|| black_box(encounter.contacts(encounter.time()).last()));
        // h = √(2 ε / c); both speed up by as much as their radii, and their speeds reach these.
        let change = Scalar::double(ONE + half);
        let tolerance = Scalar::double(encounter.tolerance());
        let rate = change.times(ONE).sqrt().quotient(tolerance.times(ONE).sqrt());
        let steps = pcr_supervisor::Number::thousandths(encounter.time().length().times(rate).narrow()).unsigned_abs();
        Some(Cost { count, units: units(ego, other).saturating_add(steps / 1000) })
    }
}

/// The cost of a query about the order of all agents, each of which lets those before it go first.
#[inline(never)]
fn orders<'m>(
    meter: &Meter,
    table: &mut Table,
    query: Query,
    fleet: &mut [Motion<'m, Number>],
    motion: Motion<'m, Number>,
) -> Option<Cost> {
    let zero = Number::default();
    for second in 0..FLEET {
        for first in 0..second {
            table.decide(fleet, second, first, PassingState::Second, zero).ok()?;
        }
    }
    // The others are on their way, where the hold is not just the begin of a piece.
    let (agent, mut progress) = (FLEET.saturating_sub(1), [Progress::at_rest(zero); FLEET]);
    for (place, motion) in progress.iter_mut().zip(&*fleet).take(agent) {
        *place = Progress::at_rest(Scalar::half(motion.path().length()));
    }
    // About a millimetre.
    let gain = (0..10).fold(ONE, |gain, _| Scalar::half(gain));
    let (tolerances, mut states) = (CheckTolerances { width: zero, gain }, [CheckState::EMPTY; FLEET]);
    let whole = |table: &Table| {
        let (pieces, regions) = (count(table.ecm().pieces()), count(table.ecm().len()));
        pieces.saturating_add(1).saturating_mul(regions.saturating_add(1)).saturating_mul(8)
    };
    let (count, units) = match query {
        Query::Hold => {
            let pieces = count(table.ecm().pieces());
            let hold = || black_box(table.hold(fleet, agent, &progress).is_ok());
            (meter.count(hold).0, pieces.saturating_add(1).saturating_mul(8))
        }
        Query::Check => {
            let units = whole(table);
            let check = || black_box(table.check(fleet, &progress, tolerances, &mut states).is_ok());
            (meter.count(check).0, units)
        }
        _ => {
            let size = |motion: &Motion<'_, Number>| count(motion.path().segments().len());
            let others = fleet.iter().take(agent).map(&size).fold(0_u32, u32::saturating_add);
            let tables = size(&motion).saturating_mul(others).saturating_mul(160);
            let proposal = PathProposal { agent, motion, progress: Progress::at_rest(zero) };
            let first = |_: &pcr_core::RegionRef<'_, Number>| PassingState::First;
            let before = whole(table);
            let (took, admitted) =
                meter.count(|| table.admit(fleet, &mut progress, proposal, tolerances, &mut states, first).is_ok());
            let checks = if admitted { whole(table) } else { before };
            (took, tables.saturating_add(checks))
        }
    };
    Some(Cost { count, units })
}

fn count(number: usize) -> u32 {
    number as u32
}

/// Units of a search for contacts of two motions: pairs of segments and stands, and the windows in which each is on one of its legs.
fn units(ego: &Motion<'_, Number>, other: &Motion<'_, Number>) -> u32 {
    let segments = [ego, other].map(|motion| count(motion.path().segments().len()).saturating_add(2));
    let phases = [ego, other].map(|motion| count(motion.profile().phases().len()));
    let windows = segments.into_iter().chain(phases).fold(0_u32, u32::saturating_add);
    let [own, their] = segments;
    own.saturating_mul(their).saturating_add(windows.saturating_mul(12))
}
