//! Two tables: a control loop in an interrupt reads one, and the main program computes the next in the other and hands it over. Nothing is
//! copied, and interrupts are off for as long as a pointer is exchanged. QEMU must run with `ICOUNT=7`.
#![no_std]
#![no_main]

use core::cell::Cell;
use core::hint::black_box;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::{Peripherals, asm};
use cortex_m_rt::exception;
use critical_section::Mutex;
use pcr_board::{AGENTS, Number, entry, out};
use pcr_core::{Ecm, EcmEntry, FleetMotions, FleetStorage, Piece};
use pcr_supervisor::dump::Line;
use pcr_supervisor::scenario::{self, PIECES, REGIONS};
use portable_atomic::{AtomicU32, Ordering};
use semihosting::process;
use static_cell::ConstStaticCell;

/// A fleet and its table. The motions borrow from the storage, so each side makes its own when it has the buffer.
struct Buffer {
    storage: FleetStorage<'static, Number, { scenario::AGENTS }, { scenario::SEGMENTS }>,
    table: Ecm<Number, [EcmEntry; REGIONS], [Piece<Number>; PIECES]>,
}

impl Buffer {
    const fn new() -> Self {
        Self { storage: FleetStorage::new(), table: Ecm::new([EcmEntry::EMPTY; REGIONS], [Piece::EMPTY; PIECES]) }
    }
}

/// Where one side leaves a buffer for the other.
type Place = Mutex<Cell<Option<&'static mut Buffer>>>;

static FIRST: ConstStaticCell<Buffer> = ConstStaticCell::new(Buffer::new());
static SECOND: ConstStaticCell<Buffer> = ConstStaticCell::new(Buffer::new());
/// The newest table, from the main program to the control loop.
static NEXT: Place = Mutex::new(Cell::new(None));
/// A table that is no longer read, back to the main program.
static FREE: Place = Mutex::new(Cell::new(None));

static CALLS: AtomicU32 = AtomicU32::new(0);
static FAILED: AtomicU32 = AtomicU32::new(0);
static TABLES: AtomicU32 = AtomicU32::new(0);

/// Tables that are handed over, each of one agent less than the one before, and then of all again.
const EDITIONS: usize = 8;
/// Ticks of the clock between two calls of the control loop; about 100,000 instructions.
const PERIOD: u32 = 320_000;

#[entry]
fn main() -> ! {
    process::exit(if run().is_some() { 0 } else { 1 })
}

fn leave(place: &'static Place, buffer: &'static mut Buffer) {
    critical_section::with(|token| place.borrow(token).set(Some(buffer)));
}

fn collect(place: &'static Place) -> Option<&'static mut Buffer> {
    critical_section::with(|token| place.borrow(token).take())
}

fn run() -> Option<()> {
    let mut clock = Peripherals::take()?.SYST;
    clock.set_clock_source(SystClkSource::Core);
    clock.set_reload(PERIOD);
    clock.clear_current();
    let mut spare = Some(SECOND.try_take()?);
    let mut buffer = FIRST.try_take()?;
    let mut during = 0_u32;
    for edition in 0..EDITIONS {
        let before = CALLS.load(Ordering::Relaxed);
        compute(buffer, edition)?;
        during = during.saturating_add(CALLS.load(Ordering::Relaxed).wrapping_sub(before));
        leave(&NEXT, buffer);
        clock.enable_interrupt();
        clock.enable_counter();
        buffer = match spare.take() {
            Some(spare) => spare,
            None => loop {
                if let Some(free) = collect(&FREE) {
                    break free;
                }
                asm::wfi();
            },
        };
    }
    while TABLES.load(Ordering::Relaxed) < EDITIONS as u32 {
        asm::wfi();
    }
    let line = Line::default()
        .integer(TABLES.load(Ordering::Relaxed), 0)
        .text(b" tables handed over, the control loop called ");
    let line = line.integer(during, 0).text(b" times while they were computed\n");
    out::print(line.as_bytes());
    (FAILED.load(Ordering::Relaxed) == 0 && during >= EDITIONS as u32).then_some(())
}

/// Computes the table of a fleet, one pair of agents after the other.
#[inline(never)]
fn compute(buffer: &mut Buffer, edition: usize) -> Option<()> {
    buffer.storage.clear();
    for agent in AGENTS.iter().skip(edition & 3) {
        agent.add_to(&mut buffer.storage).ok()?;
    }
    let mut fleet = FleetMotions::new();
    fleet.fill(&buffer.storage);
    buffer.table.begin_fill(&fleet);
    while !buffer.table.fill_pairs(&fleet, 1).ok()? {
        // What else the main program has to do: feed the watchdog, answer the line.
    }
    Some(())
}

/// The control loop, at a fixed rate.
#[exception]
fn SysTick() {
    static mut CURRENT: Option<&'static mut Buffer> = None;
    if let Some(next) = collect(&NEXT) {
        TABLES.add(1, Ordering::Relaxed);
        if let Some(before) = CURRENT.replace(next) {
            leave(&FREE, before);
        }
    }
    CALLS.add(1, Ordering::Relaxed);
    if CURRENT.as_deref().is_none_or(|buffer| control(buffer).is_none()) {
        FAILED.add(1, Ordering::Relaxed);
    }
}

/// What a robot asks at every turn: when and where it meets others.
#[inline(never)]
fn control(buffer: &Buffer) -> Option<()> {
    let mut fleet = FleetMotions::new();
    fleet.fill(&buffer.storage);
    for region in buffer.table.row(&fleet, 0).ok()? {
        black_box((region.time(), region.length()));
    }
    Some(())
}
