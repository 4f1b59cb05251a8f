//! Robots under way on a line that loses, cuts, repeats, delays and reorders frames: whatever is lost, no two discs touch.
//!
//! Each run has a fleet of its own, drawn at random and planned by the supervisor. Every robot is a [`Client`] with a [`Briefing`] and
//! a [`Robot`], as on its own controller; between them and the supervisor is one line with faults in both directions. Robots stop
//! at random, get new paths when they have arrived, and in half of the runs lose their memory on the way (*restarts*). They move
//! freely up to their holds; the true positions are checked five times per control step.

mod drawn;
mod driver;
mod line;
mod rounded;
mod tally;

use drawn::{Random, agent, heading, limits, path};
use driver::Driver;
pub(crate) use driver::motions;
use line::Way;
use pcr_supervisor::message::{Refusal, Terms};
use pcr_supervisor::{Agent, Answer, Client, Event, Number, Request, Service, Session, Traffic};
pub(crate) use rounded::Rounded;
use std::error::Error;
use tally::Tally;

/// Largest number of robots. The capacities of the supervisor below follow from it.
pub(crate) const ROBOTS: usize = 5;
/// Lines and arcs of a path.
const STEPS: usize = 3;
const SEGMENTS: usize = ROBOTS * STEPS;
/// Capacity of the supervisor for segments, with room for the new path of one robot beside its old one.
pub(crate) const ROOM: usize = SEGMENTS + STEPS;
/// Capacities for regions, pieces and orders.
pub(crate) const REGIONS: usize = 48;
pub(crate) const PIECES: usize = 128;
pub(crate) const ORDERS: usize = 2 * REGIONS;

/// Time between two control steps \[s\].
const STEP: f64 = 0.1;
/// Control steps after which a run is given up: 600 s.
const CONTROLS: usize = 6000;

/// The other end: bytes go there, and what it has said since comes back.
pub(crate) trait Supervisor {
    /// Sends bytes; what it answers to them and to nothing else.
    fn exchange(&mut self, bytes: &[u8]) -> Result<Vec<u8>, Box<dyn Error>>;
}

/// A supervisor in this process.
type Here<S> = Session<S, ROBOTS, ROOM, REGIONS, PIECES, Traffic<S, ROBOTS, REGIONS, PIECES, ORDERS>>;

pub(crate) fn here<S: Rounded>() -> Here<S> {
    Session::of(Service::with(Traffic::new(), &[]))
}

impl<S: Rounded> Supervisor for Here<S> {
    fn exchange(&mut self, bytes: &[u8]) -> Result<Vec<u8>, Box<dyn Error>> {
        let mut said = Vec::new();
        bytes.iter().for_each(|&byte| self.take(byte, &mut |frame: &[u8]| said.extend_from_slice(frame)));
        Ok(said)
    }
}

/// Runs of a number format, from this seed on. With `reckless`, robots do not look at their holds.
pub(crate) fn runs<S: Rounded>(
    seeds: std::ops::Range<u64>,
    reckless: bool,
    mut connect: impl FnMut() -> Result<Box<dyn Supervisor>, Box<dyn Error>>,
) -> Result<Tally, Box<dyn Error>> {
    let mut tally = Tally { gap: f64::INFINITY, ..Tally::default() };
    for seed in seeds {
        let mut supervisor = connect()?;
        run::<S>(seed, reckless, &mut *supervisor, &mut tally).map_err(|error| format!("run {seed}: {error}"))?;
        tally.runs += 1;
    }
    Ok(tally)
}

/// A question of the planner on a line that is perfect.
fn ask<S: Number>(
    supervisor: &mut dyn Supervisor,
    planner: &mut Client,
    request: &Request<S>,
) -> Result<Answer<S>, Box<dyn Error>> {
    if !planner.ask(request) {
        return Err("a request is too long".into());
    }
    let bytes = supervisor.exchange(planner.frame())?;
    let last = bytes.into_iter().filter_map(|byte| planner.take(byte)).last();
    match last {
        Some(Event::Last(answer)) => Ok(answer),
        other => Err(format!("no answer to {request:?} but {other:?}").into()),
    }
}

fn run<S: Rounded>(
    seed: u64,
    reckless: bool,
    supervisor: &mut dyn Supervisor,
    tally: &mut Tally,
) -> Result<(), Box<dyn Error>> {
    let mut random = Random(seed);
    let bad = [0, 20, 100, 250][random.below(4)];
    let mut planner = Client::new();
    ask::<S>(supervisor, &mut planner, &Request::Hello)?;
    ask::<S>(supervisor, &mut planner, &Request::Clear)?;
    // Robots are added as long as a plan has room for them.
    let mut fleet: Vec<Agent<S>> = Vec::new();
    for _ in 0..2 + random.below(2 * ROBOTS) {
        let new = agent::<S>(&mut random);
        if fleet.len() == ROBOTS {
            break;
        }
        let Answer::Fleet { .. } = ask(supervisor, &mut planner, &Request::Add(new.clone()))? else { continue };
        let index = u16::try_from(fleet.len())?;
        let computed = ask::<S>(supervisor, &mut planner, &Request::Compute)?;
        let replanned = match computed {
            Answer::Computed { .. } => ask::<S>(supervisor, &mut planner, &Request::Replan { agent: index })?,
            refused => refused,
        };
        if matches!(replanned, Answer::Replanned { .. }) {
            fleet.push(new);
        } else {
            ask::<S>(supervisor, &mut planner, &Request::Remove { agent: index })?;
        }
    }
    ask::<S>(supervisor, &mut planner, &Request::Compute)?;
    let terms = Terms {
        run: 1 + (seed % 65_535) as u16,
        horizon: S::from_f64(0.5 + 2.0 * random.unit()),
        width: S::from_f64(0.0),
    };
    match ask(supervisor, &mut planner, &Request::Order(terms))? {
        Answer::Edition(_) => {}
        // A robot that comes as early as possible touches the one before it: such cases may be too close to decide.
        Answer::Refused(Refusal::Meeting(_) | Refusal::Stuck(_)) => return Ok(()),
        other => return Err(format!("no orders but {other:?}").into()),
    }
    let mut drivers: Vec<Driver<S>> = (0..).zip(fleet).map(|(index, agent)| Driver::new(index, agent)).collect();
    tally.robots += drivers.len();
    let (mut there, mut back) = (Way::default(), Way::default());
    let mut missions = random.below(4);
    let forgets = if random.chance(500) { 3 } else { 0 };
    for _ in 0..CONTROLS {
        for driver in &mut drivers {
            driver.send(&mut there, &mut random, bad, tally);
        }
        let said = supervisor.exchange(&there.arrive())?;
        // Each frame suffers by itself.
        for frame in said.split_inclusive(|&byte| byte == 0).filter(|frame| frame.len() > 1) {
            back.send(&[&[0], frame].concat(), &mut random, bad, tally);
        }
        let heard = back.arrive();
        for driver in &mut drivers {
            driver.hear(&heard, tally)?;
            driver.control(&mut random, reckless)?;
            if random.chance(forgets) {
                driver.restart();
                tally.restarts += 1;
            }
        }
        advance(&mut drivers, tally)?;
        let arrived = |driver: &Driver<S>| driver.at >= driver.end();
        if missions > 0 && random.chance(30) {
            let index = random.below(drivers.len());
            if arrived(&drivers[index]) {
                missions -= 1;
                mission::<S>(index, supervisor, &mut planner, &mut random, tally)?;
            }
        }
        if missions == 0 && drivers.iter().all(|driver| arrived(driver) && !driver.asks) {
            break;
        }
    }
    match drivers.iter().find(|driver| driver.at < driver.end()) {
        Some(late) if !reckless => {
            let Driver { index, at, hold, asks, .. } = late;
            let (end, edition) = (late.end(), late.robot.edition());
            return Err(format!(
                "{index} stands at {at} m of {end} m for ever, hold {hold} m, {edition:?}, asking: {asks}"
            )
            .into());
        }
        _ => tally.arrived += drivers.len(),
    }
    Ok(())
}

/// The planner gives a robot another path, which may be refused.
fn mission<S: Rounded>(
    index: usize,
    supervisor: &mut dyn Supervisor,
    planner: &mut Client,
    random: &mut Random,
    tally: &mut Tally,
) -> Result<(), Box<dyn Error>> {
    let request: Request<S> = Request::Admit {
        agent: u16::try_from(index)?,
        heading: heading::<S>(random),
        limits: limits(),
        path: path(random),
    };
    match ask(supervisor, planner, &request)? {
        Answer::Edition(_) => tally.admitted += 1,
        Answer::Refused(
            Refusal::Blocked(_)
            | Refusal::Stuck(_)
            | Refusal::NotThere { .. }
            | Refusal::TableFull(_)
            | Refusal::Agent { .. },
        ) => tally.refused += 1,
        other => return Err(format!("no mission but {other:?}").into()),
    }
    Ok(())
}

/// Moves all robots up to the next control step. Two discs that overlap by more than [`TOUCH`] are an error.
fn advance<S: Rounded>(drivers: &mut [Driver<S>], tally: &mut Tally) -> Result<(), Box<dyn Error>> {
    const PARTS: u32 = 5;
    for _ in 0..PARTS {
        for driver in drivers.iter_mut() {
            driver.at = (driver.at + driver.speed * STEP / f64::from(PARTS)).min(driver.end());
        }
        let discs: Vec<_> = drivers.iter().filter_map(Driver::disc).collect();
        for (index, (a, own)) in discs.iter().enumerate() {
            for (other, (b, radius)) in discs.iter().enumerate().skip(index + 1) {
                let gap = (a[0] - b[0]).hypot(a[1] - b[1]) - own - radius;
                tally.gap = tally.gap.min(gap);
                if gap < -TOUCH {
                    return Err(format!("{index} and {other} overlap by {} m", -gap).into());
                }
            }
        }
    }
    Ok(())
}

/// Overlap above which two discs are in contact \[m\]: at a hold they may just touch, and the positions here are rounded.
const TOUCH: f64 = 1e-3;
