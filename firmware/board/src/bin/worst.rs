//! Searches for the pairs of paths that take most instructions for each pair of their segments: changes a pair a little, keeps it if it takes no
//! less, and goes on from there. `check.sh` compares what is found with the bound of docs/maintain/firmware.md. QEMU must run with `ICOUNT=7`.
//!
//! A build with `PCR_WORST_ROUNDS=100` climbs a hundred times as often as `check.sh` has time for, and reports after every round.
#![no_std]
#![no_main]

use core::hint::black_box;
use pcr_board::courses::{self, Course, ONE, Random};
use pcr_board::meter::Meter;
use pcr_board::{AGENTS, Number, entry, out};
use pcr_core::scalar::Angle;
use pcr_core::{Curve, Ecm, EcmEntry, FleetMotions, FleetStorage, Limits, Piece, Point, Pose, Scalar};
use pcr_supervisor::dump::Line;
use pcr_supervisor::{Agent, Step, scenario};
use semihosting::process;
use static_cell::ConstStaticCell;

/// Segments of a path; climbs in a round, and changes in each.
const SIZES: [(usize, u32, u32); 4] = [(1, 64, 250), (2, 16, 250), (4, 6, 200), (8, 2, 150)];
/// Segments of two paths whose segments all meet, and room for them and for their pieces. A Cortex-M0 has 16 KiB of RAM.
const MANY: [usize; 2] = if cfg!(armv6m) { [5, 10] } else { [10, 24] };
const SEGMENTS: usize = if cfg!(armv6m) { scenario::SEGMENTS } else { 48 };
const PIECES: usize = if cfg!(armv6m) { scenario::PIECES } else { 576 };

type Storage = FleetStorage<'static, Number, { scenario::AGENTS }, SEGMENTS>;
type Table = Ecm<Number, [EcmEntry; scenario::REGIONS], [Piece<Number>; PIECES]>;

// The pairs of paths, and then the 12 agents.
static STORE: ConstStaticCell<Storage> = ConstStaticCell::new(Storage::new());
static TABLE: ConstStaticCell<Table> =
    ConstStaticCell::new(Ecm::new([EcmEntry::EMPTY; scenario::REGIONS], [Piece::EMPTY; PIECES]));

pcr_board::meter_interrupt!();

#[entry]
fn main() -> ! {
    process::exit(if run().is_some() { 0 } else { 1 })
}

fn run() -> Option<()> {
    let (store, table) = (STORE.try_take()?, TABLE.try_take()?);
    let mut search = Search { meter: Meter::new(), store, table, random: Random::new(), too_large: 0 };
    let mut longest = [0_u32; SIZES.len()];
    for _ in 0..courses::rounds()? {
        for ((size, climbs, changes), most) in SIZES.into_iter().zip(&mut longest) {
            for _ in 0..climbs {
                *most = search.climb(size, changes)?.max(*most);
            }
        }
        search.report(longest)?;
    }
    Some(())
}

fn per_pair(count: u32, pairs: u32) -> Option<u32> {
    count.saturating_add(pairs.saturating_sub(1)).checked_div(pairs)
}

/// Instructions of the table of the 12 agents, and the pairs of segments of any two of them.
#[inline(never)]
fn twelve(meter: &Meter, store: &mut Storage, table: &mut Table) -> Option<(u32, u32)> {
    store.clear();
    table.clear();
    AGENTS.iter().try_for_each(|agent| agent.add_to(store).map(drop)).ok()?;
    let mut fleet = FleetMotions::new();
    fleet.fill(store);
    let (mut took, mut pairs, mut before) = (0_u32, 0_u32, 0_u32);
    for (agent, built_in) in AGENTS.iter().enumerate() {
        let motions = fleet.get(..=agent)?;
        let (count, inserted) = meter.count(|| table.insert(black_box(motions), agent));
        inserted.ok()?;
        let segments = built_in.path.len() as u32;
        pairs = pairs.saturating_add(segments.saturating_mul(before));
        (took, before) = (took.saturating_add(count), before.saturating_add(segments));
    }
    Some((took, pairs))
}

struct Search {
    meter: Meter,
    store: &'static mut Storage,
    table: &'static mut Table,
    random: Random,
    /// Pairs that the table had no room for.
    too_large: u32,
}

impl Search {
    fn report(&mut self, longest: [u32; SIZES.len()]) -> Option<()> {
        for ((size, ..), most) in SIZES.into_iter().zip(longest) {
            let pairs = size.saturating_mul(size) as u32;
            let what = Line::default().integer(per_pair(most, pairs)?, 9);
            let what = what.text(b"  instructions a pair of segments: two paths of ");
            out::print(what.integer(size as u32, 0).text(b", the longest found\n").as_bytes());
        }
        for size in MANY {
            let pairs = size.saturating_mul(size) as u32;
            let line = Line::default().integer(per_pair(self.many(size)?, pairs)?, 9);
            let line = line.text(b"  instructions a pair of segments: two paths of ").integer(size as u32, 0);
            out::print(line.text(b" that meet everywhere\n").as_bytes());
        }
        let (took, pairs) = twelve(&self.meter, self.store, self.table)?;
        let line = Line::default().integer(per_pair(took, pairs)?, 9);
        out::print(line.text(b"  instructions a pair of segments: table of all agents\n").as_bytes());
        let line = Line::default().integer(self.too_large, 9);
        out::print(line.text(b"  pairs of paths in this search that the table has no room for\n").as_bytes());
        Some(())
    }

    /// The most instructions that a pair of paths takes on one climb.
    fn climb(&mut self, size: usize, changes: u32) -> Option<u32> {
        let mut pair = [self.random.course(), self.random.course()];
        let mut most = self.count(&pair, size)?;
        for _ in 0..changes {
            let mut other = pair;
            for _ in 0..=self.random.below(1) {
                let course = other.get_mut(self.random.below(1) as usize)?;
                self.random.change(course, size, false);
            }
            let count = self.count(&other, size)?;
            if count >= most {
                (pair, most) = (other, count);
            }
        }
        Some(most)
    }

    /// Instructions of the regions of two paths; 0 if the table has no room for them.
    fn count(&mut self, pair: &[Course; 2], size: usize) -> Option<u32> {
        self.store.clear();
        self.table.clear();
        for course in pair {
            course.add(self.store, size).ok()?;
        }
        self.insert()
    }

    /// Instructions of the regions of two paths of this many lines, each of which is within reach of all lines of the other path.
    fn many(&mut self, size: usize) -> Option<u32> {
        self.store.clear();
        self.table.clear();
        let length = ONE.half().half().half().half().half();
        let steps = [Step { curve: Curve::Line, length }; if cfg!(armv6m) { 10 } else { 24 }];
        for east in [ONE, Number::ZERO] {
            let heading = <Number as Scalar>::Angle::atan2(ONE - east, east);
            let start = Pose { position: Point::new(Number::ZERO, Number::ZERO), heading };
            let limits = Limits { speed: ONE, acceleration: ONE };
            let agent = Agent { radius: ONE, start_time: Number::ZERO, limits, start, path: steps.get(..size)? };
            agent.add_to(self.store).ok()?;
        }
        self.insert().filter(|_| self.table.pieces() == size.saturating_mul(size))
    }

    /// Instructions of the regions of the two paths in the storage; 0 if the table has no room for them.
    fn insert(&mut self) -> Option<u32> {
        let mut motions = FleetMotions::new();
        motions.fill(self.store);
        self.table.insert(motions.get(..1)?, 0).ok()?;
        let table = &mut *self.table;
        let (count, inserted) = self.meter.count(|| table.insert(black_box(&motions), 1));
        if inserted.is_ok() {
            return Some(count);
        }
        self.too_large = self.too_large.saturating_add(1);
        Some(0)
    }
}
