//! The library's whole pipeline and nothing else, for its size and its stack: constructors, the table of the 12 agents,
//! and what one asks of it. All storage is static.
#![no_std]
#![no_main]

use core::hint::black_box;
use pcr_board::{AGENTS, Number, entry};
use pcr_core::{CapacityError, Ecm, EcmEntry, FleetMotions, FleetStorage, Interval, InvalidInput, Motion, Piece};
use pcr_supervisor::scenario::{self, PIECES, REGIONS};
use pcr_supervisor::{Agent, Step};
use semihosting::process;
use static_cell::ConstStaticCell;

type Table = Ecm<Number, [EcmEntry; REGIONS], [Piece<Number>; PIECES]>;
type Storage = FleetStorage<'static, Number, { scenario::AGENTS }, { scenario::SEGMENTS }>;
type Fleet<'a> = FleetMotions<'a, Number, { scenario::AGENTS }>;
type BuiltIn = [Agent<Number, &'static [Step<Number>]>];

static STORE: ConstStaticCell<Storage> = ConstStaticCell::new(Storage::new());
static FLEET: ConstStaticCell<Fleet<'static>> = ConstStaticCell::new(Fleet::new());
static TABLE: ConstStaticCell<Table> =
    ConstStaticCell::new(Ecm::new([EcmEntry::EMPTY; REGIONS], [Piece::EMPTY; PIECES]));

// The table of the 12 agents, and what it may take (`check.sh` reads this from the build that succeeds).
const _: () = assert!(size_of::<Table>() <= 6 * 1024, "the budget of the table");

#[entry]
fn main() -> ! {
    let seen = match (STORE.try_take(), FLEET.try_take(), TABLE.try_take()) {
        (Some(store), Some(fleet), Some(table)) => job(store, fleet, table, black_box(&AGENTS)),
        _ => None,
    };
    process::exit(if seen == Some(2 * 68) { 0 } else { 1 })
}

/// The job whose stack counts.
#[inline(never)]
fn job<'a>(store: &'a mut Storage, fleet: &mut Fleet<'a>, table: &mut Table, agents: &BuiltIn) -> Option<usize> {
    construct(store, agents).ok()?;
    fleet.fill(store);
    build(table, fleet).ok()?;
    Some(ask(table, fleet))
}

#[inline(never)]
fn construct(store: &mut Storage, agents: &BuiltIn) -> Result<(), InvalidInput> {
    agents.iter().try_for_each(|agent| agent.add_to(store).map(|_| ()))
}

#[inline(never)]
fn build(table: &mut Table, fleet: &[Motion<'_, Number>]) -> Result<(), CapacityError> {
    table.fill(fleet)
}

#[inline(never)]
fn ask(table: &Table, fleet: &[Motion<'_, Number>]) -> usize {
    let mut regions = 0_usize;
    for region in table.regions(fleet).into_iter().flatten() {
        let (time, length): (Interval<Number>, Interval<Number>) = (region.time(), region.length());
        black_box((region.contains(time.lo, length.lo), region.slice_at(time.middle()).last()));
        regions = regions.saturating_add(1);
    }
    regions
}
