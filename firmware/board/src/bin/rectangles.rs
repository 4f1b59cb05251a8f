//! The table of 12 rectangles on the paper's paths, each as long as its disc is wide, and half as wide: its regions, and the instructions that it
//! takes. QEMU must run with `ICOUNT=7`.
#![no_std]
#![no_main]

use core::hint::black_box;
use pcr_board::meter::Meter;
use pcr_board::{AGENTS, Number, entry, out};
use pcr_core::{Ecm, EcmEntry, FleetMotions, FleetStorage, InvalidInput, Motion, Outline, Piece, Scalar};
use pcr_supervisor::dump::{self, Line};
use pcr_supervisor::scenario::{self, PIECES, REGIONS};
use semihosting::process;
use static_cell::ConstStaticCell;

type Table = Ecm<Number, [EcmEntry; REGIONS], [Piece<Number>; 2 * PIECES]>;
type Storage = FleetStorage<'static, Number, { scenario::AGENTS }, { scenario::SEGMENTS }>;
type Outlines = [Option<Outline<Number, 4>>; scenario::AGENTS];
type Fleet = FleetMotions<'static, Number, { scenario::AGENTS }>;

static STORE: ConstStaticCell<Storage> = ConstStaticCell::new(Storage::new());
static OUTLINES: ConstStaticCell<Outlines> = ConstStaticCell::new([const { None }; scenario::AGENTS]);
static FLEET: ConstStaticCell<Fleet> = ConstStaticCell::new(Fleet::new());
static TABLE: ConstStaticCell<Table> =
    ConstStaticCell::new(Ecm::new([EcmEntry::EMPTY; REGIONS], [Piece::EMPTY; 2 * PIECES]));

pcr_board::meter_interrupt!();

#[entry]
fn main() -> ! {
    process::exit(if run().is_some() { 0 } else { 1 })
}

fn run() -> Option<()> {
    let (outlines, fleet, table) = (OUTLINES.try_take()?, FLEET.try_take()?, TABLE.try_take()?);
    construct(STORE.try_take()?, outlines, fleet).ok()?;
    let motions = &*fleet;
    let (count, filled) = Meter::new()
        .count(|| (0..motions.len()).try_for_each(|agent| insert(table, black_box(motions.get(..=agent)?), agent)));
    filled?;
    table.regions(fleet).ok()?.for_each(|region| out::print(dump::region(&region).as_bytes()));
    let line = Line::default().integer(table.len() as u32, 0).text(b" regions, ").integer(table.pieces() as u32, 0);
    out::print(line.text(b" pieces\n").as_bytes());
    out::print(Line::default().integer(count, 9).text(b"  table of 12 rectangles\n").as_bytes());
    Some(())
}

#[inline(never)]
fn construct(
    store: &'static mut Storage,
    outlines: &'static mut Outlines,
    fleet: &mut Fleet,
) -> Result<(), InvalidInput> {
    AGENTS.iter().try_for_each(|agent| agent.add_to(store).map(|_| ()))?;
    fleet.fill(store);
    for (motion, outline) in fleet.iter_mut().zip(outlines) {
        let (length, width) = (motion.radius(), motion.radius().half());
        let rectangle = outline.insert(Outline::rectangle(length, length, width, width, Number::ZERO)?);
        *motion = Motion::with_outline(motion.path(), motion.profile(), &*rectangle, motion.time().lo)?;
    }
    Ok(())
}

/// The job whose stack counts.
#[inline(never)]
fn insert(table: &mut Table, fleet: &[Motion<'_, Number>], agent: usize) -> Option<()> {
    table.insert(fleet, agent).ok()
}
