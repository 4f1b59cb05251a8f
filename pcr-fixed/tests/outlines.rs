//! Regions of outlines in fixed point, against an independent distance in `f64`: nothing within R is lost, and nothing
//! beyond R + ε is invented.

use pcr_core::{
    Ecm, EcmEntry, Encounter, Motion, Outline, Path, Piece, Point, Pose, Profile, RegionRef, TurnSide, Vector, excess,
};
use pcr_fixed::{Q, Turns};
use std::f64::consts::{FRAC_PI_2, PI};

struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
    fn within(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }
    fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }
}

/// The distance of two polygons by all of their sides, crossings and inclusion.
fn oracle(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    let minus = |u: [f64; 2], v: [f64; 2]| [u[0] - v[0], u[1] - v[1]];
    let cross = |u: [f64; 2], v: [f64; 2]| u[0] * v[1] - u[1] * v[0];
    let side = |p: [f64; 2], s: [f64; 2], e: [f64; 2]| cross(minus(e, s), minus(p, s));
    let inside = |p, poly: &[[f64; 2]]| {
        poly.len() > 2 && (0..poly.len()).all(|k| side(p, poly[k], poly[(k + 1) % poly.len()]) >= 0.0)
    };
    if inside(a[0], b) || inside(b[0], a) {
        return 0.0;
    }
    let to = |p: [f64; 2], s: [f64; 2], e: [f64; 2]| {
        let (d, w) = (minus(e, s), minus(p, s));
        let square = d[0] * d[0] + d[1] * d[1];
        let t = if square > 0.0 { ((w[0] * d[0] + w[1] * d[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
        (w[0] - t * d[0]).hypot(w[1] - t * d[1])
    };
    let mut least = f64::MAX;
    for i in 0..a.len() {
        for j in 0..b.len() {
            let (p, q, r, s) = (a[i], a[(i + 1) % a.len()], b[j], b[(j + 1) % b.len()]);
            if side(r, p, q) * side(s, p, q) < 0.0 && side(p, r, s) * side(q, r, s) < 0.0 {
                return 0.0;
            }
            least = least.min(to(p, r, s)).min(to(q, r, s)).min(to(r, p, q)).min(to(s, p, q));
        }
    }
    least
}

/// A segment: radius of an arc or lever of a turn in place, negative to the right, and length \[m\].
enum Step {
    Line(f64),
    Arc(f64, f64),
    /// An arc on which the body keeps its heading.
    Steady(f64, f64),
    Pivot(f64, f64),
    /// Change of gear: the direction of travel turns by half a turn, the body does not.
    Reverse,
}

/// An agent: its segments, and what is exact of them in the format.
struct Agent<const F: u32> {
    pose: [f64; 3],
    /// Angle from the direction of travel at the start to the body.
    facing: f64,
    segments: Vec<Step>,
    path: Path<Q<F>, 3>,
    outline: Outline<Q<F>, 8>,
    corners: Vec<[f64; 2]>,
    radius: f64,
}

fn q<const F: u32>(x: f64) -> Q<F> {
    Q::from_f64(x).unwrap()
}

impl<const F: u32> Agent<F> {
    fn random(random: &mut Random, turns: bool) -> Self {
        let grid = random.below(3) == 0;
        let on = |x: f64| if grid { (8.0 * x).round() / 8.0 } else { x };
        let heading = if grid {
            Turns::from_bits((random.below(4) as i32) << 30)
        } else {
            Turns::from_radians(random.within(-3.0, 3.0)).unwrap()
        };
        let (x, y) = (q::<F>(on(random.within(-1.5, 1.5))), q::<F>(on(random.within(-1.5, 1.5))));
        let mut path = Path::starting_at(Pose { position: Point::new(x, y), heading }).unwrap();
        let mut segments = Vec::new();
        let facing = Turns::from_radians([0.0, PI, random.within(-3.0, 3.0)][random.below(3)]).unwrap();
        let facing = if turns { facing } else { Turns::from_bits(0) };
        path = path.facing(facing).unwrap();
        for _ in 0..1 + random.below(3) {
            if turns && random.below(2) == 0 {
                path = path.reverse().unwrap();
                segments.push(Step::Reverse);
            }
            if turns && random.below(2) == 0 {
                let lever = q::<F>([1.0, 0.25 + on(random.within(0.0, 1.5))][random.below(2)]);
                let quarters = q::<F>(FRAC_PI_2 * (1 + random.below(4)) as f64);
                let sweep = if random.below(2) == 0 { quarters } else { q::<F>(random.within(0.1, 6.0)) };
                let left = random.below(2) == 0;
                let before = path.as_path().length();
                path = path.pivot(lever, if left { sweep } else { -sweep }).unwrap();
                let sign = if left { 1.0 } else { -1.0 };
                segments.push(Step::Pivot(sign * lever.to_f64(), (path.as_path().length() - before).to_f64()));
            } else if random.below(2) == 0 {
                let length = q::<F>(0.125 + on(random.within(0.125, 2.0)));
                path = path.line(length).unwrap();
                segments.push(Step::Line(length.to_f64()));
            } else {
                let radius = q::<F>(0.25 + on(random.within(0.0, 1.5)));
                let length = q::<F>(radius.to_f64() * random.within(0.1, 5.0));
                let turn = if random.below(2) == 0 { TurnSide::Left } else { TurnSide::Right };
                let sign = if turn == TurnSide::Left { 1.0 } else { -1.0 };
                let numbers = (sign * radius.to_f64(), length.to_f64());
                if turns && random.below(2) == 0 {
                    path = path.steady_arc(radius, turn, length).unwrap();
                    segments.push(Step::Steady(numbers.0, numbers.1));
                } else {
                    path = path.arc(radius, turn, length).unwrap();
                    segments.push(Step::Arc(numbers.0, numbers.1));
                }
            }
        }
        let number = |x: f64| q::<F>(on(x));
        let radius = number(random.within(0.0, 0.3));
        let (ahead, behind, left) = (random.within(0.1, 1.0), random.within(0.1, 1.0), random.within(0.1, 0.6));
        let [ahead, behind, left] = [ahead, behind, left].map(|x| number(0.125 + x));
        let outline = match if turns { random.below(4) } else { random.below(3) } {
            3 => Outline::disc(radius + q(0.125)),
            0 => Outline::capsule(Vector { x: -behind, y: left }, Vector { x: ahead, y: q(0.0) }, radius + q(0.125)),
            1 => Outline::polygon(
                [(-behind, -left), (ahead, q(0.0)), (-behind, left)].map(|(x, y)| Vector { x, y }),
                radius,
            ),
            _ => Outline::rectangle(ahead, behind, left, left, radius),
        };
        let outline = outline.unwrap();
        let corners =
            outline.as_outline().corners().iter().map(|corner| [corner.at().x.to_f64(), corner.at().y.to_f64()]);
        let mut corners: Vec<_> = corners.collect();
        if corners.is_empty() {
            corners.push([0.0; 2]);
        }
        let radius = outline.as_outline().radius().to_f64();
        let pose = [x.to_f64(), y.to_f64(), heading.to_radians()];
        Self { pose, facing: facing.to_radians(), segments, path, outline, corners, radius }
    }

    fn at(&self, length: f64) -> Vec<[f64; 2]> {
        let ([mut x, mut y, mut heading], mut facing, mut rest) = (self.pose, self.facing, length);
        for step in &self.segments {
            let (Step::Line(length) | Step::Arc(_, length) | Step::Steady(_, length) | Step::Pivot(_, length)) = step
            else {
                (heading, facing) = (heading + PI, facing - PI);
                continue;
            };
            let way = rest.clamp(0.0, *length);
            match step {
                Step::Line(_) => (x, y) = (x + way * heading.cos(), y + way * heading.sin()),
                Step::Arc(radius, _) | Step::Steady(radius, _) => {
                    let next = heading + way / radius;
                    (x, y) = (x + radius * (next.sin() - heading.sin()), y - radius * (next.cos() - heading.cos()));
                    if let Step::Steady(..) = step {
                        facing -= next - heading;
                    }
                    heading = next;
                }
                Step::Pivot(lever, _) => heading += way / lever,
                Step::Reverse => {}
            }
            rest -= way;
        }
        let (sin, cos) = (heading + facing).sin_cos();
        self.corners.iter().map(|[a, b]| [x + a * cos - b * sin, y + a * sin + b * cos]).collect()
    }
}

fn campaign<const F: u32>(seeds: std::ops::Range<u64>, turns: bool) {
    let (mut inside, mut refused) = (0, 0);
    let count = seeds.end - seeds.start;
    for seed in seeds {
        let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
        (0..4).for_each(|_| {
            random.unit();
        });
        let agents = [Agent::<F>::random(&mut random, turns), Agent::random(&mut random, turns)];
        let profiles = agents
            .each_ref()
            .map(|agent| Profile::<Q<F>, 1>::from_pieces(q(1.0), [(agent.path.as_path().length(), q(0.0))]).unwrap());
        let motion = |k: usize| {
            Motion::with_outline(agents[k].path.as_path(), profiles[k].as_profile(), &agents[k].outline, q(0.0))
        };
        let (Ok(first), Ok(second)) = (motion(0), motion(1)) else {
            refused += 1;
            continue;
        };
        let fleet = [first, second];
        let (radius, eps) = (agents[0].radius + agents[1].radius, excess(&fleet[0], &fleet[1]).to_f64());
        let ecm = Ecm::build([EcmEntry::EMPTY; 64], [Piece::EMPTY; 512], &fleet).unwrap();
        let regions: Vec<RegionRef<'_, Q<F>>> = ecm.pair(&fleet, 0, 1).unwrap().collect();
        let [l, s] = agents.each_ref().map(|agent| agent.path.as_path().length().to_f64());
        let mut check = |a: f64, b: f64| {
            // At 1 m/s, times are lengths.
            let (length, time) = (q::<F>(a.clamp(0.0, l)), q::<F>(b.clamp(0.0, s)));
            let other = fleet[1].length_at(time).to_f64();
            let f = oracle(&agents[0].at(length.to_f64()), &agents[1].at(other));
            let holds = regions.iter().any(|region| region.contains(time, length));
            assert!(f >= radius - 1e-12 || holds, "seed {seed} of {F}: lost {a} {b}: {:e}, eps {eps:e}", f - radius);
            assert!(
                f <= radius + eps + 1e-12 || !holds,
                "seed {seed} of {F}: invented {a} {b}: {:e}, eps {eps:e}",
                f - radius
            );
            inside += u32::from(f < radius);
        };
        for _ in 0..30 {
            check(random.within(0.0, l), random.within(0.0, s));
        }
        for region in &regions {
            for _ in 0..4 {
                let time = random.within(region.time().lo.to_f64(), region.time().hi.to_f64());
                for part in region.slice_at(q(time)) {
                    for by in [0.0, 1e-4, -1e-4, 1e-2, -1e-2] {
                        check(part.lo.to_f64() + by, time);
                        check(part.hi.to_f64() + by, time);
                    }
                }
            }
        }
        let encounter = Encounter::new(&fleet[0], &fleet[1]);
        let contacts: Vec<_> = encounter.contacts(encounter.time()).collect();
        let tolerance = encounter.tolerance().to_f64();
        for k in 0..=50 {
            let time = q::<F>(encounter.time().hi.to_f64() * f64::from(k) / 50.0).min(encounter.time().hi);
            let [a, b] = fleet.each_ref().map(|motion| motion.length_at(time).to_f64());
            let f = oracle(&agents[0].at(a), &agents[1].at(b));
            let holds = contacts.iter().any(|contact| contact.contains(time));
            assert!(f >= radius - 1e-12 || holds, "seed {seed} of {F}: missed {time:?}: {:e}", f - radius);
            assert!(
                f <= radius + tolerance + 1e-12 || !holds,
                "seed {seed} of {F}: invented {time:?}: {:e}, {tolerance:e}",
                f - radius
            );
        }
    }
    assert!(inside > 2000 && refused < count / 4, "{F}: {inside} {refused} of {count}");
}

#[test]
fn regions_of_outlines_in_q20_hold_what_the_oracle_says() {
    campaign::<20>(0..1200, false);
}

#[test]
fn regions_of_outlines_in_q16_hold_what_the_oracle_says() {
    campaign::<16>(1000..2200, false);
}

#[test]
fn regions_of_outlines_in_q12_hold_what_the_oracle_says() {
    campaign::<12>(2000..3200, false);
}

#[test]
fn regions_of_outlines_that_turn_in_place_change_gear_and_keep_their_heading_hold_what_the_oracle_says() {
    campaign::<20>(3000..4200, true);
    campaign::<16>(4000..5200, true);
    campaign::<12>(5000..6200, true);
}
