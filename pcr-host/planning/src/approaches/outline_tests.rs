//! Records of vehicles with outlines.

use super::tests::report;
use super::*;
use crate::outline_judge::{FORK, Outline, Point, TRUCK};
use pcr_formats::footprint::Footprint;
use pcr_formats::import::{PoseTrack, TimedPose};
use pcr_formats::splitmix64::SplitMix64;

/// Greatest speed and rate of turning \[m/s, rad/s\].
const TOP: [f64; 2] = [2.0, 1.0];

/// Time between two poses of what truly happened \[s\], and how many of these there are from one pose of the record to the next.
const STEP: f64 = 0.1;
const SEEN: usize = 5;

fn track(id: u64, outline: &[Point], poses: Vec<TimedPose>) -> PoseTrack {
    let footprint = Footprint::new(outline.to_vec()).unwrap();
    PoseTrack { id, radius: footprint.circumscribed_radius(), footprint: Some(footprint), poses }
}

fn random_way(random: &mut SplitMix64) -> Vec<TimedPose> {
    let mut place = [3.0 * random.unit(), 3.0 * random.unit(), 6.3 * random.unit()];
    let pose = |k: usize, [x, y, heading]: [f64; 3]| TimedPose {
        t: STEP * k as f64,
        point: [x, y],
        heading: Some(heading),
        error: 0.0,
        map: 0,
        is_joined: k > 0,
    };
    let mut poses = vec![pose(0, place)];
    let mut course = 6.3 * random.unit();
    for k in 1..=4 * SEEN {
        course += 2.0 * random.unit() - 1.0;
        let way = 0.99 * STEP * TOP[0] * random.unit();
        let turn = 0.99 * STEP * TOP[1] * (2.0 * random.unit() - 1.0);
        place = [place[0] + way * course.cos(), place[1] + way * course.sin(), place[2] + turn];
        poses.push(pose(k, place));
    }
    poses
}

fn at(poses: &[TimedPose], t: f64) -> [f64; 3] {
    let k = ((t / STEP) as usize).min(poses.len() - 2);
    let (a, b) = (&poses[k], &poses[k + 1]);
    let part = (t - a.t) / (b.t - a.t);
    let mix = |a: f64, b: f64| a + part * (b - a);
    [mix(a.point[0], b.point[0]), mix(a.point[1], b.point[1]), mix(a.heading.unwrap(), b.heading.unwrap())]
}

#[test]
fn straight_and_steady_motions_agree_with_dense_sampling() {
    let mut random = SplitMix64(21);
    let (mut contacts, mut free) = (0, 0);
    for _ in 0..150 {
        let ways = [random_way(&mut random), random_way(&mut random)];
        let tracks = vec![track(1, &TRUCK, ways[0].clone()), track(2, &FORK, ways[1].clone())];
        let exact = report(tracks, BetweenPoses::Straight(0.0));
        let (bodies, mut least) = ([Outline::polygon(&TRUCK), Outline::polygon(&FORK)], f64::INFINITY);
        for k in 0..=2000 {
            let t = 0.001 * f64::from(k);
            let gap = bodies[0].at(at(&ways[0], t)).apart(&bodies[1].at(at(&ways[1], t)));
            least = least.min(gap);
            let is_open = exact.approaches.iter().any(|it| it.t[0] <= t && t <= it.t[1]);
            let is_proved = exact.approaches.iter().flat_map(|it| &it.contacts).any(|it| it[0] <= t && t <= it[1]);
            assert!((!is_proved || gap <= 1e-9) && (is_open || gap > -1e-9), "{t}: {gap}");
            assert!(!is_open || gap < 1e-4, "{t}: {gap}");
            if gap <= 0.0 { contacts += 1 } else { free += 1 }
        }
        let clearance = exact.closest.as_ref().unwrap()[0].clearance;
        if least > 0.0 {
            // In a millisecond they come no nearer than by this.
            assert!(clearance[0] <= least + 1e-9 && least - 0.01 < clearance[1], "{clearance:?} {least}");
        }
        assert!(clearance[1] - clearance[0] < 1e-3 && (least > 0.0) == (clearance[1] > 0.0), "{clearance:?} {least}");
        assert!(exact.approaches.iter().all(|it| it.verdict == ContactVerdict::Contact || it.clearance[1] > -1e-4));
    }
    assert!(contacts > 10_000 && free > 10_000, "{contacts} {free}");
}

#[test]
fn ways_within_the_top_speed_and_rotation_are_within_the_bounds() {
    let mut random = SplitMix64(22);
    let (mut proved, mut covered, mut narrower) = (0, 0, 0);
    for _ in 0..200 {
        let ways = [random_way(&mut random), random_way(&mut random)];
        let seen = |way: &Vec<TimedPose>| way.iter().copied().step_by(SEEN).collect::<Vec<_>>();
        let [a, b] = [&ways[0], &ways[1]].map(seen);
        let between = BetweenPoses::TopSpeed { speed: TOP[0], rotation: TOP[1] };
        let bounds = report(vec![track(1, &TRUCK, a.clone()), track(2, &FORK, b.clone())], between);
        let [own, theirs] = ways;
        let truth = report(vec![track(1, &TRUCK, own), track(2, &FORK, theirs)], BetweenPoses::Straight(0.0));
        let [truly, bound] = [&truth, &bounds].map(|report| report.closest.as_ref().unwrap()[0].clearance);
        assert!(bound[0] <= truly[1] && truly[0] <= bound[1], "{bound:?} {truly:?}");
        let is_within = |report: &ApproachReport, t: [f64; 2]| {
            report.approaches.iter().any(|it| it.t[0] <= t[0] && t[1] <= it.t[1])
        };
        for contact in truth.approaches.iter().flat_map(|it| &it.contacts) {
            assert!(is_within(&bounds, *contact), "{contact:?}");
            covered += 1;
        }
        for contact in bounds.approaches.iter().flat_map(|it| &it.contacts) {
            assert!(is_within(&truth, *contact), "{contact:?}");
            proved += 1;
        }
        // Discs around the outlines know less.
        let disc = |track: PoseTrack| PoseTrack { footprint: None, ..track };
        let tracks = vec![disc(track(1, &TRUCK, a)), disc(track(2, &FORK, b))];
        let discs = report(tracks, BetweenPoses::TopSpeed { speed: TOP[0], rotation: 0.0 });
        assert!(bounds.approaches.iter().all(|it| is_within(&discs, it.t)));
        narrower += usize::from(bounds.is_free() && !discs.is_free());
    }
    assert!(proved > 20 && covered > 50 && narrower > 5, "{proved} {covered} {narrower}");
}

/// Two lanes side by side: the discs around trucks would touch, the trucks do not.
#[test]
fn trucks_pass_in_two_lanes_in_which_their_discs_would_touch() {
    let lane = |y: f64, from: f64, to: f64, heading: f64| {
        let pose = |t: f64, x: f64, is_joined| TimedPose {
            t,
            point: [x, y],
            heading: Some(heading),
            error: 0.01,
            map: 0,
            is_joined,
        };
        vec![pose(0.0, from, false), pose(10.0, to, true)]
    };
    let pass = |apart: f64| {
        let [east, west] = [lane(0.0, 0.0, 10.0, 0.0), lane(apart, 10.0, 0.0, std::f64::consts::PI)];
        report(vec![track(1, &TRUCK, east), track(2, &TRUCK, west)], BetweenPoses::Straight(0.05))
    };
    // Half widths of 0.4 m, and 0.06 m of each.
    let free = pass(0.93);
    assert!(free.is_free() && free.agents[0].outline.as_ref().is_some_and(|corners| corners.len() == 4));
    assert!((free.closest.unwrap()[0].clearance[0] - 0.01).abs() < 2e-4);
    let unknown = pass(0.85);
    assert!(!unknown.is_free() && !unknown.has_contact());
    assert!(pass(0.6).has_contact());
}
