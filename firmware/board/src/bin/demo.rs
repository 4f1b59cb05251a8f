//! Computes the paper's 12 agents into a table in a `static` and prints it: `cargo run --release`. What it prints can be certified:
//! `pcr certify --table FILE`.
#![no_std]
#![no_main]

use pcr_board::{AGENTS, Number, entry, out};
use pcr_core::{Ecm, EcmEntry, FleetMotions, FleetStorage, Piece};
use pcr_supervisor::dump::{self, Line};
use pcr_supervisor::scenario;
use semihosting::process;
use static_cell::ConstStaticCell;

type Table = Ecm<Number, [EcmEntry; scenario::REGIONS], [Piece<Number>; scenario::PIECES]>;

static STORE: ConstStaticCell<FleetStorage<'static, Number, { scenario::AGENTS }, { scenario::SEGMENTS }>> =
    ConstStaticCell::new(FleetStorage::new());
static TABLE: ConstStaticCell<Table> =
    ConstStaticCell::new(Ecm::new([EcmEntry::EMPTY; scenario::REGIONS], [Piece::EMPTY; scenario::PIECES]));

#[entry]
fn main() -> ! {
    process::exit(if run().is_some() { 0 } else { 1 })
}

fn run() -> Option<()> {
    let (store, table) = (STORE.try_take()?, TABLE.try_take()?);
    for agent in &AGENTS {
        agent.add_to(store).ok()?;
    }
    let mut fleet = FleetMotions::new();
    fleet.fill(store);
    table.fill(&fleet).ok()?;
    out::print(dump::HEADING);
    table.regions(&fleet).ok()?.for_each(|region| out::print(dump::region(&region).as_bytes()));
    let line = Line::default().integer(table.len() as u32, 0).text(b" regions, ").integer(table.pieces() as u32, 0);
    out::print(line.text(b" pieces\n").as_bytes());
    dump::table(&fleet, table, out::print).ok()?;
    Some(())
}
