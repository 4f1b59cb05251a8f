//! Measures the stack of single calls: paints the free stack below the caller, calls, and looks how much was painted over. The frames of the
//! call count, those of its caller do not.
#![no_std]
#![no_main]

use core::hint::black_box;
use pcr_board::{AGENTS as BUILT_IN, Number, entry, out};
use pcr_core::{
    CheckState, CheckTolerances, EcmEntry, Encounter, FleetMotions, FleetStorage, Interval, Motion, PassingState,
    PathProposal, Piece, PrecedenceTable, Progress, RegionPrecedence, Scalar, earliest_departure, earliest_start,
    first_conflict, first_overlap, least_duration, safe_intervals, safe_lengths,
};
use pcr_supervisor::dump::Line;
use semihosting::process;
use static_cell::ConstStaticCell;

// The first 8 agents of the 12, and no more room than they need: on a Cortex-M0 the rest of 16 KiB is the stack that is measured.
const AGENTS: usize = 8;
const SEGMENTS: usize = 24;
const REGIONS: usize = 44;
const PIECES: usize = 60;
const ORDERS: usize = REGIONS + 18;
type Table = PrecedenceTable<Number, [EcmEntry; REGIONS], [Piece<Number>; PIECES], [RegionPrecedence<Number>; ORDERS]>;
type Storage = FleetStorage<'static, Number, AGENTS, SEGMENTS>;
type Fleet<'a> = FleetMotions<'a, Number, AGENTS>;

static STORE: ConstStaticCell<Storage> = ConstStaticCell::new(Storage::new());
static FLEET: ConstStaticCell<Fleet<'static>> = ConstStaticCell::new(Fleet::new());
static TABLE: ConstStaticCell<Table> = ConstStaticCell::new(PrecedenceTable::new(
    [EcmEntry::EMPTY; REGIONS],
    [Piece::EMPTY; PIECES],
    [RegionPrecedence::EMPTY; ORDERS],
));

/// The agent of the queries: agent 3, counted from 1.
const AGENT: usize = 2;
const PAINT: u32 = 0xA5A5_5A5A;

unsafe extern "C" {
    static __sheap: u32;
}

#[entry]
fn main() -> ! {
    process::exit(if run().is_some() { 0 } else { 1 })
}

#[inline(always)]
fn stack_pointer() -> usize {
    let at: usize;
    // SAFETY: reads a register.
    unsafe { core::arch::asm!("mov {}, sp", out(reg) at, options(nomem, nostack, preserves_flags)) };
    at
}

/// Prints how much stack `call` takes; `None` if it fails.
#[inline(never)]
fn measure(name: &[u8], call: &mut dyn FnMut() -> bool) -> Option<()> {
    let lowest = &raw const __sheap as usize;
    let top = stack_pointer();
    let mut at = lowest;
    while at < top {
        // SAFETY: between the statics and the stack nothing is stored.
        unsafe { (at as *mut u32).write_volatile(PAINT) };
        at = at.wrapping_add(4);
    }
    let done = call();
    let mut at = lowest;
    // SAFETY: as above.
    while at < top && unsafe { (at as *const u32).read_volatile() } == PAINT {
        at = at.wrapping_add(4);
    }
    let used = top.wrapping_sub(at) as u32;
    out::print(Line::default().integer(used, 9).text(b"  bytes of stack of ").text(name).text(b"\n").as_bytes());
    // Nothing is known of a call that has painted over all of it: it may have gone on into the statics.
    (done && at > lowest).then_some(())
}

fn run() -> Option<()> {
    let (store, fleet, table) = (STORE.try_take()?, FLEET.try_take()?, TABLE.try_take()?);
    measure(b"the constructors", &mut || {
        BUILT_IN.iter().take(AGENTS).all(|agent| black_box(agent).add_to(store).is_ok())
    })?;
    let store: &'static Storage = store;
    measure(b"the motions", &mut || {
        fleet.fill(store);
        fleet.len() == AGENTS
    })?;
    measure(b"Ecm::fill", &mut || table.fill(fleet).is_ok())?;
    queries(fleet, table)?;
    orders(fleet, table)
}

#[inline(never)]
fn queries(fleet: &Fleet<'static>, table: &Table) -> Option<()> {
    let (zero, motion) = (<Number as Scalar>::ZERO, fleet.get(AGENT)?);
    let span = Motion::span(fleet);
    let middle = Scalar::half(motion.path().length());
    let row = table.ecm().row(fleet, AGENT).ok()?;
    measure(b"RegionRef::time and length", &mut || {
        row.clone().for_each(|region| {
            black_box((region.time(), region.length()));
        });
        true
    })?;
    measure(b"RegionRef::slice_at", &mut || {
        row.clone().for_each(|region| {
            black_box(region.slice_at(region.time().middle()).last());
        });
        true
    })?;
    measure(b"first_conflict", &mut || first_conflict(motion, row.clone(), motion.time()).is_ok())?;
    measure(b"first_overlap", &mut || first_overlap(motion, row.clone(), motion.time()).is_ok())?;
    let other = fleet.get(6)?;
    measure(b"Encounter::closest", &mut || {
        let pair = Encounter::new(motion, other);
        black_box(pair.closest(pair.time()));
        true
    })?;
    let at = Interval::new(middle, middle);
    measure(b"safe_intervals", &mut || safe_intervals(fleet, AGENT, at, span).map(Iterator::last).is_ok())?;
    measure(b"safe_lengths", &mut || safe_lengths(fleet, AGENT, span).map(Iterator::last).is_ok())?;
    measure(b"RegionRef::forbidden_delays", &mut || {
        row.clone().for_each(|region| {
            black_box(region.forbidden_delays());
        });
        true
    })?;
    measure(b"earliest_start", &mut || earliest_start(row.clone(), zero).is_some())?;
    measure(b"earliest_departure", &mut || {
        black_box(earliest_departure(row.clone(), middle, zero));
        true
    })?;
    let duration = motion.time().length();
    measure(b"least_duration", &mut || {
        black_box(least_duration::<Number, 3>(row.clone(), duration).is_ok());
        true
    })
}

#[inline(never)]
fn orders(fleet: &mut Fleet<'static>, table: &mut Table) -> Option<()> {
    let zero = <Number as Scalar>::ZERO;
    for second in 0..AGENTS {
        for first in 0..second {
            table.decide(fleet, second, first, PassingState::Second, zero).ok()?;
        }
    }
    let mut progress = [Progress::at_rest(zero); AGENTS];
    measure(b"PrecedenceTable::hold", &mut || table.hold(fleet, AGENT, &progress).is_ok())?;
    let tolerances = CheckTolerances { width: zero, gain: <Number as Scalar>::LEAST };
    let mut states = [CheckState::EMPTY; AGENTS];
    // Whether all can finish in this order does not matter here, only what it takes to know.
    measure(b"PrecedenceTable::check", &mut || {
        black_box(table.check(fleet, &progress, tolerances, &mut states).is_ok());
        true
    })?;
    measure(b"PrecedenceTable::as_planned", &mut || {
        black_box(table.as_planned(fleet).is_ok());
        true
    })?;
    let motion = *fleet.get(AGENT)?;
    measure(b"PrecedenceTable::replace", &mut || table.replace(fleet, AGENT, motion).is_ok())?;
    measure(b"PrecedenceTable::admit", &mut || {
        let proposal = PathProposal { agent: AGENT, motion, progress: Progress::at_rest(zero) };
        let first = |_: &pcr_core::RegionRef<'_, Number>| PassingState::First;
        black_box(table.admit(fleet, &mut progress, proposal, tolerances, &mut states, first).is_ok());
        true
    })
}
