//! Counts the instructions of every part of the 12-agent job. QEMU must run with `ICOUNT=7`; means are rounded down.
#![no_std]
#![no_main]

use core::hint::black_box;
use pcr_board::meter::Meter;
use pcr_board::{AGENTS, Number, entry, out};
use pcr_core::scalar::{Angle, Wide};
use pcr_core::{Ecm, EcmEntry, FleetMotions, FleetStorage, Piece, Scalar, earliest_start, first_conflict};
use pcr_supervisor::dump::Line;
use pcr_supervisor::message::ConflictRecord;
use pcr_supervisor::scenario;
use semihosting::process;
use static_cell::ConstStaticCell;

static STORE: ConstStaticCell<FleetStorage<'static, Number, { scenario::AGENTS }, { scenario::SEGMENTS }>> =
    ConstStaticCell::new(FleetStorage::new());
static TABLE: ConstStaticCell<Ecm<Number, [EcmEntry; scenario::REGIONS], [Piece<Number>; scenario::PIECES]>> =
    ConstStaticCell::new(Ecm::new([EcmEntry::EMPTY; scenario::REGIONS], [Piece::EMPTY; scenario::PIECES]));

/// Agent 3, counted from 1: the one whose map the README shows.
const AGENT: usize = 2;

/// Unordered pairs of the agents.
const PAIRS: u32 = (scenario::AGENTS * (scenario::AGENTS - 1) / 2) as u32;

pcr_board::meter_interrupt!();

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
        let (count, added) = meter.count(|| black_box(agent).add_to(store));
        added.ok()?;
        constructors = constructors.saturating_add(count);
    }
    let mut fleet = FleetMotions::new();
    fleet.fill(store);
    let (mut build, mut worst) = (0_u32, 0_u32);
    for agent in 0..fleet.len() {
        let motions = fleet.get(..=agent)?;
        let (count, inserted) = meter.count(|| table.insert(black_box(motions), agent));
        inserted.ok()?;
        build = build.saturating_add(count);
        worst = worst.max(count);
    }
    let (motion, zero) = (fleet.get(AGENT)?, <Number as Scalar>::ZERO);
    let (conflict, _) = meter
        .count(|| black_box(table.row(&fleet, AGENT).map(|row| first_conflict(motion, row, motion.time())).is_ok()));
    let laps = meter.laps();
    let row = table.row(&fleet, AGENT).ok()?.inspect(|_| laps.lap());
    black_box(earliest_start(row, zero));
    laps.lap();
    let mut pair = 0_u32;
    for second in 1..fleet.len() {
        for first in 0..second {
            let (count, _) = meter.count(|| black_box(ConflictRecord::first(&fleet, [first, second]).is_ok()));
            pair = pair.max(count);
        }
    }
    let (regions, pairs) = (table.len() as u32, PAIRS);
    let mut ranges = 0_u32;
    for region in table.regions(&fleet).ok()? {
        let (count, _) = meter.count(|| black_box((region.time(), region.length())));
        ranges = ranges.saturating_add(count);
    }
    let mut slices = 0_u32;
    for region in table.regions(&fleet).ok()? {
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
    report(b"... of two agents, the longest", pair);
    let [replan, part] = laps.counts();
    report(b"earliest start of agent 3", replan);
    report(b"... from one region to the next, the longest", part);
    let radius = AGENTS.first()?.radius;
    let [root, sine, tangent] = functions(&meter, radius);
    report(b"a square root", root);
    report(b"a sine and cosine", sine);
    report(b"an arctangent", tangent);
    #[cfg(feature = "f32")]
    {
        let [root, sine, tangent] = functions_of_libm(&meter, radius);
        report(b"a square root of libm", root);
        report(b"a sine and cosine of libm", sine);
        report(b"an arctangent of libm", tangent);
    }
    Some(())
}

/// Calls of a function, about all directions.
const CALLS: u32 = 48;

fn mean(sums: [u32; 3]) -> [u32; 3] {
    sums.map(|sum| sum / CALLS)
}

/// Means of the functions that are more than a few instructions.
fn functions<S: Scalar>(meter: &Meter, radius: S) -> [u32; 3] {
    let [mut root, mut sine, mut tangent] = [0_u32; 3];
    let (mut angle, step) = (S::Angle::ZERO, S::Angle::half_subtended(radius.half().half(), radius));
    for _ in 0..CALLS {
        let (sin, cos) = angle.sin_cos();
        let (x, y) = (radius.scale(cos), radius.scale(sin));
        let square = radius.times(x.abs());
        root = root.saturating_add(meter.count(|| black_box(black_box(square).sqrt())).0);
        sine = sine.saturating_add(meter.count(|| black_box(black_box(angle).sin_cos())).0);
        tangent = tangent.saturating_add(meter.count(|| black_box(S::Angle::atan2(black_box(y), black_box(x)))).0);
        angle = angle + step;
    }
    mean([root, sine, tangent])
}

/// The same functions of libm.
#[cfg(feature = "f32")]
fn functions_of_libm(meter: &Meter, radius: f32) -> [u32; 3] {
    let [mut root, mut sine, mut tangent] = [0_u32; 3];
    let mut angle = 0.0;
    for _ in 0..CALLS {
        let (sin, cos) = libm::sincosf(angle);
        let (x, y) = (radius * cos, radius * sin);
        let square = radius * x.abs();
        root = root.saturating_add(meter.count(|| black_box(libm::sqrtf(black_box(square)))).0);
        sine = sine.saturating_add(meter.count(|| black_box(libm::sincosf(black_box(angle)))).0);
        tangent = tangent.saturating_add(meter.count(|| black_box(libm::atan2f(black_box(y), black_box(x)))).0);
        angle += 0.125;
    }
    mean([root, sine, tangent])
}
