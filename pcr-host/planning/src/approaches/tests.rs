use super::*;
use crate::check::CheckReport;
use pcr_formats::import::{PoseTrack, TimedPose, sectioned};
use pcr_formats::plane_geometry::distance;
use pcr_formats::scenario::{Agent, PlacedSegment, Scenario};
use pcr_formats::splitmix64::SplitMix64;

fn track(id: u64, radius: f64, poses: &[(f64, [f64; 2])]) -> PoseTrack {
    let pose = |(k, &(t, point)): (usize, &(f64, [f64; 2]))| TimedPose {
        t,
        point,
        heading: None,
        error: 0.0,
        map: 0,
        is_joined: k > 0,
    };
    PoseTrack { id, radius, footprint: None, poses: poses.iter().enumerate().map(pose).collect() }
}

pub(super) fn report(tracks: Vec<PoseTrack>, between: BetweenPoses) -> ApproachReport {
    let maps = vec![String::new()];
    let log = PoseLog {
        labels: Labels::default(),
        origin: None,
        maps,
        tracks,
        held: Vec::new(),
        stands_at_ends: false,
        between,
    };
    ApproachReport::compute("", &log, true, Vec::new(), &|_, _| {}).unwrap()
}

fn random_track(id: u64, random: &mut SplitMix64) -> PoseTrack {
    let mut t = random.unit();
    let poses: Vec<(f64, [f64; 2])> = (0..6)
        .map(|_| {
            t += 0.2 + random.unit();
            (t, [4.0 * random.unit(), 4.0 * random.unit()])
        })
        .collect();
    track(id, 0.2 + 0.3 * random.unit(), &poses)
}

fn place(track: &PoseTrack, t: f64) -> Option<[f64; 2]> {
    let pair = track.poses.windows(2).find(|pair| pair[0].t <= t && t <= pair[1].t)?;
    let part = (t - pair[0].t) / (pair[1].t - pair[0].t);
    Some([0, 1].map(|axis| pair[0].point[axis] + part * (pair[1].point[axis] - pair[0].point[axis])))
}

#[test]
fn random_plans_agree_with_dense_sampling() {
    let mut random = SplitMix64(7);
    let (mut inside, mut outside) = (0, 0);
    for _ in 0..200 {
        let tracks = vec![random_track(1, &mut random), random_track(2, &mut random)];
        let exact = report(tracks.clone(), BetweenPoses::Straight(0.0));
        let wide = report(tracks.clone(), BetweenPoses::Straight(0.1));
        let (radii, mut least) = (tracks[0].radius + tracks[1].radius, f64::INFINITY);
        for k in 0..4000 {
            let t = 0.002 * f64::from(k);
            let (Some(a), Some(b)) = (place(&tracks[0], t), place(&tracks[1], t)) else { continue };
            let gap = distance(a, b) - radii;
            least = least.min(gap);
            let is_open = |report: &ApproachReport| report.approaches.iter().any(|it| it.t[0] <= t && t <= it.t[1]);
            let is_proved = |report: &ApproachReport| {
                report.approaches.iter().flat_map(|it| &it.contacts).any(|it| it[0] <= t && t <= it[1])
            };
            for (report, bound) in [(&exact, 0.0), (&wide, 0.2)] {
                assert!(is_open(report) || gap > bound - 1e-8, "{t}: {gap}");
                assert!(!is_open(report) || gap < bound + 1e-7, "{t}: {gap}");
                assert!(!is_proved(report) || gap < -bound + 1e-8, "{t}: {gap}");
                assert!(is_proved(report) || gap > -bound - 1e-7, "{t}: {gap}");
            }
            if gap < 0.0 { inside += 1 } else { outside += 1 }
        }
        let Some(nearest) = exact.closest.as_ref().unwrap().first() else { continue };
        // Between two samples they come nearer by less than this at these speeds.
        assert!(nearest.clearance[0] <= least + 1e-9 && least - 0.06 < nearest.clearance[1], "{nearest:?} {least}");
        assert!(nearest.clearance[1] - nearest.clearance[0] < 1e-9, "{nearest:?}");
    }
    assert!(inside > 1000 && outside > 1000, "{inside} {outside}");
}

/// One constant speed each, which the kernel computes as a motion on a line.
#[test]
fn straight_motions_have_the_conflicts_of_the_kernel() {
    let mut random = SplitMix64(11);
    let mut conflicts = 0;
    for _ in 0..200 {
        let mut ends = || [0; 2].map(|_| [6.0 * random.unit(), 6.0 * random.unit()]);
        let (ways, duration) = ([ends(), ends()], 3.0);
        let tracks = [1, 2].map(|id| {
            let [from, to] = ways[id - 1];
            track(id as u64, 0.6, &[(0.0, from), (duration, to)])
        });
        let agents = [1, 2].map(|id| {
            let [from, to] = ways[id - 1];
            let heading = (to[1] - from[1]).atan2(to[0] - from[0]);
            let motion = sectioned(&[(distance(from, to), duration)]);
            Agent::disc(id as u64, 0.6, [from[0], from[1], heading], vec![PlacedSegment::line(from, to).shape], motion)
        });
        let kernel = CheckReport::compute::<f64>(&Scenario::new("", agents.to_vec()), true).unwrap();
        let exact = report(tracks.to_vec(), BetweenPoses::Straight(0.0));
        let near = exact.closest.as_ref().unwrap()[0].clone();
        let expected = kernel.closest.as_ref().unwrap()[0];
        assert!(near.clearance[0] - 1e-7 < expected.clearance && expected.clearance < near.clearance[1] + 1e-7);
        if expected.clearance.abs() < 1e-6 {
            continue;
        }
        let found: Vec<[f64; 2]> = exact.approaches.iter().map(|it| it.t).collect();
        assert_eq!(found.len(), kernel.conflicts.len(), "{ways:?}");
        for (own, theirs) in found.iter().zip(&kernel.conflicts) {
            assert!(own.iter().zip(theirs.t).all(|(a, b)| (a - b).abs() < 1e-4), "{own:?} {theirs:?}");
            conflicts += 1;
        }
        assert!(exact.approaches.iter().all(|it| it.verdict == ContactVerdict::Contact));
    }
    assert!(conflicts > 20, "{conflicts}");
}

/// The least distance of discs of 0.3 m that leave and reach their ends within 1 s, by sampling; that of the centres is at least 0.
fn least_gap(ways: &[[[f64; 2]; 2]; 2], top: f64) -> f64 {
    let sample = |k: u32| {
        let t = f64::from(k) / 10_000.0;
        let at = |way: &[[f64; 2]; 2]| [0, 1].map(|axis| way[0][axis] + t * (way[1][axis] - way[0][axis]));
        let off = |way: &[[f64; 2]; 2]| {
            let speed = distance(way[0], way[1]);
            let ellipse = ((top * top - speed * speed) * t * (1.0 - t)).sqrt();
            ellipse.min((top + speed) * t.min(1.0 - t))
        };
        distance(at(&ways[0]), at(&ways[1])) - off(&ways[0]) - off(&ways[1])
    };
    (0..=10_000).map(sample).fold(f64::INFINITY, f64::min).max(0.0) - 0.6
}

/// Whatever two agents did at up to the top speed is within the bounds.
#[test]
fn ways_within_the_top_speed_are_within_the_bounds() {
    let mut random = SplitMix64(5);
    let top = 3.0;
    for _ in 0..300 {
        // Legs of 1 s, with a corner at a random time that it reaches and leaves at up to the top speed.
        let mut way = |id: u64| loop {
            let at = 0.05 + 0.9 * random.unit();
            let [a, b, c] = [0; 3].map(|_| [3.0 * random.unit(), 3.0 * random.unit()]);
            if distance(a, c) <= top * at && distance(c, b) <= top * (1.0 - at) {
                return (track(id, 0.3, &[(0.0, a), (1.0, b)]), track(id, 0.3, &[(0.0, a), (at, c), (1.0, b)]));
            }
        };
        let ((seen, true_way), (other_seen, other_way)) = (way(1), way(2));
        let ways = [&seen, &other_seen].map(|track| [track.poses[0].point, track.poses[1].point]);
        let truth = report(vec![true_way, other_way], BetweenPoses::Straight(0.0));
        let bounds = report(vec![seen, other_seen], BetweenPoses::TopSpeed { speed: top, rotation: 0.0 });
        let [truly, bound] = [&truth, &bounds].map(|report| report.closest.as_ref().unwrap()[0].clearance);
        assert!(bound[0] <= truly[1] && truly[0] <= bound[1], "{bound:?} {truly:?}");
        assert!((bound[0] - least_gap(&ways, top)).abs() < 1e-4, "{bound:?}");
        for contact in truth.approaches.iter().flat_map(|it| &it.contacts) {
            let is_covered = |it: &ApproachEntry| it.t[0] <= contact[0] && contact[1] <= it.t[1];
            assert!(bounds.approaches.iter().any(is_covered), "{contact:?}");
        }
        for contact in bounds.approaches.iter().flat_map(|it| &it.contacts) {
            let is_real = |it: &ApproachEntry| it.t[0] <= contact[0] && contact[1] <= it.t[1];
            assert!(truth.approaches.iter().any(is_real), "{contact:?}");
        }
    }
}

#[test]
fn a_touch_in_parallel_is_not_known_and_ends() {
    let side = |id: u64, y: f64| track(id, 0.5, &[(0.0, [0.1, y]), (1000.0, [700.3, y])]);
    let report = report(vec![side(1, 0.0), side(2, 1.0)], BetweenPoses::Straight(0.0));
    assert_eq!(report.approaches.len(), 1);
    assert_eq!(report.approaches[0].verdict, ContactVerdict::Unknown);
    assert_eq!(report.approaches[0].t, [0.0, 1000.0]);
}
