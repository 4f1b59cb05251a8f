//! Fleets that keep passing orders while anything may be late: robots with brakes and uncertain places, news that are lost or old,
//! random stops, missions that come and change on the way. Distances are those of the oracle.

use crate::disc::{Course, Disc, Leg};
use crate::generators::{Dice, leg};
use crate::oracle::Route;
use pcr_core::{
    AdmissionError, BrakingModel, CapacityError, CheckState, CheckTolerances, EcmEntry, Interval, Motion,
    MovementAuthority, PassingState, PathProposal, Piece, PrecedenceTable, Progress, RegionPrecedence,
};
use pcr_planning::fleet::HostScalar;
use std::f64::consts::{FRAC_PI_2, PI};

/// Time between two controls \[s\].
const STEP: f64 = 0.1;
/// Largest speed \[m/s\], acceleration and deceleration \[m/s²\].
const SPEED: f64 = 1.0;
const BRAKE: f64 = 0.8;
/// So much of the path that a robot has come along it keeps before a new one \[m\].
const BACK: f64 = 0.05;
/// A robot that is so near to where it may go has come there \[m\].
const THERE: f64 = 1e-3;
/// Half the side of the square in which everybody moves \[m\].
const ARENA: f64 = 4.0;

/// Places in the storage.
const REGIONS: usize = 1000;
const PIECES: usize = 4000;

/// The table of the fleets here.
pub type Table<S> = PrecedenceTable<S, Vec<EcmEntry>, Vec<Piece<S>>, Vec<RegionPrecedence<S>>>;

/// What became of a fleet.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// Missions that were given to a robot.
    pub admitted: u32,
    /// Of these, such that replace one on the way.
    pub changed: u32,
    /// Missions that were refused, as somebody would have waited for ever.
    pub stuck: u32,
    /// Missions that were refused, as somebody was in the way.
    pub blocked: u32,
    /// Times at which a robot had to wait for another one.
    pub waits: u32,
    /// Least distance between two discs \[m\].
    pub clearance: f64,
    /// Until the last one arrived \[s\].
    pub time: f64,
}

struct Robot<S: HostScalar> {
    disc: Disc,
    route: Route,
    course: &'static Course<S>,
    /// Where it is \[m\], and its speed \[m/s\].
    at: f64,
    speed: f64,
    /// By how much it may think to be behind or before that \[m\].
    doubt: [f64; 2],
    /// Until when it stands for no reason \[s\].
    stops_until: f64,
    /// A path that it may take instead while it is before this length \[m\].
    other: Option<(Disc, f64)>,
}

impl<S: HostScalar> Robot<S> {
    fn new(disc: Disc, doubt: [f64; 2]) -> Option<Self> {
        let disc = disc.rounded::<S>();
        // Tests are short.
        let course: &'static Course<S> = Box::leak(Box::new(Course::new(&disc).ok()?));
        let route = Route::new(&disc);
        Some(Self { disc, route, course, at: 0.0, speed: 0.0, doubt, stops_until: 0.0, other: None })
    }

    fn length(&self) -> f64 {
        self.course.motion().path().length().to_f64()
    }

    fn progress(&self) -> Progress<S> {
        let end = self.length();
        let [lo, hi] = [(self.at - self.doubt[0]).max(0.0), (self.at + self.doubt[1]).min(end)];
        let stop = (hi + self.speed * self.speed / (2.0 * BRAKE)).min(end);
        Progress { at: Interval::new(S::from_f64(lo), S::from_f64(hi)), stop: S::from_f64(stop) }
    }

    fn position(&self) -> (f64, f64) {
        self.route.at(self.at)
    }

    /// Goes on for a step, so that it can stop before the hold; returns whether it has to wait.
    fn drive(&mut self, hold: MovementAuthority<S>, stops: bool) -> bool {
        let end = self.length();
        let thought = (self.at + self.doubt[1]).min(end);
        let limit = match hold {
            MovementAuthority::Free => end,
            MovementAuthority::At(hold) => hold.to_f64().min(end),
            MovementAuthority::Inside => thought,
        };
        let left = limit - thought;
        let brakes = BrakingModel::new(BRAKE, 0.5 * STEP).expect("brakes");
        let wanted = if stops { 0.0 } else { brakes.speed(left - 0.5 * self.speed * STEP).min(SPEED) };
        let change = BRAKE * STEP;
        let speed = wanted.clamp((self.speed - change).max(0.0), self.speed + change);
        let stopping = speed == 0.0;
        let way = if stopping { self.speed * self.speed / (2.0 * BRAKE) } else { 0.5 * (self.speed + speed) * STEP };
        (self.at, self.speed) = ((self.at + way).min(end), speed);
        limit < end && left < THERE
    }

    fn has_arrived(&self) -> bool {
        self.at + self.doubt[1] >= self.length() - THERE
    }

    /// A way on from the end of its path, that stays in the arena; sometimes with a turn-off.
    fn next(&self, dice: &mut Dice) -> Option<Self> {
        let back = self.length() - BACK;
        let (x, y) = self.route.at(back);
        let last = self.disc.legs.last()?;
        let heading = self.disc.start[2] + self.disc.legs.iter().map(|leg| leg.sweep()).sum::<f64>();
        let heading = heading - last.with_length(BACK).sweep();
        let mut legs = vec![last.with_length(BACK)];
        // Round, if need be.
        legs.push(Leg::arc(dice.range(0.3, 1.0), dice.sign() * dice.range(0.1, PI)));
        legs.extend((0..1 + dice.below(2)).map(|_| leg(dice)));
        let shared = legs.len();
        let tail = |dice: &mut Dice| [leg(dice), Leg::Line(dice.range(0.3, 3.0))];
        let with = |legs: &[Leg], tail: [Leg; 2]| {
            let legs = legs.iter().copied().chain(tail).collect();
            Disc { radius: self.disc.radius, start: [x, y, heading % (2.0 * PI)], legs }
        };
        let disc = with(&legs, tail(dice));
        let mut robot = Self::new(disc.clone(), self.doubt)?;
        if dice.chance(0.5) {
            let other = with(&legs, tail(dice));
            robot.other = Some((other, legs[..shared].iter().map(|leg| leg.length()).sum()));
        }
        robot.at = self.at - back;
        robot.is_inside().then_some(robot)
    }

    fn is_inside(&self) -> bool {
        let length = self.length();
        (0..=40).all(|k| {
            let (x, y) = self.route.at(length * f64::from(k) / 40.0);
            x.abs() < ARENA && y.abs() < ARENA
        })
    }
}

/// A fleet that moves for so long \[s\], with new missions until then; then everybody has to arrive.
///
/// # Panics
/// With the seed, where two discs touch, a robot has to brake harder than it can, one does not arrive, or a refusal leaves
/// traces.
pub fn run<S: HostScalar>(seed: u64, robots: usize, missions_until: f64) -> Tally {
    let mut state = seed;
    let mut dice = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        Dice::seeded(state)
    };
    let exact = S::slack(S::from_f64(10.0)).to_f64() < 1e-12;
    let mut fleet = placed::<S>(&mut dice(), robots, exact);
    let tolerance = 8.0 * pcr_core::excess(&fleet[0].course.motion(), &fleet[0].course.motion()).to_f64() + 1e-9;
    let mut motions: Vec<Motion<'static, S>> = fleet.iter().map(|robot| robot.course.motion()).collect();
    let mut progress: Vec<Progress<S>> = fleet.iter().map(Robot::progress).collect();
    let storage =
        (vec![EcmEntry::EMPTY; REGIONS], vec![Piece::EMPTY; PIECES], vec![RegionPrecedence::EMPTY; 2 * REGIONS]);
    let mut orders = Table::build(storage.0, storage.1, storage.2, &motions).expect("room for a small fleet");
    let mut reaches = vec![CheckState::EMPTY; robots];
    let width = S::from_f64(if exact { 0.05 } else { 0.06 });
    let tolerances = CheckTolerances { width, gain: S::from_f64(1e-3) };
    let mut tally = Tally { clearance: f64::INFINITY, ..Tally::default() };
    // What each robot has heard of each other one.
    let mut heard: Vec<Vec<Progress<S>>> = vec![progress.clone(); robots];
    for tick in 0.. {
        let time = f64::from(tick) * STEP;
        let mut dice = dice();
        for (place, robot) in progress.iter_mut().zip(&fleet) {
            *place = robot.progress();
        }
        if time < missions_until && dice.chance(0.5) {
            let agent = dice.below(fleet.len());
            let (next, changes) = proposal(&fleet[agent], &mut dice);
            if let Some(next) = next {
                let mission = PathProposal { agent, motion: next.course.motion(), progress: next.progress() };
                let before = trace(&orders, &motions, &progress);
                let random = seed.wrapping_add(tick as u64);
                let prefer = |region: &pcr_core::RegionRef<'_, S>| {
                    let odd = (region.other() as u64 + random).is_multiple_of(2);
                    if odd { PassingState::First } else { PassingState::Second }
                };
                match orders.admit(&mut motions, &mut progress, mission, tolerances, &mut reaches, prefer) {
                    Ok(()) => {
                        fleet[agent] = next;
                        tally.admitted += 1;
                        tally.changed += u32::from(changes);
                        heard.iter_mut().for_each(|heard| heard[agent] = progress[agent]);
                    }
                    Err(refused) => {
                        let after = trace(&orders, &motions, &progress);
                        assert_eq!(before, after, "seed {seed}: {refused} leaves traces");
                        match refused {
                            AdmissionError::Stuck { .. } => tally.stuck += 1,
                            AdmissionError::Blocked { .. } => tally.blocked += 1,
                            AdmissionError::Full(CapacityError::Pieces { .. } | CapacityError::Regions { .. }) => {
                                panic!("seed {seed}: no room")
                            }
                            _ => panic!("seed {seed}: {refused}"),
                        }
                    }
                }
            }
        }
        if dice.chance(0.05) {
            let found = orders.check(&motions, &progress, tolerances, &mut reaches);
            assert_eq!(found, Ok(()), "seed {seed}: what was admitted stays so, {time} s");
        }
        // News are lost; what is heard twice is no news.
        for (k, heard) in heard.iter_mut().enumerate() {
            for (j, place) in heard.iter_mut().enumerate() {
                if j == k || dice.chance(0.3) {
                    *place = progress[j];
                }
            }
            let hold = orders.hold(&motions, k, heard).expect("the table of the fleet");
            let kept = hold.allows(progress[k].stop - S::from_f64(tolerance)) || fleet[k].speed == 0.0;
            assert!(kept, "seed {seed}: robot {k} cannot keep {hold:?} from {:?} at {time} s", progress[k]);
            let robot = &mut fleet[k];
            if time < missions_until && dice.chance(0.01) {
                robot.stops_until = time + dice.range(0.0, 8.0);
            }
            tally.waits += u32::from(robot.drive(hold, robot.stops_until > time));
        }
        if tick % 10 == 0 {
            let places: Vec<Progress<S>> = fleet.iter().map(Robot::progress).collect();
            orders.passed(&places);
        }
        let clearance = clearance(&fleet);
        assert!(clearance > -tolerance, "seed {seed}: contact by {clearance} m at {time} s");
        tally.clearance = tally.clearance.min(clearance);
        tally.time = time;
        if time >= missions_until && fleet.iter().all(Robot::has_arrived) {
            break;
        }
        let stands: Vec<usize> = (0..robots).filter(|&k| !fleet[k].has_arrived()).collect();
        assert!(time < missions_until + 600.0, "seed {seed}: {stands:?} do not arrive");
    }
    tally
}

/// Robots at rest at the ends of short paths, apart from one another.
fn placed<S: HostScalar>(dice: &mut Dice, robots: usize, exact: bool) -> Vec<Robot<S>> {
    let mut fleet: Vec<Robot<S>> = Vec::new();
    let mut k = 0;
    while fleet.len() < robots {
        k += 1;
        let (x, y) = (dice.range(-ARENA, ARENA) * 0.95, dice.range(-ARENA, ARENA) * 0.95);
        let start = [x, y, FRAC_PI_2 * f64::from(k % 4)];
        let radius = dice.range(0.1, 0.3);
        let disc = Disc { radius, start, legs: vec![Leg::Line(BACK)] };
        let doubt = if exact && dice.chance(0.5) { [0.0; 2] } else { [dice.range(1e-3, 0.02), dice.range(1e-3, 0.02)] };
        let Some(mut robot) = Robot::new(disc, doubt) else { continue };
        robot.at = robot.length() - doubt[1];
        let (x, y) = robot.position();
        let free = fleet.iter().all(|other| {
            let at = other.position();
            (at.0 - x).hypot(at.1 - y) > robot.disc.radius + other.disc.radius + 3.0 * BACK
        });
        if free {
            fleet.push(robot);
        }
        if k % 20 == 0 {
            *dice = Dice::seeded(k as u64 ^ (dice.face() * 1e9) as u64);
        }
    }
    fleet
}

/// A new mission, or another end of the present one on the way, with whether it is that.
fn proposal<S: HostScalar>(robot: &Robot<S>, dice: &mut Dice) -> (Option<Robot<S>>, bool) {
    match &robot.other {
        Some((other, until)) if robot.progress().stop.to_f64() < *until && dice.chance(0.2) => {
            let changed = Robot::new(other.clone(), robot.doubt).map(|next| Robot {
                at: robot.at,
                speed: robot.speed,
                stops_until: robot.stops_until,
                other: None,
                ..next
            });
            (changed.filter(Robot::is_inside), true)
        }
        _ if robot.has_arrived() && robot.speed == 0.0 => (robot.next(dice), false),
        _ => (None, false),
    }
}

/// All that a refusal must not change.
fn trace<S: HostScalar>(orders: &Table<S>, motions: &[Motion<'_, S>], progress: &[Progress<S>]) -> String {
    let row = |agent: usize| {
        let passes = orders
            .row(motions, agent)
            .expect("the table of the fleet")
            .map(|(place, region, pass)| (place, region.other(), region.length(), pass));
        format!("{:?} {:?}", orders.hold(motions, agent, progress), passes.collect::<Vec<_>>())
    };
    (0..motions.len()).map(row).collect::<Vec<_>>().join("\n") + &format!("{progress:?}")
}

/// Least distance between two discs \[m\].
fn clearance<S: HostScalar>(fleet: &[Robot<S>]) -> f64 {
    let pairs = (0..fleet.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
    let apart = |(a, b): (usize, usize)| {
        let (p, q) = (fleet[a].position(), fleet[b].position());
        (p.0 - q.0).hypot(p.1 - q.1) - fleet[a].disc.radius - fleet[b].disc.radius
    };
    pairs.map(apart).fold(f64::INFINITY, f64::min)
}
