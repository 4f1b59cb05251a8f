//! Searches for the pair of segments that takes most instructions, and compares pairs of paths, and the table of the 12 agents, with what
//! follows from it: the paths' pairs of segments times the longest. It fails where one takes more. QEMU must run with `ICOUNT=7`.
#![no_std]
#![no_main]

use core::hint::black_box;
use pcr_board::meter::Meter;
use pcr_board::{AGENTS, Number, entry, out};
use pcr_core::scalar::Angle;
use pcr_core::{Curve, Ecm, EcmEntry, FleetMotions, FleetStorage, Limits, Piece, Point, Pose, Scalar, TurnSide};
use pcr_supervisor::dump::Line;
use pcr_supervisor::{Agent, Step, scenario};
use semihosting::process;
use static_cell::ConstStaticCell;

/// Lines and arcs of a path, and how many pairs of such paths there are.
const SIZES: [(u32, u32); 4] = [(1, 4096), (2, 1024), (4, 256), (8, 64)];
const ONE: Number = <Number as pcr_supervisor::Number>::ONE;

type Fleet = FleetStorage<'static, Number, { scenario::AGENTS }, { scenario::SEGMENTS }>;
type Table = Ecm<Number, [EcmEntry; scenario::REGIONS], [Piece<Number>; scenario::PIECES]>;

// The pairs of paths, and then the 12 agents.
static STORE: ConstStaticCell<Fleet> = ConstStaticCell::new(FleetStorage::new());
static TABLE: ConstStaticCell<Table> =
    ConstStaticCell::new(Ecm::new([EcmEntry::EMPTY; scenario::REGIONS], [Piece::EMPTY; scenario::PIECES]));

#[entry]
fn main() -> ! {
    process::exit(if run() == Some(true) { 0 } else { 1 })
}

fn report(count: u32, what: &[u8], paths: u32) {
    let line = Line::default().integer(count, 9).text(b"  ").text(what);
    let line = if paths > 0 { line.text(b" of ").integer(paths, 0).text(b" random pairs") } else { line };
    out::print(line.text(b"\n").as_bytes());
}

fn run() -> Option<bool> {
    let (meter, mut random) = (Meter::new(), Random(1));
    let (store, table) = (STORE.try_take()?, TABLE.try_take()?);
    let (mut longest, mut holds) = (0_u32, true);
    for (size, pairs) in SIZES {
        let mut most = 0_u32;
        for _ in 0..pairs {
            store.clear();
            table.clear();
            for _ in 0..2 {
                random.add(store, size as usize)?;
            }
            let mut motions = FleetMotions::new();
            motions.fill(store).ok()?;
            table.insert(motions.get(..1)?, 0).ok()?;
            let (count, inserted) = meter.count(|| table.insert(black_box(&motions), 1));
            inserted.ok()?;
            most = most.max(count);
        }
        if size == 1 {
            longest = most;
            report(longest, b"instructions: two segments, the longest", pairs);
            continue;
        }
        let bound = longest.saturating_mul(size).saturating_mul(size);
        holds &= most <= bound;
        let what: &[u8] = match size {
            2 => b"percent of the bound: two paths of 2 segments, the longest",
            4 => b"percent of the bound: two paths of 4 segments, the longest",
            _ => b"percent of the bound: two paths of 8 segments, the longest",
        };
        report(percent(most, bound)?, what, pairs);
    }
    let (took, pairs) = twelve(&meter, store, table)?;
    let bound = longest.saturating_mul(pairs);
    holds &= took <= bound;
    report(percent(took, bound)?, b"percent of the bound: table of all agents", 0);
    Some(holds)
}

fn percent(part: u32, whole: u32) -> Option<u32> {
    u64::from(part).saturating_mul(100).checked_div(u64::from(whole)).map(|percent| percent as u32)
}

/// Instructions of the table of the 12 agents, and the pairs of segments of any two of them.
#[inline(never)]
fn twelve(meter: &Meter, store: &mut Fleet, table: &mut Table) -> Option<(u32, u32)> {
    store.clear();
    table.clear();
    AGENTS.iter().try_for_each(|agent| agent.add_to(store).map(drop)).ok()?;
    let mut fleet = FleetMotions::new();
    fleet.fill(store).ok()?;
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

/// Xorshift (Marsaglia 2003).
struct Random(u32);

impl Random {
    fn below(&mut self, bits: u32) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0.wrapping_shr(32_u32.wrapping_sub(bits))
    }

    /// From 0 to 1, in steps of 1/256.
    fn part(&mut self) -> Number {
        let bits = self.below(8);
        let (mut sum, mut weight) = (Number::ZERO, ONE);
        for bit in (0..8).rev() {
            weight = weight.half();
            if bits & 1 << bit != 0 {
                sum = sum + weight;
            }
        }
        sum
    }

    /// An agent on lines and arcs that begin in a square of two metres: most of them meet others.
    fn add(&mut self, store: &mut Fleet, steps: usize) -> Option<()> {
        let least = ONE.half().half().half();
        let mut path = [Step { curve: Curve::Line, length: least }; 8];
        let path = path.get_mut(..steps)?;
        for step in &mut *path {
            *step = match self.below(2) {
                0 => Step { curve: Curve::Line, length: least + self.part().double() },
                kind => {
                    let (radius, turn) =
                        (least + self.part(), if kind == 1 { TurnSide::Left } else { TurnSide::Right });
                    Step { curve: Curve::Arc { radius, turn }, length: radius.double().double() }
                }
            };
        }
        let position = Point::new(self.part().double(), self.part().double());
        let heading = <Number as Scalar>::Angle::atan2(self.part() - ONE.half(), self.part() - ONE.half());
        let limits = Limits { speed: ONE, acceleration: ONE };
        let radius = least + self.part().half();
        let agent = Agent { radius, start_time: Number::ZERO, limits, start: Pose { position, heading }, path: &*path };
        store.add(&agent).ok().map(drop)
    }
}
