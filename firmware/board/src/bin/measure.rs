//! Counts the instructions of every part of the 12-agent job. QEMU must run with `ICOUNT=7`; means are rounded down.
#![no_std]
#![no_main]

use core::hint::black_box;
use pcr_board::meter::Meter;
use pcr_board::{AGENTS, Number, entry, out};
use pcr_core::{Ecm, Piece, Region, Scalar, earliest_start, first_conflict};
use pcr_supervisor::dump::Line;
use pcr_supervisor::{Store, scenario};
use semihosting::process;
use static_cell::ConstStaticCell;

static STORE: ConstStaticCell<Store<Number, { scenario::AGENTS }, { scenario::SEGMENTS }>> =
    ConstStaticCell::new(Store::new());
static TABLE: ConstStaticCell<Ecm<Number, [Region; scenario::REGIONS], [Piece<Number>; scenario::PIECES]>> =
    ConstStaticCell::new(Ecm::new([Region::EMPTY; scenario::REGIONS], [Piece::EMPTY; scenario::PIECES]));

/// Agent 3, counted from 1: the one whose map the README shows.
const AGENT: usize = 2;

/// Unordered pairs of the agents.
const PAIRS: u32 = (scenario::AGENTS * (scenario::AGENTS - 1) / 2) as u32;

#[entry]
fn main() -> ! {
    process::exit(if run().is_some() { 0 } else { 1 })
}

fn report(name: &[u8], count: u32) {
    out::print(Line::default().integer(count, 9).text(b"  ").text(name).text(b"\n").as_bytes());
}

fn run() -> Option<()> {
    let meter = Meter::new();
    let (store, table) = (STORE.try_take()?, TABLE.try_take()?);
    let mut constructors = 0_u32;
    for agent in &AGENTS {
        let (count, added) = meter.count(|| store.add(black_box(agent)));
        added.ok()?;
        constructors = constructors.saturating_add(count);
    }
    let fleet = store.motions();
    let (mut build, mut worst) = (0_u32, 0_u32);
    for agent in 0..fleet.len() {
        let motions = fleet.get(..=agent)?;
        let (count, inserted) = meter.count(|| table.insert(black_box(motions), agent));
        inserted.ok()?;
        build = build.saturating_add(count);
        worst = worst.max(count);
    }
    let motion = fleet.get(AGENT)?;
    let (conflict, _) = meter.count(|| black_box(first_conflict(motion, table.row(&fleet, AGENT), motion.time())));
    let (replan, _) = meter.count(|| black_box(earliest_start(table.row(&fleet, AGENT), Number::ZERO)));
    let (regions, pairs) = (table.len() as u32, PAIRS);
    let mut ranges = 0_u32;
    for region in table.regions(&fleet) {
        let (count, _) = meter.count(|| black_box((region.time(), region.length())));
        ranges = ranges.saturating_add(count);
    }
    let mut slices = 0_u32;
    for region in table.regions(&fleet) {
        let middle = region.time().middle();
        let (count, _) = meter.count(|| black_box(region.slice_at(black_box(middle)).next()));
        slices = slices.saturating_add(count);
    }
    report(b"constructors of all agents", constructors);
    report(b"table of all agents", build);
    report(b"... per pair", build.checked_div(pairs)?);
    report(b"... per region, both directions", build.checked_div(regions)?);
    report(b"... of the agent that takes longest", worst);
    report(b"time and length range of a region", ranges.checked_div(regions.saturating_mul(2))?);
    report(b"slice of a region at a time", slices.checked_div(regions.saturating_mul(2))?);
    report(b"first conflict of agent 3 with the others", conflict);
    // In fixed point it takes longer than the clock of an ARM core can count.
    if replan < u32::MAX {
        report(b"earliest start of agent 3", replan);
    }
    Some(())
}
