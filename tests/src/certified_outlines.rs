//! Tables and motions of random pairs of outlines, proved by `pcr_certify::outline`.
//!
//! Every second pair touches: at lengths of both paths the outlines are exactly R apart along a normal, which is that of an edge, or normal to
//! the velocity of a corner, where slices begin, end and split. Others lie on a grid, where edges are parallel and
//! touching is exact. Reference points are inside, outside, on a corner and on an edge of an outline whose arc has its centre there.

use crate::case_ranges::{CaseRange, Total, in_every_format};
use crate::generators::Dice;
use pcr_certify::outline::motion::{Answer, Driven, Encounter as Proof};
use pcr_certify::outline::table::Checker;
use pcr_certify::outline::{
    Body, RawBody, RawBodySegment, RawCourse, RawHeading, RawOutline, RawOutlinePair, RawOutlinePiece, RawOutlineTable,
};
use pcr_certify::raw::{RawAngle, RawRegion};
use pcr_certify::table::CoverageMargin;
use pcr_core::{
    Ecm, EcmEntry, Encounter, InvalidInput, Limits, Motion, Outline, Path, Piece, Point, Pose, Profile, TurnSide,
    Vector, excess,
};
use pcr_planning::checker_input;
use pcr_planning::fleet::HostScalar;
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt;

/// What has come of many pairs of outlines.
#[derive(Clone, Debug, Default)]
pub struct OutlineProofs {
    /// Pairs whose table and motions are proved.
    pub proved: u64,
    /// Pairs that the format or a table cannot hold.
    pub refused: u64,
    /// Pieces.
    pub pieces: u64,
    /// Pieces that are one of several intervals.
    pub ranked: u64,
    /// Contacts in time.
    pub contacts: u64,
    /// What is refuted, with the seed.
    pub refuted: Vec<String>,
    /// What the checker's rounding does not tell, with the seed.
    pub undecided: Vec<String>,
}

impl Total for OutlineProofs {
    fn add(&mut self, other: &Self) {
        self.proved += other.proved;
        self.refused += other.refused;
        self.pieces += other.pieces;
        self.ranked += other.ranked;
        self.contacts += other.contacts;
        self.refuted.extend_from_slice(&other.refuted);
        self.undecided.extend_from_slice(&other.undecided);
    }
}

impl OutlineProofs {
    /// All pairs.
    pub fn cases(&self) -> u64 {
        self.proved + self.refused + (self.refuted.len() + self.undecided.len()) as u64
    }
}

impl fmt::Display for OutlineProofs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { proved, refused, pieces, ranked, contacts, refuted, undecided } = self;
        write!(f, "{proved} proved ({refused} refused by the format), {} refuted, ", refuted.len())?;
        write!(f, "{} undecided; {pieces} pieces, {ranked} one of several; {contacts} contacts", undecided.len())
    }
}

/// A body on a path, before it is rounded to a format.
#[derive(Clone, Debug)]
struct Case {
    start: [f64; 3],
    /// Length, the radius of an arc, positive to the left, and whether the body keeps its heading on it.
    legs: Vec<(f64, Option<f64>, bool)>,
    corners: Vec<[f64; 2]>,
    radius: f64,
    set_off: f64,
}

/// A place of the reference point, its heading, and its velocity: of the point, and the rate of turn.
#[derive(Clone, Copy, Debug)]
struct Posture {
    at: [f64; 2],
    heading: f64,
    /// Direction of travel.
    way: f64,
    turn: f64,
}

impl Posture {
    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.heading.sin_cos();
        [self.at[0] + cos * x - sin * y, self.at[1] + sin * x + cos * y]
    }

    /// The velocity of a corner, for a speed of 1 along the path.
    fn velocity(&self, corner: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.way.sin_cos();
        let [x, y] = self.place(corner);
        [cos - self.turn * (y - self.at[1]), sin + self.turn * (x - self.at[0])]
    }
}

impl Case {
    fn length(&self) -> f64 {
        self.legs.iter().map(|(length, ..)| length).sum()
    }

    fn posture(&self, mut length: f64) -> Posture {
        let [x, y, heading] = self.start;
        let mut now = Posture { at: [x, y], heading, way: heading, turn: 0.0 };
        for &(leg, bend, steady) in &self.legs {
            let part = length.clamp(0.0, leg);
            let (from, turn) = (now.way, bend.map_or(0.0, f64::recip));
            let to = from + turn * part;
            let way = bend.map_or([part * from.cos(), part * from.sin()], |radius| {
                [radius * (to.sin() - from.sin()), radius * (from.cos() - to.cos())]
            });
            let turn = if steady { 0.0 } else { turn };
            let heading = now.heading + turn * part;
            now = Posture { at: [now.at[0] + way[0], now.at[1] + way[1]], heading, way: to, turn };
            length -= leg;
            if length <= 0.0 {
                break;
            }
        }
        now
    }

    fn random(dice: &mut Dice, grid: bool) -> Self {
        let q = |x: f64| if grid { (4.0 * x).round() / 4.0 } else { x };
        let heading = if grid { [0.0, FRAC_PI_2, PI, -FRAC_PI_2][dice.below(4)] } else { dice.range(-3.1, 3.1) };
        let start = [q(dice.range(-1.5, 1.5)), q(dice.range(-1.5, 1.5)), heading];
        let legs: Vec<_> = (0..1 + dice.below(3))
            .map(|_| {
                if dice.chance(0.4) {
                    return (q(dice.range(0.5, 2.0)), None, false);
                }
                let radius = if dice.chance(0.2) { 0.0625 } else { q(dice.range(0.3, 2.0)).max(0.25) };
                let sweep = if grid { [0.5, 1.0, 2.0][dice.below(3)] * PI } else { dice.range(0.2, 6.0) };
                (radius * sweep, Some(if dice.chance(0.5) { radius } else { -radius }), dice.chance(0.3))
            })
            .collect();
        let (a, b) = (q(dice.range(0.2, 0.8)).max(0.25), q(dice.range(0.1, 0.5)).max(0.25));
        let mut corners = match dice.below(8) {
            0..=3 => vec![[-a, -b], [a, -b], [a, b], [-a, b]],
            4 => vec![[-a, 0.0], [a, 0.0]],
            5 => vec![[-a, -b], [a, 0.0], [-a, b]],
            6 => {
                let count = 5 + dice.below(12);
                let angles =
                    (0..count).map(|k| std::f64::consts::TAU * (k as f64 + dice.range(0.0, 0.5)) / count as f64);
                angles.map(|angle| [a * angle.cos(), b * angle.sin()]).collect()
            }
            _ => vec![[0.0, 0.0]],
        };
        // Where the reference point lies: in the middle, outside, or so that the centre of the first arc is on a corner or on an edge.
        let bend = legs.iter().find_map(|(_, bend, _)| *bend);
        let middle = |k: usize, corners: &[[f64; 2]]| {
            let [one, two] = [corners[k], corners[(k + 1) % corners.len()]];
            [0.5 * (one[0] + two[0]), 0.5 * (one[1] + two[1])]
        };
        let k = dice.below(corners.len());
        let by = match (dice.below(8), bend) {
            (0, Some(radius)) => [-corners[k][0], radius - corners[k][1]],
            (1, Some(radius)) => {
                let [x, y] = middle(k, &corners);
                [-x, radius - y]
            }
            (2, _) => [q(dice.range(-2.0, 2.0)), q(dice.range(-2.0, 2.0))],
            _ => [0.0; 2],
        };
        corners.iter_mut().for_each(|corner| *corner = [corner[0] + by[0], corner[1] + by[1]]);
        let radius = [0.0, 0.0625, 0.25][dice.below(3)] + if corners.len() == 1 { 0.25 } else { 0.0 };
        Self { start, legs, corners, radius, set_off: if dice.chance(0.5) { 0.0 } else { dice.range(0.0, 2.0) } }
    }

    /// Moves the body so that at lengths of both paths it touches the other from outside.
    fn touch(&mut self, other: &Self, dice: &mut Dice) {
        let [own, their] = [&*self, other].map(|case| case.posture(dice.range(0.0, case.length())));
        let corner = |dice: &mut Dice, case: &Self| case.corners[dice.below(case.corners.len())];
        let edge_normal = |dice: &mut Dice, case: &Self, posture: &Posture| {
            let k = dice.below(case.corners.len());
            let [one, two] = [case.corners[k], case.corners[(k + 1) % case.corners.len()]].map(|at| posture.place(at));
            [two[1] - one[1], one[0] - two[0]]
        };
        // The normal from the other to this one.
        let normal = match dice.below(5) {
            0 => edge_normal(dice, other, &their),
            1 => edge_normal(dice, self, &own).map(|x| -x),
            2 => {
                let [x, y] = their.velocity(corner(dice, other));
                if dice.chance(0.5) { [-y, x] } else { [y, -x] }
            }
            3 => {
                let [x, y] = own.velocity(corner(dice, self));
                if dice.chance(0.5) { [-y, x] } else { [y, -x] }
            }
            _ => {
                let (sin, cos) = dice.range(-PI, PI).sin_cos();
                [cos, sin]
            }
        };
        let norm = normal[0].hypot(normal[1]);
        let normal = if norm > 0.0 { normal.map(|x| x / norm) } else { [1.0, 0.0] };
        let farthest = |case: &Self, posture: &Posture, sign: f64| {
            let places = case.corners.iter().map(|corner| posture.place(*corner));
            let along = |[x, y]: [f64; 2]| sign * (x * normal[0] + y * normal[1]);
            places.max_by(|one, two| along(*one).total_cmp(&along(*two))).expect("a corner")
        };
        let (to, from) = (farthest(other, &their, 1.0), farthest(self, &own, -1.0));
        let off = [0.0, 1e-13, -1e-13, 1e-9, -1e-9, 1e-6, -1e-6][dice.below(7)];
        let apart = self.radius + other.radius + off;
        for k in 0..2 {
            self.start[k] += to[k] + apart * normal[k] - from[k];
        }
    }
}

/// The pair of a seed.
fn pair(seed: u64) -> [Case; 2] {
    let mut dice = Dice::seeded(seed);
    let grid = dice.chance(0.25);
    let mut pair = [Case::random(&mut dice, grid), Case::random(&mut dice, grid)];
    if !grid && dice.chance(0.7) {
        let [first, second] = &mut pair;
        second.touch(first, &mut dice);
    }
    pair
}

/// A body in a number format.
struct Held<S: HostScalar> {
    path: Path<S, 3>,
    profile: Profile<S, 3>,
    outline: Outline<S, 16>,
    corners: Vec<[f64; 2]>,
    heading: S::Angle,
    start: S,
}

impl<S: HostScalar> Held<S> {
    fn new(case: &Case) -> Result<Self, InvalidInput> {
        let [x, y, heading] = case.start;
        let heading = S::angle(heading).ok_or(InvalidInput::OutOfRange("heading"))?;
        let mut path = Path::starting_at(Pose { position: Point::new(S::from_f64(x), S::from_f64(y)), heading })?;
        for &(length, bend, steady) in &case.legs {
            let length = S::from_f64(length);
            path = match bend {
                None => path.line(length)?,
                Some(radius) => {
                    let turn = if radius > 0.0 { TurnSide::Left } else { TurnSide::Right };
                    let radius = S::from_f64(radius.abs());
                    if steady { path.steady_arc(radius, turn, length) } else { path.arc(radius, turn, length) }?
                }
            };
        }
        let limits = Limits { speed: S::from_f64(1.0), acceleration: S::from_f64(1.0) };
        let profile = Profile::rest_to_rest(path.as_path().length(), limits)?;
        let corners = case.corners.iter().map(|corner| corner.map(S::from_f64));
        let vectors: Vec<_> = corners.clone().map(|[x, y]| Vector { x, y }).collect();
        let outline = Outline::polygon(vectors, S::from_f64(case.radius))?;
        let corners = corners.map(|corner| corner.map(S::to_f64)).collect();
        Ok(Self { path, profile, outline, corners, heading, start: S::from_f64(case.set_off) })
    }

    fn motion(&self) -> Result<Motion<'_, S>, InvalidInput> {
        Motion::with_outline(self.path.as_path(), self.profile.as_profile(), &self.outline, self.start)
    }

    /// The body as plain numbers for the checker.
    fn raw(&self, id: u64, motion: &Motion<'_, S>) -> RawBody {
        let agent = checker_input::agent(id, motion, self.heading, &[]);
        // Both turn on arcs, the body not on all of them.
        let (mut way, mut heading) = (S::radians(self.heading), S::radians(self.heading));
        let parts = motion.path().segments().iter();
        let segments = agent.path.segments.iter().zip(parts).map(|(segment, part)| {
            let turned = segment.radius.map_or(0.0, |radius| segment.length / radius);
            let raw = RawBodySegment {
                course: segment.radius.map_or(RawCourse::Line, |radius| RawCourse::Arc { radius }),
                length: segment.length,
                turns: vec![],
                heading: match part.is_steady() {
                    true => RawHeading::Steady(RawAngle::Radians(heading)),
                    false => RawHeading::Along(RawAngle::Radians(heading - way)),
                },
                from: segment.from,
                to: segment.to,
            };
            way += turned;
            heading += if part.is_steady() { 0.0 } else { turned };
            raw
        });
        RawBody {
            id,
            outline: RawOutline { corners: self.corners.clone(), radius: motion.outline().radius().to_f64() },
            start: agent.path.start,
            direction: agent.path.heading,
            segments: segments.collect(),
            rounding: agent.path.rounding,
            jump: 1e-6,
            step: agent.path.step,
            travel: agent.travel,
        }
    }
}

/// What has come of one pair.
enum Verdict {
    Refused,
    Proved,
    Refuted(String),
    Undecided(String),
}

fn prove<S: HostScalar>(seed: u64, proofs: &mut OutlineProofs) -> Verdict {
    let cases = pair(seed);
    let [Ok(one), Ok(two)] = cases.each_ref().map(Held::<S>::new) else { return Verdict::Refused };
    let (Ok(first), Ok(second)) = (one.motion(), two.motion()) else { return Verdict::Refused };
    let motions = [first, second];
    let Ok(ecm) = Ecm::build(vec![EcmEntry::EMPTY; 200], vec![Piece::EMPTY; 2000], &motions) else {
        return Verdict::Refused;
    };
    let ends = |interval: pcr_core::Interval<S>| [interval.lo.to_f64(), interval.hi.to_f64()];
    let (mut regions, mut pieces) = (vec![], vec![]);
    for (place, region) in ecm.pair(&motions, 0, 1).expect("its fleet").enumerate() {
        let times = [ends(region.clone().swapped().time()), ends(region.time())];
        let lengths = [ends(region.length()), ends(region.other_length())];
        regions.push(RawRegion { lengths, times: Some(times) });
        pieces.extend(region.pieces().map(|piece| RawOutlinePiece {
            segments: piece.segments,
            lengths: [ends(piece.length), ends(piece.other_length)],
            rank: piece.rank.unwrap_or([0, 1]),
            region: place,
        }));
    }
    proofs.pieces += pieces.len() as u64;
    proofs.ranked += pieces.iter().filter(|piece| piece.rank[1] > 1).count() as u64;
    let bodies = vec![one.raw(1, &motions[0]), two.raw(2, &motions[1])];
    let most = excess(&motions[0], &motions[1]).to_f64();
    let pairs = vec![RawOutlinePair { bodies: [0, 1], excess: most, regions, pieces }];
    let table = RawOutlineTable { bodies, pairs, apart: None };
    let found = Checker::new(&table).and_then(|checker| checker.check(CoverageMargin::Needed));
    let found = found.unwrap_or_else(|wrong| panic!("{seed} in {}: {wrong}", S::NAME)).findings;
    if let Some(witness) = found.refuted.first() {
        return Verdict::Refuted(format!("{seed}: {witness:?}"));
    }
    let encounter = Encounter::new(&motions[0], &motions[1]);
    let contacts: Vec<_> = encounter.contacts(encounter.time()).map(ends).collect();
    proofs.contacts += contacts.len() as u64;
    let bodies: Vec<Body<'_>> = table.bodies.iter().map(|raw| Body::new(raw).expect("the table was checked")).collect();
    let span = ends(encounter.time());
    let driven: Vec<_> = bodies.iter().map(|body| Driven::new(body, span).expect("a body in motion")).collect();
    let tolerance = encounter.tolerance().to_f64();
    let answer = Proof::new(&driven[0], &driven[1]).are_conflicts(span, &contacts, tolerance, &mut 0);
    match (answer, found.undecided.first()) {
        (Answer::Refuted(moment), _) => Verdict::Refuted(format!("{seed} in time: {moment:?}")),
        (_, Some(witness)) => Verdict::Undecided(format!("{seed}: {witness:?}")),
        (Answer::Undecided(moment), None) => Verdict::Undecided(format!("{seed} in time: {moment:?}")),
        (Answer::Proved, None) => Verdict::Proved,
    }
}

/// Proves the tables and contacts of the pairs with the seeds `first`, `first + 1`, ...
pub fn run<S: HostScalar>(first: u64, count: u64) -> OutlineProofs {
    let mut proofs = OutlineProofs::default();
    for seed in first..first + count {
        match prove::<S>(seed, &mut proofs) {
            Verdict::Refused => proofs.refused += 1,
            Verdict::Proved => proofs.proved += 1,
            Verdict::Refuted(what) => proofs.refuted.push(what),
            Verdict::Undecided(what) => proofs.undecided.push(what),
        }
    }
    proofs
}

/// The formats by name.
pub const FORMATS: &[(&str, CaseRange<OutlineProofs>)] = &in_every_format!(run);
