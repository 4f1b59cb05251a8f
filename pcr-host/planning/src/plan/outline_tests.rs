//! Plans of outlines, judged by polygons at many times.

use super::*;
use crate::check::CheckReport;
use crate::outline_judge::{Course, Outline, TRUCK, read};
use pcr_formats::scenario::{Agent, MotionSpec};
use pcr_formats::splitmix64::SplitMix64;
use std::f64::consts::{FRAC_PI_2, PI};

/// A fleet, in both ways in which it is described here.
struct JudgedFleet {
    scenario: Scenario,
    outlines: Vec<Outline>,
    courses: Vec<Course>,
}

impl JudgedFleet {
    fn new(agents: Vec<(Outline, Course)>) -> Self {
        let values: Vec<_> = agents.iter().zip(1..).map(|((outline, course), id)| course.agent(id, outline)).collect();
        let (outlines, courses) = agents.into_iter().unzip();
        Self { scenario: read(&values), outlines, courses }
    }

    fn trucks(courses: Vec<Course>) -> Self {
        Self::new(courses.into_iter().map(|course| (Outline::polygon(&TRUCK), course)).collect())
    }

    fn plan(&self, method: PlanMethod) -> (PlanReport, Option<Scenario>) {
        PlanReport::compute(&self.scenario, &PlanOptions::new(method)).expect("an answer")
    }

    /// The least distance of any two at some times of a plan, smaller by a distance.
    fn least(&self, plan: &Scenario, smaller: f64) -> f64 {
        const STEPS: u32 = 1500;
        let ends = plan.agents.iter().zip(&self.courses).map(|(agent, course)| agent.t_start + time(agent, course));
        let end = ends.fold(0.0, f64::max);
        let at = |t: f64| {
            let those = plan.agents.iter().zip(&self.courses).zip(&self.outlines);
            let placed: Vec<Outline> = those
                .map(|((agent, course), outline)| {
                    outline.smaller(smaller).at(course.at(travelled(agent, course, t - agent.t_start)))
                })
                .collect();
            let pairs = placed.iter().enumerate().flat_map(|(k, a)| placed[..k].iter().map(move |b| a.apart(b)));
            pairs.fold(f64::INFINITY, f64::min)
        };
        (0..=STEPS).map(|k| at(end * f64::from(k) / f64::from(STEPS))).fold(f64::INFINITY, f64::min)
    }
}

/// How long an agent of a plan takes.
fn time(agent: &Agent, course: &Course) -> f64 {
    match &agent.motion {
        MotionSpec::Profile { pieces, .. } => pieces.iter().map(|piece| piece.duration).sum(),
        _ => course.duration(),
    }
}

/// How far an agent of a plan has come after a time.
fn travelled(agent: &Agent, course: &Course, time: f64) -> f64 {
    let MotionSpec::Profile { .. } = &agent.motion else { return course.after(time) };
    let (v0, pieces) = agent.motion.pieces(course.length());
    let (mut left, mut speed, mut way) = (time.max(0.0), v0, 0.0);
    for (duration, acceleration) in pieces {
        let own = left.min(duration);
        way += own * (speed + 0.5 * acceleration * own);
        (left, speed) = (left - own, speed + acceleration * own);
    }
    way.min(course.length())
}

fn lane(start: [f64; 3], length: f64) -> Course {
    Course { start, legs: vec![[length, 0.0]] }
}

/// Rounding of lengths, and what plans keep of one another for it \[m\].
const ROUNDED: f64 = 1e-6;

#[test]
fn trucks_that_pass_with_a_millimetre_between_them_wait_for_nobody() {
    for (apart, is_free) in [(0.801, true), (0.799, false)] {
        let fleet = JudgedFleet::trucks(vec![lane([0.0; 3], 8.0), lane([8.0, apart, PI], 8.0)]);
        for method in [PlanMethod::Delay, PlanMethod::Speed] {
            let (plan, solved) = fleet.plan(method);
            assert_eq!(solved.is_some(), is_free, "{apart} {method:?}: {plan:?}");
            if is_free {
                assert!(plan.agents.iter().all(|agent| agent.delay == 0.0 && (agent.t_end - 10.0).abs() < 1e-9));
                assert!(plan.costs.is_some_and(|costs| costs.proved), "{plan:?}");
                let proof = plan.certificate.as_ref().expect("a certificate");
                assert_eq!((proof.verdict, proof.outlines, proof.pairs), ("proved", 2, 1));
            } else {
                assert!(plan.unsolved[0].why.contains("head-on"), "{plan:?}");
            }
        }
    }
}

#[test]
fn trucks_that_cross_wait_as_long_as_their_outlines_touch() {
    let fleet = JudgedFleet::trucks(vec![lane([-4.0, 0.0, 0.0], 8.0), lane([0.0, -4.0, FRAC_PI_2], 8.0)]);
    let (plan, solved) = fleet.plan(PlanMethod::Delay);
    let solved = solved.expect("a plan");
    let wait = plan.agents.iter().map(|agent| agent.delay).fold(0.0, f64::max);
    // The second one reaches the first lane when the first one has left its own: 3 m to 5 m of both, at full speed.
    assert!((wait - 2.0).abs() < ROUNDED, "{wait}");
    assert!(fleet.least(&solved, ROUNDED) > 0.0);
    assert_eq!(CheckReport::compute::<f64>(&solved, false).expect("an answer").conflicts, []);
    // A moment earlier they touch.
    let mut earlier = solved.clone();
    let late = earlier.agents.iter_mut().find(|agent| agent.t_start > 0.0).expect("one that waits");
    late.t_start -= 1e-3;
    assert_eq!(CheckReport::compute::<f64>(&earlier, false).expect("an answer").conflicts.len(), 1);
    assert!(fleet.least(&earlier, 0.0) <= 0.0);
    assert_eq!(MotionCertificate::prove::<f64>(&earlier).expect("it fits").verdict, "contact");
}

#[test]
fn other_speeds_cost_no_more_than_delays() {
    // The second lane begins so near to the first that its truck is slow where they cross.
    let fleet = JudgedFleet::trucks(vec![lane([-4.0, 0.0, 0.0], 8.0), lane([0.0, -1.1, FRAC_PI_2], 6.0)]);
    let cost = |plan: &PlanReport| plan.costs.expect("a plan").sum_of_costs;
    let ((by_delay, _), (by_speed, solved)) = (fleet.plan(PlanMethod::Delay), fleet.plan(PlanMethod::Speed));
    assert!(cost(&by_speed) <= cost(&by_delay) + ROUNDED, "{} {}", cost(&by_speed), cost(&by_delay));
    assert!(fleet.least(&solved.expect("a plan"), ROUNDED) > 0.0);
    assert_eq!(by_speed.certificate.map(|proof| (proof.verdict, proof.outlines)), Some(("proved", 2)));
}

/// A course from a circle towards its middle and beyond.
fn across(dice: &mut SplitMix64) -> Course {
    let at = dice.uniform(-PI, PI);
    let (radius, side) = (dice.uniform(1.0, 3.0), if dice.below(2) == 0 { 1.0 } else { -1.0 });
    let legs = vec![
        [dice.uniform(2.0, 3.0), 0.0],
        [radius * dice.uniform(0.3, 1.2), side / radius],
        [dice.uniform(3.0, 4.0), 0.0],
    ];
    Course { start: [4.5 * at.cos(), 4.5 * at.sin(), at + PI + dice.uniform(-0.4, 0.4)], legs }
}

#[test]
fn plans_of_random_fleets_keep_their_polygons_apart() {
    const FLEETS: u64 = 40;
    let mut dice = SplitMix64(5656);
    let [mut planned, mut waits, mut tight] = [0; 3];
    for number in 0..FLEETS {
        let agents = (0..4).map(|_| (Outline::random(&mut dice), across(&mut dice)));
        let fleet = JudgedFleet::new(agents.collect());
        for method in [PlanMethod::Delay, PlanMethod::Speed] {
            let (plan, Some(solved)) = fleet.plan(method) else { continue };
            let proof = plan.certificate.as_ref().expect("a certificate");
            let outlines = fleet.outlines.iter().filter(|outline| !outline.is_disc()).count();
            assert_eq!((proof.verdict, proof.outlines), ("proved", outlines), "{number} {method:?}");
            let least = fleet.least(&solved, ROUNDED);
            assert!(least > 0.0, "{number} {method:?}: {least}");
            planned += 1;
            for (place, agent) in plan.agents.iter().enumerate() {
                if method == PlanMethod::Delay && agent.delay > 0.1 {
                    waits += 1;
                    // Most of them would touch somebody a moment before; some would do so only if another one were earlier as well.
                    let mut earlier = solved.clone();
                    earlier.agents[place].t_start -= 0.02;
                    tight += usize::from(fleet.least(&earlier, 0.0) <= 0.0);
                }
            }
        }
    }
    println!("{planned} plans, {waits} waits, {tight} of them tight");
    assert!(planned > 20 && waits > 8 && 2 * tight > waits, "{planned} {waits} {tight}");
}
