//! A robot among 29 others on a serial line: asks for its orders, reports where it is, and computes how far it may go, which
//! is where it is next time. `pcr-link robot` is the other end. On stderr it tells what a hold takes, with `ICOUNT=7`.
//!
//! A robot that drives sends its reports by a timer, and its questions again where no answer comes; here the line is perfect.
#![no_std]
#![no_main]

use core::hint::black_box;
use pcr_board::meter::Meter;
use pcr_board::uart::Uart;
use pcr_board::{Number, entry, out};
use pcr_core::{FleetMotions, Interval, Motion, Scalar};
use pcr_supervisor::dump::Line;
use pcr_supervisor::scenario::crowd::{OWN, PIECES, REGIONS, ROBOTS, SEGMENTS};
use pcr_supervisor::{Answer, Briefing, Client, Event, Request, Robot};
use semihosting::process;
use static_cell::{ConstStaticCell, StaticCell};

type Told = Briefing<Number, ROBOTS, SEGMENTS, REGIONS>;
type Keeper = Robot<Number, ROBOTS, REGIONS, PIECES>;

static CLIENT: StaticCell<Client> = StaticCell::new();
static TOLD: ConstStaticCell<Told> = ConstStaticCell::new(Told::new());
static KEEPER: ConstStaticCell<Keeper> = ConstStaticCell::new(Keeper::new());

pcr_board::meter_interrupt!();

#[entry]
fn main() -> ! {
    let client = CLIENT.try_init_with(|| Client::robot(OWN));
    let (Some(client), Some(told), Some(keeper)) = (client, TOLD.try_take(), KEEPER.try_take()) else {
        process::exit(2)
    };
    let mut link = Link { uart: Uart::start(), client };
    process::exit(if work(&mut link, told, keeper).is_some() { 0 } else { 1 })
}

struct Link {
    uart: Uart,
    client: &'static mut Client,
}

impl Link {
    /// Asks, and hands over the answers; the last one is returned.
    #[inline(never)]
    fn ask(&mut self, request: &Request<Number>, mut hear: impl FnMut(&Answer<Number>)) -> Option<Answer<Number>> {
        if !self.client.ask(request) {
            return None;
        }
        self.uart.write(self.client.frame());
        loop {
            match self.client.take(self.uart.read()) {
                None => {}
                Some(Event::Answer(answer)) => hear(&answer),
                Some(Event::Last(answer)) => {
                    hear(&answer);
                    return Some(answer);
                }
                Some(Event::Again) => self.uart.write(self.client.frame()),
                Some(Event::Changed | Event::OutOfStep) => return None,
            }
        }
    }
}

/// Drives to the end of its path; `None` where it was told nonsense.
#[inline(never)]
fn work(link: &mut Link, told: &mut Told, keeper: &mut Keeper) -> Option<()> {
    told.begin(OWN);
    let mut clear = true;
    let last = link.ask(&Request::Orders { agent: OWN }, |answer| clear &= told.take(answer).is_ok())?;
    let Answer::Orders { edition, .. } = last else { return None };
    let mut fleet = FleetMotions::new();
    if !clear {
        return None;
    }
    fleet.fill(told.paths());
    // It stands at the start. Restarted on the way it would be refused, as it cannot find its place there.
    keeper.brief(told, &fleet, Number::ZERO).ok()?;
    let end = fleet.get(keeper.own())?.path().length();
    let meter = Meter::new();
    let (mut at, mut most, mut all, mut holds) = (Number::ZERO, 0_u32, 0_u32, 0_u32);
    while at < end {
        let report = Request::Report { agent: OWN, edition, at: Interval::new(at, at) };
        link.ask(&report, |answer| keeper.hear(told, answer))?;
        let (count, hold) = meter.count(|| hold(black_box(&mut *keeper), &fleet));
        (at, most, all, holds) = (hold, most.max(count), all.saturating_add(count), holds.saturating_add(1));
    }
    tell(b"a hold among 30 robots, mean", all.checked_div(holds)?);
    tell(b"... the longest", most);
    Some(())
}

/// The work that is done ten times a second, with a stack of its own.
#[inline(never)]
fn hold(keeper: &mut Keeper, fleet: &[Motion<'_, Number>]) -> Number {
    keeper.hold(fleet)
}

fn tell(what: &[u8], count: u32) {
    out::tell(Line::default().integer(count, 9).text(b"  ").text(what).text(b"\n").as_bytes());
}
